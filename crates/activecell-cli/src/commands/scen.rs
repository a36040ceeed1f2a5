//! `activecell scen`: every task of a MovingAI scenario.

use super::Done;
use crate::args::ScenArgs;
use crate::terminal::Terminal;
use activecell::{Cell, Error, Lattice, Map, Outcome, Route, Rule, Search, check_route};
use activecell_formats::files::{self, ReadOptions};
use activecell_formats::movingai::{self, Task};
use anyhow::Context;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// The most bytes that a scenario may have.
const SCEN_BYTES: u64 = 256 << 20;

#[derive(Serialize)]
struct Report {
    map: String,
    lattice: &'static str,
    rule: &'static str,
    tasks: usize,
    arrived: usize,
    rows: Vec<Row>,
}

#[derive(Serialize)]
struct Row {
    line: usize,
    from: [i32; 2],
    to: [i32; 2],
    outcome: &'static str,
    steps: usize,
    expected: f64,
    us: f64,
}

pub(crate) fn run(args: &ScenArgs, terminal: &Terminal) -> anyhow::Result<Done> {
    let tasks = read(&args.scen)?;
    let map_path = match (&args.map, tasks.first()) {
        (Some(path), _) => path.clone(),
        (None, Some(task)) => beside(&args.scen, &task.map)?,
        (None, None) => anyhow::bail!("{}: the scenario has no task; add one a line", args.scen.display()),
    };
    let (map, _) = files::read_map(&map_path, &ReadOptions::default())?;
    let map = map.on(Lattice::from(args.lattice));
    let rule = Rule::from(args.rule);
    for task in &tasks {
        fits(task, &map).with_context(|| format!("{} line {}", args.scen.display(), task.line))?;
    }
    say_other_map(&args.scen, &tasks, &map_path, terminal);
    // One start, one target: the wave's shortest way can be had without flooding the map.
    let mut search = (rule == Rule::Wave).then(|| Search::new(&map));
    let bar = terminal.counting(tasks.len() as u64, "routing");
    let mut rows = Vec::with_capacity(tasks.len());
    for task in &tasks {
        rows.push(solve(&map, search.as_mut(), rule, task, args.max_steps)?);
        bar.step();
    }
    drop(bar);
    let arrived = rows.iter().filter(|row| row.outcome == Outcome::Arrived.name()).count();
    let (lattice, rule) = (map.lattice().name(), rule.name());
    let report =
        Report { map: map_path.display().to_string(), lattice, rule, tasks: rows.len(), arrived, rows };
    let text = if args.json { serde_json::to_string(&report)? + "\n" } else { text(&report) };
    Terminal::result(&text)?;
    Ok(if arrived == report.tasks { Done::Reached } else { Done::NotReached })
}

/// The tasks of a scenario.
pub(super) fn read(path: &Path) -> anyhow::Result<Vec<Task>> {
    let bytes = files::read_bytes(path, SCEN_BYTES)?;
    Ok(movingai::read_scen(&bytes).map_err(|error| error.in_file(path))?)
}

/// Whether the task was made for a map of this size; 0 × 0 says nothing.
pub(super) fn fits(task: &Task, map: &Map) -> anyhow::Result<()> {
    let (asked, given) = ((task.width, task.height), (map.width(), map.height()));
    anyhow::ensure!(
        asked == given || asked == (0, 0),
        "the task is for a map of {} x {} cells, this one has {} x {}; name the right map",
        asked.0,
        asked.1,
        given.0,
        given.1
    );
    Ok(())
}

/// Tells that the tasks were made for a map of another name: what one of the same size says of it is luck.
pub(super) fn say_other_map(scen: &Path, tasks: &[Task], map: &Path, terminal: &Terminal) {
    let Some(given) = map.file_name().map(|name| name.to_string_lossy()) else { return };
    let mut names = tasks.iter().map(|task| file_name(&task.map));
    if let Some(name) = names.find(|name| *name != given) {
        terminal.note(&format!("note: {} is for the map {name:?}, this one is {given:?}", scen.display()));
    }
}

/// The map's file without its folder. Scenarios are written on every system.
fn file_name(map: &str) -> &str {
    map.rsplit(['/', '\\']).next().unwrap_or(map)
}

/// An answer, in the form of the one that gave it.
enum Found {
    Path(Option<Vec<Cell>>),
    Route(Route),
}

/// One row. A task that cannot be set, or takes too long, is a row too: the others are still worth their answer.
fn solve(
    map: &Map,
    search: Option<&mut Search>,
    rule: Rule,
    task: &Task,
    max_steps: usize,
) -> anyhow::Result<Row> {
    let started = Instant::now();
    let found = match search {
        Some(search) => search.path(task.from, task.to).map(Found::Path),
        None => map.route(rule, task.from, task.to, max_steps).map(Found::Route),
    };
    let us = started.elapsed().as_secs_f64() * 1e6;
    let (outcome, steps) = match found {
        Ok(Found::Route(route)) => {
            route.check(map, task.from, task.to)?;
            (route.outcome().name(), route.steps())
        }
        Ok(Found::Path(Some(cells))) => {
            check_route(map, &cells, task.from, task.to)?;
            (Outcome::Arrived.name(), cells.len() - 1)
        }
        Ok(Found::Path(None)) => (Outcome::Unreachable.name(), 0),
        Err(Error::StartOccupied { .. }) => ("start_occupied", 0),
        Err(Error::TargetOccupied { .. }) => ("target_occupied", 0),
        Err(Error::OutsideMap { .. }) => ("outside_map", 0),
        Err(Error::StepLimit { steps }) => ("step_limit", steps),
        Err(other) => return Err(other.into()),
    };
    let (from, to) = ([task.from.x, task.from.y], [task.to.x, task.to.y]);
    Ok(Row { line: task.line, from, to, outcome, steps, expected: task.expected, us })
}

/// The map that a scenario names: its file name, looked for beside the scenario.
fn beside(scen: &Path, name: &str) -> anyhow::Result<PathBuf> {
    let folder = scen.parent().unwrap_or(Path::new(""));
    let found = [folder.join(file_name(name)), folder.join(name)].into_iter().find(|path| path.is_file());
    found.with_context(|| {
        format!("{}: its map `{name}` is not beside it; name the map with --map", scen.display())
    })
}

fn text(report: &Report) -> String {
    let mut micros: Vec<f64> = report.rows.iter().map(|row| row.us).collect();
    micros.sort_by(f64::total_cmp);
    let percentile = |share: f64| {
        let index = ((micros.len() as f64 * share).ceil() as usize).clamp(1, micros.len().max(1)) - 1;
        micros.get(index).copied().unwrap_or(0.0)
    };
    let steps: usize = report.rows.iter().map(|row| row.steps).sum();
    let mut text = format!(
        "{} · {} · {}: {} of {} tasks arrived, {steps} steps in all\nmicroseconds a task: median {:.0}, 95 % {:.0}, 99 % {:.0}\n",
        report.map,
        report.lattice,
        report.rule,
        report.arrived,
        report.tasks,
        percentile(0.5),
        percentile(0.95),
        percentile(0.99),
    );
    let missed = report.rows.iter().filter(|row| row.outcome != Outcome::Arrived.name());
    for row in missed.clone().take(10) {
        text += &format!("line {}: {} from {:?} to {:?}\n", row.line, row.outcome, row.from, row.to);
    }
    let more = missed.count().saturating_sub(10);
    if more > 0 {
        text += &format!("… and {more} more; --json gives all\n");
    }
    text
}
