//! The wave through time against a plain search over cells and steps.

use activecell::{Cell, Lattice, Map, Rng};
use activecell_fleet::{Floor, Passage, Reservations};
use std::collections::BTreeSet;

/// Others wander: each path is taken step by step where it meets nobody, so that the reservations are those of a plan.
fn wander(map: &Map, taken: &mut Reservations, robots: usize, steps: usize, rng: &mut Rng) -> Vec<Vec<Cell>> {
    let free: Vec<Cell> = map.free().collect();
    let mut paths: Vec<Vec<Cell>> = Vec::new();
    for _ in 0..robots {
        let start = free[rng.below(free.len() as u32) as usize];
        let mut path = vec![start];
        for step in 0..steps {
            let here = path[step];
            let mut ways: Vec<Cell> =
                map.lattice().dirs().map(|dir| map.lattice().neighbour(here, dir)).collect();
            ways.push(here);
            let next = ways[rng.below(ways.len() as u32) as usize];
            path.push(if map.is_free(next) { next } else { here });
        }
        if paths.iter().all(|other| meet_never(other, &path)) {
            taken.reserve(&path.iter().map(|&cell| taken.layout().bit(cell)).collect::<Vec<_>>());
            paths.push(path);
        }
    }
    paths
}

fn meet_never(a: &[Cell], b: &[Cell]) -> bool {
    (0..a.len()).all(|i| a[i] != b[i]) && (1..a.len()).all(|i| a[i] != b[i - 1] || b[i] != a[i - 1])
}

/// The same question, asked plainly: sets of cells, step by step.
fn plain(map: &Map, others: &[Vec<Cell>], from: Cell, to: Cell, latest: usize) -> Option<usize> {
    let at = |path: &Vec<Cell>, step: usize| path[step.min(path.len() - 1)];
    let horizon = others.iter().map(Vec::len).max().unwrap_or(1);
    if others.iter().any(|path| at(path, horizon) == to) {
        return None;
    }
    let keeps = (0..horizon)
        .rev()
        .find(|&step| others.iter().any(|path| at(path, step) == to))
        .map_or(0, |step| step + 1);
    let mut reached = BTreeSet::from([from]);
    for step in 0..=latest {
        if step >= keeps && reached.contains(&to) {
            return Some(step);
        }
        let mut next = BTreeSet::new();
        for &here in &reached {
            let around = map.lattice().dirs().map(|dir| map.lattice().neighbour(here, dir)).chain([here]);
            next.extend(around.filter(|&there| {
                map.is_free(there)
                    && others.iter().all(|path| {
                        let (now, then) = (at(path, step), at(path, step + 1));
                        then != there && (now != there || then != here || here == there)
                    })
            }));
        }
        reached = next;
    }
    None
}

#[test]
fn the_wave_through_time_arrives_as_soon_as_a_plain_search() {
    let mut rng = Rng::new(5);
    let (mut found, mut late) = (0, 0);
    for case in 0..3000 {
        let lattice = if case % 2 == 0 { Lattice::Square } else { Lattice::Hex };
        let [width, height] = [1 + rng.below(if case % 5 == 0 { 150 } else { 9 }), 1 + rng.below(9)];
        let map = Map::random(lattice, width, height, 0.2, rng.next_u64()).unwrap();
        let free: Vec<Cell> = map.free().collect();
        if free.is_empty() {
            continue;
        }
        let floor = Floor::new(&map);
        let steps = rng.below(12) as usize;
        let mut taken = Reservations::new(&floor, steps + rng.below(3) as usize);
        let robots = rng.below(1 + free.len() as u32 / 2) as usize;
        let others = wander(&map, &mut taken, robots, steps, &mut rng);
        let mut passage = Passage::new(taken.layout());
        for _ in 0..4 {
            let mut any = || free[rng.below(free.len() as u32) as usize];
            let (from, to) = (any(), any());
            if others.iter().any(|path| path[0] == from) {
                continue;
            }
            let latest = rng.below(40) as usize;
            let [a, b] = [from, to].map(|cell| taken.layout().bit(cell));
            let path = passage.earliest(&taken, a, b, latest, &mut rng);
            assert_eq!(path.as_ref().map(|path| path.len() - 1), plain(&map, &others, from, to, latest));
            let Some(path) = path else { continue };
            found += 1;
            late += usize::from(path.len() as u32 > lattice.distance(from, to) + 1);
            assert_eq!((path[0], path[path.len() - 1]), (a, b));
            let cells: Vec<Cell> = path.iter().map(|&bit| taken.layout().cell(bit)).collect();
            assert!(
                cells
                    .windows(2)
                    .all(|pair| pair[0] == pair[1] || lattice.dir_between(pair[0], pair[1]).is_some())
            );
            let end = path.len().max(steps + 1);
            let whole =
                |path: &[Cell]| -> Vec<Cell> { (0..=end).map(|i| path[i.min(path.len() - 1)]).collect() };
            assert!(others.iter().all(|other| meet_never(&whole(other), &whole(&cells))));
        }
    }
    println!(
        "{found} paths among others, {late} of them later than the distance: each as soon as a plain search"
    );
    assert!(found > 2000 && late > 500);
}

#[test]
fn what_is_given_back_is_free_again() {
    let map = Map::random(Lattice::Hex, 70, 5, 0.1, 3).unwrap();
    let floor = Floor::new(&map);
    let mut rng = Rng::new(8);
    let mut taken = Reservations::new(&floor, 20);
    let others = wander(&map, &mut taken, 30, 20, &mut rng);
    for path in &others {
        taken.release(&path.iter().map(|&cell| taken.layout().bit(cell)).collect::<Vec<_>>());
    }
    for (step, cell) in (0..25).flat_map(|step| map.free().map(move |cell| (step, cell))) {
        let bit = taken.layout().bit(cell);
        assert!(!taken.is_taken(step, bit));
        assert!(floor.links(floor.number(cell)).iter().all(|&next| taken.allows(
            step,
            bit,
            taken.layout().bit(floor.cell(next))
        )));
    }
}
