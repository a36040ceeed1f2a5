//! The wave on bits: 16 × 16 cells in four words, and a list of the tiles in which the wave's front stands.
//!
//! One step of the automaton shifts the front of a tile by a cell to each side, for its 256 cells at once. Only tiles
//! that hold a part of the front are visited, so a step costs what the front is long, not what the map is large.
//! Rows of the map instead of square tiles would be visited once a cell: on a lattice a front runs diagonally, and
//! cuts a row in one place only. In a tile of 8 × 8 cells it holds four cells, in one of 16 × 16 eight; a visit costs a
//! third more, since four words are one vector.
//!
//! Whether a front leaves its tile on some side is a toss-up on ragged floors, and a wrong guess costs a processor as
//! much as half the visit. So nothing branches: what may leave is written to a list whose end moves on only if
//! something did, and the list is worked off at the end of the step.
//!
//! Source: bit-parallel breadth-first search is folklore of the four-colour board games (*kogge-stone* and *dumb7*
//! fills, Chess Programming Wiki, "Fill Algorithms").

use super::tiles::transpose;
use crate::lattice::{Cell, Lattice};
use crate::map::Map;

/// The 256 cells of a tile, four rows in a word; bit `16 · (row mod 4) + column` is a cell.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[repr(align(32))]
pub(super) struct Bits(pub(super) [u64; 4]);

impl Bits {
    /// Adds the cells of a front if `bit` is odd.
    #[inline]
    pub(super) fn add(&mut self, front: &Self, bit: u32) {
        let mask = u64::from(bit & 1).wrapping_neg();
        for (word, front) in self.0.iter_mut().zip(front.0) {
            *word |= front & mask;
        }
    }
}

/// Columns and rows of a tile.
pub(super) const SIDE: usize = 16;
/// Tiles in a block: as many as a word of the map's row covers.
const BLOCK: usize = 4;
/// Column 0 of a tile.
const WEST: u64 = 0x0001_0001_0001_0001;
/// Column 15.
const EAST: u64 = WEST << 15;
/// The even rows; the rows of a tile have the parity of the map's rows.
const EVEN: u64 = 0x0000_ffff_0000_ffff;
/// The time of the targets: steps count from here, so that a record of zeros lies long ago.
pub(super) const FIRST: u32 = 64;

/// What a flood keeps of the cells of a tile.
pub(super) trait Record: Copy + Default {
    /// Whether [`renew`](Self::renew) must come first; so for the first front of a tile.
    #[inline]
    fn is_full(&self, _time: u32) -> bool {
        false
    }
    /// Makes room for this time; says whether this is the tile's first front.
    fn renew(&mut self, _time: u32, _older: &mut Vec<Self>) -> bool {
        false
    }
    /// Notes the cells that the wave reached at this time.
    fn put(&mut self, time: u32, front: &Bits);
}

/// The map as tiles, with a rim of tiles without a free cell so that every tile has neighbours.
pub(super) struct Tiles<'a, R> {
    ground: Ground<'a>,
    /// Free cells near the wave that it has not reached.
    open: Vec<Bits>,
    /// Cells that were reached in this step.
    fronts: Vec<Bits>,
    pub(super) records: Vec<R>,
    /// Records that were full.
    pub(super) older: Vec<R>,
    lists: Lists,
}

/// The tiles in which the front stands and will stand, and what leaves them: kept from flood to flood.
#[derive(Default)]
struct Lists {
    rim: Vec<u32>,
    next: Vec<u32>,
    events: Vec<Event>,
}

/// Which part of the map the wave knows: free cells are learnt when it comes near, so that what it never reaches
/// costs nothing.
struct Ground<'a> {
    map: &'a Map,
    /// Tiles in a row, the rim included.
    across: usize,
    /// Blocks in a row.
    blocks: usize,
    /// Whether a block is known, and whether all around it are.
    known: Vec<[bool; 2]>,
}

