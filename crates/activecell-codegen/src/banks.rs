//! A map dealt out to 16 memories, so that any 5 × 5 cells can be read at once.

use activecell::{Error, Map};

/// The most cells that the banks may hold together: no small FPGA has block RAM for more.
pub const MOST_STORED: u64 = 1 << 22;

/// Columns before the map's first, and rows above it: so the window about a cell begins at the stored cell of the same
/// numbers.
const BORDER: i32 = 2;

/// The images of 4 × 4 memories. Tiles of 2 × 2 cells go to the memories in turn, along rows and along columns, so 5 × 5
/// cells never need two tiles of one memory.
///
/// Columns and rows wrap; those that the map leaves over hold obstacles. Two of them are a border on both sides.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Banks {
    /// There are 2^`x_bits` columns, at least 16.
    pub x_bits: u32,
    /// There are 2^`y_bits` rows, at least 16.
    pub y_bits: u32,
    /// For each memory, row by row of the 16, its tiles in the order of their addresses: row by row of 8 cells, and in
    /// each the columns of 8 cells. Bits 0 to 3 of a tile: upper left, upper right, lower left, lower right; 1 for a
    /// free cell.
    pub images: Vec<Vec<u8>>,
}

impl Banks {
    /// The map in as few columns and rows as hold it.
    ///
    /// ```
    /// use activecell::{Lattice, Map};
    /// use activecell_codegen::Banks;
    /// let banks = Banks::of(&Map::parse(Lattice::Square, "..\n.#")?)?;
    /// assert_eq!((banks.x_bits, banks.y_bits), (4, 4));
    /// // Cell (0, 0) is the first of its tile, in the memory of column 1 and row 1.
    /// assert_eq!(banks.images[5][0], 0b0111);
    /// # Ok::<(), activecell::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::MapTooLarge`] if these are more than [`MOST_STORED`] cells.
    pub fn of(map: &Map) -> Result<Self, Error> {
        let [x_bits, y_bits] = Self::bits(map)?;
        let mut images = vec![vec![0; Self::tiles(map)?]; 16];
        for cell in map.free() {
            let wrapped = |at: i32, bits: u32| (at + BORDER) as usize & ((1 << bits) - 1);
            let (x, y) = (wrapped(cell.x, x_bits), wrapped(cell.y, y_bits));
            let (bank, address) = (y / 2 % 4 * 4 + x / 2 % 4, ((y / 8) << (x_bits - 3)) + x / 8);
            images[bank][address] |= 1 << (y % 2 * 2 + x % 2);
        }
        Ok(Self { x_bits, y_bits, images })
    }

    /// How many tiles each memory has, without dealing the map out.
    pub(crate) fn tiles(map: &Map) -> Result<usize, Error> {
        let [x_bits, y_bits] = Self::bits(map)?;
        Ok(1 << (x_bits + y_bits - 6))
    }

    /// `x_bits` and `y_bits`.
    fn bits(map: &Map) -> Result<[u32; 2], Error> {
        let [x_bits, y_bits] =
            [map.width(), map.height()].map(|cells| cells.next_power_of_two().trailing_zeros().max(4));
        if 1u64 << (x_bits + y_bits) > MOST_STORED {
            let [width, height] = [map.width(), map.height()].map(u64::from);
            return Err(Error::MapTooLarge { width, height, limit: MOST_STORED });
        }
        Ok([x_bits, y_bits])
    }
}
