//! The options of uneven ground.

use activecell::Ground;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// The heights of the ground under a map.
#[derive(Debug, Args)]
pub(crate) struct GroundArgs {
    /// The ground's heights: a GeoTIFF .tif, an ESRI grid .asc, a gray .png, a NumPy .npy or .npz
    ///
    /// A file that says in metres where it lies is laid there, in the map's frame; any other over the map, corner to
    /// corner. Steps too steep for the robot (`slopes` in its file) are avoided, and lengths are those of the ground.
    #[arg(long, value_name = "FILE")]
    pub(crate) elevation: Option<PathBuf>,
    /// Metres that a value of 1 in the elevation is worth [default: 1; a .png needs it]
    #[arg(long, value_name = "M", allow_negative_numbers = true, value_parser = metres)]
    pub(crate) height_scale: Option<f64>,
    /// The height of the value 0 in the elevation, in metres
    #[arg(long, value_name = "M", default_value_t = 0.0, allow_negative_numbers = true, value_parser = metres)]
    pub(crate) height_offset: f64,
    /// What counts as the length of a step over uneven ground
    #[arg(long, value_enum, default_value_t)]
    pub(crate) ground: GroundArg,
}

#[derive(Debug, Clone, Copy, Default, ValueEnum)]
pub(crate) enum GroundArg {
    /// The straight line from centre to centre
    Segments,
    /// The way over the interpolated surface
    #[default]
    Surface,
}

impl From<GroundArg> for Ground {
    fn from(arg: GroundArg) -> Self {
        match arg {
            GroundArg::Segments => Self::Segments,
            GroundArg::Surface => Self::Surface,
        }
    }
}

fn metres(text: &str) -> Result<f64, String> {
    super::number(text, -1e6, 1e6)
}
