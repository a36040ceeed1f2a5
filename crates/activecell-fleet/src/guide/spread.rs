//! Ways for all robots from start to target, spread over the floor so that they meet seldom.
//!
//! One after the other, the robots find a way that is at most a little longer than the shortest and meets the others'
//! ways, and robots that rest at their targets by then, as seldom as can be. Ways do not wait.
//!
//! Source: K. Okumura, *Engineering `LaCAM*`: Towards Real-Time, Large-Scale, and Near-Optimal Multi-Agent Pathfinding*,
//! AAMAS 2024 (space utilisation optimisation). Our own: a search by buckets over compact fields, and that arbitration
//! follows the ways with a window ahead (`local.rs`).

use super::Problem;
use super::local::turned;
use crate::floor::NONE;
use activecell::Rng;

/// How much longer than the shortest a way may be, in steps.
const MARGIN: u32 = 10;
/// What it costs to meet somebody: more than any detour.
const MEETING: u32 = MARGIN + 1;
/// The ways are looked for at most so many times.
const ROUNDS: usize = 4;
/// Costs that are told apart; what costs more counts as the last.
const COSTS: usize = 1 << 12;

/// A way of each robot, from its start to its target, and how far it has come.
#[derive(Debug, Clone)]
pub(super) struct Ways {
    /// Where each robot's way begins among the visits.
    first: Vec<u32>,
    /// How many cells each way has.
    counts: Vec<u32>,
    /// The cells of the ways, by visit.
    cells: Vec<u32>,
    /// On which cell of its way each robot was last.
    places: Vec<u32>,
}

impl Ways {
    /// Spreads the ways of robots that have so many steps to go; the ways found so far, perhaps none, if it is to stop.
    pub(super) fn new(problem: Problem<'_>, ahead: &[u32], seed: u64, stop: &impl Fn() -> bool) -> Self {
        let mut spread = Spread::new(problem, ahead);
        let mut rng = Rng::new(seed);
        let mut order: Vec<u32> = (0..ahead.len() as u32).collect();
        let mut least = u64::MAX;
        for _ in 0..ROUNDS {
            rng.shuffle(&mut order);
            let mut sum = 0;
            for &robot in &order {
                if stop() {
                    return spread.ways;
                }
                sum += u64::from(spread.again(robot as usize, &mut rng));
            }
            if sum == 0 || sum >= least {
                break;
            }
            least = sum;
        }
        spread.ways
    }

    /// The memory that spreading takes, in bytes.
    pub(super) fn bytes(problem: Problem<'_>, ahead: &[u32]) -> usize {
        let visits: usize = ahead.iter().map(|&steps| (steps + MARGIN + 1) as usize).sum();
        let heads = visits.next_power_of_two();
        problem.floor.numbers() * 5 + (visits * 2 + heads + 3 * ahead.len()) * size_of::<u32>()
    }

    /// Takes note of where the robots are.
    pub(super) fn follow(&mut self, now: &[u32]) {
        for (robot, &here) in now.iter().enumerate() {
            let rest = self.rest(robot);
            let place = match rest {
                [at, ..] if *at == here => continue,
                [_, next, ..] if *next == here => self.places[robot] + 1,
                _ => match self.way(robot).iter().position(|&cell| cell == here) {
                    Some(place) => place as u32,
                    None => continue,
                },
            };
            self.places[robot] = place;
        }
    }

    fn way(&self, robot: usize) -> &[u32] {
        &self.cells[self.first[robot] as usize..][..self.counts[robot] as usize]
    }

    /// The rest of a robot's way, from the last cell of it that it was on.
    pub(super) fn rest(&self, robot: usize) -> &[u32] {
        self.way(robot).get(self.places[robot] as usize..).unwrap_or(&[])
    }

    /// The cell after `here` on a robot's way, if `here` is on it and about so many steps ahead.
    pub(super) fn after(&self, robot: usize, here: u32, window: u32) -> Option<u32> {
        let rest = self.rest(robot);
        let near = &rest[..rest.len().min(2 * window as usize)];
        near.windows(2).find(|pair| pair[0] == here).map(|pair| pair[1])
    }
}

#[derive(Debug, Clone, Copy)]
struct Node {
    cell: u32,
    /// Steps from the start.
    time: u32,
    /// How many of them are more than the shortest way needs.
    excess: u32,
    before: u32,
    /// The node below in its bucket, or [`NONE`].
    under: u32,
}

/// Ways that are being spread: who is where when. A visit is one cell of one robot's way.
struct Spread<'a> {
    problem: Problem<'a>,
    ways: Ways,
    /// The visit after each with the same hash, or [`NONE`].
    nexts: Vec<u32>,
    /// The first visit of each hash.
    heads: Vec<u32>,
    /// From when on somebody rests in each cell.
    rests: Vec<u32>,
    seen: Vec<bool>,
    nodes: Vec<Node>,
    buckets: Vec<u32>,
    /// The highest cost in the buckets.
    most: u32,
}

