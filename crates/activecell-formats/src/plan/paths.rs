//! A path for each robot, `Agent 0: (row,column)->(row,column)->`, as MAPF-LNS2, EECBS and RHCR write them (J. Li).

use super::scan::Scan;
use super::{PlanFile, push, room};
use crate::error::Error;
use crate::lines::Lines;
use activecell::{Cell, Plan};
use std::fmt::Write as _;

pub(super) fn read(bytes: &[u8]) -> Result<PlanFile, Error> {
    // All paths one after the other, and where each ends.
    let (mut all, mut ends) = (Vec::new(), Vec::new());
    for (line, text) in Lines::new(bytes) {
        if text.trim_ascii().is_empty() {
            continue;
        }
        let word = b"Agent ";
        if !text.starts_with(word) {
            return Err(Error::at(line, 1, "expected `Agent` with a number and a path"));
        }
        let mut scan = Scan::new(line, text, word.len());
        let (robot, due) = (scan.number()?, ends.len());
        if usize::try_from(robot) != Ok(due) {
            return Err(
                scan.error(format!("agent {robot} where agent {due} is due; give every agent in order"))
            );
        }
        scan.expect(b':')?;
        let mut first = true;
        // The last cell may have an arrow too.
        while first || (scan.take_arrow() && !scan.is_done()) {
            let [row, column] = scan.pair()?;
            push(&mut all, Cell::new(column, row)).map_err(|reason| scan.error(reason))?;
            first = false;
        }
        if !scan.is_done() {
            return Err(scan.wanted("`->` and a cell"));
        }
        ends.push(all.len());
    }
    let begins = std::iter::once(0).chain(ends.iter().copied());
    let paths: Vec<&[Cell]> = begins.zip(&ends).map(|(begin, &end)| &all[begin..end]).collect();
    let steps = paths.iter().map(|path| path.len() - 1).max().unwrap_or(0);
    let mut cells = room(paths.len(), steps)?;
    for step in 0..=steps {
        // Who has arrived rests.
        cells.extend(paths.iter().filter_map(|path| path.get(step).or(path.last())));
    }
    Ok(PlanFile::new(Plan::new(paths.len(), cells)?))
}

pub(super) fn write(plan: &Plan) -> String {
    let mut text = String::with_capacity(10 * plan.robots() * (plan.steps() + 2));
    for (robot, cost) in plan.costs().into_iter().enumerate() {
        // Writing to a string cannot fail.
        let _ = write!(text, "Agent {robot}: ");
        for step in 0..=cost {
            let cell = plan.at(step, robot);
            let _ = write!(text, "({},{})->", cell.y, cell.x);
        }
        text.push('\n');
    }
    text
}
