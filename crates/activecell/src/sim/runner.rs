//! A robot under way in the task mode: its body in the world, its senses, and what it makes of them.

use super::avoid::{Lookout, SURE, Tally};
use super::guide::Guide;
use super::offline::Feeler;
use super::task::{Room, Task};
use super::trace::{Contact, Ending, Foreseen, Tick, Trace};
use super::world::World;
use crate::control::{Control, Inputs, State};
use crate::lattice::Cell;
use crate::map::PointM;
use crate::program::{Motion, Pose, Robot};
use crate::rng::Rng;
use crate::sense::{Belief, Change, Estimate, look, wrapped};
use std::f64::consts::PI;

/// The time between two looks.
pub(super) const LOOK_S: f64 = 0.05;
/// Contacts with what moves are looked for as often.
const MOVING_S: f64 = 0.05;
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
    pub(super) robot: &'a Robot,
    rng: &'a mut Rng,
    world: World,
    motion: Motion<'a>,
    pub(super) room: Room,
    pub(super) time_s: f64,
    pub(super) estimate: Estimate,
    pub(super) belief: Belief,
    pub(super) guide: Guide,
    /// Where moving objects are reckoned with.
    pub(super) lookout: Option<Lookout>,
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
        (guide, lookout): (Guide, Option<Lookout>),
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
            lookout,
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
        self.detect();
        let readings_m = self.readings_of_cells();
        let changes = self.belief.observe(&self.estimate, sensors, &readings_m);
        self.lead(&changes);
        self.ends = self.belief.ends(&self.estimate, sensors, &readings_m);
        self.changes.extend(&changes);
        changes
    }

    /// Tells all that leads it which cells are closed and open.
    pub(super) fn lead(&mut self, changes: &[Change]) {
        self.guide.set(changes);
        if let Some(lookout) = &mut self.lookout {
            lookout.set(changes);
        }
    }

    /// What the detector sees of the objects that move: where they are from the robot, with noise along each axis, put
    /// on the map by where it believes to be.
    fn detect(&mut self) {
        let Some(lookout) = &mut self.lookout else { return };
        let (sensors, pose) = (&self.robot.sensors, self.motion.pose);
        let (sin, cos) = pose.bearing_rad.sin_cos();
        for (number, place_m) in self.world.sighted(pose.at_m, sensors.range_m) {
            let (dx, dy) = (place_m[0] - pose.at_m[0], place_m[1] - pose.at_m[1]);
            let ahead_m = dx * cos + dy * sin + sensors.noise_m * self.rng.normal();
            let left_m = dy * cos - dx * sin + sensors.noise_m * self.rng.normal();
            let away_m = ahead_m.hypot(left_m);
            let within_m = SURE * sensors.noise_m.hypot(self.estimate.aside_m(away_m));
            let at_m = self.estimate.pose().point(ahead_m, left_m);
            lookout.observe(number, self.time_s, at_m, within_m, away_m);
        }
    }

    /// The last readings as far as they are of cells: a beam that met an object that moves counts as one that ended at
    /// once, which says nothing.
    fn readings_of_cells(&self) -> Vec<f64> {
        let Some(lookout) = &self.lookout else { return self.readings_m.clone() };
        let (pose, sensors) = (self.estimate.pose(), &self.robot.sensors);
        let beams = sensors.bearings_rad(pose.bearing_rad).zip(&self.readings_m);
        let cells = beams.map(|(bearing_rad, &reading_m)| {
            let end_m = Pose { bearing_rad, ..pose }.point(reading_m, 0.0);
            if lookout.explains(self.time_s, end_m) { 0.0 } else { reading_m }
        });
        cells.collect()
    }

    /// Lets time pass.
    pub(super) fn wait(&mut self, seconds: f64) {
        self.pass(seconds, self.motion.pose.at_m, false);
    }

    /// Lets time pass while the robot comes straight from a place to where it is.
    fn pass(&mut self, seconds: f64, from_m: PointM, driving: bool) {
        let (begin_s, to_m) = (self.time_s, self.motion.pose.at_m);
        let pieces = if self.world.movers().is_empty() { 1.0 } else { (seconds / MOVING_S).ceil().max(1.0) };
        for piece in 1..=pieces as u32 {
            let share = f64::from(piece) / pieces;
            let at_m =
                if share < 1.0 { [0, 1].map(|k| from_m[k] + share * (to_m[k] - from_m[k])) } else { to_m };
            self.time_s = begin_s + share * seconds;
            self.world.advance(self.time_s, at_m, self.robot.radius_m);
            let mover = self.world.touched(at_m, self.robot.radius_m);
            if let Some(number) = mover
                && mover != self.touching.1
            {
                let promised =
                    self.lookout.as_ref().is_some_and(|lookout| lookout.promised(number, self.time_s));
                self.contacts.push(Contact { time_s: self.time_s, at_m, mover, driving, promised });
            }
            self.touching.1 = mover;
        }
    }

    /// Closes a cell that could not be entered, whatever the readings say.
    pub(super) fn close(&mut self, cell: Cell) {
        let change = self.belief.close(cell);
        self.lead(change.as_slice());
        self.changes.extend(change);
    }

    /// Whether the belief or one of the last readings speaks against entering the cell.
    pub(super) fn is_blocked(&self, cell: Cell) -> bool {
        !self.belief.map().is_free(cell) || self.ends.contains(&cell)
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
        self.tick_by(inputs, cell, aim, None)
    }

    /// One that begins a slot.
    pub(super) fn tick_by(
        &mut self,
        inputs: Inputs,
        cell: Cell,
        aim: Cell,
        foreseen: Option<Foreseen>,
    ) -> State {
        let objects = self.lookout.as_ref().map_or_else(Vec::new, |lookout| lookout.sightings(self.time_s));
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
            objects,
            foreseen,
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
    pub(super) fn turn(&mut self, mut turn_rad: f64, back: bool, aim: Cell) {
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
            let contact =
                Contact { time_s: self.time_s, at_m: to_m, mover: None, driving: true, promised: false };
            self.contacts.push(contact);
        }
        self.touching.0 = feeler.touching;
        self.pass(length_m.abs() / self.robot.max_speed_mps, from_m, true);
    }

    /// The trace.
    pub(super) fn finish(self, ending: Ending) -> Trace {
        Trace {
            ending,
            ticks: self.ticks,
            contacts: self.contacts,
            found: self.belief.found().collect(),
            length_m: self.length_m,
            tally: self.lookout.map_or_else(Tally::default, |lookout| lookout.tally),
        }
    }
}