/// Cells that a front reaches in another tile.
#[derive(Debug, Clone, Copy, Default)]
struct Event {
    new: Bits,
    tile: u32,
}

/// Most tiles that one front reaches, its own not counted, and room for appending without a check each.
const SLOTS: usize = 8;

impl Ground<'_> {
    /// Learns the block of a tile and those around it.
    fn learn_around(&mut self, tile: usize, open: &mut [Bits]) {
        let (row, block) = (tile / self.across - 1, (tile % self.across - 1) / BLOCK);
        if std::mem::replace(&mut self.known[row * self.blocks + block][1], true) {
            return;
        }
        let rows = self.known.len() / self.blocks;
        for row in row.saturating_sub(1)..(row + 2).min(rows) {
            for block in block.saturating_sub(1)..(block + 2).min(self.blocks) {
                if !std::mem::replace(&mut self.known[row * self.blocks + block][0], true) {
                    self.learn(row, block, open);
                }
            }
        }
    }

    fn learn(&self, row: usize, block: usize, open: &mut [Bits]) {
        let width = self.map.width() as usize;
        let last = u64::MAX >> ((64 - width % 64) % 64);
        let inside = if block + 1 == self.blocks { last } else { u64::MAX };
        let mut words = [0; SIDE];
        for (y, word) in (row * SIDE..self.map.height() as usize).zip(&mut words) {
            *word = !self.map.obstacles().row(y as u32)[block] & inside;
        }
        let tiles = self.tiles(row, block);
        for (i, rows) in words.as_chunks_mut::<BLOCK>().0.iter_mut().enumerate() {
            transpose(rows);
            for (tile, word) in open[tiles.clone()].iter_mut().zip(rows) {
                tile.0[i] = *word;
            }
        }
    }

    /// The tiles of a block.
    fn tiles(&self, row: usize, block: usize) -> std::ops::Range<usize> {
        let first = (row + 1) * self.across + block * BLOCK + 1;
        first..first + (self.across - 2 - block * BLOCK).min(BLOCK)
    }
}

impl<'a, R: Record> Tiles<'a, R> {
    pub(super) fn new(map: &'a Map) -> Self {
        let (across, down) =
            ((map.width() as usize).div_ceil(SIDE) + 2, (map.height() as usize).div_ceil(SIDE));
        let tiles = across * (down + 2);
        let blocks = (map.width() as usize).div_ceil(64);
        Self {
            ground: Ground { map, across, blocks, known: vec![[false; 2]; blocks * down] },
            open: vec![Bits::default(); tiles],
            fronts: vec![Bits::default(); tiles],
            records: vec![R::default(); tiles],
            older: Vec::new(),
            lists: Lists::default(),
        }
    }

    /// Learns the whole map at once, for many floods; gives the free cells, for [`refill`](Self::refill).
    pub(super) fn learn_all(&mut self) -> Vec<Bits> {
        for block in 0..self.ground.known.len() {
            self.ground.learn(block / self.ground.blocks, block % self.ground.blocks, &mut self.open);
        }
        self.ground.known.fill([true; 2]);
        self.open.clone()
    }

    /// Makes ready for another flood over these free cells.
    pub(super) fn refill(&mut self, free: &[Bits]) {
        self.open.copy_from_slice(free);
        self.records.fill(R::default());
    }

    /// Tiles in a row, the rim included.
    pub(super) const fn across(&self) -> usize {
        self.ground.across
    }

    /// Spreads the wave from all `targets` at once.
    pub(super) fn flood(&mut self, targets: &[Cell]) {
        self.flood_from(targets, FIRST);
    }

