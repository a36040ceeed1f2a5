//! The checker: knows the map, the team and the rules of moving, and nothing of how plans are made.

use super::bodies::Standing;
use super::{Bodies, KeepOuts, Plan, Team};
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
    /// A robot that covers several cells covers one that is an obstacle or outside the map.
    NoRoom {
        /// The step.
        step: usize,
        /// The robot.
        robot: usize,
        /// Where its centre is.
        at: Cell,
        /// The cell that it covers.
        covers: Cell,
    },
    /// Two robots are closer than their sizes and the team's least distance allow.
    TooClose {
        /// The step.
        step: usize,
        /// The robots, the lower number first.
        robots: [usize; 2],
        /// Where their centres are.
        cells: [Cell; 2],
        /// How far apart the centres must be at least, in cells.
        least: u32,
    },
    /// A robot is in a cell that is closed at that time.
    Closed {
        /// The step.
        step: usize,
        /// The robot.
        robot: usize,
        /// Where its centre is.
        at: Cell,
        /// The closed cell.
        closed: Cell,
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

impl PlanFault {
    /// The step in which the robots arrive; `None` if it is no step's fault.
    pub const fn step(&self) -> Option<usize> {
        match *self {
            Self::WrongStart { .. } => Some(0),
            Self::Outside { step, .. }
            | Self::Blocked { step, .. }
            | Self::Jump { step, .. }
            | Self::Collision { step, .. }
            | Self::Swap { step, .. }
            | Self::NoRoom { step, .. }
            | Self::TooClose { step, .. }
            | Self::Closed { step, .. } => Some(step),
            Self::Robots { .. } | Self::NotArrived { .. } => None,
        }
    }
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
            Self::NoRoom { step, robot, at, covers } => {
                write!(
                    f,
                    "step {step}: robot {robot} at {at} covers {covers}, an obstacle or outside the map"
                )
            }
            Self::TooClose { step, robots: [a, b], cells: [at_a, at_b], least } => write!(
                f,
                "step {step}: robots {a} and {b} at {at_a} and {at_b} are too close; their centres must be at least {least} cells apart"
            ),
            Self::Closed { step, robot, at, closed } => {
                write!(f, "step {step}: robot {robot} at {at} is in {closed}, which is closed then")
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
/// Following into a cell that is being left is allowed. A team with [`Bodies`](super::Bodies) must have room and keep its
/// distances at every step; robots that do cannot pass through each other during one, as the chapter on bodies shows.
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
    check_bodies(map, team.bodies(), plan)?;
    let ends = plan.row(plan.steps()).iter().zip(team.targets()).enumerate();
    for (robot, (&cell, &target)) in ends {
        if cell != target {
            return Err(PlanFault::NotArrived { robot, cell, target });
        }
    }
    Ok(())
}

/// Checks what [`check_plan`] checks but starts and targets: that all stay on free cells, step to neighbours, and never
/// meet or swap.
///
/// # Errors
/// The first [`PlanFault`]: of the earliest step, there of the robot with the lowest number.
///
/// ```
/// use activecell::{Cell, Lattice, Map, Plan, check_moves};
/// let map = Map::parse(Lattice::Square, "...")?;
/// let plan = Plan::new(1, vec![Cell::new(0, 0), Cell::new(2, 0)])?;
/// assert_eq!(check_moves(&map, &plan).unwrap_err().to_string(), "step 1: robot 0 jumps from (0,0) to (2,0)");
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn check_moves(map: &Map, plan: &Plan) -> Result<(), PlanFault> {
    check_rows(map, plan.rows())
}

/// Checks where all robots are at each step, from step 0 on: on free cells of the map, a step apart, never two in a cell,
/// never two swapping.
pub(super) fn check_rows<'a>(map: &Map, rows: impl Iterator<Item = &'a [Cell]>) -> Result<(), PlanFault> {
    let mut before = Standing::new(map);
    let mut now = Standing::new(map);
    let mut past: Option<&[Cell]> = None;
    for (step, row) in rows.enumerate() {
        let from = past.unwrap_or(row);
        for (robot, &cell) in row.iter().enumerate() {
            check_move(map, step, robot, from[robot], cell)?;
            if let Some(other) = now.enter(cell, robot) {
                return Err(PlanFault::Collision { step, robots: [other, robot], cell });
            }
            // The one who was there before: if it is now where this robot was, they swapped.
            let other = before.who(cell).filter(|&other| other < robot && cell != from[robot]);
            if let Some(other) = other.filter(|&other| row[other] == from[robot]) {
                return Err(PlanFault::Swap { step, robots: [other, robot], cells: [row[other], cell] });
            }
        }
        if step > 0 {
            before.leave(from);
        }
        std::mem::swap(&mut before, &mut now);
        past = Some(row);
    }
    Ok(())
}

/// The same as [`check_moves`] for robots with bodies: they must have room and keep their distances at every step.
///
/// Swaps need no look where centres must be two cells apart or more: robots that were on either side of each other
/// would be too close after the step. Only one-cell robots without a distance can swap, and teams of bodies may have
/// some.
///
/// # Errors
/// The first [`PlanFault`]: of the earliest step, there of the robot with the lowest number.
///
/// ```
/// use activecell::{Bodies, Cell, Lattice, Map, Plan, check_bodies};
/// let map = Map::parse(Lattice::Square, "....")?;
/// let plan = Plan::new(2, [0, 3, 1, 2].map(|x| Cell::new(x, 0)).to_vec())?;
/// assert_eq!(check_bodies(&map, &Bodies::default(), &plan), Ok(()));
/// let fault = check_bodies(&map, &Bodies::new(vec![], 2)?, &plan).unwrap_err();
/// assert_eq!(
///     fault.to_string(),
///     "step 1: robots 0 and 1 at (1,0) and (2,0) are too close; their centres must be at least 2 cells apart"
/// );
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn check_bodies(map: &Map, bodies: &Bodies, plan: &Plan) -> Result<(), PlanFault> {
    if bodies.are_cells() {
        return check_moves(map, plan);
    }
    let (mut now, mut before) = (Standing::new(map), Standing::new(map));
    for (step, row) in plan.rows().enumerate() {
        let from = if step == 0 { row } else { plan.row(step - 1) };
        let moves = row.iter().enumerate().map(|(robot, &cell)| {
            check_move(map, step, robot, from[robot], cell)?;
            let mut block = map.lattice().block(cell, bodies.radius(robot));
            let covers = block.find(|&covered| !map.is_free(covered));
            covers.map_or(Ok(()), |covers| Err(PlanFault::NoRoom { step, robot, at: cell, covers }))
        });
        let mut moves = moves.enumerate();
        // Of several faults that of the robot with the lowest number counts.
        let bad = moves.find_map(|(robot, fault)| fault.err().map(|fault| (robot, fault)));
        let good = &row[..bad.map_or(row.len(), |(robot, _)| robot)];
        let close = bodies.first_too_close(&mut now, good);
        let swap = first_swap(&mut before, &from[..good.len()], good);
        if let Some(robots) = close.filter(|close| swap.is_none_or(|swap| close[1] <= swap[1])) {
            let [a, b] = robots;
            let least = bodies.apart(a, b);
            return Err(PlanFault::TooClose { step, robots, cells: [row[a], row[b]], least });
        }
        if let Some([a, b]) = swap {
            return Err(PlanFault::Swap { step, robots: [a, b], cells: [row[a], row[b]] });
        }
        if let Some((_, fault)) = bad {
            return Err(fault);
        }
    }
    Ok(())
}

/// The first two robots that swap cells in a step, in the order of the higher number.
fn first_swap(before: &mut Standing, from: &[Cell], to: &[Cell]) -> Option<[usize; 2]> {
    for (robot, &cell) in from.iter().enumerate() {
        before.enter(cell, robot);
    }
    let pair = to.iter().enumerate().find_map(|(robot, &cell)| {
        let other = before.who(cell).filter(|&other| other < robot)?;
        (to[other] == from[robot]).then_some([other, robot])
    });
    before.leave(from);
    pair
}

/// Checks that no robot of a plan covers a cell while it is closed. What is closed at the start was so before the plan
/// could do anything about it, and does not count; what is closed after the plan's last step does.
///
/// It comes on top of [`check_plan`], which knows nothing of closed cells.
///
/// # Errors
/// [`PlanFault::Robots`]; [`PlanFault::Closed`], of the earliest step, there of the robot with the lowest number.
///
/// ```
/// use activecell::{Cell, KeepOut, KeepOuts, Lattice, Map, Plan, Team, check_keep_outs};
/// let map = Map::parse(Lattice::Square, "...")?;
/// let cell = |x: i32| Cell::new(x, 0);
/// let keep_outs = KeepOuts::new(&map, vec![KeepOut { cell: cell(2), from_step: 1, to_step: 2 }])?;
/// let team = Team::new(&map, vec![cell(0)], vec![cell(2)])?;
/// let early = Plan::new(1, vec![cell(0), cell(1), cell(2)])?;
/// let fault = check_keep_outs(&map, &team, &keep_outs, &early).unwrap_err();
/// assert_eq!(fault.to_string(), "step 2: robot 0 at (2,0) is in (2,0), which is closed then");
/// let late = Plan::new(1, vec![cell(0), cell(1), cell(1), cell(2)])?;
/// assert!(check_keep_outs(&map, &team, &keep_outs, &late).is_ok());
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn check_keep_outs(map: &Map, team: &Team, keep_outs: &KeepOuts, plan: &Plan) -> Result<(), PlanFault> {
    if plan.robots() != team.robots() {
        return Err(PlanFault::Robots { plan: plan.robots(), team: team.robots() });
    }
    for step in 1..=keep_outs.last_step() {
        for (robot, &at) in plan.row(step as usize).iter().enumerate() {
            let mut block = map.lattice().block(at, team.bodies().radius(robot));
            if let Some(closed) = block.find(|&cell| keep_outs.is_closed(cell, step)) {
                return Err(PlanFault::Closed { step: step as usize, robot, at, closed });
            }
        }
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
