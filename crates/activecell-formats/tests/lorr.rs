//! Files of the League of Robot Runners: real ones, broken ones, and the output followed back to where robots were.

use activecell::{Cell, Dir, Lattice, Map, Rng};
use activecell_formats::files::{ReadOptions, read_map};
use activecell_formats::lorr::{Output, TaskEvent, read_agents, read_problem, read_tasks, write_output};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

/// The folder of the real data, if it is there.
fn data() -> Option<PathBuf> {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folder =
        workspace.join(std::env::var_os("ACTIVECELL_DATA").unwrap_or_else(|| "../shared/data".into()));
    let folder = folder.join("lifelong");
    if folder.is_dir() {
        return Some(folder);
    }
    println!("SKIPPED: {} not found; set ACTIVECELL_DATA to the folder of real maps", folder.display());
    None
}

#[test]
fn real_problems_are_read() {
    let Some(folder) = data() else { return };
    for (problem, robots, tasks, errands, size) in [
        ("maze.domain/maze-example_40.json", 40, 160, 320, (32, 32)),
        ("room.domain/room-example_150.json", 150, 1375, 2750, (64, 64)),
        ("warehouse.domain/fulfill-example_2500.json", 2500, 22_500, 56_227, (500, 140)),
    ] {
        let problem = read_problem(&folder.join(problem)).unwrap();
        assert_eq!((problem.starts.len(), problem.tasks.len()), (robots, tasks));
        assert_eq!((problem.map.width(), problem.map.height()), size);
        assert!((problem.tasks_revealed - 1.5).abs() < 1e-9);
        assert!(problem.starts.iter().all(|&cell| problem.map.is_free(cell)));
        let sum: usize = problem.tasks.iter().map(Vec::len).sum();
        assert_eq!(sum, errands);
    }
}

#[test]
fn real_lists_are_read() {
    let Some(folder) = data() else { return };
    for (name, most) in [("random", 800), ("warehouse", 10_000), ("sortation", 10_000)] {
        let folder = folder.join(name);
        let (map, _) = read_map(&folder.join("map.txt"), &ReadOptions::default()).unwrap();
        let tasks = read_tasks(&fs::read(folder.join("tasks_one.csv")).unwrap(), &map).unwrap();
        assert_eq!(tasks.len(), 60_000);
        let mut largest = 0;
        for entry in fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            if path.file_name().unwrap().to_string_lossy().starts_with("agents_") {
                let starts = read_agents(&fs::read(path).unwrap(), &map).unwrap();
                assert!(starts.iter().all(|&cell| map.is_free(cell)));
                largest = largest.max(starts.len());
            }
        }
        assert_eq!(largest, most, "{name}");
    }
}

#[test]
fn faults_have_their_line() {
    let map = Map::parse(Lattice::Square, "...\n.#.").unwrap();
    let agents = |text: &str| read_agents(text.as_bytes(), &map).unwrap_err().to_string();
    let tasks = |text: &str| read_tasks(text.as_bytes(), &map).unwrap_err().to_string();
    let cases = [
        (agents(""), "the list is empty; begin it with the number of starts"),
        (agents("2\n1\n"), "line 1: the list says 2 starts, and has 1; make them agree"),
        (agents("99999999999\n1\n"), "line 1: the list says 99999999999 starts, and has 1"),
        (agents("# x\n\n1\n6\n"), "line 4: cell 6 is outside the map of 6 cells; is it the right map?"),
        (agents("1\n1,2\n"), "line 2: expected one cell: row × columns + column"),
        (agents("1\n-1\n"), "line 2, column 1: expected a whole number from 0, found `-1`"),
        (agents("agent id,row,col\n0,2,1\n"), "line 2: row 2, column 1 is outside the map of 2 rows and 3"),
        (agents("agent id,row,col\n1,0,1\n"), "line 2: agent 1 where 0 is due"),
        (agents("agent id,row,col\n0,0\n"), "line 2: expected three numbers: agent id, row, column"),
        (tasks("targets\n1\nx\n"), "line 3, column 1: expected a whole number from 0, found `x`"),
        (tasks("1\n1,2,\n"), "line 2, column 5: expected a whole number from 0, found ``"),
        (tasks("1\n1,4\n"), "line 2: the target (1,1) lies in an obstacle"),
        (tasks("x\n"), "line 1, column 1: expected a whole number from 0, found `x`"),
    ];
    for (message, expected) in cases {
        assert!(message.starts_with(expected), "{message}");
    }
}

