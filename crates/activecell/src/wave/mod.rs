//! The wave: the flood automaton. From the target on, a free cell that has a reached neighbour is reached at the
//! next time step.

mod compact;
mod flood;
mod floods;
mod live;
mod padded;
mod queue;
mod reach;
mod sweep;
mod terrain;
mod tiles;
mod times;
mod weighted;

pub use compact::CompactField;
pub use floods::{Floods, TileField, TileOrder};
pub use live::LiveField;
pub use terrain::Terrain;
pub(crate) use tiles::{EAST, WEST, each_free};
pub use weighted::WeightedField;

use crate::error::Error;
use crate::lattice::{Cell, Dir, Lattice};
use crate::map::Map;

/// For every cell, the time step at which the wave from the target reached it: its distance.
///
/// ```
/// use activecell::{Cell, Lattice, Map};
/// let map = Map::parse(Lattice::Square, "S#.\n..F\n##.")?;
/// let field = map.wave(Cell::new(2, 1))?;
/// assert_eq!(field.steps(Cell::new(0, 0)), Some(3));
/// assert_eq!(field.steps(Cell::new(1, 0)), None); // an obstacle
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Field {
    lattice: Lattice,
    width: u32,
    height: u32,
    targets: Vec<Cell>,
    steps: Steps,
}

/// Distances, in the form of the method that found them.
#[derive(Debug, Clone)]
enum Steps {
    Tiles(sweep::Tiles),
    Planes(times::Planes),
    Rows(queue::Rows),
}

/// Up to this many runs of free cells, along rows and columns, for each free cell tiles are relaxed to their fixed
/// points; above it the wave's front is followed on bits. Measured: halls, streets, depots and rooms of 64 cells have
/// 0.004 to 0.04 and gain up to fivefold; caves, SLAM maps and rooms of 16 cells have 0.04 to 0.15 and lose up to
/// twofold.
const RAGGED: f64 = 0.04;
/// From here on few cells are reached at a time, and a queue of cells is faster: one-cell mazes have 1.0, where it
/// takes half the time of bits; random obstacles of 40 % have 0.8, where it takes a third more.
const MAZE: f64 = 0.9;

impl Map {
    /// Floods the map from `target`.
    ///
    /// Open floors are flooded in tiles, a thousand million cells a second and more; ragged floors and clutter on
    /// planes of bits, mazes by a queue. The distances are the same.
    ///
    /// # Errors
    /// [`Error::OutsideMap`] or [`Error::TargetOccupied`].
    pub fn wave(&self, target: Cell) -> Result<Field, Error> {
        self.wave_from(&[target])
    }

    /// Floods the map from several targets at once: each cell gets its distance to the nearest of them.
    ///
    /// # Errors
    /// [`Error::OutsideMap`] or [`Error::TargetOccupied`] for the first target that cannot be entered.
    ///
    /// ```
    /// use activecell::{Cell, Lattice, Map};
    /// let map = Map::parse(Lattice::Square, "A....B")?;
    /// let field = map.wave_from(&[map.mark('A').unwrap(), map.mark('B').unwrap()])?;
    /// assert_eq!(field.steps(Cell::new(4, 0)), Some(1));
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn wave_from(&self, targets: &[Cell]) -> Result<Field, Error> {
        for &target in targets {
            self.check_target(target)?;
        }
        let clutter = self.clutter();
        let tiles = if clutter <= RAGGED { sweep::flood(self, targets) } else { None };
        let steps = match tiles {
            Some(tiles) => Steps::Tiles(tiles),
            None if clutter < MAZE => Steps::Planes(times::flood(self, targets)),
            None => Steps::Rows(queue::flood(self, targets)),
        };
        Ok(Field::new(self, targets, steps))
    }

