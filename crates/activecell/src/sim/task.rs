//! The task mode: look, learn, decide, drive a cell's length, and again.

use super::avoid::{self, Lookout};
use super::guide::Guide;
use super::runner::{Braked, Runner};
use super::trace::{Ending, Foreseen, Trace};
use super::world::World;
use crate::control::{Inputs, State};
use crate::error::Error;
use crate::lattice::{Cell, Dir, Lattice};
use crate::map::Map;
use crate::predict::Bounds;
use crate::program::{Drive, Robot};
use crate::rng::Rng;
use crate::rule::Rule;
use crate::sense::wrapped;
use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};

/// What a robot is to do with its sensors.
///
/// At each step it looks, corrects its pose, closes and opens cells of its map, asks its rule for the next cell, and
/// tells the control unit (g0 to g7) what is wanted and what is in the way; the control unit has the last word. Then
/// it turns, looks again, and drives to the next cell's centre with an eye on what is ahead.
///
/// Before it says that no way leads to the target it goes back to each obstacle that its map did not have and that
/// shuts a way, and looks for `patience_s` whether it goes away.
///
/// ```
/// use activecell::{Cell, Frame, Lattice, Map, Robot, Rng, Rule, sim::{Ending, Task, World}};
/// let cells = Frame { cell_m: 0.5, ..Frame::default() };
/// let known = Map::parse(Lattice::Square, "S...F\n.....")?.in_frame(cells)?;
/// let world = World::new(&Map::parse(Lattice::Square, "..#..\n.....")?.in_frame(cells)?);
/// let task = Task::new(&known, Cell::new(0, 0), Cell::new(4, 0));
/// let trace = task.run(&world, &Robot::default(), &mut Rng::new(1))?;
/// assert_eq!((trace.ending, trace.contacts.len()), (Ending::Arrived, 0));
/// assert_eq!(trace.found, [Cell::new(2, 0)]);
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Task<'a> {
    /// What the robot knows of the floor.
    pub map: &'a Map,
    /// Where it is put.
    pub from: Cell,
    /// Where it faces.
    pub heading: Dir,
    /// Where it is to go.
    pub to: Cell,
    /// What leads it: wave or learning.
    pub rule: Rule,
    /// How long it looks at an obstacle that shuts the last way.
    pub patience_s: f64,
    /// It gives up after so many steps of the control unit.
    pub max_ticks: usize,
    /// What objects that move may do, if the robot has a detector for them: then it plans past them, slot by slot. Else
    /// they are obstacles like others for its beams. [`Bounds::seen_within_m`] is what a position seen may be off
    /// beyond five standard deviations of the detector's noise and of what the robot knows of where it is.
    pub bounds: Option<Bounds>,
}

/// How many looks at each stop.
pub(super) const LOOKS: usize = 3;
/// How often it looks while it waits for an obstacle to go away.
const WAIT_S: f64 = 0.5;
/// So many tries at a cell, in vain, close it.
const TRIES: usize = 4;

impl<'a> Task<'a> {
    /// A task for the rule `wave`, with patience for 30 s.
    pub const fn new(map: &'a Map, from: Cell, to: Cell) -> Self {
        let (heading, rule) = (Dir(1), Rule::Wave);
        Self { map, from, heading, to, rule, patience_s: 30.0, max_ticks: 1_000_000, bounds: None }
    }

    /// Drives it.
    ///
    /// # Errors
    /// [`Error::OutsideMap`], [`Error::StartOccupied`], [`Error::TargetOccupied`]; [`Error::TooTight`] if the robot
    /// needs larger cells; [`Error::BadValue`] if its sensors see too little; [`Error::NoMemory`] for the
    /// published rule.
    pub fn run(&self, world: &World, robot: &Robot, rng: &mut Rng) -> Result<Trace, Error> {
        self.map.check_task(self.from, self.to)?;
        let room = Room::for_robot(self.map, robot)?;
        let guide = Guide::new(self.map, self.rule, self.to)?;
        let lookout = self.bounds.map(|bounds| self.lookout(robot, room, bounds)).transpose()?;
        let runner = Runner::new(self, world, robot, (guide, lookout), room, rng);
        Ok(Driver {
            task: self,
            runner,
            doubtful: BTreeSet::new(),
            confirmed: BTreeSet::new(),
            tries: (self.from, 0),
            watched: (self.from, 0),
            looked: false,
            foreseen: None,
        }
        .drive())
    }

