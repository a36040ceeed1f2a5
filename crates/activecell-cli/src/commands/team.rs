//! The robots of a group, from the rows of a scenario or by chance.

use super::group::Group;
use super::{counted, scen};
use crate::args::WrongArgument;
use crate::terminal::Terminal;
use activecell::{Bodies, Error, Map, Team};
use anyhow::Context;
use std::path::Path;

/// The first robots of a scenario, all unless their number is given, on this map.
///
/// What the options do not say of their bodies is as `stated`.
pub(super) fn of_scenario(
    (map, map_path): (&Map, &Path),
    path: &Path,
    robots: Option<usize>,
    group: &Group,
    stated: &Bodies,
    terminal: &Terminal,
) -> anyhow::Result<Team> {
    let tasks = scen::read(path)?;
    let rows = robots.unwrap_or(tasks.len());
    if rows > tasks.len() {
        let (path, all) = (path.display(), tasks.len());
        let message = format!("{path} has {all} rows, too few for {}", counted(rows as u64, "robot"));
        return Err(WrongArgument(message).into());
    }
    let tasks = &tasks[..rows];
    let place = |row: usize| format!("{} line {}", path.display(), tasks[row].line);
    for (row, task) in tasks.iter().enumerate() {
        scen::fits(task, map).with_context(|| place(row))?;
    }
    scen::say_other_map(path, tasks, map_path, terminal);
    let (starts, targets) = tasks.iter().map(|task| (task.from, task.to)).unzip();
    let bodies = group.bodies(rows, stated)?;
    let team = Team::new(map, starts, targets).and_then(|team| team.with_bodies(map, bodies));
    team.map_err(|error| {
        let place = match &error {
            Error::OfRobot { robot, .. } => place(*robot),
            Error::SharedStart { robots, .. }
            | Error::SharedTarget { robots, .. }
            | Error::TooClose { robots, .. } => place(robots[1]),
            _ => path.display().to_string(),
        };
        anyhow::Error::new(error).context(place)
    })
}

/// Robots by chance.
pub(super) fn by_chance(map: &Map, robots: usize, seed: u64, group: &Group) -> anyhow::Result<Team> {
    // No map has so many cells: not even their sizes are worth the memory.
    let all = counted(map.cells() as u64, "cell");
    anyhow::ensure!(robots <= map.cells(), too_many(robots, &format!("the map has {all}")));
    let bodies = group.bodies(robots, &Bodies::default())?;
    let are_cells = bodies.are_cells();
    Team::random_bodies(map, bodies, robots, seed).map_err(|error| match error {
        Error::TeamSize { free, .. } if are_cells => {
            let free = counted(free as u64, "free cell");
            too_many(robots, &format!("the floor's largest region has {free}")).into()
        }
        Error::TeamSize { free, .. } => {
            too_many(robots, &format!("of these sizes and at this distance there was room for {free}")).into()
        }
        other => other.into(),
    })
}

fn too_many(robots: usize, room: &str) -> WrongArgument {
    WrongArgument(format!("--robots {robots}: {room}; take fewer robots"))
}
