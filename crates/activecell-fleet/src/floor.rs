//! The map as the planners walk it: numbered cells and the cells that they touch.

use activecell::{Cell, Map, TileOrder};

/// No cell, and no robot.
pub const NONE: u32 = u32::MAX;

/// The free cells of a map, by their numbers in a [`TileOrder`], each with the free cells that it touches.
///
/// ```
/// use activecell::{Cell, Lattice, Map};
/// use activecell_fleet::Floor;
/// let map = Map::parse(Lattice::Square, "..#.")?;
/// let floor = Floor::new(&map);
/// let [west, next, east] = [0, 1, 3].map(|x| floor.number(Cell::new(x, 0)));
/// assert_eq!(floor.links(west), [next]);
/// assert!(floor.connected(west, next) && !floor.connected(west, east));
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Floor {
    map: Map,
    order: TileOrder,
    /// Where the links of each number begin.
    first: Vec<u32>,
    links: Vec<u32>,
    /// Which connected part of the floor each number belongs to.
    part: Vec<u32>,
    /// Whether robots that meet in this cell can always go round each other: it has three ways that do not end at once.
    roomy: Vec<bool>,
}

impl Floor {
    /// Prepares a map.
    pub fn new(map: &Map) -> Self {
        let order = TileOrder::new(map);
        let (mut first, mut links) = (Vec::with_capacity(order.numbers() + 1), Vec::new());
        for number in 0..order.numbers() as u32 {
            first.push(links.len() as u32);
            let cell = order.cell(number);
            if map.is_free(cell) {
                let around = map.lattice().dirs().map(|dir| map.lattice().neighbour(cell, dir));
                links.extend(around.filter(|&cell| map.is_free(cell)).map(|cell| order.number(cell)));
            }
        }
        first.push(links.len() as u32);
        let mut floor = Self { map: map.clone(), order, first, links, part: Vec::new(), roomy: Vec::new() };
        floor.part = floor.parts();
        let numbers = 0..order.numbers() as u32;
        let open = |number| floor.links(number).iter().filter(|&&next| floor.links(next).len() > 1).count();
        floor.roomy = numbers.map(|number| open(number) > 2).collect();
        floor
    }

    fn parts(&self) -> Vec<u32> {
        let mut part = vec![NONE; self.numbers()];
        for origin in self.map.free().map(|cell| self.number(cell)) {
            let mut rim = vec![origin];
            while let Some(number) = rim.pop() {
                if part[number as usize] == NONE {
                    part[number as usize] = origin;
                    rim.extend(self.links(number));
                }
            }
        }
        part
    }

    /// The map.
    pub const fn map(&self) -> &Map {
        &self.map
    }

    /// The numbering.
    pub const fn order(&self) -> TileOrder {
        self.order
    }

    /// How many numbers there are; some belong to no free cell.
    pub const fn numbers(&self) -> usize {
        self.order.numbers()
    }

    /// The number of a cell of the map.
    pub const fn number(&self, cell: Cell) -> u32 {
        self.order.number(cell)
    }

    /// The numbers of cells of the map.
    pub fn numbers_of(&self, cells: &[Cell]) -> Vec<u32> {
        cells.iter().map(|&cell| self.number(cell)).collect()
    }

    /// The cell of a number.
    pub const fn cell(&self, number: u32) -> Cell {
        self.order.cell(number)
    }

    /// The free cells that a cell touches, clockwise from the top.
    #[inline]
    pub fn links(&self, number: u32) -> &[u32] {
        let number = number as usize;
        &self.links[self.first[number] as usize..self.first[number + 1] as usize]
    }

    /// The cell in a slot: the link of that number, or the cell itself.
    #[inline]
    pub(crate) fn beside(&self, number: u32, slot: u32) -> u32 {
        self.links(number).get(slot as usize).copied().unwrap_or(number)
    }

    /// Whether a way leads from one free cell to the other.
    pub fn connected(&self, a: u32, b: u32) -> bool {
        self.part[a as usize] == self.part[b as usize]
    }

    /// Whether robots that meet in this cell can always go round each other.
    #[inline]
    pub(crate) fn is_roomy(&self, number: u32) -> bool {
        self.roomy[number as usize]
    }

    /// The memory that the floor takes, in bytes, without the map.
    pub fn bytes(&self) -> usize {
        (self.first.capacity() + self.links.capacity() + self.part.capacity()) * size_of::<u32>()
            + self.roomy.capacity()
    }
}
