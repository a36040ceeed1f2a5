//! The free cells in an order in which neighbours stand close together, and who touches whom.

use crate::lattice::{Cell, Dir, Lattice};
use crate::map::Map;

/// The free cells, numbered by depth-first search.
///
/// Cells that lie behind the same door mostly follow one another, so that a row of first moves has few runs.
/// Source: Strasser, Harabor, Botea, *Compressing Optimal Paths with Run Length Encoding*, JAIR 54, 2015.
pub(super) struct Order {
    /// The number of each free cell, in row order.
    pub(super) numbers: Vec<u32>,
    /// The neighbours of each cell by direction, as numbers; the number of free cells where none is free.
    pub(super) neighbours: Vec<u32>,
}

const NONE: u32 = u32::MAX;

/// The directions in the order in which the search tries them. On squares, opposite ones together: the rows of a
/// game map have a quarter fewer runs than with the clockwise order, which in turn is best on hexagons (measured on
/// arena2: 9.4 against 12.8 runs, 45.5 against 49.7). Turning with the search instead doubles them.
const fn tried(lattice: Lattice) -> &'static [Dir] {
    match lattice {
        Lattice::Square => &[Dir::N, Dir::S, Dir::E, Dir::W],
        Lattice::Hex => &[Dir(0), Dir(1), Dir(2), Dir(3), Dir(4), Dir(5)],
    }
}

impl Order {
    pub(super) fn new(map: &Map) -> Self {
        let mut number = vec![NONE; map.cells()];
        let mut order: Vec<Cell> = Vec::with_capacity(map.free_cells());
        let at = |cell| map.index(cell).filter(|_| map.is_free(cell));
        let lattice = map.lattice();
        let mut way = Vec::new();
        for start in map.free() {
            let index = at(start).expect("a free cell has an index");
            if number[index] != NONE {
                continue;
            }
            number[index] = order.len() as u32;
            order.push(start);
            way.push((start, tried(lattice).iter()));
            while let Some((cell, dirs)) = way.last_mut() {
                let Some(&dir) = dirs.next() else {
                    way.pop();
                    continue;
                };
                let next = lattice.neighbour(*cell, dir);
                if let Some(index) = at(next).filter(|&index| number[index] == NONE) {
                    number[index] = order.len() as u32;
                    order.push(next);
                    way.push((next, tried(lattice).iter()));
                }
            }
        }
        let free = order.len() as u32;
        let neighbours =
            order.iter().flat_map(|&cell| lattice.dirs().map(move |dir| at(lattice.neighbour(cell, dir))));
        let neighbours = neighbours.map(|index| index.map_or(free, |index| number[index])).collect();
        number.retain(|&number| number != NONE);
        Self { numbers: number, neighbours }
    }
}
