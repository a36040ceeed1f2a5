//! Cells and headings as numbers that take apart quickly.

use activecell::{Cell, Dir, Lattice, Map, Moves};

/// A cell and a heading in one number: where a robot is. Without headings the heading is 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub(super) struct Place(u32);

impl Place {
    /// The place of a cell's number and a heading.
    pub(super) const fn new(spot: u32, heading: u32) -> Self {
        Self(spot << 3 | heading)
    }

    pub(super) const fn raw(self) -> u32 {
        self.0
    }

    /// The number of the cell.
    #[inline]
    pub(super) const fn spot(self) -> u32 {
        self.0 >> 3
    }

    #[inline]
    pub(super) const fn heading(self) -> u32 {
        self.0 & 7
    }
}

/// The floor as the planner of a run sees it: rows of cells, each row as long as a power of two.
#[derive(Debug, Clone)]
pub(super) struct Ground {
    pub(super) map: Map,
    pub(super) moves: Moves,
    pub(super) lattice: Lattice,
    pub(super) width: u32,
    pub(super) height: u32,
    shift: u32,
    /// The free cells around each cell as bits, one a direction.
    open: Vec<u8>,
}

impl Ground {
    /// Prepares a map.
    pub(super) fn new(map: &Map, moves: Moves) -> Self {
        let (width, height, lattice) = (map.width(), map.height(), map.lattice());
        let shift = width.next_power_of_two().trailing_zeros();
        let mut ground = Self { map: map.clone(), moves, lattice, width, height, shift, open: Vec::new() };
        ground.open = vec![0; ground.spots()];
        for cell in map.free() {
            let ways = lattice.dirs().filter(|&dir| map.is_free(lattice.neighbour(cell, dir)));
            let spot = ground.spot(cell) as usize;
            ground.open[spot] = ways.fold(0, |ways, dir| ways | 1 << dir.0);
        }
        ground
    }

    /// How many numbers of cells there are.
    pub(super) const fn spots(&self) -> usize {
        (self.height as usize) << self.shift
    }

    /// How many headings a robot can have.
    pub(super) const fn headings(&self) -> u32 {
        match self.moves {
            Moves::Omni => 1,
            Moves::Turning => self.lattice.degree() as u32,
        }
    }

    /// The number of a cell.
    pub(super) const fn spot(&self, cell: Cell) -> u32 {
        (cell.y as u32) << self.shift | cell.x as u32
    }

    /// The cell of a number.
    pub(super) const fn cell(&self, spot: u32) -> Cell {
        Cell::new(self.x(spot), self.y(spot))
    }

    #[inline]
    pub(super) const fn x(&self, spot: u32) -> i32 {
        (spot & ((1 << self.shift) - 1)) as i32
    }

    #[inline]
    pub(super) const fn y(&self, spot: u32) -> i32 {
        (spot >> self.shift) as i32
    }

    /// The directions in which a free cell follows, as bits.
    #[inline]
    pub(super) fn open(&self, spot: u32) -> u32 {
        u32::from(self.open[spot as usize])
    }

    /// The cell that follows in a direction; it must be on the map.
    #[inline]
    pub(super) const fn ahead(&self, spot: u32, dir: u32) -> u32 {
        self.spot(self.lattice.neighbour(self.cell(spot), Dir(dir as u8)))
    }

    /// The direction from a cell to a neighbour.
    #[inline]
    pub(super) fn direction(&self, from: u32, to: u32) -> u32 {
        let (dx, dy) = (self.x(to) - self.x(from), self.y(to) - self.y(from));
        match self.lattice {
            Lattice::Square => {
                if dy == 0 {
                    (2 - dx) as u32
                } else {
                    (1 + dy) as u32
                }
            }
            Lattice::Hex => {
                // Of the two cells in the row above or below, the right one is in the column that the row's parity says.
                let right = dx == self.y(from) & 1;
                match (dy, right) {
                    (0, _) => {
                        if dx > 0 {
                            1
                        } else {
                            4
                        }
                    }
                    (-1, true) => 0,
                    (-1, false) => 5,
                    (_, true) => 2,
                    (_, false) => 3,
                }
            }
        }
    }

    /// The directions as bits, one after the other.
    pub(super) fn directions(mut bits: u32) -> impl Iterator<Item = u32> {
        std::iter::from_fn(move || {
            let dir = bits.trailing_zeros();
            bits &= bits.wrapping_sub(1);
            (dir < 32).then_some(dir)
        })
    }

    /// The heading turned by one direction to the left (-1) or right (1).
    #[inline]
    pub(super) const fn turned(&self, heading: u32, by: i32) -> u32 {
        self.lattice.turned(Dir(heading as u8), by).0 as u32
    }

    /// The opposite direction.
    #[inline]
    pub(super) const fn turned_back(&self, dir: u32) -> u32 {
        self.lattice.opposite(Dir(dir as u8)).0 as u32
    }

    /// The fewest turns from a heading to one of these directions.
    pub(super) fn turns(&self, heading: u32, directions: u32) -> u16 {
        let degree = u32::from(self.lattice.degree());
        let turns = |dir: u32| ((dir + degree - heading) % degree).min((heading + degree - dir) % degree);
        Self::directions(directions).map(turns).min().unwrap_or(0) as u16
    }

    /// Calls with the places from which a robot comes here in a step, waiting aside.
    #[inline]
    pub(super) fn before(&self, place: Place, mut call: impl FnMut(Place)) {
        let spot = place.spot();
        if self.headings() == 1 {
            for dir in Self::directions(self.open(spot)) {
                call(Place::new(self.ahead(spot, dir), 0));
            }
        } else {
            call(Place::new(spot, self.turned(place.heading(), -1)));
            call(Place::new(spot, self.turned(place.heading(), 1)));
            let back = self.turned_back(place.heading());
            if self.open(spot) >> back & 1 == 1 {
                call(Place::new(self.ahead(spot, back), place.heading()));
            }
        }
    }

    /// From a number to that of the cell below.
    pub(super) const fn stride(&self) -> i32 {
        1 << self.shift
    }
}
