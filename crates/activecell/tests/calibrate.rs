//! Calibration on simulated robots: what was put in is found again, and the stated deviations are true.

#![expect(clippy::unwrap_used, reason = "a test may stop at the first surprise")]

use activecell::{
    Drive, DriveLog, Errors, LogRow, Motion, Odometry, Pose, Rng, Robot, SquareErrors, TruthNoise, Wheels,
    calibrate, umbmark,
};
use std::f64::consts::FRAC_PI_2;

const ORIGIN: Pose = Pose { at_m: [0.0, 0.0], bearing_rad: 0.0 };

/// Drives polygons: `sides` sides, each in pieces, with turns in place; every piece is a row with its real pose.
struct Course {
    side_m: f64,
    turns_rad: Vec<f64>,
    pieces: u32,
}

impl Course {
    fn square(side_m: f64, left: bool, pieces: u32) -> Self {
        let turn = if left { FRAC_PI_2 } else { -FRAC_PI_2 };
        Self { side_m, turns_rad: vec![turn; 4], pieces }
    }

    /// What the encoders count while `motion` drives it, and where it really is.
    fn drive(&self, robot: &Robot, motion: &mut Motion<'_>, rng: &mut Rng) -> DriveLog {
        let perimeters_m = robot.wheel_perimeters_m();
        let (mut way_m, mut counted) = ([0.0; 2], [0; 2]);
        let mut rows = vec![LogRow { time_s: 0.0, truth: Some(motion.pose), ticks: [0, 0] }];
        let mut row = |step_m: [f64; 2], pose: Pose| {
            let ticks = [0, 1].map(|wheel: usize| {
                way_m[wheel] += step_m[wheel];
                let all = (way_m[wheel] / perimeters_m[wheel] * robot.ticks_per_rev).round() as i64;
                all - std::mem::replace(&mut counted[wheel], all)
            });
            let time_s = rows.len() as f64;
            rows.push(LogRow { time_s, truth: Some(pose), ticks });
        };
        for &turn_rad in &self.turns_rad {
            let piece_m = self.side_m / f64::from(self.pieces);
            for _ in 0..self.pieces {
                motion.roll(piece_m, rng);
                row([piece_m; 2], motion.pose);
            }
            motion.turn(turn_rad, rng);
            let arc_m = turn_rad * robot.track_m / 2.0;
            row([-arc_m, arc_m], motion.pose);
        }
        DriveLog::new(rows).unwrap()
    }
}

/// The default robot on an uneven floor, which makes turns in place uncertain too.
fn robot(unevenness_m_per_sqrt_m: f64) -> Robot {
    let robot = Robot::default();
    let turn_rad = unevenness_m_per_sqrt_m * (FRAC_PI_2 / robot.track_m).sqrt();
    Robot { errors: Errors { unevenness_m_per_sqrt_m, turn_rad, ..Errors::NONE }, ..robot }
}

/// Squares both ways, some of them, as one session.
fn session(robot: &Robot, wheels: Wheels, squares: usize, rng: &mut Rng) -> Vec<DriveLog> {
    let logs = (0..squares).map(|i| {
        let mut motion = Motion::new(robot, wheels, ORIGIN);
        Course::square(4.0, i % 2 == 0, 8).drive(robot, &mut motion, rng)
    });
    logs.collect()
}

/// The wheels of a robot relative to another's, as [`Wheels`] has them.
fn relative(found: &Robot, nominal: &Robot) -> [f64; 3] {
    [
        found.wheel_perimeter_m / nominal.wheel_perimeter_m - 1.0,
        found.wheel_difference_rel - nominal.wheel_difference_rel,
        found.track_m / nominal.track_m - 1.0,
    ]
}

