//! A sweep along the logs: what dead reckoning from pose to pose foretells, beside what was measured.

use super::algebra::{
    Matrix, Vector, ZERO, apply, determinant, diagonal, dot, inverse, minus, plus, scaled, through, times,
    transposed,
};
use super::log::{DriveLog, wrapped};
use super::odometry::Odometry;
use crate::program::{Pose, Robot};

/// The noises that make the measured poses differ from dead reckoning.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Noise {
    /// Unevenness of the floor, m/√m.
    pub(super) unevenness: f64,
    /// Of a measured position, m.
    pub(super) position: f64,
    /// Of a measured bearing, rad.
    pub(super) bearing: f64,
}

/// A piece of a log between two measured poses.
#[derive(Debug, Clone, Copy)]
pub(super) struct Window {
    /// The piece driven from the pose (0, 0, 0).
    driven: Odometry,
    /// The measured pose at its end.
    truth: Vector,
}

/// The rows of a log between which its windows lie: about `window_m` apart, where truth was measured and the robot
/// turned least, because a truth that comes a moment too late is most wrong in a turn.
pub(super) fn cuts(log: &DriveLog, robot: &Robot, window_m: f64) -> Vec<usize> {
    let rows = log.rows();
    let last = rows.len() - 1;
    let turning = |i: usize| {
        let around = &rows[i..=(i + 1).min(last)];
        around.iter().map(|row| (row.ticks[1] - row.ticks[0]).unsigned_abs()).sum::<u64>()
    };
    let tick_m = robot.wheel_perimeter_m / robot.ticks_per_rev;
    let mut cuts = vec![0];
    let (mut way_m, mut best): (f64, Option<(u64, usize)>) = (0.0, None);
    let mut since_best_m = 0.0;
    for (i, row) in rows.iter().enumerate().skip(1) {
        let step_m = (row.ticks[0].abs() + row.ticks[1].abs()) as f64 / 2.0 * tick_m;
        way_m += step_m;
        since_best_m += step_m;
        if row.truth.is_some() && way_m >= window_m && best.is_none_or(|(least, _)| turning(i) < least) {
            best = Some((turning(i), i));
            since_best_m = 0.0;
        }
        if let Some((_, cut)) = best
            && way_m >= 1.5 * window_m
        {
            cuts.push(cut);
            way_m = since_best_m;
            best = None;
        }
    }
    // A short rest is part of the window before it.
    if cuts.len() > 1 && way_m < window_m / 2.0 {
        cuts.pop();
    }
    cuts.push(last);
    cuts
}

/// The windows of a log for a robot.
pub(super) fn windows(log: &DriveLog, cuts: &[usize], robot: &Robot) -> Vec<Window> {
    let rows = log.rows();
    let between = cuts.windows(2).map(|ends| {
        let mut driven = Odometry::new(Pose { at_m: [0.0, 0.0], bearing_rad: 0.0 });
        for row in &rows[ends[0] + 1..=ends[1]] {
            driven.advance(robot, row.ticks);
        }
        let truth = vector(rows[ends[1]].truth.expect("windows end where truth was measured"));
        Window { driven, truth }
    });
    between.collect()
}

pub(super) fn vector(pose: Pose) -> Vector {
    [pose.at_m[0], pose.at_m[1], pose.bearing_rad]
}

/// What a sweep found: the normal equations of the wheels' parameters, and how likely the noises make it all.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sums {
    /// Information about perimeter, difference and track.
    pub(super) information: Matrix,
    /// Its right side.
    pub(super) pull: Vector,
    /// Twice the negative logarithm of the likelihood, without its constants.
    pub(super) unlikely: f64,
    /// Measured poses that were used.
    pub(super) used: usize,
}

impl Sums {
    pub(super) const NONE: Self = Self { information: ZERO, pull: [0.0; 3], unlikely: 0.0, used: 0 };

    pub(super) fn plus(&self, other: &Self) -> Self {
        Self {
            information: plus(&self.information, &other.information),
            pull: std::array::from_fn(|i| self.pull[i] + other.pull[i]),
            unlikely: self.unlikely + other.unlikely,
            used: self.used + other.used,
        }
    }
}

