//! Where a robot must learn its position and heading anew, to stay trusted.

use super::path::{self, Leg};
use super::walk::{Walk, pieces};
use crate::lattice::Cell;
use crate::map::Map;
use crate::program::{Pose, Program, Robot};
use std::ops::Range;

/// Where position and heading are to be fixed.
#[derive(Debug, Clone, PartialEq)]
pub struct Fixes {
    /// The fixes, in the order of the way.
    pub fixes: Vec<Fix>,
    /// The first cell that is not reached with the probability asked for even after a fix in the cell before it:
    /// fixes alone do not help this robot, and none is planned from there on. `None` if the fixes are enough.
    pub not_enough_at: Option<Cell>,
}

/// A fix of position and heading.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Fix {
    /// Where.
    pub cell: Cell,
    /// After so many steps from cell to cell.
    pub step: usize,
}

impl Fixes {
    /// Fixes with which a robot is, in each cell that its program leads through, there with at least the probability
    /// `threshold`: it drives as far as that holds, and fixes in the last cell where it does.
    ///
    /// After a fix, position and heading are as sure as at the start; the wheels' deviations stay what they were. A
    /// fix does not stop the robot. The start needs none: it is one.
    ///
    /// ```
    /// use activecell::{Cell, Errors, Fixes, Lattice, Map, Robot, Rule};
    /// let map = Map::parse(Lattice::Square, "S.............................F")?; // 30 m
    /// let route = map.route(Rule::Wave, Cell::new(0, 0), Cell::new(30, 0), 100)?;
    /// let robot = Robot::default();
    /// let fixes = Fixes::new(&map, &robot, &route.program(&robot, &map, None), 0.95);
    /// assert_eq!((fixes.fixes.len(), fixes.not_enough_at), (2, None));
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn new(map: &Map, robot: &Robot, program: &Program, threshold: f64) -> Self {
        Self::planned(map, robot, program, threshold, true)
    }

    /// As [`Fixes::new`]; ways that are alike are looked at once, or each anew.
    pub(super) fn planned(map: &Map, robot: &Robot, program: &Program, threshold: f64, once: bool) -> Self {
        let mut found = Self { fixes: Vec::new(), not_enough_at: None };
        if threshold <= 0.0 {
            return found;
        }
        let pieces = pieces(robot, FORESEEN as f64 * map.frame().cell_m, FORESEEN);
        let mut walk = Walk::new(map, robot, path::start(map, program), pieces);
        if walk.known().inside < threshold {
            found.not_enough_at = Some(program.start);
            return found;
        }
        let steps = steps(map, robot, program);
        if let Some((_, Some(turn))) =
            path::legs(map, robot, program).next().filter(|(run, _)| run.is_empty())
        {
            walk.drive(turn);
        }
        let mut from = 0;
        let mut below = first_below(walk, &steps, threshold);
        // Ways from a fix to the step before which the next one is needed.
        let mut ways: Vec<Range<usize>> = Vec::new();
        while let Some(step) = below {
            if step == from {
                found.not_enough_at = Some(steps[step].cell);
                // A fix that does not help is none.
                found.fixes.pop();
                break;
            }
            let Step { cell, pose, .. } = steps[step - 1];
            found.fixes.push(Fix { cell, step });
            from = step;
            below = if let Some(way) = ways.iter().find(|way| once && alike(&steps, way, from)) {
                Some(from + way.len())
            } else {
                let next = first_below(Walk::new(map, robot, pose, pieces), &steps[from..], threshold);
                next.map(|way| {
                    ways.push(from..from + way);
                    from + way
                })
            };
        }
        found
    }
}

/// A robot is reckoned to need a fix after so many steps at the latest; if not, it only takes longer to say.
const FORESEEN: usize = 100;

/// A step from cell to cell.
struct Step {
    /// What the robot does.
    legs: Vec<Leg>,
    /// Where it then is.
    cell: Cell,
    /// The turn that it makes there.
    turn: Option<Leg>,
    /// Its pose after that turn, without any error.
    pose: Pose,
}

/// After how many steps the robot is first in its cell with less than this probability.
fn first_below(mut walk: Walk<'_>, steps: &[Step], threshold: f64) -> Option<usize> {
    steps.iter().position(|Step { legs, turn, .. }| {
        for &leg in legs {
            walk.drive(leg);
        }
        let is_below = walk.known().inside < threshold;
        if let &Some(leg) = turn {
            walk.drive(leg);
        }
        is_below
    })
}

/// Whether the robot does from a step on what it did on an earlier way, up to where that needed the next fix. Then
/// its errors are the same too: all cells are alike.
fn alike(steps: &[Step], way: &Range<usize>, from: usize) -> bool {
    let same = |a: f64, b: f64| (a - b).abs() <= 1e-9 * (1.0 + a.abs());
    let same_leg = |a: &Leg, b: &Leg| match (a, b) {
        (Leg::Run(a), Leg::Run(b)) | (Leg::Turn(a), Leg::Turn(b)) => same(*a, *b),
        _ => a == b,
    };
    let same_legs = |a: &[Leg], b: &[Leg]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same_leg(a, b));
    let Some(other) = steps.get(from..=from + way.len()) else { return false };
    let (before, now) = (steps[way.start - 1].pose, steps[from - 1].pose);
    same((before.bearing_rad - now.bearing_rad).cos(), 1.0)
        && steps[way.start..=way.end]
            .iter()
            .zip(other)
            .all(|(a, b)| same_legs(&a.legs, &b.legs) && same_legs(a.turn.as_slice(), b.turn.as_slice()))
}

/// The program's steps from cell to cell. A turn before the first step is left out.
fn steps(map: &Map, robot: &Robot, program: &Program) -> Vec<Step> {
    let mut all = Vec::new();
    let lattice = map.lattice();
    let mut cell = program.start;
    let mut pose = path::start(map, program);
    for ((run, turn), waypoint) in path::legs(map, robot, program).zip(&program.waypoints) {
        let count = lattice.distance(cell, waypoint.cell);
        for step in 1..=count {
            let mut legs: Vec<Leg> = run.clone();
            if let [Leg::Run(length_m), Leg::Stop] = run[..] {
                let part = Leg::Run(length_m / f64::from(count));
                pose = part.from(pose);
                legs = if step == count { vec![part, Leg::Stop] } else { vec![part] };
            }
            cell = if step == count { waypoint.cell } else { map.cell_at_m(pose.at_m) };
            let turn = turn.filter(|_| step == count);
            all.push(Step { legs, cell, turn, pose: turn.map_or(pose, |turn| turn.from(pose)) });
        }
        pose = turn.map_or(pose, |turn| turn.from(pose));
    }
    all
}
