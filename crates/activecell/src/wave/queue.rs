//! Full fields by a plain queue: cell by cell, in the order in which the wave reaches them.

use crate::lattice::{Cell, Lattice};
use crate::map::Map;

/// Not reached, or an obstacle.
const NEVER: u32 = u32::MAX;
/// An obstacle while the wave runs.
const WALL: u32 = NEVER - 1;

/// The distances of a map, row by row, in a frame of obstacles.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Rows {
    stride: usize,
    steps: Vec<u32>,
}

impl Rows {
    /// The steps of a cell of the map; `None` where the wave did not come.
    #[inline]
    pub(super) fn steps(&self, x: u32, y: u32) -> Option<u32> {
        let steps = self.steps[(y as usize + 1) * self.stride + x as usize + 1];
        (steps < WALL).then_some(steps)
    }
}

/// Floods the map from all `targets`.
pub(super) fn flood(map: &Map, targets: &[Cell]) -> Rows {
    let stride = map.width() as usize + 2;
    let mut steps = vec![WALL; stride * (map.height() as usize + 2)];
    let index = |cell: Cell| (cell.y as usize + 1) * stride + cell.x as usize + 1;
    for y in 0..map.height() {
        let row = &mut steps[(y as usize + 1) * stride + 1..][..map.width() as usize];
        for (words, cells) in map.obstacles().row(y).iter().zip(row.chunks_mut(64)) {
            for (i, cell) in cells.iter_mut().enumerate() {
                *cell = NEVER - (words >> i & 1) as u32;
            }
        }
    }
    let mut queue = Queue { cells: vec![0; map.free_cells() + 1], end: 0 };
    for &target in targets {
        // A target may be named twice.
        if std::mem::replace(&mut steps[index(target)], 0) == NEVER {
            queue.cells[queue.end] = index(target) as u32;
            queue.end += 1;
        }
    }
    let row = stride as isize;
    match map.lattice() {
        Lattice::Square => spread(&mut steps, &mut queue, |_| [-row, row, -1, 1]),
        Lattice::Hex => spread(&mut steps, &mut queue, |cell| {
            // The frame adds a row: odd rows of the map are even here, and their slanted neighbours lie right.
            let right = isize::from((cell / stride).is_multiple_of(2));
            [-1, 1, right - 1 - row, right - row, right - 1 + row, right + row]
        }),
    }
    Rows { stride, steps }
}

/// Cells that were reached, in order; a place for each free cell.
struct Queue {
    cells: Vec<u32>,
    end: usize,
}

fn spread<const N: usize>(steps: &mut [u32], queue: &mut Queue, neighbours: impl Fn(usize) -> [isize; N]) {
    let mut begin = 0;
    while begin < queue.end {
        let cell = queue.cells[begin] as usize;
        begin += 1;
        let next = steps[cell] + 1;
        for offset in neighbours(cell) {
            let other = cell.wrapping_add_signed(offset);
            // Without a branch: mazes and clutter would mispredict it.
            let new = steps[other] == NEVER;
            steps[other] = if new { next } else { steps[other] };
            queue.cells[queue.end] = other as u32;
            queue.end += usize::from(new);
        }
    }
}
