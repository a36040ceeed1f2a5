//! Dead reckoning: a program driven wheel revolution by wheel revolution, and the check that it lands on every
//! cell of its route. Knows nothing of how programs are made.

use super::{Drive, Program, Robot, Waypoint};
use crate::lattice::Cell;
use crate::map::{Map, PointM};
use std::fmt;

/// Where a robot without any error is, once for each cell's length that it drives: the start first, then every
/// further centre. Reckoned from the wheels alone; the program's cells are not looked at.
///
/// ```
/// use activecell::{Cell, Lattice, Map, Robot, Rule, replay};
/// let map = Map::parse(Lattice::Hex, "...\n...\n...")?;
/// let (from, to) = (Cell::new(0, 0), Cell::new(2, 2));
/// let robot = Robot::default();
/// let route = map.route(Rule::Wave, from, to, 100)?;
/// let driven: Vec<Cell> = replay(&map, &robot, &route.program(&robot, &map, None)).into_iter()
///     .map(|point| map.cell_at_m(point)).collect();
/// assert_eq!(driven, route.cells());
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn replay(map: &Map, robot: &Robot, program: &Program) -> Vec<PointM> {
    let [mut x, mut y] = map.centre_m(program.start);
    let mut bearing_rad = program.heading.map_or(0.0, |heading| map.bearing_rad(heading));
    let mut points = vec![[x, y]];
    for waypoint in &program.waypoints {
        let run_m = waypoint.revolutions * robot.wheel_perimeter_m;
        let pieces = pieces(map, robot, waypoint);
        let (from_x, from_y) = (x, y);
        for piece in 1..=pieces {
            let driven_m = run_m * piece as f64 / pieces as f64;
            (x, y) = (from_x + driven_m * bearing_rad.cos(), from_y + driven_m * bearing_rad.sin());
            points.push([x, y]);
        }
        // Right turns are clockwise, bearings counter-clockwise.
        bearing_rad -= match robot.drive {
            Drive::Steered => f64::from(waypoint.turn_deg).to_radians(),
            Drive::Differential => {
                let arc_m = waypoint.turn_revolutions * robot.wheel_perimeter_m;
                f64::from(waypoint.turn_deg.signum()) * 2.0 * arc_m / robot.track_m
            }
        };
    }
    points
}

/// How many cells' lengths a run is long; none if it is no number.
fn pieces(map: &Map, robot: &Robot, waypoint: &Waypoint) -> u64 {
    (waypoint.revolutions * robot.wheel_perimeter_m / map.frame().cell_m).abs().round() as u64
}

/// Where a program leaves its route.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ProgramFault {
    /// After this many cells' lengths the robot is not at the centre of that cell of the route.
    OffRoute {
        /// How many cells' lengths were driven.
        step: usize,
        /// Where the robot should be.
        cell: Cell,
        /// How far from its centre it is.
        distance_m: f64,
    },
    /// The program drives another number of cells' lengths than the route has steps.
    WrongLength {
        /// Steps driven.
        driven: u64,
        /// Steps of the route.
        steps: usize,
    },
}

impl fmt::Display for ProgramFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OffRoute { step, cell, distance_m } => {
                write!(f, "after {step} steps the program is {distance_m} m away from the cell {cell}")
            }
            Self::WrongLength { driven, steps } => {
                write!(f, "the program drives {driven} steps, the route has {steps}")
            }
        }
    }
}

impl std::error::Error for ProgramFault {}

/// Checks by dead reckoning that the program leads through the centre of each of these cells.
///
/// # Errors
/// The first [`ProgramFault`].
pub fn check_program(
    map: &Map,
    robot: &Robot,
    program: &Program,
    cells: &[Cell],
) -> Result<(), ProgramFault> {
    // Counted before it is driven: a wrong program may be longer than the memory.
    let runs = program.waypoints.iter().map(|waypoint| pieces(map, robot, waypoint));
    let driven = runs.fold(0, u64::saturating_add);
    let steps = cells.len().saturating_sub(1);
    if driven != steps as u64 {
        return Err(ProgramFault::WrongLength { driven, steps });
    }
    let points = replay(map, robot, program);
    // Rounding grows with the way; a millionth of a cell each step is far above it and far below any harm.
    let tolerance_m = |step: usize| 1e-6 * map.frame().cell_m * (step + 1) as f64;
    for (step, (point, &cell)) in points.iter().zip(cells).enumerate() {
        let centre = map.centre_m(cell);
        let distance_m = (point[0] - centre[0]).hypot(point[1] - centre[1]);
        // A program that is not a number is off its route too.
        if distance_m.is_nan() || distance_m > tolerance_m(step) {
            return Err(ProgramFault::OffRoute { step, cell, distance_m });
        }
    }
    Ok(())
}
