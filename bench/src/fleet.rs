//! The planner for groups on one instance, in a process of its own so that the peak memory is its own.

use crate::measure::memory_kb;
use activecell::{Lattice, Team, check_plan};
use activecell_fleet::{Limits, Options, solve};
use activecell_formats::movingai::{read_map, read_scen};
use anyhow::{Context, Result, ensure};
use serde_json::json;
use std::fs::OpenOptions;
use std::io::Write;
use std::path::Path;
use std::time::{Duration, Instant};

/// Looks for plans for so many seconds, checks the last one, and appends a line to `out`: all plans with their times.
pub fn run(map: &Path, scen: &Path, robots: usize, lattice: &str, seconds: f64, out: &str) -> Result<()> {
    let name = |path: &Path| path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let lattice = Lattice::ALL.into_iter().find(|known| known.name() == lattice).context("no such lattice")?;
    let floor = read_map(&std::fs::read(map)?)?.on(lattice);
    let rows = read_scen(&std::fs::read(scen)?)?;
    // With 0, all of them.
    let robots = if robots == 0 { rows.len() } else { robots };
    ensure!(robots <= rows.len(), "{} has {} rows, too few for {robots} robots", scen.display(), rows.len());
    let (starts, targets) = rows[..robots].iter().map(|row| (row.from, row.to)).unzip();
    let team = Team::new(&floor, starts, targets)?;
    let threads = std::thread::available_parallelism()?.get();
    let limits = Limits { time: Some(Duration::from_secs_f64(seconds)), ..Limits::default() };
    let clock = Instant::now();
    let outcome = solve(&floor, &team, &Options { threads, limits, ..Options::default() }, |_| {})?;
    let ended_ms = clock.elapsed().as_secs_f64() * 1e3;
    let peak_kb = memory_kb("VmHWM:");
    if let Some(plan) = &outcome.plan {
        check_plan(&floor, &team, plan).map_err(|fault| anyhow::anyhow!("{fault}"))?;
    }
    let history: Vec<_> = outcome.history.iter().map(|found| json!([found.ms, found.sum_of_costs])).collect();
    let line = json!({
        "map": name(map), "scen": name(scen), "robots": robots, "lattice": lattice.name(), "seconds": seconds,
        "threads": threads, "bound": outcome.lower_bound, "history": history, "ended_ms": ended_ms,
        "ending": format!("{:?}", outcome.ending), "makespan": outcome.plan.map(|plan| plan.makespan()),
        "peak_kb": peak_kb,
    });
    let mut out = OpenOptions::new().create(true).append(true).open(out).context("the file of results")?;
    Ok(writeln!(out, "{line}")?)
}
