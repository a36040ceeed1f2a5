//! Random worlds of which the robot's map misses obstacles: it reaches what can be reached and touches nothing.

#![expect(clippy::unwrap_used, reason = "a test may stop at the first surprise")]

use activecell::control::Inputs;
use activecell::sim::{Ending, Leg, Mover, Task, Trace, Visit, World, trial_rng};
use activecell::{
    BitPlane, Cell, Dir, Drive, Error, Errors, Frame, Lattice, Map, Pose, Rng, Robot, Rule, Sensors,
};
use std::collections::BTreeSet;

const CELL_M: f64 = 0.5;

/// One world, and what the robot knows of it.
struct Case {
    world: Map,
    known: Map,
    from: Cell,
    to: Cell,
    robot: Robot,
    rule: Rule,
    reachable: bool,
}

fn in_cells(map: Map) -> Map {
    map.in_frame(Frame { cell_m: CELL_M, origin_m: [-1.0, 2.0], yaw_rad: 0.3 }).unwrap()
}

/// The map without some of its obstacles, each left out with this probability.
fn without(map: &Map, share: f64, rng: &mut Rng) -> Map {
    let mut obstacles: BitPlane = map.obstacles().clone();
    for y in 0..map.height() {
        for x in 0..map.width() {
            if obstacles.get(x, y) && rng.chance(share) {
                obstacles.set(x, y, false);
            }
        }
    }
    in_cells(Map::new(map.lattice(), obstacles))
}

fn case(number: u64) -> Case {
    let mut rng = trial_rng(11, number);
    let lattice = Lattice::ALL[number as usize % 2];
    let drive = [Drive::Differential, Drive::Steered][number as usize / 2 % 2];
    let rule = if number % 8 == 7 { Rule::Learning } else { Rule::Wave };
    let size = 12 + rng.below(9);
    let density = [0.1, 0.2, 0.3][number as usize / 4 % 3];
    loop {
        let world = in_cells(Map::random(lattice, size, size, density, rng.next_u64()).unwrap());
        let known = without(&world, 0.1, &mut rng);
        let mut pick = || Cell::new(rng.below(size) as i32, rng.below(size) as i32);
        let (from, to) = (pick(), pick());
        if from != to && world.is_free(from) && world.is_free(to) {
            let reachable = world.wave(to).unwrap().steps(from).is_some();
            let robot = Robot { drive, can_reverse: !number.is_multiple_of(3), ..Robot::default() };
            return Case { world, known, from, to, robot, rule, reachable };
        }
    }
}

fn drive(case: &Case, visits: &[Visit], number: u64) -> Trace {
    let world = World::new(&case.world).with_visits(visits);
    let heading = Dir((number % u64::from(case.world.lattice().degree())) as u8);
    let task =
        Task { rule: case.rule, heading, max_ticks: 50_000, ..Task::new(&case.known, case.from, case.to) };
    task.run(&world, &case.robot, &mut trial_rng(5, number)).unwrap()
}

/// The control unit never drives towards a cell that is called blocked, in the inputs or in what was sensed.
fn check_safety(case: &Case, trace: &Trace, name: &str) {
    let mut closed: BTreeSet<Cell> = BTreeSet::new();
    let mut opened: BTreeSet<Cell> = BTreeSet::new();
    for (number, tick) in trace.ticks.iter().enumerate() {
        for &(cell, blocked) in &tick.changes {
            let (to, other) = if blocked { (&mut closed, &mut opened) } else { (&mut opened, &mut closed) };
            to.insert(cell);
            other.remove(&cell);
        }
        let place = format!("{name}, tick {number}: {tick:?}");
        if let Some(obstacle) = tick.state.drives_towards() {
            assert!(!tick.inputs.has(obstacle), "{place}");
            assert!(!tick.inputs.has(Inputs::STOP), "{place}");
            if tick.aim != tick.cell {
                let free = (case.known.is_free(tick.aim) || opened.contains(&tick.aim))
                    && !closed.contains(&tick.aim);
                assert!(free, "{place}");
                assert!(case.world.lattice().dir_between(tick.cell, tick.aim).is_some(), "{place}");
            }
        }
    }
}

