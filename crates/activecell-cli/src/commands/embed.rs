//! `activecell embed`: an embedded map, and what is in one.

use super::load;
use crate::args::EmbedArgs;
use crate::terminal::Terminal;
use activecell::{Cell, EmbeddedMap, Map};
use activecell_formats::files;
use anyhow::Context;
use serde::Serialize;
use std::path::Path;
use std::thread::available_parallelism;
use std::time::Instant;

/// The most bytes that an embedded map may have to be described.
const MAX_BYTES: u64 = 1 << 32;

#[derive(Serialize)]
struct Report {
    file: String,
    kind: &'static str,
    lattice: &'static str,
    width: u32,
    height: u32,
    free_cells: u32,
    map_checksum: String,
    targets: Vec<[i32; 2]>,
    runs: u64,
    runs_per_row: f64,
    bytes_on_disk: usize,
    bytes_in_memory: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    build_s: Option<f64>,
}

/// Whether the file's name says that it is an embedded map.
pub(super) fn is_embedded(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("acm"))
}

pub(crate) fn run(args: &EmbedArgs, terminal: &Terminal) -> anyhow::Result<()> {
    let path = &args.output;
    anyhow::ensure!(is_embedded(path), "{}: an embedded map needs the ending .acm", path.display());
    let map = load::map(&args.map, None, terminal)?.map;
    let begin = Instant::now();
    let bytes = if args.to.is_empty() {
        table(&map, args, terminal)?
    } else {
        let targets = args.to.iter().map(|place| place.on(&map));
        map.direction_planes(&targets.collect::<anyhow::Result<Vec<Cell>>>()?)?
    };
    let build_s = begin.elapsed().as_secs_f64();
    files::write_atomically(path, &bytes)?;
    print(&report(path, &bytes, Some(build_s))?, args.json)
}

fn table(map: &Map, args: &EmbedArgs, terminal: &Terminal) -> anyhow::Result<Vec<u8>> {
    let free = map.free_cells();
    anyhow::ensure!(
        free <= args.limit,
        "a table of {free} free cells would take {} waves; raise --limit {}, choose larger cells with --cell, or name a few targets with --to",
        free,
        args.limit
    );
    let threads = args.threads.map_or_else(|| available_parallelism().map_or(1, usize::from), usize::from);
    let bar = terminal.counting(free as u64, "embedding");
    Ok(map.move_table(args.limit, threads, &|| bar.step())?)
}

/// Prints what an embedded map holds.
pub(super) fn describe(path: &Path, json: bool) -> anyhow::Result<()> {
    let bytes = files::read_bytes(path, MAX_BYTES)?;
    print(&report(path, &bytes, None)?, json)
}

fn report(path: &Path, bytes: &[u8], build_s: Option<f64>) -> anyhow::Result<Report> {
    let embedded = EmbeddedMap::from_bytes(bytes).with_context(|| path.display().to_string())?;
    let header = embedded.header();
    let (kind, targets, runs, bytes_in_memory) = match &embedded {
        EmbeddedMap::Directions(planes) => {
            let targets = (0..planes.targets()).filter_map(|number| planes.target(number));
            ("directions", targets.map(|cell| [cell.x, cell.y]).collect(), 0, planes.bytes())
        }
        EmbeddedMap::Moves(table) => ("moves", Vec::new(), table.runs(), table.bytes()),
    };
    Ok(Report {
        file: path.display().to_string(),
        kind,
        lattice: header.lattice.name(),
        width: header.width,
        height: header.height,
        free_cells: header.free_cells,
        map_checksum: format!("{:016x}", header.map_checksum),
        targets,
        runs,
        runs_per_row: runs as f64 / f64::from(header.free_cells.max(1)),
        bytes_on_disk: bytes.len(),
        bytes_in_memory,
        build_s,
    })
}

fn print(report: &Report, json: bool) -> anyhow::Result<()> {
    if json {
        return Terminal::result(&(serde_json::to_string(report)? + "\n"));
    }
    let holds = if report.kind == "moves" {
        format!("any to any: {} runs, {:.1} a row", report.runs, report.runs_per_row)
    } else {
        let targets: Vec<String> = report.targets.iter().map(|[x, y]| format!("({x},{y})")).collect();
        format!("directions to {}", targets.join(", "))
    };
    let mut lines = vec![
        format!("{} (embedded map)", report.file),
        format!(
            "cells     {} x {} {}, {} free",
            report.width, report.height, report.lattice, report.free_cells
        ),
        format!("holds     {holds}"),
        format!("size      {} bytes on disk, {} in memory", report.bytes_on_disk, report.bytes_in_memory),
        format!("map       checksum {}", report.map_checksum),
    ];
    lines.extend(report.build_s.map(|build_s| format!("built     in {build_s:.3} s")));
    Terminal::result(&(lines.join("\n") + "\n"))
}
