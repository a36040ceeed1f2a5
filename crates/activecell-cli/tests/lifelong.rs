//! `fleet` with tasks that keep coming, run as a user runs it.

#![expect(clippy::unwrap_used, reason = "a test that cannot start the command should stop")]

mod common;

use common::{json, run};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};

/// A floor with two rooms, a door and a cage, with robots and tasks in every form.
fn stage() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("rooms.map", "type octile\nheight 4\nwidth 8\nmap\n...@...@\n.......@\n...@...@\n...@..@.\n");
    write("agents.csv", "agent id,row,col\n0,0,0\n1,0,6\n2,3,1\n");
    write("agents.txt", "3\n0\n6\n25\n");
    write("tasks.csv", "targets\n22\n0\n12\n8\n");
    write("tasks.txt", "# version\n4\n22,0\n12\n8,14,8\n0\n");
    write("outside.csv", "targets\n22\n32\n");
    write("wall.csv", "targets\n22\n3\n");
    write("cage.csv", "targets\n22\n31\n");
    write("none.csv", "targets\n");
    write("nobody.csv", "agent id,row,col\n");
    write("agents-outside.csv", "agent id,row,col\n0,4,0\n");
    write("agents-wall.csv", "agent id,row,col\n0,0,3\n");
    write("agents-cage.csv", "agent id,row,col\n0,0,0\n1,3,7\n");
    write("agents-shared.csv", "agent id,row,col\n0,0,0\n1,0,0\n");
    let problem = |robots: usize| json!({"mapFile": "rooms.map", "agentFile": "agents.txt", "taskFile": "tasks.txt", "teamSize": robots});
    write("problem.json", &problem(2).to_string());
    write("greedy.json", &problem(4).to_string());
    write("odd.json", "{}");
    folder
}

#[test]
fn runs_on_both_lattices_with_both_motions_are_the_same_on_any_number_of_threads() {
    let folder = stage();
    let path = folder.path();
    for (lattice, motion) in [("square", "omni"), ("square", "turning"), ("hex", "omni"), ("hex", "turning")]
    {
        for assignment in ["in-order", "nearest"] {
            let go = |arguments: &str| {
                let task = format!(
                    "fleet rooms.map --lattice {lattice} --motion {motion} --assignment {assignment} -n 6 --steps 60"
                );
                json(path, &format!("{task} --step-work 40 --json {arguments}"), &[0])
            };
            for generate in ["visits", "deliveries"] {
                let [one, two] = [1, 2].map(|threads| {
                    let saved = format!("--save {threads}.txt --save {threads}.paths");
                    go(&format!("--generate {generate} --seed 3 --threads {threads} {saved}"))
                });
                for key in ["steps", "tasks_finished", "tasks_per_step", "ending"] {
                    assert_eq!(one[key], two[key], "{one} {two}");
                }
                for ending in ["txt", "paths"] {
                    let read =
                        |threads| fs::read_to_string(path.join(format!("{threads}.{ending}"))).unwrap();
                    assert_eq!(read(1), read(2));
                }
                assert_eq!((&one["robots"], &one["steps"], &one["seed"]), (&json!(6), &json!(60), &json!(3)));
                assert_eq!((&one["lattice"], &one["motion"]), (&json!(lattice), &json!(motion)));
                assert_eq!(one["ending"], "steps");
                let finished = one["tasks_finished"].as_u64().unwrap();
                assert!(finished > 5, "{one}");
                assert_eq!(one["tasks_per_step"], json!(finished as f64 / 60.0));
                let ms = |key: &str| one["planning_ms"][key].as_f64().unwrap();
                assert!(0.0 < ms("median") && ms("median") <= ms("p95") && ms("p95") <= ms("max"), "{one}");
                // The cells alone are a plan that the other checker likes.
                let checked = json(path, &format!("check rooms.map 1.txt --lattice {lattice} --json"), &[0]);
                assert_eq!((&checked["sound"], &checked["robots"]), (&json!(true), &json!(6)));
            }
        }
    }
}

