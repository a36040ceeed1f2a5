//! Full fields by a plain queue: cell by cell, in the order in which the wave reaches them.

use super::padded::{NEVER, Padded};
use crate::lattice::{Cell, Lattice};
use crate::map::Map;

/// The distances of a map, row by row, in a frame of obstacles.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Rows {
    pub(super) padded: Padded,
    /// Steps + 1.
    pub(super) values: Vec<u32>,
}

impl Rows {
    /// The steps of a cell; `None` where the wave did not come, and outside the map.
    #[inline]
    pub(super) fn steps(&self, cell: Cell) -> Option<u32> {
        let value = self.values[self.padded.place(cell)?];
        (value != NEVER).then(|| value.checked_sub(1)).flatten()
    }
}

/// Floods the map from all `targets`; one that lies in an obstacle is left out.
pub(super) fn flood(map: &Map, targets: &[Cell]) -> Rows {
    let padded = Padded::new(map);
    let mut values = padded.blank(map);
    let mut queue = Queue { cells: vec![0; map.free_cells() + 1], end: 0 };
    for place in targets.iter().filter_map(|&target| padded.place(target)) {
        // A target may be named twice.
        if values[place] == NEVER {
            values[place] = 1;
            queue.cells[queue.end] = place as u32;
            queue.end += 1;
        }
    }
    match map.lattice() {
        Lattice::Square => spread::<4>(&padded, &mut values, &mut queue),
        Lattice::Hex => spread::<6>(&padded, &mut values, &mut queue),
    }
    Rows { padded, values }
}

/// Cells that were reached, in order; a place for each free cell.
struct Queue {
    cells: Vec<u32>,
    end: usize,
}

fn spread<const N: usize>(padded: &Padded, values: &mut [u32], queue: &mut Queue) {
    let mut begin = 0;
    while begin < queue.end {
        let place = queue.cells[begin] as usize;
        begin += 1;
        let next = values[place] + 1;
        for other in padded.around::<N>(place) {
            // Without a branch: mazes and clutter would mispredict it.
            let new = values[other] == NEVER;
            values[other] = if new { next } else { values[other] };
            queue.cells[queue.end] = other as u32;
            queue.end += usize::from(new);
        }
    }
}
