//! Robots that get new targets for ever, in real time.
//!
//! All robots always hold paths through a window of the next steps that collide with nobody; at their end they rest for
//! ever, so that whatever happens there is a valid step. Each step the robots go one step along their paths; then each, by
//! rank, gets the best path that it can have, and whoever is in its way makes way, and whoever is in the way of that one, and
//! so on; robots that turn first try to move up in rows. Until the time is over, chains of robots are planned anew whose
//! paths cost less together.
//!
//! Sources: windows, and large-neighbourhood search in them: H. Jiang, Y. Zhang, R. Veerapaneni, J. Li, *Scaling Lifelong
//! Multi-Agent Path Finding to More Realistic Settings: Research Challenges and Opportunities*, `SoCS` 2024; chains of
//! robots that take each other's operations away, and weights for those who are near: E. Yukhnevich, A. Andreychuk,
//! *Enhancing PIBT via Multi-Action Operations*, AAAI 2026; inheritance of ranks: K. Okumura et al., *Priority
//! Inheritance with Backtracking for Iterative Multi-Agent Path Finding*, 2022. Own: paths by a wave through the window, 64
//! cells at once, which sees all paths of a robot, not some operations; and whom to push from a second wave among those
//! that must stay as they are.

mod crew;
mod desk;
mod distances;
mod ground;
mod reach;
mod tasks;
#[cfg(test)]
mod twin;
mod window;

pub use desk::Assignment;
pub use tasks::{deliveries, visits, within_reach};

use crate::floor::Floor;
use activecell::{Cell, Dir, Error, Event, Journal, Map, Moves, News, Rng, Task, Team};
use crew::{Chain, Crew, Judge, Scene, Want};
use desk::Desk;
use distances::Distances;
use ground::{Ground, Place};
use std::time::{Duration, Instant};

/// The most steps that can be planned ahead.
pub const MAX_WINDOW: usize = 30;
/// A robot may push this many others, one by the next, when its turn comes.
const ROBOTS: usize = 30;
/// Paths looked for before such a push is given up.
const PATHS: u64 = 300;
/// So many of the first robots may push more, so that a jam dissolves in the end.
const FIRST: usize = 16;
/// The robots that one of the first may push.
const URGENT_ROBOTS: usize = 200;
/// Paths looked for before such a push is given up.
const URGENT_PATHS: u64 = 2000;
/// The most robots in a chain that must pay for all together.
const ROBOTS_IN_SUM: usize = 12;
/// A robot's distance, in steps, counts less by this for each step since it got its task.
const PATIENCE: f64 = 0.5;
/// The largest weight of a robot.
const WEIGHT: f64 = 1023.0;

/// How a run is planned.
#[derive(Debug, Clone)]
pub struct LifelongOptions {
    /// How robots move.
    pub moves: Moves,
    /// The same seed gives the same run, unless `step_time` ends the planning of a step.
    pub seed: u64,
    /// Threads for the fields of new targets; the run does not depend on their number.
    pub threads: usize,
    /// The time for planning a step. It is looked at between robots, so that a step takes a little longer.
    pub step_time: Option<Duration>,
    /// The paths looked for in a step. With neither limit every robot has its turn, and that is all.
    pub step_paths: Option<u64>,
    /// Steps planned ahead, from 1 to [`MAX_WINDOW`]. Crowds go better with more, up to 20 or so; ten thousand robots need
    /// less.
    pub window: usize,
    /// Which task a robot gets.
    pub assignment: Assignment,
    /// New tasks a step; all are there from the start if not given.
    pub tasks_per_step: Option<f64>,
}

impl Default for LifelongOptions {
    fn default() -> Self {
        Self {
            moves: Moves::Omni,
            seed: 0,
            threads: 1,
            step_time: None,
            step_paths: None,
            window: 20,
            assignment: Assignment::InOrder,
            tasks_per_step: None,
        }
    }
}

/// What a step brought.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StepReport {
    /// The step, counted from 1: the start is step 0.
    pub step: usize,
    /// What happened to tasks after it.
    pub events: Vec<Event>,
    /// Tasks finished.
    pub finished: usize,
    /// The time that planning took, with the fields of new targets, in microseconds.
    pub planned_us: u64,
    /// Paths looked for.
    pub paths: u64,
}

