//! `simulate`, run as a user runs it.

#![expect(clippy::unwrap_used, reason = "a test that cannot start the command should stop")]

mod common;

use common::run;
use serde_json::Value;
use std::fs;
use std::path::Path;

fn json(folder: &Path, arguments: &str) -> Value {
    common::json(folder, arguments, &[0, 3])
}

/// A folder with a floor and its run on each lattice.
fn stage() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::write(path.join("floor.txt"), "S.......\n###.####\n.......F\n").unwrap();
    fs::write(path.join("real.txt"), "........\n###.####\n....#...\n").unwrap();
    fs::write(path.join("shut.txt"), "........\n########\n........\n").unwrap();
    fs::write(path.join("open.txt"), "........\n........\n........\n........\n").unwrap();
    for lattice in ["square", "hex"] {
        for rule in ["wave", "learning", "published"] {
            let save = format!(
                "route floor.txt --resolution 0.5 --lattice {lattice} --rule {rule} --from S --to F --save {lattice}-{rule}.json"
            );
            let (code, _, stderr) = run(path, &save);
            assert!(code == 0 || code == 3, "{stderr}");
        }
    }
    folder
}

#[test]
fn both_modes_give_the_same_bytes_on_any_number_of_threads() {
    let folder = stage();
    let path = folder.path();
    for lattice in ["square", "hex"] {
        for mode in ["offline", "task --missing 0.2"] {
            let base =
                format!("simulate {lattice}-wave.json --mode {mode} --trials 40 --json -q --save trace.json");
            let one = (run(path, &format!("{base} --threads 1")), fs::read(path.join("trace.json")).unwrap());
            let three =
                (run(path, &format!("{base} --threads 3")), fs::read(path.join("trace.json")).unwrap());
            assert_eq!(one, three, "{lattice} {mode}");
            let other = run(path, &format!("{base} --seed 2"));
            assert_ne!(one.0, other);
            let trace: Value = serde_json::from_slice(&one.1).unwrap();
            assert_eq!((&trace["activecell"], &trace["version"]), (&"trace".into(), &1.into()));
        }
    }
}

#[test]
fn a_world_that_the_map_does_not_tell_is_found_out() {
    let folder = stage();
    let path = folder.path();
    for run_file in ["square-wave", "hex-wave", "square-learning", "hex-learning"] {
        let report =
            json(path, &format!("simulate {run_file}.json --mode task --world real.txt --trials 5 --json"));
        let square = run_file.starts_with("square");
        // In the lower row of squares the obstacle shuts the only way; hexagons have another... none either.
        let reachable = report["reachable"].as_bool().unwrap();
        assert_eq!(
            report[if reachable { "arrived" } else { "unreachable" }],
            5,
            "{run_file} {square} {report}"
        );
        assert_eq!(report["contacts"], 0);
        let report = json(
            path,
            &format!("simulate {run_file}.json --mode task --world shut.txt --json --save t.json"),
        );
        assert_eq!((&report["unreachable"], &report["reachable"]), (&1.into(), &false.into()));
        let trace: Value = serde_json::from_slice(&fs::read(path.join("t.json")).unwrap()).unwrap();
        let ticks = trace["ticks"].as_array().unwrap();
        for key in
            ["time_s", "truth", "estimate", "deviation", "readings_m", "inputs", "state", "cell", "closed"]
        {
            assert!(ticks.iter().all(|tick| !tick[key].is_null()), "{key}");
        }
        assert!(
            ticks.iter().any(|tick| tick["closed"].as_array().unwrap().contains(&serde_json::json!([3, 1])))
        );
        // It comes, and goes again: the door opens after 20 s.
        let report = json(path, &format!("simulate {run_file}.json --mode task --appear 3,1@0..20 --json"));
        assert_eq!((&report["arrived"], &report["contacts"]), (&1.into(), &0.into()), "{run_file}");
    }
}

#[test]
fn pictures_are_drawn() {
    let folder = stage();
    let path = folder.path();
    for mode in ["offline", "task --missing 0.1"] {
        let arguments = format!(
            "simulate hex-wave.json --mode {mode} --picture a.svg --picture a.png --picture a.gif -q"
        );
        let (code, _, stderr) = run(path, &arguments);
        assert!(code == 0 || code == 3, "{stderr}");
        assert!(fs::read(path.join("a.svg")).unwrap().starts_with(b"<svg"));
        assert!(fs::read(path.join("a.png")).unwrap().starts_with(b"\x89PNG"));
        assert!(fs::read(path.join("a.gif")).unwrap().starts_with(b"GIF89a"));
    }
}

#[test]
fn what_cannot_be_simulated_is_told_in_one_line() {
    let folder = stage();
    let path = folder.path();
    fs::write(path.join("wide.toml"), "radius_m = 0.3\n").unwrap();
    fs::write(path.join("noise.json"), "{\"activecell\":\"run\",\n \"version\":").unwrap();
    let cases = [
        ("simulate none.json", 1, "none.json: there is no such file"),
        ("simulate noise.json", 1, "noise.json line 2, column 11: not a run file"),
        ("simulate floor.txt", 1, "not a run file"),
        ("simulate square-wave.json --mode task --robot wide.toml", 1, "use cells of at least"),
        ("simulate square-wave.json --world open.txt", 1, "the world has 8 x 4 cells, the run's map 8 x 3"),
        ("simulate square-wave.json --picture a.bmp", 2, "must end in .svg, .png or .gif"),
        ("simulate square-wave.json --appear 0,1@1..2", 2, "no free cell of the world"),
        ("simulate square-wave.json --appear 0,1", 2, ""),
        ("simulate square-wave.json --missing 2", 2, ""),
        ("simulate square-wave.json --trials 0", 2, ""),
        ("simulate square-published.json --mode task", 1, "`published` has no memory"),
    ];
    for (arguments, code, expected) in cases {
        let (found, stdout, stderr) = run(path, arguments);
        assert_eq!((found, stdout.as_str()), (code, ""), "{arguments}: {stderr}");
        assert!(stderr.contains(expected), "{arguments}: {stderr}");
        assert!(expected.is_empty() || stderr.lines().count() == 1, "{stderr}");
    }
}
