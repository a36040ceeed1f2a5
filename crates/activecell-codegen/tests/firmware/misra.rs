//! MISRA C:2012, as far as cppcheck knows it; and the examples, without a warning.

use crate::{STRICT, common, sources, warehouse, written};
use activecell::{Drive, Lattice, Map, Robot};
use activecell_codegen::model::player::{Motion, Segment};
use activecell_codegen::{Language, Order, generate, long_way};
use std::collections::BTreeSet;
use std::path::Path;

/// Advisory rules that the firmware does not follow, and why.
const DEVIATIONS: [(&str, &str); 2] = [
    ("2.5", "a firmware need not use all words of the header: macros that it does not"),
    (
        "8.7",
        "functions of the header are for others: with external linkage, also if no other file here calls them",
    ),
];

const PROGRAM: [Segment; 2] =
    [Segment { motion: Motion::Forward, ticks: 3 }, Segment { motion: Motion::Left, ticks: u32::MAX }];

#[test]
fn misra_finds_named_deviations_only() {
    let Some([cppcheck]) = common::programs("misra", ["cppcheck"]) else { return };
    for lattice in Lattice::ALL {
        let folder = written(&format!("misra_{lattice}"), &warehouse(lattice), Some(&PROGRAM));
        let mut command = common::command(&cppcheck, &folder);
        let output = command
            .args(["--std=c99", "--addon=misra", "--error-exitcode=0", "-q", "-Iinclude"])
            .args(["--template={file}:{line} {id}"])
            .args(sources(&folder))
            .output()
            .unwrap();
        let text = String::from_utf8_lossy(&output.stderr);
        let findings: Vec<&str> = text.lines().filter(|line| !line.is_empty()).collect();
        let rule = |line: &str| line.split("misra-c2012-").nth(1).map(str::to_owned);
        let others: Vec<&&str> = findings
            .iter()
            .filter(|line| rule(line).is_none_or(|rule| DEVIATIONS.iter().all(|(known, _)| rule != *known)))
            .collect();
        assert!(others.is_empty(), "{lattice}: {others:#?}");
        let rules: BTreeSet<String> = findings.iter().filter_map(|line| rule(line)).collect();
        println!("{lattice}: {} findings of MISRA, all of {rules:?}", findings.len());
    }
}

#[test]
fn programs_in_other_standards_can_include_the_header() {
    let folder = written("header", &warehouse(Lattice::Hex), Some(&PROGRAM));
    let use_it = "#include \"activecell.h\"\nac_cell there(void);\nac_cell there(void) { return ac_neighbour(ac_cell(), AC_E); }\n";
    std::fs::write(folder.join("user.cpp"), use_it).unwrap();
    let Some([cpp]) = common::programs("programs_in_other_standards", ["g++"]) else { return };
    for standard in ["-std=c++11", "-std=c++20"] {
        let strict = [standard, "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror", "-Iinclude"];
        common::run(common::command(&cpp, &folder).args(strict).args(["-c", "user.cpp"]));
    }
    let Some([gcc]) = common::programs("programs_in_other_standards", ["gcc"]) else { return };
    for standard in ["-std=c11", "-std=c17", "-std=gnu99"] {
        let strict = STRICT.map(|flag| if flag == "-std=c99" { standard } else { flag });
        common::run(common::command(&gcc, &folder).args(strict).arg("-c").args(sources(&folder)));
    }
}

