//! Floors to test on, and plain searches to test against.

use activecell::{BitPlane, Cell, Lattice, Map, Rng};
use std::collections::VecDeque;

/// Sizes at which rows and words end in every way.
pub(crate) const SIZES: [(u32, u32); 14] = [
    (1, 1),
    (1, 9),
    (9, 1),
    (2, 2),
    (7, 8),
    (8, 7),
    (9, 9),
    (15, 6),
    (16, 16),
    (17, 5),
    (31, 9),
    (33, 12),
    (64, 10),
    (65, 17),
];

/// Shares of obstacles from none to all.
const DENSITIES: [f64; 8] = [0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.6, 1.0];

/// A map of some kind and size, another for each seed: clutter of every density, and mazes.
pub(crate) fn floor(seed: u64) -> Map {
    let mut rng = Rng::new(seed);
    let lattice = Lattice::ALL[seed as usize % 2];
    let (width, height) = SIZES[rng.below(SIZES.len() as u32) as usize];
    if rng.chance(0.25) {
        maze(lattice, width, height, seed)
    } else {
        let density = DENSITIES[rng.below(DENSITIES.len() as u32) as usize];
        Map::random(lattice, width, height, density, seed).unwrap()
    }
}

/// Corridors of one cell without a loop (on squares; hexagons join some), dug by depth-first search.
pub(crate) fn maze(lattice: Lattice, width: u32, height: u32, seed: u64) -> Map {
    let mut rng = Rng::new(seed);
    let mut plane = BitPlane::new(width.into(), height.into()).unwrap();
    for y in 0..height {
        for x in 0..width {
            plane.set(x, y, true);
        }
    }
    let mut stack = vec![(0u32, 0u32)];
    plane.set(0, 0, false);
    while let Some(&(x, y)) = stack.last() {
        let open: Vec<(i64, i64)> = [(0, -2), (2, 0), (0, 2), (-2, 0)]
            .into_iter()
            .filter(|&(dx, dy)| {
                let (x, y) = (i64::from(x) + dx, i64::from(y) + dy);
                (0..i64::from(width)).contains(&x)
                    && (0..i64::from(height)).contains(&y)
                    && plane.get(x as u32, y as u32)
            })
            .collect();
        if open.is_empty() {
            stack.pop();
            continue;
        }
        let (dx, dy) = open[rng.below(open.len() as u32) as usize];
        let at = |part: i64| ((i64::from(x) + dx * part / 2) as u32, (i64::from(y) + dy * part / 2) as u32);
        for (x, y) in [at(1), at(2)] {
            plane.set(x, y, false);
        }
        stack.push(at(2));
    }
    Map::new(lattice, plane)
}

/// A cell of the map, or rarely one beside it.
pub(crate) fn any_cell(map: &Map, rng: &mut Rng) -> Cell {
    let beside = i32::from(rng.chance(0.02));
    let x = rng.below(map.width() + 2 * beside as u32) as i32 - beside;
    Cell::new(x, rng.below(map.height()) as i32)
}

/// A free cell, if there is one.
pub(crate) fn free_cell(map: &Map, rng: &mut Rng) -> Option<Cell> {
    let free: Vec<Cell> = map.free().collect();
    (!free.is_empty()).then(|| free[rng.below(free.len() as u32) as usize])
}

/// Every cell of the map, free or not.
pub(crate) fn cells(map: &Map) -> impl Iterator<Item = Cell> + use<> {
    let (width, height) = (map.width() as i32, map.height() as i32);
    (0..height).flat_map(move |y| (0..width).map(move |x| Cell::new(x, y)))
}

/// Steps from every cell to `target` by plain breadth-first search, in row order.
pub(crate) fn steps(map: &Map, target: Cell) -> Vec<Option<u32>> {
    let mut steps = vec![None; map.cells()];
    if map.is_free(target) {
        steps[map.index(target).unwrap()] = Some(0);
        let mut queue = VecDeque::from([target]);
        while let Some(cell) = queue.pop_front() {
            let here = steps[map.index(cell).unwrap()].unwrap();
            for dir in map.lattice().dirs() {
                let next = map.lattice().neighbour(cell, dir);
                if map.is_free(next) && steps[map.index(next).unwrap()].is_none() {
                    steps[map.index(next).unwrap()] = Some(here + 1);
                    queue.push_back(next);
                }
            }
        }
    }
    steps
}
