//! The checker: knows the map, the team and the rules of moving, and nothing of how plans are made.

use super::{Plan, Team};
use crate::lattice::Cell;
use crate::map::Map;
use std::fmt;

/// What is wrong with a plan. Robots are counted from 0, steps from 0, the start; a fault of a move has the number of
/// the step in which the robot arrives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlanFault {
    /// The plan is for another number of robots.
    Robots {
        /// Robots of the plan.
        plan: usize,
        /// Robots of the team.
        team: usize,
    },
    /// A robot starts elsewhere.
    WrongStart {
        /// The robot.
        robot: usize,
        /// Where it starts.
        cell: Cell,
        /// Where it should start.
        start: Cell,
    },
    /// A robot leaves the map.
    Outside {
        /// The step.
        step: usize,
        /// The robot.
        robot: usize,
        /// Where it is.
        cell: Cell,
    },
    /// A robot is in an obstacle.
    Blocked {
        /// The step.
        step: usize,
        /// The robot.
        robot: usize,
        /// Where it is.
        cell: Cell,
    },
    /// A robot moves to a cell that does not touch its own.
    Jump {
        /// The step.
        step: usize,
        /// The robot.
        robot: usize,
        /// Where it was.
        from: Cell,
        /// Where it is.
        to: Cell,
    },
    /// Two robots are in one cell.
    Collision {
        /// The step.
        step: usize,
        /// The robots, the lower number first.
        robots: [usize; 2],
        /// Where both are.
        cell: Cell,
    },
    /// Two robots swap cells.
    Swap {
        /// The step.
        step: usize,
        /// The robots, the lower number first.
        robots: [usize; 2],
        /// Where the robots are after the swap.
        cells: [Cell; 2],
    },
    /// A robot does not end at its target.
    NotArrived {
        /// The robot.
        robot: usize,
        /// Where it ends.
        cell: Cell,
        /// Where it should end.
        target: Cell,
    },
}

impl fmt::Display for PlanFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Robots { plan, team } => write!(f, "the plan is for {plan} robots, the team has {team}"),
            Self::WrongStart { robot, cell, start } => {
                write!(f, "robot {robot} starts at {cell}, not at its start {start}")
            }
            Self::Outside { step, robot, cell } => {
                write!(f, "step {step}: robot {robot} is at {cell}, outside the map")
            }
            Self::Blocked { step, robot, cell } => {
                write!(f, "step {step}: robot {robot} is at {cell}, in an obstacle")
            }
            Self::Jump { step, robot, from, to } => {
                write!(f, "step {step}: robot {robot} jumps from {from} to {to}")
            }
            Self::Collision { step, robots: [a, b], cell } => {
                write!(f, "step {step}: robots {a} and {b} are both at {cell}")
            }
            Self::Swap { step, robots: [a, b], cells: [at_a, at_b] } => {
                write!(f, "step {step}: robots {a} and {b} swap cells, {a} to {at_a} and {b} to {at_b}")
            }
            Self::NotArrived { robot, cell, target } => {
                write!(f, "robot {robot} ends at {cell}, not at its target {target}")
            }
        }
    }
}

impl std::error::Error for PlanFault {}