#[test]
fn problems_that_cannot_be_are_told_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("m.map", "type octile\nheight 1\nwidth 3\nmap\n...\n");
    write("a.agents", "1\n0\n");
    write("t.tasks", "1\n2,9\n");
    let problem = |extra: &str| {
        let text = format!(
            "{{\"mapFile\":\"m.map\",\"agentFile\":\"a.agents\",\"taskFile\":\"t.tasks\",\"delayConfig\":{{\"seed\":0}},{extra}}}"
        );
        write("p.json", &text);
        read_problem(&folder.path().join("p.json")).map_err(|error| error.to_string())
    };
    for (extra, expected) in [
        ("\"teamSize\":2", "p.json: teamSize is 2, but `a.agents` has 1 starts; make them agree"),
        ("\"teamSize\":1,\"numTasksReveal\":0", "p.json: numTasksReveal is 0"),
        ("\"teamSize\":-1", "p.json line 1, column"),
        ("\"team\":1", "not a problem of the League of Robot Runners: missing field `teamSize`"),
        ("\"teamSize\":1", "t.tasks line 2: cell 9 is outside the map of 3 cells"),
    ] {
        let message = problem(extra).unwrap_err();
        assert!(message.contains(expected) && !message.contains('\n'), "{message}");
    }
    write("t.tasks", "1\n2,1\n");
    let read = problem("\"teamSize\":1").unwrap();
    assert_eq!(
        (read.tasks, read.starts),
        (vec![vec![Cell::new(2, 0), Cell::new(1, 0)]], vec![Cell::new(0, 0)])
    );
    fs::remove_file(folder.path().join("m.map")).unwrap();
    assert!(problem("\"teamSize\":1").unwrap_err().contains("m.map: there is no such file"));
}

#[test]
fn changed_bytes_never_panic() {
    let map = Map::parse(Lattice::Square, "....\n....").unwrap();
    let good =
        ["# x\n3\n1,2\n3\n0,7,1\n", "2\n1\n5\n", "agent id,row,col\n0,0,1\n1,1,2\n", "targets\n1\n5\n"];
    let mut rng = Rng::new(1);
    for round in 0..4000 {
        let mut bytes = good[round % good.len()].as_bytes().to_vec();
        for _ in 0..=rng.below(3) {
            let at = rng.below(bytes.len() as u32) as usize;
            bytes[at] = if rng.chance(0.5) {
                rng.next_u64() as u8
            } else {
                b"0123456789,\n#-"[rng.below(14) as usize]
            };
        }
        let one_line = |error: activecell_formats::Error| {
            assert!(!error.to_string().contains(char::is_control), "{error:?}");
        };
        read_agents(&bytes, &map).map_or_else(one_line, drop);
        read_tasks(&bytes, &map).map_or_else(one_line, drop);
    }
}

