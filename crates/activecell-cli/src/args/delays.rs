//! The options of `activecell simulate` for plans.

use activecell::schedule::Stop;
use clap::Args;
use std::path::PathBuf;
use std::str::FromStr;

/// What goes wrong when a plan is executed. A step is the time for a cell at full speed.
#[derive(Debug, Args)]
#[command(next_help_heading = "Options for plans; a step is the time for a cell at full speed")]
pub(crate) struct DelayArgs {
    /// The map, if the plan file neither holds it nor names one that is there
    #[arg(long, value_name = "MAP")]
    pub(crate) map: Option<PathBuf>,
    /// The chance that a robot is held up on its way to the next cell, 0 to 1 [default: 0.05]
    #[arg(long, value_name = "P", allow_negative_numbers = true, value_parser = super::share)]
    pub(crate) delay_chance: Option<f64>,
    /// For how long then: one step to so many [default: 20]
    #[arg(long, value_name = "STEPS", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(crate) max_delay: Option<u32>,
    /// The share of robots that are slow, 0 to 1 [default: 0]
    #[arg(long, value_name = "SHARE", allow_negative_numbers = true, value_parser = super::share)]
    pub(crate) slow: Option<f64>,
    /// The speed of slow robots, as a share of full speed [default: 0.5]
    #[arg(long, value_name = "SHARE", requires = "slow", allow_negative_numbers = true, value_parser = speed)]
    pub(crate) slow_speed: Option<f64>,
    /// A robot stops at a step, wherever it is, for so many steps; can be given more than once
    #[arg(long, value_name = "ROBOT@STEP:STEPS")]
    pub(crate) stop: Vec<StopArg>,
    /// The chance that a robot's report does not come through, in each of the eight ticks of a step [default: 0]
    #[arg(long, value_name = "P", allow_negative_numbers = true, value_parser = lost)]
    pub(crate) lost_reports: Option<f64>,
    /// Turns take time, by the robot's turn rate
    #[arg(long)]
    pub(crate) turning: bool,
    /// Write every robot's program and the order in which each cell is passed
    #[arg(long, value_name = "FILE.json")]
    pub(crate) save_schedule: Option<PathBuf>,
}

impl DelayArgs {
    /// The first of these options that is given: a run is driven without them.
    pub(crate) fn given(&self) -> Option<&'static str> {
        let options = [
            ("--map", self.map.is_some()),
            ("--delay-chance", self.delay_chance.is_some()),
            ("--max-delay", self.max_delay.is_some()),
            ("--slow", self.slow.is_some()),
            ("--stop", !self.stop.is_empty()),
            ("--lost-reports", self.lost_reports.is_some()),
            ("--turning", self.turning),
            ("--save-schedule", self.save_schedule.is_some()),
        ];
        options.into_iter().find_map(|(name, given)| given.then_some(name))
    }
}

fn speed(text: &str) -> Result<f64, String> {
    super::number(text, 0.01, 1.0)
}

fn lost(text: &str) -> Result<f64, String> {
    super::number(text, 0.0, 0.99)
}

/// A stop, as a user writes it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct StopArg(pub(crate) Stop);

impl FromStr for StopArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parsed = || {
            let (robot, times) = text.split_once('@')?;
            let (from, steps) = times.split_once(':')?;
            let time = |text: &str| super::number(text.trim(), 0.0, 1e6).ok();
            Some(Stop { robot: robot.trim().parse().ok()?, from: time(from)?, steps: time(steps)? })
        };
        let help = "give a robot, the step at which it stops, and for how many, as 7@10:50";
        parsed().map(Self).ok_or_else(|| help.to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stops_are_read() {
        assert_eq!("7@10:50.5".parse(), Ok(StopArg(Stop { robot: 7, from: 10.0, steps: 50.5 })));
        for bad in ["", "7", "7@10", "7:10@5", "-1@2:3", "1@-2:3", "1@2:nan", "x@1:2", "1@2:inf", "1@2:"] {
            assert!(bad.parse::<StopArg>().is_err(), "{bad}");
        }
    }
}
