//! Refined plans: by the rules, never dearer, the same on any number of threads.

use activecell::{Cell, Lattice, Map, Plan, Rng, Team, check_plan};
use activecell_fleet::{Advance, Arbiter, Fields, Floor, Goal, Refiner, Search};

/// A team whose robots all have a way, as many as were asked for or fewer.
fn team(map: &Map, floor: &Floor, robots: usize, rng: &mut Rng) -> Team {
    let mut shuffled = || {
        let mut cells: Vec<Cell> = map.free().collect();
        rng.shuffle(&mut cells);
        cells
    };
    let pairs = shuffled().into_iter().zip(shuffled());
    let connected = pairs.filter(|&(a, b)| floor.connected(floor.number(a), floor.number(b)));
    let (starts, targets) = connected.take(robots).unzip();
    Team::new(map, starts, targets).expect("a team")
}

/// Calls `with` with the floor's parts and the first plan, if there is one within some steps of search.
fn first_plan(map: &Map, team: &Team, seed: u64, with: impl FnOnce(&Floor, &Fields, &[Goal], &Plan)) {
    let floor = Floor::new(map);
    let (starts, targets) = (floor.numbers_of(team.starts()), floor.numbers_of(team.targets()));
    let mut fields = Fields::new(&floor);
    let goals = fields.goals(&floor, &targets, 1).expect("fields");
    let mut search = Search::new(Arbiter::new(&floor, &fields, goals.clone(), seed), &starts, seed);
    for _ in 0..20_000 {
        if search.advance() == Advance::Better {
            break;
        }
    }
    if let Some(plan) = search.plan() {
        with(&floor, &fields, &goals, &plan);
    }
}

#[test]
fn refined_plans_are_right_and_never_dearer() {
    let mut rng = Rng::new(3);
    let (mut plans, mut saved, mut before) = (0, 0, 0);
    for case in 0..120 {
        let lattice = if case % 2 == 0 { Lattice::Square } else { Lattice::Hex };
        // From corridors one cell wide to floors of several words a row.
        let [width, height] = [1 + rng.below(if case % 5 == 0 { 90 } else { 12 }), 1 + rng.below(12)];
        let map =
            Map::random(lattice, width, height, 0.05 * f64::from(rng.below(6)), rng.next_u64()).unwrap();
        let tenths = 1 + rng.below(8);
        let robots = 1 + rng.below(map.free_cells() as u32 * tenths / 10 + 1) as usize;
        let team = team(&map, &Floor::new(&map), robots, &mut rng);
        let seed = rng.next_u64();
        first_plan(&map, &team, seed, |floor, fields, goals, plan| {
            let mut one = Refiner::new(floor, fields, goals, plan, seed);
            let mut two = Refiner::new(floor, fields, goals, plan, seed);
            let mut sum = plan.sum_of_costs();
            before += sum;
            for _ in 0..4 {
                let better = one.round(1, &|| false);
                assert_eq!(better, two.round(2, &|| false));
                assert_eq!(better, (one.sum_of_costs() < sum).then_some(one.sum_of_costs()));
                assert!(one.sum_of_costs() <= sum);
                let refined = one.plan();
                assert_eq!(check_plan(&map, &team, &refined), Ok(()));
                assert_eq!(refined.sum_of_costs(), one.sum_of_costs());
                assert_eq!(refined, two.plan());
                saved += sum - one.sum_of_costs();
                sum = one.sum_of_costs();
            }
            plans += 1;
        });
    }
    println!("{plans} plans refined, {saved} of {before} steps saved");
    assert!(plans > 100 && saved > 0);
}

#[test]
fn refining_goes_on_from_a_plan_from_elsewhere() {
    let map = Map::random(Lattice::Square, 16, 16, 0.2, 4).unwrap();
    let team = team(&map, &Floor::new(&map), 60, &mut Rng::new(2));
    first_plan(&map, &team, 1, |floor, fields, goals, plan| {
        let mut refiner = Refiner::new(floor, fields, goals, plan, 1);
        refiner.round(2, &|| false);
        let better = refiner.plan();
        refiner.replace(plan);
        assert_eq!(refiner.plan().costs(), plan.costs());
        refiner.replace(&better);
        assert_eq!(refiner.plan(), better);
        refiner.round(1, &|| false);
        assert_eq!(check_plan(&map, &team, &refiner.plan()), Ok(()));
        let promised = Refiner::bytes_for(floor, team.robots(), plan.makespan(), 2);
        assert!(refiner.bytes() <= promised, "{} of {promised} bytes", refiner.bytes());
    });
}

#[test]
fn nobody_and_nobody_late_need_no_refining() {
    let map = Map::parse(Lattice::Hex, "...").unwrap();
    for (starts, targets) in [(vec![], vec![]), (vec![Cell::new(0, 0)], vec![Cell::new(2, 0)])] {
        let team = Team::new(&map, starts, targets).expect("a team");
        first_plan(&map, &team, 1, |floor, fields, goals, plan| {
            let mut refiner = Refiner::new(floor, fields, goals, plan, 1);
            assert_eq!(refiner.round(2, &|| false), None);
            assert_eq!(&refiner.plan(), plan);
        });
    }
}
