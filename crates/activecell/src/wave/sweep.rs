//! Full fields by an asynchronous tile automaton: tiles of 32 × 16 cells are relaxed to their fixed point, one
//! after the other, nearest first.
//!
//! Inside a tile every cell runs the local rule "one step more than my nearest neighbour" until nothing changes:
//! whole rows of 32 cells at a time, downwards and upwards, and along the rows in steps of 1, 2, 4, 8 and 16
//! cells. A tile without obstacles needs no rounds at all: its distances are the least of four sums, one from
//! each side. When a tile's border has become nearer for a neighbouring tile, that tile is woken; a queue of
//! buckets wakes the tiles roughly in the order in which the wave reaches them, so that in open floors each is
//! woken once.
//!
//! The rows are written as plain loops over arrays that compilers turn into vector instructions. For their sake a
//! cell holds its *nearness*, 65 535 less the distance: then 0 is an obstacle, nearer is greater, subtraction
//! saturates at "obstacle", and memory that was never touched reads as "not reached".

use crate::lattice::{Cell, Lattice};
use crate::map::Map;

/// Columns and rows of a tile.
pub(super) const TILE_W: usize = 32;
pub(super) const TILE_H: usize = 16;
/// Nearness of an obstacle, of a free cell that the wave has not reached, and of the target.
const WALL: u16 = 0;
const FREE: u16 = 1;
const HERE: u16 = u16::MAX;
/// A tile may be woken by distances up to this: inside it they grow by less than its 512 cells.
const MAX_STEPS: u32 = (HERE - FREE) as u32 - 512;

/// The bit of each column in a row of walls.
const LANES: [u32; TILE_W] = {
    let mut lanes = [0; TILE_W];
    let mut i = 0;
    while i < TILE_W {
        lanes[i] = 1 << i;
        i += 1;
    }
    lanes
};

/// One row of a tile.
type Row = [u16; TILE_W];
/// A tile, row by row.
pub(super) type Tile = [Row; TILE_H];

/// Where a tile's own columns begin in a row of the work space.
const PAD: usize = 16;
/// A tile with a rim of its neighbours' cells, and obstacles beyond.
#[repr(align(64))]
struct Work(Rows);
type Rows = [[u16; 64]; TILE_H + 2];

/// How many distances a bucket holds; about the width of a tile.
const BUCKET_STEPS: u32 = 16;
/// When the tiles have been woken so often, it is looked whether that was too often ([`Automaton::pays`]), and
/// again after each doubling.
const TRIAL: usize = 128;
const NIL: u32 = u32::MAX;

/// The distances of a map in tiles.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Tiles {
    across: usize,
    tiles: Vec<Tile>,
}

impl Tiles {
    /// The steps of a cell of the map; `None` where the wave did not come.
    #[inline]
    pub(super) fn steps(&self, x: u32, y: u32) -> Option<u32> {
        let (x, y) = (x as usize, y as usize);
        let tile = &self.tiles[y / TILE_H * self.across + x / TILE_W];
        let near = tile[y % TILE_H][x % TILE_W];
        (near > FREE).then(|| u32::from(HERE - near))
    }
}

/// Floods the map from all `targets`. `None` if a distance does not fit into 16 bits, or if the map turns out to
/// be one for another method.
pub(super) fn flood(map: &Map, targets: &[Cell]) -> Option<Tiles> {
    let mut automaton = Automaton::new(map);
    for target in targets {
        automaton.start(*target);
    }
    let done = match map.lattice() {
        Lattice::Square => automaton.run::<false>(),
        Lattice::Hex => automaton.run::<true>(),
    };
    done.then_some(Tiles { across: automaton.across, tiles: automaton.tiles })
}

/// What the automaton knows of a tile besides its cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Status {
    /// Its free cells are marked.
    known: bool,
    /// It has no obstacle and no target.
    open: bool,
    /// It waits in a bucket.
    queued: bool,
}

struct Automaton<'a> {
    map: &'a Map,
    across: usize,
    down: usize,
    tiles: Vec<Tile>,
    status: Vec<Status>,
    buckets: Vec<u32>,
    /// Entries of the buckets' lists: a tile and the next entry.
    entries: Vec<(u32, u32)>,
    /// How many tiles are known, and how often a tile was woken.
    known: usize,
    woken: usize,
    work: Box<Work>,
}

