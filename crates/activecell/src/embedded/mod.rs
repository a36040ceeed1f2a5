//! The embedded map: for a floor that does not change, the next move is looked up instead of searched.
//!
//! Two forms, in one file format that can be memory-mapped or carried by firmware, since its readers work on the
//! bytes as they are: [`DirectionPlanes`] for a few targets, [`MoveTable`] from any cell to any other. The format
//! is described to the bit in `docs/embedded.md`.

mod build;
mod directions;
mod file;
mod moves;
mod order;

pub use directions::DirectionPlanes;
pub use file::EmbeddedHeader;
pub use moves::MoveTable;

use crate::error::Error;
use file::{DIRECTIONS, parse};

/// An embedded map of either form.
///
/// ```
/// use activecell::{Cell, EmbeddedMap, Lattice, Map};
/// let map = Map::parse(Lattice::Square, "..\n.#")?;
/// let file = map.move_table(1000, 1, &|| ())?;
/// assert!(matches!(EmbeddedMap::from_bytes(&file)?, EmbeddedMap::Moves(_)));
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone)]
pub enum EmbeddedMap<'a> {
    /// For a few targets.
    Directions(DirectionPlanes<'a>),
    /// From any cell to any other.
    Moves(MoveTable<'a>),
}

impl<'a> EmbeddedMap<'a> {
    /// Checks the bytes of a file once, so that every look-up in it is safe.
    ///
    /// # Errors
    /// [`Error::BadEmbedded`] with the place and what is wrong there.
    pub fn from_bytes(bytes: &'a [u8]) -> Result<Self, Error> {
        if parse(bytes)?.kind == DIRECTIONS {
            DirectionPlanes::from_bytes(bytes).map(Self::Directions)
        } else {
            MoveTable::from_bytes(bytes).map(Self::Moves)
        }
    }

    /// What the file says of its map.
    pub fn header(&self) -> &EmbeddedHeader {
        match self {
            Self::Directions(planes) => planes.header(),
            Self::Moves(table) => table.header(),
        }
    }
}
