//! Sensors and the unknown: what distance sensors read, the map that a robot believes in, and where it believes to be.
//!
//! - [`Ray`]: the cells along a beam, exactly, on both lattices.
//! - [`look`]: the readings of all beams, with noise and false readings.
//! - [`Belief`]: a map whose cells close and open with what is read (after Moravec and Elfes, *High Resolution Maps
//!   from Wide Angle Sonar*, 1985).
//! - [`Estimate`]: the pose, carried on by the model of errors and corrected by what the beams should have met: an
//!   extended Kalman filter (Thrun, Burgard, Fox, *Probabilistic Robotics*, 2005, chapters 3, 6 and 7).

mod belief;
mod estimate;
mod ray;

pub use belief::{Belief, Change};
pub use estimate::Estimate;
pub use ray::{Crossing, Ray};

use crate::program::{Pose, Robot, Sensors};
use crate::rng::Rng;
use std::f64::consts::TAU;

impl Sensors {
    /// The bearing of each beam of a robot that faces along `bearing_rad`, the first straight ahead, then
    /// counter-clockwise.
    pub fn bearings_rad(&self, bearing_rad: f64) -> impl Iterator<Item = f64> {
        let beams = f64::from(self.beams);
        (0..self.beams).map(move |beam| bearing_rad + TAU * f64::from(beam) / beams)
    }
}

impl Robot {
    /// Whether it can drive backwards and one of its beams looks there.
    pub(crate) fn sees_behind(&self) -> bool {
        self.can_reverse && self.sensors.bearings_rad(TAU / 2.0).any(|angle| wrapped(angle).abs() < 0.2)
    }
}

/// What the sensors read at a pose, beam by beam, in metres; the range where a beam meets nothing.
///
/// `distance_m` says how far the world lets a beam go from the pose along a bearing; what is beyond the range does not
/// matter. A false reading is anything between nothing and the range.
///
/// ```
/// use activecell::{Lattice, Map, Pose, Rng, Sensors, sense};
/// let map = Map::parse(Lattice::Square, ".....")?;
/// let sensors = Sensors { range_m: 3.0, noise_m: 0.0, beams: 4, false_rate: 0.0 };
/// let pose = Pose { at_m: [1.5, 0.5], bearing_rad: 0.0 };
/// let distance_m = |bearing_rad| map.cast(pose.at_m, bearing_rad, 3.0).map_or(9.0, |hit| hit.enter_m);
/// assert_eq!(sense::look(&sensors, pose, &distance_m, &mut Rng::new(1)), [3.0, 0.5, 1.5, 0.5]);
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn look(sensors: &Sensors, pose: Pose, distance_m: &dyn Fn(f64) -> f64, rng: &mut Rng) -> Vec<f64> {
    let beams = sensors.bearings_rad(pose.bearing_rad).map(|bearing_rad| {
        if rng.chance(sensors.false_rate) {
            return rng.unit() * sensors.range_m;
        }
        let true_m = distance_m(bearing_rad);
        if true_m >= sensors.range_m {
            return sensors.range_m;
        }
        (true_m + sensors.noise_m * rng.normal()).clamp(0.0, sensors.range_m)
    });
    beams.collect()
}

/// An angle between −π and π.
pub fn wrapped(angle_rad: f64) -> f64 {
    let turned = angle_rad.rem_euclid(TAU);
    if turned > TAU / 2.0 { turned - TAU } else { turned }
}
