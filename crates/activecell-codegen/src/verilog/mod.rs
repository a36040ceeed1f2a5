//! Verilog-2005.

mod circuit;
mod fabric;

pub use circuit::module;
pub use fabric::{MAX_FABRIC_CELLS, fabric};
