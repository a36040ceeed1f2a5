//! Which cells can be reached at all: whole runs of a row at once.

use super::compact::check_targets;
use crate::error::Error;
use crate::lattice::{Cell, Lattice};
use crate::map::{BitPlane, Map};

/// Sixty-four cells of a row.
#[derive(Debug, Clone, Copy, Default)]
struct Word {
    free: u64,
    /// Only whole runs of free cells within the word.
    reached: u64,
    /// Cells that a neighbour has reached, whose runs are to be filled.
    seeds: u64,
}

/// The map's rows with a word without free cells around them.
struct Rows {
    lattice: Lattice,
    across: usize,
    words: Vec<Word>,
    /// Words with seeds, the last first.
    stack: Vec<u32>,
}

impl Map {
    /// The cells from which a way leads to at least one of `cells`, these included: reachability alone, which is
    /// some ten times cheaper than distances.
    ///
    /// # Errors
    /// [`Error::BadValue`] without a cell; [`Error::OutsideMap`] or [`Error::TargetOccupied`].
    ///
    /// ```
    /// use activecell::{Cell, Lattice, Map};
    /// let map = Map::parse(Lattice::Square, "..#.\n..#.")?;
    /// let reached = map.reachable(&[Cell::new(0, 0)])?;
    /// assert!(reached.get(1, 1) && !reached.get(3, 0));
    /// assert_eq!(reached.count_ones(), 4);
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn reachable(&self, cells: &[Cell]) -> Result<BitPlane, Error> {
        check_targets(self, cells)?;
        let mut rows = Rows::new(self);
        for cell in cells {
            let word = (cell.y as usize + 1) * rows.across + cell.x as usize / 64 + 1;
            rows.seed(word, 1 << (cell.x % 64));
        }
        while let Some(word) = rows.stack.pop() {
            rows.fill(word as usize);
        }
        rows.plane(self)
    }
}

impl Rows {
    fn new(map: &Map) -> Self {
        let (width, height) = (map.width() as usize, map.height() as usize);
        let across = width.div_ceil(64) + 2;
        let mut words = vec![Word::default(); across * (height + 2)];
        let last = u64::MAX >> ((64 - width % 64) % 64);
        for (y, row) in words.chunks_exact_mut(across).skip(1).take(height).enumerate() {
            for (word, blocked) in row[1..].iter_mut().zip(map.obstacles().row(y as u32)) {
                word.free = !blocked;
            }
            row[across - 2].free &= last;
        }
        Self { lattice: map.lattice(), across, words, stack: Vec::new() }
    }

    /// Lets the free cells among `bits` of a word grow, if they have not been reached.
    #[inline]
    fn seed(&mut self, word: usize, bits: u64) {
        let there = &mut self.words[word];
        let new = bits & there.free & !there.reached;
        if new != 0 {
            if there.seeds == 0 {
                self.stack.push(word as u32);
            }
            there.seeds |= new;
        }
    }

    /// Fills the runs of a word that hold a seed, and seeds its neighbours.
    fn fill(&mut self, word: usize) {
        let here = &mut self.words[word];
        let seeds = std::mem::take(&mut here.seeds);
        let new = runs(here.free, seeds);
        here.reached |= new;
        let across = self.across;
        if new & 1 != 0 {
            self.seed(word - 1, 1 << 63);
        }
        if new >> 63 != 0 {
            self.seed(word + 1, 1);
        }
        if self.lattice == Lattice::Square {
            self.seed(word - across, new);
            self.seed(word + across, new);
            return;
        }
        // Rows of the map are counted from 0, here from 1. Even rows touch the columns x − 1 and x above and below.
        let even = word / across % 2 == 1;
        let beside = new | if even { new >> 1 } else { new << 1 };
        self.seed(word - across, beside);
        self.seed(word + across, beside);
        if even && new & 1 != 0 {
            self.seed(word - across - 1, 1 << 63);
            self.seed(word + across - 1, 1 << 63);
        } else if !even && new >> 63 != 0 {
            self.seed(word - across + 1, 1);
            self.seed(word + across + 1, 1);
        }
    }

    fn plane(&self, map: &Map) -> Result<BitPlane, Error> {
        let mut plane = BitPlane::new(map.width().into(), map.height().into())?;
        for y in 0..map.height() {
            let row = &self.words[(y as usize + 1) * self.across + 1..];
            for (bits, word) in plane.row_mut(y).iter_mut().zip(row) {
                *bits = word.reached;
            }
        }
        Ok(plane)
    }
}

/// The runs of ones of `free` that hold a bit of `seeds`, all of which are free.
#[inline]
fn runs(free: u64, seeds: u64) -> u64 {
    // A carry runs upwards from each seed to the end of its run and leaves all it passed changed.
    let up = |free: u64, seeds: u64| free & (free.wrapping_add(seeds) ^ free) | seeds;
    let upper = up(free, seeds);
    up(free.reverse_bits(), upper.reverse_bits()).reverse_bits()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Rng;

    #[test]
    fn runs_are_filled_as_by_single_steps() {
        let mut rng = Rng::new(1);
        for round in 0..100_000 {
            let free = match round % 3 {
                0 => rng.next_u64(),
                1 => rng.next_u64() | rng.next_u64() | rng.next_u64(),
                _ => u64::MAX << rng.below(64),
            };
            let seeds = free & rng.next_u64() & rng.next_u64() & rng.next_u64();
            let mut filled = seeds;
            for _ in 0..64 {
                filled |= free & (filled << 1 | filled >> 1);
            }
            assert_eq!(runs(free, seeds), filled, "{free:x} {seeds:x}");
        }
    }
}
