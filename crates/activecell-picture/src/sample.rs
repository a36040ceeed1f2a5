//! Large maps, looked at from further away: blocks of k × k cells become one.

use activecell::{BitPlane, Cell, Lattice, Map};
use std::borrow::Cow;

/// Above this many cells a map is drawn in blocks.
const MOST_CELLS: u64 = 1 << 22;
/// A block is at least so many pixels wide: finer ones could not be seen.
const LEAST_PX: f64 = 0.25;

/// A map's obstacles in blocks of `block` × `block` cells; a block is an obstacle if at least half of its cells
/// are. With blocks of one cell it is the map itself.
pub(crate) struct Sampled<'a> {
    pub(crate) block: u32,
    /// How the blocks lie: like the map's cells, or as squares if they hold more than one.
    pub(crate) lattice: Lattice,
    pub(crate) obstacles: Cow<'a, BitPlane>,
}

impl<'a> Sampled<'a> {
    /// Blocks large enough that the map, drawn in cells of `cell_px` pixels, can be traced in a second or two.
    pub(crate) fn for_drawing(map: &'a Map, cell_px: f64) -> Self {
        let mut block = 1u32;
        while map.cells() as u64 / (u64::from(block) * u64::from(block)) > MOST_CELLS
            || (cell_px * f64::from(block) < LEAST_PX && block < 1 << 28)
        {
            block *= 2;
        }
        Self::new(map, block)
    }

    /// Blocks of `block` × `block` cells.
    pub(crate) fn new(map: &'a Map, block: u32) -> Self {
        if block > 1
            && let Some(plane) = blocks(map.obstacles(), block)
        {
            return Self { block, lattice: Lattice::Square, obstacles: Cow::Owned(plane) };
        }
        Self { block: 1, lattice: map.lattice(), obstacles: Cow::Borrowed(map.obstacles()) }
    }

    pub(crate) fn width(&self) -> u32 {
        self.obstacles.width()
    }

    pub(crate) fn height(&self) -> u32 {
        self.obstacles.height()
    }

    pub(crate) fn is_obstacle(&self, cell: Cell) -> bool {
        self.obstacles.get(cell.x as u32, cell.y as u32)
    }

    /// The first value that `find` gives for a cell of a block, in row order.
    pub(crate) fn first<T>(&self, map: &Map, block: Cell, find: impl FnMut(Cell) -> Option<T>) -> Option<T> {
        let k = self.block as i32;
        let (right, bottom) = (map.width() as i32, map.height() as i32);
        let rows = block.y * k..((block.y + 1) * k).min(bottom);
        rows.flat_map(|y| (block.x * k..((block.x + 1) * k).min(right)).map(move |x| Cell::new(x, y)))
            .find_map(find)
    }
}

/// The plane in blocks; `None` only if it could not be made, which no plane that exists can cause.
fn blocks(plane: &BitPlane, k: u32) -> Option<BitPlane> {
    let (width, height) = (plane.width().div_ceil(k), plane.height().div_ceil(k));
    let mut sampled = BitPlane::new(width.into(), height.into()).ok()?;
    let mut counts = vec![0u32; width as usize];
    for by in 0..height {
        counts.fill(0);
        let rows = by * k..((by + 1) * k).min(plane.height());
        for y in rows.clone() {
            let row = plane.row(y);
            for (bx, count) in counts.iter_mut().enumerate() {
                let from = bx as u32 * k;
                *count += ones(row, from, (from + k).min(plane.width()));
            }
        }
        for (bx, &count) in counts.iter().enumerate() {
            let from = bx as u32 * k;
            let cells = rows.len() as u64 * u64::from((from + k).min(plane.width()) - from);
            sampled.set(bx as u32, by, 2 * u64::from(count) >= cells);
        }
    }
    Some(sampled)
}

/// How many bits of columns `from..to` are 1.
fn ones(row: &[u64], from: u32, to: u32) -> u32 {
    let mut count = 0;
    let mut x = from;
    while x < to {
        let bits = (64 - x % 64).min(to - x);
        let word = row[x as usize / 64] >> (x % 64);
        count += if bits == 64 { word.count_ones() } else { (word & ((1 << bits) - 1)).count_ones() };
        x += bits;
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_obstacles_if_half_of_them_is() {
        let map = Map::random(Lattice::Hex, 203, 77, 0.5, 9).unwrap();
        for k in [2, 3, 8, 64, 100, 300] {
            let sampled = Sampled::new(&map, k);
            for by in 0..sampled.height() as i32 {
                for bx in 0..sampled.width() as i32 {
                    let (mut cells, mut blocked) = (0, 0);
                    sampled.first(&map, Cell::new(bx, by), |cell| {
                        cells += 1;
                        blocked += i32::from(!map.is_free(cell));
                        None::<()>
                    });
                    assert_eq!(sampled.is_obstacle(Cell::new(bx, by)), 2 * blocked >= cells, "{k} {bx} {by}");
                }
            }
        }
    }
}
