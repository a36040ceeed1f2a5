//! Full fields on bits: the time at which the wave reached each cell of a tile, as a binary number whose digits are
//! planes.
//!
//! To note a front is then to add it to the planes of the digits that are 1: vector instructions, whatever the number
//! of its cells. The numbers of a tile count from shortly before its first front, and six digits last for 63 steps, twice
//! as many as the wave takes to cross a tile without obstacles. Where it comes back later, the full record is put aside
//! and a new one is begun, so that distances of any size are exact. A cell is looked up in the records of its tile
//! one after the other, the newest first; nearly all tiles have one.
//!
//! Source: arithmetic on numbers spread over planes of bits is *bit slicing* (E. Biham, *A Fast New DES Implementation
//! in Software*, 1997).

use super::flood::{Bits, FIRST, Record, Tiles, place};
use crate::lattice::Cell;
use crate::map::Map;

/// Digits of a number.
const DIGITS: usize = 6;
/// One more than the greatest.
const NUMBERS: usize = 1 << DIGITS;

/// For each number all ones where it has the digit 1: looked up, since compilers make branches of masks that are
/// computed, and processors guess them wrong.
static MASKS: [[u64; DIGITS]; NUMBERS] = {
    let mut masks = [[0; DIGITS]; NUMBERS];
    let mut number = 0;
    while number < NUMBERS {
        let mut digit = 0;
        while digit < DIGITS {
            masks[number][digit] = ((number >> digit & 1) as u64).wrapping_neg();
            digit += 1;
        }
        number += 1;
    }
    masks
};

/// The times of a tile's cells.
#[derive(Debug, Clone, Copy, Default)]
struct Times {
    /// A number for each cell; 0 for cells that were not reached while this record lasted.
    digits: [Bits; DIGITS],
    /// The time of the number 0. No front comes at the time 0, so that it marks a tile without one.
    since: u32,
    /// One more than the place of the record before this one; 0 for none.
    older: u32,
}

impl Record for Times {
    #[inline]
    fn is_full(&self, time: u32) -> bool {
        time - self.since >= NUMBERS as u32
    }

    fn renew(&mut self, time: u32, older: &mut Vec<Self>) -> bool {
        let first = self.since == 0;
        if !first {
            older.push(*self);
        }
        let before = if first { 0 } else { older.len() as u32 };
        *self = Self { digits: [Bits::default(); DIGITS], since: time - 1, older: before };
        first
    }

    #[inline]
    fn put(&mut self, time: u32, front: &Bits) {
        let masks = &MASKS[(time - self.since) as usize % NUMBERS];
        for (digit, mask) in self.digits.iter_mut().zip(masks) {
            for (word, front) in digit.0.iter_mut().zip(front.0) {
                *word |= front & mask;
            }
        }
    }
}

/// The distances of a map in tiles of bits.
#[derive(Debug, Clone)]
pub(super) struct Planes {
    across: usize,
    tiles: Vec<Times>,
    older: Vec<Times>,
}

impl Planes {
    /// The steps of a cell of the map; `None` where the wave did not come.
    #[inline]
    pub(super) fn steps(&self, x: u32, y: u32) -> Option<u32> {
        let (tile, word, bit) = place(x as usize, y as usize, self.across);
        let mut times = &self.tiles[tile];
        loop {
            let digits = times.digits.iter().rev();
            let number = digits.fold(0, |number, digit| number << 1 | (digit.0[word] >> bit & 1) as u32);
            if number != 0 {
                return Some(times.since + number - FIRST);
            }
            times = self.older.get((times.older as usize).checked_sub(1)?)?;
        }
    }
}

/// Floods the map from all `targets`.
pub(super) fn flood(map: &Map, targets: &[Cell]) -> Planes {
    let mut tiles = Tiles::<Times>::new(map);
    tiles.flood(targets);
    let across = tiles.across();
    Planes { across, tiles: tiles.records, older: tiles.older }
}
