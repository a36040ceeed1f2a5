//! Jump points on four neighbours: A* that looks only at corners of obstacles.
//!
//! Of the shortest ways that differ only in the order of their steps one is searched: it goes along rows first. So
//! a way turns from a row into a column anywhere, but from a column into a row only at a *forced corner*, where
//! the row could not have been entered before. From a row a column is worth a look only where it leads to such a
//! corner, which the planes know, or to the target, whose sight up and down is known: a row is searched 64 cells
//! at a time.
//!
//! Horizontal-first jump point search: Baum, *Jump Point Search Pathfinding in 4-connected Grids*, 2025; jump points:
//! Harabor, Grastien, *Online Graph Pruning for Pathfinding on Grid Maps*, AAAI 2011.

use super::OutOfRoom;
use super::planes::Planes;
use crate::lattice::{Cell, Lattice};
use crate::map::Map;

/// The end of a list of nodes.
const NONE: u32 = u32::MAX;
/// Places of the table at first, a power of two.
const FIRST_TABLE: usize = 256;

/// Where the direction of a node begins; 2²⁸ cells, their rows padded to a power of two, stay below.
const DIRECTION: u32 = 30;
const EAST: u32 = 0;
const WEST: u32 = 1;
const SOUTH: u32 = 2;
const NORTH: u32 = 3;

/// A place on the rim of the search.
#[derive(Debug, Clone, Copy)]
struct Node {
    /// The cell, packed; in the two highest bits the direction in which it was reached.
    key: u32,
    /// The node from which it was reached, along a row and then along a column.
    parent: u32,
    /// The next node of the same bucket.
    next: u32,
}

/// The search by jumps; square lattice only.
#[derive(Debug, Clone)]
pub(super) struct Jumps {
    planes: Planes,
    height: i32,
    /// Bits of a packed cell that hold its column.
    shift: u32,
    nodes: Vec<Node>,
    /// The most nodes there is room for.
    most: usize,
    /// The least cost of each cell, by open addressing: packed cell + 1 above; below steps from the start · 16 and
    /// the directions in which the cell was reached with them, a bit each. Only the first `places`
    /// are in use, a power of two that grows so that half of
    /// them stay free while there is room.
    table: Vec<u64>,
    places: usize,
    /// Places of the table in use.
    used: usize,
    /// The first node of each bucket, a ring; bucket k holds ways with k detours. A jump is no longer than the map,
    /// so the buckets in use fit into the ring.
    buckets: Vec<u32>,
    /// Nodes in buckets, and the highest bucket that had one.
    open: usize,
    highest: u32,
    /// Whether there was no room for a node: the search is of no use then.
    full: bool,
    query: Query,
}

/// What is known of one query.
#[derive(Debug, Clone, Copy, Default)]
struct Query {
    to: Cell,
    /// The rows that see the target in its column.
    first: i32,
    last: i32,
    /// Steps on an empty floor.
    empty: u32,
    /// The bucket at hand.
    level: u32,
    /// The best way found: its steps and its last node.
    best: Option<(u32, u32)>,
}

impl Jumps {
    /// Prepares the map. Planes, nodes and their table take at most `bytes`; nodes and table may take `least`, whatever
    /// the planes leave over.
    pub(super) fn new(map: &Map, bytes: usize, least: usize) -> Self {
        let side = map.width().max(map.height()) as usize;
        let planes = Planes::new(map);
        let buckets = vec![NONE; (side + 1).next_power_of_two()];
        let (most, places) = shares(bytes.saturating_sub(planes.bytes() + buckets.len() * 4).max(least));
        Self {
            planes,
            height: map.height() as i32,
            shift: map.width().next_power_of_two().trailing_zeros(),
            nodes: Vec::with_capacity(most),
            most,
            table: vec![0; places],
            places: FIRST_TABLE,
            used: 0,
            buckets,
            open: 0,
            highest: 0,
            full: false,
            query: Query::default(),
        }
    }

