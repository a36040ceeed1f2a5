//! Where the cells of a map lie in a plane of bits.

use crate::floor::Floor;
use activecell::{Cell, Lattice};
use std::ops::Range;

/// The layout of a plane: the map in strips of 64 columns from west to east, each with its rows from top to bottom, a word a
/// row. Words above and below each strip belong to no cell. So cells one above the other are in neighbouring words,
/// and the cells around a robot in few of them.
///
/// Edges have kinds, a plane each: within a row, within a column, and on hexagons those that are slanted in the plane. An
/// edge is named by its eastern or lower cell.
#[derive(Debug, Clone)]
pub struct Layout {
    lattice: Lattice,
    height: u32,
    strips: u32,
}

impl Layout {
    /// The layout for a floor.
    pub fn new(floor: &Floor) -> Self {
        let map = floor.map();
        Self { lattice: map.lattice(), height: map.height(), strips: map.width().div_ceil(64) }
    }

    /// The lattice of the floor.
    pub const fn lattice(&self) -> Lattice {
        self.lattice
    }

    /// The words of a plane.
    pub const fn words(&self) -> usize {
        self.strips as usize * self.strip()
    }

    /// The bit of a cell.
    #[inline]
    pub const fn bit(&self, cell: Cell) -> u32 {
        let (x, y) = (cell.x as u32, cell.y as u32);
        64 * (x / 64 * self.strip() as u32 + y + 1) + x % 64
    }

    /// The cell of a bit.
    #[inline]
    pub const fn cell(&self, bit: u32) -> Cell {
        let (word, strip) = (bit / 64, self.strip() as u32);
        Cell::new((word / strip * 64 + bit % 64) as i32, (word % strip) as i32 - 1)
    }

    pub(super) const fn strips(&self) -> usize {
        self.strips as usize
    }

    /// The words of a strip.
    pub(super) const fn strip(&self) -> usize {
        self.height as usize + 2
    }

    /// The bits around one, those that stand for cells and others; as many as there are directions.
    #[inline]
    pub(super) fn around(&self, bit: u32) -> impl Iterator<Item = u32> {
        let across = self.strip() as u32 * 64 - 63;
        let west = bit.wrapping_sub(if bit.is_multiple_of(64) { across } else { 1 });
        let east = bit.wrapping_add(if bit % 64 == 63 { across } else { 1 });
        // The first row of a strip is odd in words, and even on the map.
        let is_odd = self.lattice == Lattice::Hex && (bit / 64 % self.strip() as u32).is_multiple_of(2);
        let slant = if is_odd { east } else { west };
        let all = [
            west,
            east,
            bit.wrapping_sub(64),
            bit.wrapping_add(64),
            slant.wrapping_sub(64),
            slant.wrapping_add(64),
        ];
        all.into_iter().take(usize::from(self.lattice.degree()))
    }

    /// How many kinds of edges there are.
    pub(super) const fn edges(&self) -> usize {
        self.lattice.degree() as usize / 2
    }

    /// The kind of the edge between two neighbours, and the bit that names it.
    #[inline]
    pub(super) const fn edge(&self, a: u32, b: u32) -> (usize, u32) {
        let (low, high) = if a < b { (a, b) } else { (b, a) };
        let apart = (high / 64 - low / 64) as usize;
        if apart == 0 || apart == self.strip() {
            (0, high)
        } else if apart == 1 {
            (if low % 64 == high % 64 { 1 } else { 2 }, high)
        } else {
            // Slanted, from strip to strip.
            (2, if apart > self.strip() { high } else { low })
        }
    }

    /// The words of a strip with the cells that are at most so many steps from one.
    #[inline]
    pub(super) fn near(&self, strip: usize, cell: Cell, steps: usize) -> Range<usize> {
        let (steps, west) = (steps.min(1 << 24) as i32, 64 * strip as i32);
        let across = (west - cell.x).max(cell.x - west - 63).max(0);
        let first = (strip * self.strip() + 1) as i32;
        if across > steps {
            return first as usize..first as usize;
        }
        let rows = match self.lattice {
            Lattice::Square => steps - across,
            // Two rows lead half a column east or west each.
            Lattice::Hex => steps.min(2 * (steps - across) + 1),
        };
        let from = (cell.y - rows).max(0);
        let to = (cell.y + rows + 1).min(self.height as i32);
        (first + from) as usize..(first + to) as usize
    }

    /// A plane with the bits of these cells.
    pub(super) fn plane(&self, cells: impl Iterator<Item = Cell>) -> Vec<u64> {
        let mut plane = vec![0; self.words()];
        for bit in cells.map(|cell| self.bit(cell)) {
            plane[bit as usize / 64] |= 1 << (bit % 64);
        }
        plane
    }
}
