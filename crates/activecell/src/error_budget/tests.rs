//! The pieces of the closed form against finite differences, against each other, and against sampling.

use super::fixes::Fixes;
use super::linear::Linear;
use super::normal::mahalanobis_squared;
use super::path::Leg;
use super::walk::{CROWD, Crowd, HIGHER_ORDERS, Walk};
use crate::lattice::{Cell, Lattice};
use crate::map::Map;
use crate::program::{Drive, Errors, Motion, Pose, Robot, Wheels};
use crate::rng::Rng;
use std::f64::consts::FRAC_PI_3;

const DRIVES: [Drive; 2] = [Drive::Steered, Drive::Differential];
const BEGIN: Pose = Pose { at_m: [1.0, 2.0], bearing_rad: 0.7 };

/// Runs forwards and backwards, with stops and turns.
fn legs(rng: &mut Rng) -> Vec<Leg> {
    let mut legs = Vec::new();
    for _ in 0..=rng.below(5) {
        let length_m = (10.0 * rng.unit() + 0.5) * if rng.chance(0.2) { -1.0 } else { 1.0 };
        let turn_rad = [1.0, -1.0, 2.0, -2.0, 1.5][rng.below(5) as usize] * FRAC_PI_3;
        legs.extend([Leg::Run(length_m), Leg::Stop, Leg::Turn(turn_rad)]);
    }
    legs
}

/// Some errors none, the others of all sizes about these.
fn errors(typical: f64, rng: &mut Rng) -> Errors {
    let mut size =
        |value: f64| if rng.chance(0.35) { 0.0 } else { typical * value * (4.0 * rng.unit() - 2.0).exp() };
    Errors {
        wheel_perimeter_rel: size(0.005),
        wheel_difference_rel: size(0.0005),
        track_rel: size(0.005),
        unevenness_m_per_sqrt_m: size(0.001),
        cell_division_m: size(0.003),
        stop_inertia_m: size(0.003),
        turn_rad: size(0.02),
        start_m: size(0.01),
        start_rad: size(0.02),
    }
}

fn linear(robot: &Robot, legs: &[Leg]) -> [[f64; 3]; 3] {
    let (mut linear, mut pose) = (Linear::new(robot), BEGIN);
    for leg in legs {
        linear.drive(robot, *leg, pose);
        pose = leg.from(pose);
    }
    linear.covariance()
}

/// Where a robot ends whose wheels, or whose start, are off by so much.
type Ends<'a> = &'a dyn Fn(f64) -> [f64; 3];