    /// A field for each of many targets, on `threads` threads: the same fields whatever their number.
    ///
    /// # Errors
    /// As [`Map::wave`], for the first target that cannot be entered.
    ///
    /// ```
    /// use activecell::{Cell, Lattice, Map};
    /// let map = Map::parse(Lattice::Hex, "A..\n.#.\n..B")?;
    /// let docks: Vec<Cell> = map.marks().iter().map(|mark| mark.1).collect();
    /// let fields = map.waves(&docks, 2)?;
    /// assert_eq!(fields[0].steps(docks[1]), fields[1].steps(docks[0]));
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn waves(&self, targets: &[Cell], threads: usize) -> Result<Vec<Field>, Error> {
        let share = targets.len().div_ceil(threads.max(1)).max(1);
        std::thread::scope(|scope| {
            let flood = |part: &'_ [Cell]| {
                part.iter().map(|&target| self.wave(target)).collect::<Result<Vec<_>, _>>()
            };
            let parts: Vec<_> = targets.chunks(share).map(|part| scope.spawn(move || flood(part))).collect();
            let mut fields = Vec::with_capacity(targets.len());
            for part in parts {
                fields.extend(part.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))?);
            }
            Ok(fields)
        })
    }

    /// Of the cells that can be reached from `from` the one nearest to `to` on an empty floor, the first in row
    /// order among equals: where to go when there is no way to `to`, or `to` lies in an obstacle.
    ///
    /// # Errors
    /// [`Error::OutsideMap`] for either cell; [`Error::StartOccupied`].
    ///
    /// ```
    /// use activecell::{Cell, Lattice, Map};
    /// let map = Map::parse(Lattice::Square, "...#.\n...#.")?;
    /// assert_eq!(map.nearest_reachable(Cell::new(0, 0), Cell::new(4, 1))?, Cell::new(2, 1));
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn nearest_reachable(&self, from: Cell, to: Cell) -> Result<Cell, Error> {
        self.check_task(from, from)?;
        if !self.contains(to) {
            return Err(Error::OutsideMap { cell: to, width: self.width(), height: self.height() });
        }
        let reached = self.reachable(&[from])?;
        let cells = self.free().filter(|cell| reached.get(cell.x as u32, cell.y as u32));
        Ok(cells.min_by_key(|&cell| self.lattice().distance(cell, to)).unwrap_or(from))
    }

    /// How many runs of free cells, along rows and columns, the map has for each free cell.
    pub(crate) fn clutter(&self) -> f64 {
        let plane = self.obstacles();
        let walls = vec![!0; plane.row(0).len()];
        let (mut ends, mut free) = (0, 0);
        let mut above = walls.as_slice();
        for y in 0..self.height() {
            let row = plane.row(y);
            let mut left = 1;
            for (x, (&word, &above)) in row.iter().zip(above).enumerate() {
                let inside = (self.width() as usize - 64 * x).min(64);
                let cells = !word & (!0 >> (64 - inside));
                free += cells.count_ones();
                ends += (cells & (word << 1 | left)).count_ones() + (cells & above).count_ones();
                left = word >> 63;
            }
            above = row;
        }
        f64::from(ends) / f64::from(free.max(1))
    }

    /// How many cells each part of the floor has that no way connects to another, largest first.
    ///
    /// ```
    /// use activecell::{Lattice, Map};
    /// assert_eq!(Map::parse(Lattice::Square, "..#\n.#.")?.regions(), [3, 1]);
    /// assert_eq!(Map::parse(Lattice::Hex, "..#\n.#.")?.regions(), [3, 1]);
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn regions(&self) -> Vec<usize> {
        let mut sizes: Vec<usize> = self.parts().map(|part| part.len()).collect();
        sizes.sort_unstable_by(|a, b| b.cmp(a));
        sizes
    }

    /// The cells of the largest of the [`regions`](Self::regions), row by row; of equally large ones, of the first.
    ///
    /// ```
    /// use activecell::{Cell, Lattice, Map};
    /// let map = Map::parse(Lattice::Square, "..#\n.#.")?;
    /// assert_eq!(map.largest_region(), [Cell::new(0, 0), Cell::new(1, 0), Cell::new(0, 1)]);
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn largest_region(&self) -> Vec<Cell> {
        let mut largest = Vec::new();
        for part in self.parts() {
            if part.len() > largest.len() {
                largest = part;
            }
        }
        largest.sort_unstable_by_key(|cell| (cell.y, cell.x));
        largest
    }

    /// The cells of each part of the floor.
    fn parts(&self) -> impl Iterator<Item = Vec<Cell>> + '_ {
        let mut seen = vec![false; self.cells()];
        self.free().filter_map(move |origin| {
            let mut new =
                |cell| self.index(cell).is_some_and(|index| !std::mem::replace(&mut seen[index], true));
            let mut part = Vec::new();
            let mut rim = vec![origin];
            while let Some(cell) = rim.pop() {
                if self.is_free(cell) && new(cell) {
                    part.push(cell);
                    rim.extend(self.lattice().dirs().map(|dir| self.lattice().neighbour(cell, dir)));
                }
            }
            (!part.is_empty()).then_some(part)
        })
    }
}

impl Field {
    fn new(map: &Map, targets: &[Cell], steps: Steps) -> Self {
        let (width, height) = (map.width(), map.height());
        Self { lattice: map.lattice(), width, height, targets: targets.to_vec(), steps }
    }

    /// The lattice.
    pub const fn lattice(&self) -> Lattice {
        self.lattice
    }

    /// Where the wave started.
    pub fn targets(&self) -> &[Cell] {
        &self.targets
    }

    /// The steps from `cell` to the target; `None` where the wave did not come.
    #[inline]
    pub fn steps(&self, cell: Cell) -> Option<u32> {
        let (x, y) = (cell.x as u32, cell.y as u32);
        if x >= self.width || y >= self.height {
            return None;
        }
        match &self.steps {
            Steps::Tiles(tiles) => tiles.steps(x, y),
            Steps::Planes(planes) => planes.steps(x, y),
            Steps::Rows(rows) => rows.steps(x, y),
        }
    }

