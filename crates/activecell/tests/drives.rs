//! Drives: what a program takes, and how a robot with errors moves.

#![expect(clippy::unwrap_used, reason = "a test may stop at the first surprise")]

use activecell::{
    Drive, Errors, Frame, Lattice, Map, Motion, Pose, Program, Rng, Robot, Rule, Wheels, replay,
};

const DRIVES: [Drive; 2] = [Drive::Steered, Drive::Differential];

fn programs(count: u64) -> impl Iterator<Item = (Map, Program, Robot)> {
    let task = |i: u64| {
        let map = Map::random(Lattice::ALL[i as usize % 2], 12, 12, 0.15, i).unwrap();
        let (from, to) = (map.free().next()?, map.free().last()?);
        Some((map, from, to))
    };
    (0..count).filter_map(task).enumerate().map(|(i, (map, from, to))| {
        let map = map.in_frame(Frame { cell_m: 0.35, origin_m: [1.0, 2.0], yaw_rad: 0.1 }).unwrap();
        let route = map.route(Rule::Wave, from, to, 10_000).unwrap();
        let drive = DRIVES[i / 2 % 2];
        let robot = Robot { drive, can_reverse: i % 3 == 0, errors: Errors::NONE, ..Robot::default() };
        let program = route.program(&robot, &map, map.lattice().dirs().nth(i % 7));
        (map, program, robot)
    })
}

#[test]
fn rounding_to_ticks_never_adds_up() {
    let mut runs = 0;
    for (i, (_, program, robot)) in programs(600).enumerate() {
        let ticks_per_rev = [1.0, 3.0, 20.0, 2796.8][i % 4];
        let robot = Robot { ticks_per_rev, wheel_difference_rel: 0.01 * (i % 5) as f64, ..robot };
        let perimeters_m = robot.wheel_perimeters_m();
        let (mut way_m, mut counted) = ([0.0; 2], [0; 2]);
        for (waypoint, ticks) in program.waypoints.iter().zip(program.ticks(&robot)) {
            let run_m = waypoint.revolutions * robot.wheel_perimeter_m;
            let turn_m = match robot.drive {
                Drive::Steered => 0.0,
                Drive::Differential => f64::from(waypoint.turn_deg).to_radians() * robot.track_m / 2.0,
            };
            for (wheel, sign) in [(0, 1.0), (1, -1.0)] {
                for (part_m, part) in [(run_m, ticks.run[wheel]), (sign * turn_m, ticks.turn[wheel])] {
                    way_m[wheel] += part_m;
                    counted[wheel] += part;
                    let exact = way_m[wheel] / perimeters_m[wheel] * ticks_per_rev;
                    assert!(
                        (exact - counted[wheel] as f64).abs() <= 0.5 + 1e-6,
                        "{exact} {}",
                        counted[wheel]
                    );
                }
            }
            runs += 1;
        }
    }
    println!("{runs} runs");
    assert!(runs > 1000);
}

#[test]
fn without_errors_the_motion_is_the_replay() {
    for (map, program, robot) in programs(300) {
        let at_m = map.centre_m(program.start);
        let bearing_rad = program.heading.map_or(0.0, |dir| map.bearing_rad(dir));
        let mut motion = Motion::drawn(&robot, Pose { at_m, bearing_rad }, &mut Rng::new(1));
        let mut rng = Rng::new(2);
        for waypoint in &program.waypoints {
            motion.roll(waypoint.revolutions * robot.wheel_perimeter_m, &mut rng);
            motion.stop(&mut rng);
            motion.turn(-f64::from(waypoint.turn_deg).to_radians(), &mut rng);
        }
        let end_m = *replay(&map, &robot, &program).last().unwrap();
        let apart_m = (motion.pose.at_m[0] - end_m[0]).hypot(motion.pose.at_m[1] - end_m[1]);
        assert!(apart_m < 1e-9, "{apart_m}");
    }
}

/// Covariance of along, across and heading after one run, driven whole or in parts, against the formulas.
#[test]
fn noise_of_a_run_follows_the_formulas_however_it_is_cut() {
    let start = Pose { at_m: [0.0, 0.0], bearing_rad: 0.0 };
    let (length_m, k): (f64, f64) = (4.0, 0.0004);
    for drive in DRIVES {
        let robot = Robot {
            drive,
            errors: Errors { unevenness_m_per_sqrt_m: k, ..Errors::NONE },
            ..Robot::default()
        };
        for parts in [1, 10] {
            let mut rng = Rng::new(5);
            let mut sums = [0.0; 4];
            let trials = 40_000;
            for _ in 0..trials {
                let mut motion = Motion::new(&robot, Wheels::NOMINAL, start);
                (0..parts).for_each(|_| motion.roll(length_m / f64::from(parts), &mut rng));
                let [x, y] = motion.pose.at_m;
                let (along, turned) = (x - length_m, motion.pose.bearing_rad);
                for (sum, term) in sums.iter_mut().zip([along * along, y * y, turned * turned, y * turned]) {
                    *sum += term / f64::from(trials);
                }
            }
            let q = 2.0 * k * k / robot.track_m.powi(2);
            let expected = match drive {
                Drive::Steered => [k * k * length_m, k * k * length_m, 0.0, 0.0],
                Drive::Differential => [
                    k * k * length_m / 2.0,
                    q * length_m.powi(3) / 3.0,
                    q * length_m,
                    q * length_m.powi(2) / 2.0,
                ],
            };
            for (i, (found, expected)) in sums.into_iter().zip(expected).enumerate() {
                // Along, the arc's sag adds to the linear formula.
                let slack = if i == 0 { 0.2 } else { 0.03 };
                assert!(
                    (found - expected).abs() <= slack * expected,
                    "{drive:?} {parts} {i}: {found} {expected}"
                );
            }
        }
    }
}

#[test]
fn time_follows_speed_and_acceleration() {
    let map = Map::parse(Lattice::Hex, "...........\n...........").unwrap();
    let route = map.route(Rule::Wave, activecell::Cell::new(0, 0), activecell::Cell::new(2, 0), 100).unwrap();
    let robot = Robot { max_speed_mps: 3.0, max_accel_mps2: 0.5, ..Robot::default() };
    // Too short for full speed: 1 m up, 1 m down.
    let effort = route.program(&robot, &map, None).effort(&robot);
    assert!((effort.time_s - 4.0).abs() < 1e-12);
    let facing = map.lattice().dir_named("NE");
    let turned = route.program(&robot, &map, facing).effort(&robot);
    assert!((turned.time_s - 4.0 - (60f64).to_radians() / robot.turn_rate_radps).abs() < 1e-12);
    assert!(turned.energy_j > effort.energy_j);
}
