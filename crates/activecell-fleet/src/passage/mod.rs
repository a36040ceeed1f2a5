//! The wave through time: where one robot can be at each step, among others whose paths are given.
//!
//! The cells that the robot can have reached are one plane of bits a step. The next plane is the last one, together with
//! itself moved to each neighbour, without what others take: a few operations on whole words, 64 cells at once. The
//! first plane that holds the target tells the earliest arrival; the path is read backwards.

mod layout;
mod reservations;

pub use layout::Layout;
pub use reservations::Reservations;

use activecell::{Cell, Lattice, Rng};
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
    /// The planes reached, one a step; zero but for what `written` tells.
    reached: Vec<u64>,
    /// The words that are not zero, for each step and strip.
    written: Vec<Range<usize>>,
    /// Nothing is reached outside the map.
    outside: Vec<u64>,
    /// The words of the odd rows of a strip; only hexagons ask.
    odd: Vec<u64>,
}

impl Passage {
    /// For planes of this layout.
    pub fn new(layout: &Layout) -> Self {
        let strip = layout.strip();
        // Above the first row there is a word.
        let odd = (0..strip).map(|word| if word % 2 == 0 { u64::MAX } else { 0 }).collect();
        let layout = layout.clone();
        Self { layout, reached: Vec::new(), written: Vec::new(), outside: vec![0; strip], odd }
    }

    /// The memory that it keeps, in bytes.
    pub fn bytes(&self) -> usize {
        (self.reached.capacity() + self.outside.len() + self.odd.len()) * size_of::<u64>()
            + self.written.capacity() * size_of::<Range<usize>>()
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
        let cells = [from, to].map(|bit| self.layout.cell(bit));
        let distance = self.layout.lattice().distance(cells[0], cells[1]) as usize;
        let keeps = taken.free_from(to, distance)?;
        if keeps > latest {
            return None;
        }
        self.start(from);
        let mut step = 0;
        while step < keeps || !self.reaches(step, to) {
            if step == latest || !self.spread(taken, step, cells, latest) {
                return None;
            }
            step += 1;
        }
        Some(self.trace(taken, step, to, rng))
    }

    /// Sets out from a cell at step 0.
    fn start(&mut self, from: u32) {
        let size = self.layout.words();
        for (i, written) in self.written.drain(..).enumerate() {
            self.reached[i / self.layout.strips() * size..][written].fill(0);
        }
        if self.reached.is_empty() {
            self.reached.resize(size, 0);
        }
        let word = from as usize / 64;
        let at = word / self.layout.strip();
        self.written.resize(self.layout.strips(), 0..0);
        self.written[at] = word..word + 1;
        self.reached[word] = 1 << (from % 64);
    }

    /// Whether the robot can be in a cell at a step that the wave has come to.
    #[inline]
    fn reaches(&self, step: usize, bit: u32) -> bool {
        let (word, size) = (bit as usize / 64, self.layout.words());
        word < size && self.reached[step * size + word] >> (bit % 64) & 1 == 1
    }

    /// Spreads the wave from a step, the last so far, to the next: to cells from which the last of two, the target, can be
    /// reached by step `latest`. False if nothing is reached any more.
    fn spread(&mut self, taken: &Reservations, step: usize, cells: [Cell; 2], latest: usize) -> bool {
        let (size, strips) = (self.layout.words(), self.layout.strips());
        if self.reached.len() < (step + 2) * size {
            self.reached.resize((step + 2) * size, 0);
        }
        let (old, new) = self.reached.split_at_mut((step + 1) * size);
        let old = &old[step * size..];
        let around =
            Around { taken, step, old, outside: &self.outside, odd: &self.odd, strip: self.layout.strip() };
        let mut any = false;
        for strip in 0..strips {
            let reach = neighbourhood(&self.layout, &self.written[step * strips..][..strips], strip);
            let near = self.layout.near(strip, cells[0], step + 1);
            let back = self.layout.near(strip, cells[1], latest - step - 1);
            let (start, end) =
                (reach.start.max(near.start).max(back.start), reach.end.min(near.end).min(back.end));
            let mut words = start..end.max(start);
            match self.layout.lattice() {
                _ if words.is_empty() => {}
                Lattice::Square => around.square(&words, &mut new[words.clone()]),
                Lattice::Hex => around.hex(strip, &words, &mut new[words.clone()]),
            }
            while !words.is_empty() && new[words.start] == 0 {
                words.start += 1;
            }
            while !words.is_empty() && new[words.end - 1] == 0 {
                words.end -= 1;
            }
            any |= !words.is_empty();
            self.written.push(words);
        }
        any
    }

