//! A plan, executed with delays.

use super::super::Done;
use super::super::counted;
use crate::args::{SimulateArgs, WrongArgument};
use crate::commands::load;
use crate::terminal::Terminal;
use activecell::schedule::{Delays, Executed, Execution, Runner};
use activecell::sim::trials;
use activecell::{Lattice, Map, Robot, Schedule, check_schedule};
use activecell_formats::files::{self, ReadOptions};
use activecell_formats::plan::{MAX_PLAN_BYTES, PlanFile, is_plan, read_plan};
use activecell_formats::schedule::{self, ExecutionReport};
use activecell_formats::trace::Distribution;
use anyhow::Context;
use std::thread::available_parallelism;

/// If the user does not say.
const DELAY_CHANCE: f64 = 0.05;
const MAX_DELAY_STEPS: u32 = 20;
const SLOW_SPEED: f64 = 0.5;

/// The file as a plan, if it is one.
pub(super) fn read(args: &SimulateArgs, terminal: &Terminal) -> anyhow::Result<Option<PlanFile>> {
    let _working = terminal.working(format!("reading {}", args.run.display()));
    let bytes = files::read_bytes(&args.run, MAX_PLAN_BYTES)?;
    if !is_plan(&bytes) {
        return Ok(None);
    }
    Ok(Some(read_plan(&bytes).map_err(|error| error.in_file(&args.run))?))
}

pub(super) fn run(args: &SimulateArgs, file: &PlanFile, terminal: &Terminal) -> anyhow::Result<Done> {
    if let Some(option) = args.given_for_runs() {
        let path = args.run.display();
        return Err(WrongArgument(format!("{option} is for runs; {path} is a plan")).into());
    }
    refuse_bodies(args, file, terminal)?;
    let map = map(args, file)?;
    let robot = match &args.robot {
        Some(path) => load::robot(path)?,
        None => Robot { radius_m: usual_radius(map.lattice()) * map.frame().cell_m, ..Robot::default() },
    };
    let schedule = Schedule::new(&map, &file.plan).with_context(|| args.run.display().to_string())?;
    check_schedule(&map, &file.plan, &schedule).context("a wrong schedule was made; please report this")?;
    let runner = Runner::new(&map, &schedule, &robot)?;
    if let Some(path) = &args.delays.save_schedule {
        files::write_atomically(path, schedule::write(&map, &robot, &runner)?.as_bytes())?;
    }
    let execution = Execution::new(&map, &schedule, &robot, delays(args))?;
    let count = args.trials.unwrap_or(1);
    let threads = args.threads.map_or_else(|| available_parallelism().map_or(1, usize::from), usize::from);
    let bar = terminal.counting(u64::from(count), "executing");
    let done = trials(count.into(), threads, args.seed, &|| bar.step(), &|rng| execution.trial(rng));
    drop(bar);
    let done: Vec<Executed> = done
        .into_iter()
        .collect::<Result<_, _>>()
        .context("robots that keep to the schedule failed; please report this")?;
    let report = report(args, &map, &schedule, &runner, &done);
    Terminal::result(&if args.json { serde_json::to_string(&report)? + "\n" } else { text(&report) })?;
    Ok(Done::Reached)
}

/// Schedules keep the order in which robots of one cell pass each cell, and neither distances nor times.
fn refuse_bodies(args: &SimulateArgs, file: &PlanFile, terminal: &Terminal) -> anyhow::Result<()> {
    let path = args.run.display();
    anyhow::ensure!(
        file.bodies.largest() == 0,
        "{path}: some robots are larger than a cell, and schedules are for robots of one cell; take larger cells"
    );
    if file.bodies.distance() > 1 || !file.keep_outs.is_empty() {
        terminal.note(&format!(
            "note: {path} keeps a distance or keeps out of closed cells; by order alone, robots only keep from touching"
        ));
    }
    Ok(())
}

/// Bodies of this radius in cells can go around every ring.
const fn usual_radius(lattice: Lattice) -> f64 {
    match lattice {
        Lattice::Square => 0.3,
        Lattice::Hex => 0.2,
    }
}

