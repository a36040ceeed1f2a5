//! Where the cells of a map lie in a plane of bits.

use crate::floor::Floor;
use activecell::{Cell, Lattice};

/// The layout of a plane: rows one after the other, with one bit between them that belongs to no cell, so that a move to a
/// neighbour is the same shift for all cells of a row's parity.
///
/// Of two neighbours the one with the higher bit names the edge between them. Edges have kinds, a plane each: within a row,
/// `stride` apart, and on hexagons one more or one less than that.
#[derive(Debug, Clone)]
pub struct Layout {
    lattice: Lattice,
    /// Bits from a cell to the one below it.
    stride: u32,
    height: u32,
    /// Words before the first cell; as many come after the last, so that shifts read inside the plane.
    margin: usize,
    words: usize,
    /// The cells of the odd rows; only hexagons ask.
    odd: Vec<u64>,
}

impl Layout {
    /// The layout for a floor.
    pub fn new(floor: &Floor) -> Self {
        let map = floor.map();
        let stride = map.width() + 1;
        let margin = stride as usize / 64 + 2;
        let words = (stride as usize * map.height() as usize).div_ceil(64) + 2 * margin;
        let (lattice, height) = (map.lattice(), map.height());
        let mut layout = Self { lattice, stride, height, margin, words, odd: Vec::new() };
        if lattice == Lattice::Hex {
            layout.odd = layout.parity(1);
        }
        layout
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

    /// The bits around one, those that stand for cells and others; as many as there are directions.
    #[inline]
    pub(super) fn around(&self, bit: u32) -> impl Iterator<Item = u32> {
        let stride = self.stride as i32;
        let is_odd = self.odd.get(bit as usize / 64).is_some_and(|word| word >> (bit % 64) & 1 == 1);
        let slant = if is_odd { 1 } else { -1 };
        let offsets = [1, -1, stride, -stride, stride + slant, -stride + slant];
        let degree = usize::from(self.lattice.degree());
        offsets.into_iter().take(degree).map(move |offset| bit.wrapping_add_signed(offset))
    }

    /// How many kinds of edges there are.
    pub(super) const fn edges(&self) -> usize {
        self.lattice.degree() as usize / 2
    }

    /// The kind of the edge between two neighbours, and the bit that names it.
    #[inline]
    pub(super) const fn edge(&self, a: u32, b: u32) -> (usize, u32) {
        let kind = match a.abs_diff(b) {
            1 => 0,
            apart if apart == self.stride => 1,
            _ => 2,
        };
        (kind, if a > b { a } else { b })
    }

    /// Bits from a cell to the one below it.
    pub(super) const fn stride(&self) -> u32 {
        self.stride
    }

    /// The words in which the rows from `first` to `last` lie; rows outside the map count for nothing.
    pub(super) fn rows(&self, first: i32, last: i32) -> std::ops::Range<usize> {
        let row = |y: i32| y.clamp(0, self.height as i32) as usize * self.stride as usize;
        let (from, to) = (row(first), row(last.saturating_add(1)));
        self.margin + from / 64..self.margin + to.div_ceil(64)
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