#[test]
fn the_wheels_are_found_within_their_stated_deviations() {
    let (trials, mut rng) = (300, Rng::new(5));
    let (mut within, mut squared, mut noise_off): ([u32; 3], [f64; 3], Vec<f64>) = ([0; 3], [0.0; 3], vec![]);
    let drawn =
        Errors { wheel_perimeter_rel: 0.01, wheel_difference_rel: 0.003, track_rel: 0.02, ..Errors::NONE };
    for trial in 0..trials {
        let k = [0.0005, 0.001, 0.003][trial % 3];
        let nominal = robot(k);
        let wheels = Wheels::drawn(&drawn, &mut rng);
        let logs = session(&nominal, wheels, 6, &mut rng);
        let found = calibrate(&[&logs], &nominal).unwrap();
        assert!(found.between_sessions_rel.iter().all(|&rel| rel == 0.0));
        let real = [wheels.perimeter - 1.0, wheels.difference, wheels.track - 1.0];
        let fitted = relative(&found.robot, &nominal);
        for i in 0..3 {
            let off = (fitted[i] - real[i]) / found.fit_rel[i];
            within[i] += u32::from(off.abs() < 1.96);
            squared[i] += off * off / trials as f64;
        }
        noise_off.push(found.robot.errors.unevenness_m_per_sqrt_m / k - 1.0);
    }
    let mean = noise_off.iter().sum::<f64>() / noise_off.len() as f64;
    let worst = noise_off.iter().fold(0.0_f64, |worst, off| worst.max(off.abs()));
    println!(
        "{within:?} of {trials} within 1.96 deviations, mean squares {squared:?}; k off by {mean:.3} in the mean, {worst:.3} at the worst"
    );
    for i in 0..3 {
        // 95 % ± 4 %, three deviations of the count.
        assert!((270..=297).contains(&within[i]) && (0.75..1.3).contains(&squared[i]), "{i}");
    }
    let good = noise_off.iter().filter(|off| off.abs() < 0.2).count();
    assert!(mean.abs() < 0.05 && good * 100 >= trials * 98, "{good} of {trials} within 20 %");
}

#[test]
fn sessions_that_differ_widen_the_deviations() {
    let mut rng = Rng::new(8);
    let (mut within, mut between_sum, trials) = (0, 0.0, 150);
    let nominal = robot(0.0005);
    for _ in 0..trials {
        // The track of each session, and of one more that the fit does not see, is off by 1 %.
        let wheels = |rng: &mut Rng| Wheels { track: 1.03 + 0.01 * rng.normal(), ..Wheels::NOMINAL };
        let sessions: Vec<Vec<DriveLog>> = (0..5)
            .map(|_| {
                let wheels = wheels(&mut rng);
                session(&nominal, wheels, 2, &mut rng)
            })
            .collect();
        let sessions: Vec<&[DriveLog]> = sessions.iter().map(Vec::as_slice).collect();
        let found = calibrate(&sessions, &nominal).unwrap();
        let unseen = wheels(&mut rng).track;
        let off = (found.robot.track_m / nominal.track_m - unseen) / found.robot.errors.track_rel;
        within += usize::from(off.abs() < 1.96);
        between_sum += found.between_sessions_rel[2] / trials as f64;
    }
    println!("{within} of {trials} unseen tracks within 1.96 deviations; between sessions {between_sum:.4}");
    // Five sessions tell their spread only roughly, so a little less than 95 % is right.
    assert!(within * 100 >= trials * 84);
    assert!((0.007..0.013).contains(&between_sum));
}

#[test]
fn umbmark_and_the_fit_agree_on_squares() {
    let mut rng = Rng::new(3);
    let (mut worst_difference, mut worst_track): (f64, f64) = (0.0, 0.0);
    for _ in 0..100 {
        let nominal = Robot { ticks_per_rev: 100_000.0, ..robot(1e-6) };
        let wheels =
            Wheels { perimeter: 1.0, difference: 0.000_5 * rng.normal(), track: 1.0 + 0.005 * rng.normal() };
        let side_m = 2.0;
        let both = [true, false].map(|left| {
            let mut motion = Motion::new(&nominal, wheels, ORIGIN);
            Course::square(side_m, left, 8).drive(&nominal, &mut motion, &mut rng)
        });
        let error = |log: &DriveLog| {
            let off = log.end_error(&nominal, TruthNoise::default()).off_m;
            [-off[0], -off[1]]
        };
        let errors =
            SquareErrors { side_m, clockwise_m: error(&both[1]), counter_clockwise_m: error(&both[0]) };
        let closed = umbmark(&errors, &nominal).unwrap();
        let fitted = calibrate(&[&both], &nominal).unwrap().robot;
        let real = [wheels.difference, wheels.track - 1.0];
        let (closed, fitted) = (relative(&closed, &nominal), relative(&fitted, &nominal));
        for i in 0..2 {
            assert!((fitted[i + 1] - real[i]).abs() < 2e-5, "{fitted:?} {real:?}");
        }
        worst_difference = worst_difference.max((closed[1] - real[0]).abs());
        worst_track = worst_track.max((closed[2] - real[1]).abs());
    }
    // The closed form is for small errors: it leaves their squares.
    println!(
        "UMBmark is off by {worst_difference:.6} in the difference, {worst_track:.6} in the track at the worst"
    );
    assert!(worst_difference < 2e-4 && worst_track < 1e-3);
}

