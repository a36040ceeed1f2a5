//! Prints every circuit in the language named: `circuits verilog|c`.

use activecell::Lattice;
use activecell_codegen::{c, circuits, verilog};

fn main() {
    let print = match std::env::args().nth(1).as_deref() {
        Some("c") => c::function,
        _ => verilog::module,
    };
    for circuit in [
        circuits::sector(Lattice::Square),
        circuits::decision(Lattice::Square),
        circuits::sector(Lattice::Hex),
        circuits::decision(Lattice::Hex),
        circuits::control(),
    ] {
        println!("{}", print(&circuit));
    }
}
