//! Verilog-2005.

mod circuit;
mod template;
mod windowed;

pub use circuit::module;
pub use windowed::windowed;
