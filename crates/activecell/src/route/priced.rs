//! Routes on which turns have a price: shorter ways are given up for ways with fewer, or better placed, turns.

use super::{Outcome, Route};
use crate::lattice::{Cell, Dir};
use crate::wave::Field;
use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};

/// What a step costs, in the unit of turns' prices.
pub(crate) const STEP: u64 = 1 << 20;
/// Places (a cell and a direction) that are looked at before a search is given up.
const MOST_PLACES: usize = 500_000;

/// A cell, and the direction in which it was entered.
type Place = (Cell, Dir);

impl Field {
    /// The route from `from` to the nearest target on which steps and turns cost least, each turn the price of its
    /// cell. The first step is no turn in the directions `facing`. `None` where the wave did not come, or if the
    /// search would grow too large.
    ///
    /// A search that always goes on where cost so far and field together are least (Hart, Nilsson and Raphael, *A
    /// Formal Basis for the Heuristic Determination of Minimum Cost Paths*, 1968).
    pub(crate) fn route_with_priced_turns(
        &self,
        from: Cell,
        facing: &[Dir],
        price: impl Fn(Cell) -> u64,
    ) -> Option<Route> {
        let lattice = self.lattice();
        let to_go = |cell: Cell| self.steps(cell).map(|steps| u64::from(steps) * STEP);
        let mut known: HashMap<Place, (u64, Option<Place>)> = HashMap::new();
        let mut open = BinaryHeap::new();
        let start = to_go(from)?;
        for &dir in facing {
            known.insert((from, dir), (0, None));
            open.push(Reverse((start, Reverse(0), (from, dir))));
        }
        if facing.is_empty() || start == 0 {
            return Some(self.of_cells(vec![from]));
        }
        while let Some(Reverse((_, Reverse(cost), place))) = open.pop() {
            let (cell, dir) = place;
            if known[&place].0 < cost {
                continue;
            }
            if to_go(cell) == Some(0) {
                return Some(self.of_cells(traced(&known, place)));
            }
            if known.len() > MOST_PLACES {
                return None;
            }
            for next_dir in lattice.dirs() {
                let next = (lattice.neighbour(cell, next_dir), next_dir);
                let Some(rest) = to_go(next.0) else { continue };
                let turn = if next_dir == dir || cell == from && facing.contains(&next_dir) {
                    0
                } else {
                    price(cell)
                };
                let cost = cost + STEP + turn;
                if known.get(&next).is_none_or(|&(old, _)| cost < old) {
                    known.insert(next, (cost, Some(place)));
                    open.push(Reverse((cost + rest, Reverse(cost), next)));
                }
            }
        }
        None
    }

    /// Some shortest route from `from` to the nearest target: the first step that leads nearer, again and again.
    ///
    /// ```
    /// use activecell::{Cell, Lattice, Map};
    /// let map = Map::parse(Lattice::Square, "S..\n.#.\n..F")?;
    /// let route = map.wave(Cell::new(2, 2))?.shortest_route(Cell::new(0, 0));
    /// assert_eq!(route.steps(), 4);
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn shortest_route(&self, from: Cell) -> Route {
        let mut cells = vec![from];
        let mut cell = from;
        while let Some(dir) = self.nearer(cell).next() {
            cell = self.lattice().neighbour(cell, dir);
            cells.push(cell);
        }
        self.of_cells(cells)
    }

    fn of_cells(&self, cells: Vec<Cell>) -> Route {
        let arrives = self.steps(cells[0]).is_some();
        let outcome = if arrives { Outcome::Arrived } else { Outcome::Unreachable };
        Route { lattice: self.lattice(), outcome, cells, cycle: Vec::new() }
    }
}

/// The cells that led to a place.
fn traced(known: &HashMap<Place, (u64, Option<Place>)>, mut place: Place) -> Vec<Cell> {
    let mut cells = vec![place.0];
    while let Some(before) = known[&place].1 {
        cells.push(before.0);
        place = before;
    }
    cells.reverse();
    cells
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lattice::Lattice;
    use crate::map::Map;
    use crate::rng::Rng;

    /// The least cost by relaxing every place until nothing changes.
    fn least(map: &Map, from: Cell, to: Cell, facing: &[Dir], price: impl Fn(Cell) -> u64) -> Option<u64> {
        let lattice = map.lattice();
        let mut best: HashMap<Place, u64> = facing.iter().map(|&dir| ((from, dir), 0)).collect();
        let mut queue: Vec<Place> = facing.iter().map(|&dir| (from, dir)).collect();
        while let Some((cell, dir)) = queue.pop() {
            let cost = best[&(cell, dir)];
            for next_dir in lattice.dirs() {
                let next = (lattice.neighbour(cell, next_dir), next_dir);
                let straight = next_dir == dir || cell == from && facing.contains(&next_dir);
                let cost = cost + STEP + if straight { 0 } else { price(cell) };
                if map.is_free(next.0) && best.get(&next).is_none_or(|&old| cost < old) {
                    best.insert(next, cost);
                    queue.push(next);
                }
            }
        }
        lattice.dirs().filter_map(|dir| best.get(&(to, dir)).copied()).min()
    }

    #[test]
    fn priced_turns_cost_least() {
        for seed in 0..200 {
            let lattice = Lattice::ALL[seed as usize % 2];
            let map = Map::random(lattice, 9, 9, 0.3, seed).unwrap();
            let (Some(from), Some(to)) = (map.free().next(), map.free().last()) else { continue };
            let mut rng = Rng::new(seed);
            let prices: Vec<u64> = (0..81).map(|_| u64::from(rng.below(1 << 22))).collect();
            let price = |cell: Cell| prices[map.index(cell).unwrap()];
            let facing: Vec<Dir> =
                if seed % 3 == 0 { vec![Dir(seed as u8 % 4)] } else { lattice.dirs().collect() };
            let route = map.wave(to).unwrap().route_with_priced_turns(from, &facing, price);
            let expected = least(&map, from, to, &facing, price);
            let cost = route.map(|route| {
                assert!(route.check(&map, from, to).is_ok());
                let dirs: Vec<Dir> = route.dirs().collect();
                let turns = dirs.windows(2).zip(&route.cells()[1..]).filter(|(pair, _)| pair[0] != pair[1]);
                let first = dirs.first().is_some_and(|dir| !facing.contains(dir));
                route.steps() as u64 * STEP
                    + turns.map(|(_, &cell)| price(cell)).sum::<u64>()
                    + if first { price(from) } else { 0 }
            });
            assert_eq!(cost, expected, "{seed}");
        }
    }

    #[test]
    fn shortest_routes_are_shortest() {
        for seed in 0..100 {
            let map = Map::random(Lattice::ALL[seed as usize % 2], 12, 12, 0.3, seed).unwrap();
            let (from, to) = (map.free().next().unwrap(), map.free().last().unwrap());
            let field = map.wave(to).unwrap();
            let (short, few) = (field.shortest_route(from), field.route(from));
            assert_eq!((short.steps(), short.outcome()), (few.steps(), few.outcome()));
            assert!(short.check(&map, from, to).is_ok());
        }
    }
}
