//! The certificate: how far a robot that drives a program by its wheels alone can be trusted.
//!
//! Its errors are those of [`Motion`](crate::Motion), no others. What is told of each waypoint is where the robot's
//! centre is from the true centre of its cell on, which [`Errors::cell_division_m`](crate::Errors) displaces.

mod complex;
mod fixes;
mod linear;
mod moments;
mod normal;
mod path;
#[cfg(test)]
mod tests;
mod trusted;
mod walk;

pub use fixes::{Fix, Fixes};
pub use normal::REGION_95;
pub use trusted::TrustedRoute;

use crate::lattice::Cell;
use crate::map::{Map, PointM};
use crate::program::{Program, Robot};
use normal::{mahalanobis_squared, main_axes};
use walk::{Known, Walk, pieces};

/// How far a robot can be trusted at each waypoint of its program.
///
/// ```
/// use activecell::{Cell, Certificate, Lattice, Map, Robot, Rule};
/// let map = Map::parse(Lattice::Square, "S........F")?; // 9 m
/// let route = map.route(Rule::Wave, Cell::new(0, 0), Cell::new(9, 0), 100)?;
/// let robot = Robot::default();
/// let certificate = Certificate::new(&map, &robot, &route.program(&robot, &map, None));
/// let end = certificate.worst().unwrap();
/// assert!(end.inside > 0.97 && end.method == activecell::Method::ClosedForm);
/// // The heading is the weak point: the region is longer across the way than along it.
/// let region = end.region();
/// assert!(region.semi_major_m > 0.2 && region.angle_rad.abs() > 1.5);
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Certificate {
    waypoints: Vec<Trust>,
}

/// How far the robot can be trusted at one waypoint: when it has come to rest there, before it turns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trust {
    /// The cell in which it should be.
    pub cell: Cell,
    /// That cell's centre on the floor.
    pub centre_m: PointM,
    /// The mean of where it is, from the cell's centre on.
    pub offset_m: PointM,
    /// The covariance of where it is, along x and y, in m².
    pub covariance_m2: [[f64; 2]; 2],
    /// One standard deviation of its heading.
    pub heading_deviation_rad: f64,
    /// The squared Mahalanobis distance from the mean within which it is with 95 %.
    pub radius_squared: f64,
    /// The probability that its centre is in the cell.
    pub inside: f64,
    /// How all this was found.
    pub method: Method,
}

/// How a waypoint's trust was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// By formulas.
    ClosedForm,
    /// By 10,000 robots drawn by chance (fewer, 200 at least, if each takes long to drive), always the same, because the errors are
    /// too large for the formulas.
    Sampled,
}

impl Method {
    /// The method's name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::ClosedForm => "closed_form",
            Self::Sampled => "sampled",
        }
    }
}

/// The ellipse in which a robot is with 95 %.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Region {
    /// Its middle on the floor.
    pub centre_m: PointM,
    /// Half its length.
    pub semi_major_m: f64,
    /// Half its width.
    pub semi_minor_m: f64,
    /// The direction of its length, counter-clockwise from the x axis, more than -π/2 and at most π/2.
    pub angle_rad: f64,
}

impl Certificate {
    /// The certificate of a program on the map for which it was made.
    pub fn new(map: &Map, robot: &Robot, program: &Program) -> Self {
        Self::walked(map, robot, program, Walk::known)
    }

    /// By the closed form, also where it does not hold.
    fn by_formulas(map: &Map, robot: &Robot, program: &Program) -> Self {
        Self::walked(map, robot, program, |walk| walk.closed().0)
    }

    fn walked<'a>(
        map: &'a Map,
        robot: &'a Robot,
        program: &Program,
        known: impl Fn(&mut Walk<'a>) -> Known,
    ) -> Self {
        let way_m = program.runs_m(map, robot).iter().map(|run_m| run_m.abs()).sum();
        let pieces = pieces(robot, way_m, program.waypoints.len());
        let mut walk = Walk::new(map, robot, path::start(map, program), pieces);
        let mut waypoints = Vec::with_capacity(program.waypoints.len());
        for ((run, turn), waypoint) in path::legs(map, robot, program).zip(&program.waypoints) {
            for leg in run {
                walk.drive(leg);
            }
            waypoints.push(Trust::new(map, waypoint.cell, &known(&mut walk)));
            if let Some(leg) = turn {
                walk.drive(leg);
            }
        }
        Self { waypoints }
    }

    /// For each waypoint of the program, in its order.
    pub fn waypoints(&self) -> &[Trust] {
        &self.waypoints
    }

    /// The waypoint where the robot is least likely in its cell, the first of several; `None` of an empty program.
    pub fn worst(&self) -> Option<&Trust> {
        self.waypoints.iter().min_by(|a, b| a.inside.total_cmp(&b.inside))
    }

    /// The probability at the worst waypoint; 1 for an empty program.
    fn worst_inside(&self) -> f64 {
        self.worst().map_or(1.0, |trust| trust.inside)
    }

    /// The first waypoint where the robot is in its cell with less than this probability.
    pub fn first_below(&self, threshold: f64) -> Option<&Trust> {
        self.waypoints.iter().find(|trust| trust.inside < threshold)
    }
}

impl Trust {
    fn new(map: &Map, cell: Cell, known: &Known) -> Self {
        Self {
            cell,
            centre_m: map.centre_m(cell),
            offset_m: known.offset_m,
            covariance_m2: known.covariance_m2,
            heading_deviation_rad: known.heading_rad,
            radius_squared: known.radius_squared,
            inside: known.inside,
            method: if known.sampled { Method::Sampled } else { Method::ClosedForm },
        }
    }

    /// The ellipse in which the robot is with 95 %.
    pub fn region(&self) -> Region {
        let (variances, angle_rad) = main_axes(&self.covariance_m2);
        let [semi_major_m, semi_minor_m] = variances.map(|variance| (variance * self.radius_squared).sqrt());
        let centre_m = [self.centre_m[0] + self.offset_m[0], self.centre_m[1] + self.offset_m[1]];
        Region { centre_m, semi_major_m, semi_minor_m, angle_rad }
    }

    /// Whether a point of the floor is in the region; deviations of less than a nanometre are none.
    pub fn region_holds(&self, point_m: PointM) -> bool {
        let offset = [0, 1].map(|axis| point_m[axis] - self.centre_m[axis] - self.offset_m[axis]);
        mahalanobis_squared(&self.covariance_m2, offset, 1e-9) <= self.radius_squared
    }
}
