//! Cross-compiled: sizes; in QEMU: the same decisions and routes as here, and instructions counted.

use crate::{STRICT, common, real_map, sources, warehouse, written};
use activecell::rule::{Decision, Sector, decide};
use activecell::{BitPlane, Cell, Lattice, Map, Outcome, Robot, Rule};
use activecell_codegen::{Language, Order, circuits, generate, long_way};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// A processor and the board on which QEMU has it.
#[derive(Debug, Clone, Copy)]
struct Board {
    name: &'static str,
    processor: &'static str,
    machine: &'static str,
    ram: &'static str,
}

/// QEMU has no Cortex-M0+, but the M0, of the same instructions.
const M0: Board = Board { name: "M0+", processor: "cortex-m0plus", machine: "microbit", ram: "16K" };
const M4: Board = Board { name: "M4", processor: "cortex-m4", machine: "mps2-an386", ram: "4M" };

/// Compilers without a library.
struct Tools {
    gcc: PathBuf,
    size: PathBuf,
    nm: PathBuf,
    qemu: PathBuf,
}

impl Tools {
    fn new(test: &str) -> Option<Self> {
        let names = ["arm-none-eabi-gcc", "arm-none-eabi-size", "arm-none-eabi-nm", "qemu-system-arm"];
        let [gcc, size, nm, qemu] = common::programs(test, names)?;
        Some(Self { gcc, size, nm, qemu })
    }

    fn compiled(&self, folder: &Path, board: Board, files: &[String], more: &[String]) {
        let processor = format!("-mcpu={}", board.processor);
        let target = [&processor, "-mthumb", "-ffreestanding", "-ffunction-sections", "-fdata-sections"];
        common::run(
            common::command(&self.gcc, folder)
                .args(STRICT)
                .args(target)
                .arg("-Os")
                .args(more)
                .arg("-c")
                .args(files),
        );
    }

    /// An image for the board from all object files in the folder.
    fn linked(&self, folder: &Path, board: Board, objects: &[&str], image: &str) {
        let script = std::fs::read_to_string(folder.join("examples/cortex_m.ld")).unwrap();
        let line = |line: &str| match line.split_once("LENGTH = ") {
            Some((memory, _)) if memory.contains("RAM") => format!("{memory}LENGTH = {}\n", board.ram),
            Some((memory, _)) => format!("{memory}LENGTH = 1M\n"),
            None => format!("{line}\n"),
        };
        let script: String = script.lines().map(line).collect();
        std::fs::write(folder.join("board.ld"), script).unwrap();
        let processor = format!("-mcpu={}", board.processor);
        common::run(
            common::command(&self.gcc, folder)
                .args([&processor, "-mthumb", "-nostdlib", "-Wl,--gc-sections", "-Wl,--fatal-warnings"])
                .args(["-T", "board.ld", "-o", image])
                .args(objects)
                .arg("-lgcc"),
        );
    }

    fn emulated(&self, folder: &Path, board: Board, image: &str, more: &[&str]) -> String {
        let semihosting = ["-nographic", "-semihosting-config", "enable=on,target=native", "-kernel", image];
        let mut command = common::command(&self.qemu, folder);
        let output = command.args(["-M", board.machine]).args(more).args(semihosting).output().unwrap();
        // What the board says comes out there.
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{command:?}: {said}");
        said
    }

    /// Bytes of code and constants of the functions named, and of what they call.
    fn bytes(&self, folder: &Path, board: Board, roots: &[&str]) -> u32 {
        let processor = format!("-mcpu={}", board.processor);
        let roots = roots.iter().map(|root| format!("-Wl,-u,{root}"));
        let objects = objects(folder);
        common::run(
            common::command(&self.gcc, folder)
                .args([&processor, "-mthumb", "-nostdlib", "-Wl,--gc-sections", "-Wl,-e,0", "-o", "part.elf"])
                .args(roots)
                .args(objects),
        );
        let sizes = common::run(common::command(&self.size, folder).arg("part.elf"));
        sizes.lines().nth(1).and_then(|line| line.split_whitespace().next()).unwrap().parse().unwrap()
    }

    /// The addresses of all instructions that an image executes, from the emulator's trace.
    fn trace(&self, folder: &Path, board: Board, image: &str) -> Vec<u32> {
        let version = common::run(common::command(&self.qemu, folder).arg("--version"));
        let major = version.split("version ").nth(1).and_then(|version| version.split('.').next());
        let major: u32 = major.unwrap().parse().unwrap();
        let one_by_one = if major < 8 { "-singlestep" } else { "-one-insn-per-tb" };
        self.emulated(folder, board, image, &[one_by_one, "-d", "exec,nochain", "-D", "trace.log"]);
        let trace = std::fs::read_to_string(folder.join("trace.log")).unwrap();
        std::fs::remove_file(folder.join("trace.log")).unwrap();
        let lines = trace.lines().filter(|line| line.starts_with("Trace"));
        let address = |line: &str| u32::from_str_radix(line.split(['[', '/']).nth(2).unwrap(), 16).unwrap();
        lines.map(address).collect()
    }

