//! How far every place is from a target: tables on small floors, cut-outs around the robots on large ones.

use super::ground::{Ground, Place};
use crate::fields::Fields;
use crate::floor::Floor;
use activecell::Error;
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// The most memory for tables of all targets, in bytes.
const TABLES: usize = 256 << 20;
/// How far a robot may go before the cut-out around it is made anew.
const SLACK: u32 = 8;
/// Cut-outs below which a thread is not worth its start.
const MIN_SHARE: usize = 64;
/// No way, or too far away to matter.
const FAR: u16 = u16::MAX;

/// Distances to one target, on the whole floor or around a robot.
#[derive(Debug, Clone, Copy)]
pub(super) struct View<'a> {
    values: &'a [u16],
    /// What to take from a cell's `y * stride + x` to find its values.
    skip: i32,
    stride: i32,
}

impl View<'_> {
    /// The steps that are left from a place.
    #[inline]
    pub(super) fn at(&self, ground: &Ground, spot: u32, heading: u32) -> u16 {
        let at = ground.y(spot) * self.stride + ground.x(spot) - self.skip;
        self.values[(at as u32 * ground.headings() + heading) as usize]
    }
}

/// The distances of all robots to their targets.
#[derive(Debug, Clone)]
pub(super) enum Distances {
    /// A table for every target ever asked for.
    Tables {
        /// The tables, by slot.
        made: Vec<Box<[u16]>>,
        /// The slot of each target.
        slots: BTreeMap<u32, u32>,
    },
    /// A field of one or two bits a cell for every target that a robot has now, and around each robot the distances
    /// that follow from it.
    Around(Box<Around>),
}

/// Distances around robots.
#[derive(Debug, Clone)]
pub(super) struct Around {
    floor: Floor,
    fields: Fields,
    /// How many robots have a target.
    users: BTreeMap<u32, u32>,
    /// Cells to each side of a robot.
    radius: u32,
    patches: Vec<Patch>,
}

/// The distances around one robot.
#[derive(Debug, Clone, Default)]
struct Patch {
    target: Option<u32>,
    /// Where the robot was when it was made.
    centre: u32,
    values: Box<[u16]>,
}

/// A robot whose cut-out must be made anew, its cell, and its target with the slot of its field.
type Stale = (usize, u32, Option<(u32, u32)>);

impl Distances {
    /// Nobody wants to go anywhere yet.
    pub(super) fn new(ground: &Ground, floor: Floor, robots: usize, steps: usize) -> Self {
        let table = ground.spots() * ground.headings() as usize * size_of::<u16>();
        if table.saturating_mul(ground.map.free_cells()) <= TABLES && ground.map.free_cells() < 1 << 14 {
            return Self::Tables { made: Vec::new(), slots: BTreeMap::new() };
        }
        Self::Around(Box::new(Around {
            fields: Fields::new(&floor),
            floor,
            users: BTreeMap::new(),
            radius: steps as u32 + SLACK,
            patches: vec![Patch::default(); robots],
        }))
    }

    /// The slot under which a robot finds the distances to its target, from where it stands now.
    pub(super) fn request(&mut self, ground: &Ground, robot: usize, target: u32) -> u32 {
        match self {
            Self::Tables { made, slots } => {
                let free = made.len() as u32;
                *slots.entry(target).or_insert_with(|| {
                    made.push(table(ground, target));
                    free
                })
            }
            Self::Around(_) => robot as u32,
        }
    }

    /// Whether distances to any target can be asked for, not only those to the robots' next errands.
    pub(super) const fn knows_all(&self) -> bool {
        matches!(self, Self::Tables { .. })
    }

    /// Tells where the robots are and want to go; to be called whenever either has changed.
    pub(super) fn follow(
        &mut self,
        ground: &Ground,
        robots: impl Iterator<Item = (Place, Option<u32>)>,
        threads: usize,
    ) -> Result<(), Error> {
        match self {
            Self::Tables { .. } => Ok(()),
            Self::Around(around) => around.follow(ground, robots, threads),
        }
    }

    /// The distances of a slot.
    #[inline]
    pub(super) fn view(&self, ground: &Ground, slot: u32) -> View<'_> {
        match self {
            Self::Tables { made, .. } => {
                View { values: &made[slot as usize], skip: 0, stride: ground.stride() }
            }
            Self::Around(around) => {
                let patch = &around.patches[slot as usize];
                let (stride, radius) = (around.span() as i32, around.radius as i32);
                let (x, y) = (ground.x(patch.centre) - radius, ground.y(patch.centre) - radius);
                View { values: &patch.values, skip: y * stride + x, stride }
            }
        }
    }

    /// The memory that it takes, in bytes.
    pub(super) fn bytes(&self) -> usize {
        match self {
            Self::Tables { made, .. } => made.iter().map(|table| size_of_val(&**table)).sum(),
            Self::Around(around) => {
                let patches: usize = around.patches.iter().map(|patch| size_of_val(&*patch.values)).sum();
                around.floor.bytes() + around.fields.bytes() + patches
            }
        }
    }
}

