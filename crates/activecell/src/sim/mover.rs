//! Discs that move: people and other robots, as far as a distance sensor sees them.

use crate::lattice::{Cell, Dir};
use crate::map::{Map, PointM};
use crate::program::Pose;
use crate::rng::Rng;
use crate::sense::wrapped;

/// A part of a mover's way: straight, along a circle, or at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Leg {
    /// How long it takes.
    pub duration_s: f64,
    /// How fast it goes at first.
    pub speed_mps: f64,
    /// How much faster it gets each second; negative while it brakes.
    pub accel_mps2: f64,
    /// How fast it turns, counter-clockwise positive.
    pub turn_rate_radps: f64,
}

/// A disc that goes its way whatever the robot does; after its last leg it stands still.
///
/// ```
/// use activecell::{Pose, sim::{Leg, Mover}};
/// use std::f64::consts::PI;
/// let legs = vec![
///     Leg { duration_s: 2.0, speed_mps: 1.0, accel_mps2: 0.0, turn_rate_radps: 0.0 },
///     Leg { duration_s: 1.0, speed_mps: PI, accel_mps2: 0.0, turn_rate_radps: PI }, // half a circle of radius 1 m
/// ];
/// let mover = Mover { radius_m: 0.2, start: Pose { at_m: [0.0, 0.0], bearing_rad: 0.0 }, legs };
/// assert_eq!(mover.at_m(1.0), [1.0, 0.0]);
/// let end = mover.at_m(9.0);
/// assert!((end[0] - 2.0).abs() < 1e-12 && (end[1] - 2.0).abs() < 1e-12);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Mover {
    /// Its size.
    pub radius_m: f64,
    /// Where it is at time 0 and where it faces.
    pub start: Pose,
    /// Its way.
    pub legs: Vec<Leg>,
}

impl Leg {
    /// Where it leads from a pose after a part of its time. With v and a along the heading, which turns at ω:
    /// ∫ (v + a t) e^{iωt} dt.
    fn after(&self, from: Pose, part_s: f64) -> Pose {
        let (v, a, w) = (self.speed_mps, self.accel_mps2, self.turn_rate_radps);
        let (angle_rad, faster) = (w * part_s, v + a * part_s);
        let (ahead_m, left_m) = if angle_rad.abs() < 1e-6 {
            (f64::midpoint(v, faster) * part_s, 0.0)
        } else {
            let (sin, cos) = angle_rad.sin_cos();
            (faster * sin / w + a * (cos - 1.0) / (w * w), (v - faster * cos) / w + a * sin / (w * w))
        };
        Pose { at_m: from.point(ahead_m, left_m), bearing_rad: from.bearing_rad + angle_rad }
    }
}

/// How far on its way a mover is: times only grow, so that no leg is reckoned twice.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stroll {
    leg: usize,
    /// When and where the leg begins.
    since_s: f64,
    from: Pose,
}

impl Stroll {
    pub(super) const fn new(mover: &Mover) -> Self {
        Self { leg: 0, since_s: 0.0, from: mover.start }
    }

    /// Where the mover is at a time not before the last one asked for.
    pub(super) fn at_m(&mut self, mover: &Mover, time_s: f64) -> PointM {
        while let Some(leg) = mover.legs.get(self.leg) {
            if time_s < self.since_s + leg.duration_s {
                return leg.after(self.from, (time_s - self.since_s).max(0.0)).at_m;
            }
            self.from = leg.after(self.from, leg.duration_s);
            self.since_s += leg.duration_s;
            self.leg += 1;
        }
        self.from.at_m
    }
}

/// What a walker stays within.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gait {
    /// Its size.
    pub radius_m: f64,
    /// Its highest speed.
    pub max_speed_mps: f64,
    /// Its highest acceleration.
    pub max_accel_mps2: f64,
}

/// A walker turns on the spot in this time, and rests for up to so long.
const TURN_S: f64 = 0.5;
const REST_S: f64 = 3.0;
/// It goes straight on for up to so many cells.
const STRAIGHT: u32 = 8;

