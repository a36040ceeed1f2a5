//! The options of `activecell simulate`.

use super::DelayArgs;
use activecell::Cell;
use activecell::sim::Visit;
use clap::{Args, ValueEnum};
use std::path::PathBuf;
use std::str::FromStr;

/// Drive a saved run in a world with errors, or execute a plan with delays
///
/// The world is the run's map unless --missing, --world or --appear say otherwise. In the mode offline the robot
/// drives the program M and asks no sensor; in the mode task its sensors correct the way, find what the map does not
/// tell, and the run's rule leads on from there. The same seed gives the same result on any number of threads.
///
/// A plan for many robots (of `fleet --save`, or of another MAPF tool) is executed with delays: each robot is let into its
/// next cell by what the others report, so that whoever is late, none collide and all arrive.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples (maps/office-run.json is what `activecell route maps/office.yaml … --save` wrote):
  activecell simulate maps/office-run.json --trials 1000
  activecell simulate maps/office-run.json --mode task --missing 0.1 --picture way.svg --picture way.gif
  activecell simulate maps/office-run.json --mode task --robot maps/quick.toml --movers 3 --picture way.gif
  activecell simulate maps/office-run.json --mode task --appear 7,13@10..40 --save trace.json
  activecell simulate maps/warehouse-plan.json --delay-chance 0.1 --max-delay 10 --stop 3@5:50 --trials 100")]
pub(crate) struct SimulateArgs {
    /// A file of `route --save`, or a plan
    #[arg(value_name = "RUN.json|PLAN")]
    pub(crate) run: PathBuf,
    /// Another robot than the run's; the robots of a plan [default there: bodies of 0.3 cells, 0.2 on hexagons]
    #[arg(long, value_name = "FILE.toml")]
    pub(crate) robot: Option<PathBuf>,
    /// The program alone, or corrected by sensors
    #[arg(long, value_enum, default_value_t)]
    pub(crate) mode: ModeArg,
    /// How often it is driven [default: 1000 offline, 1 task, 1 of a plan]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(crate) trials: Option<u32>,
    /// Chance
    #[arg(long, default_value_t = 1)]
    pub(crate) seed: u64,
    /// Threads [default: one for each processor]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    pub(crate) threads: Option<u16>,
    /// The share of the world's obstacles, 0 to 0.9, that the run's map misses; they are put on free cells by chance
    #[arg(long, value_name = "SHARE", conflicts_with = "world", allow_negative_numbers = true, value_parser = missing)]
    pub(crate) missing: Option<f64>,
    /// The world as it really is: a map of the same columns and rows
    #[arg(long, value_name = "MAP")]
    pub(crate) world: Option<PathBuf>,
    /// An obstacle that stands in a cell from one second to another; can be given more than once
    #[arg(long, value_name = "X,Y@FROM..TO")]
    pub(crate) appear: Vec<Appear>,
    /// So many walkers go about by chance on the free cells, and the robot plans past them (with --mode task)
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=100))]
    pub(crate) movers: u32,
    /// No walker is faster
    #[arg(long, value_name = "MPS", default_value_t = 0.3, allow_negative_numbers = true, value_parser = mover_speed)]
    pub(crate) mover_speed: f64,
    /// Write what the first trial did, and where every trial ended
    #[arg(long, value_name = "TRACE.json")]
    pub(crate) save: Option<PathBuf>,
    /// Draw it; .gif shows the first trial's robot move; can be given more than once
    #[arg(long, value_name = "FILE.svg|.png|.gif")]
    pub(crate) picture: Vec<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) delays: DelayArgs,
}

impl SimulateArgs {
    /// The first option that is given and that only runs have.
    pub(crate) fn given_for_runs(&self) -> Option<&'static str> {
        let options = [
            ("--mode", self.mode != ModeArg::default()),
            ("--missing", self.missing.is_some()),
            ("--world", self.world.is_some()),
            ("--appear", !self.appear.is_empty()),
            ("--movers", self.movers > 0),
            ("--save", self.save.is_some()),
            ("--picture", !self.picture.is_empty()),
        ];
        options.into_iter().find_map(|(name, given)| given.then_some(name))
    }
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum ModeArg {
    /// The program M, no sensor asked
    #[default]
    Offline,
    /// Corrected by the control unit and the sensors
    Task,
}

fn missing(text: &str) -> Result<f64, String> {
    super::number(text, 0.0, 0.9)
}

fn mover_speed(text: &str) -> Result<f64, String> {
    super::number(text, 0.01, 10.0)
}

/// An obstacle for a while, as a user writes it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Appear(pub(crate) Visit);

impl FromStr for Appear {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parsed = || {
            let (cell, times) = text.split_once('@')?;
            let ((x, y), (from, to)) = (cell.split_once(',')?, times.split_once("..")?);
            let cell = Cell::new(x.trim().parse().ok()?, y.trim().parse().ok()?);
            let (from_s, to_s): (f64, f64) = (from.trim().parse().ok()?, to.trim().parse().ok()?);
            (from_s >= 0.0 && from_s < to_s).then_some(Visit { cell, from_s, to_s })
        };
        let help = "give a cell and two times in seconds, as 3,4@10..60";
        parsed().map(Self).ok_or_else(|| help.to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn obstacles_for_a_while_are_read() {
        let visit = Visit { cell: Cell::new(3, 4), from_s: 10.0, to_s: 60.5 };
        assert_eq!("3,4@10..60.5".parse(), Ok(Appear(visit)));
        for bad in ["", "3,4", "3,4@5", "3,4@5..5", "3,4@-1..5", "3@1..2", "3,4@nan..5", "3,4@1..x"] {
            assert!(bad.parse::<Appear>().is_err(), "{bad}");
        }
    }
}
