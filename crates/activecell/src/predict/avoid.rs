//! A robot that makes a new plan each slot.

use super::closures::Closures;
use super::plan::{Facing, Plan};
use super::slots::Slots;
use super::track::Track;
use super::window::FARTHEST;
use crate::error::Error;
use crate::lattice::{Cell, Dir};
use crate::map::Map;
use crate::wave::LiveField;
use std::collections::{BTreeMap, BTreeSet};

/// Drives a robot to its target past moving objects, with a new plan each slot.
///
/// **What is guaranteed.** As long as every object keeps to its bounds, is on the list of tracks before it comes within
/// reach, and the robot ends each step within the slot: a robot that does what [`Plan::step`] says is touched in no
/// slot for which it did not say [`NoSafeStep`](super::Step::NoSafeStep). What was once proven open stays open, so
/// that a later plan is safe at least as long as the rest of an earlier one: `NoSafeStep` never comes without
/// [`Plan::safe_slots`] having counted down to it.
///
/// **What is not.** An object that chases the robot, or fills the corridor that the robot stands in, can touch it: no
/// robot can be safe from everything everywhere. Then the plan is the one that stays safe longest.
///
/// ```
/// use activecell::predict::{Avoider, Bounds, Slots, Step, Track};
/// use activecell::{Cell, Lattice, Map};
/// let map = Map::parse(Lattice::Square, "#.###\nS...F\n#.###")?; // cells of 1 m; a corridor is crossed at x = 1
/// let mut avoider = Avoider::new(&map, map.mark('F').unwrap(), Slots::default())?;
/// let bounds = Bounds { radius_m: 0.3, max_speed_mps: 1.0, max_accel_mps2: 0.1, seen_within_m: 0.01 };
/// let mut object = Track::new(bounds)?; // crosses from the top to the bottom
/// object.observe(0.0, [1.5, 3.0])?;
/// object.observe(0.5, [1.5, 2.5])?;
/// let tracks = std::collections::BTreeMap::from([(7, object)]);
/// let plan = avoider.plan(&tracks, map.mark('S').unwrap(), 0.5)?;
/// assert_eq!(plan.step(), Step::Wait);
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Avoider {
    slots: Slots,
    /// The map's obstacles; parked objects are blocked in the field, not here.
    map: Map,
    /// The way from each cell, round the obstacles and the objects that are parked.
    field: LiveField,
    parked: BTreeSet<Cell>,
    /// The nearest to the target that it was, in steps, and for how many slots it has not come nearer.
    nearest: u32,
    stuck: u32,
    /// By object: what it closed when last looked at, and how often it had broken its bounds.
    closed: BTreeMap<u32, (u32, Closures)>,
}

impl Avoider {
    /// A robot on its way to `target`, on the map of the cells in which it fits.
    ///
    /// # Errors
    /// [`Error::BadValue`] as [`Slots::checked`]; [`Error::OutsideMap`] or [`Error::TargetOccupied`].
    pub fn new(map: &Map, target: Cell, slots: Slots) -> Result<Self, Error> {
        Ok(Self {
            slots: slots.checked()?,
            map: map.clone(),
            field: LiveField::new(map, target)?,
            parked: BTreeSet::new(),
            nearest: u32::MAX,
            stuck: 0,
            closed: BTreeMap::new(),
        })
    }

    /// Blocks or frees a cell of the map, as sensed.
    pub fn set(&mut self, cell: Cell, blocked: bool) {
        if self.map.contains(cell) {
            self.map.set_obstacle(cell, blocked);
            self.field.set(cell, blocked || self.parked.contains(&cell));
        }
    }

    /// The map without moving objects.
    pub const fn map(&self) -> &Map {
        &self.map
    }

    /// Whether the last plan's closures close a cell to stand in (no direction) or a side to cross, in a slot counted
    /// from that plan's begin.
    pub fn is_closed(&self, slot: usize, cell: Cell, way: Option<Dir>) -> bool {
        self.closed.values().any(|(_, closures)| closures.is_closed(slot, cell, way))
    }

    /// The plan for a robot in `cell` at `time_s`, when a slot begins. `tracks` holds the objects by numbers that stay
    /// theirs.
    ///
    /// # Errors
    /// [`Error::BadValue`] for a time beyond 10⁹ s; [`Error::OutsideMap`] or [`Error::StartOccupied`] for the cell.
    pub fn plan(&mut self, tracks: &BTreeMap<u32, Track>, cell: Cell, time_s: f64) -> Result<Plan, Error> {
        self.plan_as(tracks, cell, None, time_s)
    }

    /// The plan for a robot that cannot turn and drive within one slot. Its slots are shorter: in each it drives on in
    /// the direction in which it faces (or back), or turns on the spot, as [`Plan::turn`] says.
    ///
    /// # Errors
    /// As [`Avoider::plan`].
    pub fn plan_facing(
        &mut self,
        tracks: &BTreeMap<u32, Track>,
        cell: Cell,
        facing: Facing,
        time_s: f64,
    ) -> Result<Plan, Error> {
        self.plan_as(tracks, cell, Some(facing), time_s)
    }