#[test]
fn wrong_poses_of_the_truth_do_no_harm() {
    let mut rng = Rng::new(4);
    let nominal = robot(0.001);
    let wheels = Wheels { perimeter: 1.01, difference: 0.002, track: 1.03 };
    for _ in 0..40 {
        let clean = session(&nominal, wheels, 6, &mut rng);
        let mut wrong = 0;
        let spoilt: Vec<DriveLog> = clean
            .iter()
            .map(|log| {
                let mut rows = log.rows().to_vec();
                let inner = 1..rows.len() - 1;
                for row in &mut rows[inner] {
                    if rng.chance(0.04) {
                        row.truth = row.truth.map(|pose| Pose {
                            at_m: pose.point(0.5 + rng.unit(), -0.7),
                            bearing_rad: pose.bearing_rad + 1.0,
                        });
                        wrong += 1;
                    }
                }
                DriveLog::new(rows).unwrap()
            })
            .collect();
        let found = calibrate(&[&spoilt], &nominal).unwrap();
        let fitted = relative(&found.robot, &nominal);
        for (i, real) in [0.01, 0.002, 0.03].into_iter().enumerate() {
            assert!((fitted[i] - real).abs() < 4.0 * found.fit_rel[i], "{i}: {fitted:?}, {wrong} wrong");
        }
        assert!(found.left_out <= wrong, "{} left out, {wrong} wrong", found.left_out);
        let k = found.robot.errors.unevenness_m_per_sqrt_m;
        assert!((0.0007..0.0014).contains(&k), "{k}");
    }
}

#[test]
fn regions_of_calibrated_robots_hold_95_of_100_unseen_ends() {
    let mut rng = Rng::new(6);
    let nominal = robot(0.002);
    let (mut inside, mut all) = (0, 0);
    for _ in 0..150 {
        let wheels = Wheels { perimeter: 0.99, difference: -0.004, track: 1.02 };
        let seen = session(&nominal, wheels, 4, &mut rng);
        let found = calibrate(&[&seen], &nominal).unwrap();
        for log in session(&nominal, wheels, 4, &mut rng) {
            inside += usize::from(log.end_error(&found.robot, found.truth).inside());
            all += 1;
        }
    }
    let percent = 100.0 * inside as f64 / f64::from(all);
    println!("{inside} of {all} unseen ends inside: {percent:.1} %");
    assert!((92.0..98.5).contains(&percent));
}

/// The twin of the derivatives and of the covariance: differences of driven poses, and drawn ones.
#[test]
fn columns_and_covariance_are_those_of_driven_robots() {
    let mut rng = Rng::new(7);
    for _ in 0..100 {
        let nominal = Robot { wheel_difference_rel: 0.01 * rng.normal(), ..robot(0.001) };
        let steps: Vec<[i64; 2]> =
            (0..30).map(|_| [rng.below(2000), rng.below(2000)].map(|ticks| i64::from(ticks) - 600)).collect();
        let drive = |robot: &Robot| {
            let mut odometry = Odometry::new(Pose { at_m: [1.0, 2.0], bearing_rad: 0.3 });
            for &ticks in &steps {
                odometry.advance(robot, ticks);
            }
            odometry
        };
        let numbers = |robot: &Robot| {
            let pose = drive(robot).pose();
            [pose.at_m[0], pose.at_m[1], pose.bearing_rad]
        };
        let small = 1e-6;
        for which in 0..3 {
            let moved = |by: f64| {
                let mut robot = nominal;
                match which {
                    0 => robot.wheel_perimeter_m *= 1.0 + by,
                    1 => robot.wheel_difference_rel += by,
                    _ => robot.track_m *= 1.0 + by,
                }
                numbers(&robot)
            };
            let (plus, minus) = (moved(small), moved(-small));
            let mut errors = Errors::NONE;
            match which {
                0 => errors.wheel_perimeter_rel = 1.0,
                1 => errors.wheel_difference_rel = 1.0,
                _ => errors.track_rel = 1.0,
            }
            let covariance = drive(&nominal).covariance(&errors);
            for (i, row) in covariance.iter().enumerate() {
                for (j, &entry) in row.iter().enumerate() {
                    let by = |k: usize| (plus[k] - minus[k]) / (2.0 * small);
                    let expected = by(i) * by(j);
                    assert!((entry - expected).abs() < 1e-4 * (1.0 + expected.abs()), "{which}");
                }
            }
        }
    }
    // The floor's noise: straight runs and turns of the model of errors, drawn.
    let model = robot(0.000_5);
    let trials = 20_000;
    let mut sums = [[0.0; 3]; 3];
    let mut odometry = Odometry::new(ORIGIN);
    let run_ticks = (3.0 / model.wheel_perimeter_m * model.ticks_per_rev).round() as i64;
    odometry.advance(&model, [run_ticks, run_ticks]);
    for _ in 0..trials {
        let mut motion = Motion::new(&model, Wheels::NOMINAL, ORIGIN);
        motion.roll(3.0, &mut rng);
        let off = [motion.pose.at_m[0] - 3.0, motion.pose.at_m[1], motion.pose.bearing_rad];
        for i in 0..3 {
            for j in 0..3 {
                sums[i][j] += off[i] * off[j] / f64::from(trials);
            }
        }
    }
    let expected = odometry.covariance(&model.errors);
    for (i, row) in expected.iter().enumerate() {
        for (j, &entry) in row.iter().enumerate() {
            let size = (expected[i][i] * expected[j][j]).sqrt();
            assert!((sums[i][j] - entry).abs() < 0.05 * size, "{i} {j}: {} {entry}", sums[i][j]);
        }
    }
}

