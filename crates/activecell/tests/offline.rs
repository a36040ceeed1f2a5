//! The offline mode: whether the certificate holds for what is driven, and that nothing depends on threads.

#![expect(clippy::unwrap_used, reason = "a test may stop at the first surprise")]

use activecell::sim::{Offline, Trial, World, trials};
use activecell::{Certificate, Drive, Errors, Frame, Lattice, Map, Program, Robot, Rule};

const TRIALS: u64 = 10_000;

fn drives(lattice: Lattice, robot: &Robot) -> (World, Program) {
    let text = "..........\n..........\n......#...\n......#...\n..........\n..........";
    let map = Map::parse(lattice, text).unwrap();
    let map = map.in_frame(Frame { cell_m: 0.5, origin_m: [3.0, -1.0], yaw_rad: 0.2 }).unwrap();
    let (from, to) = (map.free().next().unwrap(), map.free().last().unwrap());
    let route = map.route(Rule::Wave, from, to, 1000).unwrap();
    let program = route.program(robot, &map, Some(activecell::Dir(2)));
    (World::new(&map), program)
}

#[test]
fn what_the_certificate_says_is_what_happens() {
    let errors = [
        Errors::default(),
        Errors { wheel_perimeter_rel: 0.02, turn_rad: 0.002, ..Errors::default() },
        Errors { unevenness_m_per_sqrt_m: 0.004, start_rad: 0.03, ..Errors::default() },
    ];
    for lattice in Lattice::ALL {
        for drive in [Drive::Steered, Drive::Differential] {
            for errors in errors {
                let robot = Robot { drive, errors, ..Robot::default() };
                let (world, program) = drives(lattice, &robot);
                let offline = Offline::new(&world, &program, &robot);
                let run = |seed| trials(TRIALS, 2, seed, &|| {}, &|rng| offline.trial(rng));
                let certificate = Certificate::new(world.map(), &robot, &program);
                let driven: Vec<Trial> = run(2);
                for (waypoint, trust) in certificate.waypoints().iter().enumerate() {
                    let at_m = |trial: &Trial| trial.waypoints_m[waypoint];
                    let share = |count: usize| 100.0 * count as f64 / TRIALS as f64;
                    let held = share(driven.iter().filter(|trial| trust.region_holds(at_m(trial))).count());
                    let in_cell = |trial: &&Trial| world.map().cell_at_m(at_m(trial)) == trust.cell;
                    let inside = share(driven.iter().filter(in_cell).count());
                    let place = format!("{lattice} {drive:?} waypoint {waypoint}");
                    println!(
                        "{place}: region {held:.2} %, cell {inside:.2} % of {:.2} %",
                        100.0 * trust.inside
                    );
                    assert!((held - 95.0).abs() <= 1.5, "{place}: {held}");
                    assert!(
                        (inside - 100.0 * trust.inside).abs() <= 2.0,
                        "{place}: {inside} {}",
                        trust.inside
                    );
                }
            }
        }
    }
}

#[test]
fn a_robot_without_errors_ends_where_the_program_says() {
    for lattice in Lattice::ALL {
        let robot = Robot { errors: Errors::NONE, ..Robot::default() };
        let (world, program) = drives(lattice, &robot);
        let offline = Offline::new(&world, &program, &robot);
        let trial = offline.trial(&mut activecell::Rng::new(1));
        assert!(trial.end_error_m() < 1e-9 && offline.ended_inside(&trial));
        assert!(trial.contacts.is_empty());
    }
}

#[test]
fn a_drive_through_a_wall_is_felt_once() {
    let robot = Robot { errors: Errors::NONE, ..Robot::default() };
    for lattice in Lattice::ALL {
        let (world, program) = drives(lattice, &robot);
        let known = world.map();
        // An obstacle in the middle of the first run that the program does not know.
        let first = program.waypoints.iter().find(|waypoint| waypoint.revolutions != 0.0).unwrap();
        let (a, b) = (known.centre_m(program.start), known.centre_m(first.cell));
        let middle = known.cell_at_m([f64::midpoint(a[0], b[0]), f64::midpoint(a[1], b[1])]);
        let mut obstacles = known.obstacles().clone();
        obstacles.set(middle.x as u32, middle.y as u32, true);
        let world = World::new(&Map::new(lattice, obstacles).in_frame(*known.frame()).unwrap());
        let trial = Offline::new(&world, &program, &robot).trial(&mut activecell::Rng::new(1));
        assert_eq!(trial.contacts.len(), 1, "{lattice}");
    }
}

#[test]
fn the_same_seed_gives_the_same_trials_on_any_number_of_threads() {
    let robot = Robot::default();
    let (world, program) = drives(Lattice::Hex, &robot);
    let offline = Offline::new(&world, &program, &robot);
    let run = |threads, seed| trials(300, threads, seed, &|| {}, &|rng| offline.trial(rng));
    assert_eq!(run(1, 4), run(5, 4));
    assert_ne!(run(1, 4), run(1, 5));
}
