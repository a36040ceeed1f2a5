//! `generate`, run as a user runs it: the folders it writes build and simulate; what cannot be is told in one line.

#![expect(clippy::unwrap_used, reason = "a test that cannot start the command should stop")]

mod common;

use common::run;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

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
    let output = Command::new("make").args([target, "STRICT=1"]).current_dir(folder).output().unwrap();
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
                if language == "verilog" {
                    let compile = "iverilog -g2012 -Wall -Wno-timescale -o build/all.vvp rtl/*.v tb/*.v";
                    let output =
                        Command::new("sh").args(["-c", compile]).current_dir(path.join(&out)).output();
                    let said = String::from_utf8(output.unwrap().stderr).unwrap();
                    assert_eq!(said, "", "as SystemVerilog, whose words are more");
                }
                if language != "c" {
                    assert!(make("every_folder_simulates", &path.join(&out), "example", programs).is_some());
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

/// Every file and folder below a folder; of files what they hold.
fn everything(folder: &Path) -> BTreeMap<PathBuf, Option<Vec<u8>>> {
    let mut all = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            all.extend(everything(&path));
        }
        all.insert(path.clone(), fs::read(&path).ok());
    }
    all
}

/// A floor, and another of another size.
fn two_floors() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("floor.txt"), FLOOR).unwrap();
    fs::write(folder.path().join("other.txt"), "...\n.#.\n").unwrap();
    folder
}

#[test]
fn a_write_that_fails_leaves_all_as_it_was() {
    let folder = two_floors();
    let path = folder.path();
    assert_eq!(run(path, "generate verilog floor.txt -o out").0, 0);
    let refused = |what: &str| {
        let before = everything(path);
        let (code, stdout, stderr) = run(path, "generate verilog other.txt -o out");
        assert_eq!((code, stdout.as_str(), stderr.lines().count()), (1, "", 1), "{stderr}");
        assert!(stderr.contains(what), "{stderr}");
        assert!(everything(path) == before, "{what}");
    };
    // The last file cannot be written, then the folder of the first.
    fs::remove_file(path.join("out/README.md")).unwrap();
    fs::create_dir(path.join("out/README.md")).unwrap();
    refused("out/README.md: this is a folder");
    fs::remove_dir_all(path.join("out")).unwrap();
    fs::create_dir(path.join("out")).unwrap();
    fs::write(path.join("out/tb"), "a user's file").unwrap();
    refused("out/tb: this is a file where a folder must be");
}

/// A limit on file sizes stands for the full disk; the signal that comes with it is ignored by the shell.
#[cfg(unix)]
#[test]
fn a_full_disk_leaves_all_as_it_was() {
    let folder = two_floors();
    let path = folder.path();
    for before in ["nothing", "another generation"] {
        if before != "nothing" {
            assert_eq!(run(path, "generate vhdl other.txt --lattice hex -o out").0, 0);
        }
        let before = everything(path);
        let output = Command::new("sh")
            .args(["-c", "trap '' XFSZ; ulimit -f 8; exec \"$0\" generate verilog floor.txt -o out"])
            .arg(env!("CARGO_BIN_EXE_activecell"))
            .current_dir(path)
            .output()
            .unwrap();
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!((output.status.code(), stderr.lines().count()), (Some(1), 1), "{stderr}");
        assert!(stderr.contains("out/"), "{stderr}");
        assert!(everything(path) == before);
    }
}

#[test]
fn generations_at_once_end_with_whole_files() {
    let folder = two_floors();
    let path = folder.path();
    for out in ["floor", "other"] {
        assert_eq!(run(path, &format!("generate verilog {out}.txt -o {out}")).0, 0);
    }
    let start = |floor: &str| {
        Command::new(env!("CARGO_BIN_EXE_activecell"))
            .args(["generate", "verilog", floor, "-o", "both", "-q"])
            .current_dir(path)
            .stdout(Stdio::null())
            .spawn()
            .unwrap()
    };
    for _ in 0..3 {
        for mut run in ["floor.txt", "other.txt", "floor.txt"].map(start) {
            assert!(run.wait().unwrap().success());
        }
        let both = everything(&path.join("both"));
        assert_eq!(both.len(), everything(&path.join("floor")).len());
        for (file, text) in both {
            let name = file.strip_prefix(path.join("both")).unwrap();
            let is_of = |out: &str| fs::read(path.join(out).join(name)).ok() == text;
            assert!(is_of("floor") || is_of("other"), "{}", name.display());
        }
    }
}

#[test]
fn what_an_earlier_generation_left_is_removed_but_no_file_of_a_user() {
    let folder = two_floors();
    let path = folder.path();
    assert_eq!(run(path, "generate verilog floor.txt -o alone").0, 0);
    let (_, _, stderr) = run(path, "generate c floor.txt -o out");
    assert_eq!(stderr, "");
    fs::write(path.join("outside"), "").unwrap();
    fs::write(path.join("out/src/mine.c"), "").unwrap();
    fs::write(path.join("out/examples/main.c"), "edited").unwrap();
    // A list can name what it likes.
    let list = path.join("out/.activecell-generated");
    let listed = fs::read_to_string(&list).unwrap();
    let files = listed.lines().count() - 1;
    fs::write(&list, listed + "cbf29ce484222325 ../outside\ncbf29ce484222325 src/none.c\nnonsense\n")
        .unwrap();
    let (code, _, stderr) = run(path, "generate verilog floor.txt -o out");
    // README and Makefile are written again, one file was edited.
    let expected = format!(
        "activecell: note: removed of an earlier generation: {} files\n\
         activecell: note: of an earlier generation, but edited, so left: examples/main.c\n",
        files - 3
    );
    assert_eq!((code, stderr), (0, expected));
    assert!(path.join("outside").exists());
    assert!(!path.join("out/include").exists(), "an empty folder");
    for mine in ["src/mine.c", "examples/main.c"] {
        fs::remove_file(path.join("out").join(mine)).unwrap();
        fs::remove_dir(path.join("out").join(mine).parent().unwrap()).unwrap();
    }
    let [out, alone] = ["out", "alone"].map(|folder| {
        let all = everything(&path.join(folder));
        let inside = |file: &PathBuf| file.strip_prefix(path.join(folder)).unwrap().to_owned();
        all.iter().map(|(file, text)| (inside(file), text.clone())).collect::<BTreeMap<_, _>>()
    });
    assert!(out == alone, "as in a new folder");
    // A list that is not ours is none.
    fs::write(&list, "cbf29ce484222325 empty\n").unwrap();
    fs::write(path.join("out/empty"), "").unwrap();
    assert_eq!(run(path, "generate verilog floor.txt -o out").2, "");
    assert!(path.join("out/empty").exists());
}

#[test]
fn what_the_program_leaves_out_is_told() {
    let folder = two_floors();
    let path = folder.path();
    fs::write(path.join("coarse.toml"), "ticks_per_rev = 1\nwheel_perimeter_m = 3.0\n").unwrap();
    for language in ["c", "verilog"] {
        let (code, _, stderr) =
            run(path, &format!("generate {language} floor.txt --robot coarse.toml -o out-{language}"));
        assert_eq!((code, stderr.lines().count()), (0, 1), "{stderr}");
        assert!(stderr.contains("left out of the program, because shorter than an encoder tick"), "{stderr}");
    }
}