/// A run in which targets keep coming.
///
/// ```
/// use activecell::{Lattice, Map, Moves, check_journal};
/// use activecell_fleet::{Lifelong, LifelongOptions, visits};
/// let map = Map::parse(Lattice::Hex, ".....\n.#.#.\n.....")?;
/// let cells: Vec<_> = map.free().collect();
/// let tasks = visits(&cells, 50, 1);
/// let options = LifelongOptions { moves: Moves::Turning, ..LifelongOptions::default() };
/// let mut run = Lifelong::new(&map, &cells[..6], &[], tasks.clone(), options)?;
/// let journal = run.run(100, |_| {})?;
/// assert_eq!(check_journal(&map, &tasks, &journal), Ok(()));
/// assert!(journal.finished(&tasks) > 20);
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Lifelong {
    ground: Ground,
    options: LifelongOptions,
    distances: Distances,
    desk: Desk,
    wants: Vec<Option<Want>>,
    ranks: Vec<u32>,
    weights: Vec<u32>,
    crew: Crew,
    rng: Rng,
    step: usize,
    /// What happened at the start.
    first: Vec<Event>,
}

impl Lifelong {
    /// Robots at their starts, with their first tasks. Robots that turn have these headings; without any they head east.
    ///
    /// # Errors
    /// As [`Team::new`] for the starts; [`Error::BadValue`] for headings or options outside their range;
    /// [`Error::OfTask`] with the reason for the first task that cannot be done, [`Error::Unreachable`] among them: every
    /// robot must be able to come to every cell of every task.
    pub fn new(
        map: &Map,
        starts: &[Cell],
        headings: &[Dir],
        tasks: Vec<Task>,
        options: LifelongOptions,
    ) -> Result<Self, Error> {
        Team::new(map, starts.to_vec(), starts.to_vec())?;
        let floor = Floor::new(map);
        check(&floor, starts, headings, &tasks, &options)?;
        let ground = Ground::new(map, options.moves);
        let heading = |robot: usize| match options.moves {
            Moves::Omni => 0,
            Moves::Turning => u32::from(headings.get(robot).copied().unwrap_or(Dir::E).0),
        };
        let place = |(robot, &cell): (usize, &Cell)| Place::new(ground.spot(cell), heading(robot));
        let places: Vec<Place> = starts.iter().enumerate().map(place).collect();
        let robots = starts.len();
        let mut lifelong = Self {
            crew: Crew::new(&ground, &places, options.window),
            distances: Distances::new(&ground, floor, robots, options.window),
            desk: Desk::new(tasks, robots, options.assignment, options.tasks_per_step),
            ground,
            wants: vec![None; robots],
            ranks: vec![0; robots],
            weights: vec![0; robots],
            rng: Rng::new(options.seed),
            options,
            step: 0,
            first: Vec::new(),
        };
        lifelong.first = lifelong.look()?;
        Ok(lifelong)
    }

    /// How many robots there are.
    pub fn robots(&self) -> usize {
        self.wants.len()
    }

    /// The steps so far.
    pub const fn steps(&self) -> usize {
        self.step
    }

    /// Where the robots are.
    pub fn cells(&self) -> Vec<Cell> {
        (0..self.robots()).map(|robot| self.ground.cell(self.crew.path(robot)[0].spot())).collect()
    }

    /// Where the robots head; empty for robots without headings.
    pub fn headings(&self) -> Vec<Dir> {
        match self.options.moves {
            Moves::Omni => Vec::new(),
            Moves::Turning => {
                (0..self.robots()).map(|robot| Dir(self.crew.path(robot)[0].heading() as u8)).collect()
            }
        }
    }

    /// What happened at the start: tasks given, and errands that were already done.
    pub fn first_events(&self) -> &[Event] {
        &self.first
    }

    /// Whether all tasks are done.
    pub fn is_done(&self) -> bool {
        self.desk.is_done()
    }

    /// The memory that the run takes, in bytes, without map and tasks.
    pub fn bytes(&self) -> usize {
        self.crew.bytes() + self.distances.bytes() + self.wants.capacity() * size_of::<Option<Want>>()
    }

