//! Which cells are closed when.

use super::capsule::Capsule;
use super::slots::Slots;
use super::track::Track;
use super::window::{self, Rows, Window};
use crate::error::Error;
use crate::lattice::{Cell, Dir};
use crate::map::Map;

/// For each slot, in which cells the robot must not stand and which sides between cells it must not cross, because a
/// moving object may touch it there at some time of the slot.
///
/// Nothing is sampled: the robot's way, a straight line between centres or a point, and what the object can sweep over
/// in the slot are capsules ([`Track::reach`]), and the slot is closed if they may touch. In the first
/// [`Slots::certain`] slots all that the object can *reach* is closed, in the next [`Slots::likely`] what it is
/// *likely* to be in (and can reach). After them everything is open: there is no knowledge, but a new plan each slot.
///
/// ```
/// use activecell::predict::{Bounds, Closures, Slots, Track};
/// use activecell::{Cell, Dir, Lattice, Map};
/// let map = Map::parse(Lattice::Square, ".....\n.....\n.....")?; // cells of 1 m
/// let bounds = Bounds { radius_m: 0.2, max_speed_mps: 1.0, max_accel_mps2: 0.0, seen_within_m: 0.0 };
/// let mut object = Track::new(bounds)?; // comes down the middle column, a cell a second
/// object.observe(0.0, [2.5, 4.5])?;
/// object.observe(1.0, [2.5, 3.5])?;
/// let slots = Slots { slot_s: 1.0, robot_radius_m: 0.2, ..Slots::default() };
/// let closures = Closures::new(&map, Cell::new(1, 1), slots, 1.0, &[object])?;
/// assert!(closures.is_closed(0, Cell::new(2, 0), None)); // between 3.5 m and 2.5 m: in the top row
/// assert!(!closures.is_closed(0, Cell::new(2, 2), None));
/// assert!(closures.is_closed(1, Cell::new(1, 1), Some(Dir::E)));
/// assert!(!closures.is_closed(1, Cell::new(1, 1), None));
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Closures {
    pub(super) window: Window,
    pub(super) free: Rows,
    pub(super) start_s: f64,
    /// What objects can reach, in the certain slots.
    pub(super) reach: Vec<Planes>,
    /// Where they are likely to be, in all slots.
    likely: Vec<Planes>,
}

/// The closed cells of a slot: a plane for each direction, and one for standing.
pub(super) type Planes = Vec<Rows>;

/// The likely place of an object is where it is with this probability. What is less certain is left to later plans.
const LIKELY: f64 = 0.9;

impl Closures {
    /// The closures that all these objects cause around a robot in `cell`, from `start_s` on.
    ///
    /// # Errors
    /// [`Error::BadValue`] as [`Slots::checked`] and for a time beyond 10⁹ s; [`Error::OutsideMap`] or
    /// [`Error::StartOccupied`] for the cell.
    pub fn new(map: &Map, cell: Cell, slots: Slots, start_s: f64, tracks: &[Track]) -> Result<Self, Error> {
        let mut all = Self::none(map, cell, slots, start_s)?;
        for track in tracks {
            let mut own = Self::none(map, cell, slots, start_s)?;
            own.close(map, slots, track);
            all.add(&own);
        }
        Ok(all)
    }

    /// Without any object.
    pub(super) fn none(map: &Map, cell: Cell, slots: Slots, start_s: f64) -> Result<Self, Error> {
        let slots = slots.checked()?;
        super::within("the time of a plan, in seconds", start_s, -1e9, 1e9, "between -10⁹ and 10⁹")?;
        map.check_task(cell, cell)?;
        let window = Window::around(map.lattice(), cell, slots.count());
        let open = vec![window.empty(); usize::from(map.lattice().degree()) + 1];
        Ok(Self {
            window,
            free: window.free(map),
            start_s,
            reach: vec![open.clone(); slots.certain.into()],
            likely: vec![open; slots.count().into()],
        })
    }

    /// How many slots.
    pub fn slots(&self) -> usize {
        self.likely.len()
    }

    /// Whether the robot must not stand in the cell (no direction), or not leave it in that direction, during slot
    /// `slot`. Slots and cells beyond its foresight are open.
    pub fn is_closed(&self, slot: usize, cell: Cell, way: Option<Dir>) -> bool {
        slot < self.slots() && self.has(self.planes(slot, self.reach.len()), cell, way)
    }

