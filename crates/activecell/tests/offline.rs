//! The offline mode: how far the regions that trials give hold for other trials, and that nothing depends on threads.

#![expect(clippy::unwrap_used, reason = "a test may stop at the first surprise")]

use activecell::sim::{Offline, Trial, World, trials};
use activecell::{Drive, Errors, Frame, Lattice, Map, Program, Robot, Rule};

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
fn regions_of_some_trials_hold_95_percent_of_others() {
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
                let regions = offline.sampled_regions(&run(1));
                let others: Vec<Trial> = run(2);
                for (waypoint, region) in regions.iter().enumerate() {
                    let inside =
                        others.iter().filter(|trial| region.contains(trial.waypoints_m[waypoint])).count();
                    let share = 100.0 * inside as f64 / TRIALS as f64;
                    println!("{lattice} {drive:?} waypoint {waypoint}: {share:.2} %");
                    assert!((share - 95.0).abs() <= 1.5, "{lattice} {drive:?} {waypoint}: {share}");
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
