//! The navigator with its map in block RAM goes where the published rule goes, clock by clock.

#![allow(clippy::unwrap_used)] // A test may panic.

mod common;

use activecell::{Cell, Lattice, Map, Outcome, Rng, Rule};
use activecell_codegen::model::{Shown, Status, Windowed, WindowedInputs};
use activecell_codegen::{Banks, SourceFile, verilog};
use activecell_formats::files::{ReadOptions, read_map};
use common::cxxrtl::Simulation;
use std::path::{Path, PathBuf};

type Task = (Cell, Cell);
/// What is given with a clock's edge, and what is shown before it.
type Clock = (WindowedInputs, Shown);

const STEP: WindowedInputs = WindowedInputs { enable: true, reset: false, begin: None };

/// Two free cells.
fn task(map: &Map, rng: &mut Rng) -> Option<Task> {
    let free: Vec<Cell> = map.free().collect();
    let mut cell = || free.get(rng.below(free.len().max(1) as u32) as usize).copied();
    Some((cell()?, cell()?))
}

/// So many tasks; every fifth leads to any two numbers that the ports can hold.
fn tasks(map: &Map, count: usize, rng: &mut Rng) -> Vec<Task> {
    let mut given: Vec<Task> = (0..count).filter_map(|_| task(map, rng)).collect();
    for (_, target) in given.iter_mut().skip(4).step_by(5) {
        let number = |size: u32| rng.below(size.next_power_of_two().max(2)) as i32;
        let [x, y] = [map.width(), map.height()].map(number);
        *target = Cell::new(x, y);
    }
    given
}

/// A task as the model runs it, a step a clock.
fn trace(map: &Map, task: Task) -> Vec<Clock> {
    let mut navigator = Windowed::new(map);
    let mut clocks = Vec::new();
    let mut clock = |inputs| {
        clocks.push((inputs, navigator.shown()));
        navigator.clock(inputs);
        navigator.shown().status == Status::Busy
    };
    clock(STEP);
    clock(WindowedInputs { begin: Some(task), ..STEP });
    while clock(STEP) {}
    clock(STEP);
    clocks
}

/// The tasks as the model runs them, one after the other, with pauses: every second makes a step at random clocks, every third
/// is cut off, if it lasts as long, half of these by a reset.
fn rough_trace(map: &Map, tasks: &[Task], rng: &mut Rng) -> Vec<Clock> {
    let mut navigator = Windowed::new(map);
    let mut clocks = Vec::new();
    let mut clock = |inputs| {
        clocks.push((inputs, navigator.shown()));
        navigator.clock(inputs);
        navigator.shown().status == Status::Busy
    };
    clock(STEP);
    for (i, &task) in tasks.iter().enumerate() {
        let pause = [1, 3][i % 2];
        let mut enable = || rng.below(pause) == 0;
        clock(WindowedInputs { begin: Some(task), enable: enable(), reset: i % 12 == 11 });
        let longest = if i % 3 == 2 { 7 } else { usize::MAX };
        (0..longest).find(|_| !clock(WindowedInputs { enable: enable(), ..STEP }));
        clock(WindowedInputs { enable: enable(), reset: i % 6 == 5, begin: None });
    }
    clock(STEP);
    clocks
}

/// The navigator of all maps of the size of this one.
fn compile(tools: &[PathBuf; 2], map: &Map) -> Simulation {
    let lattice = map.lattice();
    let folder = common::folder(&format!("windowed_{lattice}_{}x{}", map.width(), map.height()));
    common::write(&folder, &verilog::windowed(map).unwrap());
    let script =
        format!("read_verilog rtl/*.v; hierarchy -check -top windowed_{lattice}; proc; flatten; opt");
    let bank = |i: usize| {
        format!(
            "&top.memory_p_fetch_2e_bank__rows_5b_{}_5d__2e_banks_5b_{}_5d__2e_bank_2e_tiles",
            i / 4,
            i % 4
        )
    };
    let main = include_str!("windowed_sim/navigator.cc")
        .replace("@TOP@", &format!("windowed__{lattice}"))
        .replace("@BANKS@", &(0..16).map(bank).collect::<Vec<_>>().join(", "));
    Simulation::compile(tools, &folder, &script, &main)
}

