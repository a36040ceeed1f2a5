//! The paths of all robots through the window, and how they become better: each in turn, and by making way.

mod row;

use super::distances::{Distances, View};
use super::ground::{Ground, Place};
use super::reach::{Goal, Look, Reach};
use super::window::Window;
use crate::floor::NONE;
use activecell::Rng;
use row::Row;

/// Where a robot has to go: the cell and the slot of its distances, for the next errand and, if known, for the one after.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Want {
    pub(super) target: u32,
    pub(super) slot: u32,
    /// The slot of the errand after, and how far that is from this one.
    pub(super) next: Option<(u32, u32)>,
}

/// What all paths are about; it stays the same while they become better.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scene<'a> {
    pub(super) ground: &'a Ground,
    pub(super) distances: &'a Distances,
    pub(super) wants: &'a [Option<Want>],
    /// Who comes first.
    pub(super) ranks: &'a [u32],
    /// How much a step of each robot counts.
    pub(super) weights: &'a [u32],
}

impl<'a> Scene<'a> {
    fn view(&self, slot: u32) -> View<'a> {
        self.distances.view(self.ground, slot)
    }

    fn goal(&self, robot: usize) -> Option<Goal<'a>> {
        let want = self.wants[robot]?;
        let next = want.next.map(|(slot, leg)| (self.view(slot), leg));
        Some(Goal { target: want.target, view: self.view(want.slot), next })
    }

    /// The steps that a robot needs from a place if nobody else is there.
    pub(super) fn distance(&self, robot: usize, place: Place) -> u32 {
        let Some(want) = self.wants[robot] else { return 0 };
        u32::from(self.view(want.slot).at(self.ground, place.spot(), place.heading()))
    }

    /// What a path costs, as [`Reach::find`] counts.
    fn cost(&self, robot: usize, path: &[Place]) -> u32 {
        let Some(goal) = self.goal(robot) else { return 0 };
        let last = path[path.len() - 1];
        let left = |view: View<'_>| u32::from(view.at(self.ground, last.spot(), last.heading()));
        let window = path.len() as u32 - 1;
        match (path.iter().position(|place| place.spot() == goal.target), goal.next) {
            (Some(step), None) => step as u32,
            (Some(_), Some((view, leg))) => (window + left(view)).saturating_sub(leg),
            (None, _) => window + left(goal.view),
        }
    }

    fn weigh(&self, robot: usize, cost: u32) -> u64 {
        u64::from(self.weights[robot]) * u64::from(cost)
    }
}

/// By what a chain of robots that make way for each other is judged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Judge {
    /// Who comes first goes first, whatever it costs those after it.
    Rank,
    /// All together must cost no more than before, by weight.
    Sum,
}

/// How far a chain may go.
#[derive(Debug, Clone, Copy)]
pub(super) struct Chain {
    pub(super) judge: Judge,
    /// The most robots in it.
    pub(super) robots: usize,
    /// The most paths to be looked for.
    pub(super) paths: u64,
}

/// The robots whose paths are looked for together, in the order in which each was asked to make way.
#[derive(Debug, Clone, Default)]
struct Group {
    robots: Vec<u32>,
    /// Their old paths, one after the other.
    paths: Vec<Place>,
    /// What the new paths cost; of the first robots, as far as they have new ones.
    costs: Vec<u32>,
    /// Robots that could not make way.
    stuck: Vec<u32>,
}

/// The paths of all robots through the window.
#[derive(Debug, Clone)]
pub(super) struct Crew {
    /// All paths.
    window: Window,
    /// Those that must stay as they are for now.
    firm: Window,
    /// The places of a path.
    length: usize,
    paths: Vec<Place>,
    costs: Vec<u32>,
    reach: Reach,
    group: Group,
    alone: Vec<Place>,
    row: Row,
    /// Paths looked for.
    pub(super) work: u64,
}

/// How often somebody looks for another robot that could make way.
const TRIES: usize = 3;
/// Steps that a robot that turns is given more at each try to get away.
const GRACE: usize = 2;

impl Crew {
    /// All robots rest where they are.
    pub(super) fn new(ground: &Ground, starts: &[Place], steps: usize) -> Self {
        let length = steps + 1;
        let firm = Window::new(ground, steps);
        let mut window = firm.clone();
        let paths: Vec<Place> = starts.iter().flat_map(|&place| std::iter::repeat_n(place, length)).collect();
        for (robot, path) in paths.chunks_exact(length).enumerate() {
            window.reserve(ground, path, robot as u32);
        }
        Self {
            window,
            firm,
            length,
            paths,
            costs: vec![0; starts.len()],
            reach: Reach::new(ground, steps),
            group: Group::default(),
            alone: vec![Place::default(); length],
            row: Row::new(ground),
            work: 0,
        }
    }

