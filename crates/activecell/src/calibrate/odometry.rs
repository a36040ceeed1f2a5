//! Dead reckoning from encoder ticks, with its covariance.

use super::algebra::{Matrix, ZERO, diagonal, plus, scaled, through, times};
use crate::map::PointM;
use crate::program::{Errors, Pose, Robot};

/// Where a differential robot is by its wheels' encoders alone, and how that depends on its wheels.
///
/// Each row of ticks is driven as an exact arc: the left and the right wheel roll l and r, the centre (r + l) ÷ 2, and
/// the robot turns by (r − l) ÷ track. Beside the pose it carries how the pose changes with the perimeter, the
/// wheels' difference and the track, and the covariance that an uneven floor gives, of variance k² × its way for
/// each wheel (Chong and Kleeman, *Accurate Odometry and Error Modelling for a Mobile Robot*, 1997).
///
/// ```
/// use activecell::{Errors, Odometry, Pose, Robot};
/// let robot = Robot { wheel_perimeter_m: 0.2, ticks_per_rev: 100.0, ..Robot::default() };
/// let mut odometry = Odometry::new(Pose { at_m: [0.0, 0.0], bearing_rad: 0.0 });
/// odometry.advance(&robot, [5000, 5000]);
/// assert_eq!(odometry.pose().at_m, [10.0, 0.0]);
/// let covariance = odometry.covariance(&Errors { wheel_perimeter_rel: 0.01, ..Errors::NONE });
/// assert!((covariance[0][0].sqrt() - 0.1).abs() < 1e-12); // 1 % of 10 m
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Odometry {
    pose: Pose,
    start: PointM,
    way_m: f64,
    /// Derivatives of x, y and bearing (rows) by relative perimeter, difference and relative track (columns).
    pub(super) columns: Matrix,
    /// The covariance of x, y and bearing at an unevenness of 1 m/√m.
    pub(super) noise: Matrix,
}

impl Odometry {
    /// At the beginning of the way.
    pub const fn new(pose: Pose) -> Self {
        Self { pose, start: pose.at_m, way_m: 0.0, columns: ZERO, noise: ZERO }
    }

    /// Where it is; the bearing counts full turns.
    pub const fn pose(&self) -> Pose {
        self.pose
    }

    /// The way that the wheels rolled, the mean of both, forwards and backwards.
    pub const fn way_m(&self) -> f64 {
        self.way_m
    }

    /// Drives what the encoders of the left and the right wheel counted.
    pub fn advance(&mut self, robot: &Robot, ticks: [i64; 2]) {
        if ticks == [0, 0] {
            return;
        }
        let perimeters_m = robot.wheel_perimeters_m();
        let turns = ticks.map(|ticks| ticks as f64 / robot.ticks_per_rev);
        let [left, right] = [turns[0] * perimeters_m[0], turns[1] * perimeters_m[1]];
        let track = robot.track_m;
        let (ahead, turned) = (f64::midpoint(left, right), (right - left) / track);
        let (chord, by_ahead, by_turned) = arc(self.pose.bearing_rad, ahead, turned);

        // How the pose before the row, and the row itself, change the pose after it.
        let moved = [[1.0, 0.0, -chord[1]], [0.0, 1.0, chord[0]], [0.0, 0.0, 1.0]];
        let by_row = [[by_ahead[0], by_turned[0], 0.0], [by_ahead[1], by_turned[1], 0.0], [0.0, 1.0, 0.0]];
        // The difference takes half of its share from the left wheel and gives it to the right one.
        let share = turns.map(|turns| turns * robot.wheel_perimeter_m / 2.0);
        let by_wheels = [
            [ahead, (share[1] - share[0]) / 2.0, 0.0],
            [turned, (share[1] + share[0]) / track, -turned],
            [0.0; 3],
        ];
        self.columns = plus(&times(&moved, &self.columns), &times(&by_row, &by_wheels));

        let (sum, difference) = (left.abs() + right.abs(), right.abs() - left.abs());
        let both = difference / (2.0 * track);
        let wander = sum / track.powi(2);
        let row = [[sum / 4.0, both, 0.0], [both, wander, 0.0], [0.0; 3]];
        let mut noise = plus(&through(&moved, &self.noise), &through(&by_row, &row));
        // What the heading did inside the row, beyond half of what it did over it: it moves the robot sideways.
        let sideways = wander * ahead.powi(2) / 12.0;
        let (sin, cos) = (self.pose.bearing_rad + turned / 2.0).sin_cos();
        let across = [-sin, cos];
        for (i, row) in noise.iter_mut().take(2).enumerate() {
            for (j, entry) in row.iter_mut().take(2).enumerate() {
                *entry += sideways * across[i] * across[j];
            }
        }
        self.noise = noise;

        let [x, y] = self.pose.at_m;
        self.pose = Pose { at_m: [x + chord[0], y + chord[1]], bearing_rad: self.pose.bearing_rad + turned };
        self.way_m += sum / 2.0;
    }