    /// Spreads the wave from all `targets`, which are reached at time `time`.
    pub(super) fn flood_from(&mut self, targets: &[Cell], mut time: u32) {
        let Lists { mut rim, mut next, mut events } = std::mem::take(&mut self.lists);
        rim.resize(rim.len().max(targets.len() + 1), 0);
        let mut len = 0;
        for target in targets {
            let (x, y) = (target.x as usize, target.y as usize);
            let (tile, word, bit) = place(x, y, self.ground.across);
            self.ground.learn_around(tile, &mut self.open);
            rim[len] = tile as u32;
            len += usize::from(!any(&self.fronts[tile]));
            self.fronts[tile].0[word] |= 1 << bit;
            self.open[tile].0[word] &= !(1 << bit);
        }
        while len > 0 {
            if events.len() < len * SLOTS {
                events.resize(2 * len * SLOTS, Event::default());
            }
            if next.len() <= len * SLOTS {
                next.resize(2 * len * SLOTS, 0);
            }
            len = match self.ground.map.lattice() {
                Lattice::Square => self.step::<false>(&rim[..len], time, &mut next, &mut events),
                Lattice::Hex => self.step::<true>(&rim[..len], time, &mut next, &mut events),
            };
            std::mem::swap(&mut rim, &mut next);
            time += 1;
        }
        self.lists = Lists { rim, next, events };
    }

    /// One step of the wave in the tiles of `rim`. Fills `next` with the tiles of the next, and says how many they
    /// are.
    fn step<const HEX: bool>(
        &mut self,
        rim: &[u32],
        time: u32,
        next: &mut [u32],
        events: &mut [Event],
    ) -> usize {
        let Self { ground, open, fronts, records, older, .. } = self;
        let across = ground.across;
        let tiles = records.len();
        let (open, fronts, records) = (&mut open[..tiles], &mut fronts[..tiles], &mut records[..tiles]);
        let (mut len, mut out) = (0, 0);
        for &tile in rim {
            let tile = tile as usize;
            let record = &mut records[tile];
            if record.is_full(time) {
                renew(record, time, older, ground, tile, open);
            }
            let front = fronts[tile];
            record.put(time, &front);
            let east = each(|i| (front.0[i] & !EAST) << 1);
            let west = each(|i| (front.0[i] & !WEST) >> 1);
            // Columns that the front touches in the rows above and below.
            let beside =
                if HEX { each(|i| front.0[i] | west.0[i] & EVEN | east.0[i] & !EVEN) } else { front };
            let (up, down) = (up(&beside), down(&beside));
            let here = &mut open[tile];
            let new = each(|i| (east.0[i] | west.0[i] | up.0[i] | down.0[i]) & here.0[i]);
            *here = each(|i| here.0[i] ^ new.0[i]);
            fronts[tile] = new;
            next[len] = tile as u32;
            len += usize::from(any(&new));
            let Some(slots) = events.get_mut(out..).and_then(|rest| rest.first_chunk_mut()) else { break };
            out += leave::<HEX>(&front, &beside, open, [tile, across], slots);
        }
        for &Event { new, tile } in &events[..out] {
            let front = &mut fronts[tile as usize];
            next[len] = tile;
            len += usize::from(!any(front));
            *front = each(|i| front.0[i] | new.0[i]);
            let open = &mut open[tile as usize];
            *open = each(|i| open.0[i] & !new.0[i]);
        }
        len
    }

    /// Calls `sink` with each row of a plane, from the top: its number and its words, in the form of
    /// [`crate::BitPlane::row`].
    pub(super) fn rows(&self, plane: impl Fn(&R) -> Bits, mut sink: impl FnMut(usize, &[u64])) {
        let ground = &self.ground;
        let (width, height) = (ground.map.width() as usize, ground.map.height() as usize);
        let last = u64::MAX >> ((64 - width % 64) % 64);
        let mut buffer = vec![0; SIDE * ground.blocks];
        for top in (0..height).step_by(SIDE) {
            for block in 0..ground.blocks {
                let mut square = [Bits::default(); BLOCK];
                let records = &self.records[ground.tiles(top / SIDE, block)];
                for (record, bits) in records.iter().zip(&mut square) {
                    *bits = plane(record);
                }
                for i in 0..4 {
                    let mut rows = square.map(|tile| tile.0[i]);
                    transpose(&mut rows);
                    for (row, bits) in rows.into_iter().enumerate() {
                        buffer[(4 * i + row) * ground.blocks + block] = bits;
                    }
                }
            }
            for (y, row) in (top..height.min(top + SIDE)).zip(buffer.chunks_exact_mut(ground.blocks)) {
                row[ground.blocks - 1] &= last;
                sink(y, row);
            }
        }
    }
}

