//! Tiles: 8 × 8 cells in a word, bit `8 · (y % 8) + x % 8`, with one empty tile around the map.

use crate::lattice::Cell;
use crate::map::Map;

/// How tiles are numbered, as [`crate::wave::each_free`] does.
#[derive(Debug, Clone, Copy)]
pub(super) struct Grid {
    /// Tiles from one row of tiles to the next.
    pub(super) stride: usize,
    /// Tiles in all, the empty ones around the map with them.
    pub(super) len: usize,
}

impl Grid {
    pub(super) fn new(map: &Map) -> Self {
        let stride = map.width().div_ceil(8) as usize + 2;
        Self { stride, len: stride * (map.height().div_ceil(8) as usize + 2) }
    }

    /// The number of the cell's tile and the cell's bit. The column -1 and the row -1 lie in empty tiles.
    #[inline]
    pub(super) fn locate(self, cell: Cell) -> (usize, u32) {
        let (x, y) = ((cell.x + 8) as usize, (cell.y + 8) as usize);
        (y / 8 * self.stride + x / 8, (y % 8 * 8 + x % 8) as u32)
    }
}

/// A list of tiles, each at most once, that grows without a branch: where tiles come in no foreseeable order a
/// branch costs more than a write that may be in vain.
#[derive(Debug, Clone)]
pub(super) struct List {
    items: Vec<u32>,
    len: usize,
}

impl List {
    /// A list with room for all tiles.
    pub(super) fn new(grid: Grid) -> Self {
        Self::with_room(grid.len + 1)
    }

    /// A list with room for so many tiles; [`make_room`](Self::make_room) gives it more.
    pub(super) fn with_room(tiles: usize) -> Self {
        Self { items: vec![0; tiles], len: 0 }
    }

    /// Sees to it that as many tiles may be put, wanted or not.
    #[inline]
    pub(super) fn make_room(&mut self, tiles: usize) {
        if self.len + tiles > self.items.len() {
            self.items.resize(self.len + tiles + self.items.len() / 4, 0);
        }
    }

    /// Appends a tile if it is `wanted`.
    #[inline]
    pub(super) fn put(&mut self, tile: usize, wanted: bool) {
        self.items[self.len] = tile as u32;
        self.len += usize::from(wanted);
    }

    #[inline]
    pub(super) fn pop(&mut self) -> Option<usize> {
        self.len = self.len.checked_sub(1)?;
        Some(self.items[self.len] as usize)
    }

    #[inline]
    pub(super) fn get(&self, i: usize) -> usize {
        self.items[i] as usize
    }

    pub(super) fn tiles(&self) -> impl Iterator<Item = usize> + '_ {
        self.items[..self.len].iter().map(|&tile| tile as usize)
    }

    pub(super) const fn len(&self) -> usize {
        self.len
    }

    pub(super) const fn clear(&mut self) {
        self.len = 0;
    }

    pub(super) const fn bytes(&self) -> usize {
        self.items.capacity() * 4
    }
}