    /// The path of a robot, from where it is now.
    pub(super) fn path(&self, robot: usize) -> &[Place] {
        &self.paths[robot * self.length..][..self.length]
    }

    /// A step passes: all robots go their first step, and rest a step longer at the end.
    pub(super) fn pass(&mut self) {
        for path in self.paths.chunks_exact_mut(self.length) {
            path.copy_within(1.., 0);
        }
        self.window.pass();
        self.firm.pass();
    }

    /// Counts the costs anew, after targets have changed.
    pub(super) fn count(&mut self, scene: Scene<'_>) {
        for robot in 0..self.costs.len() {
            self.costs[robot] = scene.cost(robot, self.path(robot));
        }
    }

    /// Whether a robot goes as fast as it could alone.
    pub(super) fn is_best(&self, scene: Scene<'_>, robot: usize) -> bool {
        self.costs[robot] <= scene.distance(robot, self.path(robot)[0])
    }

    /// Looks for a path of one robot among all others; the old one stays if there is none as good.
    pub(super) fn improve(&mut self, scene: Scene<'_>, robot: usize, rng: &mut Rng) {
        self.take(scene, robot);
        match self.plan(scene, robot, rng) {
            Some(cost) if cost <= self.costs[robot] => {
                self.costs[robot] = cost;
                let path = &self.paths[robot * self.length..][..self.length];
                self.window.reserve(scene.ground, path, robot as u32);
                self.group.emptied();
            }
            _ => self.put_back(scene),
        }
    }

    /// Makes a robot's path one that nobody may take away.
    pub(super) fn fix(&mut self, scene: Scene<'_>, robot: usize) {
        let path = &self.paths[robot * self.length..][..self.length];
        self.firm.reserve(scene.ground, path, robot as u32);
    }

    /// Makes it again one that others may take away.
    pub(super) fn loosen(&mut self, scene: Scene<'_>, robot: usize) {
        let path = &self.paths[robot * self.length..][..self.length];
        self.firm.release(scene.ground, path);
    }

    /// Gives a robot a better path by taking away that of another one, which must find a new one and may take that of a
    /// third for it, and so on. Nothing changes if the judge does not like the outcome.
    pub(super) fn push(&mut self, scene: Scene<'_>, robot: usize, chain: Chain, rng: &mut Rng) {
        self.take(scene, robot);
        let chain = Chain { paths: self.work + chain.paths, ..chain };
        let old = scene.weigh(robot, self.costs[robot]);
        let moved = self.make_way(scene, robot, self.costs[robot], (old, 0), chain, rng);
        while let Some(robot) = self.group.stuck.pop() {
            self.loosen(scene, robot as usize);
        }
        if !moved {
            return self.put_back(scene);
        }
        for at in 0..self.group.robots.len() {
            let robot = self.group.robots[at] as usize;
            self.costs[robot] = self.group.costs[at];
            self.loosen(scene, robot);
        }
        self.group.emptied();
    }

    /// Finds a path of the last robot of the group that costs less than `known`, with the help of another one. `sums` are
    /// what the old paths of the group cost, and the new ones of those before.
    fn make_way(
        &mut self,
        scene: Scene<'_>,
        robot: usize,
        known: u32,
        sums: (u64, u64),
        chain: Chain,
        rng: &mut Rng,
    ) -> bool {
        if self.group.robots.len() >= chain.robots {
            return false;
        }
        let by_rank = chain.judge == Judge::Rank;
        let first = scene.ranks[self.group.robots[0] as usize];
        // Who must turn first may need some steps to get away; they pay where rank alone decides.
        let lenient = by_rank && scene.ground.headings() > 1;
        let tries = if lenient { TRIES } else { TRIES - 1 };
        for turn in 0..tries {
            if self.work >= chain.paths {
                return false;
            }
            let Some(other) = self.in_the_way(scene, robot, rng) else { continue };
            if by_rank && scene.ranks[other] < first {
                continue;
            }
            let start = self.path(other)[0];
            self.take(scene, other);
            // At later tries its first steps count, too.
            let steps = if lenient { turn * GRACE } else { 0 };
            let mut grace = [start; GRACE * TRIES];
            let grace = &mut grace[..steps.min(self.length)];
            let old = self.group.paths.len() - self.length;
            grace.copy_from_slice(&self.group.paths[old..old + grace.len()]);
            self.window.reserve(scene.ground, grace, other as u32);
            let found = self.plan(scene, robot, rng).filter(|&cost| cost < known);
            self.window.release(scene.ground, grace);
            let Some(cost) = found else {
                self.put_back(scene);
                continue;
            };
            let old = sums.0 + scene.weigh(other, self.costs[other]);
            let new = sums.1 + scene.weigh(robot, cost);
            let is_good = |cost: u32| by_rank || new + scene.weigh(other, cost) <= old;
            if is_good(scene.distance(other, start)) {
                self.settle(scene, robot, cost);
                let found = self.plan(scene, other, rng);
                if let Some(cost) = found.filter(|&cost| is_good(cost)) {
                    self.settle(scene, other, cost);
                    return true;
                }
                if self.make_way(scene, other, found.unwrap_or(u32::MAX), (old, new), chain, rng) {
                    return true;
                }
                self.unsettle(scene, robot);
            }
            self.put_back(scene);
            if !lenient || turn + 1 == tries {
                self.fix(scene, other);
                self.group.stuck.push(other as u32);
            }
        }
        false
    }

