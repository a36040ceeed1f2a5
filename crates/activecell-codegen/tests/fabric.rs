//! The generated fabric against its model and the core.

#![expect(clippy::unwrap_used, reason = "a test that cannot prepare itself should stop")]

mod common;

use activecell::{BitPlane, Cell, Lattice, Map, Rng};
use activecell_codegen::model::fabric::{Fabric, Inputs, Outputs};
use activecell_codegen::{long_way, verilog};
use common::aig::{Aig, aig};
use std::path::{Path, PathBuf};

const INPUTS: [&str; 8] =
    ["reset", "load_map", "scan_in", "begin_task", "start_x", "start_y", "target_x", "target_y"];
const OUTPUTS: [&str; 6] = ["busy", "moving", "at_x", "at_y", "arrived", "unreachable"];

/// The generated fabric beside its model: both are given the same, and must show the same after every clock.
struct Pair {
    fabric: Fabric,
    gates: Aig,
    inputs: Vec<Vec<usize>>,
    outputs: Vec<usize>,
    lanes: u8,
    clocks: usize,
}

impl Pair {
    fn new(test: &str, map: &Map, loadable: bool) -> Option<Self> {
        let files = verilog::fabric(map, loadable).unwrap();
        // The wires of every cell, by patterns of their names: `row[2].column[1].reached`, or the like.
        let wires = [r"reached\[*", r"active\[*", r"row*\].on_map.pointer"];
        let gates = aig(test, &files, "fabric", &wires)?;
        let inputs = INPUTS.map(|name| gates.port(name)).to_vec();
        let mut outputs: Vec<usize> = OUTPUTS.iter().flat_map(|name| gates.port(name)).collect();
        // From 1: row 0 and column 0 are of the frame around the map. Of an array yosys counts the words.
        let cells: Vec<(u32, u32)> =
            (1..=map.height()).flat_map(|y| (1..=map.width()).map(move |x| (x, y))).collect();
        for array in ["reached", "active"] {
            let word = |&(x, y): &(u32, u32)| gates.port(&format!("{array}[{}]", y * (map.width() + 2) + x));
            outputs.extend(cells.iter().flat_map(word));
        }
        for (x, y) in cells {
            outputs.extend(gates.port(&format!("row[{y}].column[{x}].on_map.pointer")));
        }
        let lanes = map.lattice().degree();
        let fabric = if loadable { Fabric::unloaded(map) } else { Fabric::new(map) };
        let mut pair = Self { fabric, gates, inputs, outputs, lanes, clocks: 0 };
        // Pointers need no reset: they hold anything before the second clock.
        for _ in 0..2 {
            pair.clock_unseen(Inputs { reset: true, ..Inputs::default() });
        }
        Some(pair)
    }

    fn clock_unseen(&mut self, inputs: Inputs) -> Outputs {
        let (from, to) = inputs.begin.unwrap_or_default();
        let flags = [inputs.reset, inputs.load.is_some(), inputs.load == Some(true), inputs.begin.is_some()];
        let ends = [from.x, from.y, to.x, to.y].map(|coordinate| coordinate as u32);
        for (port, number) in self.inputs.iter().zip(flags.map(u32::from).into_iter().chain(ends)) {
            self.gates.drive_all(port, number);
        }
        self.gates.clock();
        self.clocks += 1;
        self.fabric.clock(inputs)
    }

    fn clock(&mut self, inputs: Inputs) -> Outputs {
        let shown = self.clock_unseen(inputs);
        let seen = self.outputs.iter().map(|&place| self.gates.seen(place) & 1 == 1);
        let number = |bits: usize, value: i32| (0..bits).map(move |bit| value >> bit & 1 == 1);
        let [x_bits, y_bits] = ["at_x", "at_y"].map(|name| self.gates.port(name).len());
        let lanes = |bits: u8| (0..self.lanes).map(move |lane| bits >> lane & 1 == 1);
        let expected = [shown.busy, shown.moving]
            .into_iter()
            .chain(number(x_bits, shown.at.x))
            .chain(number(y_bits, shown.at.y))
            .chain([shown.arrived, shown.unreachable])
            .chain(self.fabric.reached())
            .chain(self.fabric.active())
            .chain(self.fabric.pointers().flat_map(lanes));
        assert!(seen.eq(expected), "clock {}: {shown:?}", self.clocks);
        shown
    }

    fn task(&mut self, from: Cell, to: Cell) {
        let mut shown = self.clock(Inputs { begin: Some((from, to)), ..Inputs::default() });
        while shown.busy {
            shown = self.clock(Inputs::default());
        }
    }

