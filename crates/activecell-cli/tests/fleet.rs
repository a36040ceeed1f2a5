//! `fleet` and `check`, run as a user runs them.

#![expect(clippy::unwrap_used, reason = "a test that cannot start the command should stop")]

mod common;

use common::{json, run};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

/// A floor with two rooms and a door, tasks through the door, and a cage.
fn stage() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("rooms.map", "type octile\nheight 4\nwidth 7\nmap\n...@...\n.......\n...@...\n...@...\n");
    write("pipe.txt", "....\n");
    write("walls.txt", "..#..\n");
    let task = |from: [u32; 2], to: [u32; 2]| {
        format!("0\trooms.map\t7\t4\t{}\t{}\t{}\t{}\t0\n", from[0], from[1], to[0], to[1])
    };
    let tasks = [([0, 0], [6, 0]), ([6, 1], [0, 1]), ([0, 3], [5, 3]), ([4, 0], [2, 2])];
    let rows: String = tasks.map(|(from, to)| task(from, to)).concat();
    write("rooms.scen", &format!("version 1\n{rows}"));
    write("wall.scen", &(rows.clone() + &task([3, 0], [0, 0])));
    write("shared.scen", &(rows + &task([6, 3], [5, 3])));
    write("pipe.scen", "0 pipe.txt 4 1 0 0 3 0 3\n0 pipe.txt 4 1 3 0 0 0 3\n");
    write("walls.scen", "0 walls.txt 5 1 0 0 4 0 3\n");
    write("hall.txt", &"............\n".repeat(7));
    let hall = [[1, 1, 10, 1], [10, 5, 1, 5], [10, 2, 4, 3]];
    write("hall.scen", &hall.map(|[a, b, c, d]| format!("0 hall.txt 12 7 {a} {b} {c} {d} 9\n")).concat());
    write("strangers.json", STRANGERS);
    folder
}

/// A closed cell, and an object that comes down a column.
const STRANGERS: &str = r#"{"activecell": "strangers", "version": 1, "keep_outs": [{"cell": [5, 1], "from": 2, "to": 9}],
    "objects": [{"radius_m": 0.3, "max_speed_mps": 0.5, "max_accel_mps2": 0.5, "seen_within_m": 0.05,
    "seen": [[0, 7.5, 6.5], [1, 7.5, 6]]}]}"#;

#[test]
fn plans_of_every_format_pass_the_checker() {
    let folder = stage();
    let path = folder.path();
    for lattice in ["square", "hex"] {
        let plan = |arguments: &str| {
            json(
                path,
                &format!("fleet rooms.map --lattice {lattice} --step-limit 2000 --json {arguments}"),
                &[0],
            )
        };
        let report = plan("--scen rooms.scen --save a.txt --save a.json --save a.paths --threads 2 --seed 3");
        assert_eq!((&report["robots"], &report["solved"]), (&json!(4), &json!(true)));
        assert_eq!((&report["lattice"], &report["seed"]), (&json!(lattice), &json!(3)));
        let cost = report["sum_of_costs"].as_u64().unwrap();
        assert!(cost >= report["lower_bound"].as_u64().unwrap(), "{report}");
        let history = report["history"].as_array().unwrap();
        assert_eq!(
            (&history[history.len() - 1][1], &history[0][0]),
            (&json!(cost), &report["first_solution_ms"])
        );
        assert!(
            report["peak_bytes"].as_u64().unwrap() > 100_000 && report["elapsed_ms"].as_f64().unwrap() > 0.0
        );
        for ending in ["txt", "json", "paths"] {
            let scen = if ending == "txt" { "" } else { "--scen rooms.scen" };
            let said = if ending == "paths" { format!("--lattice {lattice}") } else { String::new() };
            let checked = json(path, &format!("check rooms.map a.{ending} --json {scen} {said}"), &[0]);
            assert_eq!((&checked["sound"], &checked["sum_of_costs"]), (&json!(true), &json!(cost)));
            assert_eq!((&checked["makespan"], &checked["lattice"]), (&report["makespan"], &json!(lattice)));
            assert_eq!((&checked["disagreements"], &checked["targets_known"]), (&json!([]), &json!(true)));
        }
        // The same seed, the same plan, whatever the threads.
        let solution = |name: &str| {
            let text = fs::read_to_string(path.join(name)).unwrap();
            text[text.find("starts=").unwrap()..].to_owned()
        };
        plan("--scen rooms.scen --save b.txt --threads 1 --seed 3");
        assert_eq!(solution("a.txt"), solution("b.txt"));
        let random = plan("--random -n 9 --first --save r.json --save r.txt");
        assert_eq!((&random["robots"], &random["ending"]), (&json!(9), &json!("first_plan")));
        plan("--random -n 9 --first --save s.txt");
        assert_eq!(solution("r.txt"), solution("s.txt"));
        assert_eq!(json(path, "check rooms.map r.json --json", &[0])["robots"], 9);
    }
}

