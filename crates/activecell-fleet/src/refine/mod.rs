//! Better plans from a plan: some robots give up their paths and are planned again among the others.
//!
//! A neighbourhood is a small set of robots that get in each other's way. Their paths are taken out of the plan and looked
//! for again, one after the other in a random order, each by the [wave through time](crate::Passage). If the new paths
//! cost no more, they take the place of the old ones. Equal ones are welcome too: they lead to plans from
//! which there is a way on. Kinds and sizes of neighbourhoods are drawn by what they have brought so far.
//!
//! Neighbourhoods are worked off in batches, each from the same plan, by as many threads as there are. What was found is
//! put in afterwards in a fixed order, where it still fits: the plan does not depend on the number of threads.
//!
//! Sources: J. Li, Z. Chen, D. Harabor, P. J. Stuckey, S. Koenig, *Anytime Multi-Agent Path Finding via Large Neighborhood
//! Search*, IJCAI 2021; the same, *MAPF-LNS2: Fast Repairing for Multi-Agent Path Finding via Large Neighborhood Search*,
//! AAAI 2022; S.-H. Chan et al., *Anytime Multi-Agent Path Finding Using Operation Parallelism in Large Neighborhood
//! Search*, 2024.

mod choose;
mod ground;
mod incumbent;
mod roulette;
mod worker;

use crate::fields::{Fields, Goal};
use crate::floor::Floor;
use crate::passage::Reservations;
use activecell::{Plan, Rng, TileField};
use choose::Task;
use ground::Ground;
use incumbent::{Change, Incumbent};
use roulette::Roulette;
use std::collections::BTreeSet;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Barrier, Mutex, PoisonError, RwLock};
use worker::{Proposal, Worker};

/// Batches of a round.
const BATCHES: usize = 16;

/// More robots are left as they are: the table of who is where has two bytes an entry.
const MOST_ROBOTS: usize = u16::MAX as usize - 1;

/// The least and the most neighbourhoods of a batch.
const BATCH: [usize; 2] = [8, 128];

/// Refines a plan, round by round.
///
/// ```
/// use activecell::{Cell, Lattice, Map, Plan};
/// use activecell_fleet::{Fields, Floor, Refiner};
/// let map = Map::parse(Lattice::Square, "...")?;
/// let floor = Floor::new(&map);
/// let [west, mid, east] = [0, 1, 2].map(|x| Cell::new(x, 0));
/// let mut fields = Fields::new(&floor);
/// let goals = fields.goals(&floor, &[floor.number(east)], 1)?;
/// let slow = Plan::new(1, vec![west, west, mid, mid, east])?;
/// let mut refiner = Refiner::new(&floor, &fields, &goals, &slow, 7);
/// assert_eq!(refiner.round(2, &|| false), Some(2));
/// assert_eq!(refiner.plan(), Plan::new(1, vec![west, mid, east])?);
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug)]
pub struct Refiner<'a> {
    floor: &'a Floor,
    guides: Guides<'a>,
    ground: Ground,
    state: State,
    crew: Vec<Worker>,
}

/// What a round works on.
#[derive(Debug)]
struct State {
    plan: Incumbent,
    roulette: Roulette,
    tasks: Vec<(usize, Task)>,
    /// Changes of the last batch.
    changes: Vec<Change>,
    size: usize,
    rng: Rng,
}

/// What a neighbourhood is chosen from and planned on.
#[derive(Clone, Copy)]
struct View<'a> {
    ground: &'a Ground,
    guides: &'a Guides<'a>,
    plan: &'a Incumbent,
}

/// Where each robot wants to go, and its field.
#[derive(Debug)]
struct Guides<'a> {
    fields: &'a Fields,
    goals: Vec<Goal>,
    /// The places of the targets.
    targets: Vec<u32>,
}

impl Guides<'_> {
    #[inline]
    fn field(&self, robot: u32) -> TileField<'_> {
        self.fields.field(self.goals[robot as usize].slot)
    }

    #[inline]
    fn target(&self, robot: u32) -> u32 {
        self.targets[robot as usize]
    }
}