    fn load(&mut self, map: &Map) {
        let (width, height) = (map.width() as i32, map.height() as i32);
        for cell in (0..height).flat_map(|y| (0..width).map(move |x| Cell::new(x, y))) {
            self.clock(Inputs { load: Some(!map.is_free(cell)), ..Inputs::default() });
        }
    }
}

/// Runs tasks on each map, in one simulation if the fabric is loadable, and compares clock by clock.
fn compare(test: &str, maps: &[Map], loadable: bool, tasks: usize) {
    let first = &maps[0];
    let Some(mut pair) = Pair::new(test, first, loadable) else { return };
    if loadable {
        // Nothing is loaded yet: no way leads anywhere.
        pair.task(Cell::new(0, 0), Cell::new(0, 0));
        assert!(pair.clock(Inputs::default()).unreachable);
    }
    let mut rng = Rng::new(7);
    for map in maps {
        if loadable {
            pair.load(map);
        }
        let free: Vec<Cell> = map.free().collect();
        // Starts and targets that are free, and now and then any that the ports can say, also outside.
        let sayable = [map.width(), map.height()].map(|count| count.next_power_of_two().max(2));
        let mut end = || match rng.below(10) {
            0 => Cell::new(rng.below(sayable[0]) as i32, rng.below(sayable[1]) as i32),
            _ if free.is_empty() => Cell::default(),
            _ => free[rng.below(free.len() as u32) as usize],
        };
        for _ in 0..tasks {
            let [from, to, other] = [end(), end(), end()];
            pair.task(from, to);
            // A task that another cuts short.
            pair.clock(Inputs { begin: Some((to, from)), ..Inputs::default() });
            for _ in 0..(from.x + to.y + other.x) {
                pair.clock(Inputs::default());
            }
            pair.task(other, to);
            // One that a reset cuts short.
            pair.clock(Inputs { begin: Some((to, from)), ..Inputs::default() });
            for _ in 0..to.x {
                pair.clock(Inputs::default());
            }
            pair.clock(Inputs { reset: true, begin: Some((from, to)), ..Inputs::default() });
            pair.clock(Inputs::default());
            // One that may be cut short by loading.
            pair.clock(Inputs { begin: Some((other, from)), ..Inputs::default() });
            for _ in 0..from.x {
                pair.clock(Inputs::default());
            }
        }
    }
    let (lattice, width, height) = (first.lattice(), first.width(), first.height());
    let kind = if loadable { "loaded" } else { "fixed" };
    println!(
        "fabric {lattice} {width} x {height}: {} {kind} maps, {} tasks, {} clocks as the model",
        maps.len(),
        5 * tasks * maps.len(),
        pair.clocks
    );
}

fn random_maps(lattice: Lattice, width: u32, height: u32, count: u64) -> Vec<Map> {
    let map = |seed| Map::random(lattice, width, height, (seed % 6) as f64 / 10.0, seed).unwrap();
    (0..count).map(map).collect()
}

#[test]
fn loaded_fabrics_do_as_the_model_at_every_clock() {
    for lattice in Lattice::ALL {
        for (width, height) in [(8, 8), (11, 3), (1, 6), (1, 1)] {
            let maps = random_maps(lattice, width, height, 100);
            compare(&format!("fabric_loaded_{lattice}_{width}_{height}"), &maps, true, 4);
        }
    }
}

#[test]
fn fixed_fabrics_do_as_the_model_at_every_clock() {
    for lattice in Lattice::ALL {
        for (width, height, seed) in [(8, 8, 2), (7, 12, 3)] {
            let map = Map::random(lattice, width, height, 0.3, seed).unwrap();
            compare(&format!("fabric_fixed_{lattice}_{width}_{height}"), &[map], false, 100);
        }
    }
}

