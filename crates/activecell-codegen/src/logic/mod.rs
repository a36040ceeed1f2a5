//! Combinational logic as a value: what the rules are reduced to before they become C, Verilog or VHDL.

mod circuit;
mod cubes;
mod keywords;

pub(crate) use circuit::mask;
pub use circuit::{Circuit, Expr, Fault, Port, Signal, Wire};
pub use cubes::{Cube, sum_of_products};
