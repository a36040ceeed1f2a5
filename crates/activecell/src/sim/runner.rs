//! A robot under way in the task mode: its body in the world, its senses, and what it makes of them.

use super::guide::Guide;
use super::offline::Feeler;
use super::task::{Room, Task};
use super::trace::{Contact, Ending, Tick, Trace};
use super::world::World;
use crate::control::{Control, Inputs, State};
use crate::lattice::Cell;
use crate::program::{Motion, Pose, Robot};
use crate::rng::Rng;
use crate::sense::{Belief, Change, Estimate, look, wrapped};
use std::f64::consts::PI;

/// The time between two looks.
const LOOK_S: f64 = 0.05;
/// So many tries to face a cell.
const TURNS: usize = 3;
/// So many looks on the way from one cell to the next.
const PIECES: f64 = 5.0;

/// The robot stopped before the end of its run.
pub(super) struct Braked {
    /// After so much of it.
    pub(super) driven_m: f64,
}

pub(super) struct Runner<'a> {
    robot: &'a Robot,
    rng: &'a mut Rng,
    world: World,
    motion: Motion<'a>,
    pub(super) room: Room,
    pub(super) time_s: f64,
    pub(super) estimate: Estimate,
    pub(super) belief: Belief,
    pub(super) guide: Guide,
    control: Control,
    readings_m: Vec<f64>,
    /// Where the last readings ended.
    ends: Vec<Cell>,
    /// Since the last tick.
    changes: Vec<Change>,
    ticks: Vec<Tick>,
    contacts: Vec<Contact>,
    touching: (bool, Option<usize>),
    length_m: f64,
}

impl<'a> Runner<'a> {
    pub(super) fn new(
        task: &Task<'_>,
        world: &World,
        robot: &'a Robot,
        guide: Guide,
        room: Room,
        rng: &'a mut Rng,
    ) -> Self {
        let planned =
            Pose { at_m: task.map.centre_m(task.from), bearing_rad: task.map.bearing_rad(task.heading) };
        Self {
            robot,
            motion: Motion::drawn(robot, planned, rng),
            rng,
            world: world.clone(),
            room,
            time_s: 0.0,
            estimate: Estimate::new(planned, &robot.errors),
            belief: Belief::new(task.map),
            guide,
            control: Control::default(),
            readings_m: Vec::new(),
            ends: Vec::new(),
            changes: Vec::new(),
            ticks: Vec::new(),
            contacts: Vec::new(),
            touching: (false, None),
            length_m: 0.0,
        }
    }

    /// How many steps the control unit made.
    pub(super) const fn ticks(&self) -> usize {
        self.ticks.len()
    }

    /// One look while standing: corrects the pose, learns, and tells which cells closed or opened.
    pub(super) fn look(&mut self) -> Vec<Change> {
        self.wait(LOOK_S);
        self.sense()
    }

    fn sense(&mut self) -> Vec<Change> {
        let (sensors, pose, world) = (&self.robot.sensors, self.motion.pose, &self.world);
        let distance_m = |bearing_rad: f64| world.distance_m(pose.at_m, bearing_rad, sensors.range_m);
        self.readings_m = look(sensors, pose, &distance_m, self.rng);
        self.estimate.correct(self.robot, &self.belief, &self.readings_m);
        let changes = self.belief.observe(&self.estimate, sensors, &self.readings_m);
        self.guide.set(&changes);
        self.ends = self.belief.ends(&self.estimate, sensors, &self.readings_m);
        self.changes.extend(&changes);
        changes
    }

    /// Lets time pass.
    pub(super) fn wait(&mut self, seconds: f64) {
        self.time_s += seconds;
        self.world.advance(self.time_s, self.motion.pose.at_m, self.robot.radius_m);
        let mover = self.world.touched(self.motion.pose.at_m, self.robot.radius_m);
        if mover.is_some() && mover != self.touching.1 {
            self.contacts.push(Contact { time_s: self.time_s, at_m: self.motion.pose.at_m, mover });
        }
        self.touching.1 = mover;
    }

    /// Closes a cell that could not be entered, whatever the readings say.
    pub(super) fn close(&mut self, cell: Cell) {
        let change = self.belief.close(cell);
        self.guide.set(change.as_slice());
        self.changes.extend(change);
    }

    /// Whether the belief or one of the last readings speaks against entering the cell.
    pub(super) fn is_blocked(&self, cell: Cell) -> bool {
        !self.belief.map().is_free(cell) || self.ends.contains(&cell)
    }

    /// Whether it can drive backwards and one of its beams looks there.
    pub(super) fn sees_behind(&self) -> bool {
        self.robot.can_reverse && self.robot.sensors.bearings_rad(PI).any(|angle| wrapped(angle).abs() < 0.2)
    }

    /// From the believed position to a cell's centre.
    pub(super) fn off_centre_m(&self, cell: Cell) -> f64 {
        let [dx, dy] = self.to_centre(cell);
        dx.hypot(dy)
    }

    fn to_centre(&self, cell: Cell) -> [f64; 2] {
        let (at, centre) = (self.estimate.pose().at_m, self.belief.map().centre_m(cell));
        [centre[0] - at[0], centre[1] - at[1]]
    }

    /// How far the believed position is from the line through two cells' centres, or from the first's beyond it.
    pub(super) fn aside_m(&self, own: Cell, next: Cell) -> f64 {
        let map = self.belief.map();
        let (a, b) = (map.centre_m(own), map.centre_m(next));
        let [dx, dy] = self.to_centre(own);
        let size_m = map.frame().cell_m;
        let along = -(dx * (b[0] - a[0]) + dy * (b[1] - a[1])) / size_m;
        let aside = (dx * (b[1] - a[1]) - dy * (b[0] - a[0])) / size_m;
        aside.abs().max(-along - size_m / 8.0)
    }

