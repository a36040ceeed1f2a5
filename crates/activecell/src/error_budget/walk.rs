//! What is known of a robot on its way: in closed form while that holds, then by a crowd of sampled robots.

use super::linear::Linear;
use super::moments::{Moments, every_wheels};
use super::normal::{Covariance, mahalanobis_squared, region_95, share_inside};
use super::path::Leg;
use crate::map::{Map, PointM};
use crate::program::{Motion, Pose, Robot, Wheels};
use crate::rng::Rng;

/// Robots in a crowd: with 95 %, the share of them inside a cell is right to 0.01, that in a region to 0.005.
pub(super) const CROWD: usize = 10_000;
/// The least there are, for ways without end and robots that hardly know where they drive.
const LEAST_CROWD: usize = 200;
/// The pieces of way that all robots of a crowd drive together, as long as that leaves enough robots: seconds.
const PIECES: f64 = 3e7;
/// The crowd's chance is always the same.
const SEED: u64 = 0xce57;

/// How much a closed form may leave to higher orders: the share of the variance, in the direction where it is
/// largest, that first-order terms do not explain. Mean and covariance are right in any case, but higher orders bend
/// the ellipse into a banana. Measured over 1,200 random ways: up to this share the ellipse holds 94.8 % to 95 % on the
/// mean, and the probability of being inside is right to 0.01; at a share of one half 94.2 % and 0.04, and a robot
/// that is all banana 93.3 % and 0.1.
pub(super) const HIGHER_ORDERS: f64 = 0.1;

/// What is known of the position at one place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Known {
    pub(super) offset_m: PointM,
    pub(super) covariance_m2: Covariance,
    pub(super) heading_rad: f64,
    pub(super) radius_squared: f64,
    pub(super) inside: f64,
    pub(super) sampled: bool,
}

/// A robot on its way.
pub(super) struct Walk<'a> {
    map: &'a Map,
    robot: &'a Robot,
    begin: Pose,
    /// Without any error.
    pose: Pose,
    driven: Vec<Leg>,
    linear: Linear,
    moments: Vec<Moments>,
    /// How many pieces of way it may have to drive.
    pieces: f64,
    crowd: Option<Crowd<'a>>,
}

impl<'a> Walk<'a> {
    /// A robot that begins at a pose, with the errors of a start, on a way of about so many [`pieces`].
    pub(super) fn new(map: &'a Map, robot: &'a Robot, begin: Pose, pieces: f64) -> Self {
        let moments = every_wheels(robot, begin.bearing_rad);
        let linear = Linear::new(robot);
        Self { map, robot, begin, pose: begin, driven: Vec::new(), linear, moments, pieces, crowd: None }
    }

    pub(super) fn drive(&mut self, leg: Leg) {
        self.driven.push(leg);
        if let Some(crowd) = &mut self.crowd {
            crowd.drive(leg);
        } else {
            self.linear.drive(self.robot, leg, self.pose);
            for moments in &mut self.moments {
                moments.drive(self.robot, leg);
            }
        }
        self.pose = leg.from(self.pose);
    }

    /// What is known here, in the cell in which the robot should be. Once the closed form does not hold, all that
    /// follows is sampled.
    pub(super) fn known(&mut self) -> Known {
        if self.crowd.is_none() {
            let (known, higher) = self.closed();
            if higher <= HIGHER_ORDERS {
                return known;
            }
        }
        let crowd = self.crowd.get_or_insert_with(|| {
            let mut crowd = Crowd::new(self.robot, self.begin, self.pieces);
            self.driven.iter().for_each(|&leg| crowd.drive(leg));
            crowd
        });
        crowd.known(self.map, self.pose)
    }

    /// What the closed form says, and how much of it is above first order.
    pub(super) fn closed(&self) -> (Known, f64) {
        let division = self.robot.errors.cell_division_m.powi(2);
        let mean = |value: &dyn Fn(&Moments) -> f64| -> f64 {
            self.moments.iter().map(|moments| moments.weight * value(moments)).sum()
        };
        let [bx, by] = self.begin.at_m;
        let nominal = [self.pose.at_m[0] - bx, self.pose.at_m[1] - by];
        let offset_m = [mean(&|m| m.at.re - nominal[0]), mean(&|m| m.at.im - nominal[1])];
        // Within given wheels, and between them.
        let from_mean =
            |m: &Moments| [m.at.re - nominal[0] - offset_m[0], m.at.im - nominal[1] - offset_m[1]];
        let xx = mean(&|m| f64::midpoint(m.spread, m.shape.re) + from_mean(m)[0].powi(2));
        let yy = mean(&|m| (m.spread - m.shape.re) / 2.0 + from_mean(m)[1].powi(2));
        let xy = mean(&|m| m.shape.im / 2.0 + from_mean(m)[0] * from_mean(m)[1]);
        let heading_rad = mean(&|m| m.heading_rad);
        let heading = mean(&|m| m.heading_variance + (m.heading_rad - heading_rad).powi(2));
        let covariance_m2 = [[xx + division, xy], [xy, yy + division]];

        let linear = self.linear.covariance();
        let first = [[linear[0][0] + division, linear[0][1]], [linear[1][0], linear[1][1] + division]];
        let least_m = least_m(self.map);
        let lost = !(xx + yy).is_finite();
        let known = Known {
            offset_m,
            covariance_m2,
            heading_rad: heading.sqrt(),
            radius_squared: region_95(&covariance_m2, least_m),
            inside: if lost {
                0.0
            } else {
                share_inside(offset_m, &covariance_m2, &corners_m(self.map), least_m)
            },
            sampled: false,
        };
        (known, if lost { 1.0 } else { higher_share(&covariance_m2, &first, least_m) })
    }
}