/// What the simulation shows for these clocks on this map must be what the model shows.
fn compare(simulation: &Simulation, map: &Map, clocks: &[Clock]) {
    let mut input = (clocks.len() as u32).to_le_bytes().to_vec();
    input.extend(Banks::of(map).unwrap().images.concat());
    let numbers = |cell: Cell| [cell.x, cell.y].map(|at| (at as u16).to_le_bytes()).concat();
    let mut expected = Vec::new();
    for (WindowedInputs { reset, enable, begin }, shown) in clocks {
        let (start, target) = begin.unwrap_or_default();
        input.push(u8::from(*reset) << 2 | u8::from(*enable) << 1 | u8::from(begin.is_some()));
        input.extend([numbers(start), numbers(target)].concat());
        let direction = shown.direction.map_or(0, |dir| 1 << dir.0);
        expected.push([numbers(shown.cell), vec![direction, shown.status.outputs()]].concat());
    }
    // The last clock's edge is seen by none.
    let output = simulation.run(&input);
    assert_eq!(output.len() / 6, expected.len() + 1);
    for (n, (shown, expected)) in output.chunks(6).zip(&expected).enumerate() {
        assert_eq!(shown, expected, "{} map {}x{}, clock {n}", map.lattice(), map.width(), map.height());
    }
}

#[test]
fn verilog_shows_what_the_model_shows_on_random_maps() {
    let test = "verilog_shows_what_the_model_shows_on_random_maps";
    let Some(tools) = common::programs(test, ["yosys", "g++"]) else { return };
    let (mut maps, mut all, mut clocks) = (0, 0, 0);
    for lattice in Lattice::ALL {
        for (width, height) in [(5, 3), (37, 23), (16, 31), (64, 63)] {
            let map = |seed: u64| {
                let density = [0.0, 0.1, 0.2, 0.3, 0.45][seed as usize % 5];
                Map::random(lattice, width, height, density, seed).unwrap()
            };
            let simulation = compile(&tools, &map(1));
            for seed in 0..26 {
                let (map, mut rng) = (map(seed), Rng::new(seed));
                let given = tasks(&map, 6, &mut rng);
                let trace = rough_trace(&map, &given, &mut rng);
                compare(&simulation, &map, &trace);
                (maps, all, clocks) = (maps + 1, all + given.len(), clocks + trace.len());
            }
        }
    }
    println!("{maps} random maps, {all} tasks, {clocks} clocks: the Verilog shows what the model shows");
}

#[test]
fn verilog_shows_what_the_model_shows_on_real_maps() {
    let test = "verilog_shows_what_the_model_shows_on_real_maps";
    let Some(tools) = common::programs(test, ["yosys", "g++"]) else { return };
    let data = std::env::var_os("ACTIVECELL_DATA").unwrap_or_else(|| "../shared/data".into());
    let data = common::root().join(data);
    let names = ["mapf/Berlin_1_256.map", "mapf/room-64-64-8.map", "ros/tb3_sandbox.yaml"];
    for (name, lattice) in names.iter().zip([Lattice::Square, Lattice::Hex, Lattice::Hex]) {
        let path = data.join(name);
        if !path.is_file() {
            println!("SKIPPED: {} not found; set ACTIVECELL_DATA to the folder of real maps", path.display());
            continue;
        }
        let (map, _) = read_map(&path, &ReadOptions::default()).unwrap();
        let map = map.on(lattice);
        let mut rng = Rng::new(1);
        let tasks = tasks(&map, 100, &mut rng);
        let trace = rough_trace(&map, &tasks, &mut rng);
        compare(&compile(&tools, &map), &map, &trace);
        println!("{name} on {lattice}: {} tasks, {} clocks as the model", tasks.len(), trace.len());
    }
}

