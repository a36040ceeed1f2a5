//! The fabric's promises, proven by induction for every map; and mutants, which are refuted.

#![expect(clippy::unwrap_used, reason = "a test that cannot prepare itself should stop")]

mod common;

use activecell::{Lattice, Map};
use activecell_codegen::{SourceFile, verilog};
use std::path::Path;

/// A fabric whose map is any: `solve` forgets what its registers hold at first.
fn fabric(lattice: Lattice, width: u32, height: u32) -> Vec<SourceFile> {
    let files = verilog::fabric(&Map::random(lattice, width, height, 0.0, 0).unwrap(), true).unwrap();
    files.into_iter().filter(|file| file.path.starts_with("rtl/")).collect()
}

/// Runs the solver of yosys on the assertions within the files.
fn solve(yosys: &Path, test: &str, files: &[SourceFile], steps: u32) -> String {
    let folder = common::folder(test);
    std::fs::create_dir(folder.join("rtl")).unwrap();
    for file in files {
        std::fs::write(folder.join(&file.path), &file.text).unwrap();
    }
    let sources: Vec<&str> = files.iter().map(|file| file.path.as_str()).collect();
    let script = format!(
        "read_verilog -formal {}; hierarchy -check -top fabric; proc; flatten; setattr -unset init *free; opt -full; async2sync; opt_clean; \
         tee -q -o sat.log sat -tempinduct -prove-asserts -set-assumes -set-init formal_begun 0 -seq 1 -maxsteps {steps}",
        sources.join(" ")
    );
    common::yosys(yosys, &folder, &script);
    std::fs::read_to_string(folder.join("sat.log")).unwrap()
}

#[test]
fn on_every_map_of_8_by_8_wave_and_robot_keep_clear_of_obstacles() {
    let Some([yosys]) = common::programs("fabric_proof", ["yosys"]) else { return };
    for lattice in Lattice::ALL {
        // One step of induction is enough: what is asserted of a clock follows from what is asserted of the one before.
        let log = solve(&yosys, &format!("fabric_proof_{lattice}"), &fabric(lattice, 8, 8), 1);
        assert!(log.contains("Induction step proven: SUCCESS!"), "{lattice}:\n{log}");
        println!("fabric {lattice}: proven for every map of 8 x 8, every task and every loading");
    }
}

#[test]
fn mutants_of_the_fabric_are_refuted() {
    let Some([yosys]) = common::programs("fabric_mutants", ["yosys"]) else { return };
    let mutants = [
        ("the wave ignores obstacles", "is_free & ", ""),
        ("a pointer of two lanes", "assign pointer_next = ", "assign pointer_next = reached_around | "),
        ("a pointer to the neighbour beside", "leaving[y - 1][x][2]", "leaving[y - 1][x][1]"),
        ("a start that never ceases", "assign is_front = reached & was_waiting", "assign is_front = reached"),
        ("a robot that stays", "assign active_next = ", "assign active_next = is_start | "),
    ];
    for (number, (mutation, original, mutant)) in mutants.into_iter().enumerate() {
        let mut files = fabric(Lattice::Square, 4, 4);
        let before = files.clone();
        for file in &mut files {
            file.text = file.text.replace(original, mutant);
        }
        assert_ne!(files, before, "{mutation}: the generated text has no `{original}`");
        // Refuted is what goes wrong from the first clock on, not what induction cannot show.
        let log = solve(&yosys, &format!("fabric_mutant_{number}"), &files, 12);
        assert!(log.contains("model found for base case"), "{mutation} was not refuted:\n{log}");
    }
    println!("fabric: {} mutants refuted", mutants.len());
}
