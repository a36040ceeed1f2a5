//! Lattices: which cells touch which, how far apart they are, and which way is where.
//!
//! A cell is a column and a row, row 0 on top, as in an image. Directions are counted clockwise from the top.
//!
//! ```text
//!  Square                               Hex (pointy-top, odd rows shifted right: "odd-r")
//!
//!             b1¹                                / \ / \ / \
//!             (2N)                              | . | . | . |          ring 1, clockwise:
//!       b41    b1    b12                       / \ / \ / \ / \         C1 = NE  C2 = E  C3 = SE
//!       (NW)   (N)   (NE)                     | . |C6 |C1 | . |        C4 = SW  C5 = W  C6 = NW
//!  b4⁴   b4    b0     b2    b2²              / \ / \ / \ / \ / \
//!  (2W)  (W)          (E)   (2E)            | . |C5 |C0 |C2 | . |      ring 2, clockwise from twice C1:
//!       b34    b3    b23                     \ / \ / \ / \ / \ /       2C1, C1+C2, 2C2, C2+C3, … C6+C1
//!       (SW)   (S)   (SE)                     | . |C4 |C3 | . |
//!             b3³                              \ / \ / \ / \ /
//!             (2S)                              | . | . | . |
//!                                                \ / \ / \ /
//! ```
//!
//! In both lattices ring 2 is counted alike: its cell 2j lies straight ahead of neighbour j, its cell 2j + 1
//! between the neighbours j and j + 1. This is what lets one rule serve both ([`crate::rule`]).
//!
//! Hexagon coordinates follow Amit Patel, *Hexagonal Grids* (Red Blob Games, 2013).

use std::fmt;

/// A cell: column `x`, row `y`, row 0 on top. Cells outside a map are values too; there they read as obstacles.
///
/// ```
/// use activecell::Cell;
/// assert_eq!(Cell::new(3, 4).to_string(), "(3,4)");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Cell {
    /// Column, growing to the right (East).
    pub x: i32,
    /// Row, growing downwards (South).
    pub y: i32,
}

impl Cell {
    /// The cell in column `x` of row `y`.
    pub const fn new(x: i32, y: i32) -> Self {
        Self { x, y }
    }
}

impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "({},{})", self.x, self.y)
    }
}

/// A direction: the number of a neighbour, clockwise from the top, from 0.
///
/// The paper counts from 1: its `b1` (North) is [`Dir::N`] = `Dir(0)`, its `C1` (North-East) is `Dir(0)` too. A
/// number of 4 and more on squares, of 6 and more on hexagons, names no direction; functions that are given one
/// panic.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Dir(pub u8);

impl Dir {
    /// North on the square lattice.
    pub const N: Self = Self(0);
    /// East on the square lattice.
    pub const E: Self = Self(1);
    /// South on the square lattice.
    pub const S: Self = Self(2);
    /// West on the square lattice.
    pub const W: Self = Self(3);

    /// The direction's number, for indexing.
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

/// The mosaic that covers the floor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Lattice {
    /// Squares with four neighbours.
    #[default]
    Square,
    /// Pointy-top hexagons with six neighbours, odd rows shifted right by half a cell.
    Hex,
}

const SQUARE_NAMES: [&str; 4] = ["N", "E", "S", "W"];
const HEX_NAMES: [&str; 6] = ["NE", "E", "SE", "SW", "W", "NW"];
const SQUARE_OFFSETS: [(i32, i32); 4] = [(0, -1), (1, 0), (0, 1), (-1, 0)];
/// Offsets of the hexagonal neighbours, for even and for odd rows.
const HEX_OFFSETS: [[(i32, i32); 6]; 2] = [
    [(0, -1), (1, 0), (0, 1), (-1, 1), (-1, 0), (-1, -1)],
    [(1, -1), (1, 0), (1, 1), (0, 1), (-1, 0), (0, -1)],
];

impl Lattice {
    /// Both lattices.
    pub const ALL: [Self; 2] = [Self::Square, Self::Hex];

