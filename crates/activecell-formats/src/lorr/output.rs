//! The output of a lifelong run, as `PlanViz` shows it (the format of 2024, which all its versions read).

use crate::error::Error;
use activecell::{Cell, Dir, Lattice};
use serde::Serialize;

/// A run to be written, from plain values. Steps, robots and tasks are counted from 0.
#[derive(Debug, Clone, Copy)]
pub struct Output<'a> {
    /// The cells of all robots at step 0, the start, at step 1 and so on; at least the start.
    pub cells: &'a [&'a [Cell]],
    /// Where all robots head, in the same order; empty if robots move without turning.
    pub headings: &'a [&'a [Dir]],
    /// The cells of each task.
    pub tasks: &'a [Vec<Cell>],
    /// What happened to tasks, in the order of time.
    pub events: &'a [TaskEvent],
    /// How long planning each step took, in seconds.
    pub planning_s: &'a [f64],
}

/// Something that happened to a task.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TaskEvent {
    /// After which step; step 0 is the start.
    pub step: usize,
    /// The robot.
    pub robot: usize,
    /// The task.
    pub task: usize,
    /// How many errands of the task are done; 0 says that the robot got the task now.
    pub done: usize,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct File<'a> {
    action_model: &'static str,
    version: &'static str,
    #[serde(rename = "AllValid")]
    all_valid: &'static str,
    team_size: usize,
    num_task_finished: usize,
    sum_of_cost: usize,
    makespan: usize,
    start: Vec<(i32, i32, &'static str)>,
    actual_paths: &'a [String],
    planner_paths: &'a [String],
    planner_times: &'a [f64],
    errors: [(); 0],
    actual_schedule: &'a [String],
    planner_schedule: &'a [String],
    schedule_errors: [(); 0],
    events: Vec<[usize; 4]>,
    tasks: Vec<(usize, usize, Vec<i32>)>,
}

/// The output file of a run on squares: JSON for `PlanViz`.
///
/// Robots that do not turn are written with the action model `MAPF` and the actions `U` (to the next
/// row, drawn below), `D`, `L`, `R`, `W`, those that do with `MAPF_T`
/// and `F` (forward), `R` (clockwise), `C` (counter-clockwise), `W` (wait). A task that no robot ever got is left out of
/// `tasks`; one that was got appears when it was got.
///
/// # Errors
/// [`Error::BadFormat`] if a step is no action of the model: the format knows squares only; or if the values do not fit together.
///
/// ```
/// use activecell::{Cell, Dir};
/// use activecell_formats::lorr::{Output, TaskEvent, write_output};
/// let (a, b, east) = (Cell::new(0, 0), Cell::new(1, 0), Dir::E);
/// let tasks = [vec![b]];
/// let got = TaskEvent { step: 0, robot: 0, task: 0, done: 0 };
/// let output = Output {
///     cells: &[&[a], &[b]],
///     headings: &[&[east], &[east]],
///     tasks: &tasks,
///     events: &[got, TaskEvent { step: 1, done: 1, ..got }],
///     planning_s: &[0.001],
/// };
/// let text = write_output(&output)?;
/// assert!(text.contains("\"numTaskFinished\":1"));
/// assert!(text.contains("\"start\":[[0,0,\"E\"]],\"actualPaths\":[\"F\"]"));
/// # Ok::<(), activecell_formats::Error>(())
/// ```
pub fn write_output(output: &Output<'_>) -> Result<String, Error> {
    let Output { cells, headings, tasks, events, planning_s } = *output;
    let Some(&starts) = cells.first() else {
        return Err(Error::file("a run without its start cannot be written; give the cells of step 0"));
    };
    let robots = starts.len();
    let turning = !headings.is_empty();
    let fits = cells.iter().all(|row| row.len() == robots)
        && (!turning || headings.len() == cells.len() && headings.iter().all(|row| row.len() == robots))
        && events.iter().all(|event| event.robot < robots && event.task < tasks.len());
    if !fits {
        return Err(Error::file("cells, headings, events and tasks of the run do not fit together"));
    }
    let paths = (0..robots).map(|robot| path(cells, headings, robot)).collect::<Result<Vec<_>, _>>()?;
    let faces = |robot| if turning { Lattice::Square.dir_name(headings[0][robot]) } else { "E" };
    let schedule = schedule(robots, events);
    let steps = cells.len() - 1;
    let got = events.iter().filter(|event| event.done == 0);
    let file = File {
        action_model: if turning { "MAPF_T" } else { "MAPF" },
        version: "2024 LoRR",
        all_valid: "Yes",
        team_size: robots,
        num_task_finished: events.iter().filter(|event| event.done == tasks[event.task].len()).count(),
        sum_of_cost: robots * steps,
        makespan: steps,
        start: starts.iter().enumerate().map(|(robot, at)| (at.y, at.x, faces(robot))).collect(),
        actual_paths: &paths,
        planner_paths: &paths,
        planner_times: planning_s,
        errors: [],
        actual_schedule: &schedule,
        planner_schedule: &schedule,
        schedule_errors: [],
        events: events
            .iter()
            .filter(|event| event.done > 0)
            .map(|event| [event.step, event.robot, event.task, event.done])
            .collect(),
        tasks: got
            .map(|event| {
                let places = tasks[event.task].iter().flat_map(|cell| [cell.y, cell.x]);
                (event.task, event.step, places.collect())
            })
            .collect(),
    };
    let mut text = serde_json::to_string(&file).map_err(|error| Error::file(error.to_string()))?;
    text.push('\n');
    Ok(text)
}

/// The actions of a robot, separated by commas.
fn path(cells: &[&[Cell]], headings: &[&[Dir]], robot: usize) -> Result<String, Error> {
    let actions = (1..cells.len()).map(|step| {
        let (from, to) = (cells[step - 1][robot], cells[step][robot]);
        let turn = headings.get(step).map(|now| (headings[step - 1][robot], now[robot]));
        action(from, to, turn).ok_or_else(|| {
            Error::file(format!(
                "step {step}: robot {robot} does from {from} to {to} what the format cannot say"
            ))
        })
    });
    Ok(actions.collect::<Result<Vec<_>, _>>()?.join(","))
}

/// The action that leads from one cell to another, or from one heading to another.
fn action(from: Cell, to: Cell, turn: Option<(Dir, Dir)>) -> Option<&'static str> {
    let lattice = Lattice::Square;
    match (from == to, turn) {
        (true, None) => Some("W"),
        (true, Some((before, now))) if before == now => Some("W"),
        (true, Some((before, now))) if lattice.turned(before, 1) == now => Some("R"),
        (true, Some((before, now))) if lattice.turned(before, -1) == now => Some("C"),
        (false, None) => {
            let dir = lattice.dir_between(from, to)?;
            // For north, east, south and west: `PlanViz` counts rows upwards here, as the MAPF tracker does.
            ["D", "R", "U", "L"].get(dir.index()).copied()
        }
        (false, Some((before, now))) if before == now && lattice.neighbour(from, now) == to => Some("F"),
        _ => None,
    }
}

/// For each robot when it got which task: `0:3,12:7`.
fn schedule(robots: usize, events: &[TaskEvent]) -> Vec<String> {
    let mut got: Vec<Vec<String>> = vec![Vec::new(); robots];
    for event in events.iter().filter(|event| event.done == 0) {
        got[event.robot].push(format!("{}:{}", event.step, event.task));
    }
    got.into_iter().map(|got| got.join(",")).collect()
}
