//! The certificate against the robots that it speaks of: 10,000 of them drive each program.

#![expect(clippy::unwrap_used, reason = "a test may stop at the first surprise")]

use activecell::{
    Cell, Certificate, Dir, Drive, Errors, Fixes, Frame, Lattice, Map, Method, Motion, Pose, Program, Rng,
    Robot, Rule,
};

const DRIVES: [Drive; 2] = [Drive::Steered, Drive::Differential];
const TRIALS: u32 = 10_000;

const TINY: Errors = Errors {
    wheel_perimeter_rel: 1e-4,
    wheel_difference_rel: 1e-5,
    track_rel: 1e-4,
    unevenness_m_per_sqrt_m: 1e-5,
    cell_division_m: 1e-4,
    stop_inertia_m: 1e-4,
    turn_rad: 1e-4,
    start_m: 1e-4,
    start_rad: 1e-4,
};

fn error_sets() -> [(&'static str, Errors); 5] {
    let usual = Errors::default();
    let large = Errors {
        wheel_perimeter_rel: 0.03,
        wheel_difference_rel: 0.01,
        track_rel: 0.05,
        unevenness_m_per_sqrt_m: 0.01,
        cell_division_m: 0.02,
        stop_inertia_m: 0.02,
        turn_rad: 0.1,
        start_m: 0.05,
        start_rad: 0.1,
    };
    let wheels = Errors {
        wheel_perimeter_rel: usual.wheel_perimeter_rel,
        wheel_difference_rel: usual.wheel_difference_rel,
        track_rel: usual.track_rel,
        start_m: usual.start_m,
        ..Errors::NONE
    };
    let noise = Errors { wheel_perimeter_rel: 0.0, wheel_difference_rel: 0.0, track_rel: 0.0, ..usual };
    [("tiny", TINY), ("default", usual), ("large", large), ("wheels alone", wheels), ("noise alone", noise)]
}

/// Programs with bends, with runs backwards, with a turn before the first run; in a turned frame.
fn programs(lattice: Lattice, drive: Drive, errors: Errors) -> Vec<(Map, Robot, Program)> {
    let robot = Robot { drive, errors, ..Robot::default() };
    let mut all = Vec::new();
    for seed in 0.. {
        let map =
            if seed % 2 == 0 { Map::random(lattice, 24, 24, 0.2, seed).unwrap() } else { rooms(lattice) };
        let map = map.in_frame(Frame { cell_m: 0.5, origin_m: [-3.0, 2.0], yaw_rad: 0.3 }).unwrap();
        let (from, to) = (map.free().next().unwrap(), map.free().last().unwrap());
        // The learning rule also goes back where it came from.
        let rule = if seed % 3 == 0 { Rule::Learning } else { Rule::Wave };
        let Ok(route) = map.route(rule, from, to, 120) else { continue };
        if route.steps() < 30 {
            continue;
        }
        let heading = [None, Some(Dir(2)), Some(Dir(3))][all.len() % 3];
        let program = route.program(&robot, &map, heading);
        all.push((map, robot, program));
        if all.len() == 3 {
            return all;
        }
    }
    unreachable!("some map has a way")
}

/// A house: rooms of 8 × 7 cells, a door in each wall.
fn rooms(lattice: Lattice) -> Map {
    let cell = |x: u32, y: u32| {
        let wall = x % 9 == 8 && y % 8 != (x / 9) % 7 || y % 8 == 7 && x % 9 != 6 - (y / 8) % 6;
        if wall { '#' } else { '.' }
    };
    let row = |y: u32| (0..44).map(|x| cell(x, y)).chain(['\n']).collect::<String>();
    Map::parse(lattice, &(0..31).map(row).collect::<String>()).unwrap()
}

/// One entry of M, driven with errors: the run, the stop; the turn is made by the caller.
fn run(motion: &mut Motion<'_>, length_m: f64, rng: &mut Rng) {
    if length_m != 0.0 {
        motion.roll(length_m, rng);
        motion.stop(rng);
    }
}

/// For each waypoint the shares of robots that are in its region, and in its cell.
fn driven(map: &Map, robot: &Robot, program: &Program, certificate: &Certificate) -> Vec<[f64; 2]> {
    let mut rng = Rng::new(0x5eed);
    let bearing_rad = program.heading.map_or(0.0, |heading| map.bearing_rad(heading));
    let start = Pose { at_m: map.centre_m(program.start), bearing_rad };
    let mut hits = vec![[0u32; 2]; program.waypoints.len()];
    for _ in 0..TRIALS {
        let mut motion = Motion::drawn(robot, start, &mut rng);
        for ((waypoint, trust), hits) in program.waypoints.iter().zip(certificate.waypoints()).zip(&mut hits)
        {
            run(&mut motion, waypoint.revolutions * robot.wheel_perimeter_m, &mut rng);
            // The true cell is displaced, so that the robot is displaced in it.
            let at_m = motion.pose.at_m.map(|x| x - robot.errors.cell_division_m * rng.normal());
            hits[0] += u32::from(trust.region_holds(at_m));
            hits[1] += u32::from(map.cell_at_m(at_m) == waypoint.cell);
            if waypoint.turn_deg != 0 {
                motion.turn(-f64::from(waypoint.turn_deg).to_radians(), &mut rng);
            }
        }
    }
    hits.into_iter().map(|hits| hits.map(|hits| f64::from(hits) / f64::from(TRIALS))).collect()
}

#[test]
fn regions_hold_95_of_100_robots_at_every_waypoint() {
    println!("| errors | lattice, drive | waypoints | sampled | at waypoints | at ends | inside, off by |");
    println!("|---|---|---|---|---|---|---|");
    let mut backwards = 0;
    for (name, errors) in error_sets() {
        let mut sampled_of_set = 0;
        for lattice in Lattice::ALL {
            for drive in DRIVES {
                let (mut least, mut most) = ([1.0f64; 2], [0.0f64; 2]);
                let (mut count, mut sampled, mut off) = (0, 0, 0.0f64);
                for (map, robot, program) in programs(lattice, drive, errors) {
                    let certificate = Certificate::new(&map, &robot, &program);
                    let shares = driven(&map, &robot, &program, &certificate);
                    for (i, (trust, [held, inside])) in
                        certificate.waypoints().iter().zip(&shares).enumerate()
                    {
                        let place = usize::from(i + 1 == shares.len());
                        (least[place], most[place]) = (least[place].min(*held), most[place].max(*held));
                        off = off.max((trust.inside - inside).abs());
                        sampled += usize::from(trust.method == Method::Sampled);
                        assert!(
                            (held - 0.95).abs() <= 0.015,
                            "{name} {lattice} {drive:?} {i}: {held} {trust:?}"
                        );
                    }
                    count += shares.len();
                    backwards +=
                        program.waypoints.iter().filter(|waypoint| waypoint.revolutions < 0.0).count();
                }
                let [at, ends] = [0, 1].map(|k| format!("{:.1}-{:.1} %", 100.0 * least[k], 100.0 * most[k]));
                println!(
                    "| {name} | {lattice}, {} | {count} | {sampled} | {at} | {ends} | {off:.3} |",
                    drive.name()
                );
                assert!(off < 0.03, "{off}");
                sampled_of_set += sampled;
            }
        }
        match name {
            "tiny" => assert_eq!(sampled_of_set, 0),
            "large" => assert!(sampled_of_set > 50),
            _ => {}
        }
    }
    assert!(backwards > 10, "{backwards}");
}

#[test]
fn a_robot_without_errors_is_where_it_should_be() {
    for lattice in Lattice::ALL {
        for drive in DRIVES {
            for (map, robot, program) in programs(lattice, drive, Errors::NONE) {
                let certificate = Certificate::new(&map, &robot, &program);
                assert_eq!(certificate.waypoints().len(), program.waypoints.len());
                for (trust, waypoint) in certificate.waypoints().iter().zip(&program.waypoints) {
                    assert_eq!((trust.cell, trust.method), (waypoint.cell, Method::ClosedForm));
                    assert!(trust.inside > 1.0 - 1e-9, "{trust:?}");
                    assert!(trust.region().semi_major_m < 1e-6, "{trust:?}");
                }
                assert_eq!(certificate.first_below(0.999_999), None);
                let fixes = Fixes::new(&map, &robot, &program, 0.999);
                assert!(fixes.fixes.is_empty() && fixes.not_enough_at.is_none());
            }
        }
    }
}

#[test]
fn a_robot_that_is_there_already_has_a_certificate() {
    let map = Map::parse(Lattice::Hex, "...\n...").unwrap();
    let cell = Cell::new(1, 1);
    let robot = Robot::default();
    let program = map.route(Rule::Wave, cell, cell, 9).unwrap().program(&robot, &map, None);
    let certificate = Certificate::new(&map, &robot, &program);
    assert_eq!(certificate.waypoints().len(), 1);
    assert!(certificate.worst().unwrap().inside > 0.999_999);
    assert_eq!(Fixes::new(&map, &robot, &program, 0.95), Fixes { fixes: vec![], not_enough_at: None });
}

/// Robots that fix where they are told to: at every waypoint they are in their cell as often as promised.
#[test]
fn with_fixes_the_robot_stays_in_its_cells() {
    let mut planned = 0;
    for (name, errors) in error_sets() {
        for lattice in Lattice::ALL {
            for drive in DRIVES {
                for (map, robot, program) in programs(lattice, drive, errors) {
                    let fixes = Fixes::new(&map, &robot, &program, 0.9);
                    assert!(fixes.fixes.windows(2).all(|pair| pair[0].step < pair[1].step), "{fixes:?}");
                    assert!(fixes.fixes.iter().all(|fix| map.is_free(fix.cell)));
                    planned += fixes.fixes.len();
                    let worst = Certificate::new(&map, &robot, &program).worst().unwrap().inside;
                    if worst < 0.9 {
                        assert!(!fixes.fixes.is_empty() || fixes.not_enough_at.is_some(), "{name}");
                    }
                    if fixes.not_enough_at.is_none() && !fixes.fixes.is_empty() {
                        let share = least_inside(&map, &robot, &program, &fixes);
                        assert!(share > 0.9 - 0.03, "{name} {lattice} {drive:?}: {share}");
                    }
                }
            }
        }
    }
    println!("{planned} fixes");
    assert!(planned > 10);
}

/// The largest errors that a robot file may hold.
#[test]
fn a_lost_robot_gets_numbers_too() {
    let lost = Errors {
        wheel_perimeter_rel: 0.3,
        wheel_difference_rel: 0.3,
        track_rel: 0.3,
        unevenness_m_per_sqrt_m: 1e6,
        cell_division_m: 1e6,
        stop_inertia_m: 1e6,
        turn_rad: 1e6,
        start_m: 1e6,
        start_rad: 1e6,
    };
    let curls = Errors { wheel_difference_rel: 0.3, ..Errors::NONE };
    for lattice in Lattice::ALL {
        let map = Map::parse(lattice, "S..\n##.\n##F").unwrap();
        let (from, to) = (map.mark('S').unwrap(), map.mark('F').unwrap());
        let route = map.route(Rule::Wave, from, to, 100).unwrap();
        for (drive, errors) in DRIVES.into_iter().flat_map(|drive| [(drive, lost), (drive, curls)]) {
            let robot = Robot { drive, errors, track_m: 1e-4, ..Robot::default() }.checked().unwrap();
            let program = route.program(&robot, &map, None);
            for trust in Certificate::new(&map, &robot, &program).waypoints() {
                assert!((0.0..=1.0).contains(&trust.inside) && trust.radius_squared.is_finite(), "{trust:?}");
                assert!(trust.region().semi_major_m.is_finite(), "{trust:?}");
                assert!(
                    errors == curls || trust.method == Method::Sampled && trust.inside < 0.01,
                    "{trust:?}"
                );
            }
            let _ = Fixes::new(&map, &robot, &program, 0.95);
        }
    }
}

#[test]
fn where_fixes_do_not_help_it_is_said() {
    let map = Map::parse(Lattice::Square, "S....\n####.\n####F").unwrap();
    let (from, to) = (map.mark('S').unwrap(), map.mark('F').unwrap());
    let route = map.route(Rule::Wave, from, to, 100).unwrap();
    let fixes = |errors: Errors| {
        let robot = Robot { errors, ..Robot::default() };
        Fixes::new(&map, &robot, &route.program(&robot, &map, None), 0.95)
    };
    // Already the start is too unsure; then each stop.
    let lost = fixes(Errors { start_m: 0.5, ..Errors::NONE });
    assert_eq!(lost, Fixes { fixes: vec![], not_enough_at: Some(from) });
    let rolls_on = fixes(Errors { stop_inertia_m: 0.5, ..Errors::NONE });
    assert_eq!(rolls_on, Fixes { fixes: vec![], not_enough_at: Some(Cell::new(4, 0)) });
}

/// The least share of robots, over all cells, that are in the cell where they should be.
fn least_inside(map: &Map, robot: &Robot, program: &Program, fixes: &Fixes) -> f64 {
    let trials = 3_000;
    let cells = activecell::replay(map, robot, program);
    let mut rng = Rng::new(7);
    let mut inside = vec![0; cells.len()];
    let heading = program.heading.map_or(0.0, |heading| map.bearing_rad(heading));
    for _ in 0..trials {
        let mut motion = Motion::drawn(robot, Pose { at_m: cells[0], bearing_rad: heading }, &mut rng);
        let (mut step, mut bearing_rad) = (0, heading);
        for waypoint in &program.waypoints {
            let length_m = waypoint.revolutions * robot.wheel_perimeter_m;
            let steps = (length_m / map.frame().cell_m).abs().round() as usize;
            let last = step + steps;
            let fix = |motion: &mut Motion<'_>, step: usize, bearing_rad: f64, rng: &mut Rng| {
                if fixes.fixes.iter().any(|fix| fix.step == step) {
                    motion.pose = Motion::drawn(robot, Pose { at_m: cells[step], bearing_rad }, rng).pose;
                }
            };
            while step < last {
                step += 1;
                motion.roll(length_m / steps as f64, &mut rng);
                if step == last {
                    motion.stop(&mut rng);
                }
                let at_m = motion.pose.at_m.map(|x| x - robot.errors.cell_division_m * rng.normal());
                inside[step] += u32::from(map.cell_at_m(at_m) == map.cell_at_m(cells[step]));
                if step < last {
                    fix(&mut motion, step, bearing_rad, &mut rng);
                }
            }
            let turn_rad = -f64::from(waypoint.turn_deg).to_radians();
            bearing_rad += turn_rad;
            if waypoint.turn_deg != 0 {
                motion.turn(turn_rad, &mut rng);
            }
            // In a cell where it turns it fixes after the turn.
            if step > 0 {
                fix(&mut motion, step, bearing_rad, &mut rng);
            }
        }
    }
    inside[1..].iter().map(|&inside| f64::from(inside) / f64::from(trials)).fold(1.0, f64::min)
}