/// The largest share, over all directions, by which one variance differs from another.
fn higher_share(all: &Covariance, first: &Covariance, least_m: f64) -> f64 {
    let least = least_m * least_m;
    let [[a, b], [_, c]] = [[all[0][0] + least, all[0][1]], [all[1][0], all[1][1] + least]];
    let [[d, e], [_, f]] =
        [[all[0][0] - first[0][0], all[0][1] - first[0][1]], [0.0, all[1][1] - first[1][1]]];
    // The eigenvalues of all⁻¹ (all - first).
    let determinant = a * c - b * b;
    let half = (d * c - 2.0 * e * b + f * a) / determinant / 2.0;
    let product = (d * f - e * e) / determinant;
    half.abs() + (half * half - product).max(0.0).sqrt()
}

/// Deviations below it are none.
fn least_m(map: &Map) -> f64 {
    1e-7 * map.frame().cell_m
}

/// The corners of a cell about its centre.
fn corners_m(map: &Map) -> Vec<PointM> {
    let (ux, uy) = map.lattice().unit_m();
    let (sin, cos) = map.frame().yaw_rad.sin_cos();
    let corner = |&(x, y): &(i64, i64)| {
        // Rows count downwards.
        let (x, y) = (x as f64 * ux * map.frame().cell_m, -(y as f64) * uy * map.frame().cell_m);
        [cos * x - sin * y, sin * x + cos * y]
    };
    map.lattice().corners().iter().map(corner).collect()
}

/// In how many pieces about a robot drives a way of these runs ([`Motion::roll`]).
pub(super) fn pieces(robot: &Robot, way_m: f64, runs: usize) -> f64 {
    let wheels = Wheels { difference: robot.errors.wheel_difference_rel, ..Wheels::NOMINAL };
    way_m * wheels.veering(robot).pieces_a_metre() + runs as f64
}

/// Fewer robots where each is driven in very many pieces, so that no way and no robot file takes for ever.
fn crowd_size(pieces: f64) -> usize {
    let most = PIECES / pieces.max(1.0);
    (most as usize).clamp(LEAST_CROWD, CROWD)
}

/// Many robots of one kind on the same way.
pub(super) struct Crowd<'a> {
    pub(super) robots: Vec<Motion<'a>>,
    division_m: f64,
    rng: Rng,
}

impl<'a> Crowd<'a> {
    pub(super) fn new(robot: &'a Robot, begin: Pose, pieces: f64) -> Self {
        let mut rng = Rng::new(SEED);
        let robots = (0..crowd_size(pieces)).map(|_| Motion::drawn(robot, begin, &mut rng)).collect();
        Self { robots, division_m: robot.errors.cell_division_m, rng }
    }

    pub(super) fn drive(&mut self, leg: Leg) {
        for robot in &mut self.robots {
            leg.drive(robot, &mut self.rng);
        }
    }

    pub(super) fn known(&self, map: &Map, pose: Pose) -> Known {
        let Pose { at_m: [x, y], bearing_rad } = pose;
        let mut rng = Rng::new(SEED ^ 1);
        let mut scatter = || self.division_m * rng.normal();
        // Where they are from the cell's true centre on.
        let offsets: Vec<PointM> = self
            .robots
            .iter()
            .map(|robot| robot.pose.at_m)
            .map(|[rx, ry]| [rx - x - scatter(), ry - y - scatter()])
            .collect();
        let share = 1.0 / self.robots.len() as f64;
        let mut offset_m = [0.0; 2];
        for offset in &offsets {
            (0..2).for_each(|axis| offset_m[axis] += share * offset[axis]);
        }
        let from_mean = |offset: &PointM| [offset[0] - offset_m[0], offset[1] - offset_m[1]];
        let mut covariance_m2 = [[0.0; 2]; 2];
        for offset in offsets.iter().map(from_mean) {
            for (row, a) in covariance_m2.iter_mut().zip(offset) {
                for (entry, b) in row.iter_mut().zip(offset) {
                    *entry += share * a * b;
                }
            }
        }
        let least_m = least_m(map);
        let mut distances: Vec<f64> = offsets
            .iter()
            .map(|offset| mahalanobis_squared(&covariance_m2, from_mean(offset), least_m))
            .collect();
        let (_, &mut radius_squared, _) =
            distances.select_nth_unstable_by(self.robots.len() * 95 / 100, f64::total_cmp);
        let cell = map.cell_at_m(pose.at_m);
        let [cx, cy] = map.centre_m(cell);
        let inside =
            offsets.iter().filter(|offset| map.cell_at_m([cx + offset[0], cy + offset[1]]) == cell).count();
        let heading: f64 =
            self.robots.iter().map(|robot| (robot.pose.bearing_rad - bearing_rad).powi(2)).sum();
        Known {
            offset_m,
            covariance_m2,
            heading_rad: (heading * share).sqrt(),
            radius_squared,
            inside: inside as f64 * share,
            sampled: true,
        }
    }
}
