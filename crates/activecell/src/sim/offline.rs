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
        for waypoint in &self.program.waypoints {
            let run_m = waypoint.revolutions * robot.wheel_perimeter_m;
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
            motion.turn(-f64::from(waypoint.turn_deg).to_radians(), rng);
            let centre_m = map.centre_m(waypoint.cell);
            let division_m = robot.errors.cell_division_m;
            let at_m = [0, 1].map(|axis| motion.pose.at_m[axis] - division_m * rng.normal());
            trial.off_m = [at_m[0] - centre_m[0], at_m[1] - centre_m[1]];
            trial.waypoints_m.push(at_m);
        }
        trial
    }

    /// For each waypoint the region that held 95 % of a normal distribution as these trials gave: what a certificate
    /// states in closed form, by sampling.
    pub fn sampled_regions(&self, trials: &[Trial]) -> Vec<Region> {
        let mut spreads = vec![Spread::default(); self.program.waypoints.len()];
        for trial in trials {
            for (spread, &at_m) in spreads.iter_mut().zip(&trial.waypoints_m) {
                spread.add(at_m);
            }
        }
        spreads.iter().map(Spread::region).collect()
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

/// A region of the floor in which a robot is thought to be: an ellipse, as a certificate states one for each waypoint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Region {
    /// Its centre.
    pub mean_m: PointM,
    /// Of x and y, in m².
    pub covariance_m2: [[f64; 2]; 2],
    /// The square of the Mahalanobis distance of its edge: 5.991 for 95 % of a normal distribution.
    pub squared_radius: f64,
}

impl Region {
    /// The square of the Mahalanobis distance beyond which 5 % of a normal distribution in the plane lie: −2 ln 0.05.
    pub const SQUARED_RADIUS_95: f64 = 5.991_464_547_107_979;

    /// Whether the point lies in the region. A covariance without extent holds its mean alone.
    ///
    /// ```
    /// use activecell::sim::Region;
    /// let region = Region { mean_m: [1.0, 0.0], covariance_m2: [[0.04, 0.0], [0.0, 0.01]], squared_radius: 4.0 };
    /// assert!(region.contains([1.39, 0.0]) && !region.contains([1.0, 0.21]));
    /// ```
    pub fn contains(&self, point_m: PointM) -> bool {
        let [[xx, xy], [_, yy]] = self.covariance_m2;
        let (dx, dy) = (point_m[0] - self.mean_m[0], point_m[1] - self.mean_m[1]);
        let determinant = xx * yy - xy * xy;
        if determinant <= 0.0 {
            return dx == 0.0 && dy == 0.0;
        }
        (yy * dx * dx - 2.0 * xy * dx * dy + xx * dy * dy) / determinant <= self.squared_radius
    }
}

/// Mean and covariance of points, taken in one after the other (Welford, *Note on a Method for Calculating Corrected
/// Sums of Squares and Products*, 1962).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Spread {
    count: f64,
    mean_m: PointM,
    sums_m2: [[f64; 2]; 2],
}

impl Spread {
    /// One point more.
    pub fn add(&mut self, point_m: PointM) {
        self.count += 1.0;
        let before = [point_m[0] - self.mean_m[0], point_m[1] - self.mean_m[1]];
        self.mean_m = [0, 1].map(|axis| self.mean_m[axis] + before[axis] / self.count);
        let after = [point_m[0] - self.mean_m[0], point_m[1] - self.mean_m[1]];
        for (row, before) in self.sums_m2.iter_mut().zip(before) {
            row[0] += before * after[0];
            row[1] += before * after[1];
        }
    }

    /// The region that holds 95 % of a normal distribution of this mean and covariance.
    ///
    /// ```
    /// use activecell::sim::Spread;
    /// let mut spread = Spread::default();
    /// [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0], [2.0, 2.0]].map(|point| spread.add(point));
    /// assert!(spread.region().contains([1.0, 3.0]));
    /// ```
    pub fn region(&self) -> Region {
        let scale = 1.0 / (self.count - 1.0).max(1.0);
        Region {
            mean_m: self.mean_m,
            covariance_m2: self.sums_m2.map(|row| row.map(|sum| sum * scale)),
            squared_radius: Region::SQUARED_RADIUS_95,
        }
    }
}
