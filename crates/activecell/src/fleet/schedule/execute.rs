//! The rehearsal: a schedule run by robots that are delayed, slow, or stand still for a while.

use super::{Discs, Runner, Schedule};
use crate::error::Error;
use crate::lattice::Dir;
use crate::map::{Map, PointM};
use crate::program::Robot;
use crate::rng::Rng;
use crate::sim::trial_rng;
use std::fmt;

/// What goes wrong. Times are in steps: a step is the time for a cell at full speed.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Delays {
    /// The chance that a robot is held up, somewhere on its way, in a move.
    pub chance: f64,
    /// For how long then: from one step to so many, each equally likely.
    pub most_steps: u32,
    /// The chance that a robot is a slow one.
    pub slow_share: f64,
    /// The speed of a slow robot, as a share of full speed.
    pub slow_speed: f64,
    /// Robots that stop wherever they are.
    pub stops: Vec<Stop>,
    /// The chance, in every tick, that a robot's report does not come through; the next that does tells all.
    pub lost_reports: f64,
    /// Whether turning on the spot takes time, by the robot's turn rate and highest speed.
    pub turning: bool,
}

/// A robot stops for a while.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop {
    /// The robot.
    pub robot: usize,
    /// When it stops, in steps.
    pub from: f64,
    /// For how long, in steps.
    pub steps: f64,
}

/// What came of a rehearsal. Times are in steps.
#[derive(Debug, Clone, PartialEq)]
pub struct Executed {
    /// When each robot came to rest.
    pub arrivals: Vec<f64>,
    /// How long each robot was held up: delays, stops, turns, and what it lacks in speed.
    pub delayed: Vec<f64>,
    /// How long each robot stood or crept for want of a permit.
    pub waited: Vec<f64>,
}

impl Executed {
    /// When the last robot came to rest, in steps.
    pub fn makespan(&self) -> f64 {
        self.arrivals.iter().copied().fold(0.0, f64::max)
    }
}

/// What must never happen.
#[derive(Debug, Clone, PartialEq)]
pub enum ExecutionFault {
    /// The bodies of two robots overlap.
    Overlap {
        /// When, in steps.
        step: f64,
        /// The robots.
        robots: [usize; 2],
    },
    /// Nobody moves, nobody is held up, every report has come through, and not all have arrived.
    Deadlock {
        /// When, in steps.
        step: f64,
        /// Who has not arrived.
        robots: Vec<usize>,
    },
}

impl fmt::Display for ExecutionFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Overlap { step, robots: [a, b] } => {
                write!(f, "after {step:.2} steps: robots {a} and {b} overlap")
            }
            Self::Deadlock { step, robots } => write!(
                f,
                "after {step:.2} steps: nobody moves, and {} robots have not arrived, robot {} among them",
                robots.len(),
                robots.first().copied().unwrap_or_default()
            ),
        }
    }
}

impl std::error::Error for ExecutionFault {}

/// Ticks of a step: at full speed a robot drives so many to a cell.
const TICKS: f64 = 8.0;
/// No stop begins later or takes longer, in steps.
const MOST_STOP: f64 = 1e6;

/// A rehearsal of a schedule: in every tick each robot drives as far as its speed and its permit let it, and reports; the
/// bodies are watched by [`Discs`], which knows of no schedule.
///
/// ```
/// use activecell::schedule::{Delays, Execution};
/// use activecell::{Cell, Lattice, Map, Plan, Rng, Robot, Schedule};
/// let map = Map::parse(Lattice::Square, "...")?;
/// let [a, b, c] = [0, 1, 2].map(|x| Cell::new(x, 0));
/// let schedule = Schedule::new(&map, &Plan::new(2, vec![a, b, b, c])?)?;
/// let robot = Robot { radius_m: 0.3, ..Robot::default() };
/// let undisturbed = Execution::new(&map, &schedule, &robot, Delays::default())?;
/// assert_eq!(undisturbed.trial(&mut Rng::new(1)).unwrap().arrivals, [1.0, 1.0]);
/// let delays = Delays { chance: 1.0, most_steps: 3, ..Delays::default() };
/// let late = Execution::new(&map, &schedule, &robot, delays)?.trial(&mut Rng::new(1)).unwrap();
/// assert!(late.arrivals.iter().all(|&steps| (2.0..=7.0).contains(&steps)));
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Execution<'a> {
    map: &'a Map,
    runner: Runner<'a>,
    robot: Robot,
    delays: Delays,
    /// Ticks for a degree of turn.
    ticks_per_deg: f64,
}

