//! `activecell convert`: a map in another format.

use super::load;
use crate::args::{ConvertArgs, WrongArgument};
use crate::terminal::Terminal;
use activecell::{Lattice, Map};
use activecell_formats::files::{self, MapFormat};
use activecell_picture::map_svg;
use std::path::Path;

pub(crate) fn run(args: &ConvertArgs, terminal: &Terminal) -> anyhow::Result<()> {
    let is_picture = args.out.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("svg"));
    if !is_picture {
        MapFormat::of(&args.out).map_err(|error| WrongArgument(error.to_string()))?;
    }
    spare_the_source(&args.map.path, &args.out)?;
    let map = load::map(&args.map, None, terminal)?.map;
    if is_picture {
        let title = args.map.path.file_name().unwrap_or_default().to_string_lossy();
        files::write_atomically(&args.out, map_svg(&map, &title).as_bytes())?;
    } else {
        files::write_map(&args.out, &map)?;
    }
    let (out, width, height) = (args.out.display(), map.width(), map.height());
    terminal.note(&format!("wrote {out} ({width} x {height} cells){}", how_to_read(&args.out, &map)));
    Ok(())
}

/// What a file of cells does not say of itself.
fn how_to_read(out: &Path, map: &Map) -> String {
    let mut options = String::new();
    match MapFormat::of(out) {
        Err(_) => return options,
        Ok(MapFormat::Ros) => {}
        Ok(MapFormat::Text | MapFormat::MovingAi) if map.frame().cell_m.to_bits() == 1f64.to_bits() => {}
        Ok(_) => options += &format!(" --resolution {}", map.frame().cell_m),
    }
    if map.lattice() == Lattice::Hex {
        options += " --lattice hex";
    }
    if options.is_empty() { options } else { format!("; read it with{options}") }
}

/// A map must not be written over the files that it is read from.
fn spare_the_source(source: &Path, out: &Path) -> anyhow::Result<()> {
    let sources: Vec<_> = files::sources(source).iter().filter_map(|path| path.canonicalize().ok()).collect();
    for output in files::outputs(out) {
        if output.canonicalize().is_ok_and(|output| sources.contains(&output)) {
            let message =
                format!("{}: the map is read from this file; write to another name", output.display());
            return Err(WrongArgument(message).into());
        }
    }
    Ok(())
}
