//! Calibration: a robot's wheels and noise from its encoders' logs with ground truth.

mod algebra;
mod fit;
mod log;
mod odometry;
mod sweep;
mod umbmark;

pub use fit::{Calibration, calibrate};
pub use log::{DriveLog, EndError, LogRow, TruthNoise};
pub use odometry::{Odometry, deviations_squared};
pub use umbmark::{SquareErrors, umbmark};
