//! The one error type of the core: what is wrong, where, and what to do about it.

use crate::lattice::Cell;
use std::fmt;

/// Why the core refused a request. The names are those that the field uses (Nav2's planner errors among them).
///
/// ```
/// use activecell::{Error, Lattice, Map};
/// let error = Map::parse(Lattice::Square, "..\n.?").unwrap_err();
/// assert_eq!(error.to_string(), "map line 2, column 2: unexpected character `?`; use `.` for free, `#` for an obstacle, letters for named cells");
/// # assert!(matches!(error, Error::BadFormat { line: 2, column: 2, .. }));
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// The map would have more cells than a map may have.
    MapTooLarge {
        /// Columns asked for.
        width: u64,
        /// Rows asked for.
        height: u64,
        /// The most cells that a map may have.
        limit: u64,
    },
    /// The map has no cell.
    EmptyMap,
    /// A text map that cannot be read.
    BadFormat {
        /// Line, counted from 1.
        line: usize,
        /// Column, counted from 1.
        column: usize,
        /// What is wrong there and what would be right.
        reason: String,
    },
    /// A cell that does not lie on the map.
    OutsideMap {
        /// The cell.
        cell: Cell,
        /// Columns of the map.
        width: u32,
        /// Rows of the map.
        height: u32,
    },
    /// The start lies in an obstacle.
    StartOccupied {
        /// The start.
        cell: Cell,
        /// The free cell nearest to it, if the map has any.
        nearest: Option<Cell>,
    },
    /// The target lies in an obstacle.
    TargetOccupied {
        /// The target.
        cell: Cell,
        /// The free cell nearest to it, if the map has any.
        nearest: Option<Cell>,
    },
    /// Only a map of squares can be re-tiled.
    NotSquare,
    /// A walk was longer than its caller allowed.
    StepLimit {
        /// The number of steps after which it was given up.
        steps: usize,
    },
    /// A number outside its range.
    BadValue {
        /// What the number is, with its unit.
        name: &'static str,
        /// The number.
        value: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A log that tells nothing, or cannot be true.
    BadLog {
        /// The row, counted from 0, if it is one row's fault.
        row: Option<usize>,
        /// What is wrong and what would be right.
        reason: &'static str,
    },
    /// Cells in which the robot cannot keep clear of obstacles.
    TooTight {
        /// The size of the cells.
        cell_m: f64,
        /// The robot's radius.
        radius_m: f64,
        /// The least size that its errors and sensors allow.
        least_m: f64,
    },
    /// A rule that circles for ever was to find a way among unknown obstacles.
    NoMemory,
    /// Bytes that are no embedded map.
    BadEmbedded {
        /// The byte, counted from 0.
        offset: u64,
        /// What is wrong there.
        reason: &'static str,
    },
    /// The numbers of starts, targets and free cells do not fit.
    TeamSize {
        /// Starts given.
        starts: usize,
        /// Targets given.
        targets: usize,
        /// Free cells of the map.
        free: usize,
    },
    /// One robot of a team is at fault.
    OfRobot {
        /// The robot, counted from 0.
        robot: usize,
        /// What is wrong.
        error: Box<Error>,
    },
    /// Two robots of a team have the same start.
    SharedStart {
        /// The robots, counted from 0.
        robots: [usize; 2],
        /// Their start.
        cell: Cell,
    },
    /// Two robots of a team have the same target.
    SharedTarget {
        /// The robots, counted from 0.
        robots: [usize; 2],
        /// Their target.
        cell: Cell,
    },
    /// A robot that covers several cells has no room there.
    NoRoom {
        /// The cell of its centre.
        at: Cell,
        /// Its radius in cells.
        radius: u32,
        /// A cell that it would cover: an obstacle, or outside the map.
        covers: Cell,
    },
    /// Two robots of a team are too close at their starts or targets.
    TooClose {
        /// The robots, counted from 0.
        robots: [usize; 2],
        /// Their cells.
        cells: [Cell; 2],
        /// How far apart their centres must be at least, in cells.
        least: u32,
    },
    /// A connected part of the floor has more targets than robots.
    TooFewRobots {
        /// A target in it that would get no robot.
        cell: Cell,
        /// Robots that start in it.
        robots: usize,
        /// Targets in it.
        targets: usize,
    },
    /// A task without a cell to visit.
    EmptyTask,
    /// One task of many is at fault.
    OfTask {
        /// The task, counted from 0.
        task: usize,
        /// What is wrong.
        error: Box<Error>,
    },
    /// No way leads to a cell that a task wants visited.
    Unreachable {
        /// A cell where a robot is.
        from: Cell,
        /// The cell.
        to: Cell,
    },
    /// The cells of a plan are not a whole number of steps.
    PlanSize {
        /// Robots of the plan.
        robots: usize,
        /// Cells given.
        cells: usize,
    },
    /// A plan that breaks the rules.
    BadPlan {
        /// What is wrong, where.
        reason: String,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::MapTooLarge { width, height, limit } => write!(
                f,
                "map of {width} x {height} cells is too large: at most {limit} cells; choose larger cells or a part of the floor"
            ),
            Self::EmptyMap => write!(f, "the map has no cell; give it at least one row of `.` and `#`"),
            Self::BadFormat { line, column, reason } => {
                write!(f, "map line {line}, column {column}: {reason}")
            }
            Self::OutsideMap { cell, width, height } => write!(
                f,
                "cell {cell} is outside the map: x goes from 0 to {}, y from 0 (top) to {}",
                width.saturating_sub(1),
                height.saturating_sub(1)
            ),
            Self::StartOccupied { cell, nearest } => occupied(f, "start", *cell, *nearest),
            Self::TargetOccupied { cell, nearest } => occupied(f, "target", *cell, *nearest),
            Self::NotSquare => write!(f, "only a map of squares can be re-tiled; read it as squares first"),
            Self::StepLimit { steps } => {
                write!(f, "gave up after {steps} steps; raise the limit, or use the rule `wave`")
            }
            Self::BadLog { row: Some(row), reason } => write!(f, "row {row} of the log: {reason}"),
            Self::BadLog { row: None, reason } => f.write_str(reason),
            Self::TooTight { cell_m, radius_m, least_m } => write!(
                f,
                "cells of {cell_m} m are too small for a robot of radius {radius_m} m to keep clear of obstacles with its errors and sensors; use cells of at least {least_m:.3} m"
            ),
            Self::NoMemory => {
                write!(
                    f,
                    "the rule `published` has no memory for what is found on the way; use `wave` or `learning`"
                )
            }
            Self::BadEmbedded { offset, reason } => {
                write!(f, "embedded map, byte {offset}: {reason}; make the file anew")
            }
            // Not with hundreds of digits.
            Self::BadValue { name, value, allowed }
                if (1e-9..1e16).contains(&value.abs()) || *value == 0.0 =>
            {
                write!(f, "{name} is {value}; it must be {allowed}")
            }
            Self::BadValue { name, value, allowed } => write!(f, "{name} is {value:e}; it must be {allowed}"),
            _ => group(f, self),
        }
    }
}