#[test]
fn floors_in_metres_are_tiled_for_the_group() {
    let project = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."));
    let folder = tempfile::tempdir().unwrap();
    let plan = folder.path().join("plan.json").display().to_string();
    for lattice in ["square", "hex"] {
        let floor = format!("maps/office.yaml --cell 0.5 --lattice {lattice}");
        json(project, &format!("fleet {floor} --random -n 12 --first --json --save {plan}"), &[0]);
        assert_eq!(json(project, &format!("check {floor} {plan} --json"), &[0])["robots"], 12);
        let (code, _, stderr) = run(project, &format!("check maps/office.yaml {plan}"));
        assert_eq!(code, 1, "{stderr}");
        assert!(stderr.contains("the plan was made on another map"), "{stderr}");
    }
}

#[test]
fn what_cannot_be_is_told_from_what_was_not_found() {
    let folder = stage();
    let path = folder.path();
    for (arguments, words) in [
        ("pipe.txt --scen pipe.scen", "fleet: 2 robots, no plan exists\n"),
        ("walls.txt --scen walls.scen", "fleet: 1 robot, no plan exists: robot 0 has no way from "),
        ("rooms.map --scen rooms.scen --step-limit 1", "fleet: 4 robots, no plan found\n"),
    ] {
        let (code, stdout, stderr) = run(path, &format!("fleet {arguments} --save never.txt"));
        assert_eq!((code, stderr.as_str()), (3, ""), "{stdout}");
        assert!(stdout.starts_with(words), "{stdout}");
        assert!(!path.join("never.txt").exists());
        let report = json(path, &format!("fleet {arguments} --json"), &[3]);
        let exhausted = words.contains("exists");
        assert_eq!(report["ending"] == "exhausted", exhausted, "{report}");
        assert_eq!((&report["solved"], &report["sum_of_costs"]), (&json!(false), &Value::Null));
        assert_eq!((&report["makespan"], &report["history"]), (&Value::Null, &json!([])));
    }
}

/// A plan of three robots that is right, in the text that MAPF tools share.
const RIGHT: &str = "agents=3\nmap_file=rooms.map\nsolved=1\nsoc=8\nmakespan=4\nstarts=(0,1),(5,1),(6,3),\ngoals=(2,0),(1,1),(6,2),\nsolution=\n\
    0:(0,1),(5,1),(6,3),\n1:(1,1),(4,1),(6,2),\n2:(1,0),(3,1),(6,2),\n3:(2,0),(2,1),(6,2),\n4:(2,0),(1,1),(6,2),\n";