impl<'a> Refiner<'a> {
    /// Starts from a plan that leads each robot to its goal by the rules; [`activecell::check_plan`] tells. The same plan and
    /// seed give the same plans.
    ///
    /// # Panics
    /// If the plan has not as many robots as there are goals, or leaves the floor.
    pub fn new(floor: &'a Floor, fields: &'a Fields, goals: &[Goal], plan: &Plan, seed: u64) -> Self {
        let ends = goals.iter().zip(plan.row(0));
        let distances =
            ends.map(|(goal, &cell)| fields.steps(floor, goal.slot, floor.number(cell))).collect();
        Self::with_distances(floor, fields, goals, distances, plan, seed)
    }

    /// The same for robots that are known to have so many steps to go from their starts.
    pub(crate) fn with_distances(
        floor: &'a Floor,
        fields: &'a Fields,
        goals: &[Goal],
        least: Vec<u32>,
        plan: &Plan,
        seed: u64,
    ) -> Self {
        assert_eq!(plan.robots(), goals.len(), "a goal for each robot");
        let ground = Ground::new(floor);
        let plan = Incumbent::new(floor, &ground, least, plan);
        let targets = goals.iter().map(|goal| ground.place(goal.target)).collect();
        let guides = Guides { fields, goals: goals.to_vec(), targets };
        let mut state = State {
            plan,
            roulette: Roulette::new(),
            tasks: Vec::new(),
            changes: Vec::new(),
            size: 16,
            rng: Rng::new(seed),
        };
        state.draw();
        Self { floor, guides, ground, state, crew: Vec::new() }
    }

    /// The memory, in bytes, that refining a plan of so many robots and steps takes at most, on so many threads.
    pub fn bytes_for(floor: &Floor, robots: usize, makespan: usize, threads: usize) -> usize {
        let steps = makespan + 1;
        let layout = crate::passage::Layout::new(floor);
        let worker = Reservations::bytes(floor, makespan) + (steps + 4) * layout.words() * size_of::<u64>();
        let ground = 16 * floor.numbers() * size_of::<u32>();
        let paths = 2 * robots * steps * size_of::<u32>();
        ground + paths + Incumbent::table_bytes(floor.map().free_cells(), makespan) + threads * worker
    }

    /// The memory that it takes, in bytes.
    pub fn bytes(&self) -> usize {
        let crew: usize = self.crew.iter().map(Worker::bytes).sum();
        self.ground.bytes() + self.state.plan.bytes() + crew
    }

    /// The sum of costs of the plan.
    pub const fn sum_of_costs(&self) -> u64 {
        self.state.plan.sum
    }

    /// The plan.
    pub fn plan(&self) -> Plan {
        self.state.plan.plan(self.floor, &self.ground)
    }

    /// Goes on from another plan for the same robots.
    ///
    /// # Panics
    /// As [`Self::new`].
    pub fn replace(&mut self, plan: &Plan) {
        assert_eq!(plan.robots(), self.guides.goals.len(), "a goal for each robot");
        let least = std::mem::take(&mut self.state.plan.least);
        self.state.plan = Incumbent::new(self.floor, &self.ground, least, plan);
        self.crew.clear();
    }

    /// Plans a number of neighbourhoods again, on as many threads, fewer once `stop` says so. The new sum of costs, if it is lower. Each thread
    /// keeps reservations of its own; more than 65,534 robots are left as they are.
    pub fn round(&mut self, threads: usize, stop: &(impl Fn() -> bool + Sync)) -> Option<u64> {
        let before = self.state.plan.sum;
        if self.guides.goals.len() > MOST_ROBOTS || self.state.plan.late(0.0).is_none() {
            return None;
        }
        let threads = threads.max(1);
        while self.crew.len() < threads {
            self.crew.push(Worker::new(self.floor, &self.ground, &self.state.plan));
        }
        let (ground, guides) = (&self.ground, &self.guides);
        // Fewer threads than before: what the others keep would be out of date.
        self.crew.truncate(threads);
        let crew = &mut self.crew[..];
        match crew {
            [worker] => alone(&mut self.state, worker, ground, guides, stop),
            _ => side_by_side(&mut self.state, crew, ground, guides, stop),
        }
        (self.state.plan.sum < before).then_some(self.state.plan.sum)
    }
}