    /// Goes `steps` steps, or until all tasks are done, and keeps a journal from here on.
    ///
    /// # Errors
    /// As [`Self::step`].
    pub fn run(&mut self, steps: usize, mut report: impl FnMut(&StepReport)) -> Result<Journal, Error> {
        let mut journal = Journal::new(self.options.moves, &self.cells(), &self.headings(), &self.first);
        for _ in 0..steps {
            if self.is_done() {
                break;
            }
            let step = self.step()?;
            journal.push(&self.cells(), &self.headings(), &step.events);
            report(&step);
        }
        Ok(journal)
    }

    /// Plans within the limits, lets all robots go a step, notes what they did and gives out new tasks.
    ///
    /// # Errors
    /// As [`Fields::request`](crate::Fields::request); not for what [`Self::new`] accepted.
    pub fn step(&mut self) -> Result<StepReport, Error> {
        let clock = Instant::now();
        self.weigh();
        let scene = Scene {
            ground: &self.ground,
            distances: &self.distances,
            wants: &self.wants,
            ranks: &self.ranks,
            weights: &self.weights,
        };
        let limits = Limits { clock, time: self.options.step_time, paths: self.options.step_paths };
        plan(&mut self.crew, scene, limits, &mut self.rng);
        let paths = self.crew.work;
        self.crew.pass();
        self.step += 1;
        let events = self.look()?;
        let is_last = |event: &&Event| {
            let errands = self.desk.tasks[event.task].errands.len();
            matches!(event.news, News::Done(errand) if errand + 1 == errands)
        };
        let finished = events.iter().filter(is_last).count();
        let planned_us = clock.elapsed().as_micros() as u64;
        Ok(StepReport { step: self.step, finished, events, planned_us, paths })
    }

    /// Notes what robots do where they stand, and where they want to go next.
    fn look(&mut self) -> Result<Vec<Event>, Error> {
        let mut events = Vec::new();
        let (ground, crew) = (&self.ground, &self.crew);
        let places = || (0..self.wants.len()).map(|robot| crew.path(robot)[0]);
        let changed = self.desk.look(ground, self.step, places().map(Place::spot), &mut events);
        let target = |robot: usize| Some(self.desk.errands(ground, robot)?.0);
        let robots = places().enumerate().map(|(robot, place)| (place, target(robot)));
        self.distances.follow(ground, robots, self.options.threads)?;
        for robot in changed {
            self.wants[robot] = self.desk.errands(ground, robot).map(|(target, after)| {
                let slot = self.distances.request(ground, robot, target);
                let after = after.filter(|_| self.distances.knows_all());
                let next = after.map(|cell| {
                    let slot = self.distances.request(ground, robot, cell);
                    (slot, u32::from(self.distances.view(ground, slot).at(ground, target, 0)))
                });
                Want { target, slot, next }
            });
        }
        Ok(events)
    }

    /// Ranks the robots: those come first that are near to their targets, or have been on the way for long. The weight falls
    /// with the square of the rank.
    fn weigh(&mut self) {
        let robots = self.robots();
        let key = |robot: usize| {
            let Some(want) = self.wants[robot] else { return i64::MAX };
            let place = self.crew.path(robot)[0];
            let view = self.distances.view(&self.ground, want.slot);
            let left = f64::from(view.at(&self.ground, place.spot(), place.heading()));
            let age = (self.step - self.desk.since(robot)) as f64;
            (16.0 * (left - PATIENCE * age).max(0.0)) as i64
        };
        let mut order: Vec<(i64, usize)> = (0..robots).map(|robot| (key(robot), robot)).collect();
        order.sort_unstable();
        for (rank, (_, robot)) in order.into_iter().enumerate() {
            let near = 1.0 - rank as f64 / robots as f64;
            self.ranks[robot] = rank as u32;
            self.weights[robot] = 1 + (WEIGHT * near * near) as u32;
        }
    }
}