/// The cells of the neighbouring tiles that touch a tile.
struct Rim {
    top: Row,
    bottom: Row,
    left: [u16; TILE_H],
    right: [u16; TILE_H],
    /// On hexagons also the last cell of the tile up and left, and the first of the one down and right.
    up_left: u16,
    down_right: u16,
}

impl<'a> Automaton<'a> {
    fn new(map: &'a Map) -> Self {
        let across = (map.width() as usize).div_ceil(TILE_W);
        let down = (map.height() as usize).div_ceil(TILE_H);
        let status = Status { known: false, open: false, queued: false };
        Self {
            map,
            across,
            down,
            tiles: vec![[[WALL; TILE_W]; TILE_H]; across * down],
            status: vec![status; across * down],
            buckets: Vec::new(),
            entries: Vec::new(),
            known: 0,
            woken: 0,
            work: Box::new(Work([[WALL; 64]; TILE_H + 2])),
        }
    }

    fn start(&mut self, target: Cell) {
        let (x, y) = (target.x as usize, target.y as usize);
        let tile = y / TILE_H * self.across + x / TILE_W;
        self.learn(tile);
        self.tiles[tile][y % TILE_H][x % TILE_W] = HERE;
        // Its distances do not all come from its border.
        self.status[tile].open = false;
        self.wake(tile, 0);
    }

    /// The obstacles of a tile, row by row, bit 0 on the left; beyond the map all are.
    fn walls(&self, tile: usize) -> [u32; TILE_H] {
        let (tx, top) = (tile % self.across, tile / self.across * TILE_H);
        let plane = self.map.obstacles();
        let inside = (self.map.width() as usize - tx * TILE_W).min(TILE_W);
        let beyond = !(u64::from(u32::MAX) >> (TILE_W - inside)) as u32;
        let mut walls = [!0; TILE_H];
        let rows = (self.map.height() as usize - top).min(TILE_H);
        for (y, walls) in walls[..rows].iter_mut().enumerate() {
            *walls = (plane.row((top + y) as u32)[tx / 2] >> (TILE_W * (tx % 2))) as u32 | beyond;
        }
        walls
    }

    /// Marks the free cells of a tile, once.
    fn learn(&mut self, tile: usize) {
        if self.status[tile].known {
            return;
        }
        self.known += 1;
        let walls = self.walls(tile);
        let open = walls.iter().all(|&row| row == 0);
        self.status[tile] = Status { known: true, open, queued: false };
        if open {
            self.tiles[tile] = [[FREE; TILE_W]; TILE_H];
            return;
        }
        for (row, walls) in self.tiles[tile].iter_mut().zip(walls) {
            for (cell, lane) in row.iter_mut().zip(LANES) {
                *cell = if walls & lane == 0 { FREE } else { WALL };
            }
        }
    }

    fn wake(&mut self, tile: usize, steps: u32) {
        if std::mem::replace(&mut self.status[tile].queued, true) {
            return;
        }
        let bucket = (steps / BUCKET_STEPS) as usize;
        if bucket >= self.buckets.len() {
            self.buckets.resize(bucket + 1, NIL);
        }
        self.entries.push((tile as u32, self.buckets[bucket]));
        self.buckets[bucket] = self.entries.len() as u32 - 1;
    }

    /// Whether tiles are the right means for this map. Where walls cut tiles into parts that the wave reaches at
    /// different times, each is woken again and again. Measured after 128, 256, 512, … times, per known tile:
    /// rooms, halls, streets and 20 % of random obstacles stay below 1.3, 1.45, 1.6, 1.8; mazes of four cells and
    /// 40 % of random obstacles, where other methods are faster, are above 1.3, 1.6, 1.9, 2.5.
    fn pays(&self) -> bool {
        if self.woken < TRIAL || !self.woken.is_power_of_two() {
            return true;
        }
        let doublings = (self.woken / TRIAL).ilog2().min(4);
        let woken_each = self.woken as f64 / self.known as f64;
        woken_each < 1.4 + 0.2 * f64::from(doublings)
    }

    /// Wakes tiles until none is left; says whether that went well.
    fn run<const HEX: bool>(&mut self) -> bool {
        let mut bucket = 0;
        while bucket < self.buckets.len() {
            let entry = self.buckets[bucket];
            if entry == NIL {
                bucket += 1;
                continue;
            }
            let (tile, next) = self.entries[entry as usize];
            self.buckets[bucket] = next;
            self.status[tile as usize].queued = false;
            self.woken += 1;
            let farthest = self.activate::<HEX>(tile as usize, bucket as u32 * BUCKET_STEPS);
            if farthest > MAX_STEPS || !self.pays() {
                return false;
            }
        }
        true
    }