/// What is wrong with a group.
fn group(f: &mut fmt::Formatter<'_>, error: &Error) -> fmt::Result {
    match error {
        Error::TeamSize { starts, targets, free } => write!(
            f,
            "a team of {starts} starts and {targets} targets on {free} free cells; give each robot one start and one target, and at most a robot a free cell"
        ),
        Error::OfRobot { robot, error } => write!(f, "robot {robot}: {error}"),
        Error::SharedStart { robots: [a, b], cell } => {
            write!(f, "robots {a} and {b} have the same start {cell}; give every robot its own")
        }
        Error::SharedTarget { robots: [a, b], cell } => {
            write!(f, "robots {a} and {b} have the same target {cell}; give every robot its own")
        }
        Error::TooFewRobots { cell, robots, targets } => {
            let s = if *robots == 1 { "" } else { "s" };
            let of = if *targets == 1 { "1 target" } else { &format!("{targets} targets") };
            write!(
                f,
                "the part of the floor around {cell} has {robots} robot{s} for {of}; give it a robot for each target"
            )
        }
        Error::EmptyTask => write!(f, "a task without a cell to visit; give it at least one"),
        Error::OfTask { task, error } => write!(f, "task {task}: {error}"),
        Error::Unreachable { from, to } => {
            write!(f, "no way leads from {from}, where a robot is, to {to}; leave out one or the other")
        }
        Error::PlanSize { robots, cells } => write!(
            f,
            "a plan of {cells} cells for {robots} robots; give a cell for every robot at every step, the start included"
        ),
        Error::BadPlan { reason } => write!(f, "the plan breaks the rules: {reason}"),
        Error::NoRoom { at, radius, covers } => write!(
            f,
            "a body of radius {radius} at {at} covers {covers}, an obstacle or outside the map; choose a cell with more room"
        ),
        Error::TooClose { robots: [a, b], cells: [at_a, at_b], least } => write!(
            f,
            "robots {a} and {b} at {at_a} and {at_b} are too close; their centres must be at least {least} cells apart"
        ),
        _ => Ok(()),
    }
}

fn occupied(f: &mut fmt::Formatter<'_>, role: &str, cell: Cell, nearest: Option<Cell>) -> fmt::Result {
    write!(f, "the {role} {cell} lies in an obstacle; ")?;
    match nearest {
        Some(free) => write!(f, "the nearest free cell is {free}"),
        None => write!(f, "the map has no free cell"),
    }
}

impl std::error::Error for Error {}
