//! The options of `activecell calibrate`.

use clap::Args;
use std::path::PathBuf;

/// Fit a robot's wheels and noise to encoder logs with ground truth
///
/// A log is a CSV file with the columns `time_s,x_m,y_m,bearing_rad,left_ticks,right_ticks` (the pose may be empty
/// where it was not measured), or a run of the OptiOdom data set; a folder stands for all its logs. The logs of a folder
/// are a session. How well the fit holds is told for each log by a fit that did not see its session.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  activecell calibrate logs/monday logs/tuesday --robot logs/robot.toml -o calibrated.toml --picture logs.svg
  activecell calibrate logs/monday --hold-out logs/tuesday --robot logs/robot.toml --json")]
pub(crate) struct CalibrateArgs {
    /// The logs to fit
    #[arg(value_name = "LOG.csv|FOLDER", required = true)]
    pub(crate) logs: Vec<PathBuf>,
    /// Judge the fit on these logs instead
    #[arg(long, value_name = "LOG.csv|FOLDER", num_args = 1..)]
    pub(crate) hold_out: Vec<PathBuf>,
    /// The robot as it is thought to be [default: that of the logs' metadata; needed without]
    #[arg(long, value_name = "FILE.toml")]
    pub(crate) robot: Option<PathBuf>,
    /// How well the truth is measured at the best, in metres: a tracked marker is never quite above the axle's middle
    #[arg(long, value_name = "M", default_value_t = 0.001, allow_negative_numbers = true, value_parser = super::radius_m)]
    pub(crate) truth: f64,
    /// Write the robot file: --robot's, comments and all, with the values that were found
    #[arg(short, long, value_name = "ROBOT.toml")]
    pub(crate) output: Option<PathBuf>,
    /// Draw each log that was judged: truth, nominal and calibrated dead reckoning
    #[arg(long, value_name = "FILE.svg|.png")]
    pub(crate) picture: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}
