//! Local guidance: before each step of all robots each one looks a few steps ahead.
//!
//! One after the other, the robots find a way through the next steps that comes as near to their targets as possible
//! and collides with few of the ways that the others have at that time. The first step of it is what the robot
//! wishes for; arbitration sees to it that nothing collides. Who went along its way keeps the rest of it.
//!
//! Source: T. Arita, K. Okumura, *Local Guidance for Configuration-Based Multi-Agent Pathfinding*, AAAI 2026
//! (arXiv 2510.19072). Our own: ways that are as short as can be and that nobody crosses are not looked for again but made
//! one step longer; a step at the target costs nothing; robots that rest at their targets have no way; who makes no
//! headway is in a hurry; and where ways from start to target are known, a robot on its own keeps to it.

use super::Problem;
use super::spread::Ways;
use super::table::{COLLISION, Table};
use crate::floor::NONE;
use activecell::Rng;

/// The most steps that a robot looks ahead.
pub(super) const MAX_WINDOW: u32 = 20;
/// What a step costs that does not leave the cell, unless it is the target; and for who is in a hurry.
const STAY: [u32; 2] = [1, 3];
/// What it costs to collide with a robot that rests; and for who is in a hurry.
const REST: [u32; 2] = [COLLISION, 1];
/// Costs that occur: to stay all the time and to collide each time is no way of more.
const COSTS: usize = (MAX_WINDOW * (STAY[1] + COLLISION)) as usize + 1;

/// The windows of all robots at one time.
#[derive(Debug, Clone)]
pub(super) struct Local<'a> {
    problem: Problem<'a>,
    window: u32,
    time: u32,
    table: Table,
    states: Vec<State>,
    nodes: Vec<Node>,
    /// The node to be taken up first of each cost, or [`NONE`].
    buckets: [u32; COSTS],
    /// A way of this cost is known: only cheaper nodes are worth while.
    limit: u32,
    rng: Rng,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    /// It has no way.
    Lost,
    /// It is at its target.
    Resting,
    /// Its way is as short as can be and collides with none.
    Calm,
    /// Its way might be improved.
    Restless,
}

/// A cell at a step of the window, and where it was reached from.
#[derive(Debug, Clone, Copy)]
struct Node {
    cell: u32,
    step: u32,
    before: u32,
    /// The node below in its bucket, or [`NONE`].
    under: u32,
}

impl<'a> Local<'a> {
    /// Windows of so many steps, from 1 to [`MAX_WINDOW`].
    pub(super) fn new(problem: Problem<'a>, window: u32, seed: u64) -> Self {
        let window = window.clamp(1, MAX_WINDOW);
        let robots = problem.starts.len();
        Self {
            problem,
            window,
            time: 0,
            table: Table::new(problem.floor.numbers(), robots, window + 1),
            states: vec![State::Lost; robots],
            nodes: Vec::new(),
            buckets: [NONE; COSTS],
            limit: NONE,
            rng: Rng::new(seed),
        }
    }

    /// The memory that such windows take, in bytes, but for a few hundred kilobytes.
    pub(super) const fn bytes(problem: Problem<'_>, window: u32) -> usize {
        Table::bytes(problem.floor.numbers(), problem.starts.len(), window + 1)
    }

    /// Fills `wishes` with the cells that the robots in `now` wish for, those first in `order` chosen first. To be
    /// called once a step.
    pub(super) fn advise(
        &mut self,
        now: &[u32],
        order: &[u32],
        hurried: &[bool],
        ways: Option<&Ways>,
        wishes: &mut Vec<u32>,
    ) {
        for (robot, &here) in now.iter().enumerate() {
            self.follow(robot as u32, here);
        }
        for &robot in order {
            let state = self.states[robot as usize];
            if state == State::Resting || state == State::Calm && self.lengthen(robot, ways) {
                continue;
            }
            if state != State::Lost {
                self.withdraw(robot, self.time..self.time + self.window);
            }
            let lead = ways.map_or(&[][..], |ways| ways.rest(robot as usize));
            self.search(robot, now[robot as usize], hurried[robot as usize], lead);
        }
        wishes.clear();
        wishes.extend((0..now.len() as u32).map(|robot| match self.states[robot as usize] {
            State::Resting => NONE,
            _ => self.table.cell(robot, self.time + 1),
        }));
        self.time += 1;
    }

    /// Takes a robot's step into account: it is in `here` now.
    fn follow(&mut self, robot: u32, here: u32) {
        let home = self.problem.goals[robot as usize].target;
        let mut state = self.states[robot as usize];
        match state {
            State::Resting if here != home => {
                self.table.rest(home, false);
                state = State::Lost;
            }
            State::Calm | State::Restless => {
                let follows = here != home && self.table.cell(robot, self.time) == here;
                let end = if follows { self.time } else { self.time + self.window };
                self.withdraw(robot, self.time - 1..end);
                if !follows {
                    state = State::Lost;
                }
            }
            State::Resting | State::Lost => {}
        }
        if here == home {
            self.table.rest(home, true);
            state = State::Resting;
        }
        self.states[robot as usize] = state;
    }

    fn withdraw(&mut self, robot: u32, times: std::ops::Range<u32>) {
        for time in times {
            self.table.withdraw(robot, time);
        }
    }

