//! Plans for random groups keep the rules, on both lattices; the same seed makes the same plan.

#![expect(clippy::unwrap_used, reason = "a test that cannot make its map should stop")]

use activecell::{Cell, Lattice, Map, Rng, Team, check_plan};
use activecell_fleet::{Ending, Limits, Options, solve};

/// A team in the largest part of the floor, as many robots as are asked for or fit.
fn random_team(map: &Map, robots: usize, seed: u64) -> Team {
    Team::random(map, robots.min(map.largest_region().len()), seed).unwrap()
}

fn options(seed: u64, steps: u64, first: bool) -> Options {
    let limits = Limits { time: None, steps: Some(steps), first, ..Limits::default() };
    Options { seed, threads: 1, limits }
}

#[test]
fn plans_keep_the_rules() {
    let (mut plans, mut robots) = (0, 0);
    for seed in 0..400 {
        let mut rng = Rng::new(seed);
        let lattice = Lattice::ALL[seed as usize % 2];
        let map = Map::random(lattice, 4 + rng.below(30), 4 + rng.below(30), 0.15, seed).unwrap();
        let share = 0.02 + 0.6 * rng.unit();
        let team = random_team(&map, (map.free_cells() as f64 * share) as usize, seed);
        let outcome = solve(&map, &team, &options(seed, 20_000, true), |_| {}).unwrap();
        assert_eq!(Some(outcome.lower_bound), team.lower_bound(&map).unwrap());
        let Some(plan) = outcome.plan else { continue };
        assert_eq!(check_plan(&map, &team, &plan), Ok(()), "{lattice} {seed}");
        assert_eq!(outcome.history.last().unwrap().sum_of_costs, plan.sum_of_costs());
        assert!(plan.sum_of_costs() >= outcome.lower_bound);
        (plans, robots) = (plans + 1, robots + team.robots());
    }
    println!("{plans} of 400 plans for {robots} robots keep the rules");
    assert!(plans > 390);
}

#[test]
fn the_sum_of_costs_only_falls_and_the_seed_decides_all() {
    for seed in 0..30 {
        let map = Map::random(Lattice::ALL[seed as usize % 2], 14, 11, 0.2, seed).unwrap();
        let team = random_team(&map, 20, seed);
        let once = solve(&map, &team, &options(seed, 6_000, false), |_| {}).unwrap();
        let again =
            solve(&map, &team, &Options { threads: 2, ..options(seed, 6_000, false) }, |_| {}).unwrap();
        assert_eq!(once.plan, again.plan);
        assert_eq!((once.steps, once.ending), (again.steps, again.ending));
        let costs: Vec<_> = once.history.iter().map(|found| (found.step, found.sum_of_costs)).collect();
        assert_eq!(
            costs,
            again.history.iter().map(|found| (found.step, found.sum_of_costs)).collect::<Vec<_>>()
        );
        assert!(costs.windows(2).all(|pair| pair[0].1 > pair[1].1 && pair[0].0 < pair[1].0));
        assert!(check_plan(&map, &team, &once.plan.unwrap()).is_ok());
    }
}

#[test]
fn crowds_with_hardly_a_free_cell_are_solved() {
    for seed in 0..30 {
        let lattice = Lattice::ALL[seed as usize % 2];
        let map = Map::random(lattice, 12, 12, 0.1, seed).unwrap();
        let team = random_team(&map, map.largest_region().len() * 95 / 100, seed);
        let outcome = solve(&map, &team, &options(seed, 100_000, true), |_| {}).unwrap();
        assert_eq!(check_plan(&map, &team, &outcome.plan.unwrap()), Ok(()), "{lattice} {seed}");
    }
}

/// Robots that must all turn back in a corridor with one bay.
#[test]
fn robots_pass_each_other_where_there_is_room_for_one_only() {
    for (lattice, floor) in [
        (
            Lattice::Square,
            "........
###.####",
        ),
        (
            Lattice::Square,
            "..........
#######.##",
        ),
        (
            Lattice::Hex,
            "........
###..###",
        ),
    ] {
        let map = Map::parse(lattice, floor).unwrap();
        let row = |x: i32| Cell::new(x, 0);
        let last = map.width() as i32 - 1;
        let team =
            Team::new(&map, vec![row(0), row(1), row(last)], vec![row(last), row(last - 1), row(0)]).unwrap();
        let outcome = solve(&map, &team, &options(3, 50_000, true), |_| {}).unwrap();
        assert_eq!(check_plan(&map, &team, &outcome.plan.unwrap()), Ok(()), "{floor}");
    }
}

/// Five thousand robots in a queue: the last pushes all of them at once, none of it on the call stack.
#[test]
fn a_long_queue_is_pushed_without_deep_recursion() {
    let map = Map::parse(Lattice::Square, &".".repeat(5003)).unwrap();
    let cell = |x: i32| Cell::new(x, 0);
    let team = Team::new(&map, (0..5000).map(cell).collect(), (3..5003).map(cell).collect()).unwrap();
    let outcome = solve(&map, &team, &options(1, 5_000, true), |_| {}).unwrap();
    let plan = outcome.plan.unwrap();
    assert_eq!(check_plan(&map, &team, &plan), Ok(()));
    assert_eq!((plan.makespan(), plan.sum_of_costs()), (3, outcome.lower_bound));
}

#[test]
fn who_has_no_way_is_known_at_once() {
    for lattice in Lattice::ALL {
        let map = Map::parse(lattice, "..#..").unwrap();
        let team = Team::new(&map, vec![Cell::new(0, 0)], vec![Cell::new(4, 0)]).unwrap();
        let outcome = solve(&map, &team, &Options::default(), |_| {}).unwrap();
        assert!(outcome.is_impossible() && outcome.ending == Ending::Exhausted);
        assert_eq!(team.lower_bound(&map), Ok(None));
    }
}

#[test]
fn limits_of_steps_and_memory_end_the_search() {
    let map = Map::parse(Lattice::Square, "......").unwrap();
    let (west, east) = (Cell::new(1, 0), Cell::new(4, 0));
    let team = Team::new(&map, vec![west, east], vec![east, west]).unwrap();
    let outcome = solve(&map, &team, &options(0, 10, false), |_| {}).unwrap();
    assert_eq!((outcome.ending, outcome.steps, outcome.plan), (Ending::Steps, 10, None));
    let mut few = options(0, u64::MAX, false);
    few.limits.bytes = 2000;
    assert_eq!(solve(&map, &team, &few, |_| {}).unwrap().ending, Ending::Memory);
    few.limits.time = Some(std::time::Duration::ZERO);
    assert_eq!(solve(&map, &team, &few, |_| {}).unwrap().ending, Ending::Time, "no time for the fields");
    let free = solve(&map, &team, &options(0, u64::MAX, false), |_| {}).unwrap();
    assert!(free.is_impossible());
}