/// The fabric that loads its map itself: tasks while it loads, after that, and after another reset within a task.
#[test]
fn the_fabric_that_loads_its_map_does_as_the_model() {
    let mut arrivals = 0;
    for lattice in Lattice::ALL {
        for (width, height) in [(7, 5), (4, 4), (1, 1)] {
            let map = Map::random(lattice, width, height, 0.2, 3).unwrap();
            let files = verilog::fabric(&map, true).unwrap();
            let test = format!("fabric_top_{lattice}_{width}_{height}");
            let Some(mut gates) = aig(&test, &files, "fabric_top", &[]) else { return };
            let (mut model, mut rng, cells) = (Fabric::unloaded(&map), Rng::new(5), map.cells());
            // How many cells are loaded; none before the first reset.
            let mut loaded = cells;
            for clock in 0..4000 {
                let reset = clock < 2 || rng.chance(0.002);
                let mut end = || Cell::new(rng.below(width) as i32, rng.below(height) as i32);
                let (from, to) = (end(), end());
                let begin = rng.chance(0.05).then_some((from, to));
                let place = Cell::new((loaded as u32 % width) as i32, (loaded as u32 / width) as i32);
                let load = (loaded < cells).then(|| !map.is_free(place));
                let ends = [from.x, from.y, to.x, to.y].map(|coordinate| coordinate as u32);
                let told = [u32::from(reset), u32::from(begin.is_some())].into_iter().chain(ends);
                let names = ["reset", "begin_task", "start_x", "start_y", "target_x", "target_y"];
                for (name, number) in names.into_iter().zip(told) {
                    let port = gates.port(name);
                    gates.drive_all(&port, number);
                }
                gates.clock();
                let shown = model.clock(Inputs { reset, load, begin });
                loaded = if reset { 0 } else { cells.min(loaded + 1) };
                let number = |name| {
                    let bits = gates.port(name).into_iter().rev().map(|place| gates.seen(place) & 1);
                    bits.fold(0, |number, bit| number << 1 | bit as i32)
                };
                if clock < 2 {
                    continue;
                }
                let flags = [loaded < cells, shown.busy, shown.moving, shown.arrived, shown.unreachable];
                let seen = ["loading", "busy", "moving", "arrived", "unreachable"].map(number);
                assert_eq!(seen, flags.map(i32::from), "{lattice} {width} x {height}, clock {clock}");
                assert_eq!([number("at_x"), number("at_y")], [shown.at.x, shown.at.y]);
                arrivals += u32::from(shown.arrived);
            }
        }
    }
    assert!(arrivals > 1000, "{arrivals}");
    println!("fabric_top: 6 maps, 4000 clocks each as the model, which is loaded beside it");
}

/// The example drives the way of the core, in both kinds, and compilers take all files as `SystemVerilog` too.
#[test]
fn the_example_drives_a_shortest_way() {
    let Some([iverilog, vvp]) = common::programs("fabric_example", ["iverilog", "vvp"]) else { return };
    for lattice in Lattice::ALL {
        for loadable in [true, false] {
            let map = Map::random(lattice, 9, 6, 0.25, 5).unwrap();
            let folder = common::folder(&format!("fabric_example_{lattice}_{loadable}"));
            let files = verilog::fabric(&map, loadable).unwrap();
            common::write(&folder, &files);
            let sources = files.iter().map(|file| file.path.as_str()).filter(|path| path.starts_with("rtl"));
            let mut compile = common::command(&iverilog, &folder);
            compile.args(["-g2012", "-Wall", "-Wno-timescale", "-o", "example.vvp"]);
            let compile = compile.args(sources).arg("tb/fabric_example_tb.v").output().unwrap();
            assert!(compile.status.success() && compile.stderr.is_empty(), "{compile:?}");
            let said = common::run(common::command(&vvp, &folder).arg("example.vvp"));
            assert_eq!(said, example(&map));
        }
    }
    println!("the example prints the way of the core, loaded and wired in, on both lattices");
}

/// What the example prints.
fn example(map: &Map) -> String {
    let show = |cell: Cell| format!("({}, {})", cell.x, cell.y);
    let (from, to) = long_way(map).unwrap();
    let way = Fabric::new(map).run(from, to).unwrap();
    let mut text = format!("the way from {} to {}:\n", show(from), show(to));
    text.extend(way.iter().map(|&cell| format!("    {}\n", show(cell))));
    for (number, &cell) in way.iter().enumerate().skip(1) {
        text += &format!("move {number}: the robot is at {}\n", show(cell));
    }
    text + &format!("PASS example: the robot is at its target after {} moves\n", way.len() - 1)
}

