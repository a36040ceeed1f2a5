//! Two floods on hexagons, one from either end, that go on until they meet; on tiles of 8 × 8 cells.
//!
//! A flooded cell keeps its distance modulo 3: neighbours differ by one at most, so three labels are enough to find
//! the way back (Akers, *A Modification of Lee's Path Connection Algorithm*, 1967).

use super::tiles::{Grid, List};
use crate::lattice::{Cell, Lattice};
use crate::map::Map;
use crate::wave::{EAST, WEST, each_free};

/// The even rows of a tile.
const EVEN: u64 = 0x00ff_00ff_00ff_00ff;

/// 64 cells of the search.
#[derive(Debug, Clone, Copy, Default)]
struct Tile {
    free: u64,
    /// The label, 1 + distance modulo 3, in two bits; 0 where no flood came.
    low: u64,
    high: u64,
    /// Whether the flood came from the target.
    second: u64,
    /// The rims of both floods.
    rim: u64,
    /// The rim that is being made.
    next: u64,
}

impl Tile {
    const fn flooded(&self) -> u64 {
        self.low | self.high
    }
}

/// The meeting floods.
#[derive(Debug, Clone)]
pub(super) struct Floods {
    grid: Grid,
    tiles: Vec<Tile>,
    /// Tiles on the rim of either flood.
    rims: [List; 2],
    next: List,
    touched: List,
    /// Where the floods touch: the last cells of the first and of the second.
    met: Option<(Cell, Cell)>,
}

/// What a flood writes at one step.
#[derive(Debug, Clone, Copy)]
struct Ink {
    low: u64,
    high: u64,
    second: u64,
}

impl Ink {
    fn new(distance: u32, flood: usize) -> Self {
        let label = distance % 3 + 1;
        let all = |bit: bool| if bit { u64::MAX } else { 0 };
        Self { low: all(label & 1 == 1), high: all(label & 2 == 2), second: all(flood == 1) }
    }
}

impl Floods {
    pub(super) fn new(map: &Map) -> Self {
        let grid = Grid::new(map);
        let mut tiles = vec![Tile::default(); grid.len];
        each_free(map, |tile, free| tiles[tile].free = free);
        // A rim goes through few of the tiles.
        let list = || List::with_room(grid.len / 4);
        Self { grid, tiles, rims: [list(), list()], next: list(), touched: List::new(grid), met: None }
    }

    /// The length of a shortest way between two different cells.
    pub(super) fn run(&mut self, from: Cell, to: Cell) -> Option<u32> {
        self.reset();
        for (flood, cell) in [from, to].into_iter().enumerate() {
            let (tile, bit) = self.grid.locate(cell);
            self.next.make_room(1);
            self.pour(tile, 1 << bit, Ink::new(0, flood));
            self.advance(flood);
        }
        let mut distance = [0, 0];
        while self.rims[0].len() != 0 && self.rims[1].len() != 0 {
            let flood = usize::from(self.rims[1].len() < self.rims[0].len());
            let ink = Ink::new(distance[flood] + 1, flood);
            let mut met = false;
            for i in 0..self.rims[flood].len() {
                let at = self.rims[flood].get(i);
                let cells = self.tiles[at].rim & !(self.tiles[at].second ^ ink.second);
                self.tiles[at].rim ^= cells;
                if self.spread(at, cells, ink) {
                    self.met = self.touching(at, cells, ink.second);
                    met = true;
                    break;
                }
            }
            if met {
                return Some(distance[0] + 1 + distance[1]);
            }
            self.advance(flood);
            distance[flood] += 1;
        }
        None
    }

    /// Makes the new rim the rim.
    fn advance(&mut self, flood: usize) {
        for tile in self.next.tiles() {
            let tile = &mut self.tiles[tile];
            tile.rim |= tile.next;
            tile.next = 0;
        }
        self.rims[flood].clear();
        std::mem::swap(&mut self.rims[flood], &mut self.next);
    }

