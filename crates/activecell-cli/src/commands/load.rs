//! From the arguments to a map and a robot.

use super::relief;
use crate::args::{GroundArgs, MapArgs, RulesArg, UnknownArg};
use crate::terminal::Terminal;
use activecell::{Lattice, Map, Robot, Tiling};
use activecell_formats::files::{self, MapFormat, ReadOptions};
use activecell_formats::{robot, ros};
use std::path::Path;

/// A map as it was asked for.
pub(crate) struct Loaded {
    /// The cells.
    pub(crate) map: Map,
    /// The floor that they were made of, if it was re-tiled.
    pub(crate) floor: Option<Map>,
    /// The format of the file.
    pub(crate) format: MapFormat,
}

/// Reads the map and covers it with the cells that the arguments ask for.
pub(crate) fn map(args: &MapArgs, robot: Option<&Robot>, terminal: &Terminal) -> anyhow::Result<Loaded> {
    on_ground(args, None, robot, terminal)
}

/// As [`map`], on the ground that the arguments name, if they do.
pub(crate) fn on_ground(
    args: &MapArgs,
    ground: Option<&GroundArgs>,
    robot: Option<&Robot>,
    terminal: &Terminal,
) -> anyhow::Result<Loaded> {
    let _working = terminal.working(format!("reading {}", args.path.display()));
    let lattice = Lattice::from(args.lattice);
    // Re-tiling begins with squares.
    let first = if args.cell.is_some() { Lattice::Square } else { lattice };
    let (image, format) = if MapFormat::of(&args.path)? == MapFormat::Elevation {
        (relief::alone(args, ground, first, terminal)?, MapFormat::Elevation)
    } else {
        let (image, format) = files::read_map(&args.path, &options(args))?;
        // Hexagons do not lie where the pixels did: the ground goes under the cells that there are.
        (relief::under(image.on(first), ground, terminal)?, format)
    };
    let Some(cell_m) = args.cell else {
        let (width_m, cell_m) = (2.0 * robot.copied().unwrap_or_default().radius_m, image.frame().cell_m);
        if width_m > cell_m {
            terminal.note(&format!(
                "note: each pixel of {cell_m} m is a cell, and a robot of {width_m} m does not fit; --cell re-tiles the floor for it"
            ));
        }
        return Ok(Loaded { map: image, floor: None, format });
    };
    let radius_m = args.radius.or(robot.map(|robot| robot.radius_m)).unwrap_or(cell_m / 2.0);
    let tiling = Tiling { lattice, cell_m, radius_m, tolerance: args.tolerance };
    let tiled = image.retile(&tiling)?;
    terminal.detail(&format!(
        "re-tiled to {} x {} cells of {cell_m} m for a robot of radius {radius_m} m",
        tiled.width(),
        tiled.height()
    ));
    Ok(Loaded { map: tiled, floor: Some(image), format })
}

/// How the arguments say to read a map.
fn options(args: &MapArgs) -> ReadOptions {
    let rules = match args.map_rules {
        RulesArg::Humble => ros::Rules::Humble,
        RulesArg::Jazzy => ros::Rules::Jazzy,
    };
    let unknown_is_free = args.unknown == UnknownArg::Free;
    let reading = ros::Reading { rules, unknown_is_free, occupied_from: args.occupied_from };
    ReadOptions { reading, resolution_m: args.resolution, ..ReadOptions::default() }
}

/// The most bytes that a robot file may have.
const ROBOT_FILE_BYTES: u64 = 64 * 1024;

/// Reads a robot file.
pub(crate) fn robot(path: &Path) -> anyhow::Result<Robot> {
    Ok(robot_and_text(path)?.0)
}

/// Reads a robot file, and its text for one who will change it.
pub(crate) fn robot_and_text(path: &Path) -> anyhow::Result<(Robot, String)> {
    let bytes = files::read_bytes(path, ROBOT_FILE_BYTES)?;
    let robot = robot::read(&bytes).map_err(|error| error.in_file(path))?;
    Ok((robot, String::from_utf8_lossy(&bytes).into_owned()))
}
