//! Compact fields: of each cell's distance only the one or two bits that tell which neighbours are nearer.

use super::flood::{Bits, FIRST, Record, Tiles};
use crate::error::Error;
use crate::lattice::{Cell, Dir, Lattice};
use crate::map::Map;

/// Which neighbours lie one step nearer to the nearest of some targets, in two bits a cell or less.
///
/// Steps of touching cells differ by at most one, so the step modulo 3 tells nearer from farther: two bits, whose
/// fourth value stands for cells that the wave did not reach. On squares the parity of the step follows from the
/// cell's place, if all targets have the same parity; then one more bit, the step's second, tells it modulo 4, and
/// a second plane says which cells were reached. Where these are all free cells, the map's own plane is shared.
///
/// Source: S. B. Akers, *A Modification of Lee's Path Connection Algorithm*, IEEE Trans. Electronic Computers, 1967.
///
/// ```
/// use activecell::{Cell, Dir, Lattice, Map};
/// let map = Map::parse(Lattice::Square, "S#.\n..F\n##.")?;
/// let field = map.compact_wave(&[Cell::new(2, 1)])?;
/// assert_eq!(field.next(Cell::new(0, 0)), Some(Dir::S));
/// assert!(!field.is_reached(Cell::new(1, 0))); // an obstacle
/// assert_eq!(field.bytes(), 8); // the reached cells are the map's free cells
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct CompactField {
    lattice: Lattice,
    width: u32,
    height: u32,
    labels: Labels,
}

#[derive(Debug, Clone, PartialEq)]
enum Labels {
    /// The steps modulo 4, on squares.
    Half {
        /// The parity of the targets' x + y.
        parity: u32,
        reached: Reached,
        /// Bit 1 of the step.
        second: Dense,
    },
    /// The steps modulo 3; both bits are 1 where the wave did not come.
    Thirds { low: Dense, high: Dense },
}

#[derive(Debug, Clone, PartialEq)]
enum Reached {
    /// All free cells of this map, whose obstacles are shared.
    Free(Map),
    Only(Dense),
}

impl Map {
    /// Floods the map from all `targets` at once, and keeps of each cell only which neighbours are nearer to the
    /// nearest target. Ten times smaller than [`Map::wave`], and faster.
    ///
    /// # Errors
    /// [`Error::BadValue`] without a target; [`Error::OutsideMap`] or [`Error::TargetOccupied`].
    ///
    /// ```
    /// use activecell::{Cell, Dir, Lattice, Map};
    /// let map = Map::parse(Lattice::Hex, "A....B")?;
    /// let field = map.compact_wave(&[Cell::new(0, 0), Cell::new(5, 0)])?;
    /// assert_eq!(field.next(Cell::new(2, 0)), map.lattice().dir_named("W"));
    /// assert_eq!(field.next(Cell::new(3, 0)), map.lattice().dir_named("E"));
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn compact_wave(&self, targets: &[Cell]) -> Result<CompactField, Error> {
        check_targets(self, targets)?;
        let parity = |cell: Cell| (cell.x ^ cell.y) as u32 & 1;
        let first = parity(targets[0]);
        let half = self.lattice() == Lattice::Square && targets.iter().all(|&cell| parity(cell) == first);
        let labels = if half {
            let mut tiles = Tiles::<Reaching<Second>>::new(self);
            tiles.flood(targets);
            Labels::Half {
                parity: first,
                reached: reached(self, &tiles),
                second: label(self, &tiles, |record| record.labels.0),
            }
        } else {
            let mut tiles = Tiles::<Reaching<Third>>::new(self);
            tiles.flood(targets);
            Labels::Thirds {
                low: label(self, &tiles, |record| {
                    Bits(std::array::from_fn(|i| !record.reached.0[i] | record.labels.low.0[i]))
                }),
                high: label(self, &tiles, |record| {
                    Bits(std::array::from_fn(|i| !record.reached.0[i] | record.labels.high.0[i]))
                }),
            }
        };
        Ok(CompactField { lattice: self.lattice(), width: self.width(), height: self.height(), labels })
    }
}

/// Checks that there is a target, and that a robot can stand at each.
pub(super) fn check_targets(map: &Map, targets: &[Cell]) -> Result<(), Error> {
    if targets.is_empty() {
        return Err(Error::BadValue { name: "the number of targets", value: 0.0, allowed: "at least 1" });
    }
    for &target in targets {
        map.check_target(target)?;
    }
    Ok(())
}

/// Bit 1 of each cell's step.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Second(pub(super) Bits);

impl Record for Second {
    #[inline]
    fn put(&mut self, time: u32, front: &Bits) {
        self.0.add(front, (time - FIRST) >> 1);
    }
}