    /// Columns and rows of the map.
    pub(crate) const fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// The directions that lead one step nearer to the target; none at a target and where the wave did not
    /// come.
    pub fn nearer(&self, cell: Cell) -> impl Iterator<Item = Dir> + '_ {
        let wanted = self.steps(cell).and_then(|steps| steps.checked_sub(1));
        self.lattice
            .dirs()
            .filter(move |&dir| wanted.is_some() && self.steps(self.lattice.neighbour(cell, dir)) == wanted)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Rng;

    /// All methods on one map, whatever the choice would be. The queue is the plain one, to which the others are
    /// compared.
    fn compare(map: &Map, targets: &[Cell]) {
        let rows = queue::flood(map, targets);
        let planes = times::flood(map, targets);
        let tiles = sweep::flood(map, targets);
        for y in 0..map.height() {
            for x in 0..map.width() {
                let steps = rows.steps(x, y);
                assert_eq!(planes.steps(x, y), steps, "planes: ({x},{y}) of {}", map.to_text());
                if let Some(tiles) = &tiles {
                    assert_eq!(tiles.steps(x, y), steps, "tiles: ({x},{y}) of {}", map.to_text());
                }
            }
        }
    }

    /// Some free cells, or none if the map has none.
    fn some_free(map: &Map, count: u64, rng: &mut Rng) -> Vec<Cell> {
        let free: Vec<Cell> = map.free().collect();
        let count = if free.is_empty() { 0 } else { count };
        (0..count).map(|_| free[rng.below(free.len() as u32) as usize]).collect()
    }

    #[test]
    fn all_methods_agree_on_maps_of_every_shape() {
        let sides = [1, 2, 5, 7, 8, 15, 16, 17, 31, 32, 33, 47, 63, 64, 65, 100, 129];
        let densities = [0.0, 0.03, 0.1, 0.2, 0.35, 0.5];
        let mut rng = Rng::new(11);
        let mut compared = 0;
        for seed in 0..4000 {
            let mut side = || sides[rng.below(sides.len() as u32) as usize];
            let (width, height) = (side(), side());
            let lattice = Lattice::ALL[seed as usize % 2];
            let map = Map::random(lattice, width, height, densities[seed as usize / 2 % 6], seed).unwrap();
            let targets = some_free(&map, 1 + seed % 3, &mut rng);
            if !targets.is_empty() {
                compare(&map, &targets);
                compared += 1;
            }
        }
        println!("{compared} maps: tiles, planes and queue agree");
        assert!(compared > 3500);
    }

    /// In a maze the wave comes back to a tile many times, long after it came first.
    #[test]
    fn all_methods_agree_in_mazes() {
        let mut rng = Rng::new(5);
        for seed in 0..400 {
            let (width, height) = (1 + rng.below(70), 1 + rng.below(70));
            let mut walls = crate::map::BitPlane::new(width.into(), height.into()).unwrap();
            for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
                walls.set(x, y, (x % 2 == 1 || y % 2 == 1) && (x % 2 == y % 2 || rng.chance(0.47)));
            }
            let map = Map::new(Lattice::ALL[seed % 2], walls);
            compare(&map, &some_free(&map, 1 + seed as u64 % 2, &mut rng));
        }
    }

    /// A snake of corridors that are one cell wide, as far from wall to wall.
    fn snake(lattice: Lattice, width: u32, height: u32) -> Map {
        let mut walls = crate::map::BitPlane::new(width.into(), height.into()).unwrap();
        for y in (1..height).step_by(2) {
            for x in 0..width - 1 {
                walls.set(if y % 4 == 1 { x } else { x + 1 }, y, true);
            }
        }
        Map::new(lattice, walls)
    }

    #[test]
    fn all_methods_agree_where_the_wave_stays_long_in_a_tile() {
        for lattice in Lattice::ALL {
            for (width, height) in [(15, 15), (16, 16), (17, 33), (64, 64), (100, 9), (8, 200)] {
                let map = snake(lattice, width, height);
                compare(&map, &[Cell::new(0, 0)]);
                compare(&map, &[Cell::new(width as i32 / 2, height as i32 / 4 * 2)]);
                compare(&map, &[Cell::new(0, 0), Cell::new(0, 0), Cell::new(1, 0)]);
            }
        }
    }

    /// Distances that do not fit into 16 bits.
    #[test]
    fn distances_above_sixteen_bits_are_kept() {
        for lattice in Lattice::ALL {
            let map = snake(lattice, 400, 400);
            assert!(sweep::flood(&map, &[Cell::new(0, 0)]).is_none());
            compare(&map, &[Cell::new(0, 0)]);
            let field = map.wave(Cell::new(0, 0)).unwrap();
            let farthest = map.free().filter_map(|cell| field.steps(cell)).max().unwrap();
            assert!(farthest > 79_000, "{lattice} {farthest}");
        }
    }
}
