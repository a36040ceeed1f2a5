//! The best plan so far: the path of each robot, and who is where at each step.

use super::ground::Ground;
use crate::floor::{Floor, NONE};
use activecell::Plan;
use std::mem;

/// Paths of some robots that take the place of their paths in the plan.
#[derive(Debug, Clone)]
pub(super) struct Change {
    /// The robots with their paths; on the way out the new ones, once made the old ones.
    pub(super) paths: Vec<(u32, Vec<u32>)>,
}

/// A plan as paths of places. A path has a place a step, from the start to the first step of the last rest.
#[derive(Debug)]
pub(super) struct Incumbent {
    pub(super) paths: Vec<Vec<u32>>,
    /// The shortest distance of each robot.
    pub(super) least: Vec<u32>,
    /// The sum of costs.
    pub(super) sum: u64,
    /// The last step of the table; after it all rest.
    pub(super) steps: usize,
    /// The robot, plus one, in each place at each step, place by place.
    table: Vec<u16>,
    /// The delays of robots up to each, added up.
    delays: Vec<u64>,
}

impl Incumbent {
    /// Takes a plan over.
    pub(super) fn new(floor: &Floor, ground: &Ground, least: Vec<u32>, plan: &Plan) -> Self {
        let costs = plan.costs();
        let path = |(robot, &cost): (usize, &usize)| {
            (0..=cost).map(|step| ground.place(floor.number(plan.at(step, robot)))).collect()
        };
        let paths: Vec<Vec<u32>> = costs.iter().enumerate().map(path).collect();
        let steps = costs.iter().copied().max().unwrap_or(0);
        let sum = costs.iter().map(|&cost| cost as u64).sum();
        let table = vec![0; (steps + 1) * ground.len()];
        let mut new = Self { paths, least, sum, steps, table, delays: Vec::new() };
        for robot in 0..new.paths.len() as u32 {
            new.mark(robot, robot + 1);
        }
        new.add_delays();
        new
    }

    /// The bytes of the table.
    pub(super) fn bytes(&self) -> usize {
        let paths: usize = self.paths.iter().map(Vec::capacity).sum();
        paths * size_of::<u32>() + self.table.capacity() * size_of::<u16>()
    }

    pub(super) fn table_bytes(places: usize, steps: usize) -> usize {
        (steps + 1) * places * size_of::<u16>()
    }

    /// The plan.
    pub(super) fn plan(&self, floor: &Floor, ground: &Ground) -> Plan {
        let makespan = self.paths.iter().map(|path| path.len() - 1).max().unwrap_or(0);
        let cell = |step: usize, path: &Vec<u32>| {
            floor.cell(ground.number(path.get(step).copied().unwrap_or_else(|| path[path.len() - 1])))
        };
        let rows = 0..if self.paths.is_empty() { 0 } else { makespan + 1 };
        let cells = rows.flat_map(|step| self.paths.iter().map(move |path| cell(step, path))).collect();
        Plan::new(self.paths.len(), cells).expect("a cell for each robot and step")
    }

    /// The steps until a robot rests.
    #[inline]
    pub(super) fn cost(&self, robot: u32) -> usize {
        self.paths[robot as usize].len() - 1
    }

    /// The steps that a robot loses.
    #[inline]
    pub(super) fn delay(&self, robot: u32) -> usize {
        self.cost(robot) - self.least[robot as usize] as usize
    }

    /// Where a robot is at a step.
    #[inline]
    pub(super) fn at(&self, step: usize, robot: u32) -> u32 {
        let path = &self.paths[robot as usize];
        path[step.min(path.len() - 1)]
    }

    /// Who is in a place at a step, or [`NONE`].
    #[inline]
    pub(super) fn who(&self, step: usize, place: u32) -> u32 {
        u32::from(self.table[place as usize * (self.steps + 1) + step.min(self.steps)]).wrapping_sub(1)
    }

    /// A robot, drawn by its share of all delays; `None` if nobody is late.
    pub(super) fn late(&self, share: f64) -> Option<u32> {
        let all = *self.delays.last()?;
        let at = (share * all as f64) as u64;
        (all > 0).then(|| self.delays.partition_point(|&sum| sum <= at) as u32)
    }

    pub(super) fn add_delays(&mut self) {
        let mut sum = 0;
        self.delays.clear();
        for robot in 0..self.paths.len() as u32 {
            sum += self.delay(robot) as u64;
            self.delays.push(sum);
        }
    }

    /// Writes an entry of the table wherever a robot's path leads; 0 is nobody.
    fn mark(&mut self, robot: u32, entry: u32) {
        let path = &self.paths[robot as usize];
        let line = self.steps + 1;
        for (step, &place) in path.iter().enumerate() {
            self.table[place as usize * line + step] = entry as u16;
        }
        let last = path[path.len() - 1] as usize;
        self.table[last * line..][path.len()..line].fill(entry as u16);
    }

    /// Puts new paths in, if they meet nobody; the change then has the old ones.
    pub(super) fn make(&mut self, change: &mut Change) -> bool {
        for &(robot, _) in &change.paths {
            self.mark(robot, 0);
        }
        self.swap(change);
        let fits = change.paths.iter().all(|&(robot, _)| self.fits(robot));
        if !fits {
            self.swap(change);
        }
        for &(robot, _) in &change.paths {
            self.mark(robot, robot + 1);
        }
        fits
    }

    /// Exchanges the paths of a change with those of the plan, but not in the table.
    fn swap(&mut self, change: &mut Change) {
        for (robot, path) in &mut change.paths {
            let cost = self.cost(*robot) as u64;
            mem::swap(path, &mut self.paths[*robot as usize]);
            self.sum = self.sum - cost + self.cost(*robot) as u64;
        }
    }

    /// Whether a robot's path, which is not in the table, meets nobody of the table.
    fn fits(&self, robot: u32) -> bool {
        let path = &self.paths[robot as usize];
        let last = path[path.len() - 1];
        let meets = |step: usize| {
            let (here, there) = (path[step - 1], path[step]);
            let other = self.who(step - 1, there);
            self.who(step, there) != NONE || other != NONE && self.at(step, other) == here && here != there
        };
        path.len() <= self.steps + 1
            && !(1..path.len()).any(meets)
            && (path.len()..=self.steps).all(|step| self.who(step, last) == NONE)
    }
}
