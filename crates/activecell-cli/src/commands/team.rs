//! The robots of a group, from the rows of a scenario or by chance.

use super::scen;
use crate::args::WrongArgument;
use activecell::{Error, Map, Team};
use anyhow::Context;
use std::path::Path;

/// The first robots of a scenario, all unless their number is given, on this map.
pub(super) fn of_scenario(map: &Map, path: &Path, robots: Option<usize>) -> anyhow::Result<Team> {
    let tasks = scen::read(path)?;
    let rows = robots.unwrap_or(tasks.len());
    if rows > tasks.len() {
        let (path, all) = (path.display(), tasks.len());
        let message = format!("{path} has {all} rows, too few for {rows} robots; take fewer robots");
        return Err(WrongArgument(message).into());
    }
    let tasks = &tasks[..rows];
    let place = |row: usize| format!("{} line {}", path.display(), tasks[row].line);
    for (row, task) in tasks.iter().enumerate() {
        scen::fits(task, map).with_context(|| place(row))?;
    }
    let (starts, targets) = tasks.iter().map(|task| (task.from, task.to)).unzip();
    Team::new(map, starts, targets).map_err(|error| {
        let place = match &error {
            Error::OfRobot { robot, .. } => place(*robot),
            Error::SharedStart { robots, .. } | Error::SharedTarget { robots, .. } => place(robots[1]),
            _ => path.display().to_string(),
        };
        anyhow::Error::new(error).context(place)
    })
}

/// Robots by chance.
pub(super) fn by_chance(map: &Map, robots: usize, seed: u64) -> anyhow::Result<Team> {
    Team::random(map, robots, seed).map_err(|error| match error {
        Error::TeamSize { free, .. } => {
            let message = format!(
                "--robots {robots}: the floor's largest region has {free} free cells; take fewer robots"
            );
            WrongArgument(message).into()
        }
        other => other.into(),
    })
}
