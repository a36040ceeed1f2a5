//! Where a robot must learn its position and heading anew, to stay trusted.

use super::path::{self, Leg};
use super::walk::Walk;
use crate::lattice::Cell;
use crate::map::Map;
use crate::program::{Pose, Program, Robot};

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
        let mut found = Self { fixes: Vec::new(), not_enough_at: None };
        let mut walk = Walk::new(map, robot, path::start(map, program));
        if walk.known().inside < threshold {
            found.not_enough_at = Some(program.start);
            return found;
        }
        let cells = cells(map, robot, program);
        if let Some((_, Some(turn))) =
            path::legs(map, robot, program).next().filter(|(run, _)| run.is_empty())
        {
            walk.drive(turn);
        }
        // Where the robot is: after so many steps, where a fix was made last.
        let (mut step, mut fixed) = (0, 0);
        let mut before: (Cell, Pose) = (program.start, walk.pose());
        while let Some((legs, cell, turn)) = cells.get(step) {
            for &leg in legs {
                walk.drive(leg);
            }
            if walk.known().inside < threshold {
                if fixed == step {
                    found.not_enough_at = Some(*cell);
                    // A fix that does not help is none.
                    if found.fixes.last().is_some_and(|fix| fix.step == step) {
                        found.fixes.pop();
                    }
                    return found;
                }
                fixed = step;
                found.fixes.push(Fix { cell: before.0, step });
                walk = Walk::new(map, robot, before.1);
                continue;
            }
            if let Some(leg) = turn {
                walk.drive(*leg);
            }
            step += 1;
            before = (*cell, walk.pose());
        }
        found
    }
}

/// For each step from cell to cell what the robot does, the cell where it then is, and the turn that it makes there.
/// A turn before the first step is left out.
fn cells(map: &Map, robot: &Robot, program: &Program) -> Vec<(Vec<Leg>, Cell, Option<Leg>)> {
    let mut all = Vec::new();
    let lattice = map.lattice();
    let mut cell = program.start;
    let mut pose = path::start(map, program);
    for ((run, turn), waypoint) in path::legs(map, robot, program).zip(&program.waypoints) {
        let steps = lattice.distance(cell, waypoint.cell);
        for step in 1..=steps {
            let mut legs: Vec<Leg> = run.clone();
            if let [Leg::Run(length_m), Leg::Stop] = run[..] {
                let part = Leg::Run(length_m / f64::from(steps));
                pose = part.from(pose);
                legs = if step == steps { vec![part, Leg::Stop] } else { vec![part] };
            }
            cell = if step == steps { waypoint.cell } else { map.cell_at_m(pose.at_m) };
            all.push((legs, cell, turn.filter(|_| step == steps)));
        }
        pose = turn.map_or(pose, |turn| turn.from(pose));
    }
    all
}
