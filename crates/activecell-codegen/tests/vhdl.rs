//! The VHDL is the Verilog: proven for every input of the circuits; the navigators run their test benches.

mod common;

use activecell::{Drive, Lattice, Map, Rng};
use activecell_codegen::logic::Circuit;
use activecell_codegen::model::player::{Motion, Segment};
use activecell_codegen::{Language, SourceFile, circuits, generate, verilog, vhdl};
use std::path::{Path, PathBuf};

/// Every circuit that is written out.
fn all() -> Vec<Circuit> {
    let rules =
        Lattice::ALL.iter().flat_map(|&lattice| [circuits::sector(lattice), circuits::decision(lattice)]);
    let cells = Lattice::ALL.map(circuits::fabric_cell);
    rules.chain(cells).chain([circuits::control(), circuits::player()]).collect()
}

/// Whether an entity, made into gates by GHDL, equals the module of that name for every input.
fn is_equal(tools: &[PathBuf; 2], folder: &Path, name: &str, vhdl: &str, verilog: &str) -> bool {
    let [ghdl, yosys] = tools;
    std::fs::write(folder.join("entity.vhd"), vhdl).expect("the folder can be written");
    std::fs::write(folder.join("lanes.vhd"), vhdl::lanes().text).expect("the folder can be written");
    std::fs::write(folder.join("gold.v"), verilog).expect("the folder can be written");
    let mut synth = common::command(ghdl, folder);
    synth.args(["--synth", "--std=93", "--out=verilog", "lanes.vhd", "entity.vhd", "-e", name]);
    std::fs::write(folder.join("gate.v"), common::run(&mut synth)).expect("the folder can be written");
    let script = format!(
        "read_verilog gold.v; rename {name} gold; read_verilog gate.v; rename {name} gate; proc -norom; \
         miter -equiv -flatten -make_assert gold gate miter; hierarchy -top miter; opt -full; \
         sat -verify -prove-asserts miter"
    );
    let mut prove = common::command(yosys, folder);
    let output = prove.args(["-q", "-p", &script]).output().expect("a program that was found can be run");
    let said = String::from_utf8_lossy(&output.stderr) + String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success() || said.contains("Called with -verify and proof did fail"), "{said}");
    output.status.success()
}

#[test]
fn vhdl_equals_verilog_for_every_input() {
    let Some(tools) = common::programs("vhdl_equals_verilog_for_every_input", ["ghdl", "yosys"]) else {
        return;
    };
    let folder = common::folder("vhdl_equal");
    let circuits = all().into_iter().map(|circuit| {
        let (vhdl, verilog) = (vhdl::entity(&circuit), verilog::module(&circuit));
        (circuit.name, vhdl, verilog)
    });
    let bearings = Lattice::ALL.map(|lattice| {
        let map = Map::random(lattice, 200, 100, 0.2, 1).unwrap();
        let text = |files: Vec<SourceFile>, end: &str| {
            let path = format!("rtl/bearing_{lattice}.{end}");
            files.into_iter().find(|file| file.path == path).unwrap().text
        };
        let (vhdl, verilog) = (vhdl::windowed(&map).unwrap(), verilog::windowed(&map).unwrap());
        (format!("bearing_{lattice}"), text(vhdl, "vhd"), text(verilog, "v"))
    });
    for (name, vhdl, verilog) in circuits.chain(bearings) {
        assert!(vhdl.lines().all(|line| line.len() <= 125), "{vhdl}");
        assert!(is_equal(&tools, &folder, &name, &vhdl, &verilog), "{name}");
        println!("{name}: VHDL equals Verilog for all inputs");
        // The proof would find a fault.
        let (declared, begun) = vhdl.split_once("\nbegin\n").unwrap();
        let begun = begun.replacen("not ", "", 1).replacen("flag(across > 0)", "flag(across >= 0)", 1);
        let begun = begun.replacen("flag(target_row < row)", "flag(target_row <= row)", 1);
        let wrong = format!("{declared}\nbegin\n{begun}");
        assert!(wrong != vhdl && !is_equal(&tools, &folder, &name, &wrong, &verilog), "{name}");
    }
}

/// What `generate` writes without a map: the entities of both lattices, in an order in which they can be analysed.
#[test]
fn the_rule_alone_is_analysed() {
    let Some([ghdl]) = common::programs("the_rule_alone_is_analysed", ["ghdl"]) else { return };
    let folder = common::folder("vhdl_rules");
    let files = generate(Language::Vhdl, None).unwrap().files;
    common::write(&folder, &files);
    let sources: Vec<&str> = sources(&files).collect();
    assert_eq!(sources.len(), 6, "{sources:?}");
    let said = common::run(common::command(&ghdl, &folder).args(["-a", "--std=93"]).args(&sources));
    assert_eq!(said, "");
    println!("{} files of the rule alone: GHDL takes them in their order", sources.len());
}

