//! `simulate` of plans, run as a user runs it.

#![expect(clippy::unwrap_used, reason = "a test that cannot start the command should stop")]

mod common;

use common::{json, run};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// A folder with a map and a plan in which three of four robots go around a ring, on each lattice, with the map inside
/// (`.json`) and beside (`.txt`).
fn stage() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::write(path.join("floor.txt"), "...\n...\n").unwrap();
    fs::write(path.join("square.txt"), plan("(0,0),(1,0),(1,1),(0,1)", "(1,0),(1,1),(0,1),(0,0)")).unwrap();
    let hex = r#"{"activecell": "plan", "version": 1, "lattice": "hex", "map_file": "floor.txt", "steps": 1, "robots": [
        {"start": [0, 0], "moves": "E"}, {"start": [1, 0], "moves": "SW"}, {"start": [0, 1], "moves": "NW"}]}"#;
    fs::write(path.join("hex.json"), hex).unwrap();
    folder
}

fn plan(starts: &str, ends: &str) -> String {
    format!(
        "agents=4\nmap_file=floor.txt\nstarts={starts},\ngoals={ends},\nsolution=\n0:{starts},\n1:{ends},\n"
    )
}

#[test]
fn plans_are_executed_whoever_is_late_and_the_seed_decides() {
    let folder = stage();
    let path = folder.path();
    for (file, robots) in [("square.txt", 4), ("hex.json", 3)] {
        let report = json(path, &format!("simulate {file} --delay-chance 0 --json"), &[0]);
        for (key, value) in
            [("mode", "plan".into()), ("robots", robots.into()), ("rings", 1.into()), ("arrived", 1.into())]
        {
            assert_eq!(report[key], Value::clone(&value), "{file} {key}");
        }
        assert_eq!((&report["makespan"]["most"], &report["planned_makespan"]), (&1.0.into(), &1.into()));

        let base = format!(
            "simulate {file} --delay-chance 0.5 --max-delay 9 --slow 0.5 --slow-speed 0.2 --stop 1@0:30 --lost-reports 0.5 --turning --trials 50 --json"
        );
        let one = run(path, &format!("{base} --threads 1"));
        assert_eq!(one, run(path, &format!("{base} --threads 3")));
        assert_ne!(one, run(path, &format!("{base} --seed 2")));
        let report: Value = serde_json::from_str(&one.1).unwrap();
        assert_eq!((one.0, &report["arrived"]), (0, &50.into()));
        assert!(report["makespan"]["median"].as_f64().unwrap() > 30.0, "{report}");
        let (code, text, _) = run(path, &base.replace("--json", ""));
        assert!(code == 0 && text.contains("executed 50 times"), "{text}");
    }
}

#[test]
fn the_schedule_is_written() {
    let folder = stage();
    let path = folder.path();
    run(path, "simulate hex.json --save-schedule schedule.json");
    let schedule: Value = serde_json::from_slice(&fs::read(path.join("schedule.json")).unwrap()).unwrap();
    assert_eq!((&schedule["activecell"], &schedule["version"]), (&"schedule".into(), &1.into()));
    let robot = &schedule["robots"][0];
    assert_eq!((&robot["heading"], &robot["program"][0]["revolutions"]), (&"E".into(), &5.0.into()));
    // Robot 0 follows robot 1 around the ring: a sharp corner, so bodies of 0.2 cells have 0.19 of play.
    assert_eq!(robot["visits"][1]["after"], serde_json::json!([1, 0]));
    assert!((robot["visits"][1]["play"].as_f64().unwrap() - 0.19).abs() < 1e-9);
    assert_eq!(schedule["passing"][0], serde_json::json!({"cell": [0, 0], "order": [[0, 0], [2, 1]]}));
}

#[test]
fn what_cannot_be_executed_is_told_in_one_line() {
    let folder = stage();
    let path = folder.path();
    fs::write(path.join("lost.txt"), "agents=1\nmap_file=gone.map\nsolution=\n0:(0,0),\n").unwrap();
    fs::write(path.join("bare.txt"), "agents=1\nsolution=\n0:(0,0),\n1:(1;0),\n").unwrap();
    fs::write(path.join("alone.paths"), "Agent 0: (0,0)->(0,1)->\n").unwrap();
    fs::write(path.join("swap.txt"), plan("(0,0),(1,0),(1,1),(0,1)", "(1,0),(0,0),(1,1),(0,1)")).unwrap();
    fs::write(path.join("wide.toml"), "radius_m = 0.4\n").unwrap();
    let cases = [
        ("simulate lost.txt", 2, "is for the map \"gone.map\", which is not there; name it with --map MAP"),
        ("simulate bare.txt", 1, "bare.txt line 4, column 5"),
        ("simulate alone.paths", 2, "names no map; name it with --map MAP"),
        ("simulate alone.paths --map none.txt", 1, "none.txt: there is no such file"),
        ("simulate swap.txt", 1, "swap.txt: the plan breaks the rules: step 1: robots 0 and 1 swap cells"),
        (
            "simulate square.txt --robot wide.toml",
            1,
            "it must be at most 0.34 cells: in this plan robots follow",
        ),
        ("simulate hex.json --robot wide.toml", 1, "at most 0.24 cells"),
        ("simulate square.txt --movers 2", 2, "--movers is for runs; square.txt is a plan"),
        ("simulate square.txt --stop 9@0:1", 1, "a robot of the plan, counted from 0"),
        ("simulate square.txt --stop 9", 2, ""),
        ("simulate square.txt --delay-chance 2", 2, ""),
        ("simulate square.txt --slow-speed 0.5", 2, ""),
    ];
    for (arguments, code, expected) in cases {
        let (found, stdout, stderr) = run(path, arguments);
        assert_eq!((found, stdout.as_str()), (code, ""), "{arguments}: {stderr}");
        assert!(stderr.contains(expected), "{arguments}: {stderr}");
        assert!(expected.is_empty() || stderr.lines().count() == 1, "{stderr}");
    }
    assert_eq!(run(path, "simulate alone.paths --map floor.txt").0, 0);
    check_run_options(path);
}

/// A run is not executed with the options of plans.
fn check_run_options(path: &Path) {
    run(path, "route floor.txt --from 0,0 --to 2,1 --save run.json");
    let (code, _, stderr) = run(path, "simulate run.json --lost-reports 0.5");
    assert_eq!((code, stderr.as_str()), (2, "activecell: --lost-reports is for plans; run.json is a run\n"));
}
