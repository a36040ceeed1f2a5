//! The options of groups whose robots are not all one cell, or that share the floor with strangers.

use clap::Args;
use std::convert::Infallible;
use std::path::PathBuf;
use std::str::FromStr;

/// What else a plan has to keep.
#[derive(Debug, Args)]
pub(crate) struct GroupArgs {
    /// The radius of each robot in cells, or of all: 0 covers one cell, 1 its neighbours too; or a file of them
    #[arg(long, value_name = "R,R,…|FILE")]
    pub(crate) sizes: Option<SizesArg>,
    /// The least distance between robots in cells: 1 if they may touch, 2 if a free cell must be between them
    #[arg(long, value_name = "CELLS", value_parser = clap::value_parser!(u32).range(1..=16384))]
    pub(crate) distance: Option<u32>,
    /// What is no member of the group: cells closed for some steps, and objects seen
    #[arg(long, value_name = "FILE.json")]
    pub(crate) strangers: Option<PathBuf>,
}

/// Radii, or where they stand.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum SizesArg {
    List(String),
    File(PathBuf),
}

impl FromStr for SizesArg {
    type Err = Infallible;

    fn from_str(text: &str) -> Result<Self, Infallible> {
        let is_list = text.chars().all(|c| c.is_ascii_digit() || c == ',' || c == ' ');
        Ok(if is_list { Self::List(text.to_owned()) } else { Self::File(text.into()) })
    }
}
