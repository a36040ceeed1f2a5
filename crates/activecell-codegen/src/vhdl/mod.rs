//! VHDL-93.

mod circuit;

pub use circuit::{entity, lanes};
