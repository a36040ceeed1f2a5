//! One that plans neighbourhoods again, on reservations of its own.

use super::choose::{Picker, Task};
use super::ground::Ground;
use super::incumbent::{Change, Incumbent};
use crate::floor::Floor;
use crate::passage::{Passage, Reservations};
use activecell::Rng;

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
        self.taken.bytes_kept() + self.passage.bytes()
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
    pub(super) fn attempt(
        &mut self,
        ground: &Ground,
        fields: &super::Guides<'_>,
        plan: &Incumbent,
        task: &Task,
    ) -> Proposal {
        let mut rng = Rng::new(task.seed);
        let mut robots = self.picker.pick(ground, fields, plan, task, &mut rng);
        for i in (1..robots.len()).rev() {
            robots.swap(i, rng.below(i as u32 + 1) as usize);
        }
        for &robot in &robots {
            self.mark(ground, &plan.paths[robot as usize], false);
        }
        let old: usize = robots.iter().map(|&robot| plan.cost(robot)).sum();
        let mut least: usize = robots.iter().map(|&robot| plan.least[robot as usize] as usize).sum();
        let (mut spent, mut work) = (0, 1);
        let mut paths: Vec<(u32, Vec<u32>)> = Vec::with_capacity(robots.len());
        for &robot in &robots {
            least -= plan.least[robot as usize] as usize;
            if old < spent + least {
                break;
            }
            let latest = (old - spent - least).min(plan.steps);
            let path = &plan.paths[robot as usize];
            let [from, to] = [path[0], path[path.len() - 1]].map(|place| ground.bit(place));
            work += 1;
            let Some(path) = self.passage.earliest(&self.taken, from, to, latest, &mut rng) else { break };
            self.taken.reserve(&path);
            spent += path.len() - 1;
            paths.push((robot, path));
        }
        for (_, path) in &paths {
            self.taken.release(path);
        }
        for &robot in &robots {
            self.mark(ground, &plan.paths[robot as usize], true);
        }
        let complete = paths.len() == robots.len() && !robots.is_empty();
        for (_, path) in &mut paths {
            path.iter_mut().for_each(|bit| *bit = ground.place_of_bit(*bit));
        }
        let gain = if complete { (old - spent) as u64 } else { 0 };
        Proposal { change: complete.then_some(Change { paths }), gain, work }
    }
}
