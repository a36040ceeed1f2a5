//! Routes downhill in a field of any kind: cheapest, and among the cheapest one with the fewest turns.

use super::{Outcome, Route};
use crate::lattice::{Cell, Dir, Lattice};
use crate::map::row_index;
use crate::wave::{Field, LiveField, WeightedField};

const NO_WAY: u32 = u32::MAX;

/// What a route needs to know of a field.
trait Downhill {
    fn lattice(&self) -> Lattice;
    /// Columns and rows of the map.
    fn size(&self) -> (u32, u32);
    /// The cost of the way to the nearest target, smaller with every step that leads nearer; 0 at a target alone.
    fn level(&self, cell: Cell) -> Option<u32>;
    /// The steps that lead nearer on a cheapest way.
    fn nearer(&self, cell: Cell) -> impl Iterator<Item = Dir>;
    /// The most that a step can cost.
    fn dearest_step(&self) -> u32 {
        1
    }
}

impl Downhill for Field {
    fn lattice(&self) -> Lattice {
        self.lattice()
    }
    fn size(&self) -> (u32, u32) {
        self.size()
    }
    fn level(&self, cell: Cell) -> Option<u32> {
        self.steps(cell)
    }
    fn nearer(&self, cell: Cell) -> impl Iterator<Item = Dir> {
        self.nearer(cell)
    }
}

impl Downhill for LiveField {
    fn lattice(&self) -> Lattice {
        self.map().lattice()
    }
    fn size(&self) -> (u32, u32) {
        (self.map().width(), self.map().height())
    }
    fn level(&self, cell: Cell) -> Option<u32> {
        self.steps(cell)
    }
    fn nearer(&self, cell: Cell) -> impl Iterator<Item = Dir> {
        self.nearer(cell)
    }
}

impl Downhill for WeightedField {
    fn lattice(&self) -> Lattice {
        self.terrain().map().lattice()
    }
    fn size(&self) -> (u32, u32) {
        (self.terrain().map().width(), self.terrain().map().height())
    }
    fn dearest_step(&self) -> u32 {
        self.terrain().dearest_step()
    }
    fn level(&self, cell: Cell) -> Option<u32> {
        self.cost(cell)
    }
    fn nearer(&self, cell: Cell) -> impl Iterator<Item = Dir> {
        self.nearer(cell)
    }
}

impl Field {
    /// A shortest route from `from` to the nearest target, and among the shortest one with the fewest turns.
    ///
    /// Where the wave did not come the outcome is [`Outcome::Unreachable`] and the route is the start alone.
    pub fn route(&self, from: Cell) -> Route {
        route(self, from, None)
    }

    /// As [`Field::route`], for a robot that faces somewhere already: the first step is no turn if it leads in one
    /// of the directions `facing` (where the robot faces, and straight back if it can reverse).
    ///
    /// ```
    /// use activecell::{Cell, Dir, Lattice, Map};
    /// let map = Map::parse(Lattice::Square, "...\n...\n...")?;
    /// let route = map.wave(Cell::new(2, 0))?.route_facing(Cell::new(0, 2), &[Dir::N]);
    /// assert_eq!(route.cells()[1], Cell::new(0, 1));
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn route_facing(&self, from: Cell, facing: &[Dir]) -> Route {
        route(self, from, Some(facing))
    }
}

impl LiveField {
    /// A shortest route from `from` to the target on the map as it is now, and among the shortest one with the
    /// fewest turns.
    ///
    /// Where no way leads to the target the outcome is [`Outcome::Unreachable`] and the route is the start alone.
    pub fn route(&self, from: Cell) -> Route {
        route(self, from, None)
    }
}

impl WeightedField {
    /// A cheapest route from `from` to the target, and among the cheapest one with the fewest turns.
    ///
    /// Where no way leads to the target the outcome is [`Outcome::Unreachable`] and the route is the start alone.
    pub fn route(&self, from: Cell) -> Route {
        route(self, from, None)
    }

    /// As [`WeightedField::route`], for a robot that faces somewhere already; see [`Field::route_facing`].
    pub fn route_facing(&self, from: Cell, facing: &[Dir]) -> Route {
        route(self, from, Some(facing))
    }
}

