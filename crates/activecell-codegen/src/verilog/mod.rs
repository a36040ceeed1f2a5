//! Verilog-2005.

mod circuit;
mod player;

pub use circuit::module;
pub use player::{control_unit, player};
