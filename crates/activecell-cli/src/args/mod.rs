//! The command line: every option and its help.

mod calibrate;
mod delays;
mod fleet;
mod generate;
mod ground;
mod group;
mod lifelong;
mod place;
mod simulate;

use activecell::{Lattice, Rule};
pub(crate) use calibrate::CalibrateArgs;
use clap::{Args, CommandFactory, FromArgMatches, Parser, Subcommand, ValueEnum};
pub(crate) use delays::DelayArgs;
pub(crate) use fleet::{CheckArgs, FleetArgs};
pub(crate) use generate::GenerateArgs;
pub(crate) use ground::GroundArgs;
pub(crate) use group::{GroupArgs, SizesArg};
pub(crate) use lifelong::{AssignmentArg, GenerateArg, LifelongArgs, MotionArg};
pub(crate) use place::{Place, heading};
pub(crate) use simulate::{ModeArg, SimulateArgs};
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  activecell route maps/beyond.txt --from S --to F --rule published
  activecell route maps/office.yaml --cell 0.5 --radius 0.2 --from 1.2m,1.5m --to 19m,11m --picture route.svg
  activecell fleet maps/warehouse.map --scen maps/warehouse.scen --time-limit 1
  activecell info maps/office.yaml --cell 0.5 --radius 0.2 --lattice hex
  activecell table success

Exit codes: 0 done, 1 failed, 2 wrong arguments, 3 done but the target was not reached.";

/// Navigation for robots that must find their own way: a floor plan goes in, a route and the wheel program that
/// drives it come out.
#[derive(Debug, Parser)]
#[command(name = "activecell", version, after_help = EXAMPLES)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
    /// No progress and no notes on stderr
    #[arg(short, long, global = true, conflicts_with = "verbose", display_order = 990)]
    pub(crate) quiet: bool,
    /// More notes on stderr
    #[arg(short, long, global = true, display_order = 991)]
    pub(crate) verbose: bool,
}

impl Cli {
    /// The arguments that the command was given; ends it with help or a message otherwise.
    pub(crate) fn read() -> Self {
        // Of all commands with a map only this one can do without.
        let mut command = Self::command()
            .mut_subcommand("generate", |command| command.mut_arg("path", |map| map.required(false)));
        let read = Self::from_arg_matches(&command.get_matches_mut());
        read.unwrap_or_else(|_| {
            let what = "options of the map need a MAP";
            command.error(clap::error::ErrorKind::MissingRequiredArgument, what).exit()
        })
    }
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Route(RouteArgs),
    Simulate(SimulateArgs),
    Fleet(FleetArgs),
    Check(CheckArgs),
    Scen(ScenArgs),
    Info(InfoArgs),
    Convert(ConvertArgs),
    Embed(EmbedArgs),
    Generate(GenerateArgs),
    Calibrate(CalibrateArgs),
    Table(TableArgs),
    /// Print a completion script for a shell
    ///
    /// For bash: activecell completions bash > ~/.local/share/bash-completion/completions/activecell
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
}

/// How to read a map, and the cells to cover it with.
#[derive(Debug, Args)]
pub(crate) struct MapArgs {
    /// The floor: a ROS .yaml, a MovingAI .map, an image .png or .pgm, a text .txt; or ground alone: .asc, .tif, .npy, .npz
    #[arg(value_name = "MAP")]
    pub(crate) path: PathBuf,
    /// The mosaic
    #[arg(long, value_enum, default_value_t)]
    pub(crate) lattice: LatticeArg,
    /// Re-tile the floor to cells of this many metres; without it each pixel or character is one cell
    #[arg(long, value_name = "M", allow_negative_numbers = true, value_parser = size_m)]
    pub(crate) cell: Option<f64>,
    /// The radius in metres of the robot that must fit, with --cell [default: the robot file's, else half a cell]
    #[arg(long, value_name = "M", requires = "cell", allow_negative_numbers = true, value_parser = radius_m)]
    pub(crate) radius: Option<f64>,
    /// The share of a cell that may be occupied, 0 to 1, with --cell; at 1 only the robot's own disc counts
    #[arg(long, value_name = "SHARE", requires = "cell", default_value_t = 1.0, allow_negative_numbers = true, value_parser = share)]
    pub(crate) tolerance: f64,
    /// Metres per pixel or character of a map that does not say [default: 0.05 for images, 1 for .map and .txt]
    #[arg(long, value_name = "M", allow_negative_numbers = true, value_parser = size_m)]
    pub(crate) resolution: Option<f64>,
    /// What unknown pixels of an image are
    #[arg(long, value_enum, default_value_t)]
    pub(crate) unknown: UnknownArg,
    /// Whose reading of images to follow: ROS 2 Humble and before, or Jazzy and after
    #[arg(long, value_enum, default_value_t)]
    pub(crate) map_rules: RulesArg,
    /// From which occupancy on (1 to 100) a pixel is an obstacle, in the modes scale and raw
    #[arg(long, value_name = "PERCENT", default_value_t = 65, value_parser = clap::value_parser!(u8).range(1..=100))]
    pub(crate) occupied_from: u8,
}

