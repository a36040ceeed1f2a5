//! The checker of schedules: knows the map, the plan and the schedule, and nothing of how schedules are made.

use super::Schedule;
use crate::fleet::Plan;
use crate::lattice::Cell;
use crate::map::Map;
use std::fmt;

/// What is wrong with a schedule. Visits of a robot are counted from 0, its start.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ScheduleFault {
    /// It is for another number of robots.
    Robots {
        /// Robots of the schedule.
        schedule: usize,
        /// Robots of the plan.
        plan: usize,
    },
    /// A robot's cells are not those of the plan, or not at their steps.
    Cells {
        /// The robot.
        robot: usize,
        /// The first visit that differs, is missing or is too much.
        visit: usize,
    },
    /// A cell is not passed in the plan's order.
    Order {
        /// The cell.
        cell: Cell,
        /// The robot.
        robot: usize,
        /// The visit that should follow another one than it does.
        visit: usize,
    },
    /// A move waits for one that the plan has later: the graph may have a cycle that is no ring.
    Backwards {
        /// The robot.
        robot: usize,
        /// The visit.
        visit: usize,
    },
}

impl fmt::Display for ScheduleFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Robots { schedule, plan } => {
                write!(f, "the schedule is for {schedule} robots, the plan for {plan}")
            }
            Self::Cells { robot, visit } => {
                write!(f, "robot {robot}, visit {visit}: not the plan's cell, or not at its step")
            }
            Self::Order { cell, robot, visit } => {
                write!(f, "robot {robot}, visit {visit}: {cell} is not passed in the plan's order")
            }
            Self::Backwards { robot, visit } => {
                write!(f, "robot {robot}, visit {visit}: waits for what the plan has later")
            }
        }
    }
}

impl std::error::Error for ScheduleFault {}

/// Checks a schedule against the plan that it was made from: every robot's cells, the order in which each cell is passed,
/// and that the graph has no cycle but rings.
///
/// For that it is enough to look at each dependency alone. The steps of the plan are an order in which the moves can be
/// done: a move waits for moves of earlier steps, or for one of its own step with which it goes in step. Within a step
/// each move waits for one at most, so that only rings can close, and the moves of a ring are one action. Two robots
/// never make a ring: they would swap.
///
/// Takes time for n log n in the plan's moves.
///
/// # Errors
/// A [`ScheduleFault`].
///
/// ```
/// use activecell::{Cell, Lattice, Map, Plan, Schedule, check_schedule, schedule::ScheduleFault};
/// let map = Map::parse(Lattice::Square, "...")?;
/// let [a, b, c] = [0, 1, 2].map(|x| Cell::new(x, 0));
/// let plan = Plan::new(2, vec![a, b, a, c, b, c])?;
/// let schedule = Schedule::new(&map, &plan)?;
/// assert_eq!(check_schedule(&map, &plan, &schedule), Ok(()));
/// let sooner = Plan::new(2, vec![a, b, b, c])?;
/// let fault = ScheduleFault::Cells { robot: 0, visit: 1 };
/// assert_eq!(check_schedule(&map, &sooner, &schedule), Err(fault));
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn check_schedule(map: &Map, plan: &Plan, schedule: &Schedule) -> Result<(), ScheduleFault> {
    if schedule.robots() != plan.robots() {
        return Err(ScheduleFault::Robots { schedule: schedule.robots(), plan: plan.robots() });
    }
    let passing = passing(map, plan, schedule)?;
    for (i, &[cell, step, robot, visit]) in passing.iter().enumerate() {
        let [robot, visit] = [robot, visit].map(|number| number as usize);
        let found = schedule.visit(robot, visit);
        let before = passing[..i].last().filter(|before| before[0] == cell);
        let expected = before.map(|before| (before[2] as usize, before[3] as usize));
        if found.after != expected {
            return Err(ScheduleFault::Order { cell: found.cell, robot, visit });
        }
        let Some((other, left)) = expected.filter(|&(other, _)| other != robot) else { continue };
        // The plan never has two in a cell, so the other one has left it.
        let backwards = ScheduleFault::Backwards { robot, visit };
        if schedule.visits(other).len() <= left + 1 {
            return Err(backwards);
        }
        let leaving = schedule.visit(other, left + 1);
        let in_step = leaving.step == step as usize;
        let swap = in_step && leaving.cell == schedule.visit(robot, visit - 1).cell;
        if leaving.step > step as usize || found.bend_deg.is_some() != in_step || swap {
            return Err(backwards);
        }
    }
    Ok(())
}

/// Of every visit the cell, the step, the robot and the number, as the plan has them; sorted, so that the visits of each
/// cell stand together in the plan's order.
fn passing(map: &Map, plan: &Plan, schedule: &Schedule) -> Result<Vec<[u32; 4]>, ScheduleFault> {
    let mut passing = Vec::with_capacity(schedule.moves() + schedule.robots());
    for robot in 0..plan.robots() {
        let begun = passing.len();
        let mut visits = schedule.visits(robot);
        for step in 0..=plan.steps() {
            let cell = plan.at(step, robot);
            if step > 0 && cell == plan.at(step - 1, robot) {
                continue;
            }
            let fault = ScheduleFault::Cells { robot, visit: passing.len() - begun };
            let same = visits.next().is_some_and(|visit| (visit.cell, visit.step) == (cell, step));
            let index = map.index(cell).filter(|_| same).ok_or(fault)?;
            passing.push([index, step, robot, passing.len() - begun].map(|number| number as u32));
        }
        if visits.next().is_some() {
            return Err(ScheduleFault::Cells { robot, visit: passing.len() - begun });
        }
    }
    passing.sort_unstable();
    Ok(passing)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fleet::schedule::NONE;
    use crate::lattice::Lattice;

    #[test]
    fn another_order_and_a_cycle_are_found() {
        let map = Map::parse(Lattice::Square, "...\n...").unwrap();
        let [a, b, c, d] = [(0, 0), (1, 0), (2, 0), (1, 1)].map(|(x, y)| Cell::new(x, y));
        // Robot 0 goes from a over b to c, then robot 1 from d to b.
        let plan = Plan::new(2, vec![a, d, b, d, c, d, c, b]).unwrap();
        let schedule = Schedule::new(&map, &plan).unwrap();
        assert_eq!(check_schedule(&map, &plan, &schedule), Ok(()));
        let mut other = schedule.clone();
        // Robot 1 first: its visit 1 of b after nobody, robot 0's after that.
        (other.before[1], other.before[4]) = (4, NONE);
        let fault = ScheduleFault::Order { cell: b, robot: 0, visit: 1 };
        assert_eq!(check_schedule(&map, &plan, &other), Err(fault));
        // A plan in which they swap gives a schedule in which each waits for the other.
        let swap = Plan::new(2, vec![a, b, b, a]).unwrap();
        let waiting = Schedule {
            first: vec![0, 2, 4],
            cells: vec![0, 1, 1, 0],
            steps: vec![0, 1, 0, 1],
            before: vec![NONE, 2, NONE, 0],
            ..schedule
        };
        let fault = ScheduleFault::Backwards { robot: 1, visit: 1 };
        assert_eq!(check_schedule(&map, &swap, &waiting), Err(fault));
    }
}
