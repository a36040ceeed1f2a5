//! The search that makes arbitration complete, and its plans better with time.
//!
//! A node is a configuration: the cells of all robots. From the newest node arbitration makes the next; where it turns
//! in circles, robots are told where to go, first one, then two, in every way there is, so that at last every step
//! is tried. Who comes to a known configuration on a cheaper way makes the ways over it cheaper. When nothing is
//! left to try, there is no plan, or no better one.
//!
//! Sources: K. Okumura, *`LaCAM`: Search-Based Algorithm for Quick Multi-Agent Pathfinding*, AAAI 2023; *Improving `LaCAM`
//! for Scalable Eventually Optimal Multi-Agent Pathfinding*, IJCAI 2023; *Engineering `LaCAM*`*, AAMAS 2024.

mod nodes;

use crate::arbitrate::Arbiter;
use crate::fields::Goal;
use crate::floor::NONE;
use crate::priorities::Priorities;
use activecell::{Cell, Plan, Rng};
use nodes::{Nodes, Reached, share};
use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

/// How often the search goes back to the start when it meets a known configuration, so that it does not stay in a corner.
const RESTARTS: f64 = 0.001;

/// How many nodes the search may add before it starts over, beside those that the longest way asks for.
const PATIENCE: usize = 500;

/// After so many steps in a row that failed, the search looks at most so many steps earlier.
const REFUSALS: u32 = 30;
const EARLIER: u32 = 60;

/// What one step of the search brought.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Advance {
    /// The search goes on.
    Searching,
    /// The first plan, or a plan of less loss than before.
    Better,
    /// Everything was tried: there is no plan, or none of less loss.
    Exhausted,
}

/// A search in progress.
///
/// The loss of a plan counts the steps in which a robot does not rest at its target. It is at most the sum of
/// costs, which also counts rests at the target before a robot leaves it again.
///
/// ```
/// use activecell::{Cell, Lattice, Map};
/// use activecell_fleet::{Advance, Arbiter, Fields, Floor, Search};
/// let map = Map::parse(Lattice::Square, "...\n#.#")?;
/// let floor = Floor::new(&map);
/// let [west, east] = [0, 2].map(|x| floor.number(Cell::new(x, 0)));
/// let mut fields = Fields::new(&floor);
/// let goals = fields.goals(&floor, &[east, west], 1)?;
/// let mut search = Search::new(Arbiter::new(&floor, &fields, goals, 7), &[west, east], 7);
/// while search.advance() != Advance::Exhausted {}
/// let plan = search.plan().unwrap();
/// assert_eq!((plan.steps(), search.loss()), (4, Some(7)));
/// # Ok::<(), activecell::Error>(())
/// ```
pub struct Search<'a> {
    arbiter: Arbiter<'a>,
    nodes: Nodes,
    /// The nodes to be worked on, the last first.
    open: Vec<u32>,
    /// The node in which all robots are at their targets.
    goal: Option<u32>,
    /// Steps from the start of each robot to its target.
    distances: Vec<u32>,
    /// Robots, the one farthest from its target first.
    ranks: Vec<u32>,
    rng: Rng,
    /// The step that arbitration fills.
    next: Vec<u32>,
    priorities: Priorities,
    /// Nodes that may be added before the search, still without a plan, starts over.
    patience: usize,
    /// Nodes when the search last set out from the start.
    dive_start: usize,
    /// Steps that failed since the last that did not.
    refused: u32,
}

impl<'a> Search<'a> {
    /// A search from the cells of `starts`, which decides on the arbiter's manners itself ([`Arbiter::shy`]). The same
    /// arbiter, starts and seed give the same plans.
    ///
    /// # Panics
    /// If there are not as many starts as goals.
    pub fn new(mut arbiter: Arbiter<'a>, starts: &[u32], seed: u64) -> Self {
        assert_eq!(starts.len(), arbiter.goals().len(), "one start and one goal a robot");
        // Measured: below half of the cells it costs 2 to 10 % less, above it takes twice the time and costs more.
        arbiter.shy = 2 * starts.len() < arbiter.floor().map().free_cells();
        let distance = |(robot, (&start, goal)): (u32, (&u32, &Goal))| {
            arbiter.fields().steps(arbiter.floor_of(robot), goal.slot, start)
        };
        let distances: Vec<u32> = (0..).zip(starts.iter().zip(arbiter.goals())).map(distance).collect();
        let mut ranks: Vec<u32> = (0..starts.len() as u32).collect();
        ranks.sort_by_key(|&robot| Reverse(distances[robot as usize]));
        let root = Reached {
            hash: starts.iter().enumerate().fold(0, |hash, (robot, &cell)| hash ^ share(robot, cell)),
            time: 0,
            spent: 0,
            ahead: distances.iter().map(|&steps| u64::from(steps)).sum(),
        };
        // A plan in a crowd takes several times as many steps as its longest way.
        let longest = distances.iter().copied().max().unwrap_or(0) as usize;
        let patience = PATIENCE + 8 * longest;
        let mut nodes = Nodes::new();
        let start = nodes.add(starts, arbiter.goals(), NONE, root);
        Self {
            arbiter,
            nodes,
            open: vec![start],
            goal: None,
            distances,
            ranks,
            rng: Rng::new(!seed),
            next: vec![NONE; starts.len()],
            priorities: Priorities::default(),
            patience,
            dive_start: 0,
            refused: 0,
        }
    }

