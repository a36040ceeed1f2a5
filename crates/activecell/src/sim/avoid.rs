//! Moving objects on a robot's way: what its detector has seen of them, and what it does about them, slot by slot.

use super::runner::LOOK_S;
use super::task::{Driver, LOOKS};
use super::trace::{Foreseen, Sighting};
use crate::control::Inputs;
use crate::error::Error;
use crate::lattice::{Cell, Dir};
use crate::map::{Map, PointM};
use crate::predict::{Avoider, Bounds, Facing, Plan, Slots, Step, Track};
use crate::program::Robot;
use crate::sense::{Change, wrapped};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;

/// A position seen is taken to be within so many standard deviations of the true one: one in 270,000 is not.
pub(super) const SURE: f64 = 5.0;
/// What may lie between where a beam ends and the object that it met, beside what the position seen may be off.
const BEAM_SLACK_M: f64 = 0.05;
/// The time between two looks of a robot that waits for the end of a slot.
const WATCH_S: f64 = 0.2;
/// So many slots are sure, and a robot that has come no nearer for so many dares more: its slots are short.
const CERTAIN: u8 = 4;
const PATIENCE: u8 = 30;
/// It guesses ahead for so many more.
const LIKELY: u8 = 8;

/// The objects that move, and the plans past them.
#[derive(Debug, Clone)]
pub(super) struct Lookout {
    avoider: Avoider,
    bounds: Bounds,
    /// What a position seen may be off beyond what the sensors tell.
    more_m: f64,
    slots: Slots,
    tracks: BTreeMap<u32, Track>,
    /// How far off the last position of each may be.
    within_m: BTreeMap<u32, f64>,
    /// What holds for this slot.
    promise: Option<Promise>,
    slot_end_s: f64,
    pub(super) tally: Tally,
}

/// The objects that cannot touch the robot until then.
#[derive(Debug, Clone)]
struct Promise {
    until_s: f64,
    objects: BTreeSet<u32>,
}

/// What moving objects cost a robot.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Tally {
    /// Slots driven, or waited, by a plan past moving objects.
    pub slots: usize,
    /// The time for which it waited for them.
    pub waited_s: f64,
    /// Slots for which there was no safe step.
    pub helpless: usize,
    /// Slots that took longer than planned.
    pub late: usize,
    /// Objects that were so near when first seen that they could have reached the robot before the slot's end.
    pub surprises: usize,
    /// Positions seen that the bounds do not allow.
    pub breaks: u32,
}

impl Lookout {
    pub(super) fn new(
        map: &Map,
        to: Cell,
        bounds: Bounds,
        noise_m: f64,
        slots: Slots,
    ) -> Result<Self, Error> {
        Ok(Self {
            avoider: Avoider::new(map, to, slots)?,
            // The filter reckons with the detector's noise; each position tells how far off it may be at the most.
            bounds: Bounds { seen_within_m: bounds.seen_within_m + SURE * noise_m, ..bounds }.checked()?,
            more_m: bounds.seen_within_m,
            slots,
            tracks: BTreeMap::new(),
            within_m: BTreeMap::new(),
            promise: None,
            slot_end_s: 0.0,
            tally: Tally::default(),
        })
    }

    /// Whether there is any object to reckon with.
    pub(super) fn is_watching(&self) -> bool {
        !self.tracks.is_empty()
    }

    /// Closes and opens cells of the map.
    pub(super) fn set(&mut self, changes: &[Change]) {
        for &(cell, closed) in changes {
            self.avoider.set(cell, closed);
        }
    }

    /// Takes in where an object was seen, `away_m` from the robot's centre.
    pub(super) fn observe(&mut self, number: u32, time_s: f64, at_m: PointM, within_m: f64, away_m: f64) {
        let within_m = self.more_m + within_m;
        let bounds = self.bounds;
        let track = match self.tracks.entry(number) {
            std::collections::btree_map::Entry::Occupied(track) => track.into_mut(),
            std::collections::btree_map::Entry::Vacant(entry) => {
                let reach_m = bounds.radius_m + bounds.max_speed_mps * self.slots.slot_s;
                self.tally.surprises += usize::from(away_m - within_m <= self.slots.robot_radius_m + reach_m);
                let Ok(track) = Track::new(bounds) else { return };
                entry.insert(track)
            }
        };
        // Two looks at once tell no more than one.
        if let Ok(keeps) = track.observe_within(time_s, at_m, within_m) {
            self.tally.breaks += u32::from(!keeps);
            self.within_m.insert(number, within_m);
        }
    }

