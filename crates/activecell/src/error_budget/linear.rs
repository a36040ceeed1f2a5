//! First order: the covariance of the pose if every error were small.

use super::path::Leg;
use crate::program::{Drive, Pose, Robot};

/// A deviation of the pose: x, y, heading.
type Deviation = [f64; 3];

/// The deviations of the pose that the errors cause, to first order: a covariance for the noise, and for each of
/// the wheels' deviations (perimeter, difference, track) a column, what one standard deviation of it does.
///
/// In a run of signed length L along the unit vector e, with n to its left, q the heading's variance a metre and
/// b the track:
///
/// - a heading deviation θ moves the robot by L θ n;
/// - the perimeter's column gains L e, the difference's ½ L² ÷ b n and the heading L ÷ b;
/// - noise: k² |L| ÷ 2 along e; the heading gains q |L|, the side q |L|³ ÷ 3, and both together q |L| L ÷ 2
///   (k² |L| along and across, no more, with steered wheels).
///
/// In a turn by α the perimeter's column gains α, the track's loses α; steered wheels turn without either.
///
/// Source: Smith and Cheeseman, *On the Representation and Estimation of Spatial Uncertainty*, 1986; the noise of a
/// run after Chong and Kleeman, *Accurate Odometry and Error Modelling for a Mobile Robot*, 1997.
#[derive(Debug, Clone)]
pub(super) struct Linear {
    noise: [Deviation; 3],
    columns: [Deviation; 3],
}

const PERIMETER: usize = 0;
const DIFFERENCE: usize = 1;
const TRACK: usize = 2;

impl Linear {
    pub(super) fn new(robot: &Robot) -> Self {
        let (position, heading) = (robot.errors.start_m.powi(2), robot.errors.start_rad.powi(2));
        let noise = [[position, 0.0, 0.0], [0.0, position, 0.0], [0.0, 0.0, heading]];
        Self { noise, columns: [[0.0; 3]; 3] }
    }

    /// After a leg that begins, nominally, at this pose.
    pub(super) fn drive(&mut self, robot: &Robot, leg: Leg, pose: Pose) {
        let errors = &robot.errors;
        let (sin, cos) = pose.bearing_rad.sin_cos();
        match leg {
            Leg::Run(length_m) => self.run(robot, length_m, [cos, sin]),
            Leg::Stop => self.add_noise([cos, sin, 0.0], errors.stop_inertia_m.powi(2)),
            Leg::Turn(turn_rad) => {
                self.noise[2][2] += errors.turn_rad.powi(2);
                if robot.drive == Drive::Differential {
                    self.columns[PERIMETER][2] += errors.wheel_perimeter_rel * turn_rad;
                    self.columns[TRACK][2] -= errors.track_rel * turn_rad;
                }
            }
        }
    }

    fn run(&mut self, robot: &Robot, length_m: f64, [cos, sin]: [f64; 2]) {
        let errors = &robot.errors;
        let left = [-sin, cos];
        for column in &mut self.columns {
            for axis in 0..2 {
                column[axis] += length_m * column[2] * left[axis];
            }
        }
        // Noise from both sides: F N Fᵀ with F = 1 + L n (heading).
        for row in &mut self.noise {
            for axis in 0..2 {
                row[axis] += length_m * row[2] * left[axis];
            }
        }
        let [x, y, heading] = &mut self.noise;
        for (row, left) in [(x, left[0]), (y, left[1])] {
            for (entry, other) in row.iter_mut().zip(heading.iter()) {
                *entry += length_m * other * left;
            }
        }
        let step_m = errors.wheel_perimeter_rel * length_m;
        self.columns[PERIMETER][0] += step_m * cos;
        self.columns[PERIMETER][1] += step_m * sin;
        let way_m = length_m.abs();
        let variance = errors.unevenness_m_per_sqrt_m.powi(2) * way_m;
        self.add_noise(
            [cos, sin, 0.0],
            if robot.drive == Drive::Steered { variance } else { variance / 2.0 },
        );
        match robot.drive {
            Drive::Steered => self.add_noise([left[0], left[1], 0.0], variance),
            Drive::Differential => {
                let bend_rad = errors.wheel_difference_rel * length_m / robot.track_m;
                let side_m = bend_rad * length_m / 2.0;
                for (axis, gain) in [side_m * left[0], side_m * left[1], bend_rad].into_iter().enumerate() {
                    self.columns[DIFFERENCE][axis] += gain;
                }
                // What the side does beyond half the length times the heading has a third of its variance.
                let heading = 2.0 * variance / robot.track_m.powi(2);
                self.add_noise([length_m / 2.0 * left[0], length_m / 2.0 * left[1], 1.0], heading);
                self.add_noise([left[0], left[1], 0.0], heading * length_m.powi(2) / 12.0);
            }
        }
    }

    fn add_noise(&mut self, along: Deviation, variance: f64) {
        for (row, a) in self.noise.iter_mut().zip(along) {
            for (entry, b) in row.iter_mut().zip(along) {
                *entry += variance * a * b;
            }
        }
    }

    /// The covariance of x, y and heading.
    pub(super) fn covariance(&self) -> [Deviation; 3] {
        let mut sum = self.noise;
        for column in &self.columns {
            for (row, a) in sum.iter_mut().zip(column) {
                for (entry, b) in row.iter_mut().zip(column) {
                    *entry += a * b;
                }
            }
        }
        sum
    }
}