/// Find a route and the program that drives it
///
/// Prints how it ended and the program M: wheel revolutions to each turn. X,Y is a cell (column, row from the
/// top); 1.5m,2m a point in metres in the map's frame (x right, y up); a letter is a cell that a text map names.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  activecell route maps/detour.txt --from S --to F
  activecell route maps/office.yaml --cell 0.5 --radius 0.2 --from 1.2m,1.5m --to 19m,11m --picture route.gif
  activecell route maps/office.yaml --cell 0.4 --lattice hex --from 2m,6m --to 19m,11m --robot maps/robot.toml --save run.json
  activecell route maps/office.yaml --cell 0.5 --from 1.2m,1.5m --to 19m,11m --robot maps/robot.toml --prefer trusted --trust 0.9")]
pub(crate) struct RouteArgs {
    #[command(flatten)]
    pub(crate) map: MapArgs,
    #[command(flatten)]
    pub(crate) ground: GroundArgs,
    /// Where the robot is
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true)]
    pub(crate) from: Place,
    /// Where it should go
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true)]
    pub(crate) to: Place,
    /// If there is no way to the target, go to the cell nearest to it that can be reached
    #[arg(long)]
    pub(crate) nearest: bool,
    /// The rule that moves the active cell
    #[arg(long, value_enum, default_value_t)]
    pub(crate) rule: RuleArg,
    /// Keep this many metres from obstacles where there is room for it
    ///
    /// Measured between centres of cells, so that a cell beside a wall has one cell's size. If the way has narrow
    /// places the route takes the widest of them, and keeps off walls elsewhere (rule wave).
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    pub(crate) clearance: Option<f64>,
    /// The robot, for its program and its certificate; without it a small one with wheels of 0.2 m perimeter
    #[arg(long, value_name = "FILE.toml")]
    pub(crate) robot: Option<PathBuf>,
    /// Which of the routes to take (rule wave)
    #[arg(long, value_enum, default_value_t, requires_if("trusted", "robot"))]
    pub(crate) prefer: PreferArg,
    /// The probability of being in its cell below which the robot is not trusted, 0 to 1
    #[arg(long, value_name = "P", requires = "robot", default_value_t = 0.95, allow_negative_numbers = true, value_parser = share)]
    pub(crate) trust: f64,
    /// Where the robot faces: N, E, S, W; on hexagons NE, E, SE, SW, W, NW [default: along its first run]
    #[arg(long, value_name = "DIR")]
    pub(crate) heading: Option<String>,
    /// Give up after this many steps (rule learning)
    #[arg(long, value_name = "N", default_value_t = 100_000_000)]
    pub(crate) max_steps: usize,
    /// Write map, robot, route and program
    #[arg(long, value_name = "RUN.json")]
    pub(crate) save: Option<PathBuf>,
    /// Draw the route; .gif shows the wave and the robot move; can be given more than once
    #[arg(long, value_name = "FILE.svg|.png|.gif")]
    pub(crate) picture: Vec<PathBuf>,
    /// Whether to draw a small map in the terminal
    #[arg(long, value_enum, default_value_t)]
    pub(crate) draw: DrawArg,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}

