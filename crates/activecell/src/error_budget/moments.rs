//! Second order and beyond: mean and covariance of the position, exact for given wheels.

use super::complex::{Complex, exp_over_line, exp_over_triangle};
use super::path::Leg;
use crate::program::{Drive, Errors, Robot, Veering, Wheels};

/// For wheels that are known: mean and covariance of position and heading.
///
/// Positions are complex numbers. With the wheels known the heading's noise is a sum of independent normal
/// deviations, so that the means of e^(i heading), of the position p, and of all products of two of them follow
/// from one leg to the next without any approximation; headings of any size are allowed. Covariances are carried,
/// not mean squares: nothing cancels far from the start.
///
/// That the means of sine and cosine of a normal angle are known exactly is used for single points by Lerro and
/// Bar-Shalom, *Tracking with Debiased Consistent Converted Measurements versus EKF*, 1993; the recursion over a way
/// whose runs bend and wander is ours.
#[derive(Debug, Clone)]
pub(super) struct Moments {
    /// Its share among all wheels.
    pub(super) weight: f64,
    wheels: Wheels,
    /// The mean of p.
    pub(super) at: Complex,
    /// The mean heading, and the variance that the noise gives it.
    pub(super) heading_rad: f64,
    pub(super) heading_variance: f64,
    /// The covariance of p and its conjugate: the variance along both axes together.
    pub(super) spread: f64,
    /// The covariance of p and p: the variance along x less that along y, and twice their covariance.
    pub(super) shape: Complex,
    /// The covariances of p with e^(-i heading) and e^(i heading).
    with_back: Complex,
    with_ahead: Complex,
}

/// The nodes at which a normal deviation is looked at, and their weights: exact for polynomials of degree 5, more
/// than second moments of second-order terms need (Gauss and Hermite).
const NODES: [(f64, f64); 3] =
    [(-1.732_050_807_568_877_2, 1.0 / 6.0), (0.0, 2.0 / 3.0), (1.732_050_807_568_877_2, 1.0 / 6.0)];

/// Every combination of nodes for the wheels of a robot; a deviation that does not matter has one node.
pub(super) fn every_wheels(robot: &Robot, heading_rad: f64) -> Vec<Moments> {
    let Errors { wheel_perimeter_rel, wheel_difference_rel, track_rel, .. } = robot.errors;
    let nodes = |deviation: f64, matters: bool| -> Vec<(f64, f64)> {
        let all: &[(f64, f64)] = if matters && deviation > 0.0 { &NODES } else { &[(0.0, 1.0)] };
        all.iter().map(|&(node, weight)| (deviation * node, weight)).collect()
    };
    let bends = robot.drive == Drive::Differential;
    let mut all = Vec::new();
    for (perimeter, first) in nodes(wheel_perimeter_rel, true) {
        for (difference, second) in nodes(wheel_difference_rel, bends) {
            for (track, third) in nodes(track_rel, bends) {
                let wheels = Wheels { perimeter: 1.0 + perimeter, difference, track: 1.0 + track };
                all.push(Moments::new(robot, wheels, first * second * third, heading_rad));
            }
        }
    }
    all
}

/// A robot whose heading turns more often in one run is lost: what is known of it becomes no number.
const MOST_PIECES: f64 = 100.0;

impl Moments {
    fn new(robot: &Robot, wheels: Wheels, weight: f64, heading_rad: f64) -> Self {
        Self {
            weight,
            wheels,
            at: Complex::ZERO,
            heading_rad,
            heading_variance: robot.errors.start_rad.powi(2),
            spread: 2.0 * robot.errors.start_m.powi(2),
            shape: Complex::ZERO,
            with_back: Complex::ZERO,
            with_ahead: Complex::ZERO,
        }
    }

    /// The mean of e^(i heading).
    fn ahead(&self) -> Complex {
        Complex::new(-self.heading_variance / 2.0, self.heading_rad).exp()
    }

