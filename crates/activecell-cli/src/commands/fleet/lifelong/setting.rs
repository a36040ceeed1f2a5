//! What a run without end begins with: a floor, robots and tasks.

use crate::args::{FleetArgs, GenerateArg, WrongArgument};
use crate::commands::group::Group;
use crate::commands::{counted, load, team};
use crate::terminal::Terminal;
use activecell::{Cell, Error, Map, Task};
use activecell_fleet::{deliveries, visits, within_reach};
use activecell_formats::files;
use activecell_formats::lorr::{self, MAX_LIST_BYTES};
use std::path::Path;

/// Tasks shown a robot where no problem says, as the League of Robot Runners does it.
const TASKS_SHOWN: f64 = 1.5;
/// The most tasks that are made by chance, some 60 MB: enough for all runs but the longest.
const MAX_GENERATED: usize = 1 << 20;

/// What a run begins with.
pub(super) struct Setting {
    pub(super) map: Map,
    pub(super) starts: Vec<Cell>,
    pub(super) tasks: Vec<Task>,
    /// So many tasks a robot are known at any time.
    pub(super) shown: f64,
}

/// Whether a problem stands in place of the map.
pub(super) fn is_problem(args: &FleetArgs) -> bool {
    args.map.path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("json"))
}

impl Setting {
    /// Reads or makes what the arguments ask for.
    pub(super) fn read(args: &FleetArgs, terminal: &Terminal) -> anyhow::Result<Self> {
        let setting = if is_problem(args) {
            problem(args, terminal)?
        } else {
            let map = load::map(&args.map, None, terminal)?.map;
            let starts = starts(args, &map)?;
            let tasks = tasks(args, &map, &starts)?;
            Self { map, starts, tasks, shown: TASKS_SHOWN }
        };
        if setting.starts.is_empty() || setting.tasks.is_empty() {
            let what = if setting.starts.is_empty() { "robots" } else { "tasks" };
            return Err(WrongArgument(format!("there are no {what}; give at least one")).into());
        }
        Ok(setting)
    }
}

/// Says in which file the mistake is, if it is in one.
pub(super) fn place(args: &FleetArgs, error: Error) -> anyhow::Error {
    let lists = &args.lifelong;
    let list = if matches!(error, Error::OfTask { .. }) { &lists.tasks } else { &lists.agents };
    let file = if is_problem(args) { Some(&args.map.path) } else { list.as_ref() };
    let error = anyhow::Error::new(error);
    match file {
        Some(file) => error.context(file.display().to_string()),
        None => error,
    }
}

/// A problem, which names all that a run needs.
fn problem(args: &FleetArgs, terminal: &Terminal) -> anyhow::Result<Setting> {
    let path = &args.map.path;
    let named = [
        ("--tasks", args.lifelong.tasks.is_some()),
        ("--generate", args.lifelong.generate.is_some()),
        ("--agents", args.lifelong.agents.is_some()),
        ("--cell", args.map.cell.is_some()),
        ("--resolution", args.map.resolution.is_some()),
    ];
    if let Some((name, _)) = named.into_iter().find(|(_, given)| *given) {
        let path = path.display();
        let message = format!("{path} is a problem, which names map, starts and tasks; leave {name} out");
        return Err(WrongArgument(message).into());
    }
    let _working = terminal.working(format!("reading {}", path.display()));
    let lorr::Problem { map, starts, tasks, tasks_revealed } = lorr::read_problem(path)?;
    let starts = first(args, starts, path)?;
    let tasks = tasks.into_iter().map(|errands| Task { errands }).collect();
    Ok(Setting { map: map.on(args.map.lattice.into()), starts, tasks, shown: tasks_revealed })
}

/// Where the robots start: as the list says, or by chance.
fn starts(args: &FleetArgs, map: &Map) -> anyhow::Result<Vec<Cell>> {
    match (&args.lifelong.agents, args.robots) {
        (Some(path), _) => {
            let starts = lorr::read_agents(&files::read_bytes(path, MAX_LIST_BYTES)?, map);
            Ok(first(args, starts.map_err(|error| error.in_file(path))?, path)?)
        }
        (None, Some(robots)) => {
            Ok(team::by_chance(map, robots, args.seed, &Group::default())?.starts().to_vec())
        }
        (None, None) => {
            let message =
                "nothing says how many robots there are; give --agents FILE, or -n N for starts by chance";
            Err(WrongArgument(message.to_owned()).into())
        }
    }
}

/// The first robots, all unless their number is given.
fn first(args: &FleetArgs, mut starts: Vec<Cell>, path: &Path) -> Result<Vec<Cell>, WrongArgument> {
    let robots = args.robots.unwrap_or(starts.len());
    if robots > starts.len() {
        let (path, all) = (path.display(), counted(starts.len() as u64, "start"));
        let robots = counted(robots as u64, "robot");
        let message = format!("{path} has {all}, too few for {robots}; take fewer robots");
        return Err(WrongArgument(message));
    }
    starts.truncate(robots);
    Ok(starts)
}

/// The tasks: as the list says, or by chance.
fn tasks(args: &FleetArgs, map: &Map, starts: &[Cell]) -> anyhow::Result<Vec<Task>> {
    if let Some(path) = &args.lifelong.tasks {
        let tasks = lorr::read_tasks(&files::read_bytes(path, MAX_LIST_BYTES)?, map);
        let tasks = tasks.map_err(|error| error.in_file(path))?;
        return Ok(tasks.into_iter().map(|errands| Task { errands }).collect());
    }
    let cells = starts.first().map_or(Vec::new(), |&start| within_reach(map, start));
    let steps = args.lifelong.steps.unwrap_or(super::STEPS) as usize;
    // Nobody does more than a task a step, but for those whose cell is where a robot stands.
    let count = starts.len().saturating_mul(steps + 1).min(MAX_GENERATED);
    // Starts by chance are drawn with the seed itself: tasks must not follow them.
    let seed = !args.seed;
    Ok(match args.lifelong.generate {
        Some(GenerateArg::Deliveries) => deliveries(&cells, &cells, count, seed),
        _ => visits(&cells, count, seed),
    })
}
