//! `activecell fleet` for robots that have one task each: a plan with an end.

use super::shared::{draw, duration, formats, peak_bytes, stated, threads};
use crate::args::{FleetArgs, WrongArgument};
use crate::commands::group::{self, Group};
use crate::commands::{Done, counted, load, outputs, team};
use crate::terminal::Terminal;
use activecell::{Bodies, Cell, KeepOuts, Map, Plan, Team, check_keep_outs, check_plan};
use activecell_fleet::{Ending, Floor, Limits, Options, Outcome, solve_past};
use activecell_formats::files;
use activecell_formats::fleet::FleetReport;
use activecell_formats::plan::{PlanFile, PlanFormat, Stated};
use activecell_picture::{FleetPicture, FleetView};
use anyhow::Context;
use std::time::{Duration, Instant};

/// How long to look for better plans where nobody says, in seconds.
const TIME_LIMIT_S: f64 = 10.0;

pub(super) fn run(args: &FleetArgs, terminal: &Terminal) -> anyhow::Result<Done> {
    let (formats, pictures) = (formats(args)?, outputs::pictures(&args.picture)?);
    let map = load::map(&args.map, None, terminal)?.map;
    let team = team(args, &map, terminal)?;
    let keep_outs = group::keep_outs(&args.group, &map, team.bodies())?.unwrap_or_default();
    let options = options(args);
    let clock = Instant::now();
    let outcome = {
        let robots = counted(team.robots() as u64, "robot");
        let working = terminal.working(format!("{robots}: looking for a plan"));
        solve_past(&map, &team, &keep_outs, &options, |found| {
            working.say(format!("{robots}: sum of costs {}, looking for better", found.sum_of_costs));
        })?
    };
    let elapsed_ms = clock.elapsed().as_secs_f64() * 1e3;
    if let Some(plan) = &outcome.plan {
        check_plan(&map, &team, plan)
            .and_then(|()| check_keep_outs(&map, &team, &keep_outs, plan))
            .context("a wrong plan was made, and is not given out; please report this")?;
    }
    let report = report(args, &map, &team, &outcome, elapsed_ms);
    if let Some(plan) = outcome.plan {
        let file = plan_file(args, &map, (&team, &keep_outs), plan, &report);
        for (path, &format) in args.save.iter().zip(&formats) {
            let text = file.write(format).map_err(|error| error.in_file(path))?;
            files::write_atomically(path, text.as_bytes())?;
        }
        say_what_is_not_held(args, &formats, &team, &keep_outs, terminal);
        // A picture that fails costs no plan.
        let title = args.map.path.file_stem().unwrap_or_default().to_string_lossy();
        let picture = FleetPicture {
            map: &map,
            title: &title,
            team: &team,
            plan: &file.plan,
            lower_bound: Some(report.lower_bound),
            endless: false,
            view: FleetView::default(),
        };
        draw(&pictures, &picture, terminal)?;
    }
    let text = if args.json {
        serde_json::to_string(&report)? + "\n"
    } else {
        text(&report, if report.solved { None } else { cut_off(&map, &team) })
    };
    Terminal::result(&text)?;
    Ok(if report.solved { Done::Reached } else { Done::NotReached })
}

/// The robots: from the scenario or by chance, with their bodies, and with their targets shared out if that is wanted.
fn team(args: &FleetArgs, map: &Map, terminal: &Terminal) -> anyhow::Result<Team> {
    let group = Group::read(&args.group)?;
    let team = match (&args.scen, args.robots) {
        (Some(scen), robots) => {
            let map = (map, args.map.path.as_path());
            team::of_scenario(map, scen, robots, &group, &Bodies::default(), terminal)?
        }
        (None, robots) => team::by_chance(map, robots.unwrap_or_default(), args.seed, &group)?,
    };
    if !args.assign {
        return Ok(team);
    }
    let robots = counted(team.robots() as u64, "robot");
    let _working = terminal.working(format!("{robots}: sharing out their targets"));
    let (bodies, radius) = (team.bodies(), team.bodies().radius(0));
    if (0..team.robots()).any(|robot| bodies.radius(robot) != radius) {
        let message = "--assign: the robots have different sizes, so that a target of one may have no room for another; give all one size, or leave --assign out";
        return Err(WrongArgument(message.to_owned()).into());
    }
    // Bodies of one size go where one cell goes on the floor of that size.
    let own = map.for_body(radius);
    Ok(Team::assigned(&own, team.starts().to_vec(), team.targets())?.with_bodies(map, bodies.clone())?)
}

fn options(args: &FleetArgs) -> Options {
    let time_s = args.limits.time_limit.or(args.limits.step_limit.is_none().then_some(TIME_LIMIT_S));
    Options {
        seed: args.seed,
        threads: threads(args),
        limits: Limits {
            time: time_s.map(Duration::from_secs_f64),
            steps: args.limits.step_limit,
            first: args.limits.first,
            ..Limits::default()
        },
    }
}

