//! A* on tiles of 8 × 8 cells, all cells of a tile in a few operations.
//!
//! Counted in detours, a step towards the target costs nothing and a step away costs one: the levels of A* with
//! the distance on an empty floor are then the numbers of detours. Steps that cost nothing are closed inside a
//! tile by filling along its rows and columns. Each cell keeps one bit of its level: between neighbours the levels
//! differ by one at most, and in a known direction, so the way back is found from it.
//!
//! The A* of Hart, Nilsson, Raphael (*A Formal Basis for the Heuristic Determination of Minimum Cost Paths*, 1968);
//! detour numbers are Hadlock's (*A shortest path algorithm for grid graphs*, Networks 7, 1977).

use super::tiles::{EAST, Grid, WEST};
use crate::lattice::Cell;
use crate::map::Map;

/// 64 cells of the search.
#[derive(Debug, Clone, Copy, Default)]
struct Tile {
    free: u64,
    visited: u64,
    /// The level's lowest bit, of visited cells.
    odd: u64,
    /// Reached at the level at hand, not yet spread.
    now: u64,
    /// Reached at the next level.
    next: u64,
}

/// The search by detours; square lattice only.
#[derive(Debug, Clone)]
pub(super) struct Detours {
    grid: Grid,
    tiles: Vec<Tile>,
    now: Vec<u32>,
    next: Vec<u32>,
    touched: Vec<u32>,
}

/// For the cells of one tile: from which of them a step in a direction leads towards the target.
#[derive(Debug, Clone, Copy)]
struct Towards {
    east: u64,
    west: u64,
    south: u64,
    north: u64,
}

/// Target's tile and place in it.
#[derive(Debug, Clone, Copy)]
struct Aim {
    column: usize,
    row: usize,
    in_column: Towards,
}

impl Aim {
    fn new(to: Cell) -> Self {
        let (x, y) = ((to.x % 8) as u32, (to.y % 8) as u32);
        let west_of = WEST * ((1 << x) - 1);
        let north_of = (1u64 << (8 * y)) - 1;
        let in_column = Towards {
            east: west_of,
            west: !west_of & !(WEST << x),
            south: north_of,
            north: !north_of & !(0xff << (8 * y)),
        };
        Self { column: to.x as usize / 8 + 1, row: to.y as usize / 8 + 1, in_column }
    }

    #[inline]
    fn towards(&self, column: usize, row: usize) -> Towards {
        let (east, west) = match column.cmp(&self.column) {
            std::cmp::Ordering::Less => (u64::MAX, 0),
            std::cmp::Ordering::Equal => (self.in_column.east, self.in_column.west),
            std::cmp::Ordering::Greater => (0, u64::MAX),
        };
        let (south, north) = match row.cmp(&self.row) {
            std::cmp::Ordering::Less => (u64::MAX, 0),
            std::cmp::Ordering::Equal => (self.in_column.south, self.in_column.north),
            std::cmp::Ordering::Greater => (0, u64::MAX),
        };
        Towards { east, west, south, north }
    }
}

impl Towards {
    /// All cells of `open` that steps towards the target reach from `cells` inside the tile.
    #[inline]
    fn fill(self, mut cells: u64, open: u64) -> u64 {
        let east = open & (self.east & !EAST) << 1;
        let west = open & (self.west & !WEST) >> 1;
        let south = open & self.south << 8;
        let north = open & self.north >> 8;
        loop {
            if east != 0 {
                cells = fill_up::<1>(cells, east);
            }
            if west != 0 {
                cells = fill_down::<1>(cells, west);
            }
            let before = cells;
            if south != 0 {
                cells = fill_up::<8>(cells, south);
            }
            if north != 0 {
                cells = fill_down::<8>(cells, north);
            }
            if cells == before {
                return cells;
            }
        }
    }
}

/// Fills towards higher bits through `pass`, `STEP` bits a step, up to seven steps.
#[inline]
fn fill_up<const STEP: u32>(mut cells: u64, mut pass: u64) -> u64 {
    cells |= pass & cells << STEP;
    pass &= pass << STEP;
    cells |= pass & cells << (2 * STEP);
    pass &= pass << (2 * STEP);
    cells | pass & cells << (4 * STEP)
}

/// Fills towards lower bits.
#[inline]
fn fill_down<const STEP: u32>(mut cells: u64, mut pass: u64) -> u64 {
    cells |= pass & cells >> STEP;
    pass &= pass >> STEP;
    cells |= pass & cells >> (2 * STEP);
    pass &= pass >> (2 * STEP);
    cells | pass & cells >> (4 * STEP)
}

impl Detours {
    pub(super) fn new(map: &Map) -> Self {
        let grid = Grid::new(map);
        let mut tiles = vec![Tile::default(); grid.len];
        grid.each_free(map, |tile, free| tiles[tile].free = free);
        let list = || Vec::with_capacity(grid.len);
        Self { grid, tiles, now: list(), next: list(), touched: list() }
    }

