//! From the arguments to the ground under a map.

use crate::args::{GroundArgs, MapArgs, WrongArgument};
use crate::terminal::Terminal;
use activecell::{Elevation, Ground, Lattice, Map};
use activecell_formats::elevation::{Georeference, HeightOptions, Relief};
use activecell_formats::files;
use std::path::Path;

/// A map of the ground alone: every cell with a height is free.
pub(crate) fn alone(
    args: &MapArgs,
    ground: Option<&GroundArgs>,
    lattice: Lattice,
    terminal: &Terminal,
) -> anyhow::Result<Map> {
    if let Some(second) = ground.and_then(|ground| ground.elevation.as_ref()) {
        return Err(WrongArgument(format!(
            "{} holds heights already; leave --elevation {} out, or name a floor plan as the map",
            args.path.display(),
            second.display()
        ))
        .into());
    }
    let Relief { elevation, georeference } =
        files::read_elevation(&args.path, &heights(ground, args.resolution))?;
    note_degrees(&args.path, &elevation, georeference, terminal);
    let cell_m = cell_m(elevation.posts().apart_m);
    Ok(Map::over(elevation, lattice, cell_m, kind(ground))?)
}

/// The cells of ground alone: its posts, or if these are further apart one way than the other, cells of about the
/// shorter distance, in three digits.
fn cell_m([across, down]: [f64; 2]) -> f64 {
    let shorter = across.min(down);
    if (across - down).abs() <= 1e-9 * across {
        return shorter;
    }
    let tens = 10f64.powi(2 - shorter.log10().floor() as i32);
    (shorter * tens).floor() / tens
}

/// The map with the ground that the arguments lay under it.
pub(crate) fn under(map: Map, ground: Option<&GroundArgs>, terminal: &Terminal) -> anyhow::Result<Map> {
    let Some(path) = ground.and_then(|ground| ground.elevation.as_ref()) else { return Ok(map) };
    let Relief { elevation, georeference } = files::read_elevation(path, &heights(ground, None))?;
    let elevation =
        if georeference == Georeference::Metres { elevation } else { elevation.laid_over(&map)? };
    let (area, floor) =
        (boxed(elevation.posts().corner_m, elevation.size_m()), boxed(map.frame().origin_m, map.size_m()));
    let free = map.free_cells();
    let map = map.elevated(elevation, kind(ground));
    let lost = free - map.free_cells();
    anyhow::ensure!(
        lost == 0 || map.free_cells() > 0,
        "{}: no free cell lies on this ground, which is at {area}, and the map at {floor}; heights that do not say where they are (.png, .npy) are laid over the map",
        path.display()
    );
    if lost > 0 {
        terminal
            .note(&format!("note: the height of {lost} free cells is not known; they count as obstacles"));
    }
    Ok(map)
}

fn kind(ground: Option<&GroundArgs>) -> Ground {
    ground.map_or(Ground::default(), |ground| ground.ground.into())
}

fn heights(ground: Option<&GroundArgs>, apart_m: Option<f64>) -> HeightOptions {
    HeightOptions {
        scale: ground.and_then(|ground| ground.height_scale),
        offset_m: ground.map_or(0.0, |ground| ground.height_offset),
        apart_m,
    }
}

fn note_degrees(path: &Path, elevation: &Elevation, georeference: Georeference, terminal: &Terminal) {
    if let Georeference::Degrees { latitude_deg } = georeference {
        let [across, down] = elevation.posts().apart_m;
        terminal.note(&format!(
            "note: {} is in degrees; at latitude {latitude_deg:.2}° its posts are {across:.2} m x {down:.2} m apart, and metres count from its lower left corner",
            path.display()
        ));
    }
}

fn boxed([x, y]: [f64; 2], [width, height]: [f64; 2]) -> String {
    format!("x {x:.1} to {:.1} m, y {y:.1} to {:.1} m", x + width, y + height)
}
