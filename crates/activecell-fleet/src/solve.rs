//! From a map and a team to a plan: the fields, a first plan, dives with guidance, refinement, limits and history.

use crate::arbitrate::Arbiter;
use crate::fields::{Fields, Goal};
use crate::floor::Floor;
use crate::guide::{Budget, Problem, dives};
use crate::refine::Refiner;
use crate::room::Room;
use crate::search::{Advance, Search};
use activecell::{Error, KeepOuts, Map, Plan, Team};
use std::time::{Duration, Instant};

/// How a plan is looked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Chance; the same seed gives the same plan, whatever the number of threads, unless time ends the search.
    pub seed: u64,
    /// Threads that may work.
    pub threads: usize,
    /// When to stop.
    pub limits: Limits,
}

/// When to stop looking for a better plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Time from the call on; with it, the plan may depend on the machine.
    pub time: Option<Duration>,
    /// Steps of the search; a dive counts as its steps if it is better than what was there, a round of refinement as
    /// 256. With this limit alone, the plan is the same everywhere.
    pub steps: Option<u64>,
    /// Memory of the search, of dives and of refinement, in bytes, each without floor and fields.
    pub bytes: usize,
    /// Whether to stop at the first plan.
    pub first: bool,
}

impl Default for Options {
    /// Seed 0, a thread, the default limits.
    fn default() -> Self {
        Self { seed: 0, threads: 1, limits: Limits::default() }
    }
}

impl Default for Limits {
    /// 10 s, 256 MiB.
    fn default() -> Self {
        Self { time: Some(Duration::from_secs(10)), steps: None, bytes: 1 << 28, first: false }
    }
}

/// What came of it.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// The best plan found.
    pub plan: Option<Plan>,
    /// Why the search ended.
    pub ending: Ending,
    /// The plans found, each of a lower sum of costs than the one before.
    pub history: Vec<Improvement>,
    /// The sum of the distances to the targets; 0 if a robot has no way to its target, or if time ended before all
    /// distances were known.
    pub lower_bound: u64,
    /// Steps of the search.
    pub steps: u64,
    /// Memory that floor, fields, search and plans took in the end, in bytes.
    pub bytes: usize,
}

impl Outcome {
    /// Whether it is certain that there is no plan.
    pub const fn is_impossible(&self) -> bool {
        self.plan.is_none() && matches!(self.ending, Ending::Exhausted)
    }
}

/// A plan that was better than those before.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Improvement {
    /// Milliseconds after the call.
    pub ms: f64,
    /// Steps of the search.
    pub step: u64,
    /// Its sum of costs.
    pub sum_of_costs: u64,
}

/// Why a search ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    /// Nothing was left to try: without a plan, there is none; with one, the search went through all that might lose
    /// less than its own, or the plan costs no more than the lower bound.
    Exhausted,
    /// The first plan was asked for, and found.
    FirstPlan,
    /// The limit of time.
    Time,
    /// The limit of steps.
    Steps,
    /// The limit of memory.
    Memory,
}

/// The share of the time that dives may take; the rest is for refinement.
const DIVES_SHARE: f64 = 0.9;
/// A round of refinement counts as so many steps.
const ROUND_STEPS: u64 = 256;
/// So few robots that the search may come to an end.
const FEW: usize = 8;
/// Rounds without a better plan after which the search goes on.
const IDLE: u32 = 20;

/// So many fields are made between two looks at the clock.
const FIELDS_AT_ONCE: usize = 256;

/// Looks for a plan that takes every robot of the team from its start to its target, and for better ones until a limit is
/// reached. `watch` is told of every better plan.
///
/// # Errors
/// As [`Team::new`], if this is not the map that the team was made for.
///
/// ```
/// use activecell::{Lattice, Map, Team, check_plan};
/// use activecell_fleet::{Options, solve};
/// let map = Map::parse(Lattice::Square, "A.B\n#.#")?;
/// let [a, b] = ['A', 'B'].map(|name| map.mark(name).unwrap());
/// let team = Team::new(&map, vec![a, b], vec![b, a])?;
/// let outcome = solve(&map, &team, &Options::default(), |_| {})?;
/// let plan = outcome.plan.expect("there is room to pass");
/// assert!(check_plan(&map, &team, &plan).is_ok());
/// assert_eq!(plan.sum_of_costs(), 7);
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn solve(
    map: &Map,
    team: &Team,
    options: &Options,
    watch: impl FnMut(&Improvement),
) -> Result<Outcome, Error> {
    solve_past(map, team, &KeepOuts::default(), options, watch)
}

