//! Random worlds of which the robot's map misses obstacles: it reaches what can be reached and touches nothing.

#![expect(clippy::unwrap_used, reason = "a test may stop at the first surprise")]

use activecell::control::Inputs;
use activecell::sim::{Ending, Task, Trace, Visit, World, trial_rng};
use activecell::{BitPlane, Cell, Dir, Drive, Frame, Lattice, Map, Rng, Robot, Rule};
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
            let robot = Robot { drive, can_reverse: number % 3 != 0, ..Robot::default() };
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
    let (mut worst_m, mut spread_m, mut driven_m) = (0f64, 0f64, 0.0);
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
                faults.push(format!("{name}: {ending:?} at {} {:?} {}", end.cell, case.to, case.reachable))
            }
        }
        if !trace.contacts.is_empty() {
            let lattice = case.world.lattice();
            faults.push(format!("{name} {lattice} {:?}: {:?}", case.robot.drive, trace.contacts));
        }
        for tick in &trace.ticks {
            let (true_m, thought_m) = (tick.truth.at_m, tick.estimate.at_m);
            worst_m = worst_m.max((true_m[0] - thought_m[0]).hypot(true_m[1] - thought_m[1]));
            spread_m = spread_m.max(tick.spread_m);
        }
        if trace.ticks.len() > 3000 {
            println!(
                "{name} {} {} {:?} {:?} {}",
                trace.ticks.len(),
                end.time_s,
                trace.ending,
                case.rule,
                case.world.lattice()
            );
        }
        found += trace.found.len();
        ticks += trace.ticks.len();
        driven_m += trace.length_m;
    }
    println!("{count} worlds: {arrived} arrived, {unreachable} rightly unreachable, {} faults", faults.len());
    println!(
        "{found} obstacles found, {ticks} ticks, {driven_m:.0} m, off by at most {worst_m:.3} m ({spread_m:.3} m thought)"
    );
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(arrived > count / 2 && unreachable > 0);
}

#[test]
#[ignore = "for looking at one world"]
fn one_world() {
    let number = std::env::var("WORLD").unwrap().parse().unwrap();
    let case = case(number);
    let trace = drive(&case, &[], number);
    println!(
        "{:?} {} {:?} {:?} r={}\n{}",
        case.rule,
        case.world.lattice(),
        case.from,
        case.to,
        case.robot.can_reverse,
        case.world.to_text()
    );
    println!("{}", case.known.to_text());
    let skip: usize = std::env::var("SKIP").map_or(0, |s| s.parse().unwrap());
    for tick in trace.ticks.iter().skip(skip).take(std::env::var("TAKE").map_or(120, |t| t.parse().unwrap()))
    {
        let r: Vec<String> = tick.readings_m.iter().map(|r| format!("{r:.2}")).collect();
        println!(
            "{:.2} {} -> {} {:?} {:08b} est {:.2?} {:.2} err {:.3} {:?} {}",
            tick.time_s,
            tick.cell,
            tick.aim,
            tick.state,
            tick.inputs.0,
            tick.estimate.at_m,
            tick.estimate.bearing_rad,
            (tick.truth.at_m[0] - tick.estimate.at_m[0]).hypot(tick.truth.at_m[1] - tick.estimate.at_m[1]),
            tick.changes
                .iter()
                .map(|c| format!("{}{}", c.0, if c.1 { "#" } else { "." }))
                .collect::<Vec<_>>(),
            r.join(" ")
        );
    }
}