/// Route every task of a MovingAI scenario
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  activecell scen arena2.map.scen --map arena2.map --lattice hex --json")]
pub(crate) struct ScenArgs {
    /// The scenario
    #[arg(value_name = "FILE.scen")]
    pub(crate) scen: PathBuf,
    /// The map [default: the scenario's own, looked for beside the scenario]
    #[arg(long)]
    pub(crate) map: Option<PathBuf>,
    /// The mosaic
    #[arg(long, value_enum, default_value_t)]
    pub(crate) lattice: LatticeArg,
    /// The rule that moves the active cell
    #[arg(long, value_enum, default_value_t)]
    pub(crate) rule: RuleArg,
    /// Give up after this many steps (rule learning)
    #[arg(long, value_name = "N", default_value_t = 100_000_000)]
    pub(crate) max_steps: usize,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}

/// Describe a map: size, frame, free cells, separate regions; or an embedded map (.acm)
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  activecell info maps/office.yaml --cell 0.5 --lattice hex")]
pub(crate) struct InfoArgs {
    #[command(flatten)]
    pub(crate) map: MapArgs,
    #[command(flatten)]
    pub(crate) ground: GroundArgs,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}

/// Write a map in another format, re-tiled if --cell is given
///
/// OUT is .yaml (with a .pgm beside it), .pgm, .png, .map, .txt, or .svg for a picture with a scale.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  activecell convert maps/office.yaml office.map
  activecell convert maps/office.yaml cells.txt --cell 0.5")]
pub(crate) struct ConvertArgs {
    #[command(flatten)]
    pub(crate) map: MapArgs,
    /// The file to write
    pub(crate) out: PathBuf,
}

/// Make an embedded map, in which the next move is looked up instead of searched
///
/// With --to it holds a plane of directions for each of these targets; without, a compressed table of first moves
/// from every free cell to every other, whose build time grows with the square of their number.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  activecell embed maps/office.yaml --cell 0.5 -o office.acm
  activecell embed maps/office.yaml --cell 0.5 --radius 0.2 -o docks.acm --to 1.2m,1.5m --to 19m,11m
  activecell info office.acm")]
pub(crate) struct EmbedArgs {
    #[command(flatten)]
    pub(crate) map: MapArgs,
    /// The file to write
    #[arg(short, long, value_name = "FILE.acm")]
    pub(crate) output: PathBuf,
    /// A target; can be given more than once
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true)]
    pub(crate) to: Vec<Place>,
    /// Refuse a table of more free cells than this
    #[arg(long, value_name = "CELLS", default_value_t = 200_000)]
    pub(crate) limit: usize,
    /// Threads that build the table; the file is the same [default: one for each processor]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    pub(crate) threads: Option<u16>,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}

/// Print the rules as tables, or how often they arrive
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  activecell table rule --lattice hex
  activecell table rule --format csv
  activecell table control
  activecell table success --size 32 --pairs 400")]
pub(crate) struct TableArgs {
    #[command(subcommand)]
    pub(crate) table: TableKind,
}