    /// Relaxes a tile and wakes the neighbours for which it has become nearer. Says how far its border is at
    /// the most, as far as it wakes anyone.
    fn activate<const HEX: bool>(&mut self, tile: usize, now: u32) -> u32 {
        let (tx, ty) = (tile % self.across, tile / self.across);
        let (west, east) = (tx > 0, tx + 1 < self.across);
        let (north, south) = (ty > 0, ty + 1 < self.down);
        let across = self.across;
        let mut neighbours = [NIL as usize; 6];
        for (slot, exists, index) in [
            (0, north, tile.wrapping_sub(across)),
            (1, south, tile + across),
            (2, west, tile.wrapping_sub(1)),
            (3, east, tile + 1),
            (4, HEX && north && west, tile.wrapping_sub(across + 1)),
            (5, HEX && south && east, tile + across + 1),
        ] {
            if exists {
                self.learn(index);
                neighbours[slot] = index;
            }
        }
        let rim = self.rim(&neighbours);
        if self.status[tile].open && !HEX {
            relax_open(&mut self.tiles[tile], &rim);
        } else {
            self.relax::<HEX>(tile, &rim);
        }
        let gains = gains::<HEX>(&self.tiles[tile], &rim);
        let mut farthest = 0;
        for (&index, gain) in neighbours.iter().zip(gains) {
            if gain > WALL {
                let steps = u32::from(HERE - gain);
                farthest = farthest.max(steps);
                // What was improved late still belongs to the present.
                self.wake(index, steps.max(now));
            }
        }
        farthest
    }

    fn rim(&self, neighbours: &[usize; 6]) -> Rim {
        let tile = |slot: usize| self.tiles.get(neighbours[slot]);
        let column = |slot: usize, x: usize| {
            tile(slot).map_or([WALL; TILE_H], |tile| std::array::from_fn(|y| tile[y][x]))
        };
        Rim {
            top: tile(0).map_or([WALL; TILE_W], |tile| tile[TILE_H - 1]),
            bottom: tile(1).map_or([WALL; TILE_W], |tile| tile[0]),
            left: column(2, TILE_W - 1),
            right: column(3, 0),
            up_left: tile(4).map_or(WALL, |tile| tile[TILE_H - 1][TILE_W - 1]),
            down_right: tile(5).map_or(WALL, |tile| tile[0][0]),
        }
    }

    /// Relaxes a tile with obstacles to its fixed point, in the work space.
    fn relax<const HEX: bool>(&mut self, tile: usize, rim: &Rim) {
        let walls = self.walls(tile);
        let work = &mut self.work.0;
        let cells = &mut self.tiles[tile];
        work[0][PAD..PAD + TILE_W].copy_from_slice(&rim.top);
        work[TILE_H + 1][PAD..PAD + TILE_W].copy_from_slice(&rim.bottom);
        work[0][PAD - 1] = rim.up_left;
        work[TILE_H + 1][PAD + TILE_W] = rim.down_right;
        for (y, row) in work[1..=TILE_H].iter_mut().enumerate() {
            row[PAD..PAD + TILE_W].copy_from_slice(&cells[y]);
            row[PAD - 1] = rim.left[y];
            row[PAD + TILE_W] = rim.right[y];
            // The steps along the row reach 31 cells; the rim is a 32nd.
            for (inner, outer) in [(PAD, PAD - 1), (PAD + TILE_W - 1, PAD + TILE_W)] {
                if row[inner] != WALL {
                    row[inner] = row[inner].max(row[outer].saturating_sub(1));
                }
            }
        }
        let mut open_rows = unsettled(work);
        loop {
            settle_rows(work, &walls, open_rows);
            settle_columns::<HEX>(work);
            open_rows = unsettled(work);
            if open_rows == 0 && !(HEX && unsettled_columns(work)) {
                break;
            }
        }
        for (y, row) in cells.iter_mut().enumerate() {
            row.copy_from_slice(&work[y + 1][PAD..PAD + TILE_W]);
        }
    }
}

