//! Verilog-2005.

mod circuit;
mod fabric;
mod fabric_bench;

pub use circuit::module;
pub use fabric::{MAX_FABRIC_CELLS, fabric};