    /// The covariance of x, y (m) and bearing (rad) by the robot's errors: uneven floor, perimeter, difference,
    /// track and start pose.
    pub fn covariance(&self, errors: &Errors) -> [[f64; 3]; 3] {
        let wheels = [errors.wheel_perimeter_rel, errors.wheel_difference_rel, errors.track_rel];
        let systematic = through(&self.columns, &diagonal(wheels.map(|deviation| deviation.powi(2))));
        let noise = scaled(&self.noise, errors.unevenness_m_per_sqrt_m.powi(2));
        let start = [errors.start_m, errors.start_m, errors.start_rad].map(|deviation| deviation.powi(2));
        let [x, y] = [self.pose.at_m[0] - self.start[0], self.pose.at_m[1] - self.start[1]];
        let swung = [[1.0, 0.0, -y], [0.0, 1.0, x], [0.0, 0.0, 1.0]];
        plus(&plus(&systematic, &noise), &through(&swung, &diagonal(start)))
    }
}

/// The chord of an arc, and its derivatives by the arc's length and by the angle turned.
fn arc(bearing: f64, ahead: f64, turned: f64) -> ([f64; 2], [f64; 2], [f64; 2]) {
    let half = turned / 2.0;
    // sin h ÷ h and its derivative, by their series where the quotient would lose its digits.
    let (share, slope) = if half.abs() < 1e-4 {
        (1.0 - half * half / 6.0, -half / 3.0)
    } else {
        (half.sin() / half, (half.cos() - half.sin() / half) / half)
    };
    let (sin, cos) = (bearing + half).sin_cos();
    let chord = ahead * share;
    let bent = ahead * slope / 2.0;
    (
        [chord * cos, chord * sin],
        [share * cos, share * sin],
        [bent * cos - chord / 2.0 * sin, bent * sin + chord / 2.0 * cos],
    )
}

/// The square of how many standard deviations an error of the position is, by the covariance of x and y.
///
/// 0 if nothing is off, infinite if something is off that cannot be.
///
/// ```
/// use activecell::{REGION_95, deviations_squared};
/// let covariance = [[4.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.1]];
/// assert_eq!(deviations_squared(&covariance, [4.0, 0.0]), 4.0);
/// assert!(deviations_squared(&covariance, [0.0, 2.5]) > REGION_95);
/// ```
pub fn deviations_squared(covariance: &[[f64; 3]; 3], off_m: PointM) -> f64 {
    if off_m == [0.0, 0.0] {
        return 0.0;
    }
    let [[xx, xy, _], [_, yy, _], _] = *covariance;
    let whole = xx * yy - xy * xy;
    if whole.is_nan() || whole <= 0.0 {
        return f64::INFINITY;
    }
    let [x, y] = off_m;
    (yy * x * x - 2.0 * xy * x * y + xx * y * y) / whole
}