/// Checks that a plan takes every robot of the team from its start to its target by the rules: a step leads to a
/// neighbour or nowhere, never into an obstacle or off the map; never two robots in a cell, never two swapping.
/// Following into a cell that is being left is allowed.
///
/// Takes time for robots × steps and, while it runs, 8 bytes for each cell of the map.
///
/// # Errors
/// The first [`PlanFault`]: of the earliest step, there of the robot with the lowest number.
///
/// ```
/// use activecell::{Cell, Lattice, Map, Plan, PlanFault, Team, check_plan};
/// let map = Map::parse(Lattice::Square, "..")?;
/// let (west, east) = (Cell::new(0, 0), Cell::new(1, 0));
/// let team = Team::new(&map, vec![west, east], vec![east, west])?;
/// let plan = Plan::new(2, vec![west, east, east, west])?;
/// let fault = check_plan(&map, &team, &plan).unwrap_err();
/// assert_eq!(fault, PlanFault::Swap { step: 1, robots: [0, 1], cells: [east, west] });
/// assert_eq!(fault.to_string(), "step 1: robots 0 and 1 swap cells, 0 to (1,0) and 1 to (0,0)");
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn check_plan(map: &Map, team: &Team, plan: &Plan) -> Result<(), PlanFault> {
    if plan.robots() != team.robots() {
        return Err(PlanFault::Robots { plan: plan.robots(), team: team.robots() });
    }
    let starts = plan.row(0).iter().zip(team.starts()).enumerate();
    for (robot, (&cell, &start)) in starts {
        if cell != start {
            return Err(PlanFault::WrongStart { robot, cell, start });
        }
    }
    check_moves(map, plan.rows())?;
    let ends = plan.row(plan.steps()).iter().zip(team.targets()).enumerate();
    for (robot, (&cell, &target)) in ends {
        if cell != target {
            return Err(PlanFault::NotArrived { robot, cell, target });
        }
    }
    Ok(())
}

/// Checks where all robots are at each step, from step 0 on: on free cells of the map, a step apart, never two in a cell,
/// never two swapping.
pub(super) fn check_moves<'a>(map: &Map, rows: impl Iterator<Item = &'a [Cell]>) -> Result<(), PlanFault> {
    let mut before = Standing::new(map);
    let mut now = Standing::new(map);
    let mut past: Option<&[Cell]> = None;
    for (step, row) in rows.enumerate() {
        let from = past.unwrap_or(row);
        for (robot, &cell) in row.iter().enumerate() {
            check_move(map, step, robot, from[robot], cell)?;
            if let Some(other) = now.enter(map, cell, robot) {
                return Err(PlanFault::Collision { step, robots: [other, robot], cell });
            }
            // The one who was there before: if it is now where this robot was, they swapped.
            let other = before.who(map, cell).filter(|&other| other < robot && cell != from[robot]);
            if let Some(other) = other.filter(|&other| row[other] == from[robot]) {
                return Err(PlanFault::Swap { step, robots: [other, robot], cells: [row[other], cell] });
            }
        }
        if step > 0 {
            before.leave(map, from);
        }
        std::mem::swap(&mut before, &mut now);
        past = Some(row);
    }
    Ok(())
}

fn check_move(map: &Map, step: usize, robot: usize, from: Cell, to: Cell) -> Result<(), PlanFault> {
    if !map.contains(to) {
        return Err(PlanFault::Outside { step, robot, cell: to });
    }
    if !map.is_free(to) {
        return Err(PlanFault::Blocked { step, robot, cell: to });
    }
    if from != to && map.lattice().dir_between(from, to).is_none() {
        return Err(PlanFault::Jump { step, robot, from, to });
    }
    Ok(())
}

/// Who stands where.
struct Standing(Vec<u32>);

impl Standing {
    const NOBODY: u32 = u32::MAX;

    fn new(map: &Map) -> Self {
        Self(vec![Self::NOBODY; map.cells()])
    }

    fn who(&self, map: &Map, cell: Cell) -> Option<usize> {
        let robot = self.0[map.index(cell)?];
        (robot != Self::NOBODY).then_some(robot as usize)
    }

    /// Puts a robot into a cell; says who was there.
    fn enter(&mut self, map: &Map, cell: Cell, robot: usize) -> Option<usize> {
        let there = self.who(map, cell);
        if let Some(index) = map.index(cell) {
            self.0[index] = robot as u32;
        }
        there
    }

    fn leave(&mut self, map: &Map, cells: &[Cell]) {
        for index in cells.iter().filter_map(|&cell| map.index(cell)) {
            self.0[index] = Self::NOBODY;
        }
    }
}
