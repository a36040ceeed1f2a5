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

use super::planes::Planes;
use crate::lattice::{Cell, Lattice};
use crate::map::Map;

/// The end of a list of nodes.
const NONE: u32 = u32::MAX;
/// Places of the table at first, a power of two.
const FIRST_TABLE: usize = 256;

/// The direction in which a node was reached, a bit each.
const EAST: u32 = 1;
const WEST: u32 = 2;
const SOUTH: u32 = 4;
const NORTH: u32 = 8;

/// A place on the rim of the search.
#[derive(Debug, Clone, Copy)]
struct Node {
    /// The cell, packed.
    key: u32,
    /// Steps from the start · 16 + direction.
    cost: u32,
    /// The node from which it was reached, along a row and then along a column.
    parent: u32,
    /// The next node of the same bucket.
    next: u32,
}

/// Why the search ended without an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct OutOfRoom;

/// The search by jumps; square lattice only.
#[derive(Debug, Clone)]
pub(super) struct Jumps {
    planes: Planes,
    height: i32,
    /// Bits of a packed cell that hold its column.
    shift: u32,
    nodes: Vec<Node>,
    /// The least cost known of each cell and the directions it was reached in, by open addressing: key + 1 above,
    /// cost below.
    table: Vec<u64>,
    used: Vec<u32>,
    /// The first node of each bucket; bucket k holds ways with k detours.
    buckets: Vec<u32>,
    /// The most bytes that nodes, table and buckets may take.
    room: usize,
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
    pub(super) fn new(map: &Map, room: usize) -> Self {
        Self {
            planes: Planes::new(map),
            height: map.height() as i32,
            shift: map.width().next_power_of_two().trailing_zeros(),
            nodes: Vec::new(),
            table: vec![0; FIRST_TABLE],
            used: Vec::new(),
            buckets: Vec::new(),
            room,
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
        self.query = Query { to, first, last, empty: Lattice::Square.distance(from, to), level: 0, best: None };
        self.start(from);
        while (self.query.level as usize) < self.buckets.len() {
            let level = self.query.level;
            if let Some((steps, _)) = self.query.best
                && steps <= self.query.empty + 2 * level
            {
                break;
            }
            let index = self.buckets[level as usize];
            if index == NONE {
                self.query.level += 1;
                if self.bytes_of_rim() > self.room {
                    return Err(OutOfRoom);
                }
                continue;
            }
            self.buckets[level as usize] = self.nodes[index as usize].next;
            self.expand(index);
        }
        Ok(self.query.best.map(|best| best.0))
    }

    fn start(&mut self, from: Cell) {
        let (x, y) = (from.x, from.y);
        self.nodes.push(Node { key: self.key(x, y), cost: EAST | WEST | SOUTH | NORTH, parent: NONE, next: NONE });
        self.settle(self.nodes[0].key, EAST | WEST | SOUTH | NORTH);
        if x == self.query.to.x && (self.query.first..=self.query.last).contains(&y) {
            self.query.best = Some((self.query.empty, 0));
            // The buckets are empty: the search ends.
            return;
        }
        self.buckets.push(NONE);
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
        let steps = node.cost >> 4;
        let here = self.planes.row(x, y);
        let (down, up) = (here.down >> (x % 64) & 1 == 1, here.up >> (x % 64) & 1 == 1);
        match node.cost & 15 {
            EAST | WEST => {
                if down {
                    self.drop(x, y, steps, index);
                }
                if up {
                    self.rise(x, y, steps, index);
                }
                if node.cost & EAST != 0 {
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
            let key = self.key(x, y);
            if !self.settle(key, steps << 4 | direction) {
                return;
            }
            if self.level(x, y, steps) > self.query.level {
                self.push(key, steps << 4 | direction, x, y, parent);
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
        self.reach(x, corner, (steps + (corner - y) as u32) << 4 | SOUTH, parent);
    }

    #[inline]
    fn rise(&mut self, x: i32, y: i32, steps: u32, parent: u32) {
        let corner = self.planes.corner_above(x, y);
        self.reach(x, corner, (steps + (y - corner) as u32) << 4 | NORTH, parent);
    }

    #[inline]
    fn reach(&mut self, x: i32, y: i32, cost: u32, parent: u32) {
        let key = self.key(x, y);
        if self.settle(key, cost) {
            self.push(key, cost, x, y, parent);
        }
    }

    #[inline]
    fn arrive(&mut self, steps: u32, parent: u32) {
        if self.query.best.is_none_or(|best| steps < best.0) {
            self.query.best = Some((steps, parent));
        }
    }

    #[inline]
    fn push(&mut self, key: u32, cost: u32, x: i32, y: i32, parent: u32) {
        let level = self.level(x, y, cost >> 4) as usize;
        if level >= self.buckets.len() {
            self.buckets.resize(level + 1, NONE);
        }
        let next = std::mem::replace(&mut self.buckets[level], self.nodes.len() as u32);
        self.nodes.push(Node { key, cost, parent, next });
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
        ((key & ((1 << self.shift) - 1)) as i32, (key >> self.shift) as i32)
    }

    /// Notes that a cell was reached; false if it was reached as well before, so that nothing new comes of it.
    #[inline]
    fn settle(&mut self, key: u32, cost: u32) -> bool {
        let mask = self.table.len() - 1;
        let mut place = home(key) & mask;
        loop {
            let entry = self.table[place];
            if entry == 0 {
                self.table[place] = u64::from(key + 1) << 32 | u64::from(cost);
                self.used.push(place as u32);
                if self.used.len() * 2 > self.table.len() {
                    self.grow();
                }
                return true;
            }
            if (entry >> 32) as u32 == key + 1 {
                let known = entry as u32;
                if known >> 4 < cost >> 4 || known >> 4 == cost >> 4 && known & cost & 15 != 0 {
                    return false;
                }
                let directions = if known >> 4 == cost >> 4 { known & 15 } else { 0 };
                self.table[place] = u64::from(key + 1) << 32 | u64::from(cost | directions);
                return true;
            }
            place = (place + 1) & mask;
        }
    }

    fn grow(&mut self) {
        let larger = vec![0; self.table.len() * 2];
        let old = std::mem::replace(&mut self.table, larger);
        let mask = self.table.len() - 1;
        for used in &mut self.used {
            let entry = old[*used as usize];
            let mut place = home((entry >> 32) as u32 - 1) & mask;
            while self.table[place] != 0 {
                place = (place + 1) & mask;
            }
            self.table[place] = entry;
            *used = place as u32;
        }
    }

    fn reset(&mut self) {
        for place in self.used.drain(..) {
            self.table[place as usize] = 0;
        }
        self.nodes.clear();
        self.buckets.clear();
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

    fn bytes_of_rim(&self) -> usize {
        self.nodes.capacity() * size_of::<Node>()
            + self.table.capacity() * 8
            + self.used.capacity() * 4
            + self.buckets.capacity() * 4
    }

    pub(super) fn bytes(&self) -> usize {
        self.planes.bytes() + self.bytes_of_rim()
    }
}

/// Where a key's place is sought first.
#[inline]
const fn home(key: u32) -> usize {
    (key.wrapping_mul(0x9e37_79b1) >> 8) as usize
}
