//! `activecell fleet` for robots that get task after task.

mod setting;
mod written;

use super::shared::{duration, formats, peak_bytes, threads};
use crate::args::{AssignmentArg, FleetArgs, MotionArg, WrongArgument};
use crate::commands::{Done, counted, outputs};
use crate::terminal::Terminal;
use activecell::{Journal, check_journal};
use activecell_fleet::{Assignment, Lifelong, LifelongOptions};
use activecell_formats::lifelong::{LifelongReport, PlanningMs};
use activecell_formats::plan::MAX_PLAN_CELLS;
use anyhow::Context;
use setting::{Setting, is_problem};
use std::time::{Duration, Instant};

/// Steps of a run where nobody says.
const STEPS: u32 = 1000;
/// The time for planning a step where nobody says, in milliseconds.
const STEP_TIME_MS: f64 = 50.0;
/// Steps planned ahead where nobody says: crowds go better with more, many robots leave no time for it.
const WINDOW: u8 = 20;
const WINDOW_OF_MANY: u8 = 10;
const MANY: usize = 2000;

/// Whether the arguments ask for a run without end. Options of the other kind are refused.
pub(super) fn is_asked(args: &FleetArgs) -> Result<bool, WrongArgument> {
    let lifelong = &args.lifelong;
    let asked = lifelong.tasks.is_some() || lifelong.generate.is_some() || is_problem(args);
    let once = [
        ("--scen", args.scen.is_some()),
        ("--random", args.random),
        ("--assign", args.assign),
        ("--time-limit", args.limits.time_limit.is_some()),
        ("--step-limit", args.limits.step_limit.is_some()),
        ("--first", args.limits.first),
        ("--sizes", args.group.sizes.is_some()),
        ("--distance", args.group.distance.is_some()),
        ("--strangers", args.group.strangers.is_some()),
    ];
    let foreign = once.into_iter().find_map(|(name, given)| given.then_some(name));
    let message = match (asked, foreign, lifelong.given()) {
        (true, Some(name), _) => {
            format!("{name} is for a plan with an end, not for a run with tasks; leave it out")
        }
        (true, None, _) => return Ok(true),
        (false, ..) if lifelong.motion == MotionArg::Turning => {
            "--motion turning is for runs with tasks (--tasks or --generate); robots turn between the moves of a plan when it is executed: simulate PLAN --turning".to_owned()
        }
        (false, _, Some(name)) => {
            format!("{name} is for runs with tasks; give --tasks FILE or --generate visits too")
        }
        (false, ..) if args.scen.is_none() && !args.random => {
            "nothing says where robots go; give --scen FILE or --random, or for tasks without end --tasks FILE or --generate visits".to_owned()
        }
        (false, ..) => return Ok(false),
    };
    Err(WrongArgument(message))
}

pub(super) fn run(args: &FleetArgs, terminal: &Terminal) -> anyhow::Result<Done> {
    let (formats, pictures) = (formats(args)?, outputs::pictures(&args.picture)?);
    written::refuse(args, &formats)?;
    let setting = Setting::read(args, terminal)?;
    let steps = steps(args, setting.starts.len())?;
    let clock = Instant::now();
    let Setting { map, starts, tasks, .. } = &setting;
    let mut lifelong = Lifelong::new(map, starts, &[], tasks.clone(), options(args, &setting))
        .map_err(|error| setting::place(args, error))?;
    let (journal, planned_us) = go(&mut lifelong, steps, terminal)?;
    let elapsed_ms = clock.elapsed().as_secs_f64() * 1e3;
    check_journal(map, tasks, &journal)
        .context("a wrong run was made, and is not given out; please report this")?;
    let tasks_finished = journal.finished(tasks);
    let report = LifelongReport {
        robots: journal.robots(),
        motion: args.lifelong.motion.name(),
        lattice: map.lattice().name(),
        seed: args.seed,
        steps: journal.steps(),
        tasks_finished,
        tasks_per_step: tasks_finished as f64 / journal.steps().max(1) as f64,
        planning_ms: PlanningMs::of(&planned_us),
        elapsed_ms,
        peak_bytes: peak_bytes().unwrap_or(lifelong.bytes() as u64),
        ending: if lifelong.is_done() { "tasks" } else { "steps" },
    };
    written::save(args, &formats, &setting, &journal, &planned_us)?;
    written::draw(args, &pictures, &setting, &journal, terminal)?;
    let text = if args.json { serde_json::to_string(&report)? + "\n" } else { text(&report) };
    Terminal::result(&text)?;
    Ok(Done::Reached)
}

/// The steps to go; refuses a run whose journal would be too large.
fn steps(args: &FleetArgs, robots: usize) -> Result<usize, WrongArgument> {
    let steps = args.lifelong.steps.unwrap_or(STEPS) as usize;
    let most = MAX_PLAN_CELLS / robots.max(1) - 1;
    if steps <= most {
        return Ok(steps);
    }
    let robots = counted(robots as u64, "robot");
    Err(WrongArgument(format!("--steps {steps}: a run of {robots} may have {most}; take fewer steps")))
}

fn options(args: &FleetArgs, setting: &Setting) -> LifelongOptions {
    let lifelong = &args.lifelong;
    let time_ms = lifelong.step_time.or(lifelong.step_work.is_none().then_some(STEP_TIME_MS));
    let usual = if setting.starts.len() > MANY { WINDOW_OF_MANY } else { WINDOW };
    LifelongOptions {
        moves: lifelong.motion.into(),
        seed: args.seed,
        threads: threads(args),
        step_time: time_ms.map(|ms| Duration::from_secs_f64(ms / 1e3)),
        step_paths: lifelong.step_work,
        window: lifelong.window.unwrap_or(usual).into(),
        assignment: match lifelong.assignment {
            AssignmentArg::InOrder => Assignment::InOrder,
            AssignmentArg::Nearest => Assignment::Nearest { shown: setting.shown },
        },
        tasks_per_step: None,
    }
}

/// Lets the robots go and says how they fare: the journal, and how long planning each step took, in microseconds.
fn go(lifelong: &mut Lifelong, steps: usize, terminal: &Terminal) -> anyhow::Result<(Journal, Vec<u64>)> {
    let robots = counted(lifelong.robots() as u64, "robot");
    let working = terminal.counting(steps as u64, &*robots);
    let (mut planned_us, mut finished) = (Vec::new(), 0);
    let journal = lifelong.run(steps, |step| {
        planned_us.push(step.planned_us);
        finished += step.finished;
        let done = counted(finished as u64, "task");
        working.say(format!("{robots}: {done} done, {:.2} a step", finished as f64 / step.step as f64));
        working.step();
    })?;
    Ok((journal, planned_us))
}

fn text(report: &LifelongReport) -> String {
    let PlanningMs { median, p95, max } = report.planning_ms;
    let moves = if report.motion == "turning" { " that turn" } else { "" };
    let ended = if report.ending == "tasks" { "all tasks done" } else { "at the last step" };
    format!(
        "fleet: {}{moves}, {}\ntasks done     {}, {:.2} a step\nplanning       {} a step (median), 95 % of steps within {}, all within {}\nended          after {}, {ended}\n",
        counted(report.robots as u64, "robot"),
        counted(report.steps as u64, "step"),
        report.tasks_finished,
        report.tasks_per_step,
        duration(median),
        duration(p95),
        duration(max),
        duration(report.elapsed_ms),
    )
}