    /// The number of detours that a shortest way makes; its steps are the distance and two for each detour.
    pub(super) fn run(&mut self, from: Cell, to: Cell) -> Option<u32> {
        self.reset();
        let aim = Aim::new(to);
        let ((start, start_bit), (target, target_bit)) = (self.grid.locate(from), self.grid.locate(to));
        self.put_next(start, 1 << start_bit);
        for level in 0.. {
            if self.next.is_empty() {
                return None;
            }
            std::mem::swap(&mut self.now, &mut self.next);
            let tiles = &mut self.tiles;
            self.now.retain(|&tile| {
                let tile = &mut tiles[tile as usize];
                tile.now = tile.next & !tile.visited;
                tile.next = 0;
                tile.now != 0
            });
            let odd = if level % 2 == 1 { u64::MAX } else { 0 };
            while let Some(tile) = self.now.pop() {
                self.spread(tile as usize, odd, &aim);
                if self.tiles[target].visited >> target_bit & 1 == 1 {
                    return Some(level);
                }
            }
        }
        None
    }

    /// Closes the tile under steps towards the target and hands on what leaves it.
    #[inline]
    fn spread(&mut self, at: usize, odd: u64, aim: &Aim) {
        let stride = self.grid.stride;
        let tile = &mut self.tiles[at];
        let open = tile.free & !tile.visited;
        let seeds = tile.now & open;
        tile.now = 0;
        if seeds == 0 {
            return;
        }
        let towards = aim.towards(at % stride, at / stride);
        let new = towards.fill(seeds, open);
        tile.visited |= new;
        tile.odd |= new & odd;
        let rest = open & !new;
        let away = (new & !towards.east & !EAST) << 1
            | (new & !towards.west & !WEST) >> 1
            | (new & !towards.south) << 8
            | (new & !towards.north) >> 8;
        if away & rest != 0 {
            self.put_next(at, away & rest);
        }
        self.leave(at + 1, (new & EAST) >> 7, (towards.east & EAST) >> 7);
        self.leave(at - 1, (new & WEST) << 7, (towards.west & WEST) << 7);
        self.leave(at + stride, new >> 56, towards.south >> 56);
        self.leave(at - stride, new << 56, towards.north << 56);
    }

    /// Hands cells to a neighbouring tile: those of `free_of_cost` at this level, the others at the next.
    #[inline]
    fn leave(&mut self, at: usize, cells: u64, free_of_cost: u64) {
        let tile = &mut self.tiles[at];
        let cells = cells & tile.free & !tile.visited;
        let (now, next) = (cells & free_of_cost, cells & !free_of_cost);
        if now != 0 {
            if tile.visited | tile.next | tile.now == 0 {
                self.touched.push(at as u32);
            }
            if tile.now == 0 {
                self.now.push(at as u32);
            }
            tile.now |= now;
        }
        if next != 0 {
            self.put_next(at, next);
        }
    }

    #[inline]
    fn put_next(&mut self, at: usize, cells: u64) {
        let tile = &mut self.tiles[at];
        if tile.next == 0 {
            if tile.visited | tile.now == 0 {
                self.touched.push(at as u32);
            }
            self.next.push(at as u32);
        }
        tile.next |= cells;
    }

    fn reset(&mut self) {
        for tile in self.touched.drain(..) {
            let tile = &mut self.tiles[tile as usize];
            *tile = Tile { free: tile.free, ..Tile::default() };
        }
        self.now.clear();
        self.next.clear();
    }

    /// The cells of a shortest way, after [`run`](Self::run) found one of `steps` steps.
    pub(super) fn path(&self, from: Cell, to: Cell, steps: u32) -> Vec<Cell> {
        let mut path = vec![from; steps as usize + 1];
        let mut cell = to;
        let mut last = (0, 0);
        for place in path.iter_mut().rev() {
            *place = cell;
            if cell == from {
                break;
            }
            let (tile, bit) = self.grid.locate(cell);
            let odd = self.tiles[tile].odd >> bit & 1;
            let comes_from = |(dx, dy): (i32, i32)| {
                let before = Cell::new(cell.x + dx, cell.y + dy);
                let (tile, bit) = self.grid.locate(before);
                let tile = &self.tiles[tile];
                let towards = if dx == 0 {
                    (to.y - before.y).abs() > (to.y - cell.y).abs()
                } else {
                    (to.x - before.x).abs() > (to.x - cell.x).abs()
                };
                tile.visited >> bit & 1 == 1 && (tile.odd >> bit & 1 == odd) == towards
            };
            if last == (0, 0) || !comes_from(last) {
                let steps = [(1, 0), (-1, 0), (0, 1), (0, -1)];
                let Some(step) = steps.into_iter().find(|&step| comes_from(step)) else {
                    debug_assert!(false, "the way back is lost");
                    break;
                };
                last = step;
            }
            cell = Cell::new(cell.x + last.0, cell.y + last.1);
        }
        path
    }

    pub(super) fn bytes(&self) -> usize {
        self.tiles.capacity() * size_of::<Tile>()
            + (self.now.capacity() + self.next.capacity() + self.touched.capacity()) * 4
    }
}