#[test]
fn lists_and_problems_are_run_to_their_end() {
    let folder = stage();
    let path = folder.path();
    for (arguments, robots, tasks) in [
        ("rooms.map --tasks tasks.csv --agents agents.csv", 3, 4),
        ("rooms.map --tasks tasks.txt --agents agents.txt --motion turning", 3, 4),
        ("rooms.map --tasks tasks.txt --agents agents.txt -n 1 --lattice hex", 1, 4),
        ("rooms.map --tasks tasks.txt -n 2", 2, 4),
        ("problem.json", 2, 4),
        ("problem.json -n 1 --motion turning --assignment nearest", 1, 4),
        ("problem.json --lattice hex --window 3", 2, 4),
    ] {
        let report = json(path, &format!("fleet {arguments} --step-work 30 --json"), &[0]);
        assert_eq!(
            (&report["robots"], &report["tasks_finished"]),
            (&json!(robots), &json!(tasks)),
            "{report}"
        );
        assert_eq!(report["ending"], "tasks", "{arguments}");
        assert!(report["steps"].as_u64().unwrap() < 100, "{report}");
    }
    // A limit of time is a limit too.
    let report = json(path, "fleet problem.json --step-time 1 --steps 3 --json", &[0]);
    assert_eq!((&report["steps"], &report["ending"]), (&json!(3), &json!("steps")));
    let (code, stdout, stderr) = run(path, "fleet problem.json --step-work 30");
    assert_eq!((code, stderr.as_str()), (0, ""));
    assert!(stdout.starts_with("fleet: 2 robots, ") && stdout.contains("\ntasks done     4, "), "{stdout}");
    assert!(stdout.ends_with(", all tasks done\n"), "{stdout}");
}

/// What the League's output says, told again from its actions: where each robot is at the end.
fn ends(output: &Value) -> Vec<[i64; 2]> {
    let turning = output["actionModel"] == "MAPF_T";
    let paths = output["actualPaths"].as_array().unwrap();
    let starts = output["start"].as_array().unwrap();
    let end = |(start, path): (&Value, &Value)| {
        let (mut row, mut column) = (start[0].as_i64().unwrap(), start[1].as_i64().unwrap());
        // East, south, west, north.
        let mut heading = 0;
        for action in path.as_str().unwrap().split(',') {
            let step = match (turning, action) {
                (true, "F") => Some(heading),
                (true, "R" | "C") => {
                    heading = (heading + if action == "R" { 1 } else { 3 }) % 4;
                    None
                }
                (_, "W") => None,
                (false, action) => Some("RULD".find(action).unwrap()),
                _ => panic!("{action} is no action"),
            };
            let [down, right] = step.map_or([0, 0], |heading| [[0, 1], [1, 0], [0, -1], [-1, 0]][heading]);
            (row, column) = (row + down, column + right);
        }
        [column, row]
    };
    starts.iter().zip(paths).map(end).collect()
}

#[test]
fn runs_are_saved_as_the_league_does_and_drawn() {
    let folder = stage();
    let path = folder.path();
    for (motion, model) in [("omni", "MAPF"), ("turning", "MAPF_T")] {
        let task = format!("fleet problem.json --motion {motion} --step-work 30 --json");
        let report = json(
            path,
            &format!("{task} --save run.json --save cells.txt --picture run.gif --picture run.svg"),
            &[0],
        );
        let output: Value =
            serde_json::from_str(&fs::read_to_string(path.join("run.json")).unwrap()).unwrap();
        assert_eq!((&output["actionModel"], &output["teamSize"]), (&json!(model), &json!(2)));
        assert_eq!((&output["makespan"], &output["numTaskFinished"]), (&report["steps"], &json!(4)));
        let cells = fs::read_to_string(path.join("cells.txt")).unwrap();
        let last = ends(&output).iter().map(|[x, y]| format!("({x},{y}),")).collect::<Vec<_>>().concat();
        assert!(cells.trim_end().ends_with(&last), "{cells} {last}");
        assert!(fs::read(path.join("run.gif")).unwrap().starts_with(b"GIF89a"));
        let picture = fs::read_to_string(path.join("run.svg")).unwrap();
        assert!(picture.contains("problem · 4 tasks done · 2 robots, "), "{picture}");
        // Where the run stops is nobody's target.
        assert!(!picture.contains("target") && !picture.contains("sum of costs"), "{picture}");
    }
}