/// Windows of real maps (the `.map` files of MovingAI), at places that depend on the seed alone.
fn real_windows(lattice: Lattice, size: u32) -> Vec<Map> {
    let root =
        std::env::var_os("ACTIVECELL_DATA").map_or(common::root().join("../shared/data"), PathBuf::from);
    let Ok(entries) = std::fs::read_dir(root.join("movingai")) else {
        println!("SKIPPED: {} has no folder movingai; no fabric was tried on real maps", root.display());
        return Vec::new();
    };
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|ending| ending == "map"));
    files.sort();
    let mut rng = Rng::new(11);
    let mut windows = Vec::new();
    for file in files {
        let text = std::fs::read_to_string(file).unwrap();
        let rows: Vec<&[u8]> = text.lines().skip(4).map(str::as_bytes).collect();
        for _ in 0..3 {
            let (left, top) = (rng.below(rows[0].len() as u32 - size), rng.below(rows.len() as u32 - size));
            let mut obstacles = BitPlane::new(size.into(), size.into()).unwrap();
            for (x, y) in (0..size).flat_map(|y| (0..size).map(move |x| (x, y))) {
                obstacles.set(x, y, !b".GS".contains(&rows[(top + y) as usize][(left + x) as usize]));
            }
            windows.push(Map::new(lattice, obstacles));
        }
    }
    windows
}

#[test]
fn fabrics_do_as_the_model_on_real_maps() {
    for lattice in Lattice::ALL {
        let maps = real_windows(lattice, 12);
        if !maps.is_empty() {
            compare(&format!("fabric_real_{lattice}"), &maps, true, 3);
        }
    }
}

#[test]
fn maps_that_do_not_fit_are_refused() {
    let map = |width, height| Map::random(Lattice::Hex, width, height, 0.3, 1).unwrap();
    let error = verilog::fabric(&map(65, 64), true).unwrap_err().to_string();
    assert!(error.contains("65 x 64 cells is too large: at most 4096"), "{error}");
    assert!(verilog::fabric(&map(4096, 1), false).is_ok());
}

#[test]
fn what_is_generated_can_be_read() {
    for lattice in Lattice::ALL {
        for loadable in [true, false] {
            let map = Map::random(lattice, 20, 12, 0.3, 1).unwrap();
            for file in &verilog::fabric(&map, loadable).unwrap()[1..] {
                let is_place = |rest: &str| rest.starts_with(|c: char| c.is_ascii_uppercase());
                assert!(
                    !file.text.split('@').skip(1).any(is_place),
                    "{}: a place is not filled in",
                    file.path
                );
                let long = file.text.lines().find(|line| line.len() > 110);
                assert_eq!(long, None, "{}", file.path);
            }
        }
    }
}

/// All tasks of 64 maps of the same size, a map a simulation: how many have a way, each of which was shortest.
fn every_task(gates: &mut Aig, maps: &[Map]) -> usize {
    let [load, scan, begin] = ["load_map", "scan_in", "begin_task"].map(|name| gates.port(name)[0]);
    let ends = ["start_x", "start_y", "target_x", "target_y"].map(|name| gates.port(name));
    let [busy, moving, arrived] = ["busy", "moving", "arrived"].map(|name| gates.port(name)[0]);
    let where_stopped = [gates.port("at_x"), gates.port("at_y")];
    let cells: Vec<Cell> = (0..maps[0].height() as i32)
        .flat_map(|y| (0..maps[0].width() as i32).map(move |x| Cell::new(x, y)))
        .collect();
    let simulations =
        |is: &dyn Fn(&Map) -> bool| maps.iter().rev().fold(0, |word, map| word << 1 | u64::from(is(map)));
    gates.drive(load, u64::MAX);
    for &cell in &cells {
        gates.drive(scan, simulations(&|map| !map.is_free(cell)));
        gates.clock();
    }
    gates.drive(load, 0);
    let mut tasks = 0;
    for &target in &cells {
        let fields: Vec<_> = maps.iter().map(|map| map.wave(target).ok()).collect();
        for &start in cells.iter().filter(|&&start| start != target) {
            let steps: Vec<_> =
                fields.iter().map(|field| field.as_ref().and_then(|field| field.steps(start))).collect();
            for (port, number) in ends.iter().zip([start.x, start.y, target.x, target.y]) {
                gates.drive_all(port, number as u32);
            }
            gates.drive(begin, u64::MAX);
            gates.clock();
            gates.drive(begin, 0);
            // How long each robot was seen, counted in all simulations at once: bit b of the counts is word b.
            let mut seen = [0u64; 6];
            for clock in 0.. {
                assert!(clock < 64, "livelock: from {start} to {target}");
                gates.clock();
                let mut carry = gates.seen(moving);
                for bit in &mut seen {
                    (*bit, carry) = (*bit ^ carry, *bit & carry);
                }
                if gates.seen(busy) == 0 {
                    break;
                }
            }
            let arrived = gates.seen(arrived);
            let is_there = where_stopped.iter().zip([target.x, target.y]).flat_map(|(port, number)| {
                port.iter().enumerate().map(move |(bit, &place)| (place, number >> bit & 1 == 1))
            });
            let there = is_there.fold(u64::MAX, |all, (place, one)| {
                all & if one { gates.seen(place) } else { !gates.seen(place) }
            });
            for (lane, (steps, map)) in steps.into_iter().zip(maps).enumerate() {
                let cells = seen.iter().rev().fold(0, |count, bit| count << 1 | (bit >> lane & 1) as u32);
                let done = (arrived & there) >> lane & 1 == 1;
                assert_eq!(done.then(|| cells - 1), steps, "from {start} to {target} in\n{}", map.to_text());
                tasks += usize::from(steps.is_some());
            }
        }
    }
    tasks
}

