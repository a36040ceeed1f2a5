//! From any cell to any other: the table of first moves.

use super::file::{EmbeddedHeader, MOVES, Numbers, Parsed, Sections, bad, check_plane, parse};
use crate::error::Error;
use crate::lattice::{Cell, Dir};

/// The low bits of a run hold its direction, the others the number of its first cell.
const DIR_BITS: u32 = 3;
/// The direction of cells to which no way leads.
pub(super) const NO_WAY: u32 = 7;

/// A run: from target number `first` on the move is `dir`.
pub(super) const fn run(first: u32, dir: u32) -> u32 {
    first << DIR_BITS | dir
}

/// The first move of a shortest way from every free cell to every other, compressed.
///
/// The free cells are numbered by depth-first search, so that those behind the same door follow one another. The
/// table has a row for each source, and in it a run for each stretch of targets to which one first move is right.
/// Several moves may be; a run keeps any that is right for all its targets, and is as long as it can be.
///
/// Source: A. Botea, *Ultra-Fast Optimal Pathfinding without Runtime Search*, AIIDE 2011; Strasser, Harabor,
/// Botea, *Compressing Optimal Paths with Run Length Encoding*, JAIR 54, 2015.
///
/// ```
/// use activecell::{Cell, Lattice, Map, MoveTable};
/// let map = Map::parse(Lattice::Hex, "A#.\n..B")?;
/// let file = map.move_table(1000, 1, &|| ())?;
/// let table = MoveTable::from_bytes(&file)?; // the file may be memory-mapped: nothing is copied
/// assert!(table.header().is_of(&map));
/// let (from, to) = (map.mark('A').unwrap(), map.mark('B').unwrap());
/// assert_eq!(table.next(from, to), map.lattice().dir_named("SE"));
/// assert_eq!(table.path(from, to).unwrap().len(), 4);
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct MoveTable<'a> {
    header: EmbeddedHeader,
    runs_count: u64,
    /// A bit a cell: free.
    free: Numbers<'a>,
    /// For each word of them, how many free cells are before.
    ranks: Numbers<'a>,
    /// The depth-first number of each free cell in row order.
    numbers: Numbers<'a>,
    /// Where the row of each number begins, and where the last ends.
    rows: Numbers<'a>,
    runs: Numbers<'a>,
    bytes: usize,
}

impl<'a> MoveTable<'a> {
    /// Checks the bytes of a file once, so that every look-up in it is safe. Nothing is copied.
    ///
    /// # Errors
    /// [`Error::BadEmbedded`] with the place and what is wrong there.
    pub fn from_bytes(bytes: &'a [u8]) -> Result<Self, Error> {
        let Parsed { kind, header, count, planes } = parse(bytes)?;
        if kind != MOVES || planes != 0 {
            return bad(10, "the file holds no move table");
        }
        let (words, free_cells) = (header.cells().div_ceil(64), u64::from(header.free_cells));
        let mut sections = Sections::new(bytes);
        let mut starts = [0; 5];
        let mut section = |which: usize, count, size| {
            starts[which] = sections.at();
            sections.next(count, size)
        };
        let view = Self {
            header,
            runs_count: count,
            free: section(0, words, 8)?,
            ranks: section(1, words, 4)?,
            numbers: section(2, free_cells, 4)?,
            rows: section(3, free_cells + 1, 4)?,
            runs: section(4, count, 4)?,
            bytes: bytes.len(),
        };
        sections.finish()?;
        view.check_cells(&starts)?;
        view.check_rows(&starts)?;
        Ok(view)
    }

    fn check_cells(&self, starts: &[u64; 5]) -> Result<(), Error> {
        if check_plane(&self.free, 0, self.header.cells(), starts[0])? != u64::from(self.header.free_cells) {
            return bad(starts[0], "the plane of free cells has not as many as the header says");
        }
        let mut before = 0;
        for word in 0..self.header.cells().div_ceil(64) as usize {
            if self.ranks.u32(word) != before {
                return bad(starts[1] + 4 * word as u64, "a count of free cells is wrong");
            }
            before += self.free.u64(word).count_ones();
        }
        match (0..self.header.free_cells as usize).find(|&i| self.numbers.u32(i) >= self.header.free_cells) {
            Some(i) => bad(starts[2] + 4 * i as u64, "a cell's number is above the number of free cells"),
            None => Ok(()),
        }
    }

