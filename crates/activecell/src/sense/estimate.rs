//! Where a robot believes to be: an extended Kalman filter over x, y and heading.

use super::{Belief, wrapped};
use crate::lattice::Lattice;
use crate::map::PointM;
use crate::program::{Drive, Errors, Pose, Robot};

/// A reading farther than this many standard deviations from what it should be is of something else.
const GATE: f64 = 3.0;
/// A beam that meets a side more flatly than this cosine says little, and may meet another.
const FLATTEST: f64 = 0.4;

/// A believed pose and how sure it is.
///
/// Driving carries it on by the model of [`Motion`](crate::Motion), in which systematic errors are taken as noise of
/// their size over a metre: the filter does not learn them. Readings correct it, beam by beam, where the belief knows
/// which cell a beam should meet; a reading that does not fit is left out (it is false, or of something unknown).
///
/// ```
/// use activecell::{Cell, Lattice, Map, Pose, Robot, Sensors, sense::{Belief, Estimate}};
/// let map = Map::parse(Lattice::Square, "...")?;
/// let robot = Robot { sensors: Sensors { beams: 4, range_m: 9.0, ..Sensors::default() }, ..Robot::default() };
/// let mut estimate = Estimate::new(Pose { at_m: [1.50, 0.50], bearing_rad: 0.0 }, &robot.errors);
/// // The walls are 2 cm farther away in front and nearer behind.
/// estimate.correct(&robot, &Belief::new(&map), &[1.52, 0.5, 1.48, 0.5]);
/// assert!((1.48..1.495).contains(&estimate.pose().at_m[0]));
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    pose: Pose,
    /// Of x, y and heading.
    covariance: [[f64; 3]; 3],
}

impl Estimate {
    /// The start pose, as sure as `errors` says.
    pub fn new(pose: Pose, errors: &Errors) -> Self {
        let (at, facing) = (errors.start_m.powi(2), errors.start_rad.powi(2));
        Self { pose, covariance: [[at, 0.0, 0.0], [0.0, at, 0.0], [0.0, 0.0, facing]] }
    }

    /// The believed pose.
    pub const fn pose(&self) -> Pose {
        self.pose
    }

    /// One standard deviation of the position along its worst axis.
    pub fn spread_m(&self) -> f64 {
        let [[xx, xy, _], [_, yy, _], _] = self.covariance;
        let half = f64::midpoint(xx, yy);
        (half + ((xx - yy).powi(2) / 4.0 + xy * xy).sqrt()).max(0.0).sqrt()
    }

    /// One standard deviation of the heading.
    pub fn spread_rad(&self) -> f64 {
        self.covariance[2][2].max(0.0).sqrt()
    }

    /// After a run or a part of one; negative backwards.
    pub fn roll(&mut self, robot: &Robot, length_m: f64) {
        let errors = &robot.errors;
        let (sin, cos) = self.pose.bearing_rad.sin_cos();
        self.pose.at_m = self.pose.point(length_m, 0.0);
        // Heading errors so far carry over to the position.
        self.shear([-length_m * sin, length_m * cos]);
        let way_m = length_m.abs();
        let floor = errors.unevenness_m_per_sqrt_m.powi(2) * way_m;
        let (ahead, left, turned) = match robot.drive {
            Drive::Steered => (floor, floor, 0.0),
            Drive::Differential => {
                let track = robot.track_m.powi(2);
                let turned = 2.0 * floor / track + errors.wheel_difference_rel.powi(2) * way_m / track;
                (floor / 2.0, turned * way_m * way_m / 3.0, turned)
            }
        };
        let ahead = ahead + errors.wheel_perimeter_rel.powi(2) * way_m;
        // The heading's wander bends the way to the side while it is driven.
        let bent = turned * length_m / 2.0;
        self.add(ahead, left, turned, bent);
    }

    /// After coming to rest.
    pub fn stop(&mut self, robot: &Robot) {
        self.add(robot.errors.stop_inertia_m.powi(2), 0.0, 0.0, 0.0);
    }

    /// After a turn, counter-clockwise positive.
    pub fn turn(&mut self, robot: &Robot, turn_rad: f64) {
        let errors = &robot.errors;
        let wheels = match robot.drive {
            Drive::Steered => 0.0,
            Drive::Differential => errors.wheel_perimeter_rel.powi(2) + errors.track_rel.powi(2),
        };
        self.pose.bearing_rad = wrapped(self.pose.bearing_rad + turn_rad);
        self.add(0.0, 0.0, errors.turn_rad.powi(2) + wheels * turn_rad * turn_rad, 0.0);
    }

