//! The wave on bits: 8 × 8 cells in a word, and a queue of the words in which the wave's front stands.
//!
//! One step of the automaton shifts the front of a word by a cell to each side, for its 64 cells at once. Only words
//! that hold a part of the front are visited, so a step costs what the front is long, not what the map is large.
//! Rows of the map instead of square tiles would be visited once a cell: on a lattice a front runs diagonally, and
//! cuts a row in one place only.
//!
//! Source: bit-parallel breadth-first search is folklore of the four-colour board games (*kogge-stone* and *dumb7*
//! fills, Chess Programming Wiki, "Fill Algorithms"); the labels modulo a small number are those of Akers, *A
//! Modification of Lee's Path Connection Algorithm*, 1967.

use crate::lattice::{Cell, Lattice};
use crate::map::Map;

/// Column 0 of a tile; bit `8 · row + column` is a cell.
pub(crate) const WEST: u64 = 0x0101_0101_0101_0101;
/// Column 7.
pub(crate) const EAST: u64 = WEST << 7;
/// The even rows; the rows of a tile have the parity of the map's rows.
const EVEN: u64 = 0x00ff_00ff_00ff_00ff;

/// Sixty-four cells.
#[derive(Debug, Clone, Copy, Default)]
struct Tile {
    /// Free, and not yet reached.
    open: u64,
    /// Reached in this step and in the next, in turn.
    front: [u64; 2],
    /// What the caller wants to know of each reached cell: two bits that follow from its step.
    labels: [u64; 2],
}

/// The map as tiles, with a rim of tiles without a free cell so that every tile has neighbours.
pub(super) struct Tiles {
    lattice: Lattice,
    width: usize,
    height: usize,
    /// Tiles in a row, the rim included.
    across: usize,
    words: Vec<Tile>,
}

/// What [`Tiles::rows`] reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Plane {
    /// Free cells that the wave did not reach.
    Open,
    /// The first label.
    Low,
    /// The second label.
    High,
}

impl Tiles {
    pub(super) fn new(map: &Map) -> Self {
        let (width, height) = (map.width() as usize, map.height() as usize);
        let across = width.div_ceil(8) + 2;
        let words = vec![Tile::default(); across * (height.div_ceil(8) + 2)];
        let mut grid = Self { lattice: map.lattice(), width, height, across, words };
        each_free(map, |tile, open| grid.words[tile].open = open);
        grid
    }

    /// The number of the tile that holds a cell.
    fn tile(&self, x: usize, y: usize) -> usize {
        (y / 8 + 1) * self.across + x / 8 + 1
    }

    /// Spreads the wave from all `targets` at once. A cell reached in step `s` gets the bits of `label(s)`.
    pub(super) fn flood(&mut self, targets: &[Cell], label: impl Fn(u32) -> u8) {
        let mut rim = Vec::new();
        for target in targets {
            let (x, y) = (target.x as usize, target.y as usize);
            let tile = self.tile(x, y);
            reach::<1>(&mut self.words, tile, 1 << (y % 8 * 8 + x % 8), &mut rim);
        }
        let mut next = Vec::new();
        let mut step = 0;
        while !rim.is_empty() {
            let bits = label(step);
            match (self.lattice, step % 2) {
                (Lattice::Square, 0) => square::<0>(&mut self.words, self.across, &rim, bits, &mut next),
                (Lattice::Square, _) => square::<1>(&mut self.words, self.across, &rim, bits, &mut next),
                (Lattice::Hex, 0) => hex::<0>(&mut self.words, self.across, &rim, bits, &mut next),
                (Lattice::Hex, _) => hex::<1>(&mut self.words, self.across, &rim, bits, &mut next),
            }
            rim.clear();
            std::mem::swap(&mut rim, &mut next);
            step += 1;
        }
    }

    /// Calls `sink` with each row of a plane, from the top: its number and its words, in the form of
    /// [`crate::BitPlane::row`].
    pub(super) fn rows(&self, plane: Plane, mut sink: impl FnMut(usize, &[u64])) {
        let words = self.width.div_ceil(64);
        let mut buffer = vec![0; 8 * words];
        for top in (0..self.height).step_by(8) {
            for word in 0..words {
                let first = self.tile(word * 64, top);
                let count = (self.across - 1).saturating_sub(1 + word * 8).min(8);
                let mut square = [0; 8];
                for (tile, bits) in self.words[first..first + count].iter().zip(&mut square) {
                    *bits = match plane {
                        Plane::Open => tile.open,
                        Plane::Low => tile.labels[0],
                        Plane::High => tile.labels[1],
                    };
                }
                transpose(&mut square);
                for (row, bits) in square.into_iter().enumerate() {
                    buffer[row * words + word] = bits;
                }
            }
            for (y, row) in (top..self.height.min(top + 8)).zip(buffer.chunks_exact(words)) {
                sink(y, row);
            }
        }
    }
}

/// Calls `put` with the number of each tile of the map and its free cells. Tiles are numbered row by row, with a rim of
/// one tile around the map.
pub(crate) fn each_free(map: &Map, mut put: impl FnMut(usize, u64)) {
    let (width, height) = (map.width() as usize, map.height() as usize);
    let across = width.div_ceil(8) + 2;
    let last = u64::MAX >> ((64 - width % 64) % 64);
    for top in (0..height).step_by(8) {
        for word in 0..width.div_ceil(64) {
            let inside = if (word + 1) * 64 > width { last } else { u64::MAX };
            let mut square = [0; 8];
            for (y, row) in (top..height).zip(&mut square) {
                *row = !map.obstacles().row(y as u32)[word] & inside;
            }
            transpose(&mut square);
            let first = (top / 8 + 1) * across + word * 8 + 1;
            let count = (across - 1).saturating_sub(1 + word * 8).min(8);
            for (tile, open) in (first..first + count).zip(square) {
                put(tile, open);
            }
        }
    }
}

