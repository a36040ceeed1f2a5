//! The checker of runs: knows the map, the tasks and the rules, and nothing of how runs are planned.

use super::check::{PlanFault, check_rows};
use super::{Event, Journal, Moves, News, Task};
use crate::lattice::{Cell, Dir, Lattice};
use crate::map::Map;
use std::fmt;

/// What is wrong with a journal. Robots, tasks, errands and events are counted from 0, steps from 0, the start.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum JournalFault {
    /// A robot moves as no robot may.
    Move(PlanFault),
    /// A robot has a heading that is none of the lattice's.
    NoDirection {
        /// The step.
        step: usize,
        /// The robot.
        robot: usize,
        /// Its heading.
        heading: Dir,
    },
    /// A robot that turns moved to a cell that is not ahead of it, turned by more than one direction, or did both at once.
    Turn {
        /// The step.
        step: usize,
        /// The robot.
        robot: usize,
        /// Where it was and is.
        cells: [Cell; 2],
        /// Its heading before and after.
        headings: [Dir; 2],
    },
    /// An event of a robot, a task, an errand or a step that there is not, or before an earlier one.
    NoSuch {
        /// The event.
        event: usize,
    },
    /// A task is given out a second time, or to a robot that has one.
    GivenTwice {
        /// The event.
        event: usize,
        /// The robot that gets the task.
        robot: usize,
        /// The task.
        task: usize,
    },
    /// A robot reports an errand of a task that it does not have, or not the next one.
    NotNext {
        /// The step.
        step: usize,
        /// The robot.
        robot: usize,
        /// The task.
        task: usize,
        /// The errand.
        errand: usize,
    },
    /// A robot reports an errand and is elsewhere.
    NotThere {
        /// The step.
        step: usize,
        /// The robot.
        robot: usize,
        /// Where it is.
        cell: Cell,
        /// Where the errand is.
        errand: Cell,
    },
}

impl fmt::Display for JournalFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Move(fault) => fault.fmt(f),
            Self::NoDirection { step, robot, heading } => {
                write!(f, "step {step}: robot {robot} has the heading {}, which is no direction", heading.0)
            }
            Self::Turn { step, robot, cells: [from, to], headings: [before, after] } => write!(
                f,
                "step {step}: robot {robot} goes from {from}, heading {}, to {to}, heading {}; it may go ahead, turn by one direction, or wait",
                before.0, after.0
            ),
            Self::NoSuch { event } => {
                write!(
                    f,
                    "event {event} is of a robot, task, errand or step that there is not, or out of order"
                )
            }
            Self::GivenTwice { event, robot, task } => write!(
                f,
                "event {event}: robot {robot} gets task {task}, which was given out before, or has another one"
            ),
            Self::NotNext { step, robot, task, errand } => {
                write!(
                    f,
                    "step {step}: robot {robot} reports errand {errand} of task {task}, not its next one"
                )
            }
            Self::NotThere { step, robot, cell, errand } => {
                write!(f, "step {step}: robot {robot} reports an errand at {errand} and is at {cell}")
            }
        }
    }
}

impl std::error::Error for JournalFault {}

/// Checks that all robots of a journal moved by the rules, and that every errand that was reported was done: by the robot
/// that had the task, in the cell, in the order of the task.
///
/// # Errors
/// The first [`JournalFault`]: of the moves, then of the turns, then of the events.
///
/// ```
/// use activecell::{Cell, Event, Journal, JournalFault, Lattice, Map, Moves, News, Task, check_journal};
/// let map = Map::parse(Lattice::Square, "..")?;
/// let [a, b] = [0, 1].map(|x| Cell::new(x, 0));
/// let given = Event { step: 0, robot: 0, task: 0, news: News::Assigned };
/// let done = Event { step: 1, news: News::Done(0), ..given };
/// let mut journal = Journal::new(Moves::Omni, &[a], &[], &[given]);
/// journal.push(&[a], &[], &[done]);
/// let fault = JournalFault::NotThere { step: 1, robot: 0, cell: a, errand: b };
/// assert_eq!(check_journal(&map, &[Task::visit(b)], &journal), Err(fault));
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn check_journal(map: &Map, tasks: &[Task], journal: &Journal) -> Result<(), JournalFault> {
    let rows: Vec<&[Cell]> = (0..=journal.steps()).map(|step| journal.cells(step)).collect();
    check_rows(map, rows.iter().copied()).map_err(JournalFault::Move)?;
    if journal.moves() == Moves::Turning {
        check_turns(map.lattice(), journal)?;
    }
    check_events(tasks, journal)
}

fn check_turns(lattice: Lattice, journal: &Journal) -> Result<(), JournalFault> {
    for step in 0..=journal.steps() {
        let past = step.saturating_sub(1);
        for robot in 0..journal.robots() {
            let [from, to] = [past, step].map(|step| journal.cells(step)[robot]);
            let [before, after] = [past, step].map(|step| journal.headings(step)[robot]);
            if after.0 >= lattice.degree() {
                return Err(JournalFault::NoDirection { step, robot, heading: after });
            }
            let allowed = if from == to {
                [-1, 0, 1].iter().any(|&by| lattice.turned(before, by) == after)
            } else {
                before == after && lattice.neighbour(from, before) == to
            };
            if !allowed {
                let (cells, headings) = ([from, to], [before, after]);
                return Err(JournalFault::Turn { step, robot, cells, headings });
            }
        }
    }
    Ok(())
}

fn check_events(tasks: &[Task], journal: &Journal) -> Result<(), JournalFault> {
    let mut given = vec![false; tasks.len()];
    let mut jobs = vec![None; journal.robots()];
    let mut now = 0;
    for (event, &Event { step, robot, task, news }) in journal.events().iter().enumerate() {
        let exists =
            robot < journal.robots() && task < tasks.len() && (now..=journal.steps()).contains(&step);
        if !exists {
            return Err(JournalFault::NoSuch { event });
        }
        now = step;
        match news {
            News::Assigned => {
                if given[task] || jobs[robot].is_some() {
                    return Err(JournalFault::GivenTwice { event, robot, task });
                }
                given[task] = true;
                jobs[robot] = Some((task, 0));
            }
            News::Done(errand) => {
                let errands = &tasks[task].errands;
                if jobs[robot] != Some((task, errand)) || errand >= errands.len() {
                    return Err(JournalFault::NotNext { step, robot, task, errand });
                }
                let cell = journal.cells(step)[robot];
                if cell != errands[errand] {
                    return Err(JournalFault::NotThere { step, robot, cell, errand: errands[errand] });
                }
                jobs[robot] = (errand + 1 < errands.len()).then_some((task, errand + 1));
            }
        }
    }
    Ok(())
}
