//! Verilog-2005.

mod circuit;

pub use circuit::module;
