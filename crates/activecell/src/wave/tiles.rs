//! A map packed into tiles of 8 × 8 cells, a word each.

use crate::map::Map;

/// Column 0 of a tile; bit `8 · row + column` is a cell.
pub(crate) const WEST: u64 = 0x0101_0101_0101_0101;
/// Column 7.
pub(crate) const EAST: u64 = WEST << 7;

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

/// Words of as many equal parts as there are words (4 or 8), transposed: from rows of 64 cells to tiles, or back.
#[inline]
pub(super) fn transpose<const N: usize>(words: &mut [u64; N]) {
    let mut distance = N / 2;
    while distance > 0 {
        let shift = distance * 64 / N;
        // The lower half of every two times `shift` bits.
        let low = u64::MAX / ((1 << shift) + 1);
        for i in (0..N).filter(|i| i & distance == 0) {
            let swapped = (words[i] >> shift ^ words[i + distance]) & low;
            words[i] ^= swapped << shift;
            words[i + distance] ^= swapped;
        }
        distance /= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lattice::{Cell, Lattice};

    #[test]
    fn transposing_moves_byte_j_of_word_i_to_byte_i_of_word_j() {
        let mut words: [u64; 8] =
            std::array::from_fn(|i| u64::from_le_bytes(std::array::from_fn(|j| (8 * i + j) as u8)));
        transpose(&mut words);
        for (i, word) in words.into_iter().enumerate() {
            assert_eq!(word.to_le_bytes(), std::array::from_fn(|j| (8 * j + i) as u8));
        }
    }

    #[test]
    fn transposing_moves_part_j_of_word_i_to_part_i_of_word_j() {
        let part = |word: u64, j: usize| word >> (16 * j) & 0xffff;
        let words: [u64; 4] =
            std::array::from_fn(|i| (0..4).map(|j| ((4 * i + j) as u64) << (16 * j)).sum::<u64>());
        let mut transposed = words;
        transpose(&mut transposed);
        for (i, word) in words.into_iter().enumerate() {
            assert!((0..4).all(|j| part(transposed[j], i) == part(word, j)));
        }
    }

    #[test]
    fn tiles_hold_the_free_cells_of_the_map() {
        for (width, height) in [(1, 1), (7, 9), (8, 8), (63, 3), (64, 16), (65, 17), (130, 2)] {
            let map = Map::random(Lattice::Square, width, height, 0.5, 3).unwrap();
            let across = width as usize / 8 + 3 - usize::from(width.is_multiple_of(8));
            let mut free = 0;
            each_free(&map, |tile, open| {
                for bit in (0..64).filter(|bit| open >> bit & 1 == 1) {
                    let (x, y) = ((tile % across - 1) * 8 + bit % 8, (tile / across - 1) * 8 + bit / 8);
                    assert!(map.is_free(Cell::new(x as i32, y as i32)));
                    free += 1;
                }
            });
            assert_eq!(free, map.free_cells());
        }
    }
}