/// A tile of squares without obstacles: the nearest of its four sides, each side closed along itself.
fn relax_open(tile: &mut Tile, rim: &Rim) {
    let (top, bottom, left, right) = (along(rim.top), along(rim.bottom), along(rim.left), along(rim.right));
    for (y, row) in tile.iter_mut().enumerate() {
        let (down, up) = (y as u16 + 1, (TILE_H - y) as u16);
        for x in 0..TILE_W {
            let vertical = top[x].saturating_sub(down).max(bottom[x].saturating_sub(up));
            let from_left = left[y].saturating_sub(x as u16 + 1);
            let from_right = right[y].saturating_sub((TILE_W - x) as u16);
            row[x] = vertical.max(from_left).max(from_right);
        }
    }
}

/// A line of cells in which each knows of all others.
fn along<const N: usize>(mut line: [u16; N]) -> [u16; N] {
    // A side that comes from an open tile is settled already.
    let mut behind = 0;
    for i in 1..N {
        let (a, b) = (line[i - 1], line[i]);
        behind |= a.saturating_sub(1).saturating_sub(b) | b.saturating_sub(1).saturating_sub(a);
    }
    if behind == 0 {
        return line;
    }
    for i in 1..N {
        line[i] = line[i].max(line[i - 1].saturating_sub(1));
    }
    for i in (1..N).rev() {
        line[i - 1] = line[i - 1].max(line[i].saturating_sub(1));
    }
    line
}

/// The rows in which a free cell is more than a step behind its neighbours in the row, a bit each.
fn unsettled(work: &Rows) -> u32 {
    let mut rows = 0;
    for (y, row) in work[1..=TILE_H].iter().enumerate() {
        let mut behind = [0; TILE_W];
        for (i, behind) in behind.iter_mut().enumerate() {
            let here = row[PAD + i];
            let nearest = row[PAD + i - 1].max(row[PAD + i + 1]).saturating_sub(1);
            let here = if here == WALL { HERE } else { here };
            *behind = nearest.saturating_sub(here);
        }
        let any = behind.iter().fold(0, |any, &behind| any | behind);
        rows |= u32::from(any != 0) << y;
    }
    rows
}

/// Closes these rows: each cell learns of all others in its run of free cells, in steps of 1, 2, 4, 8 and 16.
fn settle_rows(work: &mut Rows, walls: &[u32; TILE_H], rows: u32) {
    let mut list = [0; TILE_H];
    let mut count = 0;
    for y in 0..TILE_H {
        list[count] = y;
        count += (rows >> y & 1) as usize;
    }
    let list = &list[..count];
    // Bit i of `blocked`: an obstacle lies between the cell and the one that the step looks at.
    let mut blocked = *walls;
    step_rows::<{ PAD - 1 }>(work, &mut blocked, list, |bits| bits << 1);
    step_rows::<{ PAD - 2 }>(work, &mut blocked, list, |bits| bits << 2);
    step_rows::<{ PAD - 4 }>(work, &mut blocked, list, |bits| bits << 4);
    step_rows::<{ PAD - 8 }>(work, &mut blocked, list, |bits| bits << 8);
    step_rows::<{ PAD - 16 }>(work, &mut blocked, list, |bits| bits << 16);
    let mut blocked = *walls;
    step_rows::<{ PAD + 1 }>(work, &mut blocked, list, |bits| bits >> 1);
    step_rows::<{ PAD + 2 }>(work, &mut blocked, list, |bits| bits >> 2);
    step_rows::<{ PAD + 4 }>(work, &mut blocked, list, |bits| bits >> 4);
    step_rows::<{ PAD + 8 }>(work, &mut blocked, list, |bits| bits >> 8);
    step_rows::<{ PAD + 16 }>(work, &mut blocked, list, |bits| bits >> 16);
}

/// One step along rows: each cell looks at the one `FROM − PAD` columns away.
#[inline]
fn step_rows<const FROM: usize>(
    work: &mut Rows,
    blocked: &mut [u32; TILE_H],
    list: &[usize],
    shift: impl Fn(u32) -> u32,
) {
    let steps = FROM.abs_diff(PAD) as u16;
    for &y in list {
        let row = &mut work[y + 1];
        let bits = blocked[y];
        let mut next = [0; TILE_W];
        for (i, next) in next.iter_mut().enumerate() {
            // All ones where the way is free.
            let pass = ((bits >> i & 1) as u16).wrapping_sub(1);
            *next = row[PAD + i].max(row[FROM + i].saturating_sub(steps) & pass);
        }
        row[PAD..PAD + TILE_W].copy_from_slice(&next);
        blocked[y] = bits | shift(bits);
    }
}