fn route(field: &impl Downhill, from: Cell, facing: Option<&[Dir]>) -> Route {
    let arrives = field.level(from).is_some();
    let outcome = if arrives { Outcome::Arrived } else { Outcome::Unreachable };
    let all: Vec<Dir> = field.lattice().dirs().collect();
    let cells = if arrives { fewest_turns(field, from, facing.unwrap_or(&all)) } else { vec![from] };
    Route { lattice: field.lattice(), outcome, cells, cycle: Vec::new() }
}

/// A cell on a cheapest way, and for each direction the fewest turns with which it can be entered so.
struct Entry {
    cell: Cell,
    turns: [u32; 6],
}

impl Entry {
    /// The fewest turns with which the cell is left in direction `out`, and the direction it was entered in:
    /// straight on where that is as good.
    fn leave(&self, out: Dir) -> (u32, Dir) {
        let straight = (self.turns[out.index()], out);
        let turned = self.turns.iter().zip(0..).map(|(&turns, dir)| (turns.saturating_add(1), Dir(dir)));
        turned.fold(straight, |best, other| if other.0 < best.0 { other } else { best })
    }
}

/// What stays known of a cell on a cheapest way once its level has passed.
struct Passed {
    /// For each direction in which the cell can be entered, three bits: the direction in which the one before was.
    before: u32,
    /// While its level is to come: its place among the cells of that level.
    place: u32,
}

/// The cells of a cheapest route from `from`, where the field has a level, to a target. The first step is no turn
/// in the directions `facing`.
///
/// Turns are counted from the start on, in falling order of levels (a ring of buckets, as in the wave): no cell is
/// looked at twice. Of passed levels only the directions are kept, eight bytes a cell on a cheapest way, from which
/// the best route is read back.
fn fewest_turns(field: &impl Downhill, from: Cell, facing: &[Dir]) -> Vec<Cell> {
    let (width, height) = field.size();
    let index = |cell: Cell| row_index(cell, width, height).expect("ways stay on the map");
    // Of each cell of the map: its number among those on cheapest ways, counted from 1.
    let mut numbers = vec![0u32; width as usize * height as usize];
    let mut passed: Vec<Passed> = Vec::new();
    let buckets = field.dearest_step() as usize + 1;
    let mut ring: Vec<Vec<Entry>> = (0..buckets).map(|_| Vec::new()).collect();
    let mut start = Entry { cell: from, turns: [NO_WAY; 6] };
    for dir in facing {
        start.turns[dir.index()] = 0;
    }
    let mut level = field.level(from).unwrap_or_default() as usize;
    ring[level % buckets].push(start);
    // Every step costs something, so that a target, at level 0, comes last.
    while level > 0 {
        for entry in std::mem::take(&mut ring[level % buckets]) {
            for dir in field.nearer(entry.cell) {
                let cell = field.lattice().neighbour(entry.cell, dir);
                let bucket = &mut ring[field.level(cell).unwrap_or_default() as usize % buckets];
                let number = &mut numbers[index(cell)];
                if *number == 0 {
                    passed.push(Passed { before: 0, place: bucket.len() as u32 });
                    *number = passed.len() as u32;
                    bucket.push(Entry { cell, turns: [NO_WAY; 6] });
                }
                let known = &mut passed[*number as usize - 1];
                let (turns, entered) = entry.leave(dir);
                let best = &mut bucket[known.place as usize].turns[dir.index()];
                if turns < *best {
                    *best = turns;
                    known.before = known.before & !(7 << (3 * dir.0)) | u32::from(entered.0) << (3 * dir.0);
                }
            }
        }
        level -= 1;
    }
    // Of several targets the one that takes the fewest turns.
    let ends = ring[0]
        .iter()
        .flat_map(|end| end.turns.iter().zip(0..).map(move |(turns, dir)| (turns, dir, end.cell)));
    let best = ends.min_by_key(|&(turns, dir, _)| (*turns, dir));
    let (mut cell, mut dir) = best.map_or((from, Dir(0)), |(_, dir, cell)| (cell, Dir(dir)));
    let mut cells = vec![cell];
    while cell != from {
        let known = &passed[numbers[index(cell)] as usize - 1];
        cell = field.lattice().neighbour(cell, field.lattice().opposite(dir));
        dir = Dir((known.before >> (3 * dir.0) & 7) as u8);
        cells.push(cell);
    }
    cells.reverse();
    cells
}