#[derive(Debug, Subcommand)]
pub(crate) enum TableKind {
    /// The published rule: its truth tables and the order of every sector
    Rule {
        /// The mosaic
        #[arg(long, value_enum, default_value_t)]
        lattice: LatticeArg,
        /// The form
        #[arg(long, value_enum, default_value_t)]
        format: TableFormat,
    },
    /// The control unit: its outputs, how it picks a motion, and all 6 × 256 entries
    Control {
        /// The form; csv and json list every entry, markdown shows them as grids
        #[arg(long, value_enum, default_value_t)]
        format: TableFormat,
        /// Draw the states and what leads from one to another
        #[arg(long, value_name = "FILE.svg")]
        picture: Option<PathBuf>,
    },
    /// How many reachable targets each rule reaches on random maps, and at what length
    Success {
        /// Columns and rows of each map
        #[arg(long, value_name = "N", default_value_t = 32, value_parser = clap::value_parser!(u32).range(2..=1024))]
        size: u32,
        /// Maps, each with one start and one reachable target, for each density
        #[arg(long, value_name = "N", default_value_t = 400, value_parser = clap::value_parser!(u32).range(1..))]
        pairs: u32,
        /// Chance
        #[arg(long, default_value_t = 1)]
        seed: u64,
        /// The form
        #[arg(long, value_enum, default_value_t)]
        format: TableFormat,
    },
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum TableFormat {
    /// A table for people
    #[default]
    Markdown,
    /// For spreadsheets
    Csv,
    /// For programs
    Json,
}

#[derive(Debug, Clone, Copy, Default, ValueEnum)]
pub(crate) enum LatticeArg {
    /// Squares, four neighbours
    #[default]
    Square,
    /// Hexagons, six neighbours
    Hex,
}

impl From<LatticeArg> for Lattice {
    fn from(arg: LatticeArg) -> Self {
        match arg {
            LatticeArg::Square => Self::Square,
            LatticeArg::Hex => Self::Hex,
        }
    }
}

#[derive(Debug, Clone, Copy, Default, ValueEnum)]
pub(crate) enum RuleArg {
    /// The paper's own: without memory, often trapped
    Published,
    /// With a level in each cell: always arrives, with detours
    Learning,
    /// The flood: always arrives, shortest, fewest turns
    #[default]
    Wave,
}

impl From<RuleArg> for Rule {
    fn from(arg: RuleArg) -> Self {
        match arg {
            RuleArg::Published => Self::Published,
            RuleArg::Learning => Self::Learning,
            RuleArg::Wave => Self::Wave,
        }
    }
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum PreferArg {
    /// Any shortest route
    Short,
    /// A shortest route with the fewest turns
    #[default]
    FewTurns,
    /// The route whose worst waypoint the robot reaches most surely, which may be longer
    Trusted,
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum UnknownArg {
    #[default]
    Obstacle,
    Free,
}

#[derive(Debug, Clone, Copy, Default, ValueEnum)]
pub(crate) enum RulesArg {
    Humble,
    #[default]
    Jazzy,
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum DrawArg {
    /// If stdout is a terminal
    #[default]
    Auto,
    Always,
    Never,
}

/// A number in a range, or what it should be.
fn number(text: &str, low: f64, high: f64) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| "give a number".to_owned())?;
    if (low..=high).contains(&value) { Ok(value) } else { Err(format!("give a number from {low} to {high}")) }
}

fn size_m(text: &str) -> Result<f64, String> {
    number(text, 1e-6, 1e6)
}

fn radius_m(text: &str) -> Result<f64, String> {
    number(text, 0.0, 1e6)
}

fn share(text: &str) -> Result<f64, String> {
    number(text, 0.0, 1.0)
}

/// A mistake in the arguments that only shows once the map is known.
#[derive(Debug)]
pub(crate) struct WrongArgument(pub(crate) String);

impl std::fmt::Display for WrongArgument {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for WrongArgument {}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    /// The examples of the help texts that need no other files.
    #[test]
    fn the_examples_of_the_help_run() {
        let project = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
        let folder = std::env::temp_dir().join(format!("activecell-examples-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let mut cli = Cli::command().term_width(400);
        let mut helps = vec![cli.render_long_help().to_string()];
        helps.extend(
            cli.get_subcommands_mut().map(|sub| sub.clone().term_width(400).render_long_help().to_string()),
        );
        let text = helps.join("\n");
        let examples: Vec<&str> = text
            .lines()
            .map(str::trim)
            .filter(|line| {
                line.starts_with("activecell ") && (line.contains("maps/") || line.contains("logs/"))
            })
            .collect();
        for example in &examples {
            let words: Vec<&str> = example.split_whitespace().collect();
            let arguments = words.iter().enumerate().map(|(place, &word)| match word {
                output if place > 0 && words[place - 1] == "-o" => folder.join(output).display().to_string(),
                path if ["maps/", "logs/"].iter().any(|top| path.starts_with(top)) => {
                    format!("{project}/{path}")
                }
                file if file.contains('.') && !file.starts_with(|c: char| c.is_ascii_digit()) => {
                    folder.join(file).display().to_string()
                }
                other => other.to_owned(),
            });
            let cli = Cli::try_parse_from(arguments).unwrap_or_else(|error| panic!("{example}: {error}"));
            let terminal = crate::terminal::Terminal::new(true, false);
            let done = crate::commands::run(cli.command, &terminal);
            assert!(matches!(done, Ok(crate::commands::Done::Reached)), "{example}: {done:?}");
        }
        std::fs::remove_dir_all(&folder).unwrap();
        assert!(examples.len() >= 8, "{examples:?}");
    }
}