/// Each cell's step modulo 3.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Third {
    pub(super) low: Bits,
    pub(super) high: Bits,
}

impl Record for Third {
    #[inline]
    fn put(&mut self, time: u32, front: &Bits) {
        let step = (time - FIRST) % 3;
        self.low.add(front, step);
        self.high.add(front, step >> 1);
    }
}

/// Labels, and which cells have one.
#[derive(Debug, Clone, Copy, Default)]
struct Reaching<L> {
    /// There was a front.
    seen: bool,
    reached: Bits,
    labels: L,
}

impl<L: Record> Record for Reaching<L> {
    #[inline]
    fn is_full(&self, _: u32) -> bool {
        !self.seen
    }
    fn renew(&mut self, _: u32, _: &mut Vec<Self>) -> bool {
        self.seen = true;
        true
    }
    #[inline]
    fn put(&mut self, time: u32, front: &Bits) {
        self.reached.add(front, 1);
        self.labels.put(time, front);
    }
}

fn label<R: Record>(map: &Map, tiles: &Tiles<R>, plane: impl Fn(&R) -> Bits) -> Dense {
    let mut dense = Dense::new(map);
    tiles.rows(plane, |y, row| dense.or_row(y, row));
    dense
}

fn reached(map: &Map, tiles: &Tiles<Reaching<Second>>) -> Reached {
    let dense = label(map, tiles, |record| record.reached);
    let count: usize = dense.words.iter().map(|word| word.count_ones() as usize).sum();
    if count == map.free_cells() { Reached::Free(map.clone()) } else { Reached::Only(dense) }
}

impl CompactField {
    /// The lattice.
    pub const fn lattice(&self) -> Lattice {
        self.lattice
    }

    /// The step at which the wave came, modulo 4 or 3.
    #[inline]
    fn step(&self, cell: Cell) -> Option<u8> {
        let (x, y) = (cell.x as u32, cell.y as u32);
        if x >= self.width || y >= self.height {
            return None;
        }
        let index = y as usize * self.width as usize + x as usize;
        match &self.labels {
            Labels::Half { parity, reached, second } => {
                let reached = match reached {
                    Reached::Free(map) => !map.obstacles().get(x, y),
                    Reached::Only(dense) => dense.get(index) == 1,
                };
                reached.then(|| ((x ^ y ^ parity) & 1) as u8 | second.get(index) << 1)
            }
            Labels::Thirds { low, high } => {
                let step = low.get(index) | high.get(index) << 1;
                (step != 3).then_some(step)
            }
        }
    }

    /// Whether a way leads from the cell to a target; false outside the map.
    pub fn is_reached(&self, cell: Cell) -> bool {
        self.step(cell).is_some()
    }

    /// The directions that lead one step nearer to the nearest target; none at a target and where the wave did
    /// not come.
    pub fn nearer(&self, cell: Cell) -> impl Iterator<Item = Dir> + '_ {
        let modulus = if matches!(self.labels, Labels::Half { .. }) { 4 } else { 3 };
        let wanted = self.step(cell).map(|step| (step + modulus - 1) % modulus);
        self.lattice
            .dirs()
            .filter(move |&dir| wanted.is_some() && self.step(self.lattice.neighbour(cell, dir)) == wanted)
    }

    /// The first of [`nearer`](Self::nearer), clockwise from the top.
    pub fn next(&self, cell: Cell) -> Option<Dir> {
        self.nearer(cell).next()
    }

    /// The memory that the field takes, in bytes, without the map that it may share.
    pub fn bytes(&self) -> usize {
        let words = match &self.labels {
            Labels::Half { reached: Reached::Free(_), second, .. } => second.words.len(),
            Labels::Half { reached: Reached::Only(own), second, .. } => own.words.len() + second.words.len(),
            Labels::Thirds { low, high } => low.words.len() + high.words.len(),
        };
        words * size_of::<u64>()
    }
}

/// A bit a cell in row order, without gaps between the rows.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Dense {
    width: usize,
    words: Vec<u64>,
}

impl Dense {
    fn new(map: &Map) -> Self {
        Self { width: map.width() as usize, words: vec![0; map.cells().div_ceil(64)] }
    }

    #[inline]
    fn get(&self, index: usize) -> u8 {
        (self.words[index / 64] >> (index % 64) & 1) as u8
    }

    /// Adds a row whose bits behind the last column are 0.
    fn or_row(&mut self, y: usize, row: &[u64]) {
        let (word, shift) = (y * self.width / 64, y * self.width % 64);
        for (i, &bits) in row.iter().enumerate() {
            if bits != 0 {
                self.words[word + i] |= bits << shift;
            }
            if shift != 0 && bits >> (64 - shift) != 0 {
                self.words[word + i + 1] |= bits >> (64 - shift);
            }
        }
    }
}