    /// Takes the path of a robot out of the window: it joins the group.
    fn take(&mut self, scene: Scene<'_>, robot: usize) {
        let path = &self.paths[robot * self.length..][..self.length];
        self.window.release(scene.ground, path);
        self.group.paths.extend_from_slice(path);
        self.group.robots.push(robot as u32);
    }

    /// Puts the old path of the last robot of the group back: it leaves the group.
    fn put_back(&mut self, scene: Scene<'_>) {
        let robot = self.group.robots.pop().expect("somebody was taken out");
        let from = self.group.robots.len() * self.length;
        let path = &mut self.paths[robot as usize * self.length..][..self.length];
        path.copy_from_slice(&self.group.paths[from..]);
        self.group.paths.truncate(from);
        self.window.reserve(scene.ground, path, robot);
    }

    /// A robot of the group keeps its new path, and nobody may take it away.
    fn settle(&mut self, scene: Scene<'_>, robot: usize, cost: u32) {
        let path = &self.paths[robot * self.length..][..self.length];
        self.window.reserve(scene.ground, path, robot as u32);
        self.firm.reserve(scene.ground, path, robot as u32);
        self.group.costs.push(cost);
    }

    fn unsettle(&mut self, scene: Scene<'_>, robot: usize) {
        let path = &self.paths[robot * self.length..][..self.length];
        self.window.release(scene.ground, path);
        self.firm.release(scene.ground, path);
        self.group.costs.pop();
    }

    /// The best path of a robot of the group, and its cost.
    fn plan(&mut self, scene: Scene<'_>, robot: usize, rng: &mut Rng) -> Option<u32> {
        self.work += 1;
        let start = self.start(robot);
        let look = Look { ground: scene.ground, window: &self.window, chance: rng.next_u64() };
        let path = &mut self.paths[robot * self.length..][..self.length];
        self.reach.find(look, start, scene.goal(robot).as_ref(), path)
    }

    /// Where a robot of the group is now.
    fn start(&self, robot: usize) -> Place {
        let at = self.group.robots.iter().rposition(|&other| other as usize == robot);
        self.group.paths[at.expect("it was taken out") * self.length]
    }

    /// The first one to be met if a robot of the group goes as if only those were there that must stay as they are.
    fn in_the_way(&mut self, scene: Scene<'_>, robot: usize, rng: &mut Rng) -> Option<usize> {
        self.work += 1;
        let start = self.start(robot);
        let look = Look { ground: scene.ground, window: &self.firm, chance: rng.next_u64() };
        self.reach.find(look, start, scene.goal(robot).as_ref(), &mut self.alone)?;
        let met = |(step, pair): (usize, &[Place])| {
            let (from, to) = (pair[0].spot(), pair[1].spot());
            let there = self.window.owner(step + 1, to);
            if there != NONE {
                return Some(there as usize);
            }
            let other = self.window.owner(step, to);
            let swaps = from != to && other != NONE && other == self.window.owner(step + 1, from);
            swaps.then_some(other as usize)
        };
        self.alone.windows(2).enumerate().find_map(met)
    }

    /// The memory that it takes, in bytes.
    pub(super) fn bytes(&self) -> usize {
        self.window.bytes()
            + self.firm.bytes()
            + self.reach.bytes()
            + self.row.bytes()
            + self.paths.capacity() * size_of::<Place>()
    }
}

impl Group {
    fn emptied(&mut self) {
        self.robots.clear();
        self.paths.clear();
        self.costs.clear();
    }
}
