//! Plan files: what was written is read again, what other tools write is read, and what is wrong is told with its place.
#![expect(clippy::unwrap_used, reason = "a test may stop at the first surprise")]

mod common;

use activecell::{Bodies, Cell, KeepOut, Lattice, Map, Plan};
use activecell_formats::plan::{MAX_PLAN_CELLS, PlanFile, PlanFormat, Stated, read_plan};
use proptest::prelude::*;

fn at(x: i32, y: i32) -> Cell {
    Cell::new(x, y)
}

fn refused(bytes: impl AsRef<[u8]>) -> String {
    let message = read_plan(bytes.as_ref()).unwrap_err().to_string();
    assert!(!message.contains(char::is_control), "{message:?}");
    message
}

/// A plan of robots that walk, rest, and now and then jump.
fn plans() -> impl Strategy<Value = (Lattice, Plan)> {
    let lattice = prop::sample::select(Lattice::ALL.to_vec());
    (lattice, 0..6_usize, 0..12_usize).prop_flat_map(|(lattice, robots, steps)| {
        let start = (-3..9_i32, -3..9_i32);
        let moves = prop::collection::vec(0..16_u8, steps);
        prop::collection::vec((start, moves), robots).prop_map(move |walks| {
            let paths = walks.iter().map(|&((x, y), ref moves)| {
                let mut path = vec![at(x, y)];
                for &choice in moves {
                    let here = path[path.len() - 1];
                    path.push(match lattice.dirs().nth(choice.into()) {
                        Some(dir) => lattice.neighbour(here, dir),
                        None if choice == 15 => at(here.y - 40, here.x + 1000),
                        None => here,
                    });
                }
                path
            });
            let paths: Vec<Vec<Cell>> = paths.collect();
            let steps = if paths.is_empty() { 0 } else { steps };
            let cells = (0..=steps).flat_map(|step| paths.iter().map(move |path| path[step])).collect();
            (lattice, Plan::new(paths.len(), cells).unwrap())
        })
    })
}

