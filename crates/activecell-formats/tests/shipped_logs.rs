//! The logs of `logs/`: a simulated robot on two days. `ACTIVECELL_WRITE_LOGS=1` writes them anew.

#![expect(clippy::unwrap_used, reason = "a test that cannot read the project should stop")]

use activecell::{DriveLog, Errors, LogRow, Motion, Pose, Rng, Robot, Wheels};
use activecell_formats::{drive_log, robot};
use std::f64::consts::FRAC_PI_2;
use std::path::Path;

const ROBOT: &str = "\
# The simulated robot of logs/, as its makers describe it.
ticks_per_rev = 2048
wheel_perimeter_m = 0.2 # by the data sheet
track_m = 0.16          # by the ruler
";

/// Runs and turns, driven; a pose is measured to 0.1 mm and 0.0001 rad at every metre and after each turn.
fn drive(robot: &Robot, wheels: Wheels, course: &[(f64, f64)], rng: &mut Rng) -> DriveLog {
    let mut motion = Motion::new(robot, wheels, Pose { at_m: [0.0, 0.0], bearing_rad: 0.0 });
    let mut rows = vec![LogRow { time_s: 0.0, truth: Some(motion.pose), ticks: [0, 0] }];
    let (mut way_m, mut counted) = ([0.0; 2], [0; 2]);
    let round = |number: f64| (number * 1e4).round() / 1e4 + 0.0;
    let mut row = |step_m: [f64; 2], seconds: f64, truth: Option<Pose>| {
        let ticks = [0, 1].map(|wheel: usize| {
            way_m[wheel] += step_m[wheel];
            let all = (way_m[wheel] / robot.wheel_perimeter_m * robot.ticks_per_rev).round() as i64;
            all - std::mem::replace(&mut counted[wheel], all)
        });
        let truth = truth.map(|Pose { at_m: [x, y], bearing_rad }| Pose {
            at_m: [round(x), round(y)],
            bearing_rad: round(bearing_rad),
        });
        rows.push(LogRow { time_s: round(rows[rows.len() - 1].time_s + seconds), truth, ticks });
    };
    for &(run_m, turn_rad) in course {
        let halves = (run_m * 2.0) as u32;
        for half in 1..=halves {
            motion.roll(0.5, rng);
            row([0.5; 2], 0.5 / robot.max_speed_mps, (half % 2 == 0).then_some(motion.pose));
        }
        motion.turn(turn_rad, rng);
        let arc_m = turn_rad * robot.track_m / 2.0;
        row([-arc_m, arc_m], turn_rad.abs() / robot.turn_rate_radps, Some(motion.pose));
    }
    DriveLog::new(rows).unwrap()
}

#[test]
fn the_logs_are_those_of_the_simulated_robot() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../logs");
    let k = 0.001;
    let told = robot::read(ROBOT.as_bytes()).unwrap();
    let turn_rad = k * (FRAC_PI_2 / told.track_m).sqrt();
    let errors = Errors { unevenness_m_per_sqrt_m: k, turn_rad, ..Errors::NONE };
    let robot = Robot { errors, ..told };
    let mut rng = Rng::new(1);
    let square = |turn_rad: f64| vec![(4.0, turn_rad); 4];
    let free: Vec<(f64, f64)> =
        [(3.0, 1.0), (2.0, -2.0), (4.0, 0.5), (1.0, 2.5), (3.0, -0.7), (2.0, 0.0)].to_vec();
    let mut files = vec![("robot.toml".to_owned(), ROBOT.to_owned())];
    for (day, track) in [("monday", 1.021), ("tuesday", 1.018), ("friday", 1.023)] {
        let wheels = Wheels { perimeter: 1.008, difference: -0.002, track };
        let courses = [("left", square(FRAC_PI_2)), ("right", square(-FRAC_PI_2)), ("free", free.clone())];
        for (name, course) in courses {
            let log = drive(&robot, wheels, &course, &mut rng);
            files.push((format!("{day}/{name}.csv"), drive_log::write(&log)));
        }
    }
    for (name, text) in files {
        let path = folder.join(name);
        if std::env::var_os("ACTIVECELL_WRITE_LOGS").is_some() {
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(&path, &text).unwrap();
        }
        assert!(std::fs::read_to_string(&path).unwrap() == text, "{} differs", path.display());
    }
}