#[test]
fn a_robot_that_lacks_a_tenth_of_the_obstacles_arrives_and_touches_nothing() {
    let count = std::env::var("ACTIVECELL_WORLDS").ok().and_then(|count| count.parse().ok()).unwrap_or(1000);
    let (mut arrived, mut unreachable, mut found, mut ticks) = (0, 0, 0, 0);
    let (mut worst_m, mut spread_m, mut driven_m, mut honest) = (0f64, 0f64, 0.0, 0);
    let mut faults = Vec::new();
    for number in 0..count {
        let case = case(number);
        let trace = drive(&case, &[], number);
        let name = format!("world {number}");
        check_safety(&case, &trace, &name);
        let end = trace.ticks.last().unwrap();
        match trace.ending {
            Ending::Arrived if case.world.cell_at_m(end.truth.at_m) == case.to => arrived += 1,
            Ending::Unreachable if !case.reachable => unreachable += 1,
            ending => {
                faults.push(format!("{name}: {ending:?} at {} {:?} {}", end.cell, case.to, case.reachable));
            }
        }
        if !trace.contacts.is_empty() {
            let lattice = case.world.lattice();
            faults.push(format!("{name} {lattice} {:?}: {:?}", case.robot.drive, trace.contacts));
        }
        for tick in &trace.ticks {
            let (true_m, thought_m) = (tick.truth.at_m, tick.estimate.at_m);
            let off_m = (true_m[0] - thought_m[0]).hypot(true_m[1] - thought_m[1]);
            worst_m = worst_m.max(off_m);
            honest += u64::from(off_m <= 3.0 * tick.spread_m);
            spread_m = spread_m.max(tick.spread_m);
        }
        found += trace.found.len();
        ticks += trace.ticks.len();
        driven_m += trace.length_m;
    }
    println!("{count} worlds: {arrived} arrived, {unreachable} rightly unreachable, {} faults", faults.len());
    println!(
        "{found} obstacles found, {ticks} ticks, {driven_m:.0} m, off by at most {worst_m:.3} m ({spread_m:.3} m thought)"
    );
    let share = 100.0 * honest as f64 / f64::from(ticks as u32);
    println!("{share:.2} % of the poses within three standard deviations of where the robot believed to be");
    assert!(share > 99.0, "{share}");
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(arrived > count / 2 && unreachable > 0);
}

/// Robots that see less, or more, or go wrong more often than the default one.
#[test]
fn other_sensors_and_errors_arrive_too() {
    let default = Robot::default();
    let (sensors, errors) = (default.sensors, default.errors);
    let robots = [
        ("8 beams", Robot { sensors: Sensors { beams: 8, ..sensors }, ..default }),
        ("7 beams", Robot { sensors: Sensors { beams: 7, ..sensors }, ..default }),
        ("36 beams", Robot { sensors: Sensors { beams: 36, ..sensors }, ..default }),
        ("range 4 m", Robot { sensors: Sensors { range_m: 4.0, ..sensors }, ..default }),
        ("5 % false", Robot { sensors: Sensors { false_rate: 0.05, ..sensors }, ..default }),
        (
            "perfect",
            Robot {
                sensors: Sensors { noise_m: 0.0, false_rate: 0.0, ..sensors },
                errors: Errors::NONE,
                ..default
            },
        ),
        (
            "wheels off",
            Robot { errors: Errors { wheel_perimeter_rel: 0.03, track_rel: 0.03, ..errors }, ..default },
        ),
        ("4 beams", Robot { sensors: Sensors { beams: 4, ..sensors }, ..default }),
        ("noise 27 mm", Robot { sensors: Sensors { noise_m: 0.027, ..sensors }, ..default }),
        ("bad turns", Robot { errors: Errors { turn_rad: 0.04, ..errors }, ..default }),
        ("bad start", Robot { errors: Errors { start_rad: 0.04, ..errors }, ..default }),
        ("uneven floor", Robot { errors: Errors { unevenness_m_per_sqrt_m: 0.003, ..errors }, ..default }),
        ("radius 5 cm", Robot { radius_m: 0.05, ..default }),
    ];
    for (name, robot) in robots {
        for number in 0..60 {
            let case = case(number);
            let case = Case {
                robot: Robot { drive: case.robot.drive, can_reverse: case.robot.can_reverse, ..robot },
                ..case
            };
            let trace = drive(&case, &[], number);
            check_safety(&case, &trace, name);
            let end = trace.ticks.last().unwrap();
            let right = match trace.ending {
                Ending::Arrived => case.world.cell_at_m(end.truth.at_m) == case.to,
                Ending::Unreachable => !case.reachable,
                Ending::GaveUp => false,
            };
            assert!(
                right && trace.contacts.is_empty(),
                "{name}, world {number}: {:?} {:?}",
                trace.ending,
                trace.contacts
            );
        }
        println!("{name}: 60 worlds rightly ended without contact");
    }
}

