//! One that plans neighbourhoods again, on reservations of its own.

use super::View;
use super::choose::{Picker, Task};
use super::ground::Ground;
use super::incumbent::{Change, Incumbent};
use crate::floor::Floor;
use crate::passage::{Passage, Reservations};
use activecell::Rng;

/// The part of its cost that a robot may lose before others gain.
const LOSS: usize = 20;

/// What a worker found.
#[derive(Debug)]
pub(super) struct Proposal {
    /// New paths; none if nothing as good was found.
    pub(super) change: Option<Change>,
    /// The sum of costs that it saves.
    pub(super) gain: u64,
    /// What it took, in paths looked for.
    pub(super) work: usize,
}

/// A worker with what it needs to work alone.
#[derive(Debug)]
pub(super) struct Worker {
    taken: Reservations,
    passage: Passage,
    picker: Picker,
}

impl Worker {
    pub(super) fn new(floor: &Floor, ground: &Ground, plan: &Incumbent) -> Self {
        let taken = Reservations::new(floor, plan.steps);
        let passage = Passage::new(taken.layout());
        let mut new = Self { taken, passage, picker: Picker::new(plan.paths.len()) };
        for path in &plan.paths {
            new.mark(ground, path, true);
        }
        new
    }

    pub(super) fn bytes(&self) -> usize {
        self.taken.bytes_kept() + self.passage.bytes() + self.picker.bytes()
    }

    fn mark(&mut self, ground: &Ground, path: &[u32], taken: bool) {
        self.taken.mark(path.iter().map(|&place| ground.bit(place)), taken);
    }

    /// Follows changes that the plan has made.
    pub(super) fn follow(&mut self, ground: &Ground, plan: &Incumbent, changes: &[Change]) {
        for change in changes {
            for (_, old) in &change.paths {
                self.mark(ground, old, false);
            }
        }
        for change in changes {
            for &(robot, _) in &change.paths {
                self.mark(ground, &plan.paths[robot as usize], true);
            }
        }
    }

    /// Plans a neighbourhood again; the reservations are then what they were.
    pub(super) fn attempt(&mut self, view: View<'_>, task: &Task) -> Proposal {
        let View { ground, plan, .. } = view;
        let mut rng = Rng::new(task.seed);
        let mut robots = self.picker.pick(view, task, &mut rng);
        rng.shuffle(&mut robots);
        for &robot in &robots {
            self.mark(ground, &plan.paths[robot as usize], false);
        }
        let paths = self.plan_again(view, &robots, &mut rng);
        for (_, path) in &paths {
            self.mark(ground, path, false);
        }
        for &robot in &robots {
            self.mark(ground, &plan.paths[robot as usize], true);
        }
        let work = 1 + robots.len().min(paths.len() + 1);
        if paths.is_empty() || paths.len() < robots.len() {
            return Proposal { change: None, gain: 0, work };
        }
        let old: usize = robots.iter().map(|&robot| plan.cost(robot)).sum();
        let new: usize = paths.iter().map(|(_, path)| path.len() - 1).sum();
        Proposal { change: Some(Change { paths }), gain: (old - new) as u64, work }
    }

    /// New paths for these robots, one after the other, all of them at most as dear as before; or for the first of them
    /// only, if that cannot be. They are reserved.
    fn plan_again(&mut self, view: View<'_>, robots: &[u32], rng: &mut Rng) -> Vec<(u32, Vec<u32>)> {
        let View { ground, plan, .. } = view;
        let least = |robot: u32| plan.least[robot as usize] as usize;
        // What may still be spent, if all that follow take their shortest ways.
        let mut budget: usize = robots.iter().map(|&robot| plan.cost(robot) - least(robot)).sum();
        let mut saved = 0_isize;
        let mut paths = Vec::with_capacity(robots.len());
        for &robot in robots {
            let cost = plan.cost(robot);
            // One that loses much is seldom made good by others: measured, giving up on it saves a third of the time.
            let loss = saved.max(0) as usize + cost / LOSS + 4;
            let latest = (least(robot) + budget).min(cost + loss).min(plan.steps);
            let path = &plan.paths[robot as usize];
            let [from, to] = [path[0], path[path.len() - 1]].map(|place| ground.bit(place));
            let Some(mut path) = self.passage.earliest(&self.taken, from, to, latest, rng) else { break };
            self.taken.reserve(&path);
            budget -= path.len() - 1 - least(robot);
            saved += cost as isize - (path.len() as isize - 1);
            for bit in &mut path {
                *bit = ground.place_of_bit(*bit);
            }
            paths.push((robot, path));
        }
        paths
    }
}