/// The same past cells that are closed for a time; [`activecell::check_keep_outs`] tells whether a plan keeps out of them.
/// A plan waits or goes round, and leaves targets again while they are closed.
///
/// # Errors
/// As [`solve`].
///
/// ```
/// use activecell::{Cell, KeepOut, KeepOuts, Lattice, Map, Team, check_keep_outs, check_plan};
/// use activecell_fleet::{Options, solve_past};
/// let map = Map::parse(Lattice::Square, "A..B")?;
/// let [a, b] = ['A', 'B'].map(|name| map.mark(name).unwrap());
/// let team = Team::new(&map, vec![a], vec![b])?;
/// let keep_outs = KeepOuts::new(&map, vec![KeepOut { cell: Cell::new(2, 0), from_step: 0, to_step: 4 }])?;
/// let plan = solve_past(&map, &team, &keep_outs, &Options::default(), |_| {})?.plan.unwrap();
/// assert!(check_plan(&map, &team, &plan).is_ok() && check_keep_outs(&map, &team, &keep_outs, &plan).is_ok());
/// assert_eq!(plan.sum_of_costs(), 6);
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn solve_past(
    map: &Map,
    team: &Team,
    keep_outs: &KeepOuts,
    options: &Options,
    watch: impl FnMut(&Improvement),
) -> Result<Outcome, Error> {
    let clock = Instant::now();
    // The map may be another.
    team.check(map)?;
    if keep_outs.is_empty() && team.bodies().are_cells() {
        solve_cells(map, team, options, clock, watch)
    } else {
        solve_in_room(map, team, keep_outs, options, clock, watch)
    }
}

/// Looks for plans of robots of one cell, nothing of which is closed.
fn solve_cells(
    map: &Map,
    team: &Team,
    options: &Options,
    clock: Instant,
    watch: impl FnMut(&Improvement),
) -> Result<Outcome, Error> {
    let floor = Floor::new(map);
    let (starts, targets) = (floor.numbers_of(team.starts()), floor.numbers_of(team.targets()));
    if starts.iter().zip(&targets).any(|(&start, &target)| !floor.connected(start, target)) {
        return Ok(nothing(Ending::Exhausted, floor.bytes()));
    }
    let mut fields = Fields::new(&floor);
    let Some(goals) = goals_in_time(&mut fields, &floor, &targets, options, clock)? else {
        return Ok(nothing(Ending::Time, floor.bytes() + fields.bytes()));
    };
    let problem = Problem { floor: &floor, fields: &fields, goals: &goals, starts: &starts };
    let arbiter = Arbiter::new(&floor, &fields, goals.clone(), options.seed);
    let search = Search::new(arbiter, &starts, options.seed);
    let mut outcome = Run::new(Some(problem), options, search, clock, watch).until_stopped();
    outcome.bytes += floor.bytes() + fields.bytes();
    Ok(outcome)
}

/// Looks for plans of bodies, or among closed cells. They are not refined: refinement knows robots of one cell only.
fn solve_in_room(
    map: &Map,
    team: &Team,
    keep_outs: &KeepOuts,
    options: &Options,
    clock: Instant,
    watch: impl FnMut(&Improvement),
) -> Result<Outcome, Error> {
    let (floor, room) = (Floor::new(map), Room::new(map, team, keep_outs));
    let (starts, targets) = (floor.numbers_of(team.starts()), floor.numbers_of(team.targets()));
    let connected =
        |(robot, (&start, &target)): (u32, (&u32, &u32))| room.floor(robot).connected(start, target);
    if room.is_lost() || !(0..).zip(starts.iter().zip(&targets)).all(connected) {
        return Ok(nothing(Ending::Exhausted, floor.bytes() + room.bytes()));
    }
    let mut fields = Fields::new(&floor);
    let mut goals = vec![Goal { target: 0, slot: 0 }; targets.len()];
    for (size, own_floor) in room.floors().iter().enumerate() {
        // No two robots share a target, so that the fields of all sizes fit into one collection.
        let robots: Vec<usize> =
            (0..targets.len()).filter(|&robot| room.size(robot as u32) == size).collect();
        let own: Vec<u32> = robots.iter().map(|&robot| targets[robot]).collect();
        let Some(own) = goals_in_time(&mut fields, own_floor, &own, options, clock)? else {
            return Ok(nothing(Ending::Time, floor.bytes() + room.bytes() + fields.bytes()));
        };
        for (robot, goal) in robots.into_iter().zip(own) {
            goals[robot] = goal;
        }
    }
    let arbiter = Arbiter::new(&floor, &fields, goals, options.seed).in_room(&room);
    let search = Search::new(arbiter, &starts, options.seed);
    let mut outcome = Run::new(None, options, search, clock, watch).until_stopped();
    outcome.bytes += floor.bytes() + room.bytes() + fields.bytes();
    Ok(outcome)
}

