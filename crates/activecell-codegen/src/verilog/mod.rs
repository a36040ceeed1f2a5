//! Verilog-2005.

mod circuit;
mod fabric;
mod fabric_bench;
mod player;
mod windowed;

pub use circuit::module;
pub use fabric::{MAX_FABRIC_CELLS, fabric};
pub(crate) use fabric::{checked, neighbour, rows_of_bits, shared_values};
pub(crate) use fabric_bench::trace as fabric_trace;
pub use player::{control_unit, player};
pub use windowed::windowed;
