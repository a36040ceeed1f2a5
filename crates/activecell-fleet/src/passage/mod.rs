//! The wave through time: where one robot can be at each step, among others whose paths are given.
//!
//! The cells that the robot can have reached are one plane of bits a step. The next plane is the last one, together with
//! itself moved to each neighbour, without what others take: a few operations on whole words, 64 cells at once. The
//! first plane that holds the target tells the earliest arrival; the path is read backwards.

mod layout;
mod reservations;

pub use layout::Layout;
pub use reservations::Reservations;

use activecell::{Lattice, Rng};
use std::ops::Range;

/// Finds paths among reservations, and keeps its memory between them.
///
/// ```
/// use activecell::{Cell, Lattice, Map, Rng};
/// use activecell_fleet::{Floor, Passage, Reservations};
/// let map = Map::parse(Lattice::Square, "...\n#.#")?;
/// let mut taken = Reservations::new(&Floor::new(&map), 9);
/// let [west, mid, east] = [0, 1, 2].map(|x| taken.layout().bit(Cell::new(x, 0)));
/// taken.reserve(&[east, mid, west]);
/// let bay = taken.layout().bit(Cell::new(1, 1));
/// let mut passage = Passage::new(taken.layout());
/// // From the bay to the east the robot waits a step for the other to pass.
/// let path = passage.earliest(&taken, bay, east, 9, &mut Rng::new(1)).unwrap();
/// assert_eq!(path, [bay, bay, mid, east]);
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Passage {
    layout: Layout,
    /// On hexagons, the cells of the even and the odd rows.
    parity: Option<[Vec<u64>; 2]>,
    /// The planes reached, one a step.
    reached: Vec<u64>,
    /// The words of each plane that were written; all others mean zero.
    written: Vec<Range<usize>>,
}

impl Passage {
    /// For planes of this layout.
    pub fn new(layout: &Layout) -> Self {
        let is_hex = layout.lattice() == Lattice::Hex;
        let parity = is_hex.then(|| [0, 1].map(|parity| layout.parity(parity)));
        Self { parity, layout: layout.clone(), reached: Vec::new(), written: Vec::new() }
    }

    /// The memory that it keeps, in bytes.
    pub fn bytes(&self) -> usize {
        (self.reached.capacity() + 3 * self.layout.words()) * size_of::<u64>()
    }

    /// The path from a cell at step 0 that comes soonest to a target that it can keep for ever: after all others have
    /// passed there. It has a cell a step and ends in the target; among equally soon ones chance decides. `None` if there is none
    /// that arrives at step `latest` or before. The robot's own path must not be reserved.
    pub fn earliest(
        &mut self,
        taken: &Reservations,
        from: u32,
        to: u32,
        latest: usize,
        rng: &mut Rng,
    ) -> Option<Vec<u32>> {
        let [start, end] = [from, to].map(|bit| self.layout.cell(bit));
        let distance = self.layout.lattice().distance(start, end) as usize;
        let keeps = taken.free_from(to, distance)?;
        if keeps > latest {
            return None;
        }
        let (start, end) = (start.y, end.y);
        self.start(from);
        let mut step = 0;
        while step < keeps || !self.reaches(step, to) {
            if step == latest {
                return None;
            }
            let far = latest - step - 1;
            let (out, back) = (step as i32 + 1, far as i32);
            let rows = self.layout.rows((start - out).max(end - back), (start + out).min(end + back));
            if !self.spread(taken, step, rows) {
                return None;
            }
            step += 1;
        }
        Some(self.trace(taken, step, to, rng))
    }

    /// Sets out from a cell at step 0.
    pub fn start(&mut self, from: u32) {
        let word = from as usize / 64;
        self.reached.resize(self.layout.words(), 0);
        self.written.clear();
        self.written.push(word..word + 1);
        self.reached[word] = 1 << (from % 64);
    }

    /// Whether the robot can be in a cell at a step that the wave has come to.
    #[inline]
    pub fn reaches(&self, step: usize, bit: u32) -> bool {
        let word = bit as usize / 64;
        self.written[step].contains(&word)
            && self.reached[step * self.layout.words() + word] >> (bit % 64) & 1 == 1
    }

    /// The cells that can be reached at a step, as words from the given word of the layout on.
    pub fn reached(&self, step: usize) -> (usize, &[u64]) {
        let written = self.written[step].clone();
        (written.start, &self.reached[step * self.layout.words()..][written])
    }

