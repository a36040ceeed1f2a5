//! For a few targets: a plane of directions each.

use super::file::{DIRECTIONS, EmbeddedHeader, Numbers, Parsed, Sections, Writer, bad, check_plane, parse};
use crate::error::Error;
use crate::lattice::{Cell, Dir, Lattice};
use crate::map::Map;

/// On hexagons, the direction of cells from which no way leads to the target.
const NO_WAY: u8 = 7;

/// For each of a few targets the next direction from every cell: 2 bits a cell on squares, 3 on hexagons.
///
/// Squares need all four values; which cells have a way to the target stands in one more plane, which targets that
/// are reached from the same cells share. On hexagons one of the two values left over says that there is none.
///
/// ```
/// use activecell::{Cell, Dir, DirectionPlanes, Lattice, Map};
/// let map = Map::parse(Lattice::Square, "A.#\n..B")?;
/// let file = map.direction_planes(&[map.mark('A').unwrap(), map.mark('B').unwrap()])?;
/// let planes = DirectionPlanes::from_bytes(&file)?;
/// assert_eq!(planes.target(1), Some(Cell::new(2, 1)));
/// assert_eq!(planes.next(1, Cell::new(1, 0)), Some(Dir::S));
/// assert_eq!(planes.next(1, Cell::new(2, 1)), None); // there
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct DirectionPlanes<'a> {
    header: EmbeddedHeader,
    count: usize,
    targets: Numbers<'a>,
    reached: Numbers<'a>,
    directions: Numbers<'a>,
    bytes: usize,
}

const fn bits(lattice: Lattice) -> usize {
    match lattice {
        Lattice::Square => 2,
        Lattice::Hex => 3,
    }
}

impl Map {
    /// The file of the direction planes of these targets, for [`DirectionPlanes::from_bytes`]. Of several
    /// directions that are as good it holds the first, clockwise from the top.
    ///
    /// # Errors
    /// [`Error::BadValue`] without a target; [`Error::OutsideMap`] or [`Error::TargetOccupied`].
    pub fn direction_planes(&self, targets: &[Cell]) -> Result<Vec<u8>, Error> {
        let words = self.cells().div_ceil(64);
        let planes = bits(self.lattice());
        let mut reaches: Vec<Vec<u64>> = Vec::new();
        let mut which = Vec::with_capacity(targets.len());
        let mut directions = Vec::new();
        // An empty list is refused by the wave.
        for target in targets.chunks(1).chain(targets.is_empty().then_some(targets)) {
            let field = self.compact_wave(target)?;
            let mut reach = vec![0; words];
            let first = directions.len();
            directions.resize(first + words * planes, 0);
            for (index, cell) in self.cells_in_order().enumerate() {
                let (word, bit) = (index / 64, index % 64);
                let is_reached = field.is_reached(cell);
                reach[word] |= u64::from(is_reached) << bit;
                let dir = if is_reached { field.next(cell).map_or(0, |dir| dir.0) } else { NO_WAY };
                for plane in 0..planes {
                    directions[first + word * planes + plane] |= u64::from(dir >> plane & 1) << bit;
                }
            }
            if self.lattice() == Lattice::Square {
                let known = reaches.iter().position(|other| *other == reach);
                which.push(known.unwrap_or(reaches.len()) as u32);
                if known.is_none() {
                    reaches.push(reach);
                }
            } else {
                which.push(0);
            }
        }
        let mut file = Writer::new(&Parsed {
            kind: DIRECTIONS,
            header: EmbeddedHeader::of(self),
            count: targets.len() as u64,
            planes: reaches.len() as u32,
        });
        for (target, which) in targets.iter().zip(which) {
            file.u32s([target.x as u32, target.y as u32, which, 0]);
        }
        file.u64s(reaches.into_iter().flatten());
        file.u64s(directions);
        Ok(file.finish())
    }

    fn cells_in_order(&self) -> impl Iterator<Item = Cell> {
        let (width, height) = (self.width() as i32, self.height() as i32);
        (0..height).flat_map(move |y| (0..width).map(move |x| Cell::new(x, y)))
    }
}

