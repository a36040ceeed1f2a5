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

/// The cells of a shortest route from `from`, which the wave reached, to the target.
///
/// All shortest routes cross the same layers of cells, one step nearer to the target each; the turns are counted
/// layer by layer, then the best route is read back from the target.
pub(super) fn fewest_turns(field: &Field, from: Cell) -> Vec<Cell> {
    let lattice = field.lattice();
    let mut layers = vec![vec![Entry { cell: from, turns: [0; 6] }]];
    let mut slots = vec![0; field.cells()];
    while let Some(layer) = layers.last().filter(|layer| field.steps(layer[0].cell) != Some(0)) {
        layers.push(next_layer(field, layer, &mut slots));
    }

    // Of several targets the one that takes the fewest turns.
    let least = |entry: &Entry| entry.turns.iter().copied().min();
    let last = layers.last().and_then(|layer| layer.iter().min_by_key(|entry| least(entry)));
    let mut cell = last.map_or(from, |entry| entry.cell);
    let mut cells = vec![cell];
    let mut entered = None;
    for pair in layers.windows(2).rev() {
        let find = |layer: &[Entry], cell| layer.iter().position(|entry| entry.cell == cell);
        let here = &pair[1][find(&pair[1], cell).expect("the cell was put in this layer")];
        let dir = entered.unwrap_or_else(|| {
            let fewest = here.turns.iter().zip(0..).min().map_or(0, |(_, dir)| dir);
            Dir(fewest)
        });
        cell = lattice.neighbour(cell, lattice.opposite(dir));
        let before = &pair[0][find(&pair[0], cell).expect("a cell is entered from the layer before")];
        entered = Some(before.leave(dir).1);
        cells.push(cell);
    }
    cells.reverse();
    cells
}

/// `slots` holds, for each cell of the map, its place in its layer, counted from 1; 0 before it has one.
fn next_layer(field: &Field, layer: &[Entry], slots: &mut [u32]) -> Vec<Entry> {
    let lattice = field.lattice();
    let mut next: Vec<Entry> = Vec::with_capacity(layer.len() + 1);
    for entry in layer {
        for dir in field.nearer(entry.cell) {
            let cell = lattice.neighbour(entry.cell, dir);
            let slot = &mut slots[field.index(cell).expect("the wave stays on the map")];
            if *slot == 0 {
                next.push(Entry { cell, turns: [NO_WAY; 6] });
                *slot = next.len() as u32;
            }
            let turns = &mut next[*slot as usize - 1].turns[dir.index()];
            *turns = (*turns).min(entry.leave(dir).0);
        }
    }
    next
}