/// Without a map: the headers of the rule, each alone and all in one file, in C and in C++.
#[test]
fn headers_of_the_rule_alone_are_compiled_without_a_warning() {
    let folder = common::folder("headers");
    let files = generate(Language::C, None).unwrap().files;
    common::write(&folder, &files);
    let headers: Vec<&str> = files.iter().filter_map(|file| file.path.strip_prefix("include/")).collect();
    assert_eq!(headers.len(), 6, "{headers:?}");
    for file in files.iter().filter(|file| file.path.starts_with("include/")) {
        let text = file.text.split_once('\n').map_or("", |(_licence, text)| text);
        assert!(text.starts_with("/*\n * "), "{}: the first comment says what it is", file.path);
    }
    let include = |names: &[&str]| {
        names.iter().map(|name| format!("#include \"{name}\"\n")).collect::<Vec<_>>().concat()
    };
    let mut users: Vec<String> = headers.iter().map(|&name| include(&[name])).collect();
    users.push(include(&headers));
    let cpp = ["-std=c++11", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror", "-Iinclude"];
    for (compiler, flags, ending) in [("gcc", &STRICT[..], "c"), ("g++", &cpp[..], "cpp")] {
        let Some([compiler]) = common::programs("headers_of_the_rule_alone", [compiler]) else { continue };
        for text in &users {
            let name = format!("user.{ending}");
            std::fs::write(folder.join(&name), text).unwrap();
            common::run(common::command(&compiler, &folder).args(flags).args(["-c", &name]));
        }
        println!("{}: {} headers, each alone and together", compiler.display(), headers.len());
    }
    let Some([gcc]) = common::programs("headers_of_the_rule_alone", ["gcc"]) else { return };
    common::run(common::command(&gcc, &folder).args(STRICT).args(["-o", "rules", "examples/rules.c"]));
    let said = common::run(&mut common::command(&folder.join("rules"), &folder));
    assert_eq!(said, "lane 1, then state 1 with q1: forward\n");
}

/// Compiles and runs the plain example, which checks itself: whether it found all right, and what it said.
fn plain(gcc: &Path, folder: &Path, level: &str) -> (bool, String) {
    example(gcc, folder, "main", level)
}

/// The same with any example.
fn example(gcc: &Path, folder: &Path, name: &str, level: &str) -> (bool, String) {
    let files = [sources(folder), vec![format!("examples/{name}.c")]].concat();
    common::run(common::command(gcc, folder).args(STRICT).args([level, "-o", name]).args(files));
    let output = common::command(&folder.join(name), folder).output().unwrap();
    (output.status.success(), String::from_utf8_lossy(&output.stdout).into_owned())
}

#[test]
fn a_plain_program_is_compiled_without_a_warning_and_runs() {
    let Some([gcc]) = common::programs("a_plain_program", ["gcc"]) else { return };
    for lattice in Lattice::ALL {
        let folder = written(&format!("plain_{lattice}"), &warehouse(lattice), None);
        for level in ["-O0", "-Os", "-O3"] {
            let (is_right, said) = plain(&gcc, &folder, level);
            assert!(
                is_right && said.contains("learning: arrived after") && said.contains("\nPASS"),
                "{said}"
            );
        }
    }
}

/// The control loop with its simulated robot: on random floors, for both drives; an encoder that is too coarse is told of.
#[test]
fn the_control_loop_arrives_past_an_obstacle_that_the_map_does_not_know() {
    let Some([gcc]) = common::programs("the_control_loop", ["gcc"]) else { return };
    let mut surprised = 0;
    for (number, lattice) in Lattice::ALL.into_iter().cycle().take(12).enumerate() {
        let drive = if number % 4 < 2 { Drive::Differential } else { Drive::Steered };
        let coarse = number >= 8;
        let ticks_per_rev = if coarse { 0.3 } else { 3.7 * (number + 1) as f64 };
        let robot = Robot { drive, ticks_per_rev, ..Robot::default() };
        let map = Map::random(lattice, 24, 20, 0.2, number as u64).unwrap();
        let folder = common::folder(&format!("robot_{number}"));
        let (from, to) = long_way(&map).unwrap();
        let order = Order { map: &map, from, to, robot: &robot, fixed_map: false, command: "" };
        common::write(&folder, &generate(Language::C, Some(&order)).unwrap().files);
        let (is_right, said) = example(&gcc, &folder, "robot", "-O2");
        let expected = if coarse { "NOT RUN" } else { "arrived after" };
        assert!(is_right && said.contains(expected), "{lattice} {drive:?} {number}: {said}");
        surprised += usize::from(said.contains("not on the map: 1"));
    }
    assert!(surprised > 5);
    println!("8 floors: the control loop arrives, on {surprised} past an obstacle that it did not know of");
}

/// The Makefile and the README of a whole folder: warnings are errors if asked, other flags and changes build anew, what is
/// missing is told; and the README's examples are C.
#[test]
fn make_builds_what_it_should() {
    let Some([gcc, make]) = common::programs("make_builds", ["gcc", "make"]) else { return };
    let map = warehouse(Lattice::Hex);
    let (from, to) = long_way(&map).unwrap();
    let order = Order { map: &map, from, to, robot: &Robot::default(), fixed_map: false, command: "" };
    let folder = common::folder("make");
    let files = generate(Language::C, Some(&order)).unwrap().files;
    common::write(&folder, &files);
    let making = |arguments: &[&str]| {
        let output = common::command(&make, &folder).args(arguments).output().unwrap();
        let [said, warned] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text));
        (output.status.success(), format!("{said}{warned}"))
    };
    let compilations = |said: &str| said.matches(" -o build/").count();
    for (arguments, expected) in [
        (&["sim", "STRICT=1", "CC=gcc"][..], 2),
        (&["sim", "STRICT=1", "CC=gcc"], 0),
        (&["sim", "CC=gcc", "CFLAGS=-g -O1 -DMINE=1", "LDFLAGS=-Wl,-s"], 2),
    ] {
        let (is_right, said) = making(arguments);
        assert!(is_right && said.contains("\nPASS") && said.contains("PASS: the robot arrived"), "{said}");
        assert_eq!(compilations(&said), expected, "{said}");
        assert_eq!(said.contains("-DMINE=1"), said.contains("-Wl,-s"));
        assert_eq!(said.contains("-Werror"), expected == 2 && arguments.contains(&"STRICT=1"));
    }
    std::fs::write(folder.join("src/ac_map.c"), "not C\n").unwrap();
    assert!(!making(&["sim"]).0, "a change builds anew");
    let (is_right, said) = making(&["sim", "CC=no-such-compiler"]);
    assert!(!is_right && said.contains("no-such-compiler was not found: install it"), "{said}");

    let readme = &files.iter().find(|file| file.path == "README.md").unwrap().text;
    let examples: Vec<&str> =
        readme.split("```c\n").skip(1).map(|text| text.split("```").next().unwrap()).collect();
    assert_eq!(examples.len(), 2);
    for text in examples {
        std::fs::write(folder.join("readme.c"), text).unwrap();
        let flags = STRICT.iter().filter(|flag| **flag != "-Wmissing-prototypes");
        common::run(common::command(&gcc, &folder).args(flags).args(["-c", "readme.c"]));
    }
}

