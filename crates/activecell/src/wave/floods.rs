//! Many floods of one map in the same memory, and their fields tile by tile: a bit or two a cell.

use super::compact::{Second, Third, check_targets};
use super::flood::{Bits, FIRST, Record, SIDE, Tiles};
use crate::error::Error;
use crate::lattice::{Cell, Lattice};
use crate::map::Map;
use std::cmp::Ordering;

/// The words of a tile in one plane.
const WORDS: usize = SIDE * SIDE / 64;

/// Numbers for the cells of a map, tile by tile of 16 × 16 cells: a cell and its neighbours lie in the same 32 bytes of
/// a plane of bits, or nearly always. The last tiles of a row and of a column may reach over the map's border.
///
/// ```
/// use activecell::{Cell, Lattice, Map, TileOrder};
/// let order = TileOrder::new(&Map::random(Lattice::Square, 40, 20, 0.0, 1)?);
/// assert_eq!(order.numbers(), 3 * 2 * 256);
/// assert_eq!(order.number(Cell::new(17, 1)), 256 + 16 + 1);
/// assert_eq!(order.cell(256 + 16 + 1), Cell::new(17, 1));
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TileOrder {
    lattice: Lattice,
    /// Tiles in a row.
    across: u32,
    /// Tiles in a column.
    down: u32,
}

impl TileOrder {
    /// The order of this map's cells.
    pub fn new(map: &Map) -> Self {
        let side = SIDE as u32;
        Self { lattice: map.lattice(), across: map.width().div_ceil(side), down: map.height().div_ceil(side) }
    }

    /// How many numbers there are: 256 a tile.
    pub const fn numbers(&self) -> usize {
        self.across as usize * self.down as usize * SIDE * SIDE
    }

    /// The number of a cell of the map; without meaning for other cells.
    #[inline]
    pub const fn number(&self, cell: Cell) -> u32 {
        let (x, y) = (cell.x as u32, cell.y as u32);
        (y / 16 * self.across + x / 16) * 256 + y % 16 * 16 + x % 16
    }

    /// The cell of a number.
    #[inline]
    pub const fn cell(&self, number: u32) -> Cell {
        let (tile, inside) = (number / 256, number % 256);
        let (x, y) = (tile % self.across * 16 + inside % 16, tile / self.across * 16 + inside / 16);
        Cell::new(x as i32, y as i32)
    }

    /// How many words a field takes: a bit a cell on squares, two on hexagons.
    pub const fn field_words(&self) -> usize {
        let planes = match self.lattice {
            Lattice::Square => 1,
            Lattice::Hex => 2,
        };
        self.numbers() / 64 * planes
    }

    /// The field whose words [`Floods::flood`] filled.
    #[inline]
    pub const fn field<'a>(&self, words: &'a [u64]) -> TileField<'a> {
        TileField { words, hex: matches!(self.lattice, Lattice::Hex) }
    }
}

/// Which of two touching cells is nearer to a target, from one bit a cell on squares and two on hexagons.
///
/// On squares the steps of touching cells differ by exactly one, and whether they are even follows from the cell's
/// place; so bit 1 of the step is enough. The steps are counted from 1 if the target's x + y is odd, so that they
/// have the parity of x + y for every target. On hexagons the step modulo 3 tells.
///
/// Source: S. B. Akers, *A Modification of Lee's Path Connection Algorithm*, IEEE Trans. Electronic Computers, 1967.
#[derive(Debug, Clone, Copy)]
pub struct TileField<'a> {
    words: &'a [u64],
    hex: bool,
}

impl TileField<'_> {
    /// How the steps of cell `to` compare with those of cell `from`, which touches it: `Less` is nearer. The cells
    /// are given by their numbers in the [`TileOrder`]. Both must be free and connected to the target, else
    /// the answer has no meaning.
    ///
    /// # Panics
    /// If a number is too large for the field.
    #[inline]
    pub fn compare(&self, from: u32, to: u32) -> Ordering {
        if self.hex {
            // Modulo 3: one less is two more.
            match (self.third(to) + 3 - self.third(from)) % 3 {
                0 => Ordering::Equal,
                1 => Ordering::Greater,
                _ => Ordering::Less,
            }
        } else if (self.second(from) ^ self.second(to) ^ u64::from(from ^ from >> 4)) & 1 == 1 {
            // From an odd step the one below has the same second bit, from an even one the other.
            Ordering::Less
        } else {
            Ordering::Greater
        }
    }

    /// Of the cells that `from` touches, given by their numbers, those that are nearer to the target, as far, and
    /// farther: bit k is cell k of `links`. The same as [`compare`](Self::compare) for each, in one go.
    ///
    /// # Panics
    /// As [`compare`](Self::compare).
    #[inline]
    pub fn split(&self, from: u32, links: &[u32]) -> [u32; 3] {
        let [mut nearer, mut level] = [0, 0];
        if self.hex {
            let here = self.third(from);
            for (k, &to) in links.iter().enumerate() {
                // There: 0 to 2; from 3 here on: one more is 4 or 1, one less is 2 or 5.
                let rise = self.third(to) + 3 - here;
                nearer |= u32::from(rise == 2 || rise == 5) << k;
                level |= u32::from(rise == 3) << k;
            }
        } else {
            let here = self.second(from) ^ u64::from(from ^ from >> 4);
            for (k, &to) in links.iter().enumerate() {
                nearer |= ((self.second(to) ^ here) as u32 & 1) << k;
            }
        }
        let all = !(u32::MAX << links.len());
        [nearer, level, all & !nearer & !level]
    }

    #[inline]
    const fn second(&self, number: u32) -> u64 {
        self.words[(number >> 6) as usize] >> (number & 63)
    }

    #[inline]
    const fn third(&self, number: u32) -> u32 {
        let word = (number >> 6) as usize * 2;
        let (low, high) = (self.words[word] >> (number & 63) & 1, self.words[word + 1] >> (number & 63) & 1);
        (low | high << 1) as u32
    }
}

