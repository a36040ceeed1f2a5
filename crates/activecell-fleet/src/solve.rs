//! From a map and a team to a plan: the fields, the search, its limits and its history.

use crate::arbitrate::{Arbiter, Goal};
use crate::fields::Fields;
use crate::floor::Floor;
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
    /// Steps of the search: with this limit alone, the plan is the same everywhere.
    pub steps: Option<u64>,
    /// Memory of the search, in bytes, without floor and fields.
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
    /// Nothing was left to try: without a plan, there is none; with one, there is none of less loss.
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

/// A better plan is looked at no more often than once in so many steps: putting it together takes as long as several.
const LOOK_EVERY: u64 = 256;

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
    let clock = Instant::now();
    // The map may be another.
    team.check(map)?;
    if !team.bodies().are_cells() {
        return solve_in_room(map, team, &KeepOuts::default(), options, watch);
    }
    let floor = Floor::new(map);
    let numbers =
        |cells: &[activecell::Cell]| cells.iter().map(|&cell| floor.number(cell)).collect::<Vec<_>>();
    let (starts, targets) = (numbers(team.starts()), numbers(team.targets()));
    if starts.iter().zip(&targets).any(|(&start, &target)| !floor.connected(start, target)) {
        return Ok(nothing(Ending::Exhausted, floor.bytes()));
    }
    let mut fields = Fields::new(&floor);
    let mut slots = Vec::with_capacity(targets.len());
    for part in targets.chunks(FIELDS_AT_ONCE) {
        slots.extend(fields.request(&floor, part, options.threads)?);
        if options.limits.time.is_some_and(|time| clock.elapsed() >= time) {
            return Ok(nothing(Ending::Time, floor.bytes() + fields.bytes()));
        }
    }
    let goals = targets.into_iter().zip(slots).map(|(target, slot)| Goal { target, slot }).collect();
    let arbiter = Arbiter::new(&floor, &fields, goals, options.seed);
    let search = Search::new(arbiter, &starts, options.seed);
    let mut run = Run { search, clock, best: None, history: Vec::new(), steps: 0, watch };
    let ending = run.until_stopped(&options.limits);
    let mut outcome = run.outcome(ending);
    outcome.bytes += floor.bytes() + fields.bytes();
    Ok(outcome)
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
    if keep_outs.is_empty() {
        return solve(map, team, options, watch);
    }
    team.check(map)?;
    solve_in_room(map, team, keep_outs, options, watch)
}

/// Looks for plans of bodies, or among closed cells. They are not refined: refinement knows robots of one cell only.
fn solve_in_room(
    map: &Map,
    team: &Team,
    keep_outs: &KeepOuts,
    options: &Options,
    watch: impl FnMut(&Improvement),
) -> Result<Outcome, Error> {
    let clock = Instant::now();
    let (floor, room) = (Floor::new(map), Room::new(map, team, keep_outs));
    let numbers =
        |cells: &[activecell::Cell]| cells.iter().map(|&cell| floor.number(cell)).collect::<Vec<_>>();
    let (starts, targets) = (numbers(team.starts()), numbers(team.targets()));
    let connected =
        |(robot, (&start, &target)): (u32, (&u32, &u32))| room.floor(robot).connected(start, target);
    if room.is_lost() || !(0..).zip(starts.iter().zip(&targets)).all(connected) {
        let (bytes, ending) = (floor.bytes() + room.bytes(), Ending::Exhausted);
        return Ok(Outcome { plan: None, ending, history: Vec::new(), lower_bound: 0, steps: 0, bytes });
    }
    let mut fields = Fields::new(&floor);
    let mut goals = vec![Goal { target: 0, slot: 0 }; targets.len()];
    for (size, floor) in room.floors().iter().enumerate() {
        // No two robots share a target, so that the fields of all sizes fit into one collection.
        let robots: Vec<usize> =
            (0..targets.len()).filter(|&robot| room.size(robot as u32) == size).collect();
        let own: Vec<u32> = robots.iter().map(|&robot| targets[robot]).collect();
        for ((robot, target), slot) in
            robots.into_iter().zip(&own).zip(fields.request(floor, &own, options.threads)?)
        {
            goals[robot] = Goal { target: *target, slot };
        }
    }
    let arbiter = Arbiter::new(&floor, &fields, goals, options.seed).in_room(&room);
    let search = Search::new(arbiter, &starts, options.seed);
    let mut run = Run { search, clock, best: None, history: Vec::new(), steps: 0, watch };
    let ending = run.until_stopped(&options.limits);
    let mut outcome = run.outcome(ending);
    outcome.bytes += floor.bytes() + room.bytes() + fields.bytes();
    Ok(outcome)
}

/// What comes of it if the search does not even begin.
const fn nothing(ending: Ending, bytes: usize) -> Outcome {
    Outcome { plan: None, ending, history: Vec::new(), lower_bound: 0, steps: 0, bytes }
}

/// A search with its best plan.
struct Run<'a, W> {
    search: Search<'a>,
    clock: Instant,
    /// The sum of costs, and the plan.
    best: Option<(u64, Plan)>,
    history: Vec<Improvement>,
    steps: u64,
    watch: W,
}

impl<W: FnMut(&Improvement)> Run<'_, W> {
    fn until_stopped(&mut self, limits: &Limits) -> Ending {
        let mut unseen = false;
        let ending = loop {
            if let Some(reached) = self.limit(limits) {
                break reached;
            }
            self.steps += 1;
            match self.search.advance() {
                Advance::Searching => {}
                Advance::Better => unseen = true,
                Advance::Exhausted => break Ending::Exhausted,
            }
            if unseen && (self.best.is_none() || self.steps.is_multiple_of(LOOK_EVERY)) {
                self.look();
                unseen = false;
                if limits.first {
                    break Ending::FirstPlan;
                }
            }
        };
        if unseen {
            self.look();
        }
        ending
    }

    /// What came of it, without the memory of floor and fields.
    fn outcome(self, ending: Ending) -> Outcome {
        let plans = self.best.as_ref().map_or(0, |(_, plan)| plan.bytes());
        Outcome {
            ending,
            lower_bound: self.search.lower_bound(),
            steps: self.steps,
            bytes: self.search.bytes() + plans,
            history: self.history,
            plan: self.best.map(|(_, plan)| plan),
        }
    }

    fn limit(&self, limits: &Limits) -> Option<Ending> {
        if limits.steps.is_some_and(|steps| self.steps >= steps) {
            return Some(Ending::Steps);
        }
        if self.search.bytes() > limits.bytes {
            return Some(Ending::Memory);
        }
        limits.time.is_some_and(|time| self.clock.elapsed() >= time).then_some(Ending::Time)
    }

    /// Looks whether the search's plan is better than the best. It has less loss than those before, but may cost more.
    fn look(&mut self) {
        let Some(plan) = self.search.plan() else { return };
        let sum_of_costs = plan.sum_of_costs();
        if self.best.as_ref().is_none_or(|&(best, _)| sum_of_costs < best) {
            let ms = self.clock.elapsed().as_secs_f64() * 1e3;
            let improvement = Improvement { ms, step: self.steps, sum_of_costs };
            (self.watch)(&improvement);
            self.history.push(improvement);
            self.best = Some((sum_of_costs, plan));
        }
    }
}