/// Which measured poses a sweep uses.
pub(super) enum Gate<'a> {
    /// Those that are off by so many variances at the most; by how many each is off is noted.
    Judge(f64, &'a mut Vec<f64>),
    /// Those noted before.
    As(&'a [bool]),
}

/// A Kalman filter along one log. Its state is the real pose; a window foretells the next one, the measured pose
/// corrects it. So the noise of a measured pose, which two windows share, counts once. A measured pose that cannot
/// be true is passed over, and the next one is compared with dead reckoning from the last good one.
///
/// How the foretold poses depend on the wheels' parameters runs along (`columns`), and the innovations give the
/// normal equations of Gauss and Newton.
///
/// Source: Bar-Shalom, Li, Kirubarajan, *Estimation with Applications to Tracking and Navigation*, 2001.
pub(super) fn sweep(start: Pose, windows: &[Window], noise: &Noise, mut gate: Gate<'_>) -> Sums {
    let measured = diagonal([noise.position.powi(2), noise.position.powi(2), noise.bearing.powi(2)]);
    let (mut at, mut covariance, mut columns) = (vector(start), measured, ZERO);
    let mut sums = Sums::NONE;
    for (i, window) in windows.iter().enumerate() {
        let (sin, cos) = at[2].sin_cos();
        let turn = [[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]];
        let moved = apply(&turn, &vector(window.driven.pose()));
        let swung = [[1.0, 0.0, -moved[1]], [0.0, 1.0, moved[0]], [0.0, 0.0, 1.0]];
        at = std::array::from_fn(|k| at[k] + moved[k]);
        let floor = scaled(&window.driven.noise, noise.unevenness.powi(2));
        covariance = plus(&through(&swung, &covariance), &through(&turn, &floor));
        columns = plus(&times(&swung, &columns), &times(&turn, &window.driven.columns));

        let off = [0, 1, 2].map(|k| window.truth[k] - at[k]);
        let off = [off[0], off[1], wrapped(off[2])];
        let spread = plus(&covariance, &measured);
        let certainty = inverse(&spread).unwrap_or(ZERO);
        let seen = apply(&certainty, &off);
        let squared = dot(&off, &seen);
        let good = match &mut gate {
            Gate::Judge(most, noted) => {
                noted.push(squared);
                squared <= *most
            }
            Gate::As(used) => used[i],
        };
        if !good {
            continue;
        }
        let across = transposed(&columns);
        sums.information = plus(&sums.information, &times(&times(&across, &certainty), &columns));
        let pull = apply(&across, &seen);
        sums.pull = std::array::from_fn(|k| sums.pull[k] + pull[k]);
        sums.unlikely += determinant(&spread).ln() + squared;
        sums.used += 1;

        let gain = times(&covariance, &certainty);
        let step = apply(&gain, &off);
        at = std::array::from_fn(|k| at[k] + step[k]);
        let kept = minus(&diagonal([1.0; 3]), &gain);
        covariance = times(&kept, &covariance);
        columns = times(&kept, &columns);
    }
    sums
}

/// How many variances each window's end is off from its measured beginning, if the floor alone is uneven by 1 m/√m.
pub(super) fn roughness(start: Pose, windows: &[Window], measured: &Noise) -> Vec<f64> {
    let mut from = vector(start);
    let smallest = diagonal([measured.position.powi(2), measured.position.powi(2), measured.bearing.powi(2)]);
    let squared = windows.iter().filter_map(|window| {
        let (sin, cos) = from[2].sin_cos();
        let [x, y] = [window.truth[0] - from[0], window.truth[1] - from[1]];
        let driven = vector(window.driven.pose());
        let off = [
            cos * x + sin * y - driven[0],
            -sin * x + cos * y - driven[1],
            wrapped(window.truth[2] - from[2] - driven[2]),
        ];
        from = window.truth;
        let certainty = inverse(&plus(&window.driven.noise, &smallest))?;
        Some(dot(&off, &apply(&certainty, &off)))
    });
    squared.collect()
}