/// The map that is named, or that the plan file holds or names, beside it or here.
fn map(args: &SimulateArgs, file: &PlanFile) -> anyhow::Result<Map> {
    let lattice = file.lattice.unwrap_or_default();
    let read = |path: &std::path::Path| -> anyhow::Result<Map> {
        Ok(files::read_map(path, &ReadOptions::default())?.0.on(lattice))
    };
    if let Some(path) = &args.delays.map {
        return read(path);
    }
    if let Some(map) = &file.map {
        return Ok(map.clone());
    }
    let plan = args.run.display();
    let Some(name) = &file.stated.map_file else {
        return Err(WrongArgument(format!("{plan} names no map; name it with --map MAP")).into());
    };
    let beside = args.run.parent().map(|folder| folder.join(name));
    let found = beside.into_iter().chain([name.into()]).find(|path| path.is_file());
    let missing = || {
        WrongArgument(format!("{plan} is for the map {name:?}, which is not there; name it with --map MAP"))
    };
    read(&found.ok_or_else(missing)?)
}

fn delays(args: &SimulateArgs) -> Delays {
    let asked = &args.delays;
    Delays {
        chance: asked.delay_chance.unwrap_or(DELAY_CHANCE),
        most_steps: asked.max_delay.unwrap_or(MAX_DELAY_STEPS),
        slow_share: asked.slow.unwrap_or(0.0),
        slow_speed: asked.slow_speed.unwrap_or(SLOW_SPEED),
        stops: asked.stop.iter().map(|stop| stop.0).collect(),
        lost_reports: asked.lost_reports.unwrap_or(0.0),
        turning: asked.turning,
    }
}

fn report(
    args: &SimulateArgs,
    map: &Map,
    schedule: &Schedule,
    runner: &Runner<'_>,
    done: &[Executed],
) -> ExecutionReport {
    let robots = schedule.robots();
    let costs: Vec<f64> = (0..robots).map(|robot| schedule.cost(robot) as f64).collect();
    let late = done.iter().flat_map(|one| one.arrivals.iter().zip(&costs).map(|(at, cost)| at - cost));
    ExecutionReport {
        mode: "plan",
        trials: done.len() as u32,
        seed: args.seed,
        lattice: map.lattice().name(),
        robots,
        moves: schedule.moves(),
        rings: schedule.rings().len(),
        radius_cells: runner.spacing().radius(),
        planned_makespan: costs.iter().copied().fold(0.0, f64::max) as usize,
        arrived: done.len() as u32,
        makespan: Distribution::of(done.iter().map(Executed::makespan)),
        late: Distribution::of(late),
        held_up: Distribution::of(done.iter().flat_map(|one| one.delayed.iter().copied())),
        waited: Distribution::of(done.iter().flat_map(|one| one.waited.iter().copied())),
    }
}

/// The result for people.
fn text(report: &ExecutionReport) -> String {
    let ExecutionReport { trials, robots, moves, rings, planned_makespan, makespan, .. } = report;
    let figures = |of: Distribution| {
        let steps = |steps: f64| format!("{steps:.1}").replace("-0.0", "0.0");
        let [mean, median, p95, most] = [of.mean, of.median, of.p95, of.most].map(steps);
        format!("mean {mean} steps, median {median}, 95 % below {p95}, most {most}")
    };
    let makespan = match trials {
        1 => format!("{:.1} steps", makespan.most),
        _ => figures(*makespan),
    };
    format!(
        "plan: {}, {}, {}; executed {}\narrived        all, without a collision\nmakespan       planned {}; {makespan}\nlate           {}\nheld up        {}\nwaited         {}\n",
        counted(*robots as u64, "robot"),
        counted(*moves as u64, "move"),
        counted(*rings as u64, "ring"),
        if *trials == 1 { "once".to_owned() } else { format!("{trials} times") },
        counted(*planned_makespan as u64, "step"),
        figures(report.late),
        figures(report.held_up),
        figures(report.waited),
    )
}