/// Each row learns from the one above, downwards, then from the one below, upwards.
fn settle_columns<const HEX: bool>(work: &mut Rows) {
    let mut last = own(&work[0]);
    for y in 1..=TILE_H {
        last = learn_row::<HEX>(work, y, y - 1, &last);
    }
    let mut last = own(&work[TILE_H + 1]);
    for y in (1..=TILE_H).rev() {
        last = learn_row::<HEX>(work, y, y + 1, &last);
    }
}

/// A tile's own columns of a row of the work space.
fn own(row: &[u16; 64]) -> Row {
    std::array::from_fn(|i| row[PAD + i])
}

/// On hexagons a row touches two cells of the next: its own column, and in even rows the one to the left, in odd
/// rows the one to the right. (Row 0 of a tile is the work space's row 1.)
const fn second(y: usize) -> usize {
    if y % 2 == 1 { PAD - 1 } else { PAD + 1 }
}

/// Row `y` learns from the row `from` beside it, whose own columns are `last`: kept at hand, since reading back
/// what was just written makes a processor wait.
fn learn_row<const HEX: bool>(work: &mut Rows, y: usize, from: usize, last: &Row) -> Row {
    let mut near = *last;
    if HEX {
        for (i, near) in near.iter_mut().enumerate() {
            *near = (*near).max(work[from][second(y) + i]);
        }
    }
    let row = &mut work[y];
    let next: Row = std::array::from_fn(|i| {
        let here = row[PAD + i];
        if here == WALL { WALL } else { here.max(near[i].saturating_sub(1)) }
    });
    row[PAD..PAD + TILE_W].copy_from_slice(&next);
    next
}

/// Whether on hexagons a cell is more than a step behind one of the rows beside it.
fn unsettled_columns(work: &Rows) -> bool {
    let mut any = 0;
    for y in 1..=TILE_H {
        let (row, above, below) = (&work[y], &work[y - 1], &work[y + 1]);
        for i in 0..TILE_W {
            let here = if row[PAD + i] == WALL { HERE } else { row[PAD + i] };
            let first = above[PAD + i].max(below[PAD + i]);
            let second = above[second(y) + i].max(below[second(y) + i]);
            any |= first.max(second).saturating_sub(1).saturating_sub(here);
        }
    }
    any != 0
}

/// For each neighbouring tile the nearest of this tile's cells by which one of its cells becomes nearer; 0 for
/// none.
fn gains<const HEX: bool>(tile: &Tile, rim: &Rim) -> [u16; 6] {
    let (first, last) = (&tile[0], &tile[TILE_H - 1]);
    let left: [u16; TILE_H] = std::array::from_fn(|y| tile[y][0]);
    let right: [u16; TILE_H] = std::array::from_fn(|y| tile[y][TILE_W - 1]);
    if !HEX {
        return [
            gain(first, &rim.top),
            gain(last, &rim.bottom),
            gain(&left, &rim.left),
            gain(&right, &rim.right),
            WALL,
            WALL,
        ];
    }
    // Each of the neighbour's cells touches up to three of this tile's.
    let to_top: Row = std::array::from_fn(|i| first[i].max(*first.get(i + 1).unwrap_or(&WALL)));
    let to_bottom: Row = std::array::from_fn(|i| if i > 0 { last[i].max(last[i - 1]) } else { last[0] });
    let three = |column: &[u16; TILE_H], parity: usize| {
        std::array::from_fn::<u16, TILE_H, _>(|y| {
            let beside = if y % 2 == parity {
                let above = if y > 0 { column[y - 1] } else { WALL };
                above.max(*column.get(y + 1).unwrap_or(&WALL))
            } else {
                WALL
            };
            column[y].max(beside)
        })
    };
    [
        gain(&to_top, &rim.top),
        gain(&to_bottom, &rim.bottom),
        gain(&three(&left, 1), &rim.left),
        gain(&three(&right, 0), &rim.right),
        gain(&[first[0]], &[rim.up_left]),
        gain(&[last[TILE_W - 1]], &[rim.down_right]),
    ]
}

/// The greatest of `new` that makes the cell of `old` beside it nearer; 0 if none does.
#[inline]
fn gain<const N: usize>(new: &[u16; N], old: &[u16; N]) -> u16 {
    let mut best = WALL;
    for i in 0..N {
        // No short cut: it would keep the loop from running on whole rows.
        let better = (old[i] != WALL) & (new[i].saturating_sub(1) > old[i]);
        best = best.max(if better { new[i] } else { WALL });
    }
    best
}
