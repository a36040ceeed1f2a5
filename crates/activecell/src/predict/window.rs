//! The part of the map that a robot can reach within its foresight: a word a row.

use crate::lattice::{Cell, Dir, Lattice};
use crate::map::Map;

/// The rows of a window, a bit a cell.
pub(super) type Rows = Vec<u64>;

/// The farthest that a window can reach to each side of its centre: 2 × 31 + 1 columns fit into a word.
pub(super) const FARTHEST: u8 = 31;

/// A square of cells around the robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Window {
    pub(super) lattice: Lattice,
    /// The upper left cell.
    corner: Cell,
    side: i32,
}

impl Window {
    pub(super) fn around(lattice: Lattice, cell: Cell, reach: u8) -> Self {
        let reach = i32::from(reach.min(FARTHEST));
        Self { lattice, corner: Cell::new(cell.x - reach, cell.y - reach), side: 2 * reach + 1 }
    }

    pub(super) fn empty(&self) -> Rows {
        vec![0; self.side as usize]
    }

    /// The row and the bit of a cell.
    pub(super) fn place(&self, cell: Cell) -> Option<(usize, u64)> {
        let (x, y) = (cell.x.checked_sub(self.corner.x)?, cell.y.checked_sub(self.corner.y)?);
        ((0..self.side).contains(&x) && (0..self.side).contains(&y)).then(|| (y as usize, 1 << x))
    }

    pub(super) fn only(&self, cell: Cell) -> Rows {
        let mut rows = self.empty();
        self.set(&mut rows, cell);
        rows
    }

    pub(super) fn has(&self, rows: &[u64], cell: Cell) -> bool {
        self.place(cell).is_some_and(|(y, bit)| rows[y] & bit != 0)
    }

    pub(super) fn set(&self, rows: &mut [u64], cell: Cell) {
        if let Some((y, bit)) = self.place(cell) {
            rows[y] |= bit;
        }
    }

    /// The cells whose bits are 1.
    pub(super) fn cells<'a>(&'a self, rows: &'a [u64]) -> impl Iterator<Item = Cell> + 'a {
        rows.iter().zip(self.corner.y..).flat_map(move |(&row, y)| {
            let mut rest = row;
            std::iter::from_fn(move || {
                let x = (rest != 0).then(|| rest.trailing_zeros())?;
                rest &= rest - 1;
                Some(Cell::new(self.corner.x + x as i32, y))
            })
        })
    }

    /// Where a robot may stand.
    pub(super) fn free(&self, map: &Map) -> Rows {
        let mut rows = self.empty();
        for (y, row) in rows.iter_mut().enumerate() {
            for x in 0..self.side {
                let cell = Cell::new(self.corner.x + x, self.corner.y + y as i32);
                *row |= u64::from(map.is_free(cell)) << x;
            }
        }
        rows
    }

    /// All these cells, one step in a direction; what leaves the window is lost.
    pub(super) fn moved(&self, rows: &[u64], dir: Dir) -> Rows {
        let mut moved = self.empty();
        let inside = !0 >> (64 - self.side);
        for (y, &row) in rows.iter().enumerate() {
            let from = Cell::new(0, self.corner.y + y as i32);
            let to = self.lattice.neighbour(from, dir);
            let there = y as i32 + to.y - from.y;
            if (0..self.side).contains(&there) {
                let shifted = match to.x {
                    0 => row,
                    1 => row << 1,
                    _ => row >> 1,
                };
                moved[there as usize] |= shifted & inside;
            }
        }
        moved
    }

    /// What another window's rows say about this window's cells; cells that it does not hold get ones.
    pub(super) fn seen_through(&self, other: &Self, rows: &[u64]) -> Rows {
        let mut seen = self.empty();
        for (y, row) in seen.iter_mut().enumerate() {
            for x in 0..self.side {
                let cell = Cell::new(self.corner.x + x, self.corner.y + y as i32);
                let set = other.place(cell).is_none_or(|(y, bit)| rows[y] & bit != 0);
                *row |= u64::from(set) << x;
            }
        }
        seen
    }
}

/// The cells that are in both.
pub(super) fn both(a: &[u64], b: &[u64]) -> Rows {
    a.iter().zip(b).map(|(a, b)| a & b).collect()
}

/// The cells of the first that are not in the second.
pub(super) fn without(a: &[u64], b: &[u64]) -> Rows {
    a.iter().zip(b).map(|(a, b)| a & !b).collect()
}

/// Adds the cells of the second to the first.
pub(super) fn add(a: &mut [u64], b: &[u64]) {
    a.iter_mut().zip(b).for_each(|(a, b)| *a |= b);
}
