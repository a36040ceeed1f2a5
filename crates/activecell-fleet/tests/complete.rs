//! The search against an exhaustive one over all configurations, on floors so small that it can be done.

#![expect(clippy::unwrap_used, reason = "a test that cannot make its map should stop")]

use activecell::{Cell, Lattice, Map, Rng, Team, check_plan};
use activecell_fleet::{Ending, Limits, Options, solve};
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
    for i in (1..cells.len()).rev() {
        cells.swap(i, rng.below(i as u32 + 1) as usize);
    }
    cells.truncate(count);
    cells
}

/// The steps in which a robot does not rest at its target.
fn loss(team: &Team, plan: &activecell::Plan) -> u64 {
    let target = |robot: usize, step: usize| plan.at(step, robot) == team.targets()[robot];
    let away = |step: usize| (0..team.robots()).filter(|&i| !target(i, step) || !target(i, step + 1)).count();
    (0..plan.steps()).map(|step| away(step) as u64).sum()
}

#[test]
fn the_search_finds_a_plan_if_there_is_one_and_the_best_if_it_may_end() {
    let (mut solved, mut impossible, mut best) = (0, 0, 0);
    for seed in 0..4000 {
        let mut rng = Rng::new(seed);
        let lattice = Lattice::ALL[seed as usize % 2];
        let (width, height) = [(3, 3), (4, 2), (7, 1), (5, 2), (2, 4)][rng.below(5) as usize];
        let map = Map::random(lattice, width, height, f64::from(rng.below(5)) * 0.1, seed).unwrap();
        let free: Vec<Cell> = map.free().collect();
        let robots = 2 + rng.below(2) as usize;
        if free.len() < robots || free.len() > 9 {
            continue;
        }
        let (starts, targets) = (some_cells(&free, robots, &mut rng), some_cells(&free, robots, &mut rng));
        let team = Team::new(&map, starts, targets).unwrap();
        let least = least_loss(&map, &team);
        let steps = if seed % 4 == 0 { 400_000 } else { 20_000 };
        let limits = Limits { time: None, steps: Some(steps), first: seed % 4 != 0, ..Limits::default() };
        let outcome = solve(&map, &team, &Options { seed, threads: 1, limits }, |_| {}).unwrap();
        let Some(plan) = &outcome.plan else {
            assert!(outcome.is_impossible(), "{lattice} {seed}: {:?}", outcome.ending);
            assert_eq!(least, None, "{lattice} {seed} {}", map.to_text());
            impossible += 1;
            continue;
        };
        assert_eq!(check_plan(&map, &team, plan), Ok(()), "{lattice} {seed}");
        assert_eq!(Some(outcome.lower_bound), team.lower_bound(&map).unwrap());
        let loss = loss(&team, plan);
        assert!(least.is_some_and(|least| least <= loss), "{lattice} {seed}: {least:?} {loss}");
        if outcome.ending == Ending::Exhausted {
            assert!(plan.sum_of_costs() >= least.unwrap());
            best += 1;
        }
        solved += 1;
    }
    println!("{solved} solved, {best} of them to the end; {impossible} impossible");
    assert!(solved > 1500 && impossible > 300 && best > 300);
}
