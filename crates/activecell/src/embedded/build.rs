//! Building a move table: one wave a source, and its first moves as runs.

use super::file::{EmbeddedHeader, MOVES, Parsed, Writer};
use super::moves::{NO_WAY, run};
use super::order::Order;
use crate::error::Error;
use crate::lattice::Lattice;
use crate::map::Map;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

/// The directions in a cell's state: those of the first moves of all shortest ways to it.
const MOVES_MASK: u8 = 0x3f;
/// Above them: the wave's step modulo 3, plus 1; 0 before it came.
const STEP_SHIFT: u32 = 6;
/// In a set of first moves: there is no way.
const UNREACHED: u8 = 0x40;
/// Any move will do: the source itself.
const ANY: u8 = 0x7f;
/// Rows that a thread takes at a time.
const BLOCK: usize = 32;

/// The rows of some sources.
struct Block {
    number: usize,
    /// Runs in each row.
    lengths: Vec<u32>,
    runs: Vec<u32>,
}

impl Map {
    /// The file of the table of first moves from every free cell to every other, for
    /// [`MoveTable::from_bytes`](super::MoveTable::from_bytes). The same bytes whatever the number of threads.
    ///
    /// The time grows with the square of the number of free cells, of which the map may have at most
    /// `max_free_cells`. `progress` is called after each of them, by any of the threads.
    ///
    /// # Errors
    /// [`Error::BadValue`] if the map has more free cells, or without a thread.
    ///
    /// ```
    /// use activecell::{Cell, Dir, Lattice, Map, MoveTable};
    /// let map = Map::parse(Lattice::Square, ".#.\n...")?;
    /// let file = map.move_table(1000, 2, &|| ())?;
    /// let table = MoveTable::from_bytes(&file)?;
    /// assert_eq!(table.next(Cell::new(0, 0), Cell::new(2, 0)), Some(Dir::S));
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn move_table(
        &self,
        max_free_cells: usize,
        threads: usize,
        progress: &(dyn Fn() + Sync),
    ) -> Result<Vec<u8>, Error> {
        let free = self.free_cells();
        if free > max_free_cells {
            let allowed =
                "at most the given limit; raise it, choose larger cells, or embed a few targets only";
            return Err(Error::BadValue { name: "the number of free cells", value: free as f64, allowed });
        }
        if threads == 0 {
            return Err(Error::BadValue { name: "the number of threads", value: 0.0, allowed: "at least 1" });
        }
        let order = Order::new(self);
        let blocks = match self.lattice() {
            Lattice::Square => rows::<4>(&order, threads, progress),
            Lattice::Hex => rows::<6>(&order, threads, progress),
        }?;
        Ok(write(self, &order, &blocks))
    }
}

fn write(map: &Map, order: &Order, blocks: &[Block]) -> Vec<u8> {
    let header = EmbeddedHeader::of(map);
    let count = blocks.iter().map(|block| block.runs.len() as u64).sum();
    let mut file = Writer::new(&Parsed { kind: MOVES, header, count, planes: 0 });
    let mut plane = vec![0u64; map.cells().div_ceil(64)];
    for cell in map.free() {
        let index = header.index(cell).expect("a free cell has an index");
        plane[index / 64] |= 1 << (index % 64);
    }
    let mut before = 0;
    let ranks = plane.iter().map(|word| {
        let rank = before;
        before += word.count_ones();
        rank
    });
    let ranks: Vec<u32> = ranks.collect();
    file.u64s(plane);
    file.u32s(ranks);
    file.end_section();
    file.u32s(order.numbers.iter().copied());
    file.end_section();
    let mut end = 0;
    file.u32s([0]);
    file.u32s(blocks.iter().flat_map(|block| &block.lengths).map(|length| {
        end += length;
        end
    }));
    file.end_section();
    for block in blocks {
        file.u32s(block.runs.iter().copied());
    }
    file.finish()
}

