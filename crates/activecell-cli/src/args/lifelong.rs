//! The options of `activecell fleet` for runs without end.

use activecell::Moves;
use activecell_fleet::MAX_WINDOW;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Robots that get task after task. A problem of the League of Robot Runners in place of the map asks for such a run too.
#[derive(Debug, Args)]
#[command(next_help_heading = "Options for runs without end (or give a problem file .json as MAP)")]
pub(crate) struct LifelongArgs {
    /// The tasks, handed out in their order: a list of the League of Robot Runners, or .csv with the header `targets`
    #[arg(long, value_name = "FILE", conflicts_with = "generate")]
    pub(crate) tasks: Option<PathBuf>,
    /// Tasks by chance, on the floor that the robots can reach
    #[arg(long, value_enum)]
    pub(crate) generate: Option<GenerateArg>,
    /// Where the robots start: a list of the League, or .csv `agent id,row,col` [default: -n robots by chance]
    #[arg(long, value_name = "FILE")]
    pub(crate) agents: Option<PathBuf>,
    /// Steps to go; fewer if all tasks are done [default: 1000]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) steps: Option<u32>,
    /// Milliseconds to plan a step [default: 50; none with --step-work]
    #[arg(long, value_name = "MS", allow_negative_numbers = true, value_parser = milliseconds)]
    pub(crate) step_time: Option<f64>,
    /// Paths to look for in a step; the run is then the same on every machine
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub(crate) step_work: Option<u64>,
    /// How robots move
    #[arg(long, value_enum, default_value_t)]
    pub(crate) motion: MotionArg,
    /// Steps planned ahead, up to 30 [default: 20; 10 for more than 2000 robots]
    #[arg(long, value_name = "STEPS", value_parser = clap::value_parser!(u8).range(1..=MAX_WINDOW as i64))]
    pub(crate) window: Option<u8>,
    /// Which task a robot gets
    #[arg(long, value_enum, default_value_t)]
    pub(crate) assignment: AssignmentArg,
}

impl LifelongArgs {
    /// The first of these options that is given: a plan with an end is made without them.
    pub(crate) fn given(&self) -> Option<&'static str> {
        let options = [
            ("--agents", self.agents.is_some()),
            ("--steps", self.steps.is_some()),
            ("--step-time", self.step_time.is_some()),
            ("--step-work", self.step_work.is_some()),
            ("--window", self.window.is_some()),
            ("--assignment", self.assignment != AssignmentArg::default()),
        ];
        options.into_iter().find_map(|(name, given)| given.then_some(name))
    }
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub(crate) enum GenerateArg {
    /// One cell to visit
    Visits,
    /// A pickup, then a delivery
    Deliveries,
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum MotionArg {
    /// To any neighbouring cell in a step
    #[default]
    Omni,
    /// Forward, or a turn by one direction of the mosaic, in a step
    Turning,
}

impl MotionArg {
    /// As the user writes it.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Omni => "omni",
            Self::Turning => "turning",
        }
    }
}

impl From<MotionArg> for Moves {
    fn from(arg: MotionArg) -> Self {
        match arg {
            MotionArg::Omni => Self::Omni,
            MotionArg::Turning => Self::Turning,
        }
    }
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum AssignmentArg {
    /// The next one
    #[default]
    InOrder,
    /// Of the next ones, as many as the problem reveals (else 1.5 a robot), the one that begins nearest
    Nearest,
}

fn milliseconds(text: &str) -> Result<f64, String> {
    super::number(text, 0.1, 1e6)
}