/// Reaches those of the cells `bits` of a tile that are open.
#[inline]
fn reach<const NOW: usize>(tiles: &mut [Tile], tile: usize, bits: u64, next: &mut Vec<u32>) {
    let there = &mut tiles[tile];
    let new = bits & there.open;
    if new != 0 {
        there.open ^= new;
        if there.front[1 - NOW] == 0 {
            next.push(tile as u32);
        }
        there.front[1 - NOW] |= new;
    }
}

/// Takes the front out of a tile and labels its cells.
#[inline]
fn take<const NOW: usize>(tiles: &mut [Tile], tile: usize, label: u8) -> u64 {
    let here = &mut tiles[tile];
    let front = std::mem::take(&mut here.front[NOW]);
    if label & 1 != 0 {
        here.labels[0] |= front;
    }
    if label & 2 != 0 {
        here.labels[1] |= front;
    }
    front
}

/// One step on squares.
fn square<const NOW: usize>(tiles: &mut [Tile], across: usize, rim: &[u32], label: u8, next: &mut Vec<u32>) {
    for &tile in rim {
        let tile = tile as usize;
        let front = take::<NOW>(tiles, tile, label);
        let inside = (front & !EAST) << 1 | (front & !WEST) >> 1 | front << 8 | front >> 8;
        reach::<NOW>(tiles, tile, inside, next);
        reach::<NOW>(tiles, tile - across, front << 56, next);
        reach::<NOW>(tiles, tile + across, front >> 56, next);
        reach::<NOW>(tiles, tile - 1, (front & WEST) << 7, next);
        reach::<NOW>(tiles, tile + 1, (front & EAST) >> 7, next);
    }
}

/// One step on hexagons. The cells above and below are in columns x − 1 and x of even rows, x and x + 1 of odd ones.
fn hex<const NOW: usize>(tiles: &mut [Tile], across: usize, rim: &[u32], label: u8, next: &mut Vec<u32>) {
    for &tile in rim {
        let tile = tile as usize;
        let front = take::<NOW>(tiles, tile, label);
        let (east, west) = ((front & !EAST) << 1, (front & !WEST) >> 1);
        // Columns that the front touches in the rows above and below.
        let beside = front | west & EVEN | east & !EVEN;
        reach::<NOW>(tiles, tile, east | west | beside << 8 | beside >> 8, next);
        reach::<NOW>(tiles, tile - across, beside << 56, next);
        reach::<NOW>(tiles, tile + across, beside >> 56, next);
        if front & WEST != 0 {
            let out = (front & WEST) << 7;
            let slanted = out & EVEN;
            reach::<NOW>(tiles, tile - 1, out | slanted << 8 | slanted >> 8, next);
            // Row 0 is even: its western end touches the tile above and to the left.
            reach::<NOW>(tiles, tile - across - 1, front << 63, next);
        }
        if front & EAST != 0 {
            let out = (front & EAST) >> 7;
            let slanted = out & !EVEN;
            reach::<NOW>(tiles, tile + 1, out | slanted << 8 | slanted >> 8, next);
            // Row 7 is odd: its eastern end touches the tile below and to the right.
            reach::<NOW>(tiles, tile + across + 1, front >> 63, next);
        }
    }
}

/// Eight words of eight bytes each, transposed: from eight rows of 64 cells to eight tiles, or back.
fn transpose(words: &mut [u64; 8]) {
    const STAGES: [(usize, u64); 3] =
        [(4, 0x0000_0000_ffff_ffff), (2, 0x0000_ffff_0000_ffff), (1, 0x00ff_00ff_00ff_00ff)];
    for (distance, low) in STAGES {
        for i in (0..8).filter(|i| i & distance == 0) {
            let shift = distance as u32 * 8;
            let swapped = (words[i] >> shift ^ words[i + distance]) & low;
            words[i] ^= swapped << shift;
            words[i + distance] ^= swapped;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn transposing_moves_byte_j_of_word_i_to_byte_i_of_word_j() {
        let mut words =
            std::array::from_fn(|i| u64::from_le_bytes(std::array::from_fn(|j| (8 * i + j) as u8)));
        transpose(&mut words);
        for (i, word) in words.into_iter().enumerate() {
            assert_eq!(word.to_le_bytes(), std::array::from_fn(|j| (8 * j + i) as u8));
        }
    }

    #[test]
    fn tiles_give_back_the_rows_they_were_made_of() {
        for (width, height) in [(1, 1), (7, 9), (8, 8), (63, 3), (64, 16), (65, 17), (130, 2)] {
            let map = Map::random(Lattice::Square, width, height, 0.5, 3).unwrap();
            let mut rows = 0;
            Tiles::new(&map).rows(Plane::Open, |y, row| {
                for x in 0..width {
                    let open = row[x as usize / 64] >> (x % 64) & 1 == 1;
                    assert_eq!(open, map.is_free(Cell::new(x as i32, y as i32)));
                }
                rows += 1;
            });
            assert_eq!(rows, height);
        }
    }
}