/// The targets as goals, with their fields; none if time ends.
fn goals_in_time(
    fields: &mut Fields,
    floor: &Floor,
    targets: &[u32],
    options: &Options,
    clock: Instant,
) -> Result<Option<Vec<Goal>>, Error> {
    let mut goals = Vec::with_capacity(targets.len());
    for part in targets.chunks(FIELDS_AT_ONCE) {
        goals.extend(fields.goals(floor, part, options.threads)?);
        if options.limits.time.is_some_and(|time| clock.elapsed() >= time) {
            return Ok(None);
        }
    }
    Ok(Some(goals))
}

/// What comes of it if the search does not even begin.
const fn nothing(ending: Ending, bytes: usize) -> Outcome {
    Outcome { plan: None, ending, history: Vec::new(), lower_bound: 0, steps: 0, bytes }
}

/// Planning in progress.
struct Run<'a, W> {
    /// What dives and refinement work on; none for bodies and among closed cells, which they do not know.
    problem: Option<Problem<'a>>,
    options: &'a Options,
    search: Search<'a>,
    clock: Instant,
    /// The sum of costs, and the plan.
    best: Option<(u64, Plan)>,
    history: Vec<Improvement>,
    steps: u64,
    /// The most memory that refinement took.
    bytes: usize,
    watch: W,
}

impl<'a, W: FnMut(&Improvement)> Run<'a, W> {
    fn new(
        problem: Option<Problem<'a>>,
        options: &'a Options,
        search: Search<'a>,
        clock: Instant,
        watch: W,
    ) -> Self {
        Self { problem, options, search, clock, best: None, history: Vec::new(), steps: 0, bytes: 0, watch }
    }

    /// What comes of it, without the memory of floor and fields.
    fn until_stopped(mut self) -> Outcome {
        let ending = self.stages();
        let plans = self.best.as_ref().map_or(0, |(_, plan)| plan.bytes());
        Outcome {
            ending,
            lower_bound: self.search.lower_bound(),
            steps: self.steps,
            bytes: self.bytes.max(self.search.bytes()) + plans,
            history: self.history,
            plan: self.best.map(|(_, plan)| plan),
        }
    }

    /// The stages: a first plan, dives with guidance, refinement.
    fn stages(&mut self) -> Ending {
        while self.best.is_none() {
            if let Some(ending) = self.search_on() {
                return ending;
            }
        }
        if self.options.limits.first {
            return Ending::FirstPlan;
        }
        if let Some(problem) = self.problem {
            self.dives(problem);
            if let Some(threads) = self.threads_to_refine(problem) {
                return self.refine(problem, threads);
            }
        }
        loop {
            if let Some(ending) = self.search_on() {
                return ending;
            }
        }
    }

    /// The threads whose refinement fits into the memory; what comes of it does not depend on them.
    fn threads_to_refine(&self, problem: Problem<'a>) -> Option<usize> {
        let Problem { floor, starts, .. } = problem;
        let (_, plan) = self.best.as_ref()?;
        let Options { threads, limits, .. } = self.options;
        let bytes = |threads| Refiner::bytes_for(floor, starts.len(), plan.steps(), threads);
        (1..=(*threads).max(1)).rev().find(|&threads| bytes(threads) <= limits.bytes)
    }

    /// One step of the search, and why it ends with it.
    fn search_on(&mut self) -> Option<Ending> {
        if let Some(reached) = self.limit() {
            return Some(reached);
        }
        if self.search.bytes() > self.options.limits.bytes {
            return Some(Ending::Memory);
        }
        self.steps += 1;
        match self.search.advance() {
            Advance::Searching => None,
            Advance::Better => {
                self.look();
                None
            }
            Advance::Exhausted => Some(Ending::Exhausted),
        }
    }

    /// The first limit of steps and time that is reached.
    fn limit(&self) -> Option<Ending> {
        let Limits { time, steps, .. } = self.options.limits;
        if steps.is_some_and(|steps| self.steps >= steps) {
            return Some(Ending::Steps);
        }
        time.is_some_and(|time| self.clock.elapsed() >= time).then_some(Ending::Time)
    }