impl<'a> DirectionPlanes<'a> {
    /// Checks the bytes of a file once, so that every look-up in it is safe. Nothing is copied.
    ///
    /// # Errors
    /// [`Error::BadEmbedded`] with the place and what is wrong there.
    pub fn from_bytes(bytes: &'a [u8]) -> Result<Self, Error> {
        let Parsed { kind, header, count, planes } = parse(bytes)?;
        if kind != DIRECTIONS {
            return bad(10, "the file holds no direction planes");
        }
        let words = header.cells().div_ceil(64);
        let mut sections = Sections::new(bytes);
        let targets = sections.next(count, 16)?;
        let reached_at = sections.at();
        let reached = sections.next(u64::from(planes) * words, 8)?;
        // `count` is below the file's length by now, so the product is below 2⁶⁴.
        let directions = sections.next(count.saturating_mul(words * bits(header.lattice) as u64), 8)?;
        sections.finish()?;
        let view = Self { header, count: count as usize, targets, reached, directions, bytes: bytes.len() };
        for index in 0..view.count {
            let at = 64 + 16 * index as u64;
            if view.target(index).and_then(|cell| header.index(cell)).is_none() {
                return bad(at, "a target lies outside the map");
            }
            let plane = targets.u32(4 * index + 2);
            if targets.u32(4 * index + 3) != 0
                || plane >= planes && (header.lattice == Lattice::Square || plane != 0)
            {
                return bad(at + 8, "a target names a plane that the file does not have");
            }
        }
        for plane in 0..u64::from(planes) {
            check_plane(&reached, (plane * words) as usize, header.cells(), reached_at + plane * words * 8)?;
        }
        Ok(view)
    }

    /// What the file says of its map.
    pub const fn header(&self) -> &EmbeddedHeader {
        &self.header
    }

    /// How many targets it knows.
    pub const fn targets(&self) -> usize {
        self.count
    }

    /// The target of that number, counted from 0.
    pub fn target(&self, number: usize) -> Option<Cell> {
        let cell = |at| Cell::new(self.targets.u32(at) as i32, self.targets.u32(at + 1) as i32);
        (number < self.count).then(|| cell(4 * number))
    }

    /// The bytes of the file, which are all the memory it needs.
    pub const fn bytes(&self) -> usize {
        self.bytes
    }

    /// The direction code of a cell; `None` outside the map and where no way leads to the target.
    #[inline]
    fn code(&self, number: usize, cell: Cell) -> Option<u8> {
        let index = self.header.index(cell).filter(|_| number < self.count)?;
        let words = self.header.cells().div_ceil(64) as usize;
        let planes = bits(self.header.lattice);
        if self.header.lattice == Lattice::Square {
            let plane = self.targets.u32(4 * number + 2) as usize;
            if !self.reached.bit(plane * words * 64 + index) {
                return None;
            }
        }
        let first = (number * words + index / 64) * planes;
        let code = (0..planes).fold(0, |code, plane| {
            code | ((self.directions.u64(first + plane) >> (index % 64) & 1) as u8) << plane
        });
        (code < self.header.lattice.degree()).then_some(code)
    }

    /// Whether a way leads from the cell to target `number`.
    pub fn is_reached(&self, number: usize, cell: Cell) -> bool {
        self.code(number, cell).is_some()
    }

    /// The first step of a shortest way from `from` to target `number`; `None` at the target, where no way leads
    /// there, and for targets that the file does not know.
    #[inline]
    pub fn next(&self, number: usize, from: Cell) -> Option<Dir> {
        let code = self.code(number, from)?;
        (self.target(number) != Some(from)).then_some(Dir(code))
    }

    /// The cells of a shortest way from `from` to target `number`, both included; `None` where there is none.
    pub fn path(&self, number: usize, from: Cell) -> Option<Vec<Cell>> {
        let target = self.target(number)?;
        super::moves::follow(&self.header, from, target, |cell| self.next(number, cell))
    }
}