/// Works a round off with one worker.
fn alone(
    state: &mut State,
    worker: &mut Worker,
    ground: &Ground,
    guides: &Guides<'_>,
    stop: &impl Fn() -> bool,
) {
    for _ in 0..BATCHES {
        let view = View { ground, guides, plan: &state.plan };
        let tasks = state.tasks.iter().take_while(|_| !stop());
        let found = tasks.map(|(_, task)| worker.attempt(view, task)).collect();
        state.settle(found);
        worker.follow(ground, &state.plan, &state.changes);
        state.draw();
    }
}

/// Works a round off, a worker a thread.
fn side_by_side(
    state: &mut State,
    crew: &mut [Worker],
    ground: &Ground,
    guides: &Guides<'_>,
    stop: &(impl Fn() -> bool + Sync),
) {
    let barrier = Barrier::new(crew.len());
    let next = AtomicUsize::new(0);
    let found: Mutex<Vec<(usize, Proposal)>> = Mutex::new(Vec::new());
    let state = RwLock::new(state);
    let work = |worker: &mut Worker| {
        for _ in 0..BATCHES {
            {
                let state = state.read().unwrap_or_else(PoisonError::into_inner);
                let view = View { ground, guides, plan: &state.plan };
                let mut own = Vec::new();
                while !stop() {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some((_, task)) = state.tasks.get(index) else { break };
                    own.push((index, worker.attempt(view, task)));
                }
                found.lock().unwrap_or_else(PoisonError::into_inner).append(&mut own);
            }
            if barrier.wait().is_leader() {
                let mut found = std::mem::take(&mut *found.lock().unwrap_or_else(PoisonError::into_inner));
                found.sort_unstable_by_key(|&(index, _)| index);
                let mut state = state.write().unwrap_or_else(PoisonError::into_inner);
                state.settle(found.into_iter().map(|(_, proposal)| proposal).collect());
                state.draw();
                next.store(0, Ordering::Relaxed);
            }
            barrier.wait();
            let state = state.read().unwrap_or_else(PoisonError::into_inner);
            worker.follow(ground, &state.plan, &state.changes);
        }
    };
    std::thread::scope(|scope| {
        for worker in crew {
            scope.spawn(|| work(worker));
        }
    });
}

impl State {
    /// Draws the neighbourhoods of the next batch.
    fn draw(&mut self) {
        self.tasks.clear();
        for _ in 0..self.size {
            let number = self.roulette.draw(&mut self.rng);
            let arm = self.roulette.arm(number);
            self.tasks.push((number, Task { kind: arm.kind, size: arm.size, seed: self.rng.next_u64() }));
        }
    }

    /// Puts in what was found, where it still fits: first what gains, then what costs the same.
    fn settle(&mut self, found: Vec<Proposal>) {
        self.changes.clear();
        for (proposal, &(arm, _)) in found.iter().zip(&self.tasks) {
            self.roulette.learn(arm, proposal.gain, proposal.work);
        }
        let changes = found.into_iter().filter_map(|proposal| Some((proposal.gain > 0, proposal.change?)));
        let (gaining, level): (Vec<_>, Vec<_>) = changes.partition(|&(gains, _)| gains);
        let (good, mut made) = (gaining.len(), 0);
        let mut touched = BTreeSet::new();
        for (gains, mut change) in gaining.into_iter().chain(level) {
            let robots: Vec<u32> = change.paths.iter().map(|&(robot, _)| robot).collect();
            if robots.iter().any(|robot| touched.contains(robot)) || !self.plan.make(&mut change) {
                continue;
            }
            made += usize::from(gains);
            touched.extend(robots);
            self.changes.push(change);
        }
        // Where much does not fit any more, smaller batches waste less.
        if 4 * made < 3 * good {
            self.size = (self.size / 2).max(BATCH[0]);
        } else if 10 * made >= 9 * good {
            self.size = (self.size + 2).min(BATCH[1]);
        }
        self.plan.add_delays();
    }
}
