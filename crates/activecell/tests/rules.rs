//! The rules on thousands of random maps: against naive twins, and against each other.

mod common;

use activecell::rule::{Decision, Levels, Mosaic, Sector, decide, neighbourhood};
use activecell::{Cell, Dir, Drive, Lattice, Map, Outcome, Robot, Rule, check_program, check_route};
use common::{breadth_first, least_steps_and_turns, random_task};

const DENSITIES: [f64; 6] = [0.05, 0.1, 0.2, 0.3, 0.4, 0.6];
const LIMIT: usize = 1_000_000;

fn tasks(count: u64, side: u32) -> impl Iterator<Item = (Map, Cell, Cell)> {
    (0..count).filter_map(move |seed| {
        let lattice = Lattice::ALL[seed as usize % 2];
        random_task(lattice, side, DENSITIES[seed as usize / 2 % DENSITIES.len()], seed)
    })
}

#[test]
fn cell_view_and_navigator_view_give_the_same_trace() {
    let (mut maps, mut steps) = (0, 0);
    for (map, from, to) in tasks(4000, 9) {
        maps += 1;
        let mut mosaic = Mosaic::new(&map, from, to);
        let mut cell = from;
        // Long enough for every cycle on such a map.
        for _ in 0..90 {
            let Some(sector) = Sector::towards(map.lattice(), cell, to) else { break };
            let near = map.lattice().distance(cell, to) == 1;
            let decision = decide(map.lattice(), sector, near, neighbourhood(&map, cell));
            assert_eq!(mosaic.step(), Some(decision), "{map:?} at {cell} towards {to}");
            if let Decision::Move(dir) = decision {
                cell = map.lattice().neighbour(cell, dir);
            }
            assert_eq!(mosaic.active(), cell);
            steps += 1;
        }
    }
    println!("{maps} maps, {steps} steps: both views agree");
    assert!(maps > 3900 && steps > 20_000);
}

#[test]
fn published_always_ends_and_never_enters_an_obstacle() {
    let mut ends = [0; 3];
    for (map, from, to) in tasks(6000, 16) {
        let route = map.route(Rule::Published, from, to, LIMIT).unwrap();
        let last = *route.cells().last().unwrap();
        assert_eq!(check_route(&map, route.cells(), from, last), Ok(()));
        let end = match route.outcome() {
            Outcome::Arrived => {
                assert_eq!(last, to);
                0
            }
            Outcome::Trapped => {
                let cycle = route.cycle();
                assert!(cycle.len() >= 2 && cycle[0] == last, "{cycle:?}");
                assert_eq!(check_route(&map, &[cycle, &cycle[..1]].concat(), last, last), Ok(()));
                1
            }
            Outcome::Enclosed => {
                assert!(map.lattice().dirs().all(|dir| !map.is_free(map.lattice().neighbour(from, dir))));
                2
            }
            Outcome::Unreachable => panic!("the published rule cannot know this"),
        };
        ends[end] += 1;
    }
    println!("published: {} arrived, {} trapped, {} enclosed", ends[0], ends[1], ends[2]);
    assert!(ends.iter().all(|&count| count > 0));
}

#[test]
fn learning_and_wave_arrive_wherever_a_way_exists() {
    let (mut reachable, mut unreachable) = (0, 0);
    for (map, from, to) in tasks(6000, 20) {
        let truth = breadth_first(&map, to).get(&from).copied();
        if truth.is_some() {
            reachable += 1;
        } else {
            unreachable += 1;
        }
        for rule in [Rule::Learning, Rule::Wave] {
            let route = map.route(rule, from, to, LIMIT).unwrap();
            match truth {
                Some(steps) => {
                    assert_eq!(route.outcome(), Outcome::Arrived);
                    assert_eq!(check_route(&map, route.cells(), from, to), Ok(()));
                    assert!(route.steps() >= steps as usize);
                    assert!(rule == Rule::Learning || route.steps() == steps as usize);
                }
                None => assert_eq!(route.outcome(), Outcome::Unreachable, "{rule} {map:?} {from} {to}"),
            }
        }
    }
    println!("{reachable} reachable and {unreachable} unreachable targets");
    assert!(reachable > 3000 && unreachable > 300);
}

#[test]
fn levels_never_exceed_the_distance() {
    for (map, from, to) in tasks(400, 12) {
        let truth = breadth_first(&map, to);
        let mut levels = Levels::new(&map, to);
        let mut cell = from;
        while let Some(dir) = levels.step(&map, cell) {
            cell = map.lattice().neighbour(cell, dir);
            for (&cell, &steps) in &truth {
                assert!(levels.level(&map, cell) <= steps);
            }
        }
    }
}

#[test]
fn the_field_holds_the_distances_of_a_plain_search() {
    for (map, _, to) in tasks(400, 24) {
        let truth = breadth_first(&map, to);
        let field = map.wave(to).unwrap();
        for y in -1..=map.height() as i32 {
            for x in -1..=map.width() as i32 {
                let cell = Cell::new(x, y);
                assert_eq!(field.steps(cell), truth.get(&cell).copied());
            }
        }
    }
}