/// The sources among the files, in their order.
fn sources(files: &[SourceFile]) -> impl Iterator<Item = &str> {
    files.iter().map(|file| file.path.as_str()).filter(|path| path.ends_with("vhd"))
}

/// What a test bench says under GHDL, which has nothing to say of the files.
fn runs(ghdl: &Path, folder: &Path, files: &[SourceFile], bench: &str) -> String {
    common::write(folder, files);
    let steps: [Vec<&str>; 2] = [
        ["-a", "--std=93"].into_iter().chain(sources(files)).collect(),
        vec!["--elab-run", "--std=93", bench, "--ieee-asserts=disable-at-0"],
    ];
    let [analysed, said] = steps.map(|step| {
        let output = common::command(ghdl, folder).args(step).output().expect("GHDL was found");
        [output.stdout, output.stderr].map(|said| String::from_utf8_lossy(&said).into_owned()).concat()
    });
    assert_eq!(analysed, "", "warnings");
    said
}

/// Whether a test bench passes under GHDL.
fn passes(ghdl: &Path, folder: &Path, files: &[SourceFile], bench: &str) -> bool {
    let said = runs(ghdl, folder, files, bench);
    let [passed, failed] = ["PASS ", "FAIL "].map(|word| said.contains(word));
    assert!(passed != failed, "{said}");
    assert!(failed || said.lines().count() == 1, "warnings: {said}");
    passed
}

#[test]
fn the_players_test_bench_passes_and_finds_faults() {
    let Some([ghdl]) = common::programs("the_players_test_bench_passes_and_finds_faults", ["ghdl"]) else {
        return;
    };
    let mut rng = Rng::new(1);
    let folder = common::folder("vhdl_player");
    for case in [0, 1, 3, 6, 9, 5] {
        // The last program is longer than a simulation could wait for.
        let longest = if case == 5 { u32::MAX } else { 1 + rng.below(300) };
        let segment = |rng: &mut Rng| Segment {
            motion: Motion::ALL[rng.below(4) as usize],
            ticks: 1 + rng.below(longest),
        };
        let segments: Vec<Segment> = (0..case * case).map(|_| segment(&mut rng)).collect();
        let drive = [Drive::Differential, Drive::Steered][case % 2];
        let mut files = vhdl::player(&segments, drive).unwrap();
        assert!(passes(&ghdl, &folder, &files, "player_tb"));
        if case < 5 {
            assert!(runs(&ghdl, &folder, &files, "player_example_tb").contains("PASS example"));
        }
        let trace = files.last_mut().unwrap();
        // Behind the last segment: done, calm.
        assert!(trace.text.lines().last().unwrap().contains("_1_1_"), "{}", trace.text);
        let place = trace.text.len() - 5; // q3 to q0 of the last line
        trace.text.replace_range(place..=place, "2");
        assert!(!passes(&ghdl, &folder, &files, "player_tb"));
    }
    println!("6 programs: the test bench in VHDL passes, and fails if the last line is wrong");
}

#[test]
fn the_windowed_navigators_test_bench_passes_and_finds_faults() {
    let test = "the_windowed_navigators_test_bench_passes_and_finds_faults";
    let Some([ghdl]) = common::programs(test, ["ghdl"]) else { return };
    let folder = common::folder("vhdl_windowed");
    for lattice in Lattice::ALL {
        // Maps that fill the banks, and maps with room around.
        for (width, height, seed) in [(1, 1, 1), (16, 15, 2), (30, 17, 3), (64, 40, 4)] {
            let map = Map::random(lattice, width, height, 0.15, seed).unwrap();
            let mut files = vhdl::windowed(&map).unwrap();
            assert!(passes(&ghdl, &folder, &files, "windowed_tb"), "{lattice} {width} x {height}");
            let mut example = common::command(&ghdl, &folder);
            example.args(["--elab-run", "--std=93", "windowed_example_tb", "--ieee-asserts=disable-at-0"]);
            common::check_example(&map, &common::run(&mut example));
            let trace = files.last_mut().unwrap();
            let place = trace.text.len() - 4; // the step of the last line, which is none
            trace.text.replace_range(place..=place, "1");
            assert!(!passes(&ghdl, &folder, &files, "windowed_tb"), "{lattice} {width} x {height}");
        }
    }
    println!("4 maps of each lattice: the test bench in VHDL passes, and fails if the last line is wrong");
}