    /// Corrects the pose by readings taken at it; says how many were of use.
    pub fn correct(&mut self, robot: &Robot, belief: &Belief, readings_m: &[f64]) -> usize {
        let sensors = &robot.sensors;
        let turns = sensors.bearings_rad(0.0);
        let mut used = 0;
        for (turn_rad, &reading_m) in turns.zip(readings_m) {
            if reading_m < sensors.range_m
                && let Some(expected) = self.expected(belief, turn_rad, sensors.range_m)
            {
                used += usize::from(self.update(expected, reading_m, sensors.noise_m));
            }
        }
        self.pose.bearing_rad = wrapped(self.pose.bearing_rad);
        used
    }

    /// What a beam should read, and how that changes with x, y and heading; `None` if it should meet nothing, or
    /// nothing sure.
    fn expected(&self, belief: &Belief, turn_rad: f64, range_m: f64) -> Option<(f64, [f64; 3])> {
        let map = belief.map();
        let bearing_rad = self.pose.bearing_rad + turn_rad;
        let hit = map.cast(self.pose.at_m, bearing_rad, range_m)?;
        let side = hit.side.filter(|_| belief.is_sure(hit.cell))?;
        let across_rad = bearing_rad - map.bearing_rad(side);
        let (sin, cos) = across_rad.sin_cos();
        if cos < FLATTEST {
            return None;
        }
        let (normal_sin, normal_cos) = map.bearing_rad(side).sin_cos();
        // Near its end the side's neighbour may be met instead.
        let met_m = [
            self.pose.at_m[0] + hit.enter_m * bearing_rad.cos(),
            self.pose.at_m[1] + hit.enter_m * bearing_rad.sin(),
        ];
        let centre_m = map.centre_m(hit.cell);
        let along_m = (met_m[1] - centre_m[1]) * normal_cos - (met_m[0] - centre_m[0]) * normal_sin;
        let half_m = half_side_m(map.lattice()) * map.frame().cell_m;
        if along_m.abs() + 2.0 * self.aside_m(hit.enter_m) > half_m {
            return None;
        }
        Some((hit.enter_m, [-normal_cos / cos, -normal_sin / cos, hit.enter_m * sin / cos]))
    }

    /// How far aside of where it is thought a beam may be after so much way, one standard deviation.
    pub(crate) fn aside_m(&self, way_m: f64) -> f64 {
        self.spread_m().hypot(way_m * self.spread_rad())
    }

    /// One scalar step of the filter.
    fn update(&mut self, (expected_m, slope): (f64, [f64; 3]), reading_m: f64, noise_m: f64) -> bool {
        let spread: [f64; 3] = std::array::from_fn(|row| dot(self.covariance[row], slope));
        // Without any noise a reading must still not be trusted without bounds.
        let variance = dot(slope, spread) + noise_m.max(1e-4).powi(2);
        let surprise_m = reading_m - expected_m;
        if surprise_m.abs() > GATE * variance.sqrt() {
            return false;
        }
        let gain = spread.map(|value| value / variance);
        self.pose.at_m[0] += gain[0] * surprise_m;
        self.pose.at_m[1] += gain[1] * surprise_m;
        self.pose.bearing_rad += gain[2] * surprise_m;
        for (row, gain) in self.covariance.iter_mut().zip(gain) {
            for (value, spread) in row.iter_mut().zip(spread) {
                *value -= gain * spread;
            }
        }
        true
    }

    /// F P Fᵀ for a position that moves by `lever` for each radian of heading.
    fn shear(&mut self, lever: PointM) {
        let [x, y, facing] = &mut self.covariance;
        for (row, lever) in [x, y].into_iter().zip(lever) {
            for (value, turned) in row.iter_mut().zip(*facing) {
                *value += lever * turned;
            }
        }
        for row in &mut self.covariance {
            row[0] += lever[0] * row[2];
            row[1] += lever[1] * row[2];
        }
    }

    /// Adds variances ahead, to the left and of the heading, and the covariance of the last two.
    fn add(&mut self, ahead: f64, left: f64, turned: f64, bent: f64) {
        let (sin, cos) = self.pose.bearing_rad.sin_cos();
        let p = &mut self.covariance;
        p[0][0] += ahead * cos * cos + left * sin * sin;
        p[1][1] += ahead * sin * sin + left * cos * cos;
        let mixed = (ahead - left) * sin * cos;
        p[0][1] += mixed;
        p[1][0] += mixed;
        p[2][2] += turned;
        for (axis, share) in [(0, -sin * bent), (1, cos * bent)] {
            p[axis][2] += share;
            p[2][axis] += share;
        }
    }
}

/// Half the length of a cell's side, in cells.
pub(crate) fn half_side_m(lattice: Lattice) -> f64 {
    match lattice {
        Lattice::Square => 0.5,
        Lattice::Hex => 0.5 / 3f64.sqrt(),
    }
}

const fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
