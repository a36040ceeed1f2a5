//! The search against an exhaustive one over all configurations, on floors so small that it can be done.

use activecell::{Cell, Lattice, Map, Rng, Team, check_plan};
use activecell_fleet::{Advance, Arbiter, Fields, Floor, Limits, Options, Search, solve};
use std::collections::{BTreeMap, BTreeSet};

/// Every configuration that one step leads to.
fn nexts(map: &Map, now: &[Cell]) -> Vec<Vec<Cell>> {
    let lattice = map.lattice();
    let mut found: Vec<Vec<Cell>> = vec![Vec::new()];
    for &here in now {
        let around = lattice.dirs().map(|dir| lattice.neighbour(here, dir)).filter(|&cell| map.is_free(cell));
        let around: Vec<Cell> = around.chain([here]).collect();
        found = found
            .iter()
            .flat_map(|part| around.iter().map(move |&cell| [part.as_slice(), &[cell]].concat()))
            .filter(|next| {
                let (new, before) = (next.len() - 1, &next[..next.len() - 1]);
                let meets = before.contains(&next[new]);
                let swaps = (0..new).any(|other| next[other] == now[new] && next[new] == now[other]);
                !meets && !swaps
            })
            .collect();
    }
    found
}

/// The least loss of a plan, by trying every configuration in the order of loss; `None` if there is no plan.
fn least_loss(map: &Map, team: &Team) -> Option<u64> {
    let mut best = BTreeMap::from([(team.starts().to_vec(), 0)]);
    let mut open = BTreeSet::from([(0, team.starts().to_vec())]);
    while let Some((spent, now)) = open.pop_first() {
        if now == team.targets() {
            return Some(spent);
        }
        for next in nexts(map, &now) {
            let steps = now.iter().zip(&next).zip(team.targets());
            let loss =
                steps.filter(|((here, there), target)| here != target || there != target).count() as u64;
            let spent = spent + loss;
            if best.get(&next).is_none_or(|&known| spent < known) {
                best.insert(next.clone(), spent);
                open.insert((spent, next));
            }
        }
    }
    None
}

fn some_cells(free: &[Cell], count: usize, rng: &mut Rng) -> Vec<Cell> {
    let mut cells = free.to_vec();
    rng.shuffle(&mut cells);
    cells.truncate(count);
    cells
}

/// The steps in which a robot does not rest at its target.
fn loss(team: &Team, plan: &activecell::Plan) -> u64 {
    let target = |robot: usize, step: usize| plan.at(step, robot) == team.targets()[robot];
    let away = |step: usize| (0..team.robots()).filter(|&i| !target(i, step) || !target(i, step + 1)).count();
    (0..plan.steps()).map(|step| away(step) as u64).sum()
}

/// A small floor with two or three robots, drawn by chance; `None` if there is no room for them.
fn small_task(seed: u64) -> Option<(Map, Team)> {
    let mut rng = Rng::new(seed);
    let (width, height) = [(3, 3), (4, 2), (7, 1), (5, 2), (2, 4)][rng.below(5) as usize];
    let density = f64::from(rng.below(5)) * 0.1;
    let map = Map::random(Lattice::ALL[seed as usize % 2], width, height, density, seed).ok()?;
    let free: Vec<Cell> = map.free().collect();
    let robots = 2 + rng.below(2) as usize;
    let small = (robots..=9).contains(&free.len());
    let team = Team::new(&map, some_cells(&free, robots, &mut rng), some_cells(&free, robots, &mut rng));
    team.ok().filter(|_| small).map(|team| (map, team))
}

#[test]
fn the_search_finds_a_plan_if_and_only_if_there_is_one() {
    let (mut solved, mut impossible) = (0, 0);
    for seed in 0..6000 {
        let Some((map, team)) = small_task(seed) else { continue };
        let least = least_loss(&map, &team);
        let limits = Limits { time: None, steps: Some(200_000), first: true, ..Limits::default() };
        let outcome = solve(&map, &team, &Options { seed, threads: 1, limits }, |_| {}).unwrap();
        if let Some(plan) = &outcome.plan {
            assert_eq!(check_plan(&map, &team, plan), Ok(()), "{seed}");
            assert_eq!(Some(outcome.lower_bound), team.lower_bound(&map).unwrap());
            assert!(least.is_some_and(|least| least <= loss(&team, plan)), "{seed}: {least:?}");
            solved += 1;
        } else {
            assert!(outcome.is_impossible(), "{seed}: {:?}", outcome.ending);
            assert_eq!(least, None, "{seed} {}", map.to_text());
            impossible += 1;
        }
    }
    println!("{solved} solved, {impossible} impossible");
    assert!(solved > 3000 && impossible > 1000);
}

#[test]
fn a_search_that_ends_has_the_least_loss() {
    let mut best = 0;
    for seed in 10_000..11_500 {
        let Some((map, team)) = small_task(seed) else { continue };
        let floor = Floor::new(&map);
        let (starts, targets) = (floor.numbers_of(team.starts()), floor.numbers_of(team.targets()));
        if starts.iter().zip(&targets).any(|(&start, &target)| !floor.connected(start, target)) {
            continue;
        }
        let mut fields = Fields::new(&floor);
        let goals = fields.goals(&floor, &targets, 1).unwrap();
        let mut search = Search::new(Arbiter::new(&floor, &fields, goals, seed), &starts, seed);
        let ended = (0..1_000_000).any(|_| search.advance() == Advance::Exhausted);
        assert!(ended, "{seed}");
        assert_eq!(search.loss(), least_loss(&map, &team), "{seed} {}", map.to_text());
        if let Some(plan) = search.plan() {
            assert_eq!(check_plan(&map, &team, &plan), Ok(()));
            assert_eq!(Some(loss(&team, &plan)), search.loss());
            // A search that is given the plan knows it, and finds no better one either.
            let goals = search.goals().to_vec();
            let mut other = Search::new(Arbiter::new(&floor, &fields, goals, !seed), &starts, !seed);
            assert!(other.insert(&plan) && !other.insert(&plan), "{seed}");
            assert_eq!((other.loss(), other.plan()), (search.loss(), Some(plan)));
            assert!((0..1_000_000).any(|_| other.advance() == Advance::Exhausted));
            assert_eq!(other.loss(), search.loss());
            best += 1;
        }
    }
    println!("{best} plans of the least loss");
    assert!(best > 800);
}