    /// The sum of the distances from the starts to the targets: no plan costs less.
    pub fn lower_bound(&self) -> u64 {
        self.nodes.get(0).ahead
    }

    /// Steps from the start of each robot to its target, if nobody were in its way.
    pub fn distances(&self) -> &[u32] {
        &self.distances
    }

    /// Where the robots want to go.
    pub fn goals(&self) -> &[Goal] {
        self.arbiter.goals()
    }

    /// How many configurations the search has met.
    pub const fn nodes(&self) -> usize {
        self.nodes.len()
    }

    /// The memory that the search takes, in bytes, without fields and floor.
    pub fn bytes(&self) -> usize {
        self.nodes.bytes() + self.open.capacity() * size_of::<u32>()
    }

    /// The loss of the best plan; `None` while there is none.
    pub fn loss(&self) -> Option<u64> {
        self.goal.map(|goal| self.nodes.get(goal).spent)
    }

    /// The best plan; `None` while there is none.
    pub fn plan(&self) -> Option<Plan> {
        let mut chain = vec![self.goal?];
        while let Some(&last) = chain.last() {
            match self.nodes.get(last).parent {
                NONE => break,
                parent => chain.push(parent),
            }
        }
        let floor = self.arbiter.floor();
        let robots = self.next.len();
        let mut cells: Vec<Cell> = Vec::with_capacity(chain.len() * robots);
        for &number in chain.iter().rev() {
            cells.extend(self.nodes.get(number).cells.iter().map(|&cell| floor.cell(cell)));
        }
        Plan::new(robots, cells).ok()
    }

    /// Makes one step of the search.
    pub fn advance(&mut self) -> Advance {
        let Some(&number) = self.open.last() else { return Advance::Exhausted };
        let node = self.nodes.get(number);
        if self.loss().is_some_and(|loss| node.spent + node.ahead >= loss) {
            self.open.pop();
            if self.nodes.len() > self.dive_start {
                self.start_over();
            }
            return Advance::Searching;
        }
        // The distances are 0 together, at the targets.
        if node.ahead == 0 && self.arbiter.may_rest(node.time) {
            self.goal = Some(number);
            return Advance::Better;
        }
        if node.tried > node.orders.len() {
            self.nodes.close(number);
            self.open.pop();
            return Advance::Searching;
        }
        let fixed = self.told(number);
        let node = self.nodes.get(number);
        self.arbiter.set_time(node.time);
        if !self.arbiter.step(&node.cells, &mut self.next, self.priorities.order(), &fixed) {
            self.go_back(number);
            return Advance::Searching;
        }
        self.refused = 0;
        self.reach(number)
    }

    /// Where cells close, robots may get caught together: after some vain tries at one time the search looks earlier. What
    /// it leaves stays open. Without closed cells a step fails only if robots are told where to go.
    fn go_back(&mut self, number: u32) {
        self.refused += 1;
        if self.refused < REFUSALS || self.arbiter.time_after(0) == 0 {
            return;
        }
        self.refused = 0;
        let (mut earlier, most) = (number, self.rng.below(EARLIER));
        for _ in 0..=most {
            earlier = match self.nodes.get(earlier).parent {
                NONE => break,
                parent => parent,
            };
        }
        self.open.push(earlier);
    }

    /// The next orders of a node; those with one robot more are noted. Fills the priorities.
    fn told(&mut self, number: u32) -> Vec<(u32, u32)> {
        let node = self.nodes.get_mut(number);
        let own = node.tried.checked_sub(1).map_or(NONE, |own| own as u32);
        node.tried += 1;
        self.priorities.fill(&node.waits, &self.ranks);
        let mut cells = Vec::new();
        let mut at = own;
        while let Some(told) = node.orders.get(at as usize) {
            cells.push(told.cell);
            at = told.before;
        }
        // The robots are told in the order of their priorities.
        cells.reverse();
        let order = self.priorities.order();
        if let Some(&robot) = order.get(cells.len()) {
            let here = node.cells[robot as usize];
            let mut choices: Vec<u32> = self.arbiter.floor_of(robot).links(here).to_vec();
            choices.push(here);
            self.rng.shuffle(&mut choices);
            self.nodes.branch(number, own, choices);
        }
        order.iter().copied().zip(cells).collect()
    }

