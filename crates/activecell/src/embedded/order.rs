//! The free cells in an order in which neighbours stand close together, and who touches whom.

use crate::lattice::{Cell, Dir};
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

impl Order {
    pub(super) fn new(map: &Map) -> Self {
        let mut number = vec![NONE; map.cells()];
        let mut order: Vec<Cell> = Vec::with_capacity(map.free_cells());
        let at = |cell| map.index(cell).filter(|_| map.is_free(cell));
        let lattice = map.lattice();
        let mut way: Vec<(Cell, u8)> = Vec::new();
        for start in map.free() {
            let index = at(start).expect("a free cell has an index");
            if number[index] != NONE {
                continue;
            }
            number[index] = order.len() as u32;
            order.push(start);
            way.push((start, 0));
            while let Some((cell, dir)) = way.last_mut() {
                if *dir == lattice.degree() {
                    way.pop();
                    continue;
                }
                let next = lattice.neighbour(*cell, Dir(*dir));
                *dir += 1;
                if let Some(index) = at(next).filter(|&index| number[index] == NONE) {
                    number[index] = order.len() as u32;
                    order.push(next);
                    way.push((next, 0));
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
