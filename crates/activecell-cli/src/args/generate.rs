//! `activecell generate`.

use super::{MapArgs, Place};
use activecell_codegen::Language;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Write the navigator as C firmware or as hardware, proven equal to what runs here
///
/// With a MAP: everything that one robot needs on it (firmware, or the windowed navigator, the fabric and the program player
/// with their test benches), a README and a Makefile. Without: the rule and the control unit alone, for both mosaics.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  activecell generate verilog maps/office.yaml --cell 0.5 --from 1.2m,1.5m --to 19m,11m -o navigator
  activecell generate c maps/warehouse.map -o firmware
  activecell generate vhdl -o rule")]
pub(crate) struct GenerateArgs {
    /// The language
    #[arg(value_enum)]
    pub(crate) language: LanguageArg,
    #[command(flatten)]
    pub(crate) map: Option<MapArgs>,
    /// The folder to write, made if it is not there; of other files in it only those of an earlier generation are removed
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,
    /// Where the program begins [default: one end of a long way over the map]
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true, requires_all = ["path", "to"])]
    pub(crate) from: Option<Place>,
    /// Where the program ends [default: the other end]
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true, requires_all = ["path", "from"])]
    pub(crate) to: Option<Place>,
    /// The robot that plays the program: its wheels and encoders
    #[arg(long, value_name = "FILE.toml", requires = "path")]
    pub(crate) robot: Option<PathBuf>,
    /// Wire the map of the fabric in: less hardware, but another map needs another bit stream
    #[arg(long, requires = "path")]
    pub(crate) fixed_map: bool,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}

/// The languages by their names on the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum LanguageArg {
    /// C99, without heap and library
    C,
    /// Verilog-2005
    Verilog,
    /// VHDL-93
    Vhdl,
}

impl From<LanguageArg> for Language {
    fn from(language: LanguageArg) -> Self {
        match language {
            LanguageArg::C => Self::C,
            LanguageArg::Verilog => Self::Verilog,
            LanguageArg::Vhdl => Self::Vhdl,
        }
    }
}
