//! The program M: a route as straight runs, counted in wheel revolutions, and turns.

mod drive;
mod motion;
mod replay;
mod robot;
mod slopes;

pub use drive::{Effort, Ticks};
pub(crate) use motion::Veering;
pub use motion::{Motion, Pose, Wheels};
pub use replay::{ProgramFault, check_program, replay};
pub use robot::{Drive, Errors, Power, Robot, Sensors, Slopes};
pub use slopes::check_slopes;

use crate::lattice::{Cell, Dir};
use crate::map::Map;
use crate::route::Route;

/// One entry (X, Y, Z, L) of the paper's M: drive L revolutions to the cell (X, Y), there turn by Z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Waypoint {
    /// Where the run ends.
    pub cell: Cell,
    /// Wheel revolutions of the run to this cell, over the ground; negative backwards.
    pub revolutions: f64,
    /// All climbs of the run together, in metres; what goes down again is not taken off. 0 on a flat floor.
    pub climb_m: f64,
    /// The turn made there: degrees, right (clockwise) positive. 0 at the target, and where the robot only
    /// changes between forwards and backwards.
    pub turn_deg: i32,
    /// The revolutions that each wheel makes in that turn, left and right with opposite signs; 0 if the wheels
    /// are steered.
    pub turn_revolutions: f64,
}

/// A robot's program for one route. The last waypoint is the route's end, with no turn.
#[derive(Debug, Clone, PartialEq)]
pub struct Program {
    /// Where the robot starts.
    pub start: Cell,
    /// Where it faces at the start; `None` for a route without a step.
    pub heading: Option<Dir>,
    /// Run, turn, run, turn, …, run.
    pub waypoints: Vec<Waypoint>,
}

impl Program {
    /// How many turns the robot makes.
    pub fn turns(&self) -> usize {
        self.waypoints.iter().filter(|waypoint| waypoint.turn_deg != 0).count()
    }

    /// How far each run takes the robot over the map, in metres, negative backwards. On a flat floor that is what its
    /// wheels roll; on uneven ground they roll more, and it is the distance between the cells.
    ///
    /// ```
    /// use activecell::{Cell, Lattice, Map, Robot, Rule};
    /// let map = Map::parse(Lattice::Square, "S..F")?;
    /// let robot = Robot::default();
    /// let route = map.route(Rule::Wave, Cell::new(0, 0), Cell::new(3, 0), 100)?;
    /// assert_eq!(route.program(&robot, &map, None).runs_m(&map, &robot), [3.0]);
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn runs_m(&self, map: &Map, robot: &Robot) -> Vec<f64> {
        let mut before = self.start;
        let runs = self.waypoints.iter().map(|waypoint| {
            let from = map.centre_m(std::mem::replace(&mut before, waypoint.cell));
            if map.elevation().is_none() {
                return waypoint.revolutions * robot.wheel_perimeter_m;
            }
            let to = map.centre_m(waypoint.cell);
            (to[0] - from[0]).hypot(to[1] - from[1]).copysign(waypoint.revolutions)
        });
        runs.collect()
    }

    /// All revolutions of all runs, forwards and backwards; turns in place are not counted.
    pub fn revolutions(&self) -> f64 {
        self.waypoints.iter().map(|waypoint| waypoint.revolutions.abs()).sum()
    }
}

impl Route {
    /// The program that drives `robot` along this route over the floor of `map`.
    ///
    /// If the map has an elevation, a run is as long as its ground ([`crate::Ground`]): 10 m of map on a ramp of 10°
    /// are 10.154 m.
    ///
    /// `heading` is where the robot faces at first; `None`: along its first run. If a turn is needed before the
    /// first run, the first waypoint is the start itself, with 0 revolutions. A run straight back is driven in
    /// reverse (L < 0) if the robot can, else after a turn of 180°.
    ///
    /// ```
    /// use activecell::{Cell, Dir, Lattice, Map, Robot, Rule};
    /// let map = Map::parse(Lattice::Square, "...F\n.###\n.###")?;
    /// let route = map.route(Rule::Wave, Cell::new(0, 2), Cell::new(3, 0), 100)?;
    /// let robot = Robot { wheel_perimeter_m: 0.8, ..Robot::default() };
    /// let program = route.program(&robot, &map, Some(Dir::N));
    /// let m: Vec<_> = program.waypoints.iter().map(|w| (w.cell.x, w.cell.y, w.turn_deg, w.revolutions)).collect();
    /// assert_eq!(m, [(0, 0, 90, 2.5), (3, 0, 0, 3.75)]);
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn program(&self, robot: &Robot, map: &Map, heading: Option<Dir>) -> Program {
        let lattice = self.lattice();
        let start = self.cells()[0];
        let mut runs: Vec<(Dir, usize)> = Vec::new();
        for dir in self.dirs() {
            match runs.last_mut() {
                Some(run) if run.0 == dir => run.1 += 1,
                _ => runs.push((dir, 1)),
            }
        }
        let heading = heading.or(runs.first().map(|run| run.0));
        let mut waypoints = vec![Waypoint {
            cell: start,
            revolutions: 0.0,
            climb_m: 0.0,
            turn_deg: 0,
            turn_revolutions: 0.0,
        }];
        let mut step = 0;
        let mut facing = heading.unwrap_or(Dir(0));
        for (dir, steps) in runs {
            let back = dir == lattice.opposite(facing) && robot.can_reverse;
            if !back {
                let turn_deg = lattice.turn_deg(facing, dir);
                let here = waypoints.len() - 1;
                waypoints[here].turn_deg = turn_deg;
                waypoints[here].turn_revolutions = robot.turn_revolutions(turn_deg);
                facing = dir;
            }
            let cells = &self.cells()[step..=step + steps];
            step += steps;
            let run = robot.revolutions(map.ground_m(cells));
            let revolutions = if back { -run } else { run };
            waypoints.push(Waypoint {
                cell: self.cells()[step],
                revolutions,
                climb_m: map.climb_m(cells),
                turn_deg: 0,
                turn_revolutions: 0.0,
            });
        }
        if waypoints.len() > 1 && waypoints[0].turn_deg == 0 {
            waypoints.remove(0);
        }
        Program { start, heading, waypoints }
    }
}