    /// How many neighbours a cell has: 4 or 6.
    pub const fn degree(self) -> u8 {
        match self {
            Self::Square => 4,
            Self::Hex => 6,
        }
    }

    /// How many cells the second ring has: 8 or 12.
    pub const fn ring2_len(self) -> u8 {
        2 * self.degree()
    }

    /// The directions, clockwise from the top.
    pub fn dirs(self) -> impl DoubleEndedIterator<Item = Dir> + ExactSizeIterator {
        (0..self.degree()).map(Dir)
    }

    /// The direction `steps` places clockwise of `dir`.
    pub const fn turned(self, dir: Dir, steps: i32) -> Dir {
        Dir((dir.0 as i32 + steps).rem_euclid(self.degree() as i32) as u8)
    }

    /// The direction back.
    pub const fn opposite(self, dir: Dir) -> Dir {
        self.turned(dir, self.degree() as i32 / 2)
    }

    /// The angle from `from` to `to` as the paper's program counts it: degrees, clockwise (right) positive,
    /// above −180 and up to 180.
    ///
    /// ```
    /// use activecell::{Dir, Lattice};
    /// assert_eq!(Lattice::Square.turn_deg(Dir::N, Dir::W), -90);
    /// assert_eq!(Lattice::Hex.turn_deg(Dir(5), Dir(1)), 120);
    /// ```
    pub const fn turn_deg(self, from: Dir, to: Dir) -> i32 {
        let step = 360 / self.degree() as i32;
        let clockwise = (to.0 as i32 - from.0 as i32).rem_euclid(self.degree() as i32) * step;
        if clockwise > 180 { clockwise - 360 } else { clockwise }
    }

    /// The neighbour of `cell` in direction `dir`.
    ///
    /// ```
    /// use activecell::{Cell, Dir, Lattice};
    /// assert_eq!(Lattice::Square.neighbour(Cell::new(2, 2), Dir::N), Cell::new(2, 1));
    /// assert_eq!(Lattice::Hex.neighbour(Cell::new(2, 1), Dir(0)), Cell::new(3, 0));
    /// ```
    pub const fn neighbour(self, cell: Cell, dir: Dir) -> Cell {
        let (dx, dy) = match self {
            Self::Square => SQUARE_OFFSETS[dir.index()],
            Self::Hex => HEX_OFFSETS[(cell.y & 1) as usize][dir.index()],
        };
        Cell::new(cell.x.saturating_add(dx), cell.y.saturating_add(dy))
    }

    /// The direction from a cell to one of its neighbours; `None` if the two do not touch.
    pub fn dir_between(self, from: Cell, to: Cell) -> Option<Dir> {
        self.dirs().find(|&dir| self.neighbour(from, dir) == to)
    }

    /// Cell `k` of the second ring, clockwise: straight ahead of neighbour `k / 2` if `k` is even, else between
    /// the neighbours `k / 2` and `k / 2 + 1`. `k` is taken modulo the ring's length.
    pub const fn ring2(self, cell: Cell, k: u8) -> Cell {
        let k = k % self.ring2_len();
        let first = Dir(k / 2);
        let second = self.turned(first, (k % 2) as i32);
        self.neighbour(self.neighbour(cell, first), second)
    }

    /// The number of steps between two cells of an empty floor.
    ///
    /// ```
    /// use activecell::{Cell, Lattice};
    /// assert_eq!(Lattice::Square.distance(Cell::new(0, 0), Cell::new(2, 3)), 5);
    /// assert_eq!(Lattice::Hex.distance(Cell::new(0, 0), Cell::new(2, 3)), 4);
    /// ```
    pub const fn distance(self, a: Cell, b: Cell) -> u32 {
        let ((ax, ay), (bx, by)) = (self.centre(a), self.centre(b));
        let (across, down) = ((bx - ax).unsigned_abs(), (by - ay).unsigned_abs());
        match self {
            // Two units a step.
            Self::Square => (across / 2 + down / 2) as u32,
            // Every row crossed also moves half a cell sideways; the rest is walked along the row.
            Self::Hex => (down / 3 + across.saturating_sub(down / 3) / 2) as u32,
        }
    }