    /// Puts a plan that was found elsewhere, a refined one say, among the search's own: what it has in common with them
    /// becomes cheaper for all. True if there is a better plan now.
    ///
    /// The plan must lead from the search's starts to its targets by the rules; [`activecell::check_plan`] tells.
    pub fn insert(&mut self, plan: &Plan) -> bool {
        let before = self.loss();
        let floor = self.arbiter.floor();
        if plan.robots() != self.next.len() {
            return false;
        }
        let mut at = 0;
        for row in plan.rows().skip(1) {
            for (next, &cell) in self.next.iter_mut().zip(row) {
                *next = floor.number(cell);
            }
            let (node, new) = self.join(at);
            if new {
                self.open.push(node);
            }
            at = node;
        }
        let last = self.nodes.get(at);
        if last.ahead == 0 && self.arbiter.may_rest(last.time) {
            self.goal = Some(at);
        }
        self.loss() != before
    }

    /// Deals with the configuration that arbitration reached from a node.
    fn reach(&mut self, from: u32) -> Advance {
        let before = self.loss();
        let (node, new) = self.join(from);
        if new {
            self.open.push(node);
            if self.goal.is_none() && self.nodes.len() - self.dive_start > self.patience {
                self.start_over();
            }
            return Advance::Searching;
        }
        let again = if self.rng.chance(RESTARTS) { 0 } else { node };
        let node = self.nodes.get(again);
        if self.loss().is_none_or(|loss| node.spent + node.ahead < loss) {
            self.open.push(again);
        }
        if self.loss() == before { Advance::Searching } else { Advance::Better }
    }

    /// The node of the configuration in `next`, which is reached from another; and whether it is new.
    fn join(&mut self, from: u32) -> (u32, bool) {
        let reached = self.weigh(from);
        let Some(known) = self.nodes.find(&self.next, &reached) else {
            let new = self.nodes.add(&self.next, self.arbiter.goals(), from, reached);
            self.nodes.link(from, new);
            return (new, true);
        };
        if self.nodes.link(from, known) {
            self.cheapen(known, from, reached.spent);
        }
        (known, false)
    }

    /// Sets out from the start again; what was met stays open. With a plan, another dive with other chances finds more than
    /// going on near the targets does. Without, in a crowd a dive may go on for ever and meet no known
    /// configuration: the next one has other manners, and more patience.
    fn start_over(&mut self) {
        if self.goal.is_none() {
            self.arbiter.shy = !self.arbiter.shy;
            self.patience += self.patience / 2;
        }
        self.dive_start = self.nodes.len();
        self.open.push(0);
    }

    /// The hash of the step that arbitration made, the loss up to it, and the distances from there.
    fn weigh(&self, from: u32) -> Reached {
        let node = self.nodes.get(from);
        let (mut hash, mut ahead, mut loss) = (self.nodes.hash(from), node.ahead, 0);
        let steps = node.cells.iter().zip(&self.next).zip(self.arbiter.goals());
        for (robot, ((&here, &there), goal)) in steps.enumerate() {
            loss += u64::from(here != goal.target || there != goal.target);
            if here != there {
                hash ^= share(robot, here) ^ share(robot, there);
                match self.arbiter.fields().field(goal.slot).compare(here, there) {
                    Ordering::Less => ahead -= 1,
                    Ordering::Equal => {}
                    Ordering::Greater => ahead += 1,
                }
            }
        }
        let time = self.arbiter.time_after(node.time);
        if time != node.time {
            hash ^= share(node.cells.len(), node.time) ^ share(node.cells.len(), time);
        }
        Reached { hash, time, spent: node.spent + loss, ahead }
    }

    /// A way of loss `spent` over `from` was found to a known node: passes the gain on to all ways over it.
    ///
    /// Source: the rewriting of `LaCAM*`, as by E. W. Dijkstra, *A Note on Two Problems in Connexion with Graphs*, 1959.
    fn cheapen(&mut self, to: u32, from: u32, spent: u64) {
        let mut queue = BinaryHeap::new();
        if self.nodes.get(to).spent > spent {
            queue.push(Reverse((spent, to, from)));
        }
        while let Some(Reverse((spent, to, from))) = queue.pop() {
            let node = self.nodes.get_mut(to);
            if node.spent <= spent {
                continue;
            }
            (node.spent, node.parent) = (spent, from);
            let node = self.nodes.get(to);
            if self.loss().is_some_and(|loss| node.spent + node.ahead < loss) {
                self.open.push(to);
            }
            for &next in &node.nexts {
                let spent = spent + self.step_loss(to, next);
                if spent < self.nodes.get(next).spent {
                    queue.push(Reverse((spent, next, to)));
                }
            }
        }
    }

    /// The robots that do not rest at their targets in the step between two nodes.
    fn step_loss(&self, from: u32, to: u32) -> u64 {
        let (from, to) = (&self.nodes.get(from).cells, &self.nodes.get(to).cells);
        let steps = from.iter().zip(to).zip(self.arbiter.goals());
        steps.filter(|((here, there), goal)| **here != goal.target || **there != goal.target).count() as u64
    }
}
