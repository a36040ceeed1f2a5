//! Cell by cell from both ends, with the dead ends closed by the first query; for one-cell ways and dense clutter.
//!
//! Where few cells lie side by side, words of cells hold one cell of the rim each, and a plain queue is ahead of them.
//! It is made faster by what it need not visit: a cell with one free neighbour at most is closed, again and again
//! until none is left, and keeps the direction of its way out. A query follows these directions from its ends until
//! they meet, as they always do in a maze without loops, or until they come out; between the ways out two floods
//! search what is left open.
//!
//! Filling dead ends to solve a maze is old; one description is Walter D. Pullen's *Think Labyrinth: Maze Algorithms*,
//! 1996. The floods are those of Pohl (*Bi-directional Search*, Machine Intelligence 6, 1971).

use super::OutOfRoom;
use super::planes::free_word;
use crate::lattice::Cell;
use crate::map::Map;

/// Four bits of a cell: what it is, or its class above and a direction below.
const OPEN: u8 = 1;
/// A closed cell without a way out: the last of its dead end.
const LAST: u8 = 2;
/// The classes: reached from the first end or from the second, by the direction that leads back; closed, with the
/// direction that leads out.
const FIRST: u8 = 4;
const SECOND: u8 = 8;
const CLOSED: u8 = 12;
const CLASS: u8 = 12;

/// Directions: north, west, east, south. That opposite to `k` is `3 - k`.
const STEPS: [(i32, i32); 4] = [(0, -1), (-1, 0), (1, 0), (0, 1)];

/// The search by ways; square lattice only.
#[derive(Debug, Clone)]
pub(super) struct Ways {
    field: Field,
    /// Whether the dead ends are closed: the first query does it.
    is_closed: bool,
    /// The closed cells that the query at hand passed, a bit each.
    passed: Vec<u64>,
    /// The rims of both floods, and the one that is being made.
    rims: [Vec<u32>; 3],
    /// The places that were passed or reached: the first and the last.
    touched: (usize, usize),
    found: Found,
}

/// The cells, two in a byte, in a frame of obstacles. One column of frame serves two rows; some bytes behind the
/// last row let words be read there.
#[derive(Debug, Clone)]
struct Field {
    /// Even, so that a row begins at a byte.
    stride: usize,
    cells: Vec<u8>,
}

/// A shortest way, in parts.
#[derive(Debug, Clone, Copy, Default)]
struct Found {
    /// Steps through closed cells, from either end.
    out: [u32; 2],
    /// Steps of either flood, and the cells where they touch; `None` if the ends met before.
    met: Option<([u32; 2], [usize; 2])>,
    /// Where the ways out come together, if they do.
    joint: usize,
}

impl Found {
    fn steps(&self) -> u32 {
        self.out[0] + self.out[1] + self.met.map_or(0, |([first, second], _)| first + 1 + second)
    }
}

impl Field {
    fn new(map: &Map) -> Self {
        let (width, height) = (map.width() as usize, map.height() as usize);
        let stride = (width + 1).next_multiple_of(2);
        let mut cells = vec![0; stride / 2 * (height + 2) + 8];
        for (y, row) in cells[stride / 2..].chunks_exact_mut(stride / 2).take(height).enumerate() {
            for (i, bytes) in row.chunks_mut(8).enumerate().take(width.div_ceil(16)) {
                let word = free_word(map.obstacles(), y as u32, i / 4);
                let spread = spread_bits(word >> (i % 4 * 16) & 0xffff).to_le_bytes();
                bytes.copy_from_slice(&spread[..bytes.len()]);
            }
        }
        Self { stride, cells }
    }

    #[inline]
    fn get(&self, place: usize) -> u8 {
        self.cells[place / 2] >> (place % 2 * 4) & 15
    }

    /// The neighbours of a cell, in the order of their directions: the byte of each and the bits to its cell there.
    #[inline]
    const fn around(&self, place: usize) -> [(usize, usize); 4] {
        let (byte, odd, row) = (place / 2, place % 2, self.stride / 2);
        let (own, other) = (odd * 4, 4 - odd * 4);
        [(byte - row, own), (byte + odd - 1, other), (byte + odd, other), (byte + row, own)]
    }

    /// Changes an open cell.
    #[inline]
    fn set(&mut self, place: usize, value: u8) {
        self.cells[place / 2] ^= (value ^ OPEN) << (place % 2 * 4);
    }

    #[inline]
    const fn place(&self, cell: Cell) -> usize {
        (cell.y as usize + 1) * self.stride + cell.x as usize
    }

    const fn cell(&self, place: usize) -> Cell {
        Cell::new((place % self.stride) as i32, (place / self.stride) as i32 - 1)
    }

