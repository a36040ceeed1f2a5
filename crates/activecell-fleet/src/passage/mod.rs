//! The wave through time: where one robot can be at each step, among others whose paths are given.
//!
//! The cells that the robot can have reached are one plane of bits a step. The next plane is the last one, together with
//! itself moved to each neighbour, without what others take: a few operations on whole words, 64 cells at once. The
//! first plane that holds the target tells the earliest arrival; the path is read backwards.

mod layout;
mod reservations;

pub use layout::Layout;
pub use reservations::Reservations;

use activecell::Rng;
use layout::Shift;
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
    shifts: Vec<Shift>,
    /// The cells of the rows of each parity.
    parity: [Vec<u64>; 2],
    /// The planes reached, one a step.
    reached: Vec<u64>,
    /// The words of each plane that were written; all others mean zero.
    written: Vec<Range<usize>>,
}

impl Passage {
    /// For planes of this layout.
    pub fn new(layout: &Layout) -> Self {
        let parity = [0, 1].map(|parity| layout.parity(parity));
        Self {
            shifts: layout.shifts(),
            parity,
            layout: layout.clone(),
            reached: Vec::new(),
            written: Vec::new(),
        }
    }

    /// The memory that it keeps, in bytes.
    pub fn bytes(&self) -> usize {
        (self.reached.capacity() + 2 * self.layout.words()) * size_of::<u64>()
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
        let keeps = taken.free_from(to)?;
        let distance = self.layout.lattice().distance(self.layout.cell(from), self.layout.cell(to)) as usize;
        if keeps.max(distance) > latest {
            return None;
        }
        self.start(from);
        let mut step = 0;
        while step < keeps || !self.reaches(step, to) {
            if step == latest {
                return None;
            }
            let far = latest - step - 1;
            let [start, end] = [from, to].map(|bit| self.layout.cell(bit).y);
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
        new.copy_from_slice(&old[words.clone()]);
        for shift in &self.shifts {
            let rows = shift.rows.map(|parity| &self.parity[parity as usize][words.clone()]);
            let back = self.layout.lattice().opposite(shift.dir);
            let against = taken.moving(step, back).map(|plane| &plane[words.clone()]);
            arrive(old, words.start, shift.bits, rows, against, new);
        }
        let mut any = 0;
        for (new, &free) in new.iter_mut().zip(&taken.free(step + 1)[words.clone()]) {
            *new &= free;
            any |= *new;
        }
        self.written.truncate(step + 1);
        self.written.push(words);
        any != 0
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
            let around = self
                .layout
                .lattice()
                .dirs()
                .map(|dir| here.wrapping_add_signed(self.layout.ahead(here, dir)));
            for from in around.chain([here]) {
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

/// Adds to `new` the cells of `old` moved by `bits`, where the rows are right and nobody comes against them.
fn arrive(
    old: &[u64],
    start: usize,
    bits: i32,
    rows: Option<&[u64]>,
    against: Option<&[u64]>,
    new: &mut [u64],
) {
    let (skip, rest) = ((bits.unsigned_abs() / 64) as usize, bits.unsigned_abs() % 64);
    let size = new.len();
    // A shift by 64 is one by 1 and 63, so that a rest of 0 needs no branch.
    let forward = bits >= 0;
    let (near, far) =
        if forward { (start - skip, start - skip - 1) } else { (start + skip, start + skip + 1) };
    let (near, far) = (&old[near..near + size], &old[far..far + size]);
    let moved = |i: usize| {
        if forward {
            near[i] << rest | far[i] >> 1 >> (63 - rest)
        } else {
            near[i] >> rest | far[i] << 1 << (63 - rest)
        }
    };
    match (rows, against) {
        (None, None) => (0..size).for_each(|i| new[i] |= moved(i)),
        (None, Some(against)) => (0..size).for_each(|i| new[i] |= moved(i) & !against[i]),
        (Some(rows), None) => (0..size).for_each(|i| new[i] |= moved(i) & rows[i]),
        (Some(rows), Some(against)) => (0..size).for_each(|i| new[i] |= moved(i) & rows[i] & !against[i]),
    }
}