#[test]
fn many_fields_are_the_same_on_any_number_of_threads() {
    for (map, from, to) in tasks(60, 20) {
        let targets = [from, to, from];
        let steps = |threads| -> Vec<Vec<Option<u32>>> {
            let fields = map.waves(&targets, threads).unwrap();
            fields.iter().map(|field| map.free().map(|cell| field.steps(cell)).collect()).collect()
        };
        assert_eq!(steps(1), steps(2));
        assert_eq!(steps(1), steps(7));
        assert!(map.waves(&[from, Cell::new(-1, 0)], 2).is_err());
    }
}

#[test]
fn the_nearest_reachable_cell_is_reachable_and_none_is_nearer() {
    for (map, from, to) in tasks(600, 14) {
        let found = map.nearest_reachable(from, to).unwrap();
        let reached = breadth_first(&map, from);
        let distance = |cell: Cell| map.lattice().distance(cell, to);
        assert!(reached.contains_key(&found));
        assert_eq!(Some(distance(found)), reached.keys().map(|&cell| distance(cell)).min());
    }
}

#[test]
fn wave_routes_have_the_fewest_turns_among_the_shortest() {
    for (map, from, to) in tasks(1500, 12) {
        let route = map.route(Rule::Wave, from, to, LIMIT).unwrap();
        if route.outcome() == Outcome::Arrived {
            let found = (route.steps() as u32, route.turns().len() as u32);
            let all: Vec<Dir> = map.lattice().dirs().collect();
            assert_eq!(Some(found), least_steps_and_turns(&map, from, to, &all), "{map:?} {from} {to}");
        }
    }
}

#[test]
fn a_robot_that_faces_somewhere_gets_a_program_with_the_fewest_turns() {
    for (i, (map, from, to)) in tasks(800, 10).enumerate() {
        let lattice = map.lattice();
        let facing = lattice.dirs().nth(i % usize::from(lattice.degree())).unwrap();
        for can_reverse in [false, true] {
            let robot = Robot { can_reverse, ..Robot::default() };
            let back = can_reverse.then_some(lattice.opposite(facing));
            let dirs: Vec<Dir> = std::iter::once(facing).chain(back).collect();
            let route = map.wave(to).unwrap().route_facing(from, &dirs);
            if route.outcome() == Outcome::Arrived && from != to {
                let program = route.program(&robot, &map, Some(facing));
                let found = (route.steps() as u32, program.turns() as u32);
                assert_eq!(Some(found), least_steps_and_turns(&map, from, to, &dirs), "{map:?} {from} {to}");
            }
        }
    }
}

#[test]
fn programs_replayed_by_dead_reckoning_land_on_every_cell() {
    let (mut programs, mut reversed) = (0, 0);
    for (i, (map, from, to)) in tasks(1500, 14).enumerate() {
        let map = map
            .in_frame(activecell::Frame {
                cell_m: 0.35,
                origin_m: [-2.0, 3.0],
                yaw_rad: 0.3 * (i % 5) as f64,
            })
            .unwrap();
        for rule in Rule::ALL {
            let route = map.route(rule, from, to, LIMIT).unwrap();
            for drive in [Drive::Steered, Drive::Differential] {
                for can_reverse in [false, true] {
                    let robot = Robot { drive, can_reverse, wheel_perimeter_m: 0.213, ..Robot::default() };
                    let lattice = map.lattice();
                    let heading = lattice.dirs().nth(i % 8); // also none
                    let program = route.program(&robot, &map, heading);
                    assert_eq!(check_program(&map, &robot, &program, route.cells()), Ok(()));
                    let last = program.waypoints.last().unwrap();
                    assert_eq!((last.cell, last.turn_deg), (*route.cells().last().unwrap(), 0));
                    let backwards = program.waypoints.iter().filter(|w| w.revolutions < 0.0).count();
                    assert!(can_reverse || backwards == 0);
                    reversed += backwards;
                    programs += 1;
                }
            }
        }
    }
    println!("{programs} programs, {reversed} runs in reverse");
    assert!(reversed > 1000);
}

#[test]
fn a_wrong_program_is_found() {
    let map = Map::parse(Lattice::Square, "....\n....").unwrap();
    let route = map.route(Rule::Wave, Cell::new(0, 0), Cell::new(3, 1), LIMIT).unwrap();
    let robot = Robot::default();
    let good = route.program(&robot, &map, None);
    let check = |change: &dyn Fn(&mut activecell::Program)| {
        let mut program = good.clone();
        change(&mut program);
        check_program(&map, &robot, &program, route.cells())
    };
    assert!(check(&|_| {}).is_ok());
    assert!(check(&|p| p.waypoints[0].revolutions *= 1.001).is_err());
    assert!(check(&|p| p.waypoints[0].turn_deg = -p.waypoints[0].turn_deg).is_err());
    assert!(check(&|p| p.waypoints[0].turn_revolutions = 0.0).is_err());
    assert!(check(&|p| p.waypoints.truncate(1)).is_err());
    assert!(check(&|p| p.waypoints[0].turn_revolutions = f64::NAN).is_err());
}

#[test]
fn a_differential_turn_costs_its_arc() {
    let robot = Robot { wheel_perimeter_m: 0.5, track_m: 0.2, ..Robot::default() };
    assert!((robot.turn_revolutions(-90) - std::f64::consts::PI * 0.2 / 4.0 / 0.5).abs() < 1e-12);
    assert!(Robot { drive: Drive::Steered, ..robot }.turn_revolutions(90).abs() < 1e-12);
}
