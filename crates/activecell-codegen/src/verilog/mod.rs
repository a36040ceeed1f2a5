//! Verilog-2005.

mod circuit;
mod player;
mod windowed;

pub use circuit::module;
pub use player::{control_unit, player};
pub use windowed::windowed;