    /// The mean of e^(2 i heading).
    fn twice_ahead(&self) -> Complex {
        Complex::new(-2.0 * self.heading_variance, 2.0 * self.heading_rad).exp()
    }

    pub(super) fn drive(&mut self, robot: &Robot, leg: Leg) {
        match leg {
            Leg::Run(length_m) => {
                let Veering { bend, wander } = self.wheels.veering(robot);
                // The power series want less than about one radian at a time.
                let pieces = (length_m.abs() * (bend.abs() + wander)).ceil().max(1.0);
                if pieces > MOST_PIECES {
                    self.spread = f64::NAN;
                    return;
                }
                for _ in 0..pieces as u32 {
                    self.run(robot, length_m / pieces, bend, wander);
                }
            }
            Leg::Stop => {
                let variance = robot.errors.stop_inertia_m.powi(2);
                self.spread += variance;
                self.shape += self.twice_ahead() * variance;
            }
            Leg::Turn(turn_rad) => {
                let scale = match robot.drive {
                    Drive::Steered => 1.0,
                    Drive::Differential => self.wheels.perimeter / self.wheels.track,
                };
                let variance = robot.errors.turn_rad.powi(2);
                let turned = Complex::new(-variance / 2.0, turn_rad * scale).exp();
                self.with_back = self.with_back * turned.conj();
                self.with_ahead = self.with_ahead * turned;
                self.heading_rad += turn_rad * scale;
                self.heading_variance += variance;
            }
        }
    }

    /// A run in which the heading bends, and wanders as a Brownian motion.
    ///
    /// With x = e^(i heading) at its begin, I the mean of e^(i heading) ÷ x along it and R that quotient at its end,
    /// the position gains Λ x I and x becomes x R; x is independent of I and R.
    fn run(&mut self, robot: &Robot, length_m: f64, bend: f64, wander: f64) {
        let (step_m, way_m) = (length_m * self.wheels.perimeter, length_m.abs());
        let once = Complex::new(-wander * way_m / 2.0, bend * length_m);
        let twice = Complex::new(-2.0 * wander * way_m, 2.0 * bend * length_m);
        let zero = Complex::ZERO;
        let (x, xx) = (self.ahead(), self.twice_ahead());
        // The variance of x, and its covariance with itself.
        let loss = -(-self.heading_variance).exp_m1();
        let fold = Complex::new(0.0, 2.0 * self.heading_rad).exp() * (-self.heading_variance).exp() * -loss;
        let end = once.exp();
        let mean = exp_over_line(zero, once);
        let own = 2.0 * exp_over_triangle(zero, zero, once).re - mean.norm();
        let own_fold = exp_over_triangle(zero, once, twice) * 2.0 - mean * mean;
        let with_end = exp_over_line(once, twice) - mean * end;
        let with_back_end = mean.conj() - mean * end.conj();

        let crossed = (mean.conj() * self.with_back).re;
        self.spread += 2.0 * step_m * crossed + step_m.powi(2) * (own + mean.norm() * loss);
        self.shape += mean * self.with_ahead * (2.0 * step_m);
        self.shape += (xx * own_fold + mean * mean * fold) * step_m.powi(2);
        self.with_back = self.with_back * end.conj() + (with_back_end + mean * end.conj() * loss) * step_m;
        self.with_ahead = self.with_ahead * end + (xx * with_end + mean * end * fold) * step_m;
        self.at += x * mean * step_m;

        let variance = robot.errors.unevenness_m_per_sqrt_m.powi(2) * way_m;
        match robot.drive {
            Drive::Steered => self.spread += 2.0 * variance,
            Drive::Differential => {
                self.spread += variance / 2.0;
                self.shape += xx * exp_over_line(zero, twice) * (variance / 2.0);
            }
        }
        self.heading_rad += bend * length_m;
        self.heading_variance += wander * way_m;
    }
}
