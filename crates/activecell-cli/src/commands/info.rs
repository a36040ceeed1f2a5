//! `activecell info`: what a map is.

use super::embed;
use super::load::{self, Loaded};
use crate::args::InfoArgs;
use crate::terminal::Terminal;
use activecell::Elevation;
use activecell_formats::files::MapFormat;
use serde::Serialize;

#[derive(Serialize)]
struct Report {
    map: String,
    format: &'static str,
    lattice: &'static str,
    width: u32,
    height: u32,
    cell_m: f64,
    size_m: [f64; 2],
    origin_m: [f64; 2],
    yaw_rad: f64,
    free_cells: usize,
    regions: usize,
    largest_region: usize,
    marks: Vec<(char, [i32; 2])>,
    /// The lowest and the highest post; left out without an elevation.
    #[serde(skip_serializing_if = "Option::is_none")]
    height_m: Option<[f64; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    steepest_deg: Option<f64>,
}

pub(crate) fn run(args: &InfoArgs, terminal: &Terminal) -> anyhow::Result<()> {
    if embed::is_embedded(&args.map.path) {
        return embed::describe(&args.map.path, args.json);
    }
    let Loaded { map, format, .. } = load::on_ground(&args.map, Some(&args.ground), None, terminal)?;
    let regions = map.regions();
    let frame = map.frame();
    let report = Report {
        map: args.map.path.display().to_string(),
        format: name(format),
        lattice: map.lattice().name(),
        width: map.width(),
        height: map.height(),
        cell_m: frame.cell_m,
        size_m: map.size_m(),
        origin_m: frame.origin_m,
        yaw_rad: frame.yaw_rad,
        free_cells: map.free_cells(),
        regions: regions.len(),
        largest_region: regions.first().copied().unwrap_or(0),
        marks: map.marks().iter().map(|&(name, cell)| (name, [cell.x, cell.y])).collect(),
        height_m: map.elevation().and_then(Elevation::range_m),
        steepest_deg: map.elevation().map(Elevation::steepest_deg),
    };
    if args.json {
        return Terminal::result(&(serde_json::to_string(&report)? + "\n"));
    }
    let cells = map.cells().max(1) as f64;
    let free = report.free_cells.max(1) as f64;
    let marks: Vec<String> = map.marks().iter().map(|(name, cell)| format!("{name} {cell}")).collect();
    let mut lines = vec![
        format!("{} ({})", report.map, report.format),
        format!(
            "cells     {} x {} {}, {} m each",
            report.width, report.height, report.lattice, report.cell_m
        ),
        format!(
            "floor     {:.2} m x {:.2} m, lower left corner at {:?} m",
            report.size_m[0], report.size_m[1], frame.origin_m
        ),
        format!("free      {} cells ({:.1} %)", report.free_cells, 100.0 * report.free_cells as f64 / cells),
        format!(
            "regions   {} that no way connects; the largest has {} cells ({:.1} % of the free)",
            report.regions,
            report.largest_region,
            100.0 * report.largest_region as f64 / free
        ),
        format!("marks     {}", if marks.is_empty() { "none".to_owned() } else { marks.join(", ") }),
    ];
    if let (Some([low, high]), Some(steepest_deg)) = (report.height_m, report.steepest_deg) {
        let posts = map.elevation().map_or([0.0; 2], |elevation| elevation.posts().apart_m);
        lines.push(format!(
            "heights   {low:.2} m to {high:.2} m, on posts {:.2} m x {:.2} m apart",
            posts[0], posts[1]
        ));
        lines.push(format!("slopes    up to {steepest_deg:.1}°"));
    }
    Terminal::result(&(lines.join("\n") + "\n"))
}

fn name(format: MapFormat) -> &'static str {
    match format {
        MapFormat::Ros => "ROS map_server",
        MapFormat::MovingAi => "MovingAI",
        MapFormat::Png => "PNG",
        MapFormat::Pgm => "PGM",
        MapFormat::Text => "text",
        MapFormat::Elevation => "elevation",
    }
}