    /// The length of a shortest way, `None` if there is none.
    ///
    /// # Errors
    /// [`OutOfRoom`] if the rim outgrows its memory.
    pub(super) fn run(&mut self, from: Cell, to: Cell) -> Result<Option<u32>, OutOfRoom> {
        self.reset();
        let (first, last) = self.planes.sight(to.x, to.y, self.height);
        self.query =
            Query { to, first, last, empty: Lattice::Square.distance(from, to), level: 0, best: None };
        self.start(from);
        let mask = self.buckets.len() as u32 - 1;
        while self.open > 0 && !self.full {
            let level = self.query.level;
            if let Some((steps, _)) = self.query.best
                && steps <= self.query.empty + 2 * level
            {
                break;
            }
            let index = self.buckets[(level & mask) as usize];
            if index == NONE {
                self.query.level += 1;
                continue;
            }
            self.buckets[(level & mask) as usize] = self.nodes[index as usize].next;
            self.open -= 1;
            self.expand(index);
        }
        if self.full { Err(OutOfRoom) } else { Ok(self.query.best.map(|best| best.0)) }
    }

    fn start(&mut self, from: Cell) {
        let (x, y) = (from.x, from.y);
        // Known in every direction: nothing better comes back to the start.
        let start = Node { key: self.key(x, y), parent: NONE, next: NONE };
        if self.settle(start.key, 15) {
            self.nodes.push(start);
        }
        if x == self.query.to.x && (self.query.first..=self.query.last).contains(&y) {
            self.query.best = Some((self.query.empty, 0));
            // No node is open: the search ends.
            return;
        }
        let here = self.planes.row(x, y);
        if here.down >> (x % 64) & 1 == 1 {
            self.drop(x, y, 0, 0);
        }
        if here.up >> (x % 64) & 1 == 1 {
            self.rise(x, y, 0, 0);
        }
        self.walk::<true>(x, y, 0, 0);
        self.walk::<false>(x, y, 0, 0);
    }

    fn expand(&mut self, index: u32) {
        let node = self.nodes[index as usize];
        let (x, y) = self.place(node.key);
        // The node's level is the one at hand, and that tells its steps.
        let to_target = Lattice::Square.distance(Cell::new(x, y), self.query.to);
        let steps = self.query.empty + 2 * self.query.level - to_target;
        let here = self.planes.row(x, y);
        let (down, up) = (here.down >> (x % 64) & 1 == 1, here.up >> (x % 64) & 1 == 1);
        match node.key >> DIRECTION {
            EAST | WEST => {
                if down {
                    self.drop(x, y, steps, index);
                }
                if up {
                    self.rise(x, y, steps, index);
                }
                if node.key >> DIRECTION == EAST {
                    self.walk::<true>(x, y, steps, index);
                } else {
                    self.walk::<false>(x, y, steps, index);
                }
            }
            direction => {
                let back = if direction == SOUTH { y - 1 } else { y + 1 };
                if direction == SOUTH && down {
                    self.drop(x, y, steps, index);
                }
                if direction == NORTH && up {
                    self.rise(x, y, steps, index);
                }
                if self.planes.is_free(x + 1, y) && !self.planes.is_free(x + 1, back) {
                    self.walk::<true>(x, y, steps, index);
                }
                if self.planes.is_free(x - 1, y) && !self.planes.is_free(x - 1, back) {
                    self.walk::<false>(x, y, steps, index);
                }
            }
        }
    }