    /// Where the directions of the cells lead from a place, cell after cell, itself first.
    #[inline]
    fn follow<'a>(&self, mut place: usize, path: impl Iterator<Item = &'a mut Cell>) {
        let offsets = self.offsets();
        let mut cell = self.cell(place);
        for to in path {
            *to = cell;
            let dir = usize::from(self.get(place) & 3);
            place = place.wrapping_add_signed(offsets[dir]);
            cell = Cell::new(cell.x + STEPS[dir].0, cell.y + STEPS[dir].1);
        }
    }

    /// How many steps the directions of the cells lead from one place to another on their way.
    fn count(&self, mut place: usize, end: usize) -> u32 {
        let offsets = self.offsets();
        let mut steps = 0;
        while place != end {
            place = place.wrapping_add_signed(offsets[usize::from(self.get(place) & 3)]);
            steps += 1;
        }
        steps
    }

    /// A cell of the rim and its neighbour in the other flood, the first flood's first.
    fn touching(&self, rim: &[u32], flood: usize, other: u8) -> [usize; 2] {
        for &place in rim {
            for offset in self.offsets() {
                let (here, there) = (place as usize, (place as usize).wrapping_add_signed(offset));
                if self.get(there) & CLASS == other {
                    return if flood == 0 { [here, there] } else { [there, here] };
                }
            }
        }
        debug_assert!(false, "the floods do not touch");
        [0, 0]
    }

    const fn offsets(&self) -> [isize; 4] {
        let stride = self.stride as isize;
        [-stride, -1, 1, stride]
    }

    /// Closes all dead ends, each as far as it goes.
    fn close_dead_ends(&mut self) {
        let row = self.stride / 2;
        for byte in (row..self.cells.len() - row - 8).step_by(8) {
            // Sixteen cells a word. What looks open of a closed neighbour does no harm: its closing went on here.
            let word = |byte: usize| {
                self.cells[byte..byte + 8].iter().rev().fold(0, |word, &cells| word << 8 | u64::from(cells))
            };
            let here = word(byte);
            let west = here << 4 | u64::from(self.cells[byte - 1] >> 4);
            let east = here >> 4 | u64::from(self.cells[byte + 8]) << 60;
            let (north, south) = (word(byte - row), word(byte + row));
            let two = west & east | north & south | (west | east) & (north | south);
            let mut ends = here & !two & spread_bits(0xffff);
            while ends != 0 {
                self.close(byte * 2 + ends.trailing_zeros() as usize / 4);
                ends &= ends - 1;
            }
        }
    }

    /// Closes a cell if it is a dead end, and those that become one by that.
    fn close(&mut self, mut place: usize) {
        let offsets = self.offsets();
        while self.get(place) == OPEN {
            let around = self.around(place).into_iter().enumerate();
            let open = around.fold(0, |open: u32, (dir, (byte, shift))| {
                open | u32::from(self.cells[byte] >> shift & 15 == OPEN) << dir
            });
            if open == 0 {
                self.set(place, LAST);
            } else if open.is_power_of_two() {
                let dir = open.trailing_zeros();
                self.set(place, CLOSED | dir as u8);
                place = place.wrapping_add_signed(offsets[dir as usize]);
            } else {
                return;
            }
        }
    }
}

impl Ways {
    /// Prepares the map; each of the three rims takes `room` cells at most.
    pub(super) fn new(map: &Map, room: usize) -> Self {
        let field = Field::new(map);
        let places = field.cells.len() * 2;
        Self {
            field,
            is_closed: false,
            passed: vec![0; places.div_ceil(64)],
            rims: std::array::from_fn(|_| vec![0; room]),
            touched: (0, 0),
            found: Found::default(),
        }
    }

    /// The length of a shortest way between two different cells, `None` if there is none.
    ///
    /// # Errors
    /// [`OutOfRoom`] if a rim outgrows its memory.
    pub(super) fn run(&mut self, from: Cell, to: Cell) -> Result<Option<u32>, OutOfRoom> {
        if !std::mem::replace(&mut self.is_closed, true) {
            self.field.close_dead_ends();
        }
        self.reset();
        let ends = [self.field.place(from), self.field.place(to)];
        self.found = Found::default();
        let outs = self.leave(ends);
        if outs[0] == outs[1] {
            self.found.joint = outs[0];
            return Ok(Some(self.found.steps()));
        }
        if outs.iter().any(|&out| self.field.get(out) == LAST) {
            return Ok(None);
        }
        Ok(self.flood(outs)?.then(|| self.found.steps()))
    }

