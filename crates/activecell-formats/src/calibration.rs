//! What a calibration found, as `calibrate --json` prints it.

use activecell::{Calibration, EndError, Robot};
use serde::Serialize;

/// The object that `calibrate --json` prints. The names are a contract: keys are added, never changed.
#[derive(Debug, Clone, Serialize)]
pub struct CalibrationReport {
    /// Logs that were fitted.
    pub logs: usize,
    /// Sessions in which they were driven.
    pub sessions: usize,
    /// The way driven in them, in metres.
    pub way_m: f64,
    /// Measured poses compared with dead reckoning.
    pub poses: usize,
    /// Measured poses left out because they cannot be true.
    pub left_out: usize,
    /// The fitted robot, with the keys of a robot file.
    pub robot: serde_json::Value,
    /// Deviations of relative perimeter, difference and relative track by the fit alone.
    pub fit_rel: [f64; 3],
    /// How much sessions differ in each, beyond that.
    pub between_sessions_rel: [f64; 3],
    /// Noise of the ground truth's position, in metres.
    pub truth_m: f64,
    /// Noise of the ground truth's bearing, in radians.
    pub truth_rad: f64,
    /// How each log was judged: `session`, `log` (each by a fit on the other sessions, or logs), `hold-out`, `none`.
    pub held_out: &'static str,
    /// The logs that the fit did not see.
    pub rows: Vec<HeldOutRow>,
    /// The median nominal ÷ the median calibrated end error; null without rows.
    pub median_end_error_falls: Option<f64>,
    /// The median of nominal ÷ calibrated end error; null without rows.
    pub end_error_falls: Option<f64>,
    /// The median over sessions of the worst nominal ÷ the worst calibrated end error in it; null without rows.
    pub worst_end_error_falls: Option<f64>,
    /// How many rows' real end lies in the 95 % region.
    pub inside: usize,
}

/// A log that the fit did not see.
#[derive(Debug, Clone, Serialize)]
pub struct HeldOutRow {
    /// Its session: the folder's name.
    pub session: String,
    /// Its file.
    pub log: String,
    /// The way driven, in metres.
    pub way_m: f64,
    /// How far off dead reckoning ends by the nominal robot.
    pub nominal_m: f64,
    /// The same by the calibrated robot.
    pub calibrated_m: f64,
    /// The heading's error at the end by the nominal robot, counter-clockwise positive.
    pub nominal_rad: f64,
    /// The same by the calibrated robot.
    pub calibrated_rad: f64,
    /// Whether the real end lies in the calibrated robot's 95 % region.
    pub inside: bool,
}

impl HeldOutRow {
    /// From the end errors of both robots.
    pub fn new(session: &str, log: &str, nominal: &EndError, calibrated: &EndError) -> Self {
        Self {
            session: session.to_owned(),
            log: log.to_owned(),
            way_m: nominal.way_m,
            nominal_m: nominal.distance_m(),
            calibrated_m: calibrated.distance_m(),
            nominal_rad: nominal.turned_rad,
            calibrated_rad: calibrated.turned_rad,
            inside: calibrated.inside(),
        }
    }
}

/// How many times an error falls.
fn fall(from_m: f64, to_m: f64) -> f64 {
    from_m / to_m.max(1e-9)
}

/// The middle of some numbers, the mean of both middles of an even count; `None` without any.
pub fn median(numbers: impl Iterator<Item = f64>) -> Option<f64> {
    let mut numbers: Vec<f64> = numbers.collect();
    numbers.sort_by(f64::total_cmp);
    let upper = *numbers.get(numbers.len() / 2)?;
    Some(if numbers.len() % 2 == 1 { upper } else { f64::midpoint(numbers[numbers.len() / 2 - 1], upper) })
}

impl CalibrationReport {
    /// A report of what was found on `logs` logs of `sessions` sessions, and of how it held on others.
    pub fn new(
        found: &Calibration,
        [sessions, logs]: [usize; 2],
        way_m: f64,
        held_out: &'static str,
        rows: Vec<HeldOutRow>,
    ) -> Self {
        let falls = rows.iter().map(|row| fall(row.nominal_m, row.calibrated_m));
        // Rows of a session stand together.
        let worst = rows.chunk_by(|a, b| a.session == b.session).map(|rows| {
            let worst = |error: fn(&HeldOutRow) -> f64| rows.iter().map(error).fold(0.0, f64::max);
            fall(worst(|row| row.nominal_m), worst(|row| row.calibrated_m))
        });
        Self {
            logs,
            sessions,
            way_m,
            poses: found.poses,
            left_out: found.left_out,
            robot: crate::robot::to_json(&found.robot),
            fit_rel: found.fit_rel,
            between_sessions_rel: found.between_sessions_rel,
            truth_m: found.truth.position_m,
            truth_rad: found.truth.bearing_rad,
            held_out,
            median_end_error_falls: median(rows.iter().map(|row| row.nominal_m))
                .zip(median(rows.iter().map(|row| row.calibrated_m)))
                .map(|(from_m, to_m)| fall(from_m, to_m)),
            end_error_falls: median(falls),
            worst_end_error_falls: median(worst),
            inside: rows.iter().filter(|row| row.inside).count(),
            rows,
        }
    }
}

/// What to type into ROS 2 for this robot: parameters of `diff_drive_controller`.
pub fn diff_drive_yaml(robot: &Robot) -> String {
    let [left, right] = robot.wheel_perimeters_m();
    format!(
        "wheel_separation: {:.6}\nwheel_radius: {:.6}\nwheel_separation_multiplier: 1.0\nleft_wheel_radius_multiplier: {:.6}\nright_wheel_radius_multiplier: {:.6}\n",
        robot.track_m,
        robot.wheel_perimeter_m / std::f64::consts::TAU,
        left / robot.wheel_perimeter_m,
        right / robot.wheel_perimeter_m,
    )
}