/// The model goes through the cells of the core's route, and its outcome is that one's; a trapped robot goes on in its cycle
/// until that is found.
#[test]
fn the_model_follows_the_published_rule() {
    let mut outcomes = [0; 3];
    let mut rng = Rng::new(2);
    for seed in 0..300 {
        let lattice = Lattice::ALL[seed as usize % 2];
        let size = 3 + rng.below(40);
        let map = Map::random(lattice, size, 1 + rng.below(40), rng.unit() / 2.0, seed).unwrap();
        let Some((from, to)) = task(&map, &mut rng) else { continue };
        let clocks = trace(&map, (from, to));
        let cells: Vec<Cell> = clocks[3..].iter().map(|(_, shown)| shown.cell).collect();
        let last = clocks.last().unwrap().1;
        let route = map.route(Rule::Published, from, to, 0).unwrap();
        let steps = route.steps();
        assert_eq!(cells[..=steps], *route.cells(), "{lattice} seed {seed}");
        let ended = [Status::Arrived, Status::Enclosed, Status::Trapped].map(|status| status == last.status);
        let expected = [Outcome::Arrived, Outcome::Enclosed, Outcome::Trapped];
        assert_eq!(ended, expected.map(|outcome| outcome == route.outcome()), "{lattice} seed {seed}");
        let moves = clocks.iter().filter(|(_, shown)| shown.direction.is_some()).count();
        if last.status == Status::Trapped {
            let cycle = route.cycle();
            assert!(cells[steps..].iter().all(|cell| cycle.contains(cell)));
            // Brent's bound: found before three times the steps until the first repeated cell.
            assert!(moves <= 3 * steps, "{moves} moves, first repeated after {steps}");
        } else {
            assert_eq!(moves, steps);
        }
        for (count, ended) in outcomes.iter_mut().zip(ended) {
            *count += usize::from(ended);
        }
    }
    assert!(outcomes[0] > 50 && outcomes[2] > 50, "{outcomes:?}");
    println!(
        "arrived {}, enclosed {}, trapped {}: the model's routes are the core's",
        outcomes[0], outcomes[1], outcomes[2]
    );
}

/// Targets on obstacles, beside the robot or far from it, and outside the map: the task ends, and not at the target.
#[test]
fn tasks_without_a_way_end() {
    let mut ended = 0;
    for seed in 0..300 {
        let lattice = Lattice::ALL[seed as usize % 2];
        let map = Map::random(lattice, 20, 9, 0.3, seed).unwrap();
        let mut rng = Rng::new(seed);
        for _ in 0..10 {
            let target = Cell::new(rng.below(32) as i32, rng.below(16) as i32);
            let Some((start, _)) = task(&map, &mut rng).filter(|_| !map.is_free(target)) else { continue };
            let status = trace(&map, (start, target)).last().unwrap().1.status;
            assert!(
                [Status::Trapped, Status::Enclosed].contains(&status),
                "{lattice} seed {seed}: {status:?}"
            );
            ended += 1;
        }
    }
    println!("{ended} tasks to obstacles and beyond the map: each ends trapped or enclosed");
}

#[test]
fn maps_beyond_block_ram_are_refused_and_texts_repeat() {
    let large = Map::random(Lattice::Square, 2049, 1025, 0.0, 1).unwrap();
    let refused = verilog::windowed(&large).unwrap_err().to_string();
    assert!(refused.starts_with("map of 2049 x 1025 cells is too large: at most 4194304 cells"), "{refused}");
    let map = Map::random(Lattice::Hex, 20, 30, 0.2, 1).unwrap();
    assert_eq!(verilog::windowed(&map), verilog::windowed(&map));
}