#[test]
fn what_cannot_be_fitted_is_told() {
    let nominal = robot(0.001);
    let told = |sessions: &[&[DriveLog]], robot: &Robot| calibrate(sessions, robot).unwrap_err().to_string();
    let mut rng = Rng::new(1);
    let logs = session(&nominal, Wheels::NOMINAL, 1, &mut rng);
    let steered = Robot { drive: Drive::Steered, ..nominal };
    assert!(told(&[&logs], &steered).starts_with("of a steered robot only the perimeter shows in a log"));
    assert_eq!(told(&[], &nominal), "there is no log to fit");
    let still = [0.0, 1.0].map(|time_s| LogRow { time_s, truth: Some(ORIGIN), ticks: [0, 0] });
    assert!(told(&[&[DriveLog::new(still.to_vec()).unwrap()]], &nominal).contains("count nothing"));

    // Closed squares of which only the ends are known do not tell the mean perimeter: it stays, and says so.
    let ends: Vec<DriveLog> = session(&nominal, Wheels { track: 1.02, ..Wheels::NOMINAL }, 6, &mut rng)
        .iter()
        .map(|log| {
            let mut rows = log.rows().to_vec();
            let last = rows.len() - 1;
            rows[1..last].iter_mut().for_each(|row| row.truth = None);
            DriveLog::new(rows).unwrap()
        })
        .collect();
    let found = calibrate(&[&ends], &nominal).unwrap();
    assert!(found.fit_rel[0] > 0.01, "{found:?}");
    let turn =
        found.robot.wheel_perimeter_m / found.robot.track_m * nominal.track_m / nominal.wheel_perimeter_m;
    assert!((turn * 1.02 - 1.0).abs() < 0.01, "{found:?}");
}

#[test]
fn logs_of_nonsense_neither_panic_nor_hang() {
    let mut rng = Rng::new(9);
    let (mut fitted, mut refused) = (0, 0);
    for trial in 0..300 {
        let size = 10.0_f64.powi(rng.below(12) as i32 - 3);
        let rows = (0..2 + rng.below(30)).map(|i| {
            let pose =
                Pose { at_m: [size * rng.normal(), size * rng.normal()], bearing_rad: size * rng.normal() };
            let ticks = [size, 10.0 * size].map(|size| (size * rng.normal()) as i64);
            let truth = (i == 0 || rng.chance(0.7)).then_some(pose);
            LogRow { time_s: f64::from(i), truth, ticks: if trial % 5 == 0 { [0, ticks[1]] } else { ticks } }
        });
        let Ok(log) = DriveLog::new(rows.collect()) else { continue };
        match calibrate(&[std::slice::from_ref(&log), &[], &[log.clone(), log.clone()]], &robot(0.001)) {
            Ok(found) => {
                let off = [found.fit_rel, found.between_sessions_rel].concat();
                assert!(off.iter().all(|number| number.is_finite()), "{found:?}");
                fitted += 1;
            }
            Err(_) => refused += 1,
        }
    }
    println!("{fitted} fitted, {refused} refused");
    assert!(fitted > 100);
}