/// The map whose obstacles are the bits of a number.
fn numbered(lattice: Lattice, width: u32, height: u32, number: u32) -> Map {
    let mut obstacles = BitPlane::new(width.into(), height.into()).unwrap();
    for bit in 0..width * height {
        obstacles.set(bit % width, bit / width, number >> bit & 1 == 1);
    }
    Map::new(lattice, obstacles)
}

#[test]
fn every_task_on_every_small_map_ends_at_its_target_by_a_shortest_way() {
    for (lattice, width, height, expected) in
        [(Lattice::Square, 4, 4, Some(2_424_312)), (Lattice::Hex, 4, 3, None)]
    {
        let test = format!("fabric_every_task_{lattice}");
        let map = Map::random(lattice, width, height, 0.0, 0).unwrap();
        let files = verilog::fabric(&map, true).unwrap();
        let Some(gates) = aig(&test, &files, "fabric", &[]) else { return };
        let batches = (1u32 << (width * height)) / 64;
        let tasks: usize = std::thread::scope(|scope| {
            let workers: Vec<_> = (0..2)
                .map(|worker| {
                    let mut gates = gates.clone();
                    scope.spawn(move || {
                        let maps = |batch| {
                            let numbers = 64 * batch..64 * (batch + 1);
                            numbers.map(|number| numbered(lattice, width, height, number)).collect::<Vec<_>>()
                        };
                        let batches = (0..batches).filter(|batch| batch % 2 == worker);
                        batches.map(|batch| every_task(&mut gates, &maps(batch))).sum::<usize>()
                    })
                })
                .collect();
            workers.into_iter().map(|worker| worker.join().unwrap()).sum()
        });
        println!(
            "fabric {lattice}: {tasks} tasks on all maps of {width} x {height}, all arrived, all shortest"
        );
        assert!(expected.is_none_or(|expected| expected == tasks), "{tasks}");
    }
}

#[test]
fn the_bench_passes_and_sees_a_wrong_trace() {
    let Some([iverilog, vvp]) = common::programs("fabric_bench", ["iverilog", "vvp"]) else { return };
    for lattice in Lattice::ALL {
        for loadable in [true, false] {
            let map = Map::random(lattice, 9, 6, 0.25, 5).unwrap();
            let folder = common::folder(&format!("fabric_bench_{lattice}_{loadable}"));
            let files = verilog::fabric(&map, loadable).unwrap();
            for file in &files {
                let path = folder.join(&file.path);
                std::fs::create_dir_all(path.parent().unwrap()).unwrap();
                std::fs::write(path, &file.text).unwrap();
            }
            let is_source = |path: &&str| {
                Path::new(path).extension().is_some_and(|end| end == "v") && !path.contains("example")
            };
            let sources: Vec<&str> = files.iter().map(|file| file.path.as_str()).filter(is_source).collect();
            common::run(
                common::command(&iverilog, &folder)
                    .args(["-g2005", "-Wall", "-s", "fabric_tb", "-o", "fabric.vvp"])
                    .args(sources),
            );
            let said = common::run(common::command(&vvp, &folder).arg("fabric.vvp"));
            assert!(said.starts_with("PASS"), "{said}");
            println!("iverilog, {lattice}, {}: {said}", if loadable { "loaded" } else { "fixed" });
            // The last line says that the robot arrived.
            let trace = &files.last().unwrap().text;
            let wrong = trace.replace("_2_", "_3_");
            assert_ne!(trace, &wrong);
            std::fs::write(folder.join("tb/fabric.hex"), wrong).unwrap();
            let said = common::run(common::command(&vvp, &folder).arg("fabric.vvp"));
            assert!(said.contains("FAIL"), "{said}");
        }
    }
}