    /// The radius of the least [`block`](Self::block) around `a` that holds `b`: on hexagons the steps between them, on
    /// squares those of a chess king.
    ///
    /// ```
    /// use activecell::{Cell, Lattice};
    /// assert_eq!(Lattice::Square.block_distance(Cell::new(0, 0), Cell::new(2, 3)), 3);
    /// assert_eq!(Lattice::Hex.block_distance(Cell::new(0, 0), Cell::new(2, 3)), 4);
    /// ```
    pub const fn block_distance(self, a: Cell, b: Cell) -> u32 {
        match self {
            Self::Square => {
                let (across, down) = (a.x.abs_diff(b.x), a.y.abs_diff(b.y));
                if across > down { across } else { down }
            }
            Self::Hex => self.distance(a, b),
        }
    }

    /// The cells of the block of this radius around a cell, row by row: 2 `radius` + 1 squares each way, or the hexagon of
    /// all cells at most `radius` steps away.
    ///
    /// ```
    /// use activecell::{Cell, Lattice};
    /// assert_eq!(Lattice::ALL.map(|lattice| lattice.block(Cell::new(5, 5), 1).count()), [9, 7]);
    /// ```
    pub fn block(self, cell: Cell, radius: u32) -> impl Iterator<Item = Cell> {
        let radius = radius.min(i32::MAX as u32 / 4) as i32;
        (-radius..=radius).flat_map(move |dy| {
            let y = cell.y.saturating_add(dy);
            let (first, last) = match self {
                Self::Square => (cell.x.saturating_sub(radius), cell.x.saturating_add(radius)),
                Self::Hex => {
                    // Half cells to the left of the centre, and rows that lie half a cell aside.
                    let left = 2 * radius - dy.abs();
                    let first =
                        (i64::from(cell.x) * 2 + i64::from(cell.y & 1) - i64::from(left) - i64::from(y & 1))
                            / 2;
                    (first as i32, (first as i32).saturating_add(left))
                }
            };
            (first..=last).map(move |x| Cell::new(x, y))
        })
    }

    /// The cell's centre in whole units, x right and y down from the top left corner of the lattice's bounding
    /// box. The unit is half a cell on the square lattice; on the hexagonal one half a cell across (x) and half
    /// a hexagon's corner radius down (y). Integers keep every comparison of angles and distances exact.
    pub const fn centre(self, cell: Cell) -> (i64, i64) {
        let (x, y) = (cell.x as i64, cell.y as i64);
        match self {
            Self::Square => (2 * x + 1, 2 * y + 1),
            Self::Hex => (2 * x + 1 + (y & 1), 3 * y + 2),
        }
    }

    /// The corners of a cell about its [`centre`](Self::centre), in the same units, clockwise; the side towards
    /// direction `j` runs from corner `j` to corner `j + 1`.
    pub const fn corners(self) -> &'static [(i64, i64)] {
        match self {
            Self::Square => &[(-1, -1), (1, -1), (1, 1), (-1, 1)],
            Self::Hex => &[(0, -2), (1, -1), (1, 1), (0, 2), (-1, 1), (-1, -1)],
        }
    }

    /// The length of the units of [`centre`](Self::centre) for a cell of 1 m from side to side: (x, y).
    pub fn unit_m(self) -> (f64, f64) {
        match self {
            Self::Square => (0.5, 0.5),
            Self::Hex => (0.5, 0.5 / 3f64.sqrt()),
        }
    }

    /// The direction's name: `N`, `E`, … on squares, `NE`, `E`, `SE`, … on hexagons.
    pub const fn dir_name(self, dir: Dir) -> &'static str {
        match self {
            Self::Square => SQUARE_NAMES[dir.index()],
            Self::Hex => HEX_NAMES[dir.index()],
        }
    }

    /// The direction of that name, upper or lower case; `None` if the lattice has no such direction.
    pub fn dir_named(self, name: &str) -> Option<Dir> {
        self.dirs().find(|&dir| self.dir_name(dir).eq_ignore_ascii_case(name))
    }

    /// The lattice's name on the command line and in files: `square` or `hex`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Square => "square",
            Self::Hex => "hex",
        }
    }
}