    /// The most instructions from one call of a function to the next.
    fn longest(&self, folder: &Path, image: &str, function: &str, trace: &[u32]) -> usize {
        let symbols = common::run(common::command(&self.nm, folder).arg(image));
        let line = symbols.lines().find(|line| line.ends_with(&format!(" {function}"))).unwrap();
        let address = u32::from_str_radix(line.split(' ').next().unwrap(), 16).unwrap();
        let calls = trace.iter().enumerate().filter(|(_, at)| **at == address);
        let calls: Vec<usize> = calls.map(|(place, _)| place).collect();
        calls.windows(2).map(|pair| pair[1] - pair[0]).max().unwrap()
    }
}

fn objects(folder: &Path) -> Vec<String> {
    let name = |source: &String| source.replace("src/", "").replace(".c", ".o");
    sources(folder).iter().map(name).collect()
}

fn task(from: Cell, to: Cell) -> [String; 4] {
    [("FROM_X", from.x), ("FROM_Y", from.y), ("TO_X", to.x), ("TO_Y", to.y)]
        .map(|(name, value)| format!("-D{name}={value}U"))
}

/// All frames together are more than any chain of calls takes: no function calls itself.
#[test]
fn frames_are_small() {
    let Some(tools) = Tools::new("frames_are_small") else { return };
    for lattice in Lattice::ALL {
        let folder = written(&format!("frames_{lattice}"), &warehouse(lattice), None);
        let header = std::fs::read_to_string(folder.join("include/activecell.h")).unwrap();
        let said = header.split("frames of less than ").nth(1).and_then(|text| text.split(' ').next());
        let most: u32 = said.unwrap().parse().unwrap();
        for board in [M0, M4] {
            tools.compiled(&folder, board, &sources(&folder), &["-fstack-usage".into()]);
            let usage = objects(&folder)
                .into_iter()
                .filter_map(|object| std::fs::read_to_string(folder.join(object.replace(".o", ".su"))).ok());
            let usage = usage.collect::<Vec<_>>().concat();
            let frames = usage.lines().map(|line| line.split('\t').nth(1).unwrap().parse::<u32>().unwrap());
            let sum: u32 = frames.sum();
            println!("{lattice} {}: all frames together take {sum} bytes", board.name);
            assert!((1..most).contains(&sum), "{lattice} {}: {sum}", board.name);
        }
    }
}

/// No part of the firmware has variables of its own or calls a library; decision and window are small.
#[test]
fn code_is_small_and_needs_no_memory() {
    let Some(tools) = Tools::new("code_is_small") else { return };
    for lattice in Lattice::ALL {
        let map = Map::random(lattice, 64, 64, 0.2, 1).unwrap();
        let folder = written(&format!("code_{lattice}"), &map, None);
        for board in [M0, M4] {
            tools.compiled(&folder, board, &sources(&folder), &[]);
            let sizes = common::run(common::command(&tools.size, &folder).args(objects(&folder)));
            for line in sizes.lines().skip(1) {
                let fields: Vec<&str> = line.split_whitespace().collect();
                assert_eq!(fields[1..3], ["0", "0"], "variables: {line}");
            }
            let parts: [(&str, &[&str]); 8] = [
                ("window and decision", &["ac_window", "ac_decide"]),
                ("step", &["ac_next", "ac_neighbour"]),
                ("replay", &["ac_replay_start", "ac_replay_step"]),
                ("learning", &["ac_learning_start", "ac_learning_step"]),
                ("wave", &["ac_wave_start", "ac_wave_flood", "ac_wave_next"]),
                ("control unit", &["ac_control_step", "ac_control_outputs"]),
                ("player", &["ac_player_start", "ac_player_clock", "ac_player_is_done"]),
                ("map of 64 x 64", &["ac_floor"]),
            ];
            let mut text = String::new();
            for (name, roots) in parts {
                // The linker would say so if a library were called.
                let bytes = tools.bytes(&folder, board, roots);
                let _ = write!(text, " {name} {bytes},");
                assert!(name != "window and decision" || bytes <= 600, "{lattice} {}: {bytes}", board.name);
            }
            println!("{lattice} {}: bytes of{}", board.name, text.trim_end_matches(','));
            // Faster code must not call a library either.
            tools.compiled(&folder, board, &sources(&folder), &["-O3".into()]);
            tools.bytes(&folder, board, &parts.map(|part| part.1).concat());
        }
    }
}

