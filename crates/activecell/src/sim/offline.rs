//! The offline mode: the program M driven with the robot's errors, no sensor asked.

use super::world::World;
use crate::lattice::Cell;
use crate::map::{Map, PointM};
use crate::program::{Motion, Pose, Program, Robot};
use crate::rng::Rng;

/// A program that is driven by chance, as often as is wanted.
///
/// ```
/// use activecell::{Cell, Errors, Lattice, Map, Robot, Rng, Rule, sim::{Offline, World}};
/// let map = Map::parse(Lattice::Square, "S....F\n......")?;
/// let route = map.route(Rule::Wave, Cell::new(0, 0), Cell::new(5, 0), 100)?;
/// let robot = Robot::default();
/// let (world, program) = (World::new(&map), route.program(&robot, &map, None));
/// let offline = Offline::new(&world, &program, &robot);
/// let trial = offline.trial(&mut Rng::new(1));
/// assert!(trial.end_error_m() < 0.2);
/// assert!(trial.contacts.is_empty());
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Offline<'a> {
    world: &'a World,
    program: &'a Program,
    robot: &'a Robot,
}

/// How one trial went.
#[derive(Debug, Clone, PartialEq)]
pub struct Trial {
    /// Where the robot came to rest at each waypoint of the program, in its map's metres: from the real centre of the
    /// cell, which the division of the floor puts elsewhere than the map, to the robot, added to the map's centre.
    pub waypoints_m: Vec<PointM>,
    /// From the real centre of the last waypoint's cell to where the robot ended.
    pub off_m: PointM,
    /// Where the robot's centre was when it began to touch an obstacle; it goes on as if there were none.
    pub contacts: Vec<PointM>,
}

impl Trial {
    /// How far from the target's centre the robot ended.
    pub fn end_error_m(&self) -> f64 {
        self.off_m[0].hypot(self.off_m[1])
    }
}

impl<'a> Offline<'a> {
    /// The program in a world.
    pub const fn new(world: &'a World, program: &'a Program, robot: &'a Robot) -> Self {
        Self { world, program, robot }
    }

    /// One drive.
    pub fn trial(&self, rng: &mut Rng) -> Trial {
        self.drive(rng, &mut |_| {})
    }

    /// One drive; `visit` is told each pose on the way, at most an eighth of a cell apart.
    pub fn drive(&self, rng: &mut Rng, visit: &mut dyn FnMut(Pose)) -> Trial {
        let (map, robot) = (self.world.map(), self.robot);
        let bearing_rad = self.program.heading.map_or(0.0, |dir| map.bearing_rad(dir));
        let planned = Pose { at_m: map.centre_m(self.program.start), bearing_rad };
        let mut motion = Motion::drawn(robot, planned, rng);
        let mut feeler = Feeler { world: self.world, radius_m: robot.radius_m, touching: false };
        let mut trial = Trial { waypoints_m: Vec::new(), off_m: [0.0; 2], contacts: Vec::new() };
        visit(motion.pose);
        for (waypoint, run_m) in self.program.waypoints.iter().zip(self.program.runs_m(map, robot)) {
            let pieces = pieces(map, run_m);
            for piece in 0..=pieces {
                let from_m = motion.pose.at_m;
                if piece < pieces {
                    motion.roll(run_m / f64::from(pieces), rng);
                } else if run_m != 0.0 {
                    motion.stop(rng);
                }
                if feeler.begins_to_touch(from_m, motion.pose.at_m) {
                    trial.contacts.push(motion.pose.at_m);
                }
                visit(motion.pose);
            }
            if waypoint.turn_deg != 0 {
                motion.turn(-f64::from(waypoint.turn_deg).to_radians(), rng);
            }
            let centre_m = map.centre_m(waypoint.cell);
            let division_m = robot.errors.cell_division_m;
            let at_m = [0, 1].map(|axis| motion.pose.at_m[axis] - division_m * rng.normal());
            trial.off_m = [at_m[0] - centre_m[0], at_m[1] - centre_m[1]];
            trial.waypoints_m.push(at_m);
        }
        trial
    }

    /// Whether the trial ended inside the cell of the last waypoint.
    pub fn ended_inside(&self, trial: &Trial) -> bool {
        let end: Option<(&PointM, Cell)> =
            trial.waypoints_m.last().zip(self.program.waypoints.last().map(|waypoint| waypoint.cell));
        end.is_none_or(|(&at_m, cell)| self.world.map().cell_at_m(at_m) == cell)
    }
}

/// How many pieces a run is driven in, so that contacts are seen on the way.
pub(super) fn pieces(map: &Map, run_m: f64) -> u32 {
    (run_m.abs() / map.frame().cell_m * 8.0).ceil().clamp(1.0, 1e9) as u32
}

/// Feels the obstacles that the robot's disc touches.
#[derive(Debug, Clone, Copy)]
pub(super) struct Feeler<'a> {
    pub(super) world: &'a World,
    pub(super) radius_m: f64,
    pub(super) touching: bool,
}

impl Feeler<'_> {
    /// Whether on this short way a contact begins.
    pub(super) fn begins_to_touch(&mut self, from_m: PointM, to_m: PointM) -> bool {
        let before = self.touching;
        let gap_m = self.world.gap_m(from_m, to_m, self.radius_m);
        self.touching = gap_m.is_some_and(|gap_m| gap_m < self.radius_m);
        self.touching && !before
    }
}
