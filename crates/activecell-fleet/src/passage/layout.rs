//! Where the cells of a map lie in a plane of bits.

use crate::floor::Floor;
use activecell::{Cell, Dir, Lattice};

/// The layout of a plane: rows one after the other, with one bit between them that belongs to no cell, so that a move to a
/// neighbour is the same shift for all cells of a row's parity.
#[derive(Debug, Clone)]
pub struct Layout {
    lattice: Lattice,
    /// Bits from a cell to the one below it.
    stride: u32,
    height: u32,
    /// Words before the first cell; as many come after the last, so that shifts read inside the plane.
    margin: usize,
    words: usize,
}

/// A move of all cells of a plane at once: of all rows on squares, of the even or the odd rows on hexagons.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Shift {
    pub(super) dir: Dir,
    /// The bits from a cell to where it moves.
    pub(super) bits: i32,
    /// The parity of the rows in which the moves end, where it matters.
    pub(super) rows: Option<u32>,
}

impl Layout {
    /// The layout for a floor.
    pub fn new(floor: &Floor) -> Self {
        let map = floor.map();
        let stride = map.width() + 1;
        let margin = stride as usize / 64 + 2;
        let bits = stride as usize * map.height() as usize;
        Self {
            lattice: map.lattice(),
            stride,
            height: map.height(),
            margin,
            words: bits.div_ceil(64) + 2 * margin,
        }
    }

    /// The lattice of the floor.
    pub const fn lattice(&self) -> Lattice {
        self.lattice
    }

    /// The words of a plane.
    pub const fn words(&self) -> usize {
        self.words
    }

    /// The bit of a cell.
    #[inline]
    pub const fn bit(&self, cell: Cell) -> u32 {
        64 * self.margin as u32 + cell.y as u32 * self.stride + cell.x as u32
    }

    /// The cell of a bit.
    #[inline]
    pub const fn cell(&self, bit: u32) -> Cell {
        let at = bit - 64 * self.margin as u32;
        Cell::new((at % self.stride) as i32, (at / self.stride) as i32)
    }

    /// The bits from a cell to the neighbour in a direction.
    #[inline]
    pub const fn ahead(&self, bit: u32, dir: Dir) -> i32 {
        let (cell, next) = (self.cell(bit), self.lattice.neighbour(self.cell(bit), dir));
        (next.y - cell.y) * self.stride as i32 + next.x - cell.x
    }

    /// The words in which the rows from `first` to `last` lie; rows outside the map count for nothing.
    pub(super) fn rows(&self, first: i32, last: i32) -> std::ops::Range<usize> {
        let row = |y: i32| y.clamp(0, self.height as i32) as usize * self.stride as usize;
        let (from, to) = (row(first), row(last.saturating_add(1)));
        self.margin + from / 64..self.margin + to.div_ceil(64)
    }

    /// All moves to neighbours, as shifts.
    pub(super) fn shifts(&self) -> Vec<Shift> {
        let even = Cell::new(1, 2);
        let odd = Cell::new(1, 3);
        let shift = |dir: Dir, from: Cell, parity: bool| {
            let to = self.lattice.neighbour(from, dir);
            let bits = (to.y - from.y) * self.stride as i32 + to.x - from.x;
            Shift { dir, bits, rows: parity.then_some(to.y as u32 % 2) }
        };
        let mut shifts = Vec::new();
        for dir in self.lattice.dirs() {
            let [a, b] = [shift(dir, even, true), shift(dir, odd, true)];
            if a.bits == b.bits {
                shifts.push(Shift { rows: None, ..a });
            } else {
                shifts.extend([a, b]);
            }
        }
        shifts
    }

    /// The words that a move to a neighbour can cross.
    pub(super) const fn reach(&self) -> usize {
        self.margin - 1
    }

    /// The cells of the rows of a parity.
    pub(super) fn parity(&self, parity: u32) -> Vec<u64> {
        let (width, height) = (self.stride as i32 - 1, self.height as i32);
        let rows = (0..height).filter(|y| *y as u32 % 2 == parity);
        self.plane(rows.flat_map(|y| (0..width).map(move |x| Cell::new(x, y))))
    }

    /// A plane with the bits of these cells.
    pub(super) fn plane(&self, cells: impl Iterator<Item = Cell>) -> Vec<u64> {
        let mut plane = vec![0; self.words];
        for bit in cells.map(|cell| self.bit(cell)) {
            plane[bit as usize / 64] |= 1 << (bit % 64);
        }
        plane
    }
}