#[test]
fn bad_input_is_told_in_one_line() {
    let folder = stage();
    let rooms = |rest: &str| format!("fleet rooms.map --step-work 9 --steps 9 {rest}");
    let lists = |tasks: &str, agents: &str| rooms(&format!("--tasks {tasks} --agents {agents}"));
    for (arguments, code, words) in [
        (lists("outside.csv", "agents.csv"), 1, "outside.csv line 3: cell 32 is outside the map of 32 cells"),
        (lists("wall.csv", "agents.csv"), 1, "wall.csv line 3: the target (3,0) lies in an obstacle"),
        (lists("cage.csv", "agents.csv"), 1, "cage.csv: task 1: "),
        (
            lists("tasks.csv", "agents-outside.csv"),
            1,
            "agents-outside.csv line 2: row 4, column 0 is outside",
        ),
        (
            lists("tasks.csv", "agents-wall.csv"),
            1,
            "agents-wall.csv: robot 0: the start (3,0) lies in an obstacle",
        ),
        (lists("tasks.csv", "agents-cage.csv"), 1, "agents-cage.csv: "),
        (lists("tasks.csv", "agents-shared.csv"), 1, "agents-shared.csv: robots 0 and 1 "),
        (lists("tasks.csv", "missing.csv"), 1, "missing.csv: there is no such file"),
        (lists("missing.csv", "agents.csv"), 1, "missing.csv: there is no such file"),
        (lists("none.csv", "agents.csv"), 2, "there are no tasks"),
        (lists("tasks.csv", "nobody.csv"), 2, "there are no robots"),
        (lists("tasks.csv", "agents.csv") + " -n 4", 2, "agents.csv has 3 starts, too few for 4 robots"),
        (
            "fleet rooms.map --tasks tasks.csv --agents agents.csv --steps 99999999".to_owned(),
            2,
            "--steps 99999999: a run of 3 robots may have",
        ),
        (lists("tasks.csv", "agents.csv") + " --window 31", 2, "31 is not in 1..=30"),
        (lists("tasks.csv", "agents.csv") + " --save tasks.txt --save agents.csv", 2, "agents.csv"),
        (
            lists("tasks.txt", "agents.csv") + " --save tasks.txt",
            2,
            "tasks.txt: the task is read from this file",
        ),
        (rooms("--tasks tasks.csv --generate visits"), 2, "cannot be used with"),
        (rooms("--tasks tasks.csv"), 2, "nothing says how many robots there are"),
        (rooms("--generate visits -n 99"), 2, "--robots 99: "),
        (rooms("--generate visits -n 0"), 2, "there are no robots"),
        (rooms("--generate visits -n 2 --first"), 2, "--first is for a plan with an end"),
        (rooms("--generate visits -n 2 --distance 2"), 2, "--distance is for a plan with an end"),
        (rooms("--generate visits --random -n 2"), 2, "--random is for a plan with an end"),
        (rooms("--generate visits -n 2 --lattice hex --save run.json"), 2, "squares only"),
        (rooms("--random -n 2"), 2, "--steps is for runs with tasks"),
        (
            "fleet rooms.map --random -n 2 --motion turning".to_owned(),
            2,
            "--motion turning is for runs with tasks",
        ),
        ("fleet rooms.map".to_owned(), 2, "nothing says where robots go"),
        ("fleet problem.json --tasks tasks.csv".to_owned(), 2, "leave --tasks out"),
        ("fleet problem.json --cell 0.5".to_owned(), 2, "leave --cell out"),
        ("fleet problem.json -n 3".to_owned(), 2, "problem.json has 2 starts, too few for 3 robots"),
        ("fleet greedy.json".to_owned(), 1, "greedy.json: teamSize is 4, but "),
        (
            "fleet odd.json".to_owned(),
            1,
            "odd.json line 1, column 2: not a problem of the League of Robot Runners",
        ),
        ("fleet missing.json".to_owned(), 1, "missing.json: there is no such file"),
    ] {
        let (found, stdout, stderr) = run(folder.path(), &arguments);
        assert_eq!((found, stdout.as_str()), (code, ""), "{arguments}: {stderr}");
        assert!(stderr.contains(words), "{arguments}: {stderr}");
        assert!(stderr.lines().count() == 1 || stderr.starts_with("error: "), "{arguments}: {stderr}");
    }
}

fn data() -> Option<PathBuf> {
    let project = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let root = std::env::var_os("ACTIVECELL_DATA").map_or(project.join("../shared/data"), PathBuf::from);
    let folder = root.join("lifelong");
    if folder.is_dir() {
        return Some(folder);
    }
    println!("SKIPPED: {} was not found; the tests on real data did not run", folder.display());
    None
}

#[test]
fn data_sets_and_problems_of_the_league_run() {
    let Some(folder) = data() else { return };
    let saved = tempfile::tempdir().unwrap();
    let saved = saved.path().join("run.json").display().to_string();
    for motion in ["omni", "turning"] {
        let go = |task: &str, work: usize| {
            let arguments =
                format!("fleet {task} --motion {motion} --steps 8 --step-work {work} --json --save {saved}");
            let report = json(&folder, &arguments, &[0]);
            let output: Value = serde_json::from_str(&fs::read_to_string(&saved).unwrap()).unwrap();
            assert_eq!((&output["makespan"], &report["steps"]), (&json!(8), &json!(8)));
            assert_eq!(output["numTaskFinished"], report["tasks_finished"]);
            assert_eq!(output["teamSize"], report["robots"]);
            (report["robots"].as_u64().unwrap(), report["tasks_finished"].as_u64().unwrap())
        };
        let (robots, finished) =
            go("random/map.txt --tasks random/tasks_one.csv --agents random/agents_4.csv -n 400", 800);
        assert!(robots == 400 && finished > 0, "{finished}");
        assert_eq!(go("maze.domain/maze-example_40.json", 100).0, 40);
        assert_eq!(go("room.domain/room-example_150.json --assignment nearest", 300).0, 150);
        assert_eq!(go("warehouse.domain/fulfill-example_2500.json --window 6", 2500).0, 2500);
    }
}