    /// The same, of the places alone where objects are likely to be.
    pub fn is_likely_closed(&self, slot: usize, cell: Cell, way: Option<Dir>) -> bool {
        slot < self.slots() && self.has(self.planes(slot, 0), cell, way)
    }

    pub(super) fn has(&self, planes: &Planes, cell: Cell, way: Option<Dir>) -> bool {
        self.window.has(&planes[way.map_or(planes.len() - 1, Dir::index)], cell)
    }

    /// What is closed in a slot if only the first `sure` slots keep off all that objects can reach.
    pub(super) fn planes(&self, slot: usize, sure: usize) -> &Planes {
        if slot < sure.min(self.reach.len()) { &self.reach[slot] } else { &self.likely[slot] }
    }

    /// Closes what one object may touch.
    pub(super) fn close(&mut self, map: &Map, slots: Slots, track: &Track) {
        for slot in 0..self.slots() {
            let from_s = self.start_s + slots.slot_s * slot as f64;
            let to_s = from_s + slots.slot_s;
            let mut reach = track.reach(from_s, to_s);
            if slot < self.reach.len() {
                self.reach[slot] = self.touched(map, slots, &reach);
            }
            let Some(likely) = likely(track, from_s, to_s, slot < self.reach.len()) else { continue };
            reach.push(likely);
            self.likely[slot] = self.touched(map, slots, &reach);
        }
    }

    /// Where the robot may touch an object whose disc stays inside all of these.
    fn touched(&self, map: &Map, slots: Slots, object: &[Capsule]) -> Planes {
        let degree = usize::from(map.lattice().degree());
        let mut closed = vec![self.window.empty(); degree + 1];
        let touches = |from_m, to_m| {
            let robot = Capsule { from_m, to_m, radius_m: slots.robot_radius_m };
            object.iter().all(|capsule| capsule.gap_m(&robot) <= 1e-9)
        };
        for cell in self.window.cells(&self.free) {
            let at_m = map.centre_m(cell);
            // A side is at most a cell away: far cells are dismissed at once.
            let far = Capsule { from_m: at_m, to_m: at_m, radius_m: slots.robot_radius_m };
            if object.iter().any(|capsule| capsule.gap_m(&far) > map.frame().cell_m * 1.001) {
                continue;
            }
            if touches(at_m, at_m) {
                self.window.set(&mut closed[degree], cell);
            }
            // Each side is looked at once, from one of its two cells.
            for dir in map.lattice().dirs().take(degree / 2) {
                let next = map.lattice().neighbour(cell, dir);
                if map.is_free(next) && touches(at_m, map.centre_m(next)) {
                    self.window.set(&mut closed[dir.index()], cell);
                    self.window.set(&mut closed[map.lattice().opposite(dir).index()], next);
                }
            }
        }
        closed
    }

    /// Closes what the other closes.
    pub(super) fn add(&mut self, other: &Self) {
        let own = self.reach.iter_mut().chain(&mut self.likely).flatten();
        for (own, other) in own.zip(other.reach.iter().chain(&other.likely).flatten()) {
            window::add(own, other);
        }
    }

    /// Opens what was proven open earlier: an object that could not be there, as seen then, cannot be there now. Only
    /// where both cut time alike, and in slots that were certain.
    pub(super) fn refine(&mut self, before: &Self, slots: Slots) {
        let passed = (self.start_s - before.start_s) / slots.slot_s;
        if passed < 0.0 || passed > f64::from(slots.count()) || (passed - passed.round()).abs() > 1e-6 {
            return;
        }
        for (own, then) in self.reach.iter_mut().zip(before.reach.iter().skip(passed.round() as usize)) {
            for (own, then) in own.iter_mut().zip(then) {
                *own = window::both(own, &self.window.seen_through(&before.window, then));
            }
        }
    }
}

/// Where the object's disc is likely to be in a slot; `None` if it was never seen. After the certain slots no wider than
/// a guess: it would close half the floor.
pub(crate) fn likely(track: &Track, from_s: f64, to_s: f64, certain: bool) -> Option<Capsule> {
    let (begin, end) = (track.forecast(from_s)?, track.forecast(to_s)?);
    let likely_m = begin.radius_m(LIKELY).max(end.radius_m(LIKELY));
    let vague_m = 2.0 * track.bounds().radius_m + 0.5 * track.bounds().max_speed_mps * (to_s - from_s);
    let likely_m = if certain { likely_m } else { likely_m.min(vague_m) };
    Some(Capsule { from_m: begin.at_m, to_m: end.at_m, radius_m: track.bounds().radius_m + likely_m })
}
