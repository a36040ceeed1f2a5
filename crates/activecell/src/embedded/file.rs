//! The file of an embedded map: its header, and sections of little-endian numbers that begin at whole words.

use crate::error::Error;
use crate::lattice::{Cell, Lattice};
use crate::map::{MAX_CELLS, Map};

const MAGIC: [u8; 8] = *b"ACTCELLM";
const VERSION: u16 = 1;
const HEADER_BYTES: u64 = 64;
/// The kinds of file.
pub(super) const DIRECTIONS: u8 = 1;
pub(super) const MOVES: u8 = 2;

/// What the header of an embedded map says of the map that it was made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EmbeddedHeader {
    /// The lattice.
    pub lattice: Lattice,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Free cells.
    pub free_cells: u32,
    /// A number that follows from the lattice, the size and the obstacles: FNV-1a over 64-bit words.
    pub map_checksum: u64,
}

impl EmbeddedHeader {
    pub(super) fn of(map: &Map) -> Self {
        let mut hash = Fnv::new();
        for number in [u64::from(lattice_code(map.lattice())), map.width().into(), map.height().into()] {
            hash.add(number);
        }
        for y in 0..map.height() {
            map.obstacles().row(y).iter().for_each(|&word| hash.add(word));
        }
        Self {
            lattice: map.lattice(),
            width: map.width(),
            height: map.height(),
            free_cells: map.free_cells() as u32,
            map_checksum: hash.0,
        }
    }

    /// Whether the file was made of exactly these obstacles on this lattice.
    pub fn is_of(&self, map: &Map) -> bool {
        *self == Self::of(map)
    }

    pub(super) fn cells(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// The cell's number in row order; `None` outside the map.
    #[inline]
    pub(super) fn index(&self, cell: Cell) -> Option<usize> {
        let (x, y) = (cell.x as u32, cell.y as u32);
        (x < self.width && y < self.height).then(|| y as usize * self.width as usize + x as usize)
    }
}

/// Fowler, Noll, Vo: the FNV-1a hash, 64 bits, fed with words instead of bytes.
struct Fnv(u64);

impl Fnv {
    const fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    const fn add(&mut self, word: u64) {
        self.0 = (self.0 ^ word).wrapping_mul(0x0000_0100_0000_01b3);
    }
}

const fn lattice_code(lattice: Lattice) -> u8 {
    match lattice {
        Lattice::Square => 0,
        Lattice::Hex => 1,
    }
}

/// The header with the numbers that its kind needs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Parsed {
    pub(super) kind: u8,
    pub(super) header: EmbeddedHeader,
    /// Targets, or runs.
    pub(super) count: u64,
    /// Planes of reached cells.
    pub(super) planes: u32,
}

/// A file that is being written.
pub(super) struct Writer(Vec<u8>);

impl Writer {
    pub(super) fn new(parsed: &Parsed) -> Self {
        let header = &parsed.header;
        let mut bytes = MAGIC.to_vec();
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend([parsed.kind, lattice_code(header.lattice)]);
        for number in [header.width, header.height, header.free_cells] {
            bytes.extend(number.to_le_bytes());
        }
        // The length is known at the end.
        for number in [header.map_checksum, 0, parsed.count] {
            bytes.extend(number.to_le_bytes());
        }
        bytes.extend(parsed.planes.to_le_bytes());
        bytes.resize(HEADER_BYTES as usize, 0);
        Self(bytes)
    }

    pub(super) fn u32s(&mut self, numbers: impl IntoIterator<Item = u32>) {
        self.0.extend(numbers.into_iter().flat_map(u32::to_le_bytes));
    }

    pub(super) fn u64s(&mut self, numbers: impl IntoIterator<Item = u64>) {
        self.0.extend(numbers.into_iter().flat_map(u64::to_le_bytes));
    }

    /// Ends a section: the next begins at a whole word.
    pub(super) fn end_section(&mut self) {
        self.0.resize(self.0.len().next_multiple_of(8), 0);
    }

    pub(super) fn finish(mut self) -> Vec<u8> {
        self.end_section();
        let length = self.0.len() as u64;
        self.0[32..40].copy_from_slice(&length.to_le_bytes());
        self.0
    }
}

/// An error at a place of the file.
pub(super) fn bad<T>(offset: u64, reason: &'static str) -> Result<T, Error> {
    Err(Error::BadEmbedded { offset, reason })
}

