//! Dead reckoning: a program driven wheel revolution by wheel revolution, and the check that it lands on every
//! cell of its route. Knows nothing of how programs are made.
//!
//! On uneven ground the wheels roll over the ground, not over the map. The replay measures it in its own way: it cuts
//! the way where it crosses the lines between posts, takes slopes from differences of heights, and adds them up by
//! Gauss's rule of five points.

use super::{Drive, Program, Robot};
use crate::lattice::Cell;
use crate::map::{Elevation, Ground, Map, PointM};
use std::f64::consts::PI;
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
    drive(map, robot, program, u64::MAX)
}

/// As [`replay`], and no further than `most` cells' lengths and one.
fn drive(map: &Map, robot: &Robot, program: &Program, most: u64) -> Vec<PointM> {
    let mut at = map.centre_m(program.start);
    let mut bearing_rad = program.heading.map_or(0.0, |heading| map.bearing_rad(heading));
    let mut points = vec![at];
    for waypoint in &program.waypoints {
        let run_m = waypoint.revolutions * robot.wheel_perimeter_m;
        let towards = if run_m < 0.0 { bearing_rad + PI } else { bearing_rad };
        let left = most.saturating_add(2).saturating_sub(points.len() as u64);
        match map.elevation() {
            None => roll(map, &mut at, towards, run_m.abs(), left, &mut points),
            Some(elevation) => {
                let hills = (elevation, map.ground());
                roll_over(hills, map.frame().cell_m, &mut at, towards, run_m.abs(), left, &mut points);
            }
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

/// A run over a flat floor, in pieces as long as cells.
fn roll(map: &Map, at: &mut PointM, towards: f64, run_m: f64, most: u64, points: &mut Vec<PointM>) {
    let from = *at;
    let pieces = (run_m / map.frame().cell_m).round() as u64; // none if it is no number
    for piece in 1..=pieces.min(most) {
        *at = ahead(from, towards, run_m * piece as f64 / pieces as f64);
        points.push(*at);
    }
}

/// A run over uneven ground: as many cells' lengths as the ground's length has room for.
fn roll_over(
    hills: (&Elevation, Ground),
    cell_m: f64,
    at: &mut PointM,
    towards: f64,
    run_m: f64,
    most: u64,
    points: &mut Vec<PointM>,
) {
    let from = *at;
    let (mut left_m, mut pieces, mut share) = (run_m, 0, 1.0);
    while pieces < most {
        let next = ahead(from, towards, (pieces + 1) as f64 * cell_m);
        let ground_m = ground_m(hills, *at, next);
        if left_m.is_nan() || left_m < ground_m / 2.0 {
            break;
        }
        (left_m, share, pieces, *at) = (left_m - ground_m, cell_m / ground_m, pieces + 1, next);
        points.push(next);
    }
    if let Some(last) = points.last_mut().filter(|_| pieces > 0) {
        // What the last piece has too little or too much.
        *at = ahead(from, towards, pieces as f64 * cell_m + left_m * share);
        *last = *at;
    }
}

fn ahead([x, y]: PointM, towards: f64, way_m: f64) -> PointM {
    [x + way_m * towards.cos(), y + way_m * towards.sin()]
}

/// Places and weights of Gauss's rule of five points between −1 and 1.
const GAUSS: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189),
    (-0.538_469_310_105_683, 0.478_628_670_499_366),
    (0.0, 0.568_888_888_888_889),
    (0.538_469_310_105_683, 0.478_628_670_499_366),
    (0.906_179_845_938_664, 0.236_926_885_056_189),
];

/// The length of the ground between two points; where a height is not known the ground is taken for flat.
fn ground_m((elevation, ground): (&Elevation, Ground), from: PointM, to: PointM) -> f64 {
    let length_m = (to[0] - from[0]).hypot(to[1] - from[1]);
    let (Some(begin_m), Some(end_m)) = (elevation.height_m(from), elevation.height_m(to)) else {
        return length_m;
    };
    if ground == Ground::Segments {
        return length_m.hypot(end_m - begin_m);
    }
    let height_m =
        |part: f64| elevation.height_m([0, 1].map(|axis| from[axis] + part * (to[axis] - from[axis])));
    let mut cuts = vec![0.0, 1.0];
    let (begin, end) = (elevation.in_posts(from), elevation.in_posts(to));
    for axis in 0..2 {
        let (low, high) = (begin[axis].min(end[axis]), begin[axis].max(end[axis]));
        let lines = low.ceil() as i64..=high.floor() as i64;
        if high - low > 1e-9 {
            cuts.extend(lines.map(|line| (line as f64 - begin[axis]) / (end[axis] - begin[axis])));
        }
    }
    cuts.sort_by(f64::total_cmp);
    let mut sum = 0.0;
    for cut in cuts.windows(2) {
        let width = cut[1] - cut[0];
        // Cut again, for cliffs.
        for quarter in 0..if width > 1e-9 { 4 } else { 0 } {
            let middle = cut[0] + width * (f64::from(quarter) + 0.5) / 4.0;
            for (place, weight) in GAUSS {
                let part = middle + place * width / 8.0;
                // The height is a parabola here: its slope is the difference about the place, however wide.
                let reach = (part - cut[0]).min(cut[1] - part);
                let Some((before, after)) = height_m(part - reach).zip(height_m(part + reach)) else {
                    return length_m;
                };
                sum += weight * width / 8.0 * length_m.hypot((after - before) / (2.0 * reach));
            }
        }
    }
    sum
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
        /// Steps driven, counted no further than one too many.
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
    let steps = cells.len().saturating_sub(1);
    // A wrong program may be longer than the memory: it is driven no further than shows that it is wrong.
    let points = drive(map, robot, program, steps as u64);
    let driven = points.len() as u64 - 1;
    if driven != steps as u64 {
        return Err(ProgramFault::WrongLength { driven, steps });
    }
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
