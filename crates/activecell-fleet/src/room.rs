//! What teams of bodies need to know: the floor of each size, and which cells are closed when.

use crate::floor::Floor;
use activecell::{Bodies, KeepOuts, Map, Team};
use std::collections::{BTreeMap, BTreeSet};

/// The room that a team of [`Bodies`] has among [`KeepOuts`].
///
/// A body moves like a robot of one cell on the floor of its size ([`Map::for_body`]); two bodies are apart if their
/// centres are. What is left of bodies is how far one looks around.
///
/// Closed are also the cells from which a robot, were it alone, could not get away in time: so none enters a trap.
#[derive(Debug, Clone)]
pub struct Room {
    bodies: Bodies,
    /// One of each radius, the least first.
    floors: Vec<Floor>,
    /// The floor of each robot.
    sizes: Vec<u32>,
    /// What is closed for each size.
    closed: Vec<Closed>,
    /// From this step on nothing is closed.
    horizon: u32,
    /// From this step on no robot must leave its target again.
    settled: u32,
    /// Whether a robot cannot get away from its start in time.
    lost: bool,
}

impl Room {
    /// Prepares a map for a team, both of which fit ([`Team::check`]).
    pub fn new(map: &Map, team: &Team, keep_outs: &KeepOuts) -> Self {
        let bodies = team.bodies().clone();
        let radii: BTreeSet<u32> = (0..team.robots()).map(|robot| bodies.radius(robot)).collect();
        let floors: Vec<Floor> = radii.iter().map(|&radius| Floor::new(&map.for_body(radius))).collect();
        let closed: Vec<Closed> =
            radii.iter().zip(&floors).map(|(&radius, floor)| Closed::new(floor, radius, keep_outs)).collect();
        let size = |robot| radii.range(..bodies.radius(robot)).count() as u32;
        let sizes: Vec<u32> = (0..team.robots()).map(size).collect();
        let ends = team.starts().iter().zip(team.targets()).zip(&sizes);
        let (mut settled, mut lost) = (0, false);
        for ((&start, &target), &size) in ends {
            let (floor, closed) = (&floors[size as usize], &closed[size as usize]);
            settled = settled.max(closed.spans(floor.number(target)).last().map_or(0, |span| span.1 + 1));
            lost |= closed.is_closed(floor.number(start), 0);
        }
        let horizon = if keep_outs.is_empty() { 0 } else { keep_outs.last_step() + 1 };
        Self { bodies, floors, sizes, closed, horizon, settled, lost }
    }

    /// The floor that a robot moves on. The numbers of cells are the same on all.
    #[inline]
    pub fn floor(&self, robot: u32) -> &Floor {
        &self.floors[self.sizes[robot as usize] as usize]
    }

    /// The floors of all sizes, the least first.
    pub fn floors(&self) -> &[Floor] {
        &self.floors
    }

    /// Which of [`floors`](Self::floors) a robot moves on.
    pub fn size(&self, robot: u32) -> usize {
        self.sizes[robot as usize] as usize
    }

    /// Whether the robot must not be there at that step: it would cover a closed cell, then or soon, whatever it did.
    #[inline]
    pub fn is_closed(&self, robot: u32, number: u32, step: u32) -> bool {
        step < self.horizon && self.closed[self.size(robot)].is_closed(number, step)
    }

    /// Whether it is certain that a robot cannot get away from its start in time.
    pub const fn is_lost(&self) -> bool {
        self.lost
    }

    /// The step after this one. After the horizon all steps are the same.
    #[inline]
    pub(crate) fn after(&self, step: u32) -> u32 {
        (step + 1).min(self.horizon)
    }

    /// Whether robots that are at their targets at that step may rest there for good.
    pub(crate) const fn may_rest(&self, step: u32) -> bool {
        step >= self.settled
    }

    /// How far from a robot's centre the centres of others may matter.
    #[inline]
    pub(crate) fn reach(&self, robot: u32) -> u32 {
        self.bodies.radius(robot as usize) + self.bodies.largest() + self.bodies.distance() - 1
    }

    /// How far the centres of two robots must be apart.
    #[inline]
    pub(crate) fn apart(&self, a: u32, b: u32) -> u32 {
        self.bodies.apart(a as usize, b as usize)
    }

    /// The memory that it takes, in bytes.
    pub fn bytes(&self) -> usize {
        let closed = |closed: &Closed| closed.first.capacity() * 4 + closed.spans.capacity() * 8;
        self.floors.iter().map(Floor::bytes).sum::<usize>()
            + self.closed.iter().map(closed).sum::<usize>()
            + self.sizes.capacity() * 4
    }
}

/// When each cell is closed for bodies of one size.
#[derive(Debug, Clone)]
struct Closed {
    /// Where the spans of each number begin; empty if there are none at all.
    first: Vec<u32>,
    /// First and last step.
    spans: Vec<(u32, u32)>,
}

impl Closed {
    /// Goes back in time: closed is what a keep-out covers, and what leads to closed cells only.
    fn new(floor: &Floor, radius: u32, keep_outs: &KeepOuts) -> Self {
        if keep_outs.is_empty() {
            return Self { first: Vec::new(), spans: Vec::new() };
        }
        // What begins and ends to be covered at which step.
        let mut changes: BTreeMap<u32, Vec<(u32, bool)>> = BTreeMap::new();
        let lattice = floor.map().lattice();
        for keep_out in keep_outs.all().iter().filter(|keep_out| keep_out.to_step > 0) {
            let centres = lattice.block(keep_out.cell, radius).filter(|&cell| floor.map().is_free(cell));
            for number in centres.map(|cell| floor.number(cell)) {
                changes.entry(keep_out.to_step).or_default().push((number, true));
                // The start itself does not count.
                changes.entry(keep_out.from_step.max(1) - 1).or_default().push((number, false));
            }
        }
        let mut covers: BTreeMap<u32, u32> = BTreeMap::new();
        let mut ends: BTreeMap<u32, u32> = BTreeMap::new();
        let mut found: Vec<(u32, (u32, u32))> = Vec::new();
        for step in (0..=keep_outs.last_step()).rev() {
            for &(number, begins) in changes.get(&step).into_iter().flatten() {
                let count = covers.entry(number).or_default();
                *count = if begins { *count + 1 } else { *count - 1 };
            }
            covers.retain(|_, count| *count > 0);
            let trapped = |number: &u32| floor.links(*number).iter().all(|link| ends.contains_key(link));
            let mut closed: BTreeSet<u32> = ends.keys().copied().filter(trapped).collect();
            closed.extend(covers.keys());
            ends.retain(|&number, &mut end| {
                let stays = closed.contains(&number);
                if !stays {
                    found.push((number, (step + 1, end)));
                }
                stays
            });
            for number in closed {
                ends.entry(number).or_insert(step);
            }
        }
        found.extend(ends.into_iter().map(|(number, end)| (number, (0, end))));
        found.sort_unstable();
        let number = |from: u32| found.partition_point(|&(number, _)| number < from) as u32;
        let first = (0..=floor.numbers() as u32).map(number).collect();
        Self { first, spans: found.into_iter().map(|(_, span)| span).collect() }
    }

    #[inline]
    fn spans(&self, number: u32) -> &[(u32, u32)] {
        let number = number as usize;
        let Some(&[from, to]) = self.first.get(number..number + 2).and_then(|ends| ends.first_chunk()) else {
            return &[];
        };
        &self.spans[from as usize..to as usize]
    }

    #[inline]
    fn is_closed(&self, number: u32, step: u32) -> bool {
        self.spans(number).iter().any(|&(from, to)| (from..=to).contains(&step))
    }
}
