//! The distance fields of many targets, a bit or two a cell, each made when it is first needed.

use crate::floor::Floor;
use activecell::{Error, Floods, TileField, TileOrder};
use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

/// Where a robot wants to go.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Goal {
    /// The number of the target cell.
    pub target: u32,
    /// The slot of its field.
    pub slot: u32,
}

/// Fields of targets, kept once each. A field is known by its slot.
///
/// ```
/// use activecell::{Cell, Lattice, Map};
/// use activecell_fleet::{Fields, Floor};
/// let map = Map::parse(Lattice::Hex, "S...F\n.....")?;
/// let floor = Floor::new(&map);
/// let [from, to] = ['S', 'F'].map(|name| floor.number(map.mark(name).unwrap()));
/// let mut fields = Fields::new(&floor);
/// let slots = fields.request(&floor, &[to, from, to], 2)?;
/// assert_eq!((slots[0], slots[1], slots[2]), (0, 1, 0));
/// assert_eq!(fields.steps(&floor, slots[0], from), 4);
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Fields {
    order: TileOrder,
    /// The words of each field, by slot.
    made: Vec<Box<[u64]>>,
    slots: BTreeMap<u32, u32>,
    /// Slots of forgotten fields.
    vacant: Vec<u32>,
}

impl Fields {
    /// No field yet.
    pub fn new(floor: &Floor) -> Self {
        Self { order: floor.order(), made: Vec::new(), slots: BTreeMap::new(), vacant: Vec::new() }
    }

    /// The slots of the fields of these targets. Those that are not there yet are made, on `threads` threads; the
    /// slots do not depend on their number.
    ///
    /// # Errors
    /// As [`Floods::flood`], for a number that belongs to no free cell.
    pub fn request(&mut self, floor: &Floor, targets: &[u32], threads: usize) -> Result<Vec<u32>, Error> {
        for &target in targets {
            floor.map().check_target(floor.cell(target))?;
        }
        let mut wanted = Vec::new();
        let mut places = Vec::new();
        for &target in targets {
            if let Entry::Vacant(entry) = self.slots.entry(target) {
                let slot = self.vacant.pop().unwrap_or_else(|| {
                    self.made.push(Box::default());
                    self.made.len() as u32 - 1
                });
                entry.insert(slot);
                places.push(slot);
                wanted.push(target);
            }
        }
        let share = wanted.len().div_ceil(threads.max(1)).max(1);
        let new = std::thread::scope(|scope| {
            let parts: Vec<_> =
                wanted.chunks(share).map(|part| scope.spawn(move || flood(floor, part))).collect();
            let join = |part: std::thread::ScopedJoinHandle<'_, Result<Vec<_>, Error>>| {
                part.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
            };
            parts.into_iter().map(join).collect::<Result<Vec<_>, _>>()
        });
        for (slot, field) in places.into_iter().zip(new?.into_iter().flatten()) {
            self.made[slot as usize] = field;
        }
        Ok(targets.iter().map(|target| self.slots[target]).collect())
    }

    /// The targets as goals; their fields are [requested](Self::request).
    ///
    /// # Errors
    /// As [`Self::request`].
    pub fn goals(&mut self, floor: &Floor, targets: &[u32], threads: usize) -> Result<Vec<Goal>, Error> {
        let slots = self.request(floor, targets, threads)?;
        Ok(targets.iter().zip(slots).map(|(&target, slot)| Goal { target, slot }).collect())
    }

    /// Forgets the field of a target, if there is one. Its slot will be that of another target.
    pub fn forget(&mut self, target: u32) {
        if let Some(slot) = self.slots.remove(&target) {
            self.made[slot as usize] = Box::default();
            self.vacant.push(slot);
        }
    }

    /// The field in this slot.
    ///
    /// # Panics
    /// If there is none.
    #[inline]
    pub fn field(&self, slot: u32) -> TileField<'_> {
        self.order.field(&self.made[slot as usize])
    }

    /// The steps from a cell to the target of a slot: the field is walked down. The two must be connected.
    ///
    /// # Panics
    /// If there is no such field.
    pub fn steps(&self, floor: &Floor, slot: u32, from: u32) -> u32 {
        let field = self.field(slot);
        let mut steps = 0;
        let mut here = from;
        while let Some(&next) =
            floor.links(here).iter().find(|&&next| field.compare(here, next) == Ordering::Less)
        {
            here = next;
            steps += 1;
        }
        steps
    }

    /// The memory that the fields take, in bytes.
    pub fn bytes(&self) -> usize {
        let words: usize = self.made.iter().map(|field| field.len()).sum();
        words * size_of::<u64>() + self.made.len() * size_of::<Box<[u64]>>()
    }
}

fn flood(floor: &Floor, targets: &[u32]) -> Result<Vec<Box<[u64]>>, Error> {
    let mut floods = Floods::new(floor.map());
    let make = |&target: &u32| {
        let mut words = vec![0; floor.order().field_words()].into_boxed_slice();
        floods.flood(floor.cell(target), &mut words)?;
        Ok(words)
    };
    targets.iter().map(make).collect()
}