    /// Walks along a row, looks into the columns that pay, and leaves the rest of the row for later once it
    /// leads away from the target.
    #[inline]
    fn walk<const IS_EAST: bool>(&mut self, mut x: i32, y: i32, mut steps: u32, parent: u32) {
        let to = self.query.to;
        let seen = (self.query.first..=self.query.last).contains(&y);
        let direction = if IS_EAST { EAST } else { WEST };
        loop {
            let stop = if IS_EAST { self.planes.walk_east(x, y) } else { self.planes.walk_west(x, y) };
            let wall = !stop.down && !stop.up;
            if seen && if IS_EAST { x < to.x && to.x <= stop.x } else { stop.x <= to.x && to.x < x } {
                // No obstacle is at stop.x = to.x here: the target is seen from this row.
                self.arrive(steps + (to.x - x).unsigned_abs() + (to.y - y).unsigned_abs(), parent);
            }
            if wall {
                return;
            }
            steps += (stop.x - x).unsigned_abs();
            x = stop.x;
            if self.level(x, y, steps) > self.query.level {
                self.reach(x, y, direction, steps, parent);
                return;
            }
            if stop.down {
                self.drop(x, y, steps, parent);
            }
            if stop.up {
                self.rise(x, y, steps, parent);
            }
        }
    }

    #[inline]
    fn drop(&mut self, x: i32, y: i32, steps: u32, parent: u32) {
        let corner = self.planes.corner_below(x, y);
        self.reach(x, corner, SOUTH, steps + (corner - y) as u32, parent);
    }

    #[inline]
    fn rise(&mut self, x: i32, y: i32, steps: u32, parent: u32) {
        let corner = self.planes.corner_above(x, y);
        self.reach(x, corner, NORTH, steps + (y - corner) as u32, parent);
    }

    /// Puts a cell on the rim, unless it was reached as well before.
    #[inline]
    fn reach(&mut self, x: i32, y: i32, direction: u32, steps: u32, parent: u32) {
        let key = self.key(x, y);
        let cost = steps << 4 | 1 << direction;
        if self.settle(key, cost) {
            let level = self.level(x, y, steps);
            self.highest = self.highest.max(level);
            let bucket = level as usize & (self.buckets.len() - 1);
            let next = std::mem::replace(&mut self.buckets[bucket], self.nodes.len() as u32);
            self.nodes.push(Node { key: key | direction << DIRECTION, parent, next });
            self.open += 1;
        }
    }

    #[inline]
    fn arrive(&mut self, steps: u32, parent: u32) {
        if self.query.best.is_none_or(|best| steps < best.0) {
            self.query.best = Some((steps, parent));
        }
    }

    /// How many detours a way of `steps` steps to (x, y) has made at least when it comes to the target.
    #[inline]
    fn level(&self, x: i32, y: i32, steps: u32) -> u32 {
        let to = self.query.to;
        (steps + (x - to.x).unsigned_abs() + (y - to.y).unsigned_abs() - self.query.empty) / 2
    }

    #[inline]
    const fn key(&self, x: i32, y: i32) -> u32 {
        (y as u32) << self.shift | x as u32
    }

    #[inline]
    const fn place(&self, key: u32) -> (i32, i32) {
        ((key & ((1 << self.shift) - 1)) as i32, (cell_of(key) >> self.shift) as i32)
    }

    /// Notes that a cell was reached; false if it was reached as well before, so that nothing new comes of it, or
    /// if there is no room for the node that the caller makes next.
    #[inline]
    fn settle(&mut self, key: u32, cost: u32) -> bool {
        if self.nodes.len() == self.most {
            self.full = true;
            return false;
        }
        if self.used * 2 >= self.places && self.places < self.table.len() {
            self.grow();
        }
        let mask = self.places - 1;
        let mut place = home(key) & mask;
        loop {
            let entry = self.table[place];
            if entry == 0 {
                self.table[place] = entry_of(key, cost);
                self.used += 1;
                return true;
            }
            if (entry >> 32) as u32 == key + 1 {
                let known = entry as u32;
                if known >> 4 < cost >> 4 || known >> 4 == cost >> 4 && known & cost & 15 != 0 {
                    return false;
                }
                let directions = if known >> 4 == cost >> 4 { known & 15 } else { 0 };
                self.table[place] = entry_of(key, cost | directions);
                return true;
            }
            place = (place + 1) & mask;
        }
    }