    fn lookout(&self, robot: &Robot, room: Room, bounds: Bounds) -> Result<Lookout, Error> {
        let slots = avoid::slots(self.map, robot, room.arrival_m(self.map));
        Lookout::new(self.map, self.to, bounds, robot.sensors.noise_m, slots)
    }
}

/// What the cells leave a robot beside it, in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Room {
    /// How far aside of the line between two centres it may be.
    pub(super) aside_m: f64,
    /// How near to what is ahead it may stop.
    pub(super) ahead_m: f64,
}

impl Room {
    /// How far from a centre counts as in it.
    fn arrival_m(self, map: &Map) -> f64 {
        (map.frame().cell_m / 8.0).min(self.aside_m)
    }

    /// Checks that the cells are large enough to drive with sensors.
    fn for_robot(map: &Map, robot: &Robot) -> Result<Self, Error> {
        let cell_m = map.frame().cell_m;
        let (errors, sensors) = (&robot.errors, &robot.sensors);
        let too_low = |name, value, allowed| Err(Error::BadValue { name, value, allowed });
        if sensors.range_m < cell_m + robot.radius_m {
            let allowed = "at least a cell's size and the robot's radius, to drive by sensors";
            return too_low("sensors.range_m", sensors.range_m, allowed);
        }
        // With fewer nothing tells how far the robot is from a wall beside it.
        if sensors.beams < 4 {
            return too_low("sensors.beams", sensors.beams.into(), "at least 4, to drive by sensors");
        }
        // The passage between two cells is as wide as the side that they share.
        let half_passage = match map.lattice() {
            Lattice::Square => 0.5,
            Lattice::Hex => 0.5 / 3f64.sqrt(),
        };
        let wander_rad = match robot.drive {
            Drive::Steered => 0.0,
            Drive::Differential => errors.unevenness_m_per_sqrt_m * (2.0 * cell_m).sqrt() / robot.track_m,
        };
        // A handful of beams meet something known; what headings are off adds up over half a cell's way.
        let bent_m = errors.turn_rad.hypot(errors.start_rad).hypot(wander_rad) * cell_m / 2.0;
        let spread_m = (sensors.noise_m / 2.0).hypot(bent_m).max(errors.start_m);
        let (aside_m, needed_m) = (half_passage * cell_m - robot.radius_m, 3.0 * spread_m);
        if aside_m < needed_m {
            let least_m = (robot.radius_m + needed_m) / half_passage;
            return Err(Error::TooTight { cell_m, radius_m: robot.radius_m, least_m });
        }
        Ok(Self { aside_m, ahead_m: ((cell_m / 2.0 - robot.radius_m) / 2.0).min(0.03) })
    }
}

/// The decisions of one run.
pub(super) struct Driver<'a> {
    pub(super) task: &'a Task<'a>,
    pub(super) runner: Runner<'a>,
    /// Found obstacles that are taken as free, because else no way leads on, until they are looked at again.
    doubtful: BTreeSet<Cell>,
    /// Those that were looked at again and stood.
    confirmed: BTreeSet<Cell>,
    /// The last cell that could not be entered, and how often.
    tries: (Cell, usize),
    /// The doubtful cell that it stands beside, and for how many slots.
    pub(super) watched: (Cell, u32),
    /// Whether it looked when the last slot ended.
    pub(super) looked: bool,
    /// What was foreseen for the slot that begins.
    pub(super) foreseen: Option<Foreseen>,
}

/// What a step of the control unit is to do.
struct Plan {
    state: State,
    /// The turn before the run.
    turn_rad: f64,
    aim: Cell,
    /// The input that says that the plan's own way is shut.
    shut: bool,
}