    fn plan_as(
        &mut self,
        tracks: &BTreeMap<u32, Track>,
        cell: Cell,
        facing: Option<Facing>,
        time_s: f64,
    ) -> Result<Plan, Error> {
        self.map.check_task(cell, cell)?;
        self.go_round_parked(tracks, cell, time_s);
        let slots = self.bolder(cell);
        let open = Closures::none(&self.map, cell, slots, time_s)?;
        let mut all = open.clone();
        let mut closed = BTreeMap::new();
        for (&name, track) in tracks {
            let mut own = open.clone();
            own.close(&self.map, slots, track);
            if let Some((breaks, before)) = self.closed.get(&name)
                && *breaks == track.breaks()
            {
                own.refine(before, slots);
            }
            all.add(&own);
            closed.insert(name, (track.breaks(), own));
        }
        self.closed = closed;
        Ok(all.plan_facing(cell, facing, |cell| self.field.steps(cell)))
    }

    /// How far to look ahead after long waiting: a robot that must be safe from all that could happen in many slots never
    /// passes an object that could set out. Each step taken is safe all the same.
    fn bolder(&mut self, cell: Cell) -> Slots {
        let steps = self.field.steps(cell).unwrap_or(u32::MAX);
        let patience = u32::from(self.slots.patience.max(1));
        if self.nearest == u32::MAX {
            // The field changed: what it had gained before is not known any more.
            self.nearest = steps;
            self.stuck += 1;
        } else if steps < self.nearest {
            self.nearest = steps;
            // Boldness goes slowly, or it would turn back halfway.
            self.stuck = self.stuck.saturating_sub(2);
        } else {
            self.stuck += 1;
        }
        self.stuck = self.stuck.min(patience * u32::from(self.slots.certain));
        let less = ((self.stuck / patience) as u8).min(self.slots.certain - 1);
        let (certain, likely) = (self.slots.certain - less, self.slots.likely + less);
        Slots { certain, likely, ..self.slots }
    }

    /// Blocks the cells of objects that stand, unless that leaves no way: then waiting is the only hope.
    fn go_round_parked(&mut self, tracks: &BTreeMap<u32, Track>, cell: Cell, time_s: f64) {
        let mut parked = BTreeSet::new();
        for track in tracks.values().filter(|track| track.rests_s() >= self.slots.parked_s) {
            let Some(at) = track.forecast(time_s) else { continue };
            let near_m = track.bounds().radius_m + self.slots.robot_radius_m;
            parked.extend(self.cells_near(at.at_m, near_m));
        }
        parked.remove(&cell);
        parked.remove(&self.field.target());
        self.block(parked);
        if self.field.steps(cell).is_none() {
            self.block(BTreeSet::new());
        }
    }

    fn block(&mut self, parked: BTreeSet<Cell>) {
        let gone = self.parked.difference(&parked).map(|&cell| (cell, !self.map.is_free(cell)));
        let come = parked.difference(&self.parked).map(|&cell| (cell, true));
        let changes: Vec<(Cell, bool)> = gone.chain(come).collect();
        if !changes.is_empty() {
            self.field.set_all(&changes);
            self.nearest = u32::MAX;
        }
        self.parked = parked;
    }

    /// The free cells whose centre, or the middle of one of whose sides, is that near to a point.
    fn cells_near(&self, at_m: crate::map::PointM, near_m: f64) -> Vec<Cell> {
        let lattice = self.map.lattice();
        let reach = (near_m / self.map.frame().cell_m).ceil() as u32;
        let mut found = BTreeSet::from([self.map.cell_at_m(at_m)]);
        let mut rim: Vec<Cell> = found.iter().copied().collect();
        for _ in 0..=reach.min(u32::from(FARTHEST)) {
            let around =
                rim.iter().flat_map(|&cell| lattice.dirs().map(move |dir| lattice.neighbour(cell, dir)));
            let next: BTreeSet<Cell> = around.filter(|cell| !found.contains(cell)).collect();
            found.extend(&next);
            rim = next.into_iter().collect();
        }
        let half_m = self.map.frame().cell_m / 2.0;
        let near = |&cell: &Cell| {
            let [x, y] = self.map.centre_m(cell);
            let apart = |dx: f64, dy: f64| (at_m[0] - x - dx).hypot(at_m[1] - y - dy) <= near_m;
            apart(0.0, 0.0)
                || lattice.dirs().any(|dir| {
                    let (sin, cos) = self.map.bearing_rad(dir).sin_cos();
                    apart(half_m * cos, half_m * sin)
                })
        };
        found.into_iter().filter(|&cell| self.map.is_free(cell)).filter(near).collect()
    }
}
