//! Plans of dives keep the rules, whatever the guide, on both lattices; the seed alone decides them.

#![expect(clippy::unwrap_used, reason = "a test that cannot make its map should stop")]

use activecell::{Lattice, Map, Rng, Team, check_plan};
use activecell_fleet::{Fields, Floor, Guide, Limits, Options, Problem, dive, solve};

const GUIDES: [Guide; 6] =
    [Guide::Plain, Guide::Local(1), Guide::Local(10), Guide::Local(20), Guide::Spread(5), Guide::Spread(20)];

/// A floor with some robots in one part of it, from a few to nearly as many as it has cells.
fn crowd(seed: u64) -> (Map, Team) {
    let mut rng = Rng::new(seed);
    let lattice = Lattice::ALL[seed as usize % 2];
    let map = Map::random(lattice, 5 + rng.below(25), 5 + rng.below(25), 0.15, seed).unwrap();
    let floor = Floor::new(&map);
    let free: Vec<_> = map.free().collect();
    let middle = floor.number(free[free.len() / 2]);
    let part: Vec<_> = free.into_iter().filter(|&cell| floor.connected(middle, floor.number(cell))).collect();
    let robots = 1 + (part.len() as f64 * 0.8 * rng.unit().powi(2)) as usize;
    let mut draw = || {
        let mut cells = part.clone();
        rng.shuffle(&mut cells);
        cells.truncate(robots);
        cells
    };
    let team = Team::new(&map, draw(), draw()).unwrap();
    (map, team)
}

#[test]
fn plans_of_every_kind_of_dive_keep_the_rules() {
    let (mut plans, mut sums) = (0, [0; GUIDES.len()]);
    for seed in 0..60 {
        let (map, team) = crowd(seed);
        let floor = Floor::new(&map);
        let (starts, targets) = (floor.numbers_of(team.starts()), floor.numbers_of(team.targets()));
        let mut fields = Fields::new(&floor);
        let goals = fields.goals(&floor, &targets, 1).unwrap();
        let problem = Problem { floor: &floor, fields: &fields, goals: &goals, starts: &starts };
        let found = GUIDES.map(|guide| dive(problem, guide, seed, &|_| false));
        for (guide, found) in GUIDES.iter().zip(&found) {
            let Some(found) = found else { continue };
            let plan = found.plan(problem).unwrap();
            assert_eq!(check_plan(&map, &team, &plan), Ok(()), "{guide:?} {seed}");
            assert_eq!(plan.sum_of_costs(), found.sum_of_costs, "{guide:?} {seed}");
            // A bound stops a dive that comes to more, and changes nothing for one that does not.
            assert_eq!(dive(problem, *guide, seed, &|bound| bound > found.sum_of_costs), Some(found.clone()));
            assert_eq!(dive(problem, *guide, seed, &|bound| bound >= found.sum_of_costs), None);
            plans += 1;
        }
        if found.iter().all(Option::is_some) {
            for (sum, found) in sums.iter_mut().zip(&found) {
                *sum += found.as_ref().unwrap().sum_of_costs;
            }
        }
    }
    println!("{plans} plans; sums of costs {sums:?} for {GUIDES:?}");
    assert!(plans > 340);
    // Who looks ten steps ahead or more saves at least a tenth.
    assert!([2, 3, 5].iter().all(|&far: &usize| 10 * sums[far] < 9 * sums[0]));
}

#[test]
fn with_a_limit_of_steps_the_threads_change_nothing() {
    for seed in 0..12 {
        let (map, team) = crowd(seed);
        let limits = Limits { time: None, steps: Some(20_000), ..Limits::default() };
        let [one, two] =
            [1, 2].map(|threads| solve(&map, &team, &Options { seed, threads, limits }, |_| {}).unwrap());
        assert_eq!((one.plan, one.ending, one.steps), (two.plan, two.ending, two.steps), "{seed}");
        let told = |history: &[activecell_fleet::Improvement]| {
            history.iter().map(|found| (found.step, found.sum_of_costs)).collect::<Vec<_>>()
        };
        assert_eq!(told(&one.history), told(&two.history), "{seed}");
    }
}