#[test]
fn the_fabrics_test_bench_passes_and_finds_faults() {
    let test = "the_fabrics_test_bench_passes_and_finds_faults";
    let Some([ghdl]) = common::programs(test, ["ghdl"]) else { return };
    let folder = common::folder("vhdl_fabric");
    for lattice in Lattice::ALL {
        for (width, height, loadable) in [(1, 1, true), (2, 1, false), (7, 5, true), (9, 10, false)] {
            let map = Map::random(lattice, width, height, 0.2, u64::from(width)).unwrap();
            let mut files = vhdl::fabric(&map, loadable).unwrap();
            assert!(passes(&ghdl, &folder, &files, "fabric_tb"), "{lattice} {width} x {height}");
            let trace = files.last_mut().unwrap();
            let place = trace.text.len() - 10; // busy to unreachable of the last line
            trace.text.replace_range(place..=place, "f");
            assert!(!passes(&ghdl, &folder, &files, "fabric_tb"), "{lattice} {width} x {height}");
        }
    }
    println!("4 fabrics of each lattice: the test bench in VHDL passes, and fails if the last line is wrong");
}

/// Whether the entity becomes gates: GHDL makes a netlist of it, which yosys takes without a complaint.
fn becomes_gates([ghdl, yosys]: &[PathBuf; 2], folder: &Path, files: &[SourceFile], top: &str) {
    common::write(folder, files);
    let sources = files.iter().map(|file| file.path.as_str()).filter(|path| path.starts_with("rtl"));
    let mut synth = common::command(ghdl, folder);
    synth.args(["--synth", "--std=93", "--out=verilog"]).args(sources).args(["-e", top]);
    std::fs::write(folder.join("netlist.v"), common::run(&mut synth)).expect("the folder can be written");
    let script = format!("read_verilog netlist.v; hierarchy -check -top {top}; proc; check -assert");
    common::yosys(yosys, folder, &script);
}

/// GHDL keeps the banks of every map as memories, and yosys puts them into block RAM by what the banks' comment says.
#[test]
fn maps_of_every_size_become_block_ram() {
    let test = "maps_of_every_size_become_block_ram";
    let Some([ghdl, yosys]) = common::programs(test, ["ghdl", "yosys"]) else { return };
    let folder = common::folder("vhdl_block_ram");
    for (lattice, width, height) in [(Lattice::Square, 8, 8), (Lattice::Hex, 40, 24)] {
        let map = Map::random(lattice, width, height, 0.2, 1).unwrap();
        let files = vhdl::windowed(&map).unwrap();
        common::write(&folder, &files);
        let bank = files.iter().find(|file| file.path == "rtl/map_bank.vhd").expect("a bank");
        let told = bank.text.lines().find_map(|line| line.strip_prefix("--     ")).expect("a command");
        let sources = sources(&files).filter(|path| path.starts_with("rtl"));
        let mut synth = common::command(&ghdl, &folder);
        synth.args(["--synth", "--std=93", "--out=verilog"]).args(sources).args(["-e", "map_window"]);
        std::fs::write(folder.join("netlist.v"), common::run(&mut synth)).expect("the folder can be written");
        let script = format!(
            "read_verilog netlist.v; {told}; proc; opt; memory -nomap; \
             memory_libmap -lib +/ice40/brams.txt; select -assert-count 16 t:$__ICE40_RAM4K_"
        );
        common::yosys(&yosys, &folder, &script);
        println!("{width} x {height} {lattice}: 16 block RAMs from VHDL");
    }
}

#[test]
fn every_navigator_becomes_gates() {
    let Some(tools) = common::programs("every_navigator_becomes_gates", ["ghdl", "yosys"]) else { return };
    let folder = common::folder("vhdl_gates");
    let segments = [Motion::Forward, Motion::Left].map(|motion| Segment { motion, ticks: 100 });
    becomes_gates(&tools, &folder, &vhdl::player(&segments, Drive::Steered).unwrap(), "player_top");
    for lattice in Lattice::ALL {
        let map = Map::random(lattice, 30, 16, 0.2, 1).unwrap();
        becomes_gates(&tools, &folder, &vhdl::windowed(&map).unwrap(), &format!("windowed_{lattice}"));
        let map = Map::random(lattice, 6, 5, 0.2, 1).unwrap();
        for loadable in [false, true] {
            becomes_gates(&tools, &folder, &vhdl::fabric(&map, loadable).unwrap(), "fabric");
        }
    }
    println!("player, windowed navigators and fabrics in VHDL become gates");
}
