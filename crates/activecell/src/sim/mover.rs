//! Discs that move: people and other robots, as far as a distance sensor sees them.

use crate::map::PointM;
use crate::program::Pose;

/// A part of a mover's way: straight, along a circle, or at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Leg {
    /// How long it takes.
    pub duration_s: f64,
    /// How fast it goes.
    pub speed_mps: f64,
    /// How fast it turns, counter-clockwise positive.
    pub turn_rate_radps: f64,
}

/// A disc that goes its way whatever the robot does; after its last leg it stands still.
///
/// ```
/// use activecell::{Pose, sim::{Leg, Mover}};
/// use std::f64::consts::PI;
/// let legs = vec![
///     Leg { duration_s: 2.0, speed_mps: 1.0, turn_rate_radps: 0.0 },
///     Leg { duration_s: 1.0, speed_mps: PI, turn_rate_radps: PI }, // half a circle of radius 1 m
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

impl Mover {
    /// Where its centre is at a time.
    pub fn at_m(&self, time_s: f64) -> PointM {
        let mut pose = self.start;
        let mut rest_s = time_s.max(0.0);
        for leg in &self.legs {
            let part_s = rest_s.min(leg.duration_s);
            let half_rad = leg.turn_rate_radps * part_s / 2.0;
            let way_m = leg.speed_mps * part_s;
            let chord_m = if half_rad == 0.0 { way_m } else { way_m * half_rad.sin() / half_rad };
            pose.bearing_rad += half_rad;
            pose.at_m = pose.point(chord_m, 0.0);
            pose.bearing_rad += half_rad;
            rest_s -= part_s;
        }
        pose.at_m
    }

    /// How far a ray gets before it meets the disc at that time.
    pub(super) fn met_m(&self, time_s: f64, from_m: PointM, bearing_rad: f64) -> Option<f64> {
        let [x, y] = self.at_m(time_s);
        let (sin, cos) = bearing_rad.sin_cos();
        let (dx, dy) = (x - from_m[0], y - from_m[1]);
        let (ahead, aside) = (dx * cos + dy * sin, dy * cos - dx * sin);
        let half_chord = (self.radius_m.powi(2) - aside * aside).max(0.0).sqrt();
        (aside.abs() <= self.radius_m && ahead + half_chord >= 0.0).then(|| (ahead - half_chord).max(0.0))
    }
}