/// The rows of all sources on `D` directions, in blocks in their order.
fn rows<const D: usize>(
    order: &Order,
    threads: usize,
    progress: &(dyn Fn() + Sync),
) -> Result<Vec<Block>, Error> {
    let free = order.numbers.len();
    let (next, total) = (AtomicUsize::new(0), AtomicU64::new(0));
    let work = || {
        let mut search = Search::<D>::new(order);
        let mut blocks = Vec::new();
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            let sources = number * BLOCK..free.min((number + 1) * BLOCK);
            if sources.is_empty() || total.load(Ordering::Relaxed) > u32::MAX.into() {
                return blocks;
            }
            let mut block = Block { number, lengths: Vec::with_capacity(BLOCK), runs: Vec::new() };
            for source in sources {
                let first = block.runs.len();
                search.spread(source);
                search.runs(source, &mut block.runs);
                block.lengths.push((block.runs.len() - first) as u32);
                progress();
            }
            total.fetch_add(block.runs.len() as u64, Ordering::Relaxed);
            blocks.push(block);
        }
    };
    let mut blocks: Vec<Block> = std::thread::scope(|scope| {
        let others: Vec<_> = (1..threads.min(free.div_ceil(BLOCK))).map(|_| scope.spawn(work)).collect();
        let mut blocks = work();
        for other in others {
            blocks.extend(other.join().expect("a thread that builds rows does not panic"));
        }
        blocks
    });
    let total = total.into_inner();
    if total > u32::MAX.into() {
        let allowed = "below 2^32; choose larger cells, or embed a few targets only";
        return Err(Error::BadValue { name: "the number of runs", value: total as f64, allowed });
    }
    blocks.sort_unstable_by_key(|block| block.number);
    Ok(blocks)
}

/// The wave from one source after the other, which carries along the first moves.
struct Search<'a, const D: usize> {
    neighbours: &'a [[u32; D]],
    /// A byte a cell, and one more for "no neighbour".
    state: Vec<u8>,
    queue: Vec<u32>,
}

impl<'a, const D: usize> Search<'a, D> {
    fn new(order: &'a Order) -> Self {
        let free = order.numbers.len();
        let neighbours = order.neighbours.as_chunks().0;
        Self { neighbours, state: vec![0; free + 1], queue: vec![0; free + 1] }
    }

    /// Finds the first moves of all shortest ways from `source` to each cell: those of the cells before it.
    ///
    /// Without branches that depend on the map: in clutter a processor would guess them wrong.
    fn spread(&mut self, source: usize) {
        let free = self.neighbours.len();
        self.state.fill(0);
        // "No neighbour" is never new, and never of the wave's next step.
        self.state[free] = MOVES_MASK;
        self.state[source] = ANY;
        let mut end = 0;
        for (dir, &next) in self.neighbours[source].iter().enumerate() {
            if next as usize != free {
                self.state[next as usize] = 1 << dir | 2 << STEP_SHIFT;
                self.queue[end] = next;
                end += 1;
            }
        }
        let (mut first, mut tag) = (0, 2u8);
        while first < end {
            tag = tag % 3 + 1;
            let level = first..end;
            first = end;
            for place in level {
                let cell = self.queue[place] as usize;
                let moves = self.state[cell] & MOVES_MASK | tag << STEP_SHIFT;
                for &next in &self.neighbours[cell] {
                    let state = &mut self.state[next as usize];
                    let is_new = u8::from(*state == 0);
                    let is_next = is_new | u8::from(*state >> STEP_SHIFT == tag);
                    *state |= moves * is_next;
                    self.queue[end] = next;
                    end += usize::from(is_new);
                }
            }
        }
    }

    /// The moves as runs of cells that have one in common, each as long as it can be.
    fn runs(&self, source: usize, runs: &mut Vec<u32>) {
        const CHUNK: usize = 32;
        let states = &self.state[..self.neighbours.len()];
        let (mut first, mut common, mut cell) = (0, ANY, 0);
        while cell < states.len() {
            if let Some(chunk) = states[cell..].first_chunk::<CHUNK>() {
                // A whole chunk with a move in common; an unreached cell has none.
                let all = chunk.iter().fold(common, |all, state| all & state) & MOVES_MASK;
                if all != 0 {
                    common = all;
                    cell += CHUNK;
                    continue;
                }
            }
            for _ in 0..CHUNK.min(states.len() - cell) {
                let moves = match states[cell] {
                    _ if cell == source => ANY,
                    0 => UNREACHED,
                    state => state & MOVES_MASK,
                };
                if common & moves == 0 {
                    runs.push(encode(first, common));
                    (first, common) = (cell, moves);
                } else {
                    common &= moves;
                }
                cell += 1;
            }
        }
        runs.push(encode(first, common));
    }
}

/// A run from cell number `first` on with the first of its moves.
fn encode(first: usize, moves: u8) -> u32 {
    run(first as u32, if moves == UNREACHED { NO_WAY } else { moves.trailing_zeros() })
}
