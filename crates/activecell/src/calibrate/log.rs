//! A log: what the encoders counted, and where the robot really was.

use super::odometry::{Odometry, deviations_squared};
use crate::error::Error;
use crate::error_budget::REGION_95;
use crate::map::PointM;
use crate::program::{Errors, Pose, Robot};
use std::f64::consts::{PI, TAU};

/// One row of a log.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LogRow {
    /// When.
    pub time_s: f64,
    /// Where the robot really was then, if that was measured.
    pub truth: Option<Pose>,
    /// What the encoders of the left and the right wheel counted since the row before.
    pub ticks: [i64; 2],
}

/// Encoder ticks with ground truth, from its first measured pose to its last one.
#[derive(Debug, Clone, PartialEq)]
pub struct DriveLog {
    rows: Vec<LogRow>,
    start: Pose,
    end: Pose,
}

/// How far off dead reckoning is at the end of a log.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EndError {
    /// The way that the wheels rolled.
    pub way_m: f64,
    /// From where the robot really was to where it should be by its encoders: x right, y up.
    pub off_m: PointM,
    /// The same for the heading, between −π and π.
    pub turned_rad: f64,
    /// The square of how many standard deviations `off_m` is.
    pub deviations_squared: f64,
}

impl EndError {
    /// The distance between the two positions.
    pub fn distance_m(&self) -> f64 {
        self.off_m[0].hypot(self.off_m[1])
    }

    /// Whether the real position lies in the 95 % region.
    pub fn inside(&self) -> bool {
        self.deviations_squared <= REGION_95
    }
}

/// How well the ground truth is measured: one standard deviation.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TruthNoise {
    /// Of the position, along each axis.
    pub position_m: f64,
    /// Of the bearing.
    pub bearing_rad: f64,
}

impl DriveLog {
    /// A log of these rows; those before the first and after the last measured pose are left out.
    ///
    /// # Errors
    /// [`Error::BadLog`] names the first row that goes back in time or holds a number that is none, and a log
    /// without two measured poses.
    ///
    /// ```
    /// use activecell::{DriveLog, LogRow, Pose};
    /// let pose = |x| Some(Pose { at_m: [x, 0.0], bearing_rad: 0.0 });
    /// let row = |time_s, truth, ticks| LogRow { time_s, truth, ticks };
    /// let rows = vec![row(0.0, pose(0.0), [0, 0]), row(1.0, None, [90, 90]), row(2.0, pose(1.0), [90, 90])];
    /// assert_eq!(DriveLog::new(rows.clone())?.rows().len(), 3);
    /// let error = DriveLog::new(rows[..2].to_vec()).unwrap_err();
    /// assert!(error.to_string().contains("two poses"));
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn new(mut rows: Vec<LogRow>) -> Result<Self, Error> {
        let bad = |row: usize, reason: &'static str| Error::BadLog { row: Some(row), reason };
        for (i, row) in rows.iter().enumerate() {
            let pose = row.truth.map_or([0.0; 3], |pose| [pose.at_m[0], pose.at_m[1], pose.bearing_rad]);
            if !row.time_s.is_finite() || pose.iter().any(|number| number.is_nan() || number.abs() > 1e9) {
                return Err(bad(i, "a time, a position or a bearing is no number; leave such a row out"));
            }
            if i > 0 && row.time_s < rows[i - 1].time_s {
                return Err(bad(i, "the time goes back; sort the rows, or split the log there"));
            }
            if row.ticks.iter().any(|ticks| ticks.unsigned_abs() > MAX_TICKS) {
                return Err(bad(
                    i,
                    "more than 1000000000 ticks in one row; give the ticks since the row before",
                ));
            }
        }
        let measured = |row: &(usize, &LogRow)| row.1.truth.is_some();
        let first = rows.iter().enumerate().find(measured);
        let last = rows.iter().enumerate().rev().find(measured);
        if let (
            Some((first, &LogRow { truth: Some(start), .. })),
            Some((last, &LogRow { truth: Some(end), .. })),
        ) = (first, last)
            && first < last
        {
            rows.truncate(last + 1);
            rows.drain(..first);
            return Ok(Self { rows, start, end });
        }
        let reason = "the log needs two poses of ground truth at least, where it begins and where it ends";
        Err(Error::BadLog { row: None, reason })
    }

    /// The rows; the first and the last one have a measured pose.
    pub fn rows(&self) -> &[LogRow] {
        &self.rows
    }

    /// The measured pose in which the log begins.
    pub const fn start(&self) -> Pose {
        self.start
    }

    /// The measured pose in which it ends.
    pub const fn end(&self) -> Pose {
        self.end
    }

    /// Dead reckoning of the whole log, from its first measured pose: one state for each row.
    pub fn dead_reckoning(&self, robot: &Robot) -> impl Iterator<Item = Odometry> {
        let mut odometry = Odometry::new(self.start);
        self.rows.iter().enumerate().map(move |(i, row)| {
            // What was counted before the first measured pose is not part of the way.
            if i > 0 {
                odometry.advance(robot, row.ticks);
            }
            odometry
        })
    }

    /// How far off this robot's dead reckoning is at the end, beside the region that the robot's errors give.
    pub fn end_error(&self, robot: &Robot, truth: TruthNoise) -> EndError {
        let reckoned = self.dead_reckoning(robot).fold(Odometry::new(self.start), |_, state| state);
        let start = (truth.position_m, truth.bearing_rad);
        let errors = Errors { start_m: start.0, start_rad: start.1, ..robot.errors };
        let mut covariance = reckoned.covariance(&errors);
        covariance[0][0] += truth.position_m.powi(2);
        covariance[1][1] += truth.position_m.powi(2);
        let (at, end) = (reckoned.pose(), self.end);
        let off_m = [at.at_m[0] - end.at_m[0], at.at_m[1] - end.at_m[1]];
        EndError {
            way_m: reckoned.way_m(),
            off_m,
            turned_rad: wrapped(at.bearing_rad - end.bearing_rad),
            deviations_squared: deviations_squared(&covariance, off_m),
        }
    }
}

/// The most ticks in one row.
const MAX_TICKS: u64 = 1_000_000_000;

/// The same angle between −π and π.
pub(super) fn wrapped(angle_rad: f64) -> f64 {
    (angle_rad + PI).rem_euclid(TAU) - PI
}
