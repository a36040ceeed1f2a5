//! C99 for microcontrollers: freestanding, without a heap or a library.

mod circuit;
mod examples;
mod firmware;
mod lattice;
mod program;
mod units;

pub use circuit::{function, header, headers};
pub use firmware::{Footprint, firmware, footprint, rows};
pub(crate) use lattice::lane_number;
pub use program::Program;