    fn check_rows(&self, starts: &[u64; 5]) -> Result<(), Error> {
        let free = self.header.free_cells as usize;
        if self.rows.u32(0) != 0 || u64::from(self.rows.u32(free)) != self.runs_count {
            return bad(starts[3], "the rows do not begin and end with the runs");
        }
        for row in 0..free {
            let (begin, end) = (self.rows.u32(row), self.rows.u32(row + 1));
            // A row that ends too late is followed by one that begins too late, and the last was checked.
            if begin >= end || u64::from(end) > self.runs_count {
                return bad(starts[3] + 4 * row as u64, "a row has no run, or ends behind the runs");
            }
            let mut least = 0;
            for place in begin..end {
                let run = self.runs.u32(place as usize);
                let (first, dir) = (run >> DIR_BITS, run & ((1 << DIR_BITS) - 1));
                let is_first = place == begin;
                if first < least || is_first && first != 0 || first as usize >= free {
                    return bad(starts[4] + 4 * u64::from(place), "the runs of a row are not in order");
                }
                if dir >= self.header.lattice.degree().into() && dir != NO_WAY {
                    return bad(starts[4] + 4 * u64::from(place), "a run has no direction of its lattice");
                }
                least = first + 1;
            }
        }
        Ok(())
    }

    /// What the file says of its map.
    pub const fn header(&self) -> &EmbeddedHeader {
        &self.header
    }

    /// How many runs the table has.
    pub const fn runs(&self) -> u64 {
        self.runs_count
    }

    /// The bytes of the file, which are all the memory it needs.
    pub const fn bytes(&self) -> usize {
        self.bytes
    }

    /// The depth-first number of a free cell.
    #[inline]
    fn number(&self, cell: Cell) -> Option<u32> {
        let index = self.header.index(cell)?;
        let word = self.free.u64(index / 64);
        let bit = 1u64 << (index % 64);
        if word & bit == 0 {
            return None;
        }
        let rank = self.ranks.u32(index / 64) + (word & (bit - 1)).count_ones();
        Some(self.numbers.u32(rank as usize))
    }

    /// The first step of a shortest way; `None` if there is no way, if the cells are the same, and if one of them
    /// is not free.
    #[inline]
    pub fn next(&self, from: Cell, to: Cell) -> Option<Dir> {
        let (from, to) = (self.number(from)?, self.number(to)?);
        self.first_move(from, to)
    }

    #[inline]
    fn first_move(&self, from: u32, to: u32) -> Option<Dir> {
        if from == to {
            return None;
        }
        let mut begin = self.rows.u32(from as usize) as usize;
        let mut length = self.rows.u32(from as usize + 1) as usize - begin;
        // The last run that begins at the target or before: the first begins at 0.
        while length > 1 {
            let half = length / 2;
            let is_before = self.runs.u32(begin + half) >> DIR_BITS <= to;
            begin = if is_before { begin + half } else { begin };
            length -= half;
        }
        let dir = self.runs.u32(begin) & ((1 << DIR_BITS) - 1);
        (dir != NO_WAY).then_some(Dir(dir as u8))
    }

    /// The cells of a shortest way, both ends included; `None` where there is none or a cell is not free.
    pub fn path(&self, from: Cell, to: Cell) -> Option<Vec<Cell>> {
        self.number(from)?;
        let target = self.number(to)?;
        follow(&self.header, from, to, |cell| self.first_move(self.number(cell)?, target))
    }
}

/// Follows the moves from `from` to `to`. A file that lies may lead in circles or against a wall: then `None`.
pub(super) fn follow(
    header: &EmbeddedHeader,
    from: Cell,
    to: Cell,
    next: impl Fn(Cell) -> Option<Dir>,
) -> Option<Vec<Cell>> {
    let mut cells = vec![from];
    let mut cell = from;
    while cell != to {
        if cells.len() > header.free_cells as usize {
            return None;
        }
        cell = header.lattice.neighbour(cell, next(cell)?);
        cells.push(cell);
    }
    Some(cells)
}
