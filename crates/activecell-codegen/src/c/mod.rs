//! C99 for microcontrollers: freestanding, without a heap or a library.

mod circuit;
mod firmware;
mod lattice;

pub use circuit::{function, header, headers};
pub use firmware::{Footprint, firmware, footprint, rows};