/// The plan as a file, with all that it holds.
fn plan_file(
    args: &FleetArgs,
    map: &Map,
    (team, keep_outs): (&Team, &KeepOuts),
    plan: Plan,
    report: &FleetReport,
) -> PlanFile {
    let stated = Stated {
        lower_bound: Some(report.lower_bound),
        comp_time_ms: Some(report.elapsed_ms),
        ..stated(args)
    };
    PlanFile {
        lattice: Some(map.lattice()),
        map: Some(map.clone()),
        starts: Some(team.starts().to_vec()),
        targets: Some(team.targets().to_vec()),
        bodies: team.bodies().clone(),
        keep_outs: keep_outs.all().to_vec(),
        stated,
        ..PlanFile::new(plan)
    }
}

/// The first robot whose target lies in another part of the floor.
fn cut_off(map: &Map, team: &Team) -> Option<String> {
    let floor = Floor::new(map);
    let mut tasks = team.starts().iter().zip(team.targets());
    let apart = |(&from, &to): (&Cell, &Cell)| !floor.connected(floor.number(from), floor.number(to));
    let robot = tasks.position(apart)?;
    Some(format!("robot {robot} has no way from {} to {}", team.starts()[robot], team.targets()[robot]))
}

/// Only one format holds all that a plan has to keep.
fn say_what_is_not_held(
    args: &FleetArgs,
    formats: &[PlanFormat],
    team: &Team,
    keep_outs: &KeepOuts,
    terminal: &Terminal,
) {
    if team.bodies().are_cells() && keep_outs.is_empty() {
        return;
    }
    for (path, _) in args.save.iter().zip(formats).filter(|(_, format)| **format != PlanFormat::Json) {
        let path = path.display();
        terminal.note(&format!(
            "note: {path} holds neither sizes nor distance nor closed cells; check it with the same options, or save .json"
        ));
    }
}

fn report(args: &FleetArgs, map: &Map, team: &Team, outcome: &Outcome, elapsed_ms: f64) -> FleetReport {
    let history = outcome.history.iter().map(|found| (found.ms, found.sum_of_costs));
    FleetReport {
        robots: team.robots(),
        solved: outcome.plan.is_some(),
        sum_of_costs: outcome.plan.as_ref().map(Plan::sum_of_costs),
        makespan: outcome.plan.as_ref().map(Plan::makespan),
        lower_bound: outcome.lower_bound,
        first_solution_ms: outcome.history.first().map(|found| found.ms),
        elapsed_ms,
        peak_bytes: peak_bytes().unwrap_or(outcome.bytes as u64),
        history: history.collect(),
        ending: match outcome.ending {
            Ending::Exhausted => "exhausted",
            Ending::FirstPlan => "first_plan",
            Ending::Time => "time",
            Ending::Steps => "steps",
            Ending::Memory => "memory",
        },
        lattice: map.lattice().name(),
        seed: args.seed,
    }
}

fn text(report: &FleetReport, cut_off: Option<String>) -> String {
    let FleetReport { lower_bound, .. } = report;
    let robots = counted(report.robots as u64, "robot");
    let ended = format!("after {}, {}", duration(report.elapsed_ms), ending(report));
    let (Some(cost), Some(makespan)) = (report.sum_of_costs, report.makespan) else {
        let what = if report.ending == "exhausted" { "no plan exists" } else { "no plan found" };
        let why = cut_off.map_or(String::new(), |why| format!(": {why}"));
        return format!("fleet: {robots}, {what}{why}\nended          {ended}\n");
    };
    let makespan = counted(makespan as u64, "step");
    let ratio = match (cost, *lower_bound) {
        (0, _) | (_, 0) => String::new(),
        (cost, bound) if cost == bound => ", the least possible".to_owned(),
        (cost, bound) => format!(", {:.3} x the lower bound of {bound}", cost as f64 / bound as f64),
    };
    let first = report.history.first().map_or(String::new(), |&(ms, cost)| {
        let better = match report.history.len() - 1 {
            0 => "none better".to_owned(),
            1 => "1 better".to_owned(),
            more => format!("{more} better"),
        };
        format!("first plan     {cost} after {}; {better} since\n", duration(ms))
    });
    format!(
        "fleet: {robots}, all arrive\nsum of costs   {cost}{ratio}\nmakespan       {makespan}\n{first}ended          {ended}\n"
    )
}

/// Why the search ended, for people.
fn ending(report: &FleetReport) -> &'static str {
    match (report.ending, report.solved) {
        ("exhausted", true) => "nothing left to try",
        ("exhausted", false) => "every way tried",
        ("first_plan", _) => "at the first plan",
        ("time", true) => "at the time limit",
        ("time", false) => "at the time limit; raise --time-limit, or take fewer robots",
        ("steps", true) => "at the step limit",
        ("steps", false) => "at the step limit; raise --step-limit, or take fewer robots",
        (_, true) => "with its memory full",
        (_, false) => "with its memory full; take fewer robots",
    }
}