    /// Gives up objects that were out of sight for longer than plans are sure of.
    pub(super) fn forget(&mut self, time_s: f64) {
        let memory_s = f64::from(self.slots.certain) * self.slots.slot_s;
        self.tracks.retain(|_, track| track.seen_s().is_some_and(|seen_s| time_s - seen_s <= memory_s));
    }

    /// Whether a beam that ended here met an object that was just seen.
    pub(super) fn explains(&self, time_s: f64, end_m: PointM) -> bool {
        self.tracks.iter().any(|(number, track)| {
            let fresh = track.seen_s().is_some_and(|seen_s| time_s - seen_s < 1e-6);
            let near_m = track.bounds().radius_m + self.within_m[number] + BEAM_SLACK_M;
            fresh && track.seen_m().is_some_and(|[x, y]| (x - end_m[0]).hypot(y - end_m[1]) <= near_m)
        })
    }

    /// Begins a slot: what the robot in `cell` is to do. `aside`: it stands between its cell and the neighbour there.
    fn plan(&mut self, cell: Cell, aside: Option<Dir>, facing: Facing, time_s: f64) -> (Step, Foreseen) {
        let plan = self.avoider.plan_facing(&self.tracks, cell, facing, time_s);
        let mut step = plan.as_ref().map_or(Step::NoSafeStep, Plan::step);
        // Between two cells it is safe only if the whole way between them is.
        if aside.is_some_and(|dir| self.avoider.is_closed(0, cell, Some(dir))) {
            step = Step::NoSafeStep;
        }
        let until_s = time_s + self.slots.slot_s;
        self.slot_end_s = until_s;
        let objects = self.tracks.keys().copied().collect();
        self.promise = (step != Step::NoSafeStep).then_some(Promise { until_s, objects });
        self.tally.slots += 1;
        self.tally.helpless += usize::from(step == Step::NoSafeStep);
        // With no step that is safe for certain it goes where nothing is likely to be, if it can: its beams still see
        // what is ahead.
        if step == Step::NoSafeStep
            && aside.is_none()
            && let Some([from, to]) = plan.as_ref().ok().and_then(|plan| plan.cells().first_chunk::<2>())
            && let Some(dir) = self.avoider.map().lattice().dir_between(*from, *to)
        {
            step = Step::Go(dir);
        }
        let safe_slots = plan.as_ref().map_or(0, Plan::safe_slots);
        let turn = plan.ok().and_then(|plan| plan.turn()).filter(|&dir| dir != facing.dir);
        let waits = !matches!(step, Step::Go(_)) && turn.is_none();
        self.tally.waited_s += if waits { self.slots.slot_s } else { 0.0 };
        (step, Foreseen { safe_slots, waits, turn, closed: self.closed_around(cell) })
    }

    /// The cells near the robot in which something that moves may be during the slot.
    fn closed_around(&self, cell: Cell) -> Vec<Cell> {
        let (map, reach) = (self.avoider.map(), i32::from(self.slots.certain + self.slots.likely));
        let square = (-reach..=reach).flat_map(|y| (-reach..=reach).map(move |x| (x, y)));
        let cells = square.map(|(x, y)| Cell::new(cell.x + x, cell.y + y));
        cells.filter(|&near| map.is_free(near) && self.avoider.is_closed(0, near, None)).collect()
    }

    /// Whether the way to a neighbour is closed in this slot.
    pub(super) fn closes(&self, cell: Cell, dir: Dir) -> bool {
        self.promise.is_some() && self.avoider.is_closed(0, cell, Some(dir))
    }

    /// Ends the slot, at this time.
    fn end_slot(&mut self, time_s: f64) {
        self.tally.late += usize::from(time_s > self.slot_end_s + 1e-6);
        self.promise = None;
    }

    /// Whether it was promised that this object does not touch the robot now.
    pub(super) fn promised(&self, number: usize, time_s: f64) -> bool {
        let number = u32::try_from(number).unwrap_or(u32::MAX);
        self.promise
            .as_ref()
            .is_some_and(|promise| time_s <= promise.until_s + 1e-9 && promise.objects.contains(&number))
    }

    /// The objects that were seen at this time, and where they are likely to be at the slot's end.
    pub(super) fn sightings(&self, time_s: f64) -> Vec<Sighting> {
        let seen = self.tracks.iter().filter_map(|(&number, track)| {
            let then = track.forecast(time_s + self.slots.slot_s)?;
            Some(Sighting { number, at_m: track.seen_m()?, seen_s: track.seen_s()?, then })
        });
        seen.collect()
    }
}

