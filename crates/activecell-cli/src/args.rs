//! The command line: every option and its help.

use activecell::{Cell, Dir, Lattice, Map, PointM, Rule};
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;
use std::str::FromStr;

const EXAMPLES: &str = "\
Examples:
  activecell route maps/beyond.txt --from S --to F --rule published
  activecell route maps/office.yaml --cell 0.5 --from 1.5m,1.5m --to 18m,10m --picture route.svg
  activecell route maps/office.yaml --cell 0.5 --lattice hex --from 3,3 --to 30,5 --json
  activecell scen arena2.map.scen --map arena2.map
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
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub(crate) quiet: bool,
    /// More notes on stderr
    #[arg(short, long, global = true)]
    pub(crate) verbose: bool,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Route(RouteArgs),
    Scen(ScenArgs),
    Info(InfoArgs),
    Convert(ConvertArgs),
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
    /// The floor: a ROS .yaml, a MovingAI .map, an image .png or .pgm, a text .txt
    #[arg(value_name = "MAP")]
    pub(crate) path: PathBuf,
    /// The mosaic
    #[arg(long, value_enum, default_value_t)]
    pub(crate) lattice: LatticeArg,
    /// Re-tile the floor to cells of this many metres; without it each pixel or character is one cell
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    pub(crate) cell: Option<f64>,
    /// The radius in metres of the robot that must fit, with --cell [default: the robot file's, else half a cell]
    #[arg(long, value_name = "M", requires = "cell", allow_negative_numbers = true)]
    pub(crate) radius: Option<f64>,
    /// The share of a cell that may be occupied, 0 to 1, with --cell; at 1 only the robot's own disc counts
    #[arg(long, value_name = "SHARE", requires = "cell", default_value_t = 1.0)]
    pub(crate) tolerance: f64,
    /// Metres per pixel or character of a map that does not say [default: 0.05 for images, 1 for .map and .txt]
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
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
  activecell route maps/office.yaml --cell 0.5 --from 1.5m,1.5m --to 18m,10m --picture route.png --picture route.gif
  activecell route maps/office.yaml --cell 0.4 --lattice hex --from 2,2 --to 40,8 --robot robot.toml --save run.json")]
pub(crate) struct RouteArgs {
    #[command(flatten)]
    pub(crate) map: MapArgs,
    /// Where the robot is
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true)]
    pub(crate) from: Place,
    /// Where it should go
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true)]
    pub(crate) to: Place,
    /// The rule that moves the active cell
    #[arg(long, value_enum, default_value_t)]
    pub(crate) rule: RuleArg,
    /// Keep this many metres from obstacles where there is room for it
    ///
    /// Measured between centres of cells, so that a cell beside a wall has one cell's size. If the way has narrow
    /// places the route takes the widest of them, and keeps off walls elsewhere (rule wave).
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    pub(crate) clearance: Option<f64>,
    /// The robot; without it a small one with wheels of 0.2 m perimeter
    #[arg(long, value_name = "FILE.toml")]
    pub(crate) robot: Option<PathBuf>,
    /// Where the robot faces: N, E, S, W; on hexagons NE, E, SE, SW, W, NW [default: along its first run]
    #[arg(long, value_name = "DIR")]
    pub(crate) heading: Option<String>,
    /// Give up after this many steps (rule learning)
    #[arg(long, value_name = "N", default_value_t = 10_000_000)]
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
    #[arg(long, value_name = "N", default_value_t = 10_000_000)]
    pub(crate) max_steps: usize,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}

/// Describe a map: size, frame, free cells, separate regions
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  activecell info maps/office.yaml --cell 0.5 --lattice hex")]
pub(crate) struct InfoArgs {
    #[command(flatten)]
    pub(crate) map: MapArgs,
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

/// Print the rules as tables, or how often they arrive
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  activecell table rule --lattice hex
  activecell table rule --format csv
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

/// A place as a user names it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Place {
    Cell(Cell),
    Metres(PointM),
    Mark(char),
}

impl FromStr for Place {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let help = "give a cell as X,Y, a point as 1.5m,2m, or the letter of a named cell";
        let mut letters = text.chars();
        if let (Some(letter), None) = (letters.next(), letters.next())
            && letter.is_ascii_alphabetic()
        {
            return Ok(Self::Mark(letter));
        }
        let (x, y) = text.split_once(',').ok_or(help)?;
        let (x, y) = (x.trim(), y.trim());
        if let (Some(x), Some(y)) = (x.strip_suffix('m'), y.strip_suffix('m')) {
            let metres = |text: &str| text.trim().parse().ok().filter(|value: &f64| value.is_finite());
            return Ok(Self::Metres([metres(x).ok_or(help)?, metres(y).ok_or(help)?]));
        }
        let cell = |text: &str| text.parse().map_err(|_| help.to_owned());
        Ok(Self::Cell(Cell::new(cell(x)?, cell(y)?)))
    }
}

impl Place {
    /// The cell of the map that is meant.
    pub(crate) fn on(self, map: &Map) -> anyhow::Result<Cell> {
        match self {
            Self::Cell(cell) => Ok(cell),
            Self::Metres(point) => {
                let cell = map.cell_at_m(point);
                anyhow::ensure!(
                    map.contains(cell),
                    "the point {} m, {} m is outside the map, which {}",
                    point[0],
                    point[1],
                    extent(map)
                );
                Ok(cell)
            }
            Self::Mark(letter) => map.mark(letter).ok_or_else(|| {
                let names: Vec<String> = map.marks().iter().map(|mark| mark.0.to_string()).collect();
                let known = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
                anyhow::anyhow!("the map names no cell `{letter}`; it names: {known}")
            }),
        }
    }
}

/// From where to where a map reaches, in metres.
fn extent(map: &Map) -> String {
    let frame = map.frame();
    let [w, h] = map.size_m();
    let turned =
        if frame.yaw_rad == 0.0 { String::new() } else { format!(", turned by {} rad", frame.yaw_rad) };
    let [x, y] = frame.origin_m;
    format!("begins at {x} m, {y} m and is {w:.3} m wide and {h:.3} m high{turned}")
}

/// The direction of that name.
pub(crate) fn heading(lattice: Lattice, name: &str) -> anyhow::Result<Dir> {
    lattice.dir_named(name).ok_or_else(|| {
        let names: Vec<&str> = lattice.dirs().map(|dir| lattice.dir_name(dir)).collect();
        anyhow::anyhow!(
            "--heading {name}: no such direction on this lattice; use one of {}",
            names.join(", ")
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn places_are_cells_metres_or_marks() {
        assert_eq!("3,4".parse(), Ok(Place::Cell(Cell::new(3, 4))));
        assert_eq!("-3, 4".parse(), Ok(Place::Cell(Cell::new(-3, 4))));
        assert_eq!("1.5m,-2m".parse(), Ok(Place::Metres([1.5, -2.0])));
        assert_eq!("S".parse(), Ok(Place::Mark('S')));
        for bad in ["", "3", "3,", "3,4m", "nanm,1m", "1e999m,1m", "3.5,1", "99999999999,1", "Ä"] {
            assert!(bad.parse::<Place>().is_err(), "{bad}");
        }
    }
}
