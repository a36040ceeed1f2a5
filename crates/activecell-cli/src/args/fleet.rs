//! The options of `activecell fleet` and `activecell check`.

use super::{GroupArgs, LifelongArgs, MapArgs};
use clap::Args;
use std::path::PathBuf;

/// Plan for many robots at once
///
/// Every robot gets from its start to its target, never two in a cell, never two swapping cells. Prints the sum of costs
/// (the steps of each robot until it rests at its target for good) and the makespan (the steps until the last one
/// rests). The first plan is there soon; until the limit it only gets better. Every plan is checked by rules that know no
/// planner.
///
/// With --tasks or --generate, or a problem of the League of Robot Runners (.json) in place of MAP, robots get task after
/// task without end, and each step is planned in bounded time; prints how many tasks are done a step.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  activecell fleet maps/warehouse.map --scen maps/warehouse.scen --time-limit 1 --save plan.txt
  activecell fleet maps/warehouse.map --scen maps/warehouse.scen --robots 10 --first --lattice hex
  activecell fleet maps/office.yaml --cell 0.5 --random --robots 20 --first --save plan.json
  activecell fleet maps/warehouse.map --random --robots 6 --sizes 1,0,0,0,0,0 --strangers maps/strangers.json --first
  activecell fleet maps/warehouse.map --generate deliveries -n 40 --motion turning --steps 50 --step-time 5

Exit codes: 0 all robots arrive, 3 there is no plan, or none was found within the limits.")]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of the command line")]
pub(crate) struct FleetArgs {
    #[command(flatten)]
    pub(crate) map: MapArgs,
    /// Starts and targets: the rows of a MovingAI scenario
    #[arg(long, value_name = "FILE.scen")]
    pub(crate) scen: Option<PathBuf>,
    /// Starts and targets by chance, on the floor's largest region
    #[arg(long, conflicts_with = "scen", requires = "robots")]
    pub(crate) random: bool,
    /// How many robots [default: a robot a row of the scenario]
    #[arg(short = 'n', long, value_name = "N")]
    pub(crate) robots: Option<usize>,
    /// Give each target to whoever is best placed: of all ways to share them out, one with the least sum of distances
    #[arg(long)]
    pub(crate) assign: bool,
    #[command(flatten)]
    pub(crate) group: GroupArgs,
    /// Seconds to look for better plans [default: 10; none with --step-limit]
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = seconds)]
    pub(crate) time_limit: Option<f64>,
    /// Steps of the search; the plan is then the same on every machine
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub(crate) step_limit: Option<u64>,
    /// Stop at the first plan
    #[arg(long)]
    pub(crate) first: bool,
    /// Chance
    #[arg(long, default_value_t = 1)]
    pub(crate) seed: u64,
    /// Threads [default: one for each processor]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    pub(crate) threads: Option<u16>,
    /// Write the plan: .txt as MAPF tools share it, .json with the map, or .paths; can be given more than once
    #[arg(long, value_name = "PLAN.txt|.json|.paths")]
    pub(crate) save: Vec<PathBuf>,
    /// Draw the plan: .svg and .png show the ways, or of many robots the traffic; .gif shows them moving. Can be given more than once
    #[arg(long, value_name = "FILE.svg|.png|.gif")]
    pub(crate) picture: Vec<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) lifelong: LifelongArgs,
}

/// Check a plan for many robots, whoever made it
///
/// Knows no planner: every step must lead to a neighbouring free cell or nowhere, never two robots in a cell, never two
/// that swap, and each must get from its start to its target. Sizes, distance and closed cells are those that the plan
/// states, unless an option says otherwise. Tells the first fault with its step, robots and cells.
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  activecell check maps/warehouse.map maps/warehouse-plan.json --scen maps/warehouse.scen

Exit codes: 0 the plan is sound, 1 it is not.")]
pub(crate) struct CheckArgs {
    #[command(flatten)]
    pub(crate) map: MapArgs,
    /// The plan: text as MAPF tools share it, .json of `fleet --save`, or paths as of MAPF-LNS2
    #[arg(value_name = "PLAN")]
    pub(crate) plan: PathBuf,
    /// Starts and targets from a MovingAI scenario, a row for each robot [default: those that the plan states]
    #[arg(long, value_name = "FILE.scen")]
    pub(crate) scen: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) group: GroupArgs,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}

fn seconds(text: &str) -> Result<f64, String> {
    super::number(text, 0.001, 1e6)
}