    /// Follows the ways out from both ends in turn until they meet; gives the cells where they come out, the same
    /// twice where they meet.
    fn leave(&mut self, ends: [usize; 2]) -> [usize; 2] {
        let offsets = self.field.offsets();
        let mut at = ends;
        let mut out = [0; 2];
        let (mut first, mut last) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        let mut moved = true;
        while moved {
            moved = false;
            for end in 0..2 {
                let place = at[end];
                let cell = self.field.get(place);
                if cell < CLOSED {
                    continue;
                }
                let passed = &mut self.passed[place / 64];
                if *passed >> (place % 64) & 1 == 1 {
                    // The other end came here before.
                    out[1 - end] = self.field.count(ends[1 - end], place);
                    (at[1 - end], moved) = (place, false);
                    break;
                }
                *passed |= 1 << (place % 64);
                at[end] = place.wrapping_add_signed(offsets[usize::from(cell & 3)]);
                out[end] += 1;
                (first, last) = (first.min(place), last.max(place));
                moved = true;
            }
        }
        self.found.out = out;
        self.touched = (first, last);
        at
    }

    /// Floods the open cells from both places, the shorter rim first, until the floods touch; false if they never do.
    fn flood(&mut self, springs: [usize; 2]) -> Result<bool, OutOfRoom> {
        let offsets = self.field.offsets();
        let (mut first, mut last) = self.touched;
        for (flood, &spring) in springs.iter().enumerate() {
            self.rims[flood][0] = spring as u32;
            self.field.set(spring, [FIRST, SECOND][flood]);
        }
        let mut len = [1, 1];
        let mut steps = [0, 0];
        let found = loop {
            let flood = usize::from(len[1] < len[0]);
            if len[flood] == 0 {
                break Ok(false);
            }
            let [one, two, next] = &mut self.rims;
            let rim = if flood == 0 { &mut *one } else { two };
            // A cell has three neighbours that are new, the spring four; one place is written in vain.
            if len[flood] * 3 + 2 > next.len() {
                break Err(OutOfRoom);
            }
            let (mine, other) = if flood == 0 { (FIRST, SECOND) } else { (SECOND, FIRST) };
            let mut new = 0;
            let mut met = false;
            for &place in &rim[..len[flood]] {
                (first, last) = (first.min(place as usize), last.max(place as usize));
                for (dir, (byte, shift)) in self.field.around(place as usize).into_iter().enumerate() {
                    // Without a branch: nobody foresees which neighbours are open.
                    let byte = &mut self.field.cells[byte];
                    let cell = *byte >> shift & 15;
                    met |= cell & CLASS == other;
                    let is_new = cell == OPEN;
                    *byte ^= if is_new { (mine | (3 - dir as u8)) ^ OPEN } else { 0 } << shift;
                    next[new] = place.wrapping_add_signed(offsets[dir] as i32);
                    new += usize::from(is_new);
                }
            }
            if met {
                self.found.met = Some((steps, self.field.touching(&rim[..len[flood]], flood, other)));
                break Ok(true);
            }
            std::mem::swap(rim, next);
            len[flood] = new;
            steps[flood] += 1;
        };
        self.touched = (first, last);
        found
    }

    fn reset(&mut self) {
        let (first, last) = self.touched;
        self.passed[first / 64..=last / 64].fill(0);
        // Reached cells lie beside those that were on a rim.
        let stride = self.field.stride;
        let cells = &mut self.field.cells;
        let end = cells.len().min(usize::midpoint(last, stride) + 1);
        for byte in &mut cells[first.saturating_sub(stride) / 2..end] {
            let reached = (*byte >> 2 ^ *byte >> 3) & 0x11;
            let all = reached | reached << 1;
            *byte = *byte & !(all | all << 2) | reached;
        }
        self.touched = (0, 0);
    }

    /// The cells of a shortest way, after [`run`](Self::run) found one of `steps` steps.
    pub(super) fn path(&self, from: Cell, to: Cell, steps: u32) -> Vec<Cell> {
        let mut path = vec![from; steps as usize + 1];
        let [first, second] = self.found.out.map(|out| out as usize);
        let (head, rest) = path.split_at_mut(first);
        let (middle, tail) = rest.split_at_mut(rest.len() - second);
        self.field.follow(self.field.place(from), head.iter_mut());
        self.field.follow(self.field.place(to), tail.iter_mut().rev());
        match self.found.met {
            Some((steps, places)) => {
                let (one, two) = middle.split_at_mut(steps[0] as usize + 1);
                self.field.follow(places[0], one.iter_mut().rev());
                self.field.follow(places[1], two.iter_mut());
            }
            // One cell, in which both ways out come together.
            None => middle[0] = self.field.cell(self.found.joint),
        }
        path
    }

    pub(super) fn bytes(&self) -> usize {
        let rims: usize = self.rims.iter().map(Vec::capacity).sum();
        self.field.cells.capacity() + self.passed.capacity() * 8 + rims * 4
    }
}

/// Puts three zeros before each of 16 bits.
#[inline]
const fn spread_bits(bits: u64) -> u64 {
    let bits = (bits | bits << 24) & 0x0000_00ff_0000_00ff;
    let bits = (bits | bits << 12) & 0x000f_000f_000f_000f;
    let bits = (bits | bits << 6) & 0x0303_0303_0303_0303;
    (bits | bits << 3) & 0x1111_1111_1111_1111
}
