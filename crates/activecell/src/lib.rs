//! Robot navigation by cellular automata with active cells.

mod error;
mod lattice;
mod map;
mod rng;

pub use error::Error;
pub use lattice::{Cell, Dir, Lattice};
pub use map::{BitPlane, Frame, MAX_CELLS, Map, PointM, Tiling};
pub use rng::Rng;
