//! The generated machines in Rust, clock by clock, built on the rules of the core: what their traces must equal.

pub mod fabric;
pub mod player;
pub mod player_top;
pub mod player_trace;
mod windowed;

pub use windowed::{Shown, Status, Windowed, WindowedInputs};