/// The slots of a robot. In each it turns on the spot, or drives to the next centre with a small turn before; it looks
/// after turns, and before the next plan.
pub(super) fn slots(map: &Map, robot: &Robot, margin_m: f64) -> Slots {
    let errors_s = robot.turn_s(10.0 * robot.errors.turn_rad) + LOOK_S * 2.0;
    let run_s = robot.run_s(map.frame().cell_m + margin_m);
    Slots {
        slot_s: errors_s + run_s.max(robot.turn_s(PI)) + LOOK_S * LOOKS as f64,
        robot_radius_m: robot.radius_m + margin_m,
        certain: CERTAIN,
        patience: PATIENCE,
        likely: LIKELY,
        ..Slots::default()
    }
}

impl Driver<'_> {
    /// Whether the next step is to be planned past moving objects.
    pub(super) fn is_avoiding(&mut self) -> bool {
        let time_s = self.runner.time_s;
        self.runner.lookout.as_mut().is_some_and(|lookout| {
            lookout.forget(time_s);
            lookout.is_watching()
        })
    }

    /// One slot: the robot drives to a neighbour, goes back to its cell's centre, or waits, and looks until the slot
    /// is over.
    pub(super) fn avoid(&mut self, own: Cell) {
        let aside = (self.runner.off_centre_m(own) > self.arrival_m()).then(|| self.side_of(own));
        let facing = Facing { dir: self.facing(), reverses: self.runner.robot.sees_behind() };
        let time_s = self.runner.time_s;
        let Some(lookout) = &mut self.runner.lookout else { return };
        let (step, foreseen) = lookout.plan(own, aside, facing, time_s);
        let turn = foreseen.turn;
        self.foreseen = Some(foreseen);
        match step {
            Step::Go(dir) => {
                let next = self.task.map.lattice().neighbour(own, dir);
                if self.is_doubtful(next) {
                    self.watch(own, next);
                } else if self.runner.aside_m(own, next) > self.runner.room.aside_m / 3.0 {
                    self.go(own, own);
                } else {
                    self.go(own, next);
                }
            }
            Step::Wait | Step::NoSafeStep if aside.is_some() => self.go(own, own),
            Step::Wait | Step::NoSafeStep => match turn {
                Some(dir) => self.face(own, dir),
                None => self.stand(own, own),
            },
        }
        self.finish_slot();
    }

    /// Nothing is wanted.
    fn stand(&mut self, own: Cell, aim: Cell) {
        let foreseen = self.foreseen.take();
        self.runner.tick_by(Inputs::default(), own, aim, foreseen);
    }

    /// Stands beside a doubtful cell, and takes it for an obstacle after so many slots of patience.
    fn watch(&mut self, own: Cell, next: Cell) {
        self.stand(own, next);
        let slots = if self.watched.0 == next { self.watched.1 + 1 } else { 1 };
        self.watched = (next, slots);
        let slot_s = self.runner.lookout.as_ref().map_or(1.0, |lookout| lookout.slots.slot_s);
        if f64::from(slots) * slot_s >= self.task.patience_s {
            self.confirm(next);
        }
    }

    /// Looks until the slot is over, as often as before any other step at the least.
    fn finish_slot(&mut self) {
        let end_s = self.runner.lookout.as_ref().map_or(0.0, |lookout| lookout.slot_end_s);
        let last_s = end_s - LOOK_S * LOOKS as f64;
        while self.runner.time_s < last_s - WATCH_S {
            self.runner.wait(WATCH_S - LOOK_S);
            self.look(1);
        }
        self.runner.wait((last_s - self.runner.time_s).max(0.0));
        self.look(LOOKS);
        let time_s = self.runner.time_s;
        if let Some(lookout) = &mut self.runner.lookout {
            lookout.end_slot(time_s);
        }
        self.looked = true;
    }

    /// The direction of the neighbour to which it stands nearest.
    fn side_of(&self, own: Cell) -> Dir {
        let map = self.task.map;
        let (at, centre) = (self.runner.estimate.pose().at_m, map.centre_m(own));
        let bearing_rad = (at[1] - centre[1]).atan2(at[0] - centre[0]);
        let off = |dir: Dir| wrapped(map.bearing_rad(dir) - bearing_rad).abs();
        map.lattice().dirs().min_by(|&a, &b| off(a).total_cmp(&off(b))).unwrap_or(Dir(0))
    }
}