#[test]
fn a_step_takes_few_instructions() {
    let Some(tools) = Tools::new("a_step_takes_few_instructions") else { return };
    for lattice in Lattice::ALL {
        let map = Map::random(lattice, 24, 24, 0.2, 5).unwrap();
        let (from, to) = (map.free().next().unwrap(), map.free().last().unwrap());
        let folder = written(&format!("count_{lattice}"), &map, None);
        std::fs::write(folder.join("count.c"), include_str!("count.c")).unwrap();
        for board in [M0, M4] {
            let files = [sources(&folder), vec!["examples/startup.c".into()]].concat();
            tools.compiled(&folder, board, &files, &[]);
            let trace = |what: u32| {
                let more = [&task(from, to)[..], &[format!("-DWHAT={what}")]].concat();
                tools.compiled(&folder, board, &["count.c".into()], &more);
                let objects = [objects(&folder), vec!["count.o".into(), "startup.o".into()]].concat();
                let objects: Vec<&str> = objects.iter().map(String::as_str).collect();
                tools.linked(&folder, board, &objects, "count.elf");
                tools.trace(&folder, board, "count.elf")
            };
            let [nothing, spread, flooded, learns] = [0, 7, 6, 8].map(|what| trace(what).len());
            let each = |what: u32, without: usize| (trace(what).len() - without) as f64 / ROUNDS;
            let steps = trace(2);
            // With the loop around it.
            let longest = tools.longest(&folder, "count.elf", "ac_next", &steps);
            let step = (steps.len() - nothing) as f64 / ROUNDS;
            println!(
                "{lattice} {}: instructions a decision {:.1}, a step of the published rule {step:.1}, the same at most {longest}, \
                 a step of the wave {:.1}, a step of learning {:.1}, a clock of the player {:.1}; a wave over 24 x 24 {}",
                board.name,
                each(1, nothing),
                each(3, flooded),
                each(4, learns),
                each(5, nothing),
                flooded - spread
            );
            assert!(board.name != "M4" || longest <= 250, "{lattice}: {longest}");
        }
    }
}

/// As in `count.c`.
const ROUNDS: f64 = 200.0;

/// What the core does with the numbers of `decisions` in `board.c`.
fn decisions(lattice: Lattice) -> u32 {
    let sectors: Vec<Sector> = Sector::all(lattice).collect();
    let (mut state, mut sum) = (1u32, 2_166_136_261u32);
    for _ in 0..20_000 {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let window = state >> 8;
        let bits = circuits::neighbourhood(lattice, [0, 8, 16].map(|at| window >> at));
        let sector = (state >> 4 & 15) as usize;
        let sector = sectors[if sector < sectors.len() { sector } else { sector - 8 }];
        let number = match decide(lattice, sector, state >> 3 & 1 == 1, bits) {
            Decision::Move(dir) => dir.0.into(),
            Decision::Enclosed => 9,
        };
        sum = hashed(sum, number);
    }
    sum
}

fn hashed(sum: u32, word: u32) -> u32 {
    (sum ^ word).wrapping_mul(16_777_619)
}

/// On the board as on this machine as in the core; and it arrives.
fn replayed(tools: &Tools, test: &str, board: Board, map: &Map, from: Cell, to: Cell) {
    let lattice = map.lattice();
    let folder = written(&format!("{test}_{lattice}_{}", board.machine), map, None);
    std::fs::write(folder.join("board.c"), include_str!("board.c")).unwrap();
    let files = [sources(&folder), vec!["examples/startup.c".into(), "board.c".into()]].concat();
    tools.compiled(&folder, board, &files, &task(from, to));
    let objects = [objects(&folder), vec!["board.o".into(), "startup.o".into()]].concat();
    let objects: Vec<&str> = objects.iter().map(String::as_str).collect();
    tools.linked(&folder, board, &objects, "board.elf");
    let said = tools.emulated(&folder, board, "board.elf", &[]);

    let mut expected = format!("decisions 0 20000 {}\n", decisions(lattice));
    for rule in [Rule::Wave, Rule::Learning, Rule::Published] {
        let line = said.lines().find(|line| line.starts_with(rule.name())).unwrap_or_default();
        let route = map.route(rule, from, to, 1 << 24).unwrap();
        let sum = route.dirs().fold(0, |sum, dir| hashed(sum, dir.0.into()));
        match rule {
            // Of shortest ways the firmware has another one.
            Rule::Wave => assert!(line.starts_with(&format!("wave 8 {} ", route.steps())), "{said}"),
            Rule::Published if route.outcome() == Outcome::Trapped => {
                assert!(line.starts_with("published 10 "), "{said}");
            }
            _ => {
                let end = if route.outcome() == Outcome::Arrived { 8 } else { 9 };
                let name = rule.name();
                let _ = writeln!(expected, "{name} {end} {} {sum}", route.steps());
            }
        }
    }
    assert!(expected.lines().all(|line| said.lines().any(|other| other == line)), "{said}\n{expected}");
    println!("{test} {lattice} on {}: {}", board.machine, said.trim().replace('\n', ", "));
    same_here(&folder, &said, from, to);
}