    /// Floods the neighbours of a tile's rim cells; true if the other flood is there.
    #[inline]
    fn spread(&mut self, at: usize, cells: u64, ink: Ink) -> bool {
        let stride = self.grid.stride;
        self.next.make_room(7);
        let mut inside = (cells & !EAST) << 1 | (cells & !WEST) >> 1;
        let (mut east, mut west) = ((cells & EAST) >> 7, (cells & WEST) << 7);
        let mut met = false;
        // The columns of the neighbours in the rows above and below.
        let upright = cells | (cells & !EVEN & !EAST) << 1 | (cells & EVEN & !WEST) >> 1;
        let (far_east, far_west) = ((cells & !EVEN & EAST) >> 7, (cells & EVEN & WEST) << 7);
        east |= far_east << 8 | far_east >> 8;
        west |= far_west << 8 | far_west >> 8;
        met |= self.pour(at + stride + 1, far_east >> 56, ink);
        met |= self.pour(at - stride - 1, far_west << 56, ink);
        inside |= upright << 8 | upright >> 8;
        met |= self.pour(at, inside, ink);
        met |= self.pour(at + 1, east, ink);
        met |= self.pour(at - 1, west, ink);
        met |= self.pour(at - stride, upright << 56, ink);
        met |= self.pour(at + stride, upright >> 56, ink);
        met
    }

    /// Floods cells of a tile; true if one of them belongs to the other flood.
    #[inline]
    #[expect(clippy::needless_bitwise_bool, reason = "a lazy operator is a branch that cannot be foreseen")]
    fn pour(&mut self, at: usize, cells: u64, ink: Ink) -> bool {
        if cells == 0 {
            return false;
        }
        let tile = &mut self.tiles[at];
        let cells = cells & tile.free;
        let flooded = tile.flooded();
        let new = cells & !flooded;
        self.touched.put(at, (flooded == 0) & (new != 0));
        self.next.put(at, (tile.next == 0) & (new != 0));
        tile.next |= new;
        tile.low |= new & ink.low;
        tile.high |= new & ink.high;
        tile.second |= new & ink.second;
        cells & flooded & (tile.second ^ ink.second) != 0
    }

    /// The cells of the two floods that touch, one of them among `cells` of a tile.
    fn touching(&self, at: usize, cells: u64, second: u64) -> Option<(Cell, Cell)> {
        let (column, row) = (at % self.grid.stride, at / self.grid.stride);
        for bit in (0..64).filter(|bit| cells >> bit & 1 == 1) {
            let cell = Cell::new(column as i32 * 8 - 8 + bit % 8, row as i32 * 8 - 8 + bit / 8);
            for dir in Lattice::Hex.dirs() {
                let other = Lattice::Hex.neighbour(cell, dir);
                let (tile, bit) = self.grid.locate(other);
                let tile = &self.tiles[tile];
                if (tile.flooded() & (tile.second ^ second)) >> bit & 1 == 1 {
                    return Some(if second == 0 { (cell, other) } else { (other, cell) });
                }
            }
        }
        debug_assert!(false, "the floods do not touch");
        None
    }

    fn reset(&mut self) {
        for tile in self.touched.tiles() {
            let tile = &mut self.tiles[tile];
            *tile = Tile { free: tile.free, ..Tile::default() };
        }
        self.touched.clear();
        self.rims.iter_mut().for_each(List::clear);
        self.next.clear();
        self.met = None;
    }

    /// The cells of a shortest way, after [`run`](Self::run) found one of `steps` steps.
    pub(super) fn path(&self, from: Cell, to: Cell, steps: u32) -> Vec<Cell> {
        let mut path = Vec::with_capacity(steps as usize + 1);
        if let Some((first, second)) = self.met {
            self.back(first, from, &mut path);
            path.reverse();
            self.back(second, to, &mut path);
        }
        path
    }

    /// Goes back from `cell` to the spring of its flood.
    fn back(&self, mut cell: Cell, spring: Cell, path: &mut Vec<Cell>) {
        let (tile, bit) = self.grid.locate(cell);
        let second = self.tiles[tile].second >> bit & 1;
        let label = |cell: Cell| {
            let (tile, bit) = self.grid.locate(cell);
            let tile = &self.tiles[tile];
            let label = tile.low >> bit & 1 | (tile.high >> bit & 1) << 1;
            if tile.second >> bit & 1 == second { label } else { 0 }
        };
        let mut here = label(cell);
        let mut last = None;
        path.push(cell);
        while cell != spring {
            let before = if here == 1 { 3 } else { here - 1 };
            let leads = |&dir: &_| label(Lattice::Hex.neighbour(cell, dir)) == before;
            let Some(dir) = last.filter(leads).or_else(|| Lattice::Hex.dirs().find(leads)) else {
                debug_assert!(false, "the way back is lost");
                return;
            };
            cell = Lattice::Hex.neighbour(cell, dir);
            path.push(cell);
            (here, last) = (before, Some(dir));
        }
    }

    pub(super) fn bytes(&self) -> usize {
        let lists = self.rims[0].bytes() + self.rims[1].bytes() + self.next.bytes() + self.touched.bytes();
        self.tiles.capacity() * size_of::<Tile>() + lists
    }
}
