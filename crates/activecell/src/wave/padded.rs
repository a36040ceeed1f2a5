//! How waves that change cell by cell lie in memory: row after row, with a border of obstacles around the map, so
//! that every cell of the map has all its neighbours and a neighbour is an addition away.

use crate::lattice::{Cell, Lattice};
use crate::map::Map;

/// The value of an obstacle. Values of reached cells count from 1 (the target), so that "greater than" and
/// "one less" leave obstacles out without a test of their own.
pub(super) const OBSTACLE: u32 = 0;

/// The value of a free cell that no wave has reached.
pub(super) const NEVER: u32 = u32::MAX;

/// Places in memory. One column of border serves two rows: the cell right of a row's end is the one left of the
/// next row's begin.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Padded {
    width: u32,
    height: u32,
    stride: usize,
    /// For even and for odd places of rows, how far each neighbour lies away.
    offsets: [[isize; 6]; 2],
}

impl Padded {
    pub(super) fn new(map: &Map) -> Self {
        let stride = map.width() as usize + 1;
        let mut offsets = [[0; 6]; 2];
        for dir in map.lattice().dirs() {
            for (y, row) in offsets.iter_mut().enumerate() {
                // The border above makes row 0 the row at place 1.
                let cell = Cell::new(0, 1 - y as i32);
                let neighbour = map.lattice().neighbour(cell, dir);
                row[dir.index()] =
                    (neighbour.y - cell.y) as isize * stride as isize + (neighbour.x - cell.x) as isize;
            }
        }
        Self { width: map.width(), height: map.height(), stride, offsets }
    }

    /// How many places there are, the border among them.
    pub(super) const fn len(&self) -> usize {
        self.stride * (self.height as usize + 2) + 1
    }

    /// Where the cell lies; `None` outside the map.
    #[inline]
    pub(super) fn place(&self, cell: Cell) -> Option<usize> {
        let (x, y) = (cell.x as u32, cell.y as u32);
        (x < self.width && y < self.height).then(|| (y as usize + 1) * self.stride + x as usize + 1)
    }

    /// The places of the neighbours in the order of their directions; `N` is the lattice's degree.
    #[inline]
    pub(super) fn around<const N: usize>(&self, place: usize) -> [usize; N] {
        let row = if N == usize::from(Lattice::Hex.degree()) { (place / self.stride) & 1 } else { 0 };
        std::array::from_fn(|dir| place.wrapping_add_signed(self.offsets[row][dir]))
    }

    /// Before the wave: [`OBSTACLE`] in obstacles and on the border, [`NEVER`] in free cells.
    pub(super) fn blank(&self, map: &Map) -> Vec<u32> {
        let mut values = vec![OBSTACLE; self.len()];
        for y in 0..self.height {
            let begin = (y as usize + 1) * self.stride + 1;
            let row = values[begin..begin + self.width as usize].chunks_mut(64);
            for (word, cells) in map.obstacles().row(y).iter().zip(row) {
                for (i, value) in cells.iter_mut().enumerate() {
                    // One more than NEVER is OBSTACLE.
                    *value = NEVER.wrapping_add((word >> i & 1) as u32);
                }
            }
        }
        values
    }
}
