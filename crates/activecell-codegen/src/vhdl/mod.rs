//! VHDL-93.

mod circuit;
mod player;

pub use circuit::{entity, lanes};
pub use player::{control_unit, player};
