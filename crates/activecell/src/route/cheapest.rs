//! Routes on fields whose distances need not differ by one from cell to cell: cheapest, then fewest turns.

use super::{Outcome, Route};
use crate::lattice::{Cell, Dir};
use crate::map::Map;
use crate::wave::{LiveField, WeightedField};

/// One more than the most that a step can cost.
const RING: usize = 256;
const NO_WAY: u32 = u32::MAX;

/// What a route needs to know of a field.
trait Downhill {
    fn map(&self) -> &Map;
    fn target(&self) -> Cell;
    /// The cost of the way to the target, smaller with every step that leads nearer.
    fn level(&self, cell: Cell) -> Option<u32>;
    /// The steps that lead nearer on a cheapest way.
    fn nearer(&self, cell: Cell) -> impl Iterator<Item = Dir>;
}

impl Downhill for LiveField {
    fn map(&self) -> &Map {
        self.map()
    }
    fn target(&self) -> Cell {
        self.target()
    }
    fn level(&self, cell: Cell) -> Option<u32> {
        self.steps(cell)
    }
    fn nearer(&self, cell: Cell) -> impl Iterator<Item = Dir> {
        self.nearer(cell)
    }
}

impl Downhill for WeightedField {
    fn map(&self) -> &Map {
        self.terrain().map()
    }
    fn target(&self) -> Cell {
        self.target()
    }
    fn level(&self, cell: Cell) -> Option<u32> {
        self.cost(cell)
    }
    fn nearer(&self, cell: Cell) -> impl Iterator<Item = Dir> {
        self.nearer(cell)
    }
}

impl LiveField {
    /// A shortest route from `from` to the target on the map as it is now, and among the shortest one with the
    /// fewest turns.
    ///
    /// Where no way leads to the target the outcome is [`Outcome::Unreachable`] and the route is the start alone.
    pub fn route(&self, from: Cell) -> Route {
        route(self, from)
    }
}

impl WeightedField {
    /// A cheapest route from `from` to the target, and among the cheapest one with the fewest turns.
    ///
    /// Where no way leads to the target the outcome is [`Outcome::Unreachable`] and the route is the start alone.
    pub fn route(&self, from: Cell) -> Route {
        route(self, from)
    }
}

fn route(field: &impl Downhill, from: Cell) -> Route {
    let arrives = field.level(from).is_some();
    let outcome = if arrives { Outcome::Arrived } else { Outcome::Unreachable };
    let cells = if arrives { fewest_turns(field, from) } else { vec![from] };
    Route { lattice: field.map().lattice(), outcome, cells, cycle: Vec::new() }
}

/// For each direction the fewest turns with which a cell can be entered on a cheapest way.
type Turns = [u32; 6];

/// The fewest turns with which a cell is left in direction `out`, and the direction it was entered in: straight on
/// where that is as good.
fn leave(turns: &Turns, out: Dir) -> (u32, Dir) {
    let straight = (turns[out.index()], out);
    let turned = turns.iter().zip(0..).map(|(&turns, dir)| (turns.saturating_add(1), Dir(dir)));
    turned.fold(straight, |best, other| if other.0 < best.0 { other } else { best })
}

/// The cells of cheapest ways, in the order in which they were found, and the fewest turns to each.
struct Found<'a> {
    map: &'a Map,
    cells: Vec<(Cell, Turns)>,
    /// For each cell of the map, its place among the found cells, counted from 1; 0 before it has one.
    slots: Vec<u32>,
}

impl Found<'_> {
    /// The place of the cell, and whether it was found just now.
    fn place(&mut self, cell: Cell) -> (usize, bool) {
        let slot = &mut self.slots[self.map.index(cell).expect("ways stay on the map")];
        let new = *slot == 0;
        if new {
            self.cells.push((cell, [NO_WAY; 6]));
            *slot = self.cells.len() as u32;
        }
        (*slot as usize - 1, new)
    }
}

/// Turns are counted from the start on, in falling order of levels (a ring of buckets, as in the wave); then the
/// best route is read back.
fn fewest_turns(field: &impl Downhill, from: Cell) -> Vec<Cell> {
    let lattice = field.map().lattice();
    let mut found = Found { map: field.map(), cells: Vec::new(), slots: vec![0; field.map().cells()] };
    let (start, _) = found.place(from);
    found.cells[start].1 = [0; 6];
    let mut ring: Vec<Vec<u32>> = vec![Vec::new(); RING];
    let mut level = field.level(from).unwrap_or_default() as usize;
    ring[level % RING].push(start as u32);
    // Every step costs something, so that the target, at level 0, comes last.
    while level > 0 {
        for place in std::mem::take(&mut ring[level % RING]) {
            let (cell, turns) = found.cells[place as usize];
            for dir in field.nearer(cell) {
                let next = lattice.neighbour(cell, dir);
                let (place, new) = found.place(next);
                if new {
                    ring[field.level(next).unwrap_or_default() as usize % RING].push(place as u32);
                }
                let best = &mut found.cells[place].1[dir.index()];
                *best = (*best).min(leave(&turns, dir).0);
            }
        }
        level -= 1;
    }
    read_back(&mut found, from, field.target())
}

fn read_back(found: &mut Found<'_>, from: Cell, target: Cell) -> Vec<Cell> {
    let lattice = found.map.lattice();
    let mut cell = target;
    let mut cells = vec![cell];
    let mut turns = |cell| {
        let (place, _) = found.place(cell);
        found.cells[place].1
    };
    let fewest = turns(cell).iter().zip(0..).min().map_or(0, |(_, dir)| dir);
    let mut dir = Dir(fewest);
    while cell != from {
        cell = lattice.neighbour(cell, lattice.opposite(dir));
        dir = leave(&turns(cell), dir).1;
        cells.push(cell);
    }
    cells.reverse();
    cells
}