/// Refuses what cannot be run.
fn check(
    floor: &Floor,
    starts: &[Cell],
    headings: &[Dir],
    tasks: &[Task],
    options: &LifelongOptions,
) -> Result<(), Error> {
    let bad = |name, value, allowed| Err(Error::BadValue { name, value, allowed });
    if !(1..=MAX_WINDOW).contains(&options.window) {
        return bad("the window in steps", options.window as f64, "from 1 to 30");
    }
    if let Some(rate) = options.tasks_per_step.filter(|rate| !(*rate > 0.0 && rate.is_finite())) {
        return bad("the number of tasks a step", rate, "above 0");
    }
    if let Assignment::Nearest { shown } = options.assignment
        && !(shown > 0.0 && shown.is_finite())
    {
        return bad("the number of tasks shown a robot", shown, "above 0");
    }
    if options.moves == Moves::Turning && !headings.is_empty() {
        if headings.len() != starts.len() {
            return bad("the number of headings", headings.len() as f64, "one a robot, or none");
        }
        let degree = floor.map().lattice().degree();
        if let Some(dir) = headings.iter().find(|dir| dir.0 >= degree) {
            return bad("a heading", f64::from(dir.0), "a direction of the lattice");
        }
    }
    let of_task = |(task, error)| Error::OfTask { task, error: Box::new(error) };
    for (task, checked) in tasks.iter().map(|task| task.check(floor.map())).enumerate() {
        checked.map_err(|error| of_task((task, error)))?;
    }
    let Some((&from, others)) = starts.split_first() else { return Ok(()) };
    let apart = |&to: &Cell| !floor.connected(floor.number(from), floor.number(to));
    if let Some(&to) = others.iter().find(|to| apart(to)) {
        return Err(Error::Unreachable { from, to });
    }
    for (task, errands) in tasks.iter().map(|task| &task.errands).enumerate() {
        if let Some(&to) = errands.iter().find(|to| apart(to)) {
            return Err(of_task((task, Error::Unreachable { from, to })));
        }
    }
    Ok(())
}

/// When planning a step ends.
#[derive(Debug, Clone, Copy)]
struct Limits {
    clock: Instant,
    time: Option<Duration>,
    paths: Option<u64>,
}

impl Limits {
    fn is_over(&self, paths: u64) -> bool {
        self.paths.is_some_and(|most| paths >= most)
            || self.time.is_some_and(|time| self.clock.elapsed() >= time)
    }
}

/// Makes the paths better: first each robot's by rank, then those of chains of robots.
fn plan(crew: &mut Crew, scene: Scene<'_>, limits: Limits, rng: &mut Rng) {
    crew.work = 0;
    crew.count(scene);
    let robots = scene.wants.len();
    let mut order: Vec<usize> = (0..robots).collect();
    order.sort_unstable_by_key(|&robot| scene.ranks[robot]);
    let by_rank = Chain { judge: Judge::Rank, robots: ROBOTS, paths: PATHS };
    let urgent = Chain { robots: URGENT_ROBOTS, paths: URGENT_PATHS, ..by_rank };
    let turning = scene.ground.headings() > 1;
    let mut turns = 0;
    for &robot in &order {
        if limits.is_over(crew.work) {
            break;
        }
        if !crew.is_best(scene, robot) {
            crew.improve(scene, robot, rng);
        }
        // In a jam of robots that turn a row that moves up is found soon, and to look for better first would use up the
        // time. Omni robots seldom jam, and come on faster without rows.
        if !(crew.is_best(scene, robot) || turning && crew.move_up(scene, robot)) {
            crew.push(scene, robot, if turns < FIRST { urgent } else { by_rank }, rng);
        }
        crew.fix(scene, robot);
        turns += 1;
    }
    for &robot in &order[..turns] {
        crew.loosen(scene, robot);
    }
    if turns < robots || limits.time.is_none() && limits.paths.is_none() {
        return;
    }
    order.retain(|&robot| scene.wants[robot].is_some());
    let by_sum = Chain { judge: Judge::Sum, robots: ROBOTS_IN_SUM, paths: PATHS };
    while !order.is_empty() && !limits.is_over(crew.work) {
        let robot = order[rng.below(order.len() as u32) as usize];
        if crew.is_best(scene, robot) {
            // Looking costs, too: a floor without conflicts must come to an end.
            crew.work += 1;
        } else {
            crew.push(scene, robot, by_sum, rng);
        }
    }
}
