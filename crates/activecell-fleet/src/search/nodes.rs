//! The configurations that the search has met, and how they lead to one another.

use crate::fields::Goal;
use crate::floor::NONE;
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

/// The cells of all robots at one time, how it was reached, and what has been tried from it.
pub(super) struct Node {
    pub(super) cells: Box<[u32]>,
    /// Which step it is, as long as that matters.
    pub(super) time: u32,
    /// Steps since each robot was at its target: its priority.
    pub(super) waits: Box<[u16]>,
    /// The node before it on the cheapest way known, or [`NONE`].
    pub(super) parent: u32,
    /// The loss on that way: steps of robots that were not resting at their targets.
    pub(super) spent: u64,
    /// The sum of the distances to the targets: no way on loses less.
    pub(super) ahead: u64,
    /// Nodes that were reached from here in one step.
    pub(super) nexts: Vec<u32>,
    /// Which robots were told where to go, one more in each generation; worked off from the front.
    pub(super) orders: Vec<Told>,
    /// How many of them have been tried; the first, without any, is not in the list.
    pub(super) tried: usize,
    hash: u64,
    /// Another node with the same hash, or [`NONE`].
    twin: u32,
}

/// One more robot told where to go, beyond what `before` tells. Which robot follows from the number told before.
#[derive(Debug, Clone, Copy)]
pub(super) struct Told {
    /// Its number among the node's orders, or [`NONE`].
    pub(super) before: u32,
    pub(super) cell: u32,
}

/// All nodes, found by their cells.
pub(super) struct Nodes {
    all: Vec<Node>,
    by_hash: HashMap<u64, u32, BuildHasherDefault<AsIs>>,
    /// Bytes of what the nodes own.
    owned: usize,
}

/// What is known of a configuration before it becomes a node.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reached {
    pub(super) hash: u64,
    pub(super) time: u32,
    pub(super) spent: u64,
    pub(super) ahead: u64,
}

impl Nodes {
    pub(super) fn new() -> Self {
        Self { all: Vec::new(), by_hash: HashMap::default(), owned: 0 }
    }

    /// The node with these cells at this time.
    pub(super) fn find(&self, cells: &[u32], reached: &Reached) -> Option<u32> {
        let mut number = *self.by_hash.get(&reached.hash)?;
        while number != NONE {
            let node = &self.all[number as usize];
            if *node.cells == *cells && node.time == reached.time {
                return Some(number);
            }
            number = node.twin;
        }
        None
    }

    /// Adds a node whose cells are not there yet.
    pub(super) fn add(&mut self, cells: &[u32], goals: &[Goal], parent: u32, reached: Reached) -> u32 {
        let Reached { hash, time, spent, ahead } = reached;
        let before = self.all.get(parent as usize);
        let wait = |(robot, (&cell, goal)): (usize, (&u32, &Goal))| match before {
            Some(before) if cell != goal.target => before.waits[robot].saturating_add(1),
            _ => 0,
        };
        let waits: Box<[u16]> = cells.iter().zip(goals).enumerate().map(wait).collect();
        let number = self.all.len() as u32;
        let twin = self.by_hash.insert(hash, number).unwrap_or(NONE);
        self.owned += size_of_val(cells) + size_of_val(&*waits);
        self.all.push(Node {
            cells: cells.into(),
            time,
            waits,
            parent,
            spent,
            ahead,
            nexts: Vec::new(),
            orders: Vec::new(),
            tried: 0,
            hash,
            twin,
        });
        number
    }

    /// Notes that one step leads from a node to another; false if that was known.
    pub(super) fn link(&mut self, from: u32, to: u32) -> bool {
        let nexts = &mut self.all[from as usize].nexts;
        let new = !nexts.contains(&to);
        if new {
            nexts.push(to);
            self.owned += size_of::<u32>();
        }
        new
    }

    /// Tells one robot more where to go, each of `cells` in turn.
    pub(super) fn branch(&mut self, number: u32, before: u32, cells: impl IntoIterator<Item = u32>) {
        let orders = &mut self.all[number as usize].orders;
        let old = orders.len();
        orders.extend(cells.into_iter().map(|cell| Told { before, cell }));
        self.owned += (orders.len() - old) * size_of::<Told>();
    }

    /// Gives back the memory of a node from which everything was tried.
    pub(super) fn close(&mut self, number: u32) {
        let node = &mut self.all[number as usize];
        self.owned -= node.orders.len() * size_of::<Told>();
        node.orders = Vec::new();
    }

    pub(super) const fn len(&self) -> usize {
        self.all.len()
    }

    pub(super) fn get(&self, number: u32) -> &Node {
        &self.all[number as usize]
    }

    pub(super) fn get_mut(&mut self, number: u32) -> &mut Node {
        &mut self.all[number as usize]
    }

    pub(super) fn hash(&self, number: u32) -> u64 {
        self.all[number as usize].hash
    }

    /// The memory that the nodes take, in bytes; lists count by what is in them.
    pub(super) fn bytes(&self) -> usize {
        self.owned + self.all.len() * (size_of::<Node>() + 2 * size_of::<u64>())
    }
}

/// A robot's share in the hash of a configuration; the shares are combined by exclusive or, so that a step changes
/// the shares of those that move only.
///
/// Source: A. Zobrist, *A New Hashing Method with Application for Game Playing*, 1970; computed instead of drawn.
#[inline]
pub(super) const fn share(robot: usize, cell: u32) -> u64 {
    let mut z = ((robot as u64) << 32 | cell as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 32)).wrapping_mul(0xd6e8_feb8_6659_fd93);
    z ^ (z >> 32)
}

/// The hash of a configuration is used as it is.
#[derive(Default)]
struct AsIs(u64);

impl Hasher for AsIs {
    fn finish(&self) -> u64 {
        self.0
    }
    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = self.0.rotate_left(8) ^ u64::from(byte);
        }
    }
    fn write_u64(&mut self, value: u64) {
        self.0 = value;
    }
}