impl fmt::Display for Lattice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    /// Distances by walking: the naive twin of `distance`.
    fn walked(lattice: Lattice, from: Cell, radius: u32) -> BTreeMap<Cell, u32> {
        let mut found = BTreeMap::from([(from, 0)]);
        let mut rim = vec![from];
        for steps in 1..=radius {
            let mut next = Vec::new();
            for cell in rim {
                for dir in lattice.dirs() {
                    let cell = lattice.neighbour(cell, dir);
                    if let std::collections::btree_map::Entry::Vacant(entry) = found.entry(cell) {
                        entry.insert(steps);
                        next.push(cell);
                    }
                }
            }
            rim = next;
        }
        found
    }

    #[test]
    fn distance_is_the_shortest_walk() {
        for lattice in Lattice::ALL {
            for from in [Cell::new(0, 0), Cell::new(3, 1), Cell::new(-2, -5)] {
                for (cell, steps) in walked(lattice, from, 9) {
                    assert_eq!(lattice.distance(from, cell), steps, "{lattice} {from} {cell}");
                }
            }
        }
    }

    #[test]
    fn blocks_hold_what_is_near() {
        for lattice in Lattice::ALL {
            for cell in [Cell::new(0, 0), Cell::new(3, 1), Cell::new(-2, -5), Cell::new(-7, 4)] {
                for radius in 0..5 {
                    let block: Vec<Cell> = lattice.block(cell, radius).collect();
                    let around = (-12..12).flat_map(|y| (-16..16).map(move |x| Cell::new(x, y)));
                    let near = around.filter(|&other| lattice.block_distance(cell, other) <= radius);
                    assert_eq!(block, near.collect::<Vec<_>>(), "{lattice} {cell} {radius}");
                }
            }
        }
    }

    #[test]
    fn rings_are_what_their_names_say() {
        for lattice in Lattice::ALL {
            for cell in [Cell::new(4, 4), Cell::new(4, 5)] {
                let ring2: Vec<Cell> = (0..lattice.ring2_len()).map(|k| lattice.ring2(cell, k)).collect();
                let mut expected: Vec<Cell> = walked(lattice, cell, 2)
                    .into_iter()
                    .filter_map(|(cell, steps)| (steps == 2).then_some(cell))
                    .collect();
                let mut sorted = ring2.clone();
                sorted.sort_unstable();
                expected.sort_unstable();
                assert_eq!(sorted, expected);
                for dir in lattice.dirs() {
                    assert_eq!(lattice.neighbour(lattice.neighbour(cell, dir), lattice.opposite(dir)), cell);
                    assert_eq!(lattice.dir_named(lattice.dir_name(dir)), Some(dir));
                    // A ring-2 cell between two neighbours touches both.
                    let between = lattice.ring2(cell, 2 * dir.0 + 1);
                    let right = lattice.neighbour(cell, lattice.turned(dir, 1));
                    assert!(lattice.dir_between(right, between).is_some());
                }
            }
        }
    }

    #[test]
    fn corners_bound_the_side_of_their_direction() {
        for lattice in Lattice::ALL {
            let n = usize::from(lattice.degree());
            for cell in [Cell::new(2, 2), Cell::new(2, 3)] {
                let corner = |cell: Cell, j: usize| {
                    let (x, y) = lattice.centre(cell);
                    (x + lattice.corners()[j % n].0, y + lattice.corners()[j % n].1)
                };
                for dir in lattice.dirs() {
                    let other = lattice.neighbour(cell, dir);
                    let back = lattice.opposite(dir).index();
                    assert_eq!(corner(cell, dir.index()), corner(other, back + 1));
                    assert_eq!(corner(cell, dir.index() + 1), corner(other, back));
                }
            }
        }
    }
}