    /// Spreads the wave from a step, the last so far, to the next, in these words. False if nothing is reached any more.
    pub fn spread(&mut self, taken: &Reservations, step: usize, words: Range<usize>) -> bool {
        let size = self.layout.words();
        if self.reached.len() < (step + 2) * size {
            self.reached.resize((step + 2) * size, 0);
        }
        // Cells that are a row away are reached from what was written.
        let reach = self.layout.reach();
        let before = self.written[step].clone();
        let words = words.start.max(before.start.saturating_sub(reach))..words.end.min(before.end + reach);
        let words = if words.is_empty() { words.start..words.start } else { words };
        let (old, new) = self.reached.split_at_mut((step + 1) * size);
        let old = &mut old[step * size..];
        // What the shifts read around the words must be zero where nothing was written.
        let around = words.start.saturating_sub(reach)..(words.end + reach).min(size);
        zero_outside(old, &around, &before);
        let new = &mut new[words.clone()];
        new.fill(0);
        let stride = self.layout.stride() as usize;
        if let Some([even, odd]) = &self.parity {
            let crossed = taken.crossed(step, 2);
            slant(old, crossed, odd, words.start, stride - 1, new);
            slant(old, crossed, even, words.start, stride + 1, new);
        }
        let crossed = [0, 1].map(|kind| taken.crossed(step, kind));
        let any = straight(old, crossed, &taken.free(step + 1)[words.clone()], words.start, stride, new);
        self.written.truncate(step + 1);
        self.written.push(words);
        any
    }

    /// A path to a cell that is reached at a step, backwards by chance.
    ///
    /// # Panics
    /// If it is not reached.
    pub fn trace(&self, taken: &Reservations, step: usize, to: u32, rng: &mut Rng) -> Vec<u32> {
        let mut path = vec![to; step + 1];
        let mut here = to;
        for step in (0..step).rev() {
            let mut ways = [here; 7];
            let mut count = 0;
            for from in self.layout.around(here).chain([here]) {
                if self.reaches(step, from) && taken.allows(step, from, here) {
                    ways[count] = from;
                    count += 1;
                }
            }
            assert!(count > 0, "the wave came from somewhere");
            here = ways[rng.below(count as u32) as usize];
            path[step] = here;
        }
        path
    }
}

/// Sets the words of `range` that are not in `keep` to zero.
fn zero_outside(plane: &mut [u64], range: &Range<usize>, keep: &Range<usize>) {
    plane[range.start..keep.start.clamp(range.start, range.end)].fill(0);
    plane[keep.end.clamp(range.start, range.end)..range.end].fill(0);
}

/// Adds to `new`, whose first word is `start` in the planes, the cells of `old` and all that they reach within rows and
/// `stride` apart, where nobody crosses; then leaves only what is free. Whether anything is left.
#[inline]
fn straight(
    old: &[u64],
    crossed: [&[u64]; 2],
    free: &[u64],
    start: usize,
    stride: usize,
    new: &mut [u64],
) -> bool {
    let size = new.len();
    let (skip, rest) = (stride / 64, stride % 64);
    let [row, column] = crossed;
    let (left, here, right) = (&old[start - 1..][..size], &old[start..][..size], &old[start + 1..][..size]);
    let (row_here, row_right) = (&row[start..][..size], &row[start + 1..][..size]);
    let (above, above_far) = (&old[start - skip..][..size], &old[start - skip - 1..][..size]);
    let (below, below_far) = (&old[start + skip..][..size], &old[start + skip + 1..][..size]);
    let column_here = &column[start..][..size];
    let (column_below, column_far) = (&column[start + skip..][..size], &column[start + skip + 1..][..size]);
    let free = &free[..size];
    let mut any = 0;
    for i in 0..size {
        // A shift by 64 is one by 1 and 63, so that a rest of 0 needs no branch.
        let east = (here[i] << 1 | left[i] >> 63) & !row_here[i];
        let west = (here[i] & !row_here[i]) >> 1 | (right[i] & !row_right[i]) << 63;
        let south = (above[i] << rest | above_far[i] >> 1 >> (63 - rest)) & !column_here[i];
        let north =
            (below[i] & !column_below[i]) >> rest | (below_far[i] & !column_far[i]) << 1 << (63 - rest);
        new[i] = (new[i] | here[i] | east | west | south | north) & free[i];
        any |= new[i];
    }
    any != 0
}

/// Adds to `new` the cells that those of `old` reach over edges `bits` apart, of which the higher end is in `rows`, where
/// nobody crosses.
#[inline]
fn slant(old: &[u64], crossed: &[u64], rows: &[u64], start: usize, bits: usize, new: &mut [u64]) {
    let size = new.len();
    let (skip, rest) = (bits / 64, bits % 64);
    let (above, above_far) = (&old[start - skip..][..size], &old[start - skip - 1..][..size]);
    let (below, below_far) = (&old[start + skip..][..size], &old[start + skip + 1..][..size]);
    let (crossed_here, rows_here) = (&crossed[start..][..size], &rows[start..][..size]);
    let (crossed_below, crossed_far) =
        (&crossed[start + skip..][..size], &crossed[start + skip + 1..][..size]);
    let (rows_below, rows_far) = (&rows[start + skip..][..size], &rows[start + skip + 1..][..size]);
    for i in 0..size {
        let south = (above[i] << rest | above_far[i] >> 1 >> (63 - rest)) & !crossed_here[i] & rows_here[i];
        let north = (below[i] & !crossed_below[i] & rows_below[i]) >> rest
            | (below_far[i] & !crossed_far[i] & rows_far[i]) << 1 << (63 - rest);
        new[i] |= south | north;
    }
}