/// At every position, come to from every neighbouring one: on a map that fills the banks, and on one with a border.
#[test]
fn windows_are_the_cells_of_the_map() {
    let Some(tools) = common::programs("windows_are_the_cells_of_the_map", ["yosys", "g++"]) else { return };
    for (width, height) in [(64, 64), (62, 30)] {
        let map = Map::random(Lattice::Square, width, height, 0.4, 9).unwrap();
        let folder = common::folder(&format!("window_{width}x{height}"));
        common::write(&folder, &verilog::windowed(&map).unwrap());
        let script = "read_verilog rtl/map_window.v rtl/map_bank.v; hierarchy -check -top map_window; proc; flatten; opt";
        let simulation = Simulation::compile(&tools, &folder, script, include_str!("windowed_sim/window.cc"));
        let around = |cell: Cell, reach: i32| {
            let rows = -reach..=reach;
            rows.flat_map(move |y| (-reach..=reach).map(move |x| Cell::new(cell.x + x, cell.y + y)))
        };
        let all = (0..height as i32).flat_map(|y| (0..width as i32).map(move |x| Cell::new(x, y)));
        let pairs: Vec<(Cell, Cell)> =
            all.flat_map(|cell| around(cell, 1).map(move |before| (before, cell))).collect();
        let numbers = |cell: Cell| [cell.x, cell.y].map(|at| (at as u16).to_le_bytes()).concat();
        let input: Vec<u8> =
            pairs.iter().flat_map(|&(before, cell)| [numbers(before), numbers(cell)].concat()).collect();
        let output = simulation.run(&input);
        assert_eq!(output.len(), 4 * pairs.len());
        for (window, (before, cell)) in output.chunks(4).zip(&pairs) {
            let bits = around(*cell, 2).enumerate();
            let expected = bits.fold(0, |bits, (i, cell)| bits | u32::from(!map.is_free(cell)) << i);
            assert_eq!(window, expected.to_le_bytes(), "at {cell} from {before}");
        }
        println!("{width}x{height}: {} windows are the map's", pairs.len());
    }
}

/// Runs a bench of a folder; what it prints.
fn simulated([iverilog, vvp]: &[PathBuf; 2], folder: &Path, files: &[SourceFile], bench: &str) -> String {
    common::write(folder, files);
    let sources = files.iter().map(|file| &file.path).filter(|path| !path.ends_with("hex"));
    let mut compile = common::command(iverilog, folder);
    compile.args(["-g2005", "-Wall", "-Wno-timescale", "-s", bench, "-o", "bench.vvp"]).args(sources);
    let output = compile.output().expect("iverilog was found");
    assert_eq!(String::from_utf8_lossy(&output.stderr), "", "warnings");
    common::run(common::command(vvp, folder).args(["-n", "bench.vvp"]))
}

/// The bench that is delivered passes, and finds a wrong line of its file; the example goes where the rule goes.
#[test]
fn test_benches_pass_and_find_faults() {
    let Some(tools) = common::programs("test_benches_pass_and_find_faults", ["iverilog", "vvp"]) else {
        return;
    };
    for (i, (width, height)) in [(20, 13), (64, 64), (1, 1), (33, 70)].into_iter().enumerate() {
        for lattice in Lattice::ALL {
            let map = Map::random(lattice, width, height, 0.2, i as u64).unwrap();
            let folder = common::folder(&format!("bench_{lattice}_{width}x{height}"));
            let mut files = verilog::windowed(&map).unwrap();
            let told = simulated(&tools, &folder, &files, "windowed_tb");
            assert!(told.starts_with("PASS windowed"), "{told}");
            print!("{lattice} {width}x{height}: {told}");
            common::check_example(&map, &simulated(&tools, &folder, &files, "windowed_example_tb"));

            let trace = files.iter_mut().find(|file| file.path == "tb/windowed.hex").unwrap();
            let end = trace.text.len() - 2;
            let other = if &trace.text[end..=end] == "0" { "8" } else { "0" };
            trace.text.replace_range(end..=end, other);
            let told = simulated(&tools, &folder, &files, "windowed_tb");
            assert!(told.starts_with("FAIL windowed") && !told.contains("PASS"), "{told}");
        }
    }
}