/// The check of the cells' size is honest: in the smallest that it allows nothing is touched either.
#[test]
fn the_smallest_cells_that_are_allowed_are_large_enough() {
    let (mut worlds, mut least_m) = (0, f64::INFINITY);
    for number in 0..200 {
        let case = case(number);
        let in_cells_of =
            |map: &Map, cell_m: f64| map.clone().in_frame(Frame { cell_m, ..*map.frame() }).unwrap();
        let tiny = in_cells_of(&case.known, 0.2);
        let refused = Task::new(&tiny, case.from, case.to).run(
            &World::new(&in_cells_of(&case.world, 0.2)),
            &case.robot,
            &mut Rng::new(1),
        );
        // The size that it asks for leaves less to errors that grow with the cell: ask until it holds.
        let Err(Error::TooTight { least_m: mut cell_m, .. }) = refused else { panic!("{refused:?}") };
        let trace = loop {
            let (world, known) = (in_cells_of(&case.world, cell_m), in_cells_of(&case.known, cell_m));
            let task = Task { rule: case.rule, ..Task::new(&known, case.from, case.to) };
            match task.run(&World::new(&world), &case.robot, &mut trial_rng(6, number)) {
                Err(Error::TooTight { least_m, .. }) => cell_m = least_m * 1.001,
                ran => break ran.unwrap(),
            }
        };
        assert!(trace.contacts.is_empty(), "world {number}, cells of {cell_m} m: {:?}", trace.contacts);
        let ending = if case.reachable { Ending::Arrived } else { Ending::Unreachable };
        assert_eq!(trace.ending, ending, "world {number}, cells of {cell_m} m");
        worlds += 1;
        least_m = least_m.min(cell_m);
    }
    println!("{worlds} worlds in cells of {least_m:.3} m and more");
}

/// A corridor with one door, and a way round that is longer.
#[test]
fn obstacles_that_appear_and_go_away_do_not_stop_it_for_ever() {
    let text = ".......\n###.###\n.......";
    let (mut waited, mut shut) = (0, 0);
    for number in 0..60 {
        let lattice = Lattice::ALL[number as usize % 2];
        let drive_by = [Drive::Differential, Drive::Steered][number as usize / 2 % 2];
        let map = in_cells(Map::parse(lattice, text).unwrap());
        let door = Cell::new(3, 1);
        let case = Case {
            world: map.clone(),
            known: map,
            from: Cell::new(0, 0),
            to: Cell::new(6, 2),
            robot: Robot { drive: drive_by, ..Robot::default() },
            rule: if number % 5 == 0 { Rule::Learning } else { Rule::Wave },
            reachable: true,
        };
        // It stands in the only door for a while, and comes back later.
        let for_a_while =
            [(2.0, 25.0), (60.0, 80.0)].map(|(from_s, to_s)| Visit { cell: door, from_s, to_s });
        let trace = drive(&case, &for_a_while, number);
        check_safety(&case, &trace, &format!("door {number}"));
        assert_eq!(trace.ending, Ending::Arrived, "{number}");
        assert!(trace.contacts.is_empty(), "{number}: {:?}", trace.contacts);
        waited += u64::from(trace.ticks.iter().any(|tick| tick.changes.contains(&(door, true))));
        // One that stays longer than it has patience: it says so, but not before it looked again.
        let trace = drive(&case, &[Visit { cell: door, from_s: 0.0, to_s: 1e9 }], number);
        assert_eq!(trace.ending, Ending::Unreachable, "{number}");
        assert!(trace.ticks.last().unwrap().time_s > 30.0, "{number}");
        shut += 1;
    }
    println!("{waited} of 60 found the door shut and waited, {shut} found it shut for ever");
    assert!(waited > 30);
}