#[test]
fn trusted_routes_are_never_worse_than_those_with_the_fewest_turns() {
    let (mut better, mut longer, mut all) = (0, 0, 0);
    for seed in 0..24u64 {
        let lattice = Lattice::ALL[seed as usize % 2];
        let map =
            if seed % 4 < 2 { rooms(lattice) } else { Map::random(lattice, 30, 30, 0.2, seed).unwrap() };
        let free: Vec<Cell> = map.free().collect();
        let mut rng = Rng::new(seed);
        let mut pick = || free[rng.below(free.len() as u32) as usize];
        let (from, to) = (pick(), pick());
        let drive = DRIVES[seed as usize / 2 % 2];
        let turn_rad = [0.01, 0.05][seed as usize % 2];
        let robot = Robot { drive, errors: Errors { turn_rad, ..Errors::default() }, ..Robot::default() };
        let heading = [None, Some(Dir(1))][seed as usize / 3 % 2];
        let field = map.wave(to).unwrap();
        let facing = match heading {
            None => lattice.dirs().collect(),
            Some(ahead) => vec![ahead, lattice.opposite(ahead)],
        };
        let few = field.route_facing(from, &facing);
        let worst = |certificate: &Certificate| certificate.worst().unwrap().inside;
        let few_worst = worst(&Certificate::new(&map, &robot, &few.program(&robot, &map, heading)));
        let trusted = field.trusted_route(&map, &robot, from, heading);
        assert_eq!(trusted.route.outcome(), few.outcome());
        assert!(trusted.route.check(&map, from, to).is_ok());
        let again = Certificate::new(&map, &robot, &trusted.route.program(&robot, &map, heading));
        assert_eq!(again, trusted.certificate);
        assert!(worst(&again) >= few_worst, "{seed}");
        all += 1;
        better += u32::from(worst(&again) > few_worst);
        longer += u32::from(trusted.route.steps() > few.steps());
    }
    println!(
        "{better} of {all} routes more trusted than those with the fewest turns, {longer} of them longer"
    );
    assert!(better > 5);
}
