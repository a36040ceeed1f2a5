//! Plans of the planner, executed with delays: nobody collides, nobody is stuck, everybody arrives.
//!
//! Maps are drawn, and real ones where the data folder of `tests/real_data.rs` is there.

use activecell::schedule::{Delays, Execution, Stop};
use activecell::{Lattice, Map, Plan, Rng, Robot, Schedule, Team, check_schedule};
use activecell_fleet::{Limits, Options, solve};
use activecell_formats::movingai::read_map;
use std::path::{Path, PathBuf};

/// A first plan for robots by chance on the largest part of the floor.
fn planned(map: &Map, robots: usize, seed: u64) -> Plan {
    let team = Team::random(map, robots, seed).expect("a team");
    let limits = Limits { time: None, steps: Some(100_000), first: true, ..Limits::default() };
    let outcome = solve(map, &team, &Options { seed, threads: 1, limits }, |_| {}).expect("the team's map");
    outcome.plan.unwrap_or_else(|| panic!("seed {seed}: {:?}", outcome.ending))
}

/// Executes a plan with delays of up to 20 steps, slow robots, and one that stands still for a while; how many rings it
/// has, and how many steps later than planned the last robot came.
fn executed(map: &Map, plan: &Plan, seed: u64) -> (usize, f64) {
    let schedule = Schedule::new(map, plan).expect("a sound plan");
    assert_eq!(check_schedule(map, plan, &schedule), Ok(()));
    let mut rng = Rng::new(seed);
    let stop = Stop { robot: rng.below(plan.robots() as u32) as usize, from: 10.0, steps: 60.0 };
    let delays = Delays {
        chance: 0.3 * rng.unit(),
        most_steps: 20,
        slow_share: 0.2 * rng.unit(),
        slow_speed: 0.3 + 0.7 * rng.unit(),
        stops: vec![stop],
        lost_reports: if seed.is_multiple_of(2) { 0.0 } else { 0.5 },
        turning: seed.is_multiple_of(3),
    };
    let radius_m = match map.lattice() {
        Lattice::Square => 0.3,
        Lattice::Hex => 0.2,
    };
    let robot = Robot { radius_m, ..Robot::default() };
    let execution = Execution::new(map, &schedule, &robot, delays).expect("delays within their ranges");
    let done = execution.trial(&mut rng).unwrap_or_else(|fault| panic!("seed {seed}: {fault}"));
    (schedule.rings().len(), done.makespan() - plan.makespan() as f64)
}

#[test]
fn plans_on_drawn_maps_are_executed_whoever_is_late() {
    let mut rings = 0;
    for seed in 0..24 {
        let map = Map::random(Lattice::ALL[seed as usize % 2], 20, 20, 0.1, seed).expect("a map");
        let (found, late) = executed(&map, &planned(&map, 200, seed), seed);
        println!("seed {seed}: {found} rings, {late:.1} steps late");
        rings += found;
    }
    assert!(rings > 0);
}

#[test]
fn plans_on_real_maps_are_executed_whoever_is_late() {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let folder = std::env::var_os("ACTIVECELL_DATA").map_or(beside, PathBuf::from).join("mapf");
    if !folder.is_dir() {
        println!("SKIPPED: {} was not found; the tests on real data did not run", folder.display());
        return;
    }
    for name in ["random-32-32-20", "room-64-64-8", "warehouse-10-20-10-2-1"] {
        let bytes = std::fs::read(folder.join(format!("{name}.map"))).expect(name);
        for lattice in Lattice::ALL {
            let map = read_map(&bytes).expect(name).on(lattice);
            for seed in 0..2 {
                let (rings, late) = executed(&map, &planned(&map, 200, seed), seed);
                println!("{name}, {lattice}, seed {seed}: {rings} rings, {late:.1} steps late");
            }
        }
    }
}