impl Mover {
    /// One that walks about by chance for `duration_s` and then stands: straight on from free cell to free cell,
    /// stopping to turn or to rest.
    ///
    /// ```
    /// use activecell::{Cell, Lattice, Map, Rng, sim::{Gait, Mover}};
    /// let map = Map::parse(Lattice::Hex, "....\n.#..\n....")?;
    /// let gait = Gait { radius_m: 0.2, max_speed_mps: 0.5, max_accel_mps2: 0.5 };
    /// let mover = Mover::walker(&map, Cell::new(0, 0), gait, 100.0, &mut Rng::new(1));
    /// assert!((0..1000).all(|i| map.is_free(map.cell_at_m(mover.at_m(0.1 * f64::from(i))))));
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn walker(map: &Map, from: Cell, gait: Gait, duration_s: f64, rng: &mut Rng) -> Self {
        let lattice = map.lattice();
        let mut bearing_rad = 0.0;
        let (mut cell, mut time_s, mut legs) = (from, 0.0, Vec::new());
        let stand = |legs: &mut Vec<Leg>, duration_s: f64, turn_rad: f64| {
            let turn_rate_radps = turn_rad / duration_s;
            legs.push(Leg { duration_s, speed_mps: 0.0, accel_mps2: 0.0, turn_rate_radps });
        };
        while time_s < duration_s {
            let before = legs.len();
            let free: Vec<Dir> =
                lattice.dirs().filter(|&dir| map.is_free(lattice.neighbour(cell, dir))).collect();
            if free.is_empty() || rng.chance(0.2) {
                stand(&mut legs, 0.1 + REST_S * rng.unit(), 0.0);
            } else {
                let dir = free[rng.below(free.len() as u32) as usize];
                stand(&mut legs, TURN_S, wrapped(map.bearing_rad(dir) - bearing_rad));
                bearing_rad = map.bearing_rad(dir);
                let mut cells = 0;
                let most = 1 + rng.below(STRAIGHT);
                while cells < most && map.is_free(lattice.neighbour(cell, dir)) {
                    cell = lattice.neighbour(cell, dir);
                    cells += 1;
                }
                let speed_mps = gait.max_speed_mps * (0.5 + 0.5 * rng.unit());
                run(&mut legs, f64::from(cells) * map.frame().cell_m, speed_mps, gait.max_accel_mps2);
            }
            time_s += legs[before..].iter().map(|leg| leg.duration_s).sum::<f64>();
        }
        let start = Pose { at_m: map.centre_m(from), bearing_rad: 0.0 };
        Self { radius_m: gait.radius_m, start, legs }
    }

    /// Where its centre is at a time.
    pub fn at_m(&self, time_s: f64) -> PointM {
        Stroll::new(self).at_m(self, time_s)
    }

    /// How far a ray gets before it meets the disc at a place.
    pub(super) fn met_m(&self, [x, y]: PointM, from_m: PointM, bearing_rad: f64) -> Option<f64> {
        let (sin, cos) = bearing_rad.sin_cos();
        let (dx, dy) = (x - from_m[0], y - from_m[1]);
        let (ahead, aside) = (dx * cos + dy * sin, dy * cos - dx * sin);
        let half_chord = (self.radius_m.powi(2) - aside * aside).max(0.0).sqrt();
        (aside.abs() <= self.radius_m && ahead + half_chord >= 0.0).then(|| (ahead - half_chord).max(0.0))
    }
}

/// A run from rest to rest.
fn run(legs: &mut Vec<Leg>, way_m: f64, speed_mps: f64, accel_mps2: f64) {
    // On a short way it does not come up to its speed.
    let speed_mps = speed_mps.min((way_m * accel_mps2).sqrt());
    let (ramp_s, cruise_m) = (speed_mps / accel_mps2, way_m - speed_mps * speed_mps / accel_mps2);
    let leg =
        |duration_s, speed_mps, accel_mps2| Leg { duration_s, speed_mps, accel_mps2, turn_rate_radps: 0.0 };
    legs.push(leg(ramp_s, 0.0, accel_mps2));
    legs.push(leg(cruise_m.max(0.0) / speed_mps, speed_mps, 0.0));
    legs.push(leg(ramp_s, speed_mps, -accel_mps2));
}