#[test]
fn discs_that_move_are_seen_and_their_touch_is_counted() {
    let map = in_cells(Map::parse(Lattice::Square, &[".".repeat(16).as_str(); 9].join("\n")).unwrap());
    let (from, to) = (Cell::new(1, 4), Cell::new(14, 4));
    let robot = Robot::default();
    let task = Task::new(&map, from, to);
    let start =
        |cell: Cell, bearing_rad: f64| Pose { at_m: map.centre_m(cell), bearing_rad: bearing_rad + 0.3 };
    let mover = |start: Pose, speed_mps: f64| {
        let legs = vec![Leg { duration_s: 1000.0, speed_mps, accel_mps2: 0.0, turn_rate_radps: 0.0 }];
        Mover { radius_m: 0.2, start, legs }
    };
    // It stands in the way: the robot goes round it.
    let standing = World::new(&map).with_movers(vec![mover(start(Cell::new(7, 4), 0.0), 0.0)]);
    let trace = task.run(&standing, &robot, &mut Rng::new(3)).unwrap();
    assert_eq!((trace.ending, trace.contacts.len()), (Ending::Arrived, 0));
    assert!(trace.ticks.iter().any(|tick| tick.changes.contains(&(Cell::new(7, 4), true))));
    // It runs the robot over, which only prediction could avoid.
    let bull = World::new(&map).with_movers(vec![mover(start(Cell::new(15, 4), std::f64::consts::PI), 1.5)]);
    let trace = task.run(&bull, &robot, &mut Rng::new(3)).unwrap();
    assert!(trace.contacts.iter().any(|contact| contact.mover == Some(0)), "{:?}", trace.contacts);
}

#[test]
fn cells_too_small_and_sensors_too_weak_are_refused_in_one_line() {
    let map = Map::parse(Lattice::Hex, "...").unwrap();
    let small = map.in_frame(Frame { cell_m: 0.4, ..Frame::default() }).unwrap();
    let task = Task::new(&small, Cell::new(0, 0), Cell::new(2, 0));
    let run = |robot: Robot| task.run(&World::new(&small), &robot, &mut Rng::new(1)).unwrap_err().to_string();
    assert_eq!(
        run(Robot::default()),
        "cells of 0.4 m are too small for a robot of radius 0.1 m to keep clear of obstacles with its errors and sensors; use cells of at least 0.455 m"
    );
    let blind = Robot { sensors: Sensors { range_m: 0.3, ..Sensors::default() }, ..Robot::default() };
    assert_eq!(
        run(blind),
        "sensors.range_m is 0.3; it must be at least a cell's size and the robot's radius, to drive by sensors"
    );
    let blind = Robot { sensors: Sensors { beams: 1, ..Sensors::default() }, ..Robot::default() };
    assert_eq!(run(blind), "sensors.beams is 1; it must be at least 4, to drive by sensors");
    let task = Task { rule: Rule::Published, ..Task::new(&small, Cell::new(0, 0), Cell::new(2, 0)) };
    let robot = Robot { radius_m: 0.05, ..Robot::default() };
    let error = task.run(&World::new(&small), &robot, &mut Rng::new(1)).unwrap_err();
    assert!(error.to_string().contains("`published` has no memory"));
}