/// Floods one map again and again without allocating: fields for thousands of targets.
///
/// ```
/// use activecell::{Cell, Floods, Lattice, Map, TileOrder};
/// use std::cmp::Ordering;
/// let map = Map::parse(Lattice::Square, "S#.\n..F\n##.")?;
/// let (order, mut floods) = (TileOrder::new(&map), Floods::new(&map));
/// let mut words = vec![0; order.field_words()];
/// floods.flood(Cell::new(2, 1), &mut words)?;
/// let (start, below) = (order.number(Cell::new(0, 0)), order.number(Cell::new(0, 1)));
/// assert_eq!(order.field(&words).compare(start, below), Ordering::Less);
/// # Ok::<(), activecell::Error>(())
/// ```
pub struct Floods<'a> {
    map: &'a Map,
    kind: Kind<'a>,
    free: Vec<Bits>,
}

enum Kind<'a> {
    Square(Tiles<'a, Second>),
    Hex(Tiles<'a, Third>),
}

impl<'a> Floods<'a> {
    /// Prepares a map.
    pub fn new(map: &'a Map) -> Self {
        match map.lattice() {
            Lattice::Square => {
                let mut tiles = Tiles::new(map);
                Self { map, free: tiles.learn_all(), kind: Kind::Square(tiles) }
            }
            Lattice::Hex => {
                let mut tiles = Tiles::new(map);
                Self { map, free: tiles.learn_all(), kind: Kind::Hex(tiles) }
            }
        }
    }

    /// Floods the map from `target` and writes the field; what `words` held before is lost.
    ///
    /// # Errors
    /// [`Error::OutsideMap`] or [`Error::TargetOccupied`].
    ///
    /// # Panics
    /// If `words` are not [`TileOrder::field_words`].
    pub fn flood(&mut self, target: Cell, words: &mut [u64]) -> Result<(), Error> {
        check_targets(self.map, &[target])?;
        let order = TileOrder::new(self.map);
        assert_eq!(words.len(), order.field_words(), "the words of a field");
        match &mut self.kind {
            Kind::Square(tiles) => {
                let parity = (target.x ^ target.y) as u32 & 1;
                tiles.refill(&self.free);
                tiles.flood_from(&[target], FIRST + parity);
                for (record, words) in inner(tiles, order).zip(words.as_chunks_mut::<WORDS>().0) {
                    *words = record.0.0;
                }
            }
            Kind::Hex(tiles) => {
                tiles.refill(&self.free);
                tiles.flood_from(&[target], FIRST);
                for (record, words) in inner(tiles, order).zip(words.as_chunks_mut::<{ 2 * WORDS }>().0) {
                    *words = std::array::from_fn(|i| {
                        if i % 2 == 0 { record.low.0[i / 2] } else { record.high.0[i / 2] }
                    });
                }
            }
        }
        Ok(())
    }
}

/// The records of the map's tiles without the rim.
fn inner<'a, R: Record>(tiles: &'a Tiles<'_, R>, order: TileOrder) -> impl Iterator<Item = &'a R> {
    let across = tiles.across();
    (1..=order.down as usize).flat_map(move |row| &tiles.records[row * across + 1..][..order.across as usize])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Rng;

    /// One `Floods` for several targets a map, against the plain wave.
    #[test]
    fn every_pair_of_neighbours_compares_as_the_wave_says() {
        let mut rng = Rng::new(3);
        let mut pairs = 0;
        for seed in 0..600 {
            let lattice = Lattice::ALL[seed as usize % 2];
            let (width, height) = (1 + rng.below(70), 1 + rng.below(50));
            let map = Map::random(lattice, width, height, f64::from(rng.below(5)) * 0.1, seed).unwrap();
            let free: Vec<Cell> = map.free().collect();
            let (order, mut floods) = (TileOrder::new(&map), Floods::new(&map));
            let mut words = vec![!0; order.field_words()];
            for _ in 0..if free.is_empty() { 0 } else { 3 } {
                let target = free[rng.below(free.len() as u32) as usize];
                floods.flood(target, &mut words).unwrap();
                let (plain, field) = (map.wave(target).unwrap(), order.field(&words));
                for &cell in &free {
                    assert_eq!(order.cell(order.number(cell)), cell);
                    let Some(steps) = plain.steps(cell) else { continue };
                    let links: Vec<u32> = lattice
                        .dirs()
                        .map(|dir| lattice.neighbour(cell, dir))
                        .filter(|&next| plain.steps(next).is_some())
                        .map(|next| order.number(next))
                        .collect();
                    let split = field.split(order.number(cell), &links);
                    for next in lattice.dirs().map(|dir| lattice.neighbour(cell, dir)) {
                        let Some(there) = plain.steps(next) else { continue };
                        let compared = field.compare(order.number(cell), order.number(next));
                        assert_eq!(compared, there.cmp(&steps), "{lattice} {seed} {cell} {next}");
                        let k = links.iter().position(|&link| link == order.number(next)).unwrap();
                        let bits = [Ordering::Less, Ordering::Equal, Ordering::Greater];
                        let expected = bits.map(|class| u32::from(class == compared));
                        assert_eq!(split.map(|class| class >> k & 1), expected);
                        pairs += 1;
                    }
                }
            }
        }
        println!("{pairs} pairs of neighbours agree");
        assert!(pairs > 100_000);
    }
}
