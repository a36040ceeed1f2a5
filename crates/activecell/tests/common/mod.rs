//! Naive twins: plain searches that the tests hold against the core.

use activecell::{Cell, Dir, Lattice, Map, Rng};
use std::collections::{BTreeMap, VecDeque};

/// Distances from `from` by plain breadth-first search.
pub(crate) fn breadth_first(map: &Map, from: Cell) -> BTreeMap<Cell, u32> {
    let mut steps = BTreeMap::from([(from, 0)]);
    let mut queue = VecDeque::from([from]);
    while let Some(cell) = queue.pop_front() {
        for dir in map.lattice().dirs() {
            let next = map.lattice().neighbour(cell, dir);
            if map.is_free(next) && !steps.contains_key(&next) {
                steps.insert(next, steps[&cell] + 1);
                queue.push_back(next);
            }
        }
    }
    steps
}

/// The least (steps, turns) from `from` to `to`, by relaxing every (cell, direction) until nothing changes.
///
/// The first step is no turn in the directions `facing`.
pub(crate) fn least_steps_and_turns(map: &Map, from: Cell, to: Cell, facing: &[Dir]) -> Option<(u32, u32)> {
    let lattice = map.lattice();
    let mut best: BTreeMap<(Cell, Dir), (u32, u32)> =
        facing.iter().map(|&dir| ((from, dir), (0, 0))).collect();
    let mut queue: VecDeque<(Cell, Dir)> = best.keys().copied().collect();
    while let Some((cell, facing)) = queue.pop_front() {
        let (steps, turns) = best[&(cell, facing)];
        for dir in lattice.dirs() {
            let next = lattice.neighbour(cell, dir);
            let cost = (steps + 1, turns + u32::from(dir != facing));
            if map.is_free(next) && best.get(&(next, dir)).is_none_or(|&old| cost < old) {
                best.insert((next, dir), cost);
                queue.push_back((next, dir));
            }
        }
    }
    lattice.dirs().filter_map(|dir| best.get(&(to, dir)).copied()).min()
}

/// A random map with two free cells on it.
pub(crate) fn random_task(lattice: Lattice, side: u32, density: f64, seed: u64) -> Option<(Map, Cell, Cell)> {
    let map = Map::random(lattice, side, side, density, seed).expect("a density between 0 and 1");
    let free: Vec<Cell> = map.free().collect();
    let mut rng = Rng::new(!seed);
    let mut pick = || free.get(rng.below(free.len().max(1) as u32) as usize).copied();
    let (from, to) = (pick()?, pick()?);
    Some((map, from, to))
}
