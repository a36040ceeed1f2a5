//! Among the shortest routes one with the fewest turns.

use crate::lattice::{Cell, Dir};
use crate::wave::Field;

const NO_WAY: u32 = u32::MAX;

/// A cell on some shortest route, and for each direction the fewest turns with which it can be entered so.
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

/// For each direction in which a cell can be entered, three bits: the direction in which the cell before it was.
#[derive(Clone, Copy, Default)]
struct Before(u32);

impl Before {
    fn get(self, dir: Dir) -> Dir {
        Dir((self.0 >> (3 * dir.0) & 7) as u8)
    }

    fn set(&mut self, dir: Dir, before: Dir) {
        self.0 = self.0 & !(7 << (3 * dir.0)) | u32::from(before.0) << (3 * dir.0);
    }
}

/// The cells of a shortest route from `from`, which the wave reached, to the nearest target. The first step is no
/// turn in the directions `facing`.
///
/// All shortest routes cross the same layers of cells, one step nearer to the target each; the turns are counted
/// layer by layer, then the best route is read back from the target. Kept are four bytes a cell, and
/// four more for each cell that lies on a shortest route.
pub(super) fn fewest_turns(field: &Field, from: Cell, facing: &[Dir]) -> Vec<Cell> {
    let lattice = field.lattice();
    let mut start = Entry { cell: from, turns: [NO_WAY; 6] };
    for dir in facing {
        start.turns[dir.index()] = 0;
    }
    let mut layer = vec![start];
    // Of a cell on a shortest route: its place in `before`, counted from 1.
    let mut places = vec![0u32; field.cells()];
    let mut before: Vec<Before> = Vec::new();
    while field.steps(layer[0].cell) != Some(0) {
        layer = next_layer(field, &layer, &mut places, &mut before);
    }

    // Of several targets the one that takes the fewest turns.
    let ends = layer
        .iter()
        .flat_map(|entry| entry.turns.iter().zip(0..).map(move |(turns, dir)| (turns, dir, entry)));
    let best = ends.min_by_key(|&(turns, dir, _)| (*turns, dir));
    let (mut cell, mut dir) = best.map_or((from, Dir(0)), |(_, dir, entry)| (entry.cell, Dir(dir)));
    let mut cells = vec![cell];
    while cell != from {
        let place = field.index(cell).map_or(0, |index| places[index]);
        let entered = before[place as usize - 1].get(dir);
        cell = lattice.neighbour(cell, lattice.opposite(dir));
        cells.push(cell);
        dir = entered;
    }
    cells.reverse();
    cells
}

fn next_layer(field: &Field, layer: &[Entry], places: &mut [u32], before: &mut Vec<Before>) -> Vec<Entry> {
    let lattice = field.lattice();
    let first_place = before.len();
    let mut next: Vec<Entry> = Vec::with_capacity(layer.len() + 1);
    for entry in layer {
        for dir in field.nearer(entry.cell) {
            let cell = lattice.neighbour(entry.cell, dir);
            let place = &mut places[field.index(cell).expect("the wave stays on the map")];
            if *place == 0 {
                next.push(Entry { cell, turns: [NO_WAY; 6] });
                before.push(Before::default());
                *place = before.len() as u32;
            }
            let (turns, entered) = entry.leave(dir);
            let known = &mut next[*place as usize - 1 - first_place].turns[dir.index()];
            if turns < *known {
                *known = turns;
                before[*place as usize - 1].set(dir, entered);
            }
        }
    }
    next
}