    /// Doubles the part of the table that is in use.
    #[cold]
    fn grow(&mut self) {
        let entries = self.table[..self.places].to_vec();
        self.table[..self.places].fill(0);
        self.places *= 2;
        let mask = self.places - 1;
        for entry in entries.into_iter().filter(|&entry| entry != 0) {
            let mut place = home((entry >> 32) as u32 - 1) & mask;
            while self.table[place] != 0 {
                place = (place + 1) & mask;
            }
            self.table[place] = entry;
        }
    }

    fn reset(&mut self) {
        if self.used * 4 > self.places {
            self.table[..self.places].fill(0);
        } else {
            // All that is settled has a node. What stands behind its first place without a gap is emptied with it.
            let mask = self.places - 1;
            for node in &self.nodes {
                let mut place = home(cell_of(node.key)) & mask;
                while self.table[place] != 0 {
                    self.table[place] = 0;
                    place = (place + 1) & mask;
                }
            }
        }
        if self.open > 0 {
            let mask = self.buckets.len() as u32 - 1;
            for level in self.query.level..=self.highest {
                self.buckets[(level & mask) as usize] = NONE;
            }
        }
        (self.used, self.open, self.highest, self.full) = (0, 0, 0, false);
        self.nodes.clear();
    }

    /// The cells of a shortest way, after [`run`](Self::run) found one of `steps` steps.
    pub(super) fn path(&self, from: Cell, to: Cell, steps: u32) -> Vec<Cell> {
        let mut path = vec![from; steps as usize + 1];
        let mut rest = path.as_mut_slice();
        let mut end = to;
        let mut node = self.query.best.map_or(NONE, |best| best.1);
        while node != NONE {
            let (x, y) = self.place(self.nodes[node as usize].key);
            // From (x, y) along the row, then along the column; written from its end.
            let down = (end.y - y).unsigned_abs() as usize;
            let across = (end.x - x).unsigned_abs() as usize;
            let (before, column) = rest.split_at_mut(rest.len() - down);
            let step = (end.y - y).signum();
            for (i, cell) in column.iter_mut().enumerate() {
                *cell = Cell::new(end.x, y + step * (i as i32 + 1));
            }
            let (before, row) = before.split_at_mut(before.len() - across);
            let step = (end.x - x).signum();
            for (i, cell) in row.iter_mut().enumerate() {
                *cell = Cell::new(x + step * (i as i32 + 1), y);
            }
            rest = before;
            end = Cell::new(x, y);
            node = self.nodes[node as usize].parent;
        }
        path
    }

    pub(super) fn bytes(&self) -> usize {
        let rim = self.nodes.capacity() * size_of::<Node>()
            + self.table.capacity() * 8
            + self.buckets.capacity() * 4;
        self.planes.bytes() + rim
    }
}

/// The most nodes, and the places of their table, that fit into `room` bytes; an eighth of the places stays free.
fn shares(room: usize) -> (usize, usize) {
    let mut best = (FIRST_TABLE / 2, FIRST_TABLE);
    let mut places = FIRST_TABLE;
    while places * 8 < room {
        let nodes = ((room - places * 8) / size_of::<Node>()).min(places / 8 * 7);
        if nodes > best.0 {
            best = (nodes, places);
        }
        places *= 2;
    }
    best
}

/// A cell of the table.
#[inline]
const fn entry_of(key: u32, cost: u32) -> u64 {
    ((key + 1) as u64) << 32 | cost as u64
}

/// A node's cell, packed, without its direction.
#[inline]
const fn cell_of(key: u32) -> u32 {
    key & ((1 << DIRECTION) - 1)
}

/// Where a key's place is sought first.
#[inline]
const fn home(key: u32) -> usize {
    ((key >> 3).wrapping_mul(0x9e37_79b1) >> 8 << 3 | key & 7) as usize
}