/// Reads the header and checks everything that does not depend on the kind.
pub(super) fn parse(bytes: &[u8]) -> Result<Parsed, Error> {
    if bytes.len() < HEADER_BYTES as usize {
        return bad(bytes.len() as u64, "the file ends within its header");
    }
    if bytes[..8] != MAGIC {
        return bad(0, "this is no embedded map");
    }
    let u16_at = |at: usize| u16::from_le_bytes([bytes[at], bytes[at + 1]]);
    let u32_at = |at: usize| Numbers(&bytes[at..at + 4]).u32(0);
    let u64_at = |at: usize| Numbers(&bytes[at..at + 8]).u64(0);
    if u16_at(8) != VERSION {
        return bad(8, "the file has a version that this program does not know");
    }
    let kind = bytes[10];
    if kind != DIRECTIONS && kind != MOVES {
        return bad(10, "the kind must be 1 (directions) or 2 (moves)");
    }
    let lattice = match bytes[11] {
        0 => Lattice::Square,
        1 => Lattice::Hex,
        _ => return bad(11, "the lattice must be 0 (square) or 1 (hex)"),
    };
    let header = EmbeddedHeader {
        lattice,
        width: u32_at(12),
        height: u32_at(16),
        free_cells: u32_at(20),
        map_checksum: u64_at(24),
    };
    if header.cells() == 0 || header.cells() > MAX_CELLS || u64::from(header.free_cells) > header.cells() {
        return bad(12, "the numbers of columns, rows and free cells make no sense");
    }
    if u64_at(32) != bytes.len() as u64 {
        return bad(32, "the file is longer or shorter than it says");
    }
    if bytes[52..64] != [0; 12] {
        return bad(52, "bytes 52 to 63 must be 0");
    }
    Ok(Parsed { kind, header, count: u64_at(40), planes: u32_at(48) })
}

/// Cuts a file into its sections.
pub(super) struct Sections<'a> {
    bytes: &'a [u8],
    at: u64,
}

impl<'a> Sections<'a> {
    pub(super) const fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: HEADER_BYTES }
    }

    /// Where the next section begins.
    pub(super) const fn at(&self) -> u64 {
        self.at
    }

    /// The next section: `count` numbers of `size` bytes.
    pub(super) fn next(&mut self, count: u64, size: u64) -> Result<Numbers<'a>, Error> {
        let end = count.checked_mul(size).and_then(|length| length.checked_add(self.at));
        let Some(end) = end.filter(|&end| end <= self.bytes.len() as u64) else {
            return bad(self.at, "the file ends within the section that begins here");
        };
        let numbers = Numbers(&self.bytes[self.at as usize..end as usize]);
        self.at = end.next_multiple_of(8);
        Ok(numbers)
    }

    /// Checks that nothing is left.
    pub(super) fn finish(&self) -> Result<(), Error> {
        if self.at != self.bytes.len() as u64 {
            return bad(self.at, "the file goes on behind its last section");
        }
        Ok(())
    }
}

/// A section of little-endian numbers, read in place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Numbers<'a>(&'a [u8]);

impl Numbers<'_> {
    #[inline]
    pub(super) fn u32(&self, index: usize) -> u32 {
        let mut bytes = [0; 4];
        bytes.copy_from_slice(&self.0[4 * index..4 * index + 4]);
        u32::from_le_bytes(bytes)
    }

    #[inline]
    pub(super) fn u64(&self, index: usize) -> u64 {
        let mut bytes = [0; 8];
        bytes.copy_from_slice(&self.0[8 * index..8 * index + 8]);
        u64::from_le_bytes(bytes)
    }

    /// Bit `index` of words of 64.
    #[inline]
    pub(super) fn bit(&self, index: usize) -> bool {
        self.u64(index / 64) >> (index % 64) & 1 == 1
    }
}

/// Checks a plane of a bit a cell: the bits behind the last cell are 0. Gives the number of ones.
pub(super) fn check_plane(plane: &Numbers, first_word: usize, cells: u64, at: u64) -> Result<u64, Error> {
    let words = cells.div_ceil(64) as usize;
    let ones = (first_word..first_word + words).map(|word| u64::from(plane.u64(word).count_ones())).sum();
    if !cells.is_multiple_of(64) && plane.u64(first_word + words - 1) >> (cells % 64) != 0 {
        return bad(at, "a plane has bits behind its last cell");
    }
    Ok(ones)
}