/// The distances of all places to a target: a search from there, against the moves.
fn table(ground: &Ground, target: u32) -> Box<[u16]> {
    let headings = ground.headings();
    let mut table = vec![FAR; ground.spots() * headings as usize].into_boxed_slice();
    let mut rim: Vec<Place> = (0..headings).map(|heading| Place::new(target, heading)).collect();
    let mut next = Vec::new();
    let mut steps = 0;
    while !rim.is_empty() {
        for place in rim.drain(..) {
            let value = &mut table[(place.spot() * headings + place.heading()) as usize];
            if *value == FAR {
                *value = steps;
                ground.before(place, |place| next.push(place));
            }
        }
        std::mem::swap(&mut rim, &mut next);
        // No table is made for floors that are large enough to reach it.
        steps += 1;
    }
    table
}

impl Around {
    const fn span(&self) -> u32 {
        2 * self.radius + 1
    }

    fn follow(
        &mut self,
        ground: &Ground,
        robots: impl Iterator<Item = (Place, Option<u32>)>,
        threads: usize,
    ) -> Result<(), Error> {
        let mut stale = Vec::new();
        for (robot, (place, target)) in robots.enumerate() {
            let patch = &self.patches[robot];
            let (here, centre) = (ground.cell(place.spot()), ground.cell(patch.centre));
            let away = (here.x - centre.x).abs().max((here.y - centre.y).abs()) as u32;
            if patch.target != target || target.is_some() && away > SLACK {
                stale.push((robot, place.spot(), patch.target, target));
            }
        }
        let number = |spot: u32| self.floor.number(ground.cell(spot));
        for &(.., target) in stale.iter().filter(|(_, _, old, new)| old != new) {
            if let Some(target) = target {
                *self.users.entry(number(target)).or_insert(0) += 1;
            }
        }
        for &(_, _, old, new) in &stale {
            let Some(old) = old.filter(|_| old != new) else { continue };
            let old = number(old);
            let users = self.users.get_mut(&old).expect("a robot had it");
            *users -= 1;
            if *users == 0 {
                self.users.remove(&old);
                self.fields.forget(old);
            }
        }
        let wanted: Vec<u32> = stale.iter().filter_map(|&(.., target)| Some(number(target?))).collect();
        let slots = self.fields.request(&self.floor, &wanted, threads)?;
        let mut slots = slots.into_iter();
        let work: Vec<Stale> = stale
            .into_iter()
            .map(|(robot, spot, _, target)| {
                (robot, spot, target.and_then(|cell| Some((cell, slots.next()?))))
            })
            .collect();
        let around = &*self;
        let share = work.len().div_ceil(threads.max(1)).max(MIN_SHARE);
        let made: Vec<Patch> = std::thread::scope(|scope| {
            let make = |part: &[Stale]| -> Vec<Patch> {
                let mut queue = Vec::new();
                part.iter().map(|&(_, spot, goal)| around.patch(ground, spot, goal, &mut queue)).collect()
            };
            let mut parts = work.chunks(share);
            let first = parts.next().unwrap_or_default();
            let others: Vec<_> = parts.map(|part| scope.spawn(move || make(part))).collect();
            let mut made = make(first);
            for other in others {
                made.extend(other.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
            }
            made
        });
        for ((robot, ..), patch) in work.into_iter().zip(made) {
            self.patches[robot] = patch;
        }
        Ok(())
    }

    /// The distances to a target around a cell; the target comes with the slot of its field.
    fn patch(
        &self,
        ground: &Ground,
        spot: u32,
        goal: Option<(u32, u32)>,
        queue: &mut Vec<(u32, u16)>,
    ) -> Patch {
        let Some((target, slot)) = goal else {
            return Patch { centre: spot, ..Patch::default() };
        };
        let (span, radius) = (self.span() as i32, self.radius as i32);
        let headings = ground.headings();
        let Self { floor, fields, .. } = self;
        let centre = ground.cell(spot);
        let local = |cell: activecell::Cell| {
            let (x, y) = (cell.x - centre.x + radius, cell.y - centre.y + radius);
            ((0..span).contains(&x) && (0..span).contains(&y)).then(|| (y * span + x) as usize)
        };
        let here = floor.number(centre);
        let steps = fields.steps(floor, slot, here);
        let mut all = vec![FAR; (span * span) as usize * headings as usize].into_boxed_slice();
        let field = fields.field(slot);
        queue.clear();
        queue.push((here, steps.min(u32::from(FAR) / 2) as u16));
        let mut next = 0;
        while let Some(&(number, steps)) = queue.get(next) {
            next += 1;
            let cell = floor.cell(number);
            let Some(at) = local(cell) else { continue };
            let values = &mut all[at * headings as usize..][..headings as usize];
            if values[0] != FAR {
                continue;
            }
            values.fill(steps);
            let mut ahead = 0;
            for &link in floor.links(number) {
                let order = field.compare(number, link);
                let there = match order {
                    Ordering::Less => steps.saturating_sub(1),
                    Ordering::Equal => steps,
                    Ordering::Greater => steps + 1,
                };
                queue.push((link, there));
                if order == Ordering::Less && headings > 1 {
                    ahead |= 1 << ground.direction(ground.spot(cell), ground.spot(floor.cell(link)));
                }
            }
            if headings > 1 && ahead != 0 {
                for (heading, value) in values.iter_mut().enumerate() {
                    *value += ground.turns(heading as u32, ahead);
                }
            }
        }
        Patch { target: Some(target), centre: spot, values: all }
    }
}