    /// A path to a cell that is reached at a step, backwards by chance.
    fn trace(&self, taken: &Reservations, step: usize, to: u32, rng: &mut Rng) -> Vec<u32> {
        let mut path = vec![to; step + 1];
        let mut here = to;
        for step in (0..step).rev() {
            let mut ways = [here; 7];
            let mut count = 0;
            for from in self.layout.around(here).chain([here]) {
                if self.reaches(step, from) && !taken.crosses(step, from, here) {
                    ways[count] = from;
                    count += 1;
                }
            }
            here = ways[rng.below(count as u32) as usize];
            path[step] = here;
        }
        path
    }
}

/// The words of a strip to which a wave can come from the words written in it and in those beside it.
#[inline]
fn neighbourhood(layout: &Layout, written: &[Range<usize>], strip: usize) -> Range<usize> {
    let size = layout.strip();
    let beside = strip.saturating_sub(1)..(strip + 2).min(layout.strips());
    let here = beside.filter(|&other| !written[other].is_empty()).map(|other| {
        // In words of this strip.
        let of = |word: usize| word + strip * size - other * size;
        of(written[other].start) - 1..of(written[other].end) + 1
    });
    here.reduce(|a, b| a.start.min(b.start)..a.end.max(b.end)).unwrap_or(0..0)
}

/// What the wave sees when it spreads.
struct Around<'a> {
    taken: &'a Reservations,
    step: usize,
    /// The plane reached.
    old: &'a [u64],
    outside: &'a [u64],
    odd: &'a [u64],
    /// The words of a strip.
    strip: usize,
}

impl Around<'_> {
    /// The same rows of the strip to the west, and of the strip to the east; nothing outside the map.
    #[inline]
    fn sides<'p>(&'p self, plane: &'p [u64], words: &Range<usize>) -> [&'p [u64]; 2] {
        let size = words.len();
        let outside = &self.outside[..size];
        let west =
            if words.start < self.strip { outside } else { &plane[words.start - self.strip..][..size] };
        let east = words.start + self.strip;
        let east = if east + size > plane.len() { outside } else { &plane[east..][..size] };
        [west, east]
    }

    /// The cells of these words that are reached at the next step, on squares.
    fn square(&self, words: &Range<usize>, new: &mut [u64]) {
        let size = words.len();
        let [row, column] = [0, 1].map(|kind| self.taken.crossed(self.step, kind));
        let here = &self.old[words.start - 1..][..size + 2];
        let [west, east] = self.sides(self.old, words);
        let [_, row_east] = self.sides(row, words);
        let (row, column) = (&row[words.start..][..size], &column[words.start..][..=size]);
        let free = &self.taken.free(self.step + 1)[words.start..][..size];
        let (new, west, east, row_east) = (&mut new[..size], &west[..size], &east[..size], &row_east[..size]);
        for i in 0..size {
            let eastward = (here[i + 1] << 1 | west[i] >> 63) & !row[i];
            let westward = (here[i + 1] & !row[i]) >> 1 | (east[i] & !row_east[i]) << 63;
            let down = here[i] & !column[i];
            let up = here[i + 2] & !column[i + 1];
            new[i] = (here[i + 1] | eastward | westward | down | up) & free[i];
        }
    }

    /// The same on hexagons: cells of odd rows touch those one column east in the rows above and below, others those one
    /// column west.
    fn hex(&self, strip: usize, words: &Range<usize>, new: &mut [u64]) {
        self.square(words, new);
        let size = words.len();
        let wide = words.start - 1..words.end + 1;
        let slanted = self.taken.crossed(self.step, 2);
        let here = &self.old[wide.clone()][..size + 2];
        let [west, east] = self.sides(self.old, &wide);
        let [slanted_west, slanted_east] = self.sides(slanted, &wide);
        let slanted = &slanted[wide.clone()][..size + 2];
        let odd = &self.odd[words.start - strip * self.strip..][..size];
        let free = &self.taken.free(self.step + 1)[words.start..][..size];
        let (west, east) = (&west[..size + 2], &east[..size + 2]);
        let (slanted_west, slanted_east) = (&slanted_west[..size + 2], &slanted_east[..size + 2]);
        for i in 0..size {
            let lower = here[i + 2] & !slanted[i + 2];
            let from_west = (here[i] << 1 | west[i] >> 63) & !slanted[i + 1]
                | lower << 1
                | (west[i + 2] & !slanted_west[i + 2]) >> 63;
            let from_east = (here[i] >> 1 | east[i] << 63) & !slanted[i + 1]
                | lower >> 1
                | (east[i + 2] & !slanted_east[i + 2]) << 63;
            new[i] |= (from_east & odd[i] | from_west & !odd[i]) & free[i];
        }
    }
}
