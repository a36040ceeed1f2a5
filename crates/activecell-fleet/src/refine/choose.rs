//! Which robots are planned again together.
//!
//! Sources: the neighbourhoods of J. Li et al., *Anytime Multi-Agent Path Finding via Large Neighborhood Search*, IJCAI
//! 2021: of a late robot, of a busy place, by chance.

use super::View;
use crate::floor::NONE;
use activecell::Rng;
use std::cmp::Ordering;

/// How robots are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// One that is late.
    Alone,
    /// A late robot, and who is in its way.
    Late,
    /// Robots that pass a place about the same time.
    Busy,
    /// A late robot, and who passes its target after it could be there.
    Target,
    /// Any.
    Chance,
}

/// A neighbourhood to be planned again.
#[derive(Debug, Clone, Copy)]
pub(super) struct Task {
    pub(super) kind: Kind,
    /// How many robots at most.
    pub(super) size: usize,
    pub(super) seed: u64,
}

/// Chooses robots, and keeps memory for it.
#[derive(Debug)]
pub(super) struct Picker {
    chosen: Vec<u32>,
    /// How many are to be chosen at most.
    size: usize,
    /// Whether each robot is chosen.
    is_chosen: Vec<bool>,
}

impl Picker {
    pub(super) fn new(robots: usize) -> Self {
        Self { chosen: Vec::new(), size: 0, is_chosen: vec![false; robots] }
    }

    pub(super) fn bytes(&self) -> usize {
        self.chosen.capacity() * size_of::<u32>() + self.is_chosen.capacity()
    }

    /// The robots of a task: the first of them is late.
    pub(super) fn pick(&mut self, view: View<'_>, task: &Task, rng: &mut Rng) -> Vec<u32> {
        let robots = view.plan.paths.len() as u32;
        self.size = task.size.min(view.plan.paths.len());
        let share = rng.unit();
        if let Some(late) = view.plan.late(share) {
            self.add(late);
            match task.kind {
                Kind::Alone => {}
                Kind::Late => self.in_the_way(view, late, rng),
                Kind::Busy => self.about(view, late, rng),
                Kind::Target => self.past_target(view, late, rng),
                Kind::Chance => {
                    while !self.is_full() {
                        self.add(rng.below(robots));
                    }
                }
            }
        }
        for &robot in &self.chosen {
            self.is_chosen[robot as usize] = false;
        }
        std::mem::take(&mut self.chosen)
    }

    const fn is_full(&self) -> bool {
        self.chosen.len() >= self.size
    }

    fn add(&mut self, robot: u32) {
        if robot != NONE && !self.is_full() && !self.is_chosen[robot as usize] {
            self.is_chosen[robot as usize] = true;
            self.chosen.push(robot);
        }
    }

    /// Walks from random points of the robot's path to its target as if nobody were there, and adds whom it meets.
    fn in_the_way(&mut self, view: View<'_>, late: u32, rng: &mut Rng) {
        let View { ground, guides, plan } = view;
        let mut robot = late;
        for _ in 0..2 * self.size {
            let cost = plan.cost(robot);
            if cost == 0 {
                break;
            }
            let mut step = rng.below(cost as u32) as usize;
            let mut here = plan.at(step, robot);
            let field = guides.field(robot);
            let target = guides.target(robot);
            while here != target && step < cost && !self.is_full() {
                let links = ground.links(here);
                let from = rng.below(links.len() as u32) as usize;
                let ahead = (0..links.len())
                    .map(|i| links[(from + i) % links.len()])
                    .find(|&next| field.compare(ground.number(here), ground.number(next)) == Ordering::Less);
                let Some(next) = ahead else { break };
                let other = plan.who(step, next);
                if other != NONE && plan.at(step + 1, other) == here {
                    self.add(other);
                }
                here = next;
                step += 1;
                self.add(plan.who(step, here));
            }
            if here == target {
                while step < cost && !self.is_full() {
                    self.add(plan.who(step, here));
                    step += 1;
                }
            }
            if self.is_full() {
                break;
            }
            robot = self.chosen[rng.below(self.chosen.len() as u32) as usize];
        }
    }

    /// From a place on the robot's path outwards, adds who is there about that time.
    fn about(&mut self, view: View<'_>, late: u32, rng: &mut Rng) {
        let View { ground, plan, .. } = view;
        let step = rng.below(plan.cost(late) as u32 + 1) as usize;
        let mut rim = vec![plan.at(step, late)];
        let mut next = 0;
        while next < rim.len() && next < 64 && !self.is_full() {
            let here = rim[next];
            for step in step.saturating_sub(2)..=step + 2 {
                self.add(plan.who(step, here));
            }
            for &link in ground.links(here) {
                if !rim.contains(&link) {
                    rim.push(link);
                }
            }
            next += 1;
        }
    }

    /// Adds who passes the robot's target, or rests on its way.
    fn past_target(&mut self, view: View<'_>, late: u32, rng: &mut Rng) {
        let View { guides, plan, .. } = view;
        let target = guides.target(late);
        for step in (plan.least[late as usize] as usize..plan.cost(late)).rev() {
            self.add(plan.who(step, target));
        }
        self.in_the_way(view, late, rng);
    }
}