impl<'a> Execution<'a> {
    /// A rehearsal with these robots and delays.
    ///
    /// # Errors
    /// As [`Runner::new`]; [`Error::BadValue`] for a chance outside 0 to 1 (of lost reports: 1 excluded), a slow speed
    /// outside 0.01 to 1 if there are slow robots, a stop of no robot or without an end.
    pub fn new(map: &'a Map, schedule: &'a Schedule, robot: &Robot, delays: Delays) -> Result<Self, Error> {
        check(&delays, schedule.robots())?;
        let runner = Runner::new(map, schedule, robot)?;
        let step_s = map.frame().cell_m / robot.max_speed_mps;
        let ticks_per_deg =
            if delays.turning { robot.turn_s(1f64.to_radians()) / step_s * TICKS } else { 0.0 };
        Ok(Self { map, runner, robot: *robot, delays, ticks_per_deg })
    }

    /// Runs it once.
    ///
    /// # Errors
    /// An [`ExecutionFault`]: proof that the schedule or its runner is wrong.
    pub fn trial(&self, rng: &mut Rng) -> Result<Executed, ExecutionFault> {
        self.watched(rng, &mut |_, _| {})
    }

    /// As [`trial`](Self::trial); `watch` is told the time in steps and where the robots are, at the start and after every
    /// tick, in the cells of [`Discs`].
    ///
    /// # Errors
    /// As [`trial`](Self::trial).
    pub fn watched(
        &self,
        rng: &mut Rng,
        watch: &mut dyn FnMut(f64, &[PointM]),
    ) -> Result<Executed, ExecutionFault> {
        let mut runner = self.runner.clone();
        let seed = rng.next_u64();
        let robots = runner.schedule().robots();
        let mut drivers: Vec<_> = (0..robots).map(|robot| Driver::new(self, robot, seed)).collect();
        let mut bodies = Discs::new(self.map, runner.spacing().radius());
        let mut points: Vec<PointM> = drivers.iter().map(|driver| driver.point(self)).collect();
        let mut silent = false;
        for tick in 0u64.. {
            let step = tick as f64 / TICKS;
            watch(step, &points);
            if let Some(robots) = bodies.overlap(&points) {
                return Err(ExecutionFault::Overlap { step, robots });
            }
            if drivers.iter().all(Driver::is_done) {
                break;
            }
            let permits: Vec<f64> = (0..robots).map(|robot| runner.permit(robot)).collect();
            let mut active = false;
            for ((driver, permit), point) in drivers.iter_mut().zip(permits).zip(&mut points) {
                if driver.tick(self, step, permit) {
                    active = true;
                    *point = driver.point(self);
                }
            }
            if !active && !silent {
                let robots = (0..robots).filter(|&robot| !drivers[robot].is_done()).collect();
                return Err(ExecutionFault::Deadlock { step, robots });
            }
            silent = false;
            for (robot, driver) in drivers.iter_mut().enumerate() {
                if driver.unsaid && !driver.rng.chance(self.delays.lost_reports) {
                    runner.report(robot, driver.revolutions);
                    driver.unsaid = false;
                }
                // Said or not: what was said now is heard in the next tick.
                silent |= driver.unsaid;
            }
        }
        Ok(Executed {
            arrivals: drivers.iter().map(|driver| driver.arrived).collect(),
            delayed: drivers.iter().map(|driver| driver.delayed / TICKS).collect(),
            waited: drivers.iter().map(|driver| driver.waited / TICKS).collect(),
        })
    }
}

/// One robot under way.
struct Driver {
    robot: usize,
    /// The last centre that it reached, and its last of all.
    visit: u32,
    last: u32,
    /// The share of the way to the next centre that is done.
    share: f64,
    revolutions: f64,
    /// Whether it has driven since its last report.
    unsaid: bool,
    facing: Option<Dir>,
    /// Share of a cell in a tick.
    speed: f64,
    /// Ticks for which it is still held up.
    hold: f64,
    /// Where on this way it will be held up, and for how many ticks.
    trouble: Option<(f64, f64)>,
    arrived: f64,
    delayed: f64,
    waited: f64,
    rng: Rng,
}

impl Driver {
    fn new(execution: &Execution<'_>, robot: usize, seed: u64) -> Self {
        let (schedule, delays) = (execution.runner.schedule(), &execution.delays);
        let mut rng = trial_rng(seed, robot as u64);
        let slow = rng.chance(delays.slow_share);
        let mut driver = Self {
            robot,
            visit: schedule.first[robot],
            last: schedule.last(robot),
            share: 0.0,
            revolutions: 0.0,
            unsaid: false,
            facing: None,
            speed: if slow { delays.slow_speed } else { 1.0 } / TICKS,
            hold: 0.0,
            trouble: None,
            arrived: 0.0,
            delayed: 0.0,
            waited: 0.0,
            rng,
        };
        driver.begin(execution);
        driver
    }