    /// The turn that would face the cell's centre.
    pub(super) fn angle_to(&self, cell: Cell) -> f64 {
        let [dx, dy] = self.to_centre(cell);
        wrapped(dy.atan2(dx) - self.estimate.pose().bearing_rad)
    }

    /// One step of the control unit, written into the trace.
    pub(super) fn tick(&mut self, inputs: Inputs, cell: Cell, aim: Cell) -> State {
        let state = self.control.tick(inputs);
        self.ticks.push(Tick {
            time_s: self.time_s,
            truth: self.motion.pose,
            estimate: self.estimate.pose(),
            spread_m: self.estimate.spread_m(),
            readings_m: self.readings_m.clone(),
            inputs,
            state,
            cell,
            aim,
            changes: std::mem::take(&mut self.changes),
        });
        state
    }

    /// Turns, looks, and drives to the centre of `aim`, forwards or back, watching what is ahead.
    pub(super) fn drive(&mut self, turn_rad: f64, back: bool, own: Cell, aim: Cell) -> Result<(), Braked> {
        self.turn(turn_rad, back, aim);
        let sign = if back { -1.0 } else { 1.0 };
        let cell_m = self.belief.map().frame().cell_m;
        let (mut driven_m, mut braked) = (0.0, false);
        loop {
            let (left_m, aside_m) = self.ahead_of(aim, back);
            if left_m <= 0.01 * cell_m {
                break;
            }
            let piece_m = left_m.min(cell_m / PIECES);
            let strayed = driven_m > 0.0 && left_m > cell_m / 4.0 && aside_m.abs() > self.room.aside_m / 2.0;
            if strayed {
                break;
            }
            if aim != own && !self.belief.map().is_free(aim)
                || self.free_way_m(back) < piece_m + self.room.ahead_m
            {
                braked = true;
                break;
            }
            self.roll(sign * piece_m);
            driven_m += piece_m;
            self.sense();
        }
        if driven_m > 0.0 {
            self.motion.stop(self.rng);
            self.estimate.stop(self.robot);
            // What speeding up and slowing down took longer than full speed.
            self.wait(self.robot.run_s(driven_m) - driven_m / self.robot.max_speed_mps);
        }
        if braked { Err(Braked { driven_m }) } else { Ok(()) }
    }

    /// Turns, looks how far it came, and turns the rest. A turn smaller than its own error is not worth making.
    fn turn(&mut self, mut turn_rad: f64, back: bool, aim: Cell) {
        let mut least_rad = self.robot.errors.turn_rad;
        for _ in 0..TURNS {
            if turn_rad.abs() <= least_rad {
                return;
            }
            self.motion.turn(turn_rad, self.rng);
            self.estimate.turn(self.robot, turn_rad);
            self.wait(self.robot.turn_s(turn_rad));
            self.look();
            self.look();
            turn_rad = wrapped(self.angle_to(aim) + if back { PI } else { 0.0 });
            least_rad = 3.0 * self.robot.errors.turn_rad;
        }
    }

    /// How far ahead, and how far to the left, the cell's centre is believed to be.
    fn ahead_of(&self, cell: Cell, back: bool) -> (f64, f64) {
        let [dx, dy] = self.to_centre(cell);
        let turned_rad = if back { PI } else { 0.0 };
        let (sin, cos) = (self.estimate.pose().bearing_rad + turned_rad).sin_cos();
        (dx * cos + dy * sin, dy * cos - dx * sin)
    }

    /// How far the disc could go straight on before it touched what the last readings saw.
    fn free_way_m(&self, back: bool) -> f64 {
        let sensors = &self.robot.sensors;
        let ahead_rad = if back { PI } else { 0.0 };
        let seen = sensors.bearings_rad(0.0).zip(&self.readings_m).filter(|&(_, &m)| m < sensors.range_m);
        let ways = seen.filter_map(|(angle_rad, &reading_m)| {
            let (sin, cos) = (angle_rad - ahead_rad).sin_cos();
            let (ahead_m, aside_m) = (reading_m * cos, reading_m * sin);
            let inside = self.robot.radius_m.powi(2) - aside_m * aside_m;
            (ahead_m > 0.0 && inside > 0.0).then(|| ahead_m - inside.sqrt())
        });
        ways.fold(f64::INFINITY, f64::min)
    }

    fn roll(&mut self, length_m: f64) {
        let from_m = self.motion.pose.at_m;
        self.motion.roll(length_m, self.rng);
        self.estimate.roll(self.robot, length_m);
        self.length_m += length_m.abs();
        let to_m = self.motion.pose.at_m;
        let mut feeler =
            Feeler { world: &self.world, radius_m: self.robot.radius_m, touching: self.touching.0 };
        if feeler.begins_to_touch(from_m, to_m) {
            self.contacts.push(Contact { time_s: self.time_s, at_m: to_m, mover: None });
        }
        self.touching.0 = feeler.touching;
        self.wait(length_m.abs() / self.robot.max_speed_mps);
    }

    /// The trace.
    pub(super) fn finish(self, ending: Ending) -> Trace {
        Trace {
            ending,
            ticks: self.ticks,
            contacts: self.contacts,
            found: self.belief.found().collect(),
            length_m: self.length_m,
        }
    }
}