/// The tile of a cell, and its word and bit there.
#[inline]
pub(super) const fn place(x: usize, y: usize, across: usize) -> (usize, usize, usize) {
    ((y / SIDE + 1) * across + x / SIDE + 1, y % SIDE / 4, y % 4 * SIDE + x % SIDE)
}

/// Kept out of the loop over the tiles: it is seldom needed.
#[cold]
#[inline(never)]
fn renew<R: Record>(
    record: &mut R,
    time: u32,
    older: &mut Vec<R>,
    ground: &mut Ground,
    tile: usize,
    open: &mut [Bits],
) {
    if record.renew(time, older) {
        ground.learn_around(tile, open);
    }
}

/// Lists the open cells that a front reaches in the tiles around its own; says in how many tiles.
#[inline]
fn leave<const HEX: bool>(
    front: &Bits,
    beside: &Bits,
    open: &[Bits],
    [tile, across]: [usize; 2],
    slots: &mut [Event; SLOTS],
) -> usize {
    let mut count = 0;
    let mut outside = |tile: usize, new: Bits| {
        slots[count] = Event { new, tile: tile as u32 };
        count += usize::from(any(&new));
    };
    let (north, south) = (tile - across, tile + across);
    outside(north, Bits([0, 0, 0, beside.0[0] << 48 & open[north].0[3]]));
    outside(south, Bits([beside.0[3] >> 48 & open[south].0[0], 0, 0, 0]));
    let mut to_west = each(|i| (front.0[i] & WEST) << 15);
    let mut to_east = each(|i| (front.0[i] & EAST) >> 15);
    if HEX {
        to_west = slanted(&to_west, EVEN);
        to_east = slanted(&to_east, !EVEN);
    }
    let (at_west, at_east) = (&open[tile - 1], &open[tile + 1]);
    outside(tile - 1, each(|i| to_west.0[i] & at_west.0[i]));
    outside(tile + 1, each(|i| to_east.0[i] & at_east.0[i]));
    if HEX {
        // Row 0 is even: its western end touches the tile above and to the left.
        outside(north - 1, Bits([0, 0, 0, front.0[0] << 63 & open[north - 1].0[3]]));
        // Row 15 is odd: its eastern end touches the tile below and to the right.
        outside(south + 1, Bits([front.0[3] >> 63 & open[south + 1].0[0], 0, 0, 0]));
    }
    count
}

#[inline]
fn each(word: impl Fn(usize) -> u64) -> Bits {
    Bits([word(0), word(1), word(2), word(3)])
}

#[inline]
fn any(bits: &Bits) -> bool {
    bits.0[0] | bits.0[1] | bits.0[2] | bits.0[3] != 0
}

/// Every row of cells moved to the row above.
#[inline]
fn up(bits: &Bits) -> Bits {
    let [a, b, c, d] = bits.0;
    Bits([a >> 16 | b << 48, b >> 16 | c << 48, c >> 16 | d << 48, d >> 16])
}

/// Every row of cells moved to the row below.
#[inline]
fn down(bits: &Bits) -> Bits {
    let [a, b, c, d] = bits.0;
    Bits([a << 16, b << 16 | a >> 48, c << 16 | b >> 48, d << 16 | c >> 48])
}

/// On hexagons every other row also touches the rows above and below in the column beside it.
#[inline]
fn slanted(side: &Bits, rows: u64) -> Bits {
    let slanted = each(|i| side.0[i] & rows);
    let (up, down) = (up(&slanted), down(&slanted));
    each(|i| side.0[i] | up.0[i] | down.0[i])
}