impl Driver<'_> {
    fn drive(mut self) -> Trace {
        let ending = loop {
            if self.runner.ticks() >= self.task.max_ticks {
                break Ending::GaveUp;
            }
            if !std::mem::take(&mut self.looked) {
                self.look(LOOKS);
            }
            let own = self.own_cell();
            let avoids = self.is_avoiding();
            if own == self.task.to && self.runner.off_centre_m(own) <= self.arrival_m() {
                self.runner.tick(Inputs::GO.with(Inputs::STOP), own, own);
                break Ending::Arrived;
            }
            if own == self.task.to {
                if avoids {
                    self.avoid(own);
                } else {
                    self.go(own, own);
                }
                continue;
            }
            let Some(dir) = self.runner.guide.next(own, self.facing()) else {
                if self.doubt() {
                    continue;
                }
                self.runner.tick(Inputs::STOP, own, own);
                break Ending::Unreachable;
            };
            let next = self.task.map.lattice().neighbour(own, dir);
            if avoids {
                self.avoid(own);
            } else if self.is_doubtful(next) {
                self.look_again(own, next);
            } else if self.runner.aside_m(own, next) > self.runner.room.aside_m / 3.0 {
                // Back to the line first.
                self.go(own, own);
            } else {
                self.go(own, next);
            }
        };
        self.runner.finish(ending)
    }

    /// How near to the target's centre is near enough.
    pub(super) fn arrival_m(&self) -> f64 {
        self.runner.room.arrival_m(self.task.map)
    }

    /// Whether it is taken as free only until it is looked at again.
    pub(super) fn is_doubtful(&self, cell: Cell) -> bool {
        self.doubtful.contains(&cell) && !self.runner.belief.map().is_free(cell)
    }

    pub(super) fn look(&mut self, looks: usize) {
        for _ in 0..looks {
            let changes = self.runner.look();
            for (cell, closed) in changes {
                if !closed {
                    self.doubtful.remove(&cell);
                    self.confirmed.remove(&cell);
                }
            }
        }
    }

    /// The cell in which the robot believes to be; if that is an obstacle, the nearest free neighbour.
    fn own_cell(&self) -> Cell {
        let map = self.runner.belief.map();
        let cell = map.cell_at_m(self.runner.estimate.pose().at_m);
        if map.is_free(cell) {
            return cell;
        }
        let lattice = map.lattice();
        let free = lattice.dirs().map(|dir| lattice.neighbour(cell, dir)).filter(|&near| map.is_free(near));
        let nearest =
            free.min_by(|&a, &b| self.runner.off_centre_m(a).total_cmp(&self.runner.off_centre_m(b)));
        nearest.unwrap_or(cell)
    }

    /// The lattice's direction nearest to the heading.
    pub(super) fn facing(&self) -> Dir {
        let bearing_rad = self.runner.estimate.pose().bearing_rad;
        let map = self.task.map;
        let off = |dir: Dir| wrapped(map.bearing_rad(dir) - bearing_rad).abs();
        map.lattice().dirs().min_by(|&a, &b| off(a).total_cmp(&off(b))).unwrap_or(Dir(0))
    }

    /// Takes found obstacles that were not looked at again as free; says whether there are any.
    fn doubt(&mut self) -> bool {
        let confirmed = &self.confirmed;
        let guide = &self.runner.guide;
        let found = self.runner.belief.found();
        let new: Vec<Cell> =
            found.filter(|cell| !confirmed.contains(cell) && !guide.map().is_free(*cell)).collect();
        self.runner.lead(&new.iter().map(|&cell| (cell, false)).collect::<Vec<_>>());
        self.doubtful.extend(&new);
        !new.is_empty()
    }

    /// Waits beside a doubtful cell whether it opens, or something that moves comes near.
    fn look_again(&mut self, own: Cell, next: Cell) {
        let until_s = self.runner.time_s + self.task.patience_s;
        while self.runner.time_s < until_s && !self.runner.belief.map().is_free(next) {
            if self.is_avoiding() {
                return;
            }
            self.runner.tick(Inputs::default(), own, next);
            self.runner.wait(WAIT_S);
            self.look(1);
        }
        if !self.runner.belief.map().is_free(next) {
            self.confirm(next);
        }
    }

    /// Takes a doubtful cell for an obstacle.
    pub(super) fn confirm(&mut self, cell: Cell) {
        self.doubtful.remove(&cell);
        self.confirmed.insert(cell);
        self.runner.lead(&[(cell, true)]);
    }

    /// One step of the control unit towards the centre of a cell, and the drive that it allows.
    pub(super) fn go(&mut self, own: Cell, aim: Cell) {
        let plan = self.plan(own, aim);
        let inputs = self.inputs(own, &plan);
        // Nothing is wanted where the way is shut: the robot rests, and looks.
        let inputs = if plan.shut { Inputs(inputs.0 & !(Inputs::GO.0 | Inputs::REVERSE.0)) } else { inputs };
        let foreseen = self.foreseen.take();
        let state = self.runner.tick_by(inputs, own, aim, foreseen);
        let moved = state == plan.state && {
            let back = state == State::Reverse;
            match self.runner.drive(plan.turn_rad, back, own, aim) {
                Ok(()) => true,
                Err(Braked { driven_m }) => {
                    self.runner.tick(Inputs::GO.with(Inputs::STOP), own, aim);
                    driven_m > 0.05 * self.task.map.frame().cell_m
                }
            }
        };
        self.tries = match self.tries {
            _ if moved => (own, 0),
            (cell, tries) if cell == aim => (aim, tries + 1),
            _ => (aim, 1),
        };
        if self.tries.1 >= TRIES && aim != own {
            self.runner.close(aim);
            self.tries = (own, 0);
        }
    }

    /// Turns on the spot.
    pub(super) fn face(&mut self, own: Cell, dir: Dir) {
        let aim = self.task.map.lattice().neighbour(own, dir);
        // Within its own cell nothing is in its way.
        let plan = Plan { aim: own, shut: false, ..self.plan(own, aim) };
        let inputs = if matches!(plan.state, State::Left | State::Right) {
            self.inputs(own, &plan)
        } else {
            Inputs::default()
        };
        let foreseen = self.foreseen.take();
        if self.runner.tick_by(inputs, own, own, foreseen) == plan.state {
            self.runner.turn(plan.turn_rad, false, aim);
        }
    }

    fn plan(&self, own: Cell, aim: Cell) -> Plan {
        let angle_rad = self.runner.angle_to(aim);
        let half_step = PI / f64::from(self.task.map.lattice().degree());
        let (state, turn_rad) = if angle_rad.abs() <= half_step {
            (State::Forward, angle_rad)
        } else if angle_rad.abs() >= PI - half_step && self.runner.robot.sees_behind() {
            (State::Reverse, wrapped(angle_rad - PI))
        } else if angle_rad > 0.0 {
            (State::Left, angle_rad)
        } else {
            (State::Right, angle_rad)
        };
        let shut = aim != own && self.runner.is_blocked(aim);
        Plan { state, turn_rad, aim, shut }
    }

    /// What the control unit is told: what is wanted, and on which sides the sensors call the next cell blocked. On
    /// the side to which it is to turn that is the cell aimed at.
    fn inputs(&self, own: Cell, plan: &Plan) -> Inputs {
        let wanted = match plan.state {
            State::Left => Inputs::GO.with(Inputs::FRONT).with(Inputs::SIDE_LEFT),
            State::Right => Inputs::GO.with(Inputs::FRONT),
            State::Reverse => Inputs::REVERSE,
            _ => Inputs::GO,
        };
        if plan.aim == own {
            // Inside its own cell, which is free, it may go anywhere.
            return wanted;
        }
        let map = self.task.map;
        let lattice = map.lattice();
        let (bearing_rad, half_step) =
            (self.runner.estimate.pose().bearing_rad, TAU / 2.0 / f64::from(lattice.degree()));
        let mut inputs = wanted;
        for dir in lattice.dirs() {
            let near = lattice.neighbour(own, dir);
            let angle_rad = wrapped(map.bearing_rad(dir) - bearing_rad);
            let side = if near == plan.aim {
                plan.state.drives_towards()
            } else if angle_rad.abs() < half_step {
                Some(Inputs::FRONT)
            } else if angle_rad.abs() > PI - half_step {
                Some(Inputs::BEHIND)
            } else {
                let side = if angle_rad > 0.0 { Inputs::LEFT } else { Inputs::RIGHT };
                (plan.state.drives_towards() != Some(side)).then_some(side)
            };
            let foreseen = || self.runner.lookout.as_ref().is_some_and(|lookout| lookout.closes(own, dir));
            if let Some(side) = side
                && (self.runner.is_blocked(near) || foreseen())
            {
                inputs = inputs.with(side);
            }
        }
        inputs
    }
}