/// Robots by chance; what was written is followed as `PlanViz` follows it.
#[test]
fn the_output_leads_where_the_robots_were() {
    let mut rng = Rng::new(5);
    for round in 0..200 {
        let turning = round % 2 == 0;
        let (robots, steps) = (1 + rng.below(4) as usize, rng.below(20) as usize);
        let mut cells = vec![(0..robots).map(|i| Cell::new(10 * i as i32, 50)).collect::<Vec<_>>()];
        let mut headings = vec![vec![Dir::E; robots]];
        for step in 0..steps {
            let (mut row, mut facing) = (cells[step].clone(), headings[step].clone());
            for robot in 0..robots {
                let dir = Dir(rng.below(4) as u8);
                match rng.below(4) {
                    0 if turning => facing[robot] = Lattice::Square.turned(facing[robot], 1),
                    1 if turning => facing[robot] = Lattice::Square.turned(facing[robot], -1),
                    2 if turning => row[robot] = Lattice::Square.neighbour(row[robot], facing[robot]),
                    0..3 if !turning => row[robot] = Lattice::Square.neighbour(row[robot], dir),
                    _ => {}
                }
            }
            cells.push(row);
            headings.push(facing);
        }
        let rows: Vec<&[Cell]> = cells.iter().map(Vec::as_slice).collect();
        let facing: Vec<&[Dir]> = headings.iter().map(Vec::as_slice).collect();
        let output = Output {
            cells: &rows,
            headings: if turning { &facing } else { &[] },
            tasks: &[],
            events: &[],
            planning_s: &[],
        };
        let file: Value = serde_json::from_str(&write_output(&output).unwrap()).unwrap();
        assert_eq!(file["actionModel"], if turning { "MAPF_T" } else { "MAPF" });
        for robot in 0..robots {
            let start = &file["start"][robot];
            let mut at = [start[0].as_i64().unwrap(), start[1].as_i64().unwrap()];
            // East, north, west, south, as PlanViz counts.
            let mut faces = 0_usize;
            let path = file["actualPaths"][robot].as_str().unwrap();
            let actions = path.split(',').filter(|action| !action.is_empty());
            for (step, action) in actions.enumerate() {
                let ahead = [[0, 1], [-1, 0], [0, -1], [1, 0]][faces];
                let go = match (turning, action) {
                    (true, "F") => ahead,
                    (false, "U") => [1, 0],
                    (false, "D") => [-1, 0],
                    (false, "L") => [0, -1],
                    (false, "R") => [0, 1],
                    _ => [0, 0],
                };
                match (turning, action) {
                    (true, "R") => faces = (faces + 3) % 4,
                    (true, "C") => faces = (faces + 1) % 4,
                    _ => {}
                }
                at = [at[0] + go[0], at[1] + go[1]];
                let cell = cells[step + 1][robot];
                assert_eq!(at, [i64::from(cell.y), i64::from(cell.x)], "{path}");
            }
        }
    }
}

#[test]
fn tasks_and_events_are_written() {
    let [a, b, c] = [0, 1, 2].map(|x| Cell::new(x, 3));
    let tasks = [vec![a, c], vec![b], vec![a]];
    let event = |step, robot, task, done| TaskEvent { step, robot, task, done };
    let events = [event(0, 0, 1, 0), event(1, 0, 1, 1), event(1, 0, 0, 0), event(2, 0, 0, 1)];
    let output = Output {
        cells: &[&[a], &[b], &[a]],
        headings: &[],
        tasks: &tasks,
        events: &events,
        planning_s: &[0.5],
    };
    let file: Value = serde_json::from_str(&write_output(&output).unwrap()).unwrap();
    for (key, expected) in [
        ("numTaskFinished", "1"),
        ("makespan", "2"),
        ("start", "[[3,0,\"E\"]]"),
        ("actualPaths", "[\"R,L\"]"),
        ("actualSchedule", "[\"0:1,1:0\"]"),
        ("events", "[[1,0,1,1],[2,0,0,1]]"),
        ("tasks", "[[1,0,[3,1]],[0,1,[3,0,3,2]]]"),
        ("plannerTimes", "[0.5]"),
        ("errors", "[]"),
    ] {
        assert_eq!(file[key].to_string(), expected, "{key}");
    }
    let jump = Output { cells: &[&[a], &[c]], ..output };
    let error = write_output(&jump).unwrap_err().to_string();
    assert!(error.starts_with("step 1: robot 0 does from (0,3) to (2,3)"), "{error}");
    for wrong in [
        Output { cells: &[], ..output },
        Output { cells: &[&[a], &[]], ..output },
        Output { headings: &[&[Dir::E]], ..output },
        Output { tasks: &[], ..output },
    ] {
        assert!(write_output(&wrong).is_err());
    }
}