fn stated() -> impl Strategy<Value = Stated> {
    let name = prop::option::of("[a-z0-9.=/-]{1,20}");
    let number = prop::option::of(0..1_000_000_u64);
    (name.clone(), name, number.clone(), number.clone(), number, prop::option::of(0.0..1e9_f64)).prop_map(
        |(map_file, solver, seed, lower_bound, makespan_lower_bound, comp_time_ms)| Stated {
            map_file,
            solver,
            seed,
            lower_bound,
            makespan_lower_bound,
            comp_time_ms,
            ..Stated::default()
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn what_was_written_is_read_again(
        (lattice, plan) in plans(),
        stated in stated(),
        targets in any::<bool>(),
        (sizes, distance) in (prop::option::of(0..4_u32), 1..4_u32),
        closed in prop::collection::vec((-9..9, -9..9, 0..9_u32, 0..9_u32), 0..4),
    ) {
        let sums = (Some(plan.sum_of_costs()), Some(plan.makespan() as u64));
        let radii = sizes.map(|size| (0..plan.robots() as u32).map(|robot| robot % (size + 1)).collect());
        let mut file = PlanFile::new(plan);
        file.bodies = Bodies::new(radii.unwrap_or_default(), distance).unwrap();
        let keep_out = |(x, y, from_step, to_step)| KeepOut { cell: at(x, y), from_step, to_step };
        file.keep_outs = closed.into_iter().map(keep_out).collect();
        file.lattice = Some(lattice);
        file.stated = Stated { sum_of_costs: sums.0, makespan: sums.1, ..stated };
        // Elsewhere than where they end.
        file.targets = targets.then(|| file.targets().iter().map(|cell| at(cell.x - 1, cell.y)).collect());
        if file.plan.robots() == 0 {
            file.targets = None;
        }
        let json = file.write(PlanFormat::Json).unwrap();
        prop_assert_eq!(&read_plan(json.as_bytes()).unwrap(), &file, "{}", json);
        let text = file.write(PlanFormat::Text).unwrap();
        let read = read_plan(text.as_bytes()).unwrap();
        prop_assert_eq!((&read.plan, &read.stated, read.lattice), (&file.plan, &file.stated, file.lattice));
        prop_assert_eq!((read.starts(), read.targets()), (file.starts(), file.targets()));
        let windows = text.replace('\n', "\r\n").replace("),\r", ")\r");
        prop_assert_eq!(read_plan(windows.as_bytes()).unwrap(), read);
        // Paths end with the robots' rests.
        let paths = file.write(PlanFormat::Paths).unwrap();
        if file.plan.robots() > 0 {
            let read = read_plan(paths.as_bytes()).unwrap();
            prop_assert_eq!(read.plan.costs(), file.plan.costs());
            for step in 0..=file.plan.steps() {
                prop_assert_eq!(read.plan.row(step), file.plan.row(step));
            }
        }
    }

    #[test]
    fn mangled_bytes_never_panic(
        (lattice, plan) in plans(),
        format in prop::sample::select(PlanFormat::ALL.to_vec()),
        changes in common::changes(),
    ) {
        let mut file = PlanFile::new(plan);
        file.lattice = Some(lattice);
        let bytes = common::changed(file.write(format).unwrap().into_bytes(), changes);
        if let Err(error) = read_plan(&bytes) {
            prop_assert!(!error.to_string().contains(char::is_control), "{error:?}");
        }
    }

    #[test]
    fn noise_never_panics(text in "(agents=|starts=|goals=|solution=\n|[0-9]:|\\([0-9]{1,12},-?[0-9]\\),?|Agent |->|\\{\"activecell\":\"plan\"|\\PC|\n){0,30}") {
        let _ = read_plan(text.as_bytes());
    }
}

#[test]
fn maps_travel_in_json() {
    let map = Map::parse(Lattice::Hex, "S..\n.#.\n..F").unwrap();
    let mut file = PlanFile::new(Plan::new(1, vec![at(0, 0), at(1, 0)]).unwrap());
    file.lattice = Some(Lattice::Hex);
    file.stated = Stated { sum_of_costs: Some(1), makespan: Some(1), ..Stated::default() };
    file.map = Some(map);
    let text = file.write(PlanFormat::Json).unwrap();
    assert_eq!(read_plan(text.as_bytes()).unwrap(), file);
    assert!(text.contains("\n{\"start\":[0,0],\"moves\":\"E\"}"), "{text}");
    let rows = text.lines().filter(|line| line.contains("\"S..\"") || line.starts_with("\".#.\""));
    assert_eq!(rows.count(), 2, "{text}");
    assert!(refused(text.replacen("\"hex\"", "\"square\"", 1)).contains("map.lattice hex; make them agree"));
}

#[test]
fn what_other_tools_write_is_read() {
    let lacam = "agents=2\nmap_file=empty-8-8.map\nsolver=planner\nsolved=1\nsoc=3\nsoc_lb=3\nmakespan=2\nmakespan_lb=2\n\
        sum_of_loss=3\nsum_of_loss_lb=3\ncomp_time=0.271\nseed=7\ncheckpoints=1,2,\nstarts=(0,0),(3,3),\n\
        goals=(2,0),(3,4),\nsolution=\n0:(0,0),(3,3),\n1:(1,0),(3,4),\n2:(2,0),(3,4),\n";
    let file = read_plan(lacam.as_bytes()).unwrap();
    assert_eq!((file.plan.robots(), file.plan.steps(), file.plan.sum_of_costs()), (2, 2, 3));
    assert_eq!(file.starts.as_deref(), Some(&[at(0, 0), at(3, 3)][..]));
    assert_eq!(file.targets.as_deref(), Some(&[at(2, 0), at(3, 4)][..]));
    let Stated { map_file, seed, comp_time_ms, makespan_lower_bound, .. } = file.stated;
    assert_eq!((map_file.as_deref(), seed), (Some("empty-8-8.map"), Some(7)));
    assert_eq!((comp_time_ms, makespan_lower_bound), (Some(0.271), Some(2)));

    let pibt2 = "instance=a.txt\nagents=2\nmap_file=a.map\nsolver=PIBT\nsolved=1\nservice_time=2.5\nmakespan=1\nlb_soc=2\n\
        starts=(0,0),(3,3),\ntask=\n0:5->7,appear=0,finished=1\nsolution=\n0:(0,0)->(1,0):0,(3,3)->(3,3):-1,\n\
        1:(1,0)->(1,0):-1,(3,3)->(3,3):-1,\n";
    let file = read_plan(pibt2.as_bytes()).unwrap();
    assert_eq!((file.plan.at(1, 0), file.targets, file.stated.lower_bound), (at(1, 0), None, Some(2)));

    let turning = "solution=\n0:(5,1,X_PLUS),\n1:(5,1,Y_MINUS)\n";
    assert_eq!(read_plan(turning.as_bytes()).unwrap().plan.at(1, 0), at(5, 1));

    let lns = "Agent 0:(1,5)->(1,6)->(2,6)->\nAgent 1: (0,0)->(0,1)\n\n";
    let file = read_plan(lns.as_bytes()).unwrap();
    assert_eq!((file.plan.row(0), file.plan.row(2)), (&[at(5, 1), at(0, 0)][..], &[at(6, 2), at(1, 0)][..]));
}

#[test]
fn faults_have_their_place() {
    let cases = [
        ("", "the file is empty; give one with a plan, of no robots in .txt or .json"),
        ("\u{feff} \r\n", "the file is empty"),
        ("agents=1\n", "line 1: the file ends before `solution=`"),
        ("seed=1\nsoc=3\nseed=1\nsolution=\n", "line 3: `seed=` is stated twice; remove one of the lines"),
        ("goals=(0,0)\nother=1\nother=2\ngoals=\nsolution=\n", "line 4: `goals=` is stated twice"),
        ("agents=x\nsolution=\n", "line 1, column 8: agents is `x`; give a whole number from 0"),
        ("starts=(0,0)(1,1)\nsolution=\n", "line 1, column 13: expected `,`, found `(`"),
        ("solution=\n0:(0,0),\n2:(0,0),\n", "line 3, column 2: step 2 where step 1 is due"),
        ("solution=\n0:(0,0),(1,1),\n1:(0,0),\n", "line 3, column 9: step 1 has 1 cells, step 0 has 2"),
        ("solution=\n0:(0,99999999999),\n", "line 2, column 6: a number above 1073741824"),
        (
            "solution=\n0:(0,0),\n1:(0,",
            "line 3, column 6: expected a whole number, found the end of the line",
        ),
        ("solution=\n0:(0,0,),\n", "line 2, column 8: expected a direction as `X_PLUS`, or `)`"),
        ("agents=2\nsolution=\n0:(0,0),\n", "`agents=` has 2 robots, the solution 1; make them agree"),
        ("goals=(0,0),(1,0),\nsolution=\n0:(0,0),\n", "`goals=` has 2 cells, the solution 1"),
        ("lattice=round\nsolution=\n", "line 1, column 9: lattice is `round`; give `square` or `hex`"),
        ("agents=3\nsolved=0\nstarts=\nsolution=\n", "`solved=0`: the file says that no plan was found"),
        ("agents=3\nsolution=\n", "there is no step after `solution=`"),
        ("Agent 1: (0,0)\n", "line 1, column 8: agent 1 where agent 0 is due"),
        ("Agent 0: (0,0)->(0,1)(0,2)\n", "line 1, column 22: expected `->` and a cell, found `(`"),
        ("Agent 0: (0,0)\nRobot 1: (0,0)\n", "line 2, column 1: expected `Agent`"),
        ("{\"activecell\":\"plan\",\n\"version\":", "line 2, column 10: not a plan file: EOF"),
        ("{\"activecell\":\"run\",\"version\":1}", "activecell is `run`, not `plan`"),
        ("{\"activecell\":\"plan\",\"version\":2,\"new\":1}", "version 2 is not known here, only 1"),
    ];
    for (text, expected) in cases {
        let message = refused(text);
        assert!(message.starts_with(expected), "{text:?}: {message}");
    }
    let json = |lattice: &str, steps: &str, robots: &str| {
        refused(format!(
            "{{\"activecell\":\"plan\",\"version\":1,\"lattice\":\"{lattice}\",\"steps\":{steps},\"robots\":[{robots}]}}"
        ))
    };
    let robot = |moves: &str| format!("{{\"start\":[0,0],\"moves\":\"{moves}\"}}");
    let cases = [
        (json("round", "1", ""), "lattice is `round`; it must be square or hex"),
        (
            json("square", "2", &robot("E NE")),
            "robots[0].moves: `NE` is no move on this lattice; use N, E, S, W or `.`",
        ),
        (json("hex", "1", &robot("N")), "robots[0].moves: `N` is no move on this lattice; use NE, E,"),
        (json("hex", "1", &robot("E2")), "robots[0] makes more steps than `steps`, 1"),
        (json("hex", "1", &robot("E99999999999999999999999")), "robots[0].moves: `E9999"),
        (json("hex", "1", &robot("E0")), "robots[0].moves: `E0` is no move"),
        (json("hex", "1", &robot("(1,2")), "robots[0].moves: `(1,2` is no cell"),
        (json("hex", "1", "{\"start\":[2000000000,0],\"moves\":\"\"}"), "robots[0].start has a number above"),
        (
            json(
                "hex",
                "0",
                "{\"start\":[0,0],\"target\":[0,0],\"moves\":\"\"},{\"start\":[0,0],\"moves\":\"\"}",
            ),
            "robots[1] has no target",
        ),
    ];
    for (message, expected) in cases {
        assert!(message.starts_with(expected), "{message}");
    }
}

/// A few bytes that say that they are much.
#[test]
fn hostile_sizes_are_refused_before_memory_is_taken() {
    let robot = "{\"start\":[0,0],\"moves\":\"\"}";
    for steps in [MAX_PLAN_CELLS.to_string(), usize::MAX.to_string()] {
        let text = format!(
            "{{\"activecell\":\"plan\",\"version\":1,\"lattice\":\"hex\",\"steps\":{steps},\"robots\":[{robot}]}}"
        );
        assert!(refused(&text).starts_with(&format!("1 robots with {steps} steps are more than")));
        let nobody = text.replace(robot, "");
        assert_eq!(read_plan(nobody.as_bytes()).unwrap().plan.steps(), 0);
    }
    // One long path and many short ones.
    let long = "(0,0)->".repeat(4000);
    let agents: Vec<String> = (1..40_000).map(|robot| format!("Agent {robot}:(0,0)")).collect();
    let message = refused(format!("Agent 0:{long}\n{}", agents.join("\n")));
    assert!(message.starts_with("40000 robots with 3999 steps are more than"), "{message}");
    assert!(refused("agents=99999999999\nsolution=\n0:(0,0)\n").starts_with("`agents=` has 99999999999"));
    assert!(refused("{".to_owned() + &"[".repeat(100_000)).contains("not a plan file"));
}