/// What was there, what is there instead, what the checker says, and how as JSON.
fn tampered() -> [(&'static str, &'static str, &'static str, Value); 9] {
    [
        (
            "2:(1,0),(3,1)",
            "2:(1,0),(3,2)",
            "step 2: robot 1 is at (3,2), in an obstacle",
            json!(["blocked", 2, [1], [[3, 2]]]),
        ),
        (
            "3:(2,0),(2,1),(6,2)",
            "3:(2,0),(2,1),(5,1)",
            "step 3: robot 2 jumps from (6,2) to (5,1)",
            json!(["jump", 3, [2], [[6, 2], [5, 1]]]),
        ),
        (
            "1:(1,1),(4,1),(6,2)",
            "1:(-1,1),(4,1),(6,2)",
            "step 1: robot 0 is at (-1,1), outside the map",
            json!(["outside", 1, [0], [[-1, 1]]]),
        ),
        (
            "4:(2,0),(1,1),(6,2)",
            "4:(2,0),(1,1),(7,2)",
            "step 4: robot 2 is at (7,2), outside the map",
            json!(["outside", 4, [2], [[7, 2]]]),
        ),
        (
            "2:(1,0),(3,1),(6,2),\n3:(2,0),(2,1)",
            "2:(2,1),(3,1),(6,2),\n3:(2,1),(2,1)",
            "step 3: robots 0 and 1 are both at (2,1)",
            json!(["collision", 3, [0, 1], [[2, 1]]]),
        ),
        (
            "2:(1,0),(3,1),(6,2),\n3:(2,0),(2,1)",
            "2:(2,1),(3,1),(6,2),\n3:(3,1),(2,1)",
            "step 3: robots 0 and 1 swap cells, 0 to (3,1) and 1 to (2,1)",
            json!(["swap", 3, [0, 1], [[3, 1], [2, 1]]]),
        ),
        (
            "0:(0,1)",
            "0:(1,0)",
            "robot 0 starts at (1,0), not at its start (0,1)",
            json!(["wrong_start", 0, [0], [[1, 0], [0, 1]]]),
        ),
        (
            "4:(2,0)",
            "4:(1,0)",
            "robot 0 ends at (1,0), not at its target (2,0)",
            json!(["not_arrived", null, [0], [[1, 0], [2, 0]]]),
        ),
        (
            "goals=(2,0),(1,1)",
            "goals=(2,0),(2,1)",
            "robot 1 ends at (1,1), not at its target (2,1)",
            json!(["not_arrived", null, [1], [[1, 1], [2, 1]]]),
        ),
    ]
}

#[test]
fn tampered_plans_are_refused_with_step_robots_and_cells() {
    let folder = stage();
    let path = folder.path();
    let right = RIGHT;
    fs::write(path.join("right.txt"), right).unwrap();
    assert_eq!(run(path, "check rooms.map right.txt").0, 0);
    for (from, to, words, expected) in tampered() {
        assert!(right.contains(from), "{from}");
        fs::write(path.join("plan.txt"), right.replacen(from, to, 1)).unwrap();
        let (code, stdout, stderr) = run(path, "check rooms.map plan.txt");
        assert_eq!((code, stdout.as_str()), (1, ""), "{stderr}");
        assert_eq!(stderr, format!("activecell: plan.txt: {words}\n"));
        let report = json(path, "check rooms.map plan.txt --json", &[1]);
        let fault = &report["fault"];
        assert_eq!(json!([fault["kind"], fault["step"], fault["robots"], fault["cells"]]), expected);
        assert_eq!((&report["sound"], fault["message"].as_str()), (&json!(false), Some(words)));
    }
}

#[test]
fn without_targets_what_robots_do_on_the_way_still_counts() {
    let folder = stage();
    let path = folder.path();
    let lines: Vec<&str> = RIGHT.lines().filter(|line| !line.starts_with("goals")).collect();
    let text = lines.join("\n");
    fs::write(path.join("plan.txt"), &text).unwrap();
    let (code, stdout, _) = run(path, "check rooms.map plan.txt");
    assert_eq!(
        (code, stdout.lines().next()),
        (0, Some("sound: 3 robots, 4 steps; nothing says where they should end"))
    );
    fs::write(path.join("plan.txt"), text.replacen("4:(2,0),(1,1),(6,2)", "4:(2,0),(1,1),(7,2)", 1)).unwrap();
    let (code, _, stderr) = run(path, "check rooms.map plan.txt");
    assert_eq!(
        (code, stderr.as_str()),
        (1, "activecell: plan.txt: step 4: robot 2 is at (7,2), outside the map\n")
    );
}

#[test]
fn a_tampered_json_plan_is_refused_too() {
    let folder = stage();
    let path = folder.path();
    run(path, "fleet rooms.map --scen rooms.scen --first -q --save plan.json");
    let text = fs::read_to_string(path.join("plan.json")).unwrap();
    let mut plan: Value = serde_json::from_str(&text).unwrap();
    let moves = plan["robots"][2]["moves"].as_str().unwrap().to_owned();
    for (changed, words) in [
        (format!("(6,3) {moves}"), "jump"),
        ("S".to_owned(), "outside"),
        (String::new(), "not at its target (5,3)"),
    ] {
        plan["robots"][2]["moves"] = changed.into();
        plan["steps"] = 100.into();
        fs::write(path.join("bad.json"), plan.to_string()).unwrap();
        let (code, _, stderr) = run(path, "check rooms.map bad.json");
        assert!(code == 1 && stderr.contains("robot 2") && stderr.contains(words), "{stderr}");
    }
}

#[test]
fn numbers_that_a_file_states_are_compared() {
    let folder = stage();
    let path = folder.path();
    let lies = RIGHT.replace("soc=8", "soc=7").replace("makespan=4", "makespan=9");
    fs::write(path.join("plan.txt"), lies).unwrap();
    let (code, stdout, _) = run(path, "check rooms.map plan.txt");
    assert_eq!(code, 0);
    assert!(stdout.contains("the file states a sum of costs of 7, but it is 8\n"), "{stdout}");
    assert!(stdout.contains("the file states a makespan of 9, but it is 4\n"), "{stdout}");
    let report = json(path, "check rooms.map plan.txt --json", &[0]);
    assert_eq!(
        report["disagreements"],
        json!([{"what": "sum_of_costs", "stated": 7, "found": 8}, {"what": "makespan", "stated": 9, "found": 4}])
    );
}

#[test]
fn what_cannot_be_planned_or_checked_is_told_in_one_line() {
    let folder = stage();
    let path = folder.path();
    fs::write(path.join("plan.txt"), RIGHT).unwrap();
    fs::write(path.join("hex.txt"), format!("lattice=square\n{RIGHT}")).unwrap();
    fs::write(path.join("noise.txt"), "agents=2\nsolution=\n0:(0,0),(1,\n").unwrap();
    fs::write(path.join("huge.json"), "{\"activecell\":\"plan\",\"version\":1,\"lattice\":\"hex\",\"steps\":4000000000,\"robots\":[{\"start\":[0,0],\"moves\":\"\"}]}").unwrap();
    fs::write(path.join("empty.paths"), "").unwrap();
    fs::write(path.join("twice.txt"), format!("seed=1\nseed=2\n{RIGHT}")).unwrap();
    let cases = [
        ("fleet rooms.map", 2, ""),
        ("fleet rooms.map --random", 2, ""),
        ("fleet rooms.map --random -n 5 --scen rooms.scen", 2, ""),
        ("fleet rooms.map --scen rooms.scen --time-limit 0", 2, ""),
        ("fleet rooms.map --random -n 26", 2, "--robots 26: the floor's largest region has 25 free cells"),
        ("fleet rooms.map --scen rooms.scen -n 5", 2, "rooms.scen has 4 rows, too few for 5 robots"),
        ("fleet rooms.map --scen rooms.scen --save plan.pdf", 2, "plan.pdf: the ending names no plan"),
        ("fleet rooms.map --scen rooms.scen --save a.txt --save a.txt", 2, "a.txt is to be written twice"),
        ("fleet pipe.txt --scen pipe.scen --save pipe.txt", 2, "pipe.txt: the task is read from this file"),
        ("fleet rooms.map --scen none.scen", 1, "none.scen: there is no such file"),
        ("fleet pipe.txt --scen rooms.scen", 1, "rooms.scen line 2: the task is for a map of 7 x 4 cells"),
        (
            "fleet rooms.map --scen wall.scen",
            1,
            "wall.scen line 5: robot 4: the start (3,0) lies in an obstacle",
        ),
        (
            "fleet rooms.map --scen shared.scen",
            1,
            "shared.scen line 5: robots 2 and 4 have the same target (5,3)",
        ),
        ("check rooms.map none.txt", 1, "none.txt: there is no such file"),
        ("check rooms.map noise.txt", 1, "noise.txt line 3, column 12: expected a whole number"),
        ("check rooms.map huge.json", 1, "huge.json: 1 robots with 4000000000 steps are more than"),
        ("check rooms.map empty.paths", 1, "empty.paths: the file is empty; give one with a plan"),
        (
            "check rooms.map twice.txt",
            1,
            "twice.txt line 2: `seed=` is stated twice; remove one of the lines",
        ),
        ("check rooms.map rooms.scen", 1, "rooms.scen line 5: the file ends before `solution=`"),
        ("check rooms.map hex.txt --lattice hex", 2, "--lattice hex: the plan says that it is for squares"),
        ("check rooms.map plan.txt --scen rooms.scen", 1, "robot 0 starts at (0,1), not at its start (0,0)"),
        ("check rooms.map plan.txt --scen pipe.scen", 2, "pipe.scen has 2 rows, too few for 3 robots"),
    ];
    for (arguments, code, expected) in cases {
        let (found, stdout, stderr) = run(path, arguments);
        assert_eq!((found, stdout.as_str()), (code, ""), "{arguments}: {stderr}");
        assert!(stderr.contains(expected), "{arguments}: {stderr}");
        assert!(expected.is_empty() || stderr.lines().count() == 1, "{stderr}");
    }
}

#[test]
fn a_scenario_of_another_map_of_the_same_size_is_told() {
    let folder = stage();
    let path = folder.path();
    fs::copy(path.join("rooms.map"), path.join("other.map")).unwrap();
    let note = "activecell: note: rooms.scen is for the map \"rooms.map\", this one is \"other.map\"\n";
    for (arguments, noted) in [
        ("fleet rooms.map --scen rooms.scen --first --save plan.json", ""),
        ("fleet other.map --scen rooms.scen --first", note),
        ("fleet other.map --scen rooms.scen --first -q", ""),
        ("check other.map plan.json --scen rooms.scen", note),
        ("scen rooms.scen", ""),
        ("scen rooms.scen --map other.map", note),
    ] {
        let (code, _, stderr) = run(path, arguments);
        assert_eq!((code, stderr.as_str()), (0, noted), "{arguments}");
    }
    // Scenarios name their maps with folders of any system.
    let text = fs::read_to_string(path.join("rooms.scen")).unwrap();
    for name in ["maps/rooms.map", "C:\\maps\\rooms.map"] {
        fs::write(path.join("far.scen"), text.replace("rooms.map", name)).unwrap();
        assert_eq!(run(path, "fleet rooms.map --scen far.scen --first").2, "", "{name}");
    }
}

#[test]
fn one_is_not_many() {
    let folder = stage();
    let path = folder.path();
    fs::write(path.join("one.scen"), "0 pipe.txt 4 1 0 0 1 0 1\n").unwrap();
    let (_, stdout, _) = run(path, "fleet pipe.txt --scen one.scen --save one.json --picture one.svg");
    assert!(stdout.starts_with("fleet: 1 robot, all arrive\n"), "{stdout}");
    assert!(stdout.contains("makespan       1 step\n"), "{stdout}");
    let svg = fs::read_to_string(path.join("one.svg")).unwrap();
    assert!(svg.contains("pipe · 1 robot, 1 step, sum of costs 1 (lower bound 1)"), "{svg}");
    fs::write(path.join("cell.txt"), ".\n").unwrap();
    let (_, _, stderr) = run(path, "fleet cell.txt --random -n 2");
    assert!(stderr.contains("the map has 1 cell; take fewer robots"), "{stderr}");
    let (_, stdout, _) = run(path, "simulate one.json");
    assert!(stdout.starts_with("plan: 1 robot, 1 move, 0 rings;"), "{stdout}");
    assert!(stdout.contains("makespan       planned 1 step; "), "{stdout}");
}

/// Real scenarios, planned, saved in every format, and checked.
#[test]
fn real_scenarios_are_planned_saved_and_checked() {
    let project = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."));
    let data = project.join(std::env::var_os("ACTIVECELL_DATA").unwrap_or_else(|| "../shared/data".into()));
    let Ok(entries) = fs::read_dir(data.join("mapf")) else {
        println!("SKIPPED: {} not found; set ACTIVECELL_DATA to the folder of real maps", data.display());
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let mut scenarios: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    scenarios.retain(|path| path.to_string_lossy().ends_with("-random-1.scen"));
    scenarios.sort();
    for (number, scen) in scenarios.iter().enumerate() {
        let map = scen.display().to_string().replace("-random-1.scen", ".map");
        let scen = scen.display();
        let ending = ["txt", "json", "paths"][number % 3];
        let plan = format!("fleet {map} --scen {scen} -n 100 --first --json --save plan.{ending}");
        let made = json(folder.path(), &plan, &[0]);
        let check = json(folder.path(), &format!("check {map} plan.{ending} --scen {scen} --json"), &[0]);
        assert_eq!((&check["robots"], &check["sum_of_costs"]), (&json!(100), &made["sum_of_costs"]), "{map}");
    }
    assert!(scenarios.len() > 5, "{scenarios:?}");
}

#[test]
fn targets_can_be_given_to_whoever_is_best_placed() {
    let folder = stage();
    let path = folder.path();
    for lattice in ["square", "hex"] {
        let task = format!("fleet rooms.map --lattice {lattice} --scen rooms.scen --step-limit 2000 --json");
        let [given, assigned] =
            ["", "--assign --save a.json"].map(|more| json(path, &format!("{task} {more}"), &[0]));
        assert!(assigned["lower_bound"].as_u64() < given["lower_bound"].as_u64(), "{assigned}");
        assert_eq!(json(path, "check rooms.map a.json --json", &[0])["robots"], json!(4));
    }
}

#[test]
fn bodies_keep_their_distance_and_the_plan_says_it() {
    let folder = stage();
    let path = folder.path();
    fs::write(path.join("sizes.txt"), "# the first is large\n1\n0\n0\n").unwrap();
    for lattice in ["square", "hex"] {
        let floor = format!("hall.txt --lattice {lattice}");
        let plan = |arguments: &str| {
            json(path, &format!("fleet {floor} --step-limit 2000 --json {arguments}"), &[0])
        };
        let asked = "--sizes 1,0,0 --distance 2";
        let made = plan(&format!("--scen hall.scen {asked} --save a.json --save a.txt"));
        let by_file = plan("--scen hall.scen --sizes sizes.txt --distance 2 --save b.json");
        assert_eq!(made["sum_of_costs"], by_file["sum_of_costs"]);
        let check = |arguments: &str| json(path, &format!("check hall.txt {arguments} --json"), &[0]);
        for judged in [
            check("a.json"),
            check("b.json --scen hall.scen"),
            check(&format!("a.txt {asked}")),
            check(&format!("a.txt --scen hall.scen {asked}")),
        ] {
            assert_eq!((&judged["largest_size"], &judged["distance"]), (&json!(1), &json!(2)));
            assert_eq!(judged["sum_of_costs"], made["sum_of_costs"]);
        }
        // Text cannot say it, and an option says otherwise.
        assert_eq!(check("a.txt")["largest_size"], json!(0));
        assert_eq!(check("a.json --sizes 0 --distance 1")["distance"], json!(1));
        let (code, _, stderr) = run(path, "check hall.txt a.json --distance 12");
        assert!(code == 1 && stderr.contains("are too close"), "{stderr}");
        let random = plan(&format!("--random -n 3 {asked} --save r.json"));
        assert_eq!(check("r.json")["sum_of_costs"], random["sum_of_costs"]);
        // All of one size may share their targets.
        let all = "--scen hall.scen --sizes 1 --assign --save s.json";
        assert!(
            plan(all)["lower_bound"].as_u64() <= plan("--scen hall.scen --sizes 1")["lower_bound"].as_u64()
        );
        assert_eq!(check("s.json")["largest_size"], json!(1));
    }
}

#[test]
fn plans_keep_out_of_what_strangers_close() {
    let folder = stage();
    let path = folder.path();
    for lattice in ["square", "hex"] {
        let task = format!("fleet hall.txt --lattice {lattice} --scen hall.scen --step-limit 2000 --json");
        json(path, &format!("{task} --strangers strangers.json --save past.json"), &[0]);
        let judged = json(path, "check hall.txt past.json --json", &[0]);
        assert!(judged["keep_outs"].as_u64() > Some(3), "{judged}");
        json(path, "check hall.txt past.json --strangers strangers.json --json", &[0]);
        // Nobody told this plan.
        json(path, &format!("{task} --save free.json"), &[0]);
        let (code, stdout, stderr) = run(path, "check hall.txt free.json --strangers strangers.json --json");
        assert!(code == 1 && stderr.contains("which is closed then"), "{stderr}");
        let report: Value = serde_json::from_str(&stdout).unwrap();
        assert_eq!((&report["sound"], &report["fault"]["kind"]), (&json!(false), &json!("closed")));
    }
}

/// A large robot and a small one that meet, and a cell that is closed until the large one covers it.
const BODIES: &str = r#"{"activecell":"plan","version":1,"lattice":"square","sizes":[1,0],"keep_outs":[{"cell":[4,3],"from":0,"to":1}],
    "steps":3,"robots":[{"start":[1,3],"moves":"E2"},{"start":[6,3],"moves":"W"}]}"#;

#[test]
fn tampered_plans_of_bodies_are_refused_with_step_robots_and_cells() {
    let folder = stage();
    let path = folder.path();
    fs::write(path.join("right.json"), BODIES).unwrap();
    let (code, stdout, _) = run(path, "check hall.txt right.json");
    assert!(
        code == 0
            && stdout.contains("of radius 1 at the most, at least 1 cell apart\nclosed         1 cell,")
    );
    let far = r#""version":1,"distance":3"#;
    for (from, to, words, expected) in [
        (
            r#""W""#,
            r#""W2""#,
            "step 2: robots 0 and 1 at (3,3) and (4,3) are too close; their centres must be at least 2 cells apart",
            json!(["too_close", 2, [0, 1], [[3, 3], [4, 3]]]),
        ),
        (
            r#""version":1"#,
            far,
            "step 1: robots 0 and 1 at (2,3) and (5,3) are too close; their centres must be at least 4 cells apart",
            json!(["too_close", 1, [0, 1], [[2, 3], [5, 3]]]),
        ),
        (
            r#""E2""#,
            r#""N3""#,
            "step 3: robot 0 at (1,0) covers (0,-1), an obstacle or outside the map",
            json!(["no_room", 3, [0], [[1, 0], [0, -1]]]),
        ),
        (
            r#""to":1"#,
            r#""to":2"#,
            "step 2: robot 0 at (3,3) is in (4,3), which is closed then",
            json!(["closed", 2, [0], [[3, 3], [4, 3]]]),
        ),
        (
            r#""cell":[4,3],"from":0,"to":1"#,
            r#""cell":[5,3],"from":90,"to":90"#,
            "step 90: robot 1 at (5,3) is in (5,3), which is closed then",
            json!(["closed", 90, [1], [[5, 3], [5, 3]]]),
        ),
    ] {
        assert!(BODIES.contains(from), "{from}");
        fs::write(path.join("plan.json"), BODIES.replacen(from, to, 1)).unwrap();
        let (code, stdout, stderr) = run(path, "check hall.txt plan.json --json");
        assert_eq!((code, stderr.as_str()), (1, format!("activecell: plan.json: {words}\n").as_str()));
        let report: Value = serde_json::from_str(&stdout).unwrap();
        let fault = &report["fault"];
        assert_eq!(json!([fault["kind"], fault["step"], fault["robots"], fault["cells"]]), expected);
        assert_eq!((&report["sound"], &fault["message"]), (&json!(false), &json!(words)));
    }
}

#[test]
fn bodies_and_strangers_that_cannot_be_are_told_in_one_line() {
    let folder = stage();
    let path = folder.path();
    fs::write(path.join("plan.json"), BODIES).unwrap();
    fs::write(path.join("few.json"), BODIES.replace("[1,0]", "[1]")).unwrap();
    fs::write(path.join("late.json"), BODIES.replace("\"to\":1", "\"to\":99999")).unwrap();
    fs::write(path.join("off.json"), STRANGERS.replace("[5, 1]", "[99, 1]")).unwrap();
    fs::write(path.join("odd.json"), STRANGERS.replace("keep_outs", "keepouts")).unwrap();
    fs::write(path.join("words.txt"), "0\none\n").unwrap();
    let fleet = |more: &str| format!("fleet hall.txt --scen hall.scen {more}");
    for (arguments, code, expected) in [
        (fleet("--distance 0"), 2, ""),
        (fleet("--sizes 1,0"), 2, "--sizes: 2 radii for 3 robots; give one for each, or one for all"),
        (fleet("--sizes ,"), 2, "--sizes: no radius is given"),
        (fleet("--sizes 0,0,99999999999"), 2, "--sizes: line 1: `99999999999` is no radius"),
        (fleet("--sizes 0,0,99999"), 1, "a robot's radius in cells is 99999; it must be from 0 to 16384"),
        (fleet("--sizes none.txt"), 1, "none.txt: there is no such file"),
        (fleet("--sizes words.txt"), 1, "words.txt line 2: `one` is no radius"),
        (fleet("--sizes 0,2,0"), 1, "hall.scen line 2: robot 1: a body of radius 2 at (10,5) covers"),
        (fleet("--distance 4"), 1, "hall.scen line 3: robots 1 and 2 at (10,5) and (10,2) are too close"),
        (fleet("--sizes 1,0,0 --assign"), 2, "--assign: the robots have different sizes"),
        (fleet("--strangers off.json"), 1, "off.json: cell (99,1) is outside the map"),
        (
            fleet("--strangers odd.json"),
            1,
            "odd.json line 1, column 52: not a file of strangers: unknown field",
        ),
        (fleet("--strangers plan.json"), 1, "plan.json: activecell is `plan`, not `strangers`"),
        (fleet("--strangers strangers.json --save strangers.json"), 2, "the task is read from this file"),
        (
            "fleet hall.txt --random -n 9 --sizes 1 --distance 4".to_owned(),
            2,
            "--robots 9: of these sizes and",
        ),
        ("fleet hall.txt --random -n 99999999999".to_owned(), 2, "the map has 84 cells; take fewer"),
        ("check hall.txt few.json".to_owned(), 1, "few.json: `sizes` has 1 radii for 2 robots"),
        ("check hall.txt late.json".to_owned(), 1, "late.json: the last step of a closed cell is 99999"),
        ("check hall.txt plan.json --sizes 0,0,0".to_owned(), 2, "--sizes: 3 radii for 2 robots"),
        ("simulate plan.json --map hall.txt".to_owned(), 1, "plan.json: some robots are larger than a cell"),
    ] {
        let (found, stdout, stderr) = run(path, &arguments);
        assert_eq!((found, stdout.as_str()), (code, ""), "{arguments}: {stderr}");
        assert!(stderr.contains(expected), "{arguments}: {stderr}");
        assert!(expected.is_empty() || stderr.lines().count() == 1, "{stderr}");
    }
}