    /// Looks whether the search's plan is better than the best. It has less loss than those before, but may cost more.
    fn look(&mut self) {
        let Some(plan) = self.search.plan() else { return };
        let sum_of_costs = plan.sum_of_costs();
        match &mut self.best {
            // Of plans that cost the same, the one of less loss.
            Some((best, kept)) if *best == sum_of_costs => *kept = plan,
            _ => self.take(sum_of_costs, || plan),
        }
    }

    /// Takes a plan if it is better than the best.
    fn take(&mut self, sum_of_costs: u64, plan: impl FnOnce() -> Plan) {
        if self.best.as_ref().is_none_or(|&(best, _)| sum_of_costs < best) {
            self.note(sum_of_costs);
            self.best = Some((sum_of_costs, plan()));
        }
    }

    fn note(&mut self, sum_of_costs: u64) {
        let ms = self.clock.elapsed().as_secs_f64() * 1e3;
        let improvement = Improvement { ms, step: self.steps, sum_of_costs };
        (self.watch)(&improvement);
        self.history.push(improvement);
    }

    /// Plans of robots that look ahead. Each that is better counts as a step.
    fn dives(&mut self, problem: Problem<'a>) {
        let Some(&(best, _)) = self.best.as_ref() else { return };
        let Limits { time, bytes, .. } = self.options.limits;
        let (seed, threads, clock) = (self.options.seed, self.options.threads, self.clock);
        let distances = self.search.distances().to_vec();
        // Refinement gets the rest of the time.
        if self.limit().is_some() {
            return;
        }
        let stop = || time.is_some_and(|time| clock.elapsed() >= time.mul_f64(DIVES_SHARE));
        dives(problem, &distances, seed, best, &Budget { threads, bytes, stop }, |dive| {
            if let Some(plan) = dive.plan(problem) {
                self.steps += plan.steps() as u64;
                self.take(dive.sum_of_costs, || plan);
            }
        });
    }

    /// Refines the best plan. The search goes on beside it where robots are few, since it may come to an end, and where
    /// refinement finds nothing more.
    fn refine(&mut self, problem: Problem<'a>, threads: usize) -> Ending {
        let Some((mut best, plan)) = self.best.take() else { return Ending::Exhausted };
        let Problem { floor, fields, goals, starts } = problem;
        let Options { seed, limits, .. } = *self.options;
        let distances = self.search.distances().to_vec();
        let mut refiner = Refiner::with_distances(floor, fields, goals, distances, &plan, seed);
        drop(plan);
        let clock = self.clock;
        let late = || limits.time.is_some_and(|time| clock.elapsed() >= time);
        // The cost of the best plan that the search knows of, and the rounds that brought nothing.
        let (mut known, mut idle) = (u64::MAX, 0);
        let ending = loop {
            if best == self.search.lower_bound() {
                break Ending::Exhausted;
            }
            if let Some(reached) = self.limit() {
                break reached;
            }
            self.steps += ROUND_STEPS;
            if refiner.round(threads, &late).is_some() {
                idle = 0;
            } else {
                idle += 1;
            }
            let full = self.search.bytes() > limits.bytes;
            if !full && (starts.len() <= FEW || idle >= IDLE) {
                if refiner.sum_of_costs() < known {
                    known = refiner.sum_of_costs();
                    self.search.insert(&refiner.plan());
                }
                let (better, exhausted) = self.search_beside();
                if let Some(plan) = better.filter(|plan| plan.sum_of_costs() < refiner.sum_of_costs()) {
                    refiner.replace(&plan);
                    idle = 0;
                }
                if exhausted {
                    best = refiner.sum_of_costs();
                    break Ending::Exhausted;
                }
            } else if full && idle >= IDLE && limits.time.is_none() && limits.steps.is_none() {
                break Ending::Memory;
            }
            if refiner.sum_of_costs() < best {
                best = refiner.sum_of_costs();
                self.note(best);
            }
        };
        self.bytes = self.search.bytes() + refiner.bytes();
        if self.history.last().is_some_and(|last| best < last.sum_of_costs) {
            self.note(best);
        }
        self.best = Some((best, refiner.plan()));
        ending
    }

    /// Some steps of the search: a plan of less loss, and whether nothing is left to try.
    fn search_beside(&mut self) -> (Option<Plan>, bool) {
        let (mut better, mut exhausted) = (false, false);
        for _ in 0..ROUND_STEPS {
            match self.search.advance() {
                Advance::Searching => {}
                Advance::Better => better = true,
                Advance::Exhausted => {
                    exhausted = true;
                    break;
                }
            }
        }
        (if better { self.search.plan() } else { None }, exhausted)
    }
}
