//! A* on tiles of 8 × 8 cells, all cells of a tile in a few operations.
//!
//! Counted in detours, a step towards the target costs nothing and a step away costs one: the levels of A* with
//! the distance on an empty floor are then the numbers of detours. Steps that cost nothing are closed inside a
//! tile by filling along its rows and columns. Each cell keeps one bit of its level: between neighbours the levels
//! differ by one at most, and in a known direction, so the way back is found from it.
//!
//! The A* of Hart, Nilsson, Raphael (*A Formal Basis for the Heuristic Determination of Minimum Cost Paths*, 1968);
//! detour numbers are Hadlock's (*A shortest path algorithm for grid graphs*, Networks 7, 1977).

use super::tiles::{Grid, List};
use crate::lattice::Cell;
use crate::map::Map;
use crate::wave::{EAST, WEST, each_free};

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
    now: List,
    next: List,
    touched: List,
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
        each_free(map, |tile, free| tiles[tile].free = free);
        Self { grid, tiles, now: List::new(grid), next: List::new(grid), touched: List::new(grid) }
    }

    /// The number of detours that a shortest way makes; its steps are the distance and two for each detour.
    pub(super) fn run(&mut self, from: Cell, to: Cell) -> Option<u32> {
        self.reset();
        let aim = Aim::new(to);
        let ((start, start_bit), (target, target_bit)) = (self.grid.locate(from), self.grid.locate(to));
        self.hand(start, 0, 1 << start_bit);
        for level in 0.. {
            if self.next.len() == 0 {
                return None;
            }
            for tile in self.next.tiles() {
                let cells = &mut self.tiles[tile];
                cells.now = cells.next & !cells.visited;
                cells.next = 0;
                self.now.put(tile, cells.now != 0);
            }
            self.next.clear();
            let odd = if level % 2 == 1 { u64::MAX } else { 0 };
            while let Some(tile) = self.now.pop() {
                self.spread(tile, odd, &aim);
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
        let seeds = std::mem::take(&mut tile.now);
        let row = at as u32 / stride as u32;
        let towards = aim.towards(at - row as usize * stride, row as usize);
        let new = towards.fill(seeds, open);
        tile.visited |= new;
        tile.odd |= new & odd;
        let away = (new & !towards.east & !EAST) << 1
            | (new & !towards.west & !WEST) >> 1
            | (new & !towards.south) << 8
            | (new & !towards.north) >> 8;
        self.hand(at, 0, away);
        self.leave(at + 1, (new & EAST) >> 7, (towards.east & EAST) >> 7);
        self.leave(at - 1, (new & WEST) << 7, (towards.west & WEST) << 7);
        self.leave(at + stride, new >> 56, towards.south >> 56);
        self.leave(at - stride, new << 56, towards.north << 56);
    }

    /// Hands cells to a neighbouring tile: those of `free_of_cost` at this level, the others at the next.
    #[inline]
    fn leave(&mut self, at: usize, cells: u64, free_of_cost: u64) {
        if cells != 0 {
            self.hand(at, cells & free_of_cost, cells & !free_of_cost);
        }
    }

    /// Hands cells to a tile, without a branch.
    #[inline]
    #[expect(clippy::needless_bitwise_bool, reason = "a lazy operator is a branch that cannot be foreseen")]
    fn hand(&mut self, at: usize, now: u64, next: u64) {
        let tile = &mut self.tiles[at];
        let open = tile.free & !tile.visited;
        let (now, next) = (now & open, next & open);
        self.touched.put(at, (tile.visited | tile.now | tile.next == 0) & (now | next != 0));
        self.now.put(at, (tile.now == 0) & (now != 0));
        self.next.put(at, (tile.next == 0) & (next != 0));
        tile.now |= now;
        tile.next |= next;
    }

    fn reset(&mut self) {
        for tile in self.touched.tiles() {
            let tile = &mut self.tiles[tile];
            *tile = Tile { free: tile.free, ..Tile::default() };
        }
        self.touched.clear();
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
        let lists = self.now.bytes() + self.next.bytes() + self.touched.bytes();
        self.tiles.capacity() * size_of::<Tile>() + lists
    }
}