#[test]
fn columns_are_the_finite_differences_of_the_motion() {
    let step = 1e-6;
    for case in 0..100 {
        let mut rng = Rng::new(case);
        let legs = legs(&mut rng);
        let drive = DRIVES[case as usize % 2];
        let still = Robot { errors: Errors::NONE, drive, ..Robot::default() };
        let end = |wheels: Wheels, turned_rad: f64| {
            let begin = Pose { bearing_rad: BEGIN.bearing_rad + turned_rad, ..BEGIN };
            let mut motion = Motion::new(&still, wheels, begin);
            for leg in &legs {
                leg.drive(&mut motion, &mut Rng::new(1));
            }
            [motion.pose.at_m[0], motion.pose.at_m[1], motion.pose.bearing_rad]
        };
        let nominal = Wheels::NOMINAL;
        let sources: [(Errors, Ends<'_>); 4] = [
            (Errors { wheel_perimeter_rel: 1.0, ..Errors::NONE }, &|h| {
                end(Wheels { perimeter: 1.0 + h, ..nominal }, 0.0)
            }),
            (Errors { wheel_difference_rel: 1.0, ..Errors::NONE }, &|h| {
                end(Wheels { difference: h, ..nominal }, 0.0)
            }),
            (Errors { track_rel: 1.0, ..Errors::NONE }, &|h| end(Wheels { track: 1.0 + h, ..nominal }, 0.0)),
            (Errors { start_rad: 1.0, ..Errors::NONE }, &|h| end(nominal, h)),
        ];
        for (errors, end) in sources {
            let (more, less) = (end(step), end(-step));
            let column = [0, 1, 2].map(|axis| (more[axis] - less[axis]) / (2.0 * step));
            let found = linear(&Robot { errors, ..still }, &legs);
            for (row, a) in found.iter().zip(column) {
                for (entry, b) in row.iter().zip(column) {
                    assert!(
                        (entry - a * b).abs() < 1e-3 * (1.0 + (a * b).abs()),
                        "{case}: {entry} {}",
                        a * b
                    );
                }
            }
        }
    }
}

/// The exact moments become the linear ones as errors become small; they share no line of code.
#[test]
fn small_errors_have_the_linear_covariance() {
    let map = Map::random(Lattice::Square, 4, 4, 0.0, 1).unwrap();
    for case in 0..400 {
        let mut rng = Rng::new(case);
        let legs = legs(&mut rng);
        let errors = errors(1e-3, &mut rng);
        let robot = Robot { errors, drive: DRIVES[case as usize % 2], ..Robot::default() };
        let mut walk = Walk::new(&map, &robot, BEGIN, 1.0);
        for leg in &legs {
            walk.drive(*leg);
        }
        let (known, higher) = walk.closed();
        let linear = linear(&robot, &legs);
        let division = errors.cell_division_m.powi(2);
        let expected = [[linear[0][0] + division, linear[0][1]], [linear[1][0], linear[1][1] + division]];
        let scale = expected[0][0] + expected[1][1] + 1e-18;
        for (row, other) in known.covariance_m2.iter().zip(expected) {
            for (a, b) in row.iter().zip(other) {
                assert!((a - b).abs() < 1e-3 * scale, "{case}: {a} {b}");
            }
        }
        assert!(
            (known.heading_rad - linear[2][2].sqrt()).abs() < 1e-4 * (known.heading_rad + 1e-9),
            "{case}"
        );
        assert!(higher < HIGHER_ORDERS, "{case}: {higher}");
    }
}

/// Mean and covariance are right however large the errors; the ellipse and the share inside while the closed form
/// says that it holds.
#[test]
fn the_closed_form_agrees_with_sampling() {
    let (mut held, mut all) = (0, 0);
    for case in 0..400 {
        let mut rng = Rng::new(case);
        let map = Map::random(Lattice::ALL[case as usize % 2], 4, 4, 0.0, 1).unwrap();
        let legs = legs(&mut rng);
        let errors = errors(1.0, &mut rng);
        let robot = Robot { errors, drive: DRIVES[case as usize / 2 % 2], ..Robot::default() };
        let mut walk = Walk::new(&map, &robot, BEGIN, 1.0);
        let mut crowd = Crowd::new(&robot, BEGIN, 1.0);
        for leg in &legs {
            walk.drive(*leg);
            crowd.drive(*leg);
        }
        let (known, higher) = walk.closed();
        let pose = legs.iter().fold(BEGIN, |pose, leg| leg.from(pose));
        let sampled = crowd.known(&map, pose);
        let [[xx, xy], [_, yy]] = known.covariance_m2;
        let found = sampled.covariance_m2;
        for (a, b, scale) in
            [(xx, found[0][0], xx), (yy, found[1][1], yy), (xy, found[0][1], (xx * yy).sqrt())]
        {
            assert!((a - b).abs() < 0.1 * scale + 1e-12, "{case}: {a} {b}");
        }
        for (axis, variance) in [xx, yy].into_iter().enumerate() {
            let apart = (known.offset_m[axis] - sampled.offset_m[axis]).abs();
            assert!(apart < 5.0 * (variance / CROWD as f64).sqrt() + 1e-9, "{case}: {apart}");
        }
        let heading = (known.heading_rad - sampled.heading_rad).abs();
        assert!(heading < 0.05 * known.heading_rad + 1e-9, "{case}: {heading}");
        all += 1;
        if higher > HIGHER_ORDERS {
            continue;
        }
        held += 1;
        assert!((known.inside - sampled.inside).abs() < 0.03, "{case}: {} {}", known.inside, sampled.inside);
        let mut scatter = Rng::new(case + 1000);
        let [x, y] = pose.at_m;
        let division_m = errors.cell_division_m;
        let [mx, my] = known.offset_m;
        let offsets = crowd.robots.iter().map(|robot| robot.pose.at_m).map(|[rx, ry]| {
            [rx - x - mx - division_m * scatter.normal(), ry - y - my - division_m * scatter.normal()]
        });
        let hits = offsets
            .filter(|offset| mahalanobis_squared(&known.covariance_m2, *offset, 1e-7) <= known.radius_squared)
            .count();
        let coverage = hits as f64 / CROWD as f64;
        assert!(xx + yy == 0.0 || (coverage - 0.95).abs() < 0.013, "{case}: {coverage}");
    }
    assert!(held > all / 2 && held < all, "{held} of {all}");
}

/// Fixes are the same whether ways that are alike are looked at once or each anew.
#[test]
fn ways_that_are_alike_need_the_same_fixes() {
    let (mut fixes, mut helpless) = (0, 0);
    for case in 0..60 {
        let mut rng = Rng::new(case);
        let lattice = Lattice::ALL[case as usize % 2];
        let map = Map::random(lattice, 60, 9, 0.05, case).unwrap();
        let mut free = Cell::new(0, 0);
        map.free().for_each(|cell| free = cell);
        let field = map.wave(free).unwrap();
        let Some(from) = map.free().find(|&cell| field.steps(cell).is_some()) else { continue };
        let errors = errors(2.0, &mut rng);
        let robot = Robot { errors, drive: DRIVES[case as usize / 2 % 2], ..Robot::default() };
        let heading = rng.chance(0.5).then(|| lattice.dirs().next().unwrap());
        let program = field.route(from).program(&robot, &map, heading);
        let threshold = [0.5, 0.9, 0.99][case as usize % 3];
        let [once, anew] = [true, false].map(|once| Fixes::planned(&map, &robot, &program, threshold, once));
        assert_eq!(once, anew, "{case}");
        fixes += once.fixes.len();
        helpless += usize::from(once.not_enough_at.is_some());
    }
    assert!(fixes > 100 && helpless > 0, "{fixes} {helpless}");
}