/// The same sources, compiled for this machine, say the same.
fn same_here(folder: &Path, said: &str, from: Cell, to: Cell) {
    let Some([gcc]) = common::programs("same_here", ["gcc"]) else { return };
    let host = "#include \"startup.h\"\n#include <stdio.h>\nvoid host_write(const char *text)\n{\n    (void)fputs(text, stdout);\n}\n\
        void host_write_number(uint32_t number)\n{\n    (void)printf(\"%lu\", (unsigned long)number);\n}\n";
    std::fs::write(folder.join("host.c"), host).unwrap();
    let files = [sources(folder), vec!["host.c".into(), "board.c".into()]].concat();
    common::run(
        common::command(&gcc, folder)
            .args(STRICT)
            .args(["-O2", "-o", "here"])
            .args(task(from, to))
            .args(files),
    );
    assert_eq!(common::run(&mut common::command(&folder.join("here"), folder)), *said);
}

#[test]
fn a_micro_bit_finds_its_way_through_the_warehouse() {
    let Some(tools) = Tools::new("a_micro_bit_finds_its_way") else { return };
    for lattice in Lattice::ALL {
        let map = warehouse(lattice);
        let (from, to) = (map.free().next().unwrap(), map.free().last().unwrap());
        replayed(&tools, "warehouse", M0, &map, from, to);
    }
}

#[test]
fn a_cortex_m4_finds_its_way_on_a_real_map() {
    let Some(tools) = Tools::new("a_cortex_m4_finds_its_way") else { return };
    for lattice in Lattice::ALL {
        let Some(map) = real_map("a_cortex_m4_finds_its_way", lattice, "lak303d.map") else { return };
        let reach = map.wave(map.free().next().unwrap()).unwrap();
        let ends = map.free().filter(|&cell| reach.steps(cell).is_some());
        let to = ends.max_by_key(|&cell| reach.steps(cell)).unwrap();
        replayed(&tools, "lak303d", M4, &map, map.free().next().unwrap(), to);
    }
}

/// The example for a board, as a user would build it: with `make`. Larger maps get a larger board; a map that none holds is
/// told of before anything is compiled.
#[test]
fn the_example_for_a_board_runs() {
    let Some(_) = Tools::new("the_example_for_a_board_runs") else { return };
    let Some([make]) = common::programs("the_example_for_a_board_runs", ["make"]) else { return };
    let robot = Robot::default();
    let large = Map::random(Lattice::Square, 256, 256, 0.1, 1).unwrap();
    let huge = Map::new(Lattice::Square, BitPlane::new(6000, 6000).unwrap());
    for (map, machine) in [
        (&warehouse(Lattice::Square), Some(M0)),
        (&warehouse(Lattice::Hex), Some(M0)),
        (&large, Some(M4)),
        (&huge, None),
    ] {
        let (from, to) = match machine {
            Some(_) => long_way(map).unwrap(),
            None => (Cell::new(0, 0), Cell::new(1, 0)),
        };
        let order = Order { map, from, to, robot: &robot, fixed_map: false, command: "" };
        let folder = common::folder(&format!("example_{}_{}", map.lattice(), map.width()));
        common::write(&folder, &generate(Language::C, Some(&order)).unwrap().files);
        let output = common::command(&make, &folder).arg("board").output().unwrap();
        // What the board says comes out among the errors.
        let said = String::from_utf8_lossy(&output.stderr);
        let Some(board) = machine else {
            assert!(
                !output.status.success() && said.contains("no board:") && said.contains("of RAM"),
                "{said}"
            );
            continue;
        };
        assert!(output.status.success(), "{said}");
        let [first, last] = [from, to].map(|cell| cell.to_string());
        assert!(
            said.contains(&format!("wave: {first}")) && said.ends_with(&format!("{last} arrived\n")),
            "{said}"
        );
        assert!(String::from_utf8_lossy(&output.stdout).contains(&format!("-M {} ", board.machine)));
    }
}