    /// Makes a way one step longer; false if it would collide, or not come nearer.
    fn lengthen(&mut self, robot: u32, ways: Option<&Ways>) -> bool {
        let time = self.time + self.window - 1;
        let here = self.table.cell(robot, time);
        let goal = self.problem.goals[robot as usize];
        let links = self.problem.floor.links(here);
        let open = |there: u32| self.table.price(here, there, time, REST[0]) == 0;
        let there = if here == goal.target {
            open(here).then_some(here)
        } else if let Some(next) = ways.and_then(|ways| ways.after(robot as usize, here, self.window)) {
            open(next).then_some(next)
        } else {
            let [nearer, ..] = self.problem.fields.field(goal.slot).split(here, links);
            let turn = self.rng.next_u64() as usize;
            let mut slots = (0..8).map(|slot| (slot + turn) % 8).filter(|slot| nearer >> slot & 1 == 1);
            slots.find_map(|slot| open(links[slot]).then_some(links[slot]))
        };
        if let Some(there) = there {
            self.table.enter(robot, there, time + 1);
        }
        there.is_some()
    }

    /// Finds a way of least cost for a robot that has none, and enters it; gives its cost.
    ///
    /// Steps nearer cost nothing here, level ones 1, steps away 2: the step itself and the distance that it adds. Nodes
    /// of equal cost are taken up the last first, so that open ways are walked straight on. `lead` is a known
    /// way: steps along it cost nothing, steps off it at least 1.
    fn search(&mut self, robot: u32, start: u32, hurried: bool, lead: &[u32]) -> u32 {
        let goal = self.problem.goals[robot as usize];
        let field = self.problem.fields.field(goal.slot);
        let [stay, rest] = [STAY, REST].map(|prices| prices[usize::from(hurried)]);
        let lead = &lead[..lead.len().min(2 * self.window as usize)];
        for pair in lead.windows(2) {
            self.table.spot(pair[0]).lead = pair[1] + 1;
        }
        self.limit = COSTS as u32;
        self.push(Node { cell: start, step: 0, before: NONE, under: NONE }, 0);
        let mut cost = 0;
        let end = loop {
            let number = self.buckets[cost as usize];
            let Some(&Node { cell: here, step, under, .. }) = self.nodes.get(number as usize) else {
                cost += 1;
                continue;
            };
            self.buckets[cost as usize] = under;
            if !self.table.see(here, self.time + step) {
                continue;
            }
            if step == self.window {
                break number;
            }
            let links = self.problem.floor.links(here);
            let [nearer, level, _] = field.split(here, links);
            let lead = self.table.spot(here).lead;
            let stay = if here == goal.target { 0 } else { stay };
            self.reach(number, here, cost + stay, rest);
            for slot in turned(links.len(), self.rng.next_u64()) {
                let rise = 2 * (!nearer >> slot & 1) - (level >> slot & 1);
                let off = if lead == links[slot] + 1 { 0 } else { rise.max(1) };
                self.reach(number, links[slot], cost + if lead == 0 { rise } else { off }, rest);
            }
        };
        for &cell in lead {
            self.table.spot(cell).lead = 0;
        }
        self.enter(robot, end);
        self.states[robot as usize] = if cost == 0 { State::Calm } else { State::Restless };
        for node in self.nodes.drain(..) {
            self.table.forget(node.cell);
        }
        self.buckets.fill(NONE);
        cost
    }

    /// Takes up the step from a node to a cell; `cost` is without collisions.
    #[inline]
    fn reach(&mut self, from: u32, there: u32, cost: u32, rest: u32) {
        let Node { cell: here, step, .. } = self.nodes[from as usize];
        let time = self.time + step;
        if cost >= self.limit || self.table.seen(there, time + 1) {
            return;
        }
        let cost = cost + self.table.price(here, there, time, rest);
        if cost < self.limit {
            if step + 1 == self.window {
                self.limit = cost;
            }
            self.push(Node { cell: there, step: step + 1, before: from, under: NONE }, cost);
        }
    }

    #[inline]
    fn push(&mut self, mut node: Node, cost: u32) {
        node.under = std::mem::replace(&mut self.buckets[cost as usize], self.nodes.len() as u32);
        self.nodes.push(node);
    }

    /// Enters the way that ends in a node. Whom it crosses becomes restless.
    fn enter(&mut self, robot: u32, end: u32) {
        let (mut then, mut at) = (NONE, end);
        while let Some(&Node { cell, step, before, .. }) = self.nodes.get(at as usize) {
            let time = self.time + step;
            for other in self.table.robots(cell, time) {
                self.states[other as usize] = State::Restless;
            }
            if then != NONE
                && let Some(other) = self.table.opposed(cell, then, time)
            {
                self.states[other as usize] = State::Restless;
            }
            self.table.enter(robot, cell, time);
            (then, at) = (cell, before);
        }
    }
}

/// The numbers below `count`, beginning anywhere, upwards or downwards.
#[inline]
pub(super) fn turned(count: usize, chance: u64) -> impl Iterator<Item = usize> {
    let first = (((chance >> 32) * count as u64) >> 32) as usize;
    let turn = move |i: usize| if i + first < count { i + first } else { i + first - count };
    (0..count).map(move |i| if chance & 1 == 0 { turn(i) } else { count - 1 - turn(i) })
}

#[cfg(test)]
mod tests;
