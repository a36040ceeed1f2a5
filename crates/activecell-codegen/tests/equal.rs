//! What is written out equals the circuits, and the circuits equal the core: for every input.

mod common;

use activecell::Lattice;
use activecell_codegen::{circuits, verilog};

#[test]
fn yosys_reads_every_module() {
    let Some([yosys]) = common::programs("yosys_reads_every_module", ["yosys"]) else { return };
    let folder = common::folder("modules");
    let all =
        Lattice::ALL.iter().flat_map(|&lattice| [circuits::sector(lattice), circuits::decision(lattice)]);
    for circuit in all.chain([circuits::control()]) {
        let file = format!("{}.v", circuit.name);
        std::fs::write(folder.join(&file), verilog::module(&circuit)).unwrap();
        common::yosys(
            &yosys,
            &folder,
            &format!("read_verilog {file}; hierarchy -check -top {}; proc; check -assert", circuit.name),
        );
    }
}