    const fn is_done(&self) -> bool {
        self.visit == self.last
    }

    fn point(&self, execution: &Execution<'_>) -> PointM {
        let schedule = execution.runner.schedule();
        let centre = |visit| Discs::centre(execution.map, schedule.cell(visit));
        let from = centre(self.visit);
        let to = if self.is_done() { from } else { centre(self.visit + 1) };
        [0, 1].map(|axis| from[axis] + self.share * (to[axis] - from[axis]))
    }

    /// At a centre: turns to the next cell, and chance decides what will happen on the way.
    fn begin(&mut self, execution: &Execution<'_>) {
        if self.is_done() {
            return;
        }
        let (schedule, delays) = (execution.runner.schedule(), &execution.delays);
        let way = schedule.way(self.visit + 1);
        let facing = self.facing.unwrap_or(way);
        let turn_deg = schedule.lattice.turn_deg(facing, way).abs();
        if turn_deg == 180 && execution.robot.can_reverse {
            self.facing = Some(facing);
        } else {
            self.facing = Some(way);
            self.hold = f64::from(turn_deg) * execution.ticks_per_deg;
        }
        self.trouble = self.rng.chance(delays.chance).then(|| {
            let steps = 1 + self.rng.below(delays.most_steps.max(1));
            (self.rng.unit(), f64::from(steps) * TICKS)
        });
    }

    /// Drives for a tick, as far as it may. Whether it moved or was held up.
    fn tick(&mut self, execution: &Execution<'_>, step: f64, permit: f64) -> bool {
        if self.is_done() {
            return false;
        }
        let stops = |stop: &Stop| stop.robot == self.robot && (0.0..stop.steps).contains(&(step - stop.from));
        if execution.delays.stops.iter().any(stops) {
            self.delayed += 1.0;
            return true;
        }
        let before = (self.visit, self.share);
        let mut held = false;
        let mut left = 1.0;
        while left > 1e-9 && !self.is_done() {
            if self.hold > 0.0 {
                let used = self.hold.min(left);
                self.hold -= used;
                self.delayed += used;
                left -= used;
                held = true;
                continue;
            }
            let [from, to] = execution.runner.way(self.visit);
            let limit = if permit >= to { 1.0 } else { (permit - from) / (to - from) };
            let goal = self.trouble.map_or(limit, |(place, _)| place.min(limit));
            if goal <= self.share && self.trouble.is_none_or(|(place, _)| place > self.share) {
                self.waited += left;
                break;
            }
            left -= self.drive(goal, left);
            if self.share >= 1.0 {
                self.visit += 1;
                self.share = 0.0;
                self.arrived = step + (1.0 - left) / TICKS;
                self.begin(execution);
            } else if let Some((_, ticks)) = self.trouble.take_if(|(place, _)| *place <= self.share) {
                self.hold = ticks;
            }
        }
        let moved = before != (self.visit, self.share);
        if moved {
            let from = execution.runner.centre(self.visit);
            let ahead = if self.is_done() { from } else { execution.runner.centre(self.visit + 1) };
            self.revolutions = from + self.share * (ahead - from);
            self.unsaid = true;
        }
        moved || held
    }

    /// Drives to a place on its way, for no longer than so many ticks; how many it took.
    fn drive(&mut self, goal: f64, ticks: f64) -> f64 {
        let used = ((goal - self.share).max(0.0) / self.speed).min(ticks);
        self.share =
            if used < ticks { self.share.max(goal) } else { (self.share + used * self.speed).min(goal) };
        self.delayed += used * (1.0 - self.speed * TICKS);
        used
    }
}

fn check(delays: &Delays, robots: usize) -> Result<(), Error> {
    let bad = |name, value, allowed| Err(Error::BadValue { name, value, allowed });
    for (name, value) in
        [("the chance of a delay", delays.chance), ("the share of slow robots", delays.slow_share)]
    {
        if !(0.0..=1.0).contains(&value) {
            return bad(name, value, "from 0 to 1");
        }
    }
    if !(0.0..1.0).contains(&delays.lost_reports) {
        return bad("the chance of a lost report", delays.lost_reports, "from 0 to below 1");
    }
    if delays.slow_share > 0.0 && !(0.01..=1.0).contains(&delays.slow_speed) {
        return bad("the speed of slow robots", delays.slow_speed, "from 0.01 to 1 of full speed");
    }
    for stop in &delays.stops {
        if stop.robot >= robots {
            return bad("the robot that stops", stop.robot as f64, "a robot of the plan, counted from 0");
        }
        if !(0.0..=MOST_STOP).contains(&stop.from) || !(0.0..=MOST_STOP).contains(&stop.steps) {
            return bad("a stop's time in steps", stop.steps, "from 0 to a million");
        }
    }
    Ok(())
}