impl<'a> Spread<'a> {
    fn new(problem: Problem<'a>, ahead: &[u32]) -> Self {
        let mut visits = 0;
        let room = |&steps: &u32| {
            visits += steps + MARGIN + 1;
            visits - (steps + MARGIN + 1)
        };
        let first = ahead.iter().map(room).collect();
        let cells = vec![NONE; visits as usize];
        let zeros = vec![0; ahead.len()];
        Self {
            problem,
            nexts: cells.clone(),
            heads: vec![NONE; cells.len().next_power_of_two()],
            ways: Ways { first, counts: zeros.clone(), cells, places: zeros },
            rests: vec![NONE; problem.floor.numbers()],
            seen: vec![false; problem.floor.numbers()],
            nodes: Vec::new(),
            buckets: vec![NONE; COSTS],
            most: 0,
        }
    }

    /// Finds a robot's way again; gives its cost.
    fn again(&mut self, robot: usize, rng: &mut Rng) -> u32 {
        self.withdraw(robot);
        let Problem { floor, fields, goals, starts } = self.problem;
        let goal = goals[robot];
        let field = fields.field(goal.slot);
        self.push(Node { cell: starts[robot], time: 0, excess: 0, before: NONE, under: NONE }, 0);
        let mut cost = 0;
        let end = loop {
            let number = self.buckets[cost as usize];
            let Some(&Node { cell: here, time, excess, under, .. }) = self.nodes.get(number as usize) else {
                cost += 1;
                continue;
            };
            self.buckets[cost as usize] = under;
            if std::mem::replace(&mut self.seen[here as usize], true) {
                continue;
            }
            if here == goal.target {
                break number;
            }
            let links = floor.links(here);
            let [nearer, level, _] = field.split(here, links);
            for slot in turned(links.len(), rng.next_u64()) {
                let (there, rise) = (links[slot], 2 * (!nearer >> slot & 1) - (level >> slot & 1));
                if !self.seen[there as usize] && excess + rise <= MARGIN {
                    let cost = cost + rise + MEETING * self.met(here, there, time + 1);
                    let node =
                        Node { cell: there, time: time + 1, excess: excess + rise, before: number, under };
                    self.push(node, cost);
                }
            }
        };
        self.enter(robot, end);
        for node in self.nodes.drain(..) {
            self.seen[node.cell as usize] = false;
        }
        self.buckets[..=self.most as usize].fill(NONE);
        self.most = 0;
        cost
    }

    fn push(&mut self, mut node: Node, cost: u32) {
        let cost = cost.min(COSTS as u32 - 1);
        self.most = self.most.max(cost);
        node.under = std::mem::replace(&mut self.buckets[cost as usize], self.nodes.len() as u32);
        self.nodes.push(node);
    }

    /// How many are met in a step that ends at this time.
    fn met(&self, here: u32, there: u32, time: u32) -> u32 {
        let moving = self.visits(there, time).count();
        // The visit after that of a robot that stands there now is its next step.
        let opposed = |&visit: &u32| {
            self.ways.cells.get(visit as usize + 1) == Some(&here)
                && self.visits(here, time).any(|next| next == visit + 1)
        };
        let opposed = self.visits(there, time - 1).filter(opposed).count();
        (moving + opposed) as u32 + u32::from(self.rests[there as usize] <= time)
    }

    /// The visits to a cell at a time. Visits of one hash that are to one cell are at one time.
    fn visits(&self, cell: u32, time: u32) -> impl Iterator<Item = u32> + '_ {
        let some = |visit: u32| (visit != NONE).then_some(visit);
        let all = std::iter::successors(some(self.heads[self.hash(cell, time)]), move |&visit| {
            some(self.nexts[visit as usize])
        });
        all.filter(move |&visit| self.ways.cells[visit as usize] == cell)
    }

    /// A cell at different times has different hashes: there are more of them than times.
    const fn hash(&self, cell: u32, time: u32) -> usize {
        let mixed = cell.wrapping_mul(0x9e37_79b9) ^ cell >> 7;
        (mixed.wrapping_add(time) as usize) & (self.heads.len() - 1)
    }

    fn enter(&mut self, robot: usize, end: u32) {
        let last = self.nodes[end as usize].time;
        let mut at = end;
        while let Some(&Node { cell, time, before, .. }) = self.nodes.get(at as usize) {
            let visit = self.ways.first[robot] + time;
            let hash = self.hash(cell, time);
            self.ways.cells[visit as usize] = cell;
            self.nexts[visit as usize] = std::mem::replace(&mut self.heads[hash], visit);
            at = before;
        }
        self.ways.counts[robot] = last + 1;
        self.rests[self.problem.goals[robot].target as usize] = last;
    }

    fn withdraw(&mut self, robot: usize) {
        for time in 0..self.ways.counts[robot] {
            let visit = self.ways.first[robot] + time;
            let hash = self.hash(self.ways.cells[visit as usize], time);
            let next = self.nexts[visit as usize];
            let mut at = self.heads[hash];
            if at == visit {
                self.heads[hash] = next;
                continue;
            }
            while self.nexts[at as usize] != visit {
                at = self.nexts[at as usize];
            }
            self.nexts[at as usize] = next;
        }
        self.ways.counts[robot] = 0;
        self.rests[self.problem.goals[robot].target as usize] = NONE;
    }
}
