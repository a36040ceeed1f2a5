//! Prints every circuit in the language named: `circuits verilog|vhdl|c`.

use activecell::Lattice;
use activecell_codegen::{circuits, verilog};

fn main() {
    for circuit in [
        circuits::sector(Lattice::Square),
        circuits::decision(Lattice::Square),
        circuits::sector(Lattice::Hex),
        circuits::decision(Lattice::Hex),
        circuits::control(),
    ] {
        println!("{}", verilog::module(&circuit));
    }
}