/// A robot that is there already, on a floor of one cell, and one that has ways shorter than a tick.
#[test]
fn an_empty_program_is_firmware_like_any_other() {
    let Some([gcc]) = common::programs("an_empty_program", ["gcc"]) else { return };
    for lattice in Lattice::ALL {
        for (name, floor) in [("one", "."), ("short", "...\n.#.")] {
            let map = Map::parse(lattice, floor).unwrap();
            let folder = written(&format!("empty_{name}_{lattice}"), &map, Some(&[]));
            let (is_right, said) = plain(&gcc, &folder, "-O2");
            assert!(is_right && said.contains("program: 0 segments"), "{said}");
            let (is_right, said) = example(&gcc, &folder, "robot", "-O2");
            assert!(is_right && said.contains("PASS: the robot arrived"), "{said}");
        }
    }
}

/// The plain example finds each of these.
#[test]
fn tampered_firmware_is_found() {
    let Some([gcc]) = common::programs("tampered_firmware", ["gcc"]) else { return };
    let rules: [&[(&str, &str)]; 2] = [
        &[("ring1 ^ 0x0FU", "ring1 ^ 0x0EU"), ("(0U - clockwise)", "(1U - clockwise)")],
        &[("ring1 ^ 0x3FU", "ring1 ^ 0x1FU"), ("(0U - clockwise)", "(1U - clockwise)")],
    ];
    for (lattice, rules) in Lattice::ALL.into_iter().zip(rules) {
        let rules = rules.iter().map(|&(right, wrong)| ("src/ac_rule.c", right, wrong, "ac_decide"));
        let others = [
            ("src/ac_map.c", "0x00000003U", "0x00010003U", "the wave's way"),
            ("src/ac_wave.c", "wave->first = row;", "wave->first = row + 2U;", "the wave's way"),
            ("src/ac_drive.c", "player->segment += 1U", "player->segment += 2U", "the player"),
        ];
        for (number, (file, right, wrong, what)) in rules.chain(others).enumerate() {
            let map = Map::parse(lattice, "..............................\n".repeat(2).trim()).unwrap();
            let folder = written(&format!("tampered_{lattice}_{number}"), &map, None);
            let text = std::fs::read_to_string(folder.join(file)).unwrap();
            assert!(text.contains(right), "{file}: {right}\n{text}");
            std::fs::write(folder.join(file), text.replace(right, wrong)).unwrap();
            let (is_right, said) = plain(&gcc, &folder, "-O1");
            assert!(!is_right && said.contains(&format!("FAIL: {what}")), "{lattice} {wrong}: {said}");
        }
    }
}
