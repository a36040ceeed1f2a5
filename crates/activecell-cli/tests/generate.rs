//! `generate`, run as a user runs it: the folders it writes build and simulate; what cannot be is told in one line.

#![expect(clippy::unwrap_used, reason = "a test that cannot start the command should stop")]

mod common;

use common::run;
use std::fs;
use std::path::Path;
use std::process::Command;

const FLOOR: &str = "S....#..\n.##..#..\n.#......\n...#..#.\n.#....#F\n";

/// Runs `make` in a folder if these programs are there; says loudly if not.
fn make(test: &str, folder: &Path, target: &str, programs: &[&str]) -> Option<String> {
    let is_there = |name: &&str| {
        let path = std::env::var_os("PATH").unwrap_or_default();
        std::env::split_paths(&path).any(|folder| folder.join(name).is_file())
    };
    if let Some(missing) = programs.iter().find(|name| !is_there(name)) {
        eprintln!("NOT RUN: {test}: make {target} needs {missing}; `make deps` installs it");
        return None;
    }
    let output = Command::new("make").arg(target).current_dir(folder).output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{target}: {said}{}", String::from_utf8_lossy(&output.stderr));
    Some(said)
}

#[test]
fn every_folder_simulates() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::write(path.join("floor.txt"), FLOOR).unwrap();
    for lattice in ["square", "hex"] {
        for (language, programs) in
            [("c", &["cc"][..]), ("verilog", &["iverilog", "vvp"]), ("vhdl", &["ghdl"])]
        {
            for more in if language == "c" { &[""][..] } else { &["", "--fixed-map"] } {
                let out = format!("{language}-{lattice}{more}");
                let arguments = format!(
                    "generate {language} floor.txt --lattice {lattice} --from S --to F -o {out} {more}"
                );
                let (code, stdout, stderr) = run(path, &arguments);
                assert_eq!((code, stderr.as_str()), (0, ""), "{arguments}");
                assert!(stdout.starts_with(&format!("{language}: ")), "{stdout}");
                let readme = fs::read_to_string(path.join(&out).join("README.md")).unwrap();
                assert!(!readme.contains('@') && readme.contains("(0,0) to (7,4)"), "{readme}");
                let Some(said) = make("every_folder_simulates", &path.join(&out), "sim", programs) else {
                    continue;
                };
                if language == "c" {
                    assert!(said.contains("wave: (0,0)") && said.contains("(7,4) arrived"), "{said}");
                    assert!(said.contains("PASS"), "{said}");
                } else {
                    assert_eq!(said.matches("PASS").count(), 3, "{said}");
                }
                println!("{out}: make sim passes");
            }
        }
    }
}

/// The example of the firmware checks what it was generated from.
#[test]
fn make_sim_finds_a_tampered_rule() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::write(path.join("floor.txt"), FLOOR).unwrap();
    // A program without a step is firmware, too.
    for (from, to) in [("7,4", "0,4"), ("2,2", "2,2")] {
        let out = format!("firmware-{from}");
        let (code, _, stderr) = run(path, &format!("generate c floor.txt --from {from} --to {to} -o {out}"));
        assert_eq!((code, stderr.as_str()), (0, ""));
        let out = path.join(out);
        let Some(said) = make("make_sim_finds_a_tampered_rule", &out, "sim", &["cc"]) else { return };
        assert!(
            said.contains(&format!("wave: ({from})")) && said.contains(&format!("({to}) arrived")),
            "{said}"
        );
        let rule = fs::read_to_string(out.join("src/ac_rule.c")).unwrap();
        assert!(rule.contains("ring1 ^ 0x0FU"));
        fs::write(out.join("src/ac_rule.c"), rule.replace("ring1 ^ 0x0FU", "ring1 ^ 0x0EU")).unwrap();
        let output = Command::new("make").arg("sim").current_dir(&out).output().unwrap();
        let said = String::from_utf8_lossy(&output.stdout);
        assert!(!output.status.success() && said.contains("FAIL: ac_decide"), "{said}");
    }
}

#[test]
fn the_report_names_files_that_are_there_and_the_same_twice() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::write(path.join("floor.txt"), FLOOR).unwrap();
    for language in ["c", "verilog", "vhdl"] {
        for map in ["floor.txt", ""] {
            let report =
                common::json(path, &format!("generate {language} {map} -o {language}{map} --json"), &[0]);
            let files = report["files"].as_array().unwrap();
            assert!(files.len() > 5 && report["language"] == language);
            let read = |folder: &str| -> Vec<String> {
                let file = |name: &serde_json::Value| path.join(folder).join(name.as_str().unwrap());
                files.iter().map(|name| fs::read_to_string(file(name)).unwrap()).collect()
            };
            let first = read(&format!("{language}{map}"));
            run(path, &format!("generate {language} {map} -o again"));
            assert_eq!(first, read("again"), "same map, same bytes");
            fs::remove_dir_all(path.join("again")).unwrap();
            assert_eq!(report["sizes"].as_array().unwrap().is_empty(), map.is_empty());
        }
    }
}

#[test]
fn what_cannot_be_generated_is_told_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::write(path.join("floor.txt"), FLOOR).unwrap();
    fs::write(path.join("split.txt"), "S#F\n").unwrap();
    fs::write(path.join("full.txt"), "##\n").unwrap();
    fs::write(path.join("file"), "").unwrap();
    fs::write(path.join("large.txt"), format!("{}\n", ".".repeat(100)).repeat(100)).unwrap();
    for (arguments, code, what) in [
        ("verilog split.txt --from S --to F -o out", 1, "no way leads from (0,0)"),
        ("verilog full.txt -o out", 1, "the number of free cells is 0"),
        ("verilog floor.txt --from 1,1 --to F -o out", 1, "obstacle"),
        ("verilog floor.txt --from 9,9 --to F -o out", 1, "(9,9)"),
        ("verilog none.txt -o out", 1, "none.txt"),
        ("c floor.txt -o file", 1, "name a folder"),
        ("c --lattice hex -o out", 2, "need a MAP"),
        ("c floor.txt --fixed-map -o out", 2, "C has no fabric"),
        ("c floor.txt", 2, "--output"),
        ("ada floor.txt -o out", 2, "ada"),
        ("c floor.txt --from S -o out", 2, "--to"),
        ("c --robot robot.toml -o out", 2, "MAP"),
    ] {
        let (got, stdout, stderr) = run(path, &format!("generate {arguments}"));
        assert_eq!((got, stdout.as_str()), (code, ""), "{arguments}: {stderr}");
        assert!(stderr.contains(what), "{arguments}: {stderr}");
        assert!(code == 2 || stderr.lines().count() == 1, "{arguments}: {stderr}");
        assert!(!path.join("out").exists(), "{arguments}: nothing is written");
    }
    let (code, _, stderr) = run(path, "generate verilog large.txt -o out");
    assert_eq!(code, 0);
    assert!(stderr.contains("the fabric is left out") && stderr.lines().count() == 1, "{stderr}");
    assert!(path.join("out/rtl/windowed_square.v").exists() && !path.join("out/rtl/fabric.v").exists());
}
