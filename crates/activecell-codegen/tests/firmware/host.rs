//! Compiled for this machine: every input, and traces on maps.

use crate::{STRICT, common, real_map, robot, sources, warehouse, written};
use activecell::control::{Inputs, State, TABLE};
use activecell::rule::{Decision, Sector, decide, neighbourhood};
use activecell::{Cell, DirectionPlanes, Lattice, Map, Outcome, Rng, Route, Rule};
use activecell_codegen::model::player::{Motion, Player, Scale, Segment, Senses};
use activecell_codegen::{c, circuits};
use std::io::Write;
use std::path::PathBuf;
use std::process::Stdio;
use std::time::Instant;

const ARRIVED: u32 = 8;
const ENCLOSED: u32 = 9;
const TRAPPED: u32 = 10;
const UNREACHABLE: u32 = 11;
const FULL: u32 = 12;

/// The firmware with the driver, compiled.
struct Driver {
    folder: PathBuf,
}

impl Driver {
    /// `None`, after saying so, where no compiler is.
    fn new(test: &str, lattice: Lattice) -> Option<Self> {
        let [gcc] = common::programs(test, ["gcc"])?;
        let map = Map::random(lattice, 20, 20, 0.2, 1).unwrap();
        let folder = written(&format!("{test}_{lattice}"), &map, None);
        std::fs::write(folder.join("driver.c"), include_str!("driver.c")).unwrap();
        let files = [vec!["driver.c".into()], sources(&folder)].concat();
        common::run(common::command(&gcc, &folder).args(STRICT).args(["-O2", "-o", "driver"]).args(files));
        Some(Self { folder })
    }

    fn run(&self, mode: &str, input: &[u32]) -> Vec<u8> {
        let mut command = common::command(&self.folder.join("driver"), &self.folder);
        let mut child =
            command.arg(mode).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("the driver runs");
        let mut pipe = child.stdin.take().unwrap();
        let bytes: Vec<u8> = input.iter().flat_map(|number| number.to_le_bytes()).collect();
        let writer = std::thread::spawn(move || pipe.write_all(&bytes).unwrap());
        let output = child.wait_with_output().unwrap();
        writer.join().unwrap();
        assert!(output.status.success(), "{mode}: {}", output.status);
        output.stdout
    }

    fn numbers(&self, mode: &str, input: &[u32]) -> Vec<u32> {
        let bytes = self.run(mode, input);
        bytes.chunks_exact(4).map(|four| u32::from_le_bytes(four.try_into().unwrap())).collect()
    }
}

fn packed(cell: Cell) -> u32 {
    (cell.y as u32) << 16 | cell.x as u32
}

/// 4,096 neighbourhoods × 8 sectors × 2, 262,144 × 12 × 2; 8 × 256 inputs of the control unit.
#[test]
fn every_input_has_the_answer_of_the_core() {
    for lattice in Lattice::ALL {
        let Some(driver) = Driver::new("every_input", lattice) else { return };
        let mut answers = driver.run("decide", &[]).into_iter();
        let mut compared = 0;
        for bits in 0..1u32 << (3 * lattice.degree()) {
            for sector in Sector::all(lattice) {
                for near in [false, true] {
                    let expected = match decide(lattice, sector, near, bits) {
                        Decision::Move(dir) => dir.0.into(),
                        Decision::Enclosed => ENCLOSED,
                    };
                    assert_eq!(
                        answers.next().map(u32::from),
                        Some(expected),
                        "{lattice} {bits:x} {sector:?}"
                    );
                    compared += 1;
                }
            }
        }
        assert!(answers.next().is_none());
        let mut answers = driver.numbers("control", &[]).into_iter();
        for number in 0..8 {
            // The two numbers that are no states act as calm.
            let state = State::ALL.get(number).copied().unwrap_or_default();
            for next in TABLE[state as usize] {
                let outputs = state.outputs().iter().rev().fold(0, |bits, &bit| bits << 1 | u32::from(bit));
                assert_eq!(answers.next().zip(answers.next()), Some((next as u32, outputs)));
            }
        }
        println!("{lattice}: {compared} decisions and 2048 steps of the control unit are those of the core");
    }
}

/// The printed circuits, also those that the firmware does without, on random inputs.
#[test]
fn circuits_as_functions_compute_what_they_say() {
    let Some([gcc]) = common::programs("circuits_as_functions", ["gcc"]) else { return };
    let of = |lattice| [circuits::sector, circuits::decision, circuits::fabric_cell].map(|of| of(lattice));
    for circuit in Lattice::ALL.into_iter().flat_map(of).chain([circuits::control(), circuits::player()]) {
        let folder = written(&format!("function_{}", circuit.name), &warehouse(Lattice::Square), None);
        let name = format!("ac_{}", circuit.name);
        let arguments: Vec<String> = (0..circuit.inputs.len()).map(|place| format!("in[{place}]")).collect();
        let call = format!("{name}({})", arguments.join(", "));
        let outputs: Vec<&str> = circuit.outputs().map(|wire| wire.port.name.as_str()).collect();
        let calls: Vec<String> = match outputs[..] {
            [_] => vec![format!("put({call});")],
            _ => outputs.iter().map(|output| format!("put({call}.{output});")).collect(),
        };
        let calls = calls.join("\n        ");
        let text = format!(
            "#include \"../src/ac_bit.h\"\n#include <stdio.h>\n\n{}\n\
             static void put(uint32_t number)\n{{\n    (void)fwrite(&number, 4U, 1U, stdout);\n}}\n\n\
             int main(void)\n{{\n    uint32_t in[{}];\n    while (fread(in, sizeof in, 1U, stdin) == 1U) {{\n        \
             {calls}\n    }}\n    return 0;\n}}\n",
            c::function(&circuit),
            arguments.len()
        );
        std::fs::write(folder.join("driver.c"), text).unwrap();
        common::run(common::command(&gcc, &folder).args(STRICT).args(["-O1", "-o", "driver", "driver.c"]));
        let mut rng = Rng::new(4);
        let inputs: Vec<Vec<u32>> = (0..20_000)
            .map(|_| circuit.inputs.iter().map(|port| rng.below(1 << port.width)).collect())
            .collect();
        let answers = Driver { folder }.numbers("", &inputs.concat());
        let expected: Vec<u32> = inputs.iter().flat_map(|inputs| circuit.evaluate(inputs)).collect();
        assert_eq!(answers, expected, "{name}");
    }
}

#[test]
fn sectors_distances_and_neighbours_are_those_of_the_core() {
    const SIDE: i32 = 200;
    for lattice in Lattice::ALL {
        let Some(driver) = Driver::new("sectors", lattice) else { return };
        let mut answers = driver.numbers("sectors", &[SIDE as u32]).into_iter();
        let mut next = || answers.next().unwrap();
        for row in 0..2 {
            let from = Cell::new(SIDE / 2, SIDE / 2 + row);
            for dir in lattice.dirs() {
                assert_eq!(next(), packed(lattice.neighbour(from, dir)));
            }
            for to in (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| Cell::new(x, y))) {
                let [bearing, distance] = [next(), next()];
                let expected = Sector::towards(lattice, from, to).map(Sector::number);
                let near = u32::from(lattice.distance(from, to) == 1) << 4;
                let equal = expected.is_none_or(|number| bearing == u32::from(number) | near);
                assert!(equal, "{lattice} {from} {to}");
                assert_eq!(distance, lattice.distance(from, to));
            }
        }
        println!("{lattice}: {} sectors and distances are those of the core", 2 * SIDE * SIDE);
    }
}

/// What was compared.
#[derive(Debug, Default)]
struct Counts {
    maps: usize,
    windows: usize,
    tasks: usize,
    trapped: usize,
    steps_learnt: usize,
    tables_full: usize,
    directions: usize,
}

/// Traces on a map: windows, the published rule, learning, directions of the wave.
fn compare(driver: &Driver, map: &Map, tasks: &[(Cell, Cell)], small_table: bool, counts: &mut Counts) {
    let lattice = map.lattice();
    let capacity = if small_table { 64 } else { (c::footprint(map).levels_bytes / 8) as u32 };
    assert!(small_table || capacity as usize * 3 >= map.free_cells() * 4, "at most three quarters are taken");
    let mut input = vec![map.width(), map.height()];
    input.extend(c::rows(map));
    input.push(tasks.len() as u32);
    for (from, to) in tasks {
        input.extend([from.x, from.y, to.x, to.y].map(|number| number as u32));
        input.push(capacity);
    }
    let mut answers = driver.numbers("tasks", &input).into_iter();
    let (width, height) = (map.width() as i32, map.height() as i32);
    let all: Vec<Cell> = (0..height).flat_map(|y| (0..width).map(move |x| Cell::new(x, y))).collect();
    for &cell in &all {
        let window = answers.next().unwrap();
        let bits = circuits::neighbourhood(lattice, [0, 8, 16].map(|at| window >> at));
        assert_eq!(bits, neighbourhood(map, cell), "{lattice} {cell}");
        assert_eq!(window & !(((1 << lattice.degree()) - 1) * 0x01_01_01), 0, "nothing beside the lanes");
        counts.windows += 1;
    }
    for &(from, to) in tasks {
        let mut walk = || {
            let cells: Vec<u32> = answers.by_ref().take_while(|&number| number != u32::MAX).collect();
            (cells, answers.next().unwrap(), answers.next().unwrap())
        };
        published(&map.route(Rule::Published, from, to, 0).unwrap(), &walk(), counts);
        learnt(&map.route(Rule::Learning, from, to, 1 << 24).unwrap(), &walk(), capacity, counts);
        let file = map.direction_planes(&[to]).unwrap();
        let planes = DirectionPlanes::from_bytes(&file).unwrap();
        for &cell in &all {
            let expected = match planes.next(0, cell) {
                Some(dir) => dir.0.into(),
                None if cell == to => ARRIVED,
                None => UNREACHABLE,
            };
            assert_eq!(answers.next(), Some(expected), "{lattice} {cell} to {to}");
            counts.directions += 1;
        }
        counts.tasks += 1;
    }
    assert!(answers.next().is_none());
    counts.maps += 1;
}

/// The firmware may go on where the core has already seen the circle, within it.
fn published(route: &Route, (cells, end, cycle): &(Vec<u32>, u32, u32), counts: &mut Counts) {
    let expected: Vec<u32> = route.cells().iter().map(|&cell| packed(cell)).collect();
    match route.outcome() {
        Outcome::Trapped => {
            let length = route.cycle().len();
            assert_eq!((*end, *cycle as usize), (TRAPPED, length));
            let before = expected.len() - 1 - length;
            let endless =
                (0..cells.len()).map(|i| if i < before { i } else { before + (i - before) % length });
            assert!(endless.map(|i| expected[i]).eq(cells.iter().copied()));
            assert!(cells.len() <= 3 * expected.len(), "{} for {}", cells.len(), expected.len());
            counts.trapped += 1;
        }
        outcome => {
            assert_eq!(*cells, expected);
            assert_eq!(*end, if outcome == Outcome::Arrived { ARRIVED } else { ENCLOSED });
        }
    }
}

/// While the table suffices, the steps of the core; then it says so.
fn learnt(route: &Route, (cells, end, used): &(Vec<u32>, u32, u32), capacity: u32, counts: &mut Counts) {
    let expected: Vec<u32> = route.cells().iter().map(|&cell| packed(cell)).collect();
    if *end == FULL {
        assert_eq!(*used, capacity - 1);
        assert!(expected.starts_with(cells) && cells.len() <= expected.len());
        counts.tables_full += 1;
    } else {
        assert_eq!(*cells, expected);
        assert_eq!(*end, if route.outcome() == Outcome::Arrived { ARRIVED } else { UNREACHABLE });
    }
    counts.steps_learnt += cells.len() - 1;
}

fn some_tasks(map: &Map, rng: &mut Rng, count: usize) -> Vec<(Cell, Cell)> {
    let free: Vec<Cell> = map.free().collect();
    let mut any = || free[rng.below(free.len() as u32) as usize];
    (0..count).map(|_| (any(), any())).collect()
}

#[test]
fn on_random_maps_every_step_is_that_of_the_core() {
    for lattice in Lattice::ALL {
        let Some(driver) = Driver::new("random_maps", lattice) else { return };
        let mut rng = Rng::new(1);
        let mut counts = Counts::default();
        for seed in 0..300 {
            let [width, height] = [0, 1].map(|_| 1 + rng.below(if seed % 10 == 0 { 130 } else { 40 }));
            let density = f64::from(rng.below(50)) / 100.0;
            let map = Map::random(lattice, width, height, density, seed).unwrap();
            if map.free_cells() > 0 {
                let tasks = some_tasks(&map, &mut rng, 4);
                compare(&driver, &map, &tasks, seed % 4 == 0, &mut counts);
            }
        }
        println!("{lattice}: equal {counts:?}");
        assert!(counts.trapped > 50 && counts.tables_full > 20 && counts.maps > 280);
    }
}

#[test]
fn on_real_maps_every_step_is_that_of_the_core() {
    for lattice in Lattice::ALL {
        let Some(driver) = Driver::new("real_maps", lattice) else { return };
        let mut rng = Rng::new(2);
        let mut counts = Counts::default();
        for name in ["lak303d.map", "arena2.map", "AR0700SR.map"] {
            let Some(map) = real_map("on_real_maps", lattice, name) else { return };
            let tasks = some_tasks(&map, &mut rng, 3);
            compare(&driver, &map, &tasks, false, &mut counts);
        }
        println!("{lattice}: equal on real maps {counts:?}");
    }
}

/// Steps to a target of a map of 4 × 4 from each cell, by flooding in the plainest way.
fn flooded(map: u32, target: u32) -> [u8; 16] {
    let mut steps = [255; 16];
    let mut reached = 1u32 << target;
    for step in 0.. {
        for (cell, steps) in steps.iter_mut().enumerate() {
            if reached >> cell & 1 == 1 && *steps == 255 {
                *steps = step;
            }
        }
        let sideways = (reached & 0x7777) << 1 | (reached & 0xEEEE) >> 1;
        let spread = (reached | sideways | reached << 4 | reached >> 4) & 0xFFFF & !map;
        if spread == reached {
            return steps;
        }
        reached = spread;
    }
    unreachable!("a wave ends")
}

/// All maps of 4 × 4, all targets, all starts from which a way leads there.
#[test]
fn the_wave_arrives_shortest_on_every_map_of_4_by_4() {
    let Some(driver) = Driver::new("small_maps", Lattice::Square) else { return };
    let answers = driver.run("small", &[]);
    let mut answers = answers.chunks_exact(16);
    let mut tasks = 0;
    for map in 0..65536u32 {
        for target in (0..16).filter(|target| map >> target & 1 == 0) {
            let steps = flooded(map, target);
            assert_eq!(answers.next(), Some(&steps[..]), "map {map:04x}, target {target}");
            tasks += steps.iter().filter(|&&steps| (1..255).contains(&steps)).count();
        }
    }
    assert!(answers.next().is_none());
    assert_eq!(tasks, 2_424_312);
    println!("{tasks} tasks on all maps of 4 x 4: all arrive, on shortest ways, no livelock");
}

#[test]
fn the_player_plays_as_its_model() {
    let Some(driver) = Driver::new("player", Lattice::Square) else { return };
    let mut rng = Rng::new(3);
    let mut clocks = 0;
    for program in 0..300 {
        let segments: Vec<Segment> = (0..rng.below(9))
            .map(|_| Segment { motion: Motion::ALL[rng.below(4) as usize], ticks: 1 + rng.below(12) })
            .collect();
        let senses: Vec<(Senses, u32)> = (0..400)
            .map(|_| {
                let ticks = rng.below(8).saturating_sub(3);
                let obstacles = if rng.below(4) == 0 { rng.below(256) as u8 } else { 0 };
                (Senses { go: rng.below(8) > 0, tick: ticks > 0, obstacles: Inputs(obstacles) }, ticks)
            })
            .collect();
        let mut input = vec![segments.len() as u32];
        input.extend(segments.iter().flat_map(|segment| [segment.motion as u32, segment.ticks]));
        input.push(senses.len() as u32);
        input.extend(senses.iter().flat_map(|(s, ticks)| [s.go.into(), *ticks, s.obstacles.0.into()]));
        let answers = driver.numbers("player", &input);
        let mut player = Player::new(segments);
        for (answer, &(senses, ticks)) in answers.chunks_exact(5).zip(&senses) {
            // A stop among the obstacles is one for the firmware; the hardware has no wire for it.
            let senses = Senses { go: senses.go && !senses.obstacles.has(Inputs::STOP), ..senses };
            (0..ticks.max(1)).for_each(|_| player.clock(senses));
            let outputs =
                player.state().outputs().iter().rev().fold(0, |bits, &bit| bits << 1 | u32::from(bit));
            let ticks = player.segments().get(player.segment()).map_or(0, |s| s.ticks - player.ticks_left());
            let is_done = player.done() && !player.state().moves();
            let expected = [outputs, player.state() as u32, player.segment() as u32, ticks, is_done.into()];
            assert_eq!(answer, expected, "program {program}");
            clocks += 1;
        }
    }
    assert_eq!(clocks, 300 * 400);
    println!("300 programs, {clocks} calls: the player of the firmware is the model");
}

/// However long it drives, all its ticks are those of the whole way, rounded; and it turns by the shorter side.
#[test]
fn moves_from_cell_to_cell_lose_no_ticks() {
    for lattice in Lattice::ALL {
        let Some(driver) = Driver::new("course", lattice) else { return };
        let scale = Scale::of(&robot(), &Map::parse(lattice, "..").unwrap());
        let parts = [scale.step_ticks, scale.turn_ticks].map(|ticks| (ticks * 256.0).round() as i64);
        assert!(parts.iter().all(|parts| parts % 256 != 0));
        let degree = u32::from(lattice.degree());
        let mut rng = Rng::new(5);
        let moves: Vec<u32> = (0..20_000).map(|_| rng.below(degree + 1)).collect();
        let answers = driver.numbers("course", &[&[1, moves.len() as u32], &moves[..]].concat());
        let (mut heading, mut steps, mut right) = (1, 0, 0);
        let mut ticks = [0, 0];
        for (answer, &next) in answers.chunks_exact(6).zip(&moves) {
            let segments: Vec<(Motion, i64)> = answer[2..]
                .chunks_exact(2)
                .take(answer[1] as usize)
                .map(|segment| (Motion::ALL[segment[0] as usize], segment[1].into()))
                .collect();
            if next < degree {
                let clockwise = i64::from((next + degree - heading) % degree);
                right +=
                    if 2 * clockwise > degree.into() { clockwise - i64::from(degree) } else { clockwise };
                (heading, steps) = (next, steps + 1);
            } else {
                assert!(segments.is_empty());
            }
            for (motion, count) in segments {
                match motion {
                    Motion::Forward => ticks[0] += count,
                    Motion::Right => ticks[1] += count,
                    Motion::Left => ticks[1] -= count,
                    Motion::Reverse => panic!("it turns instead"),
                }
            }
            let expected = [steps * parts[0], right * parts[1]].map(|parts| (parts + 128).div_euclid(256));
            assert_eq!((answer[0], ticks), (heading, expected), "{lattice} {next}");
        }
        println!(
            "{lattice}: {} moves as segments, {steps} cells and {right} turns: no tick is lost",
            moves.len()
        );
    }
}

/// All maps of 4 × 4, all targets, all starts: with the map, and with an empty map and a robot that knows of an obstacle
/// only when it bumps into it. A cell once seen free may then turn out closed, also the last one of a way.
#[test]
fn learning_arrives_where_a_way_exists_and_says_where_none_does() {
    for lattice in Lattice::ALL {
        let Some(driver) = Driver::new("learns_small", lattice) else { return };
        let answers = driver.run("learns", &[]);
        let mut answers = answers.chunks_exact(2);
        let (mut arrived, mut unreachable) = (0, 0);
        for number in 0..65536u32 {
            let cell = |place: u32| Cell::new((place % 4) as i32, (place / 4) as i32);
            let free = |place: &u32| number >> place & 1 == 0;
            let mut left = (0..16).filter(free).fold(0u32, |cells, place| cells | 1 << place);
            // Regions: a way leads from each cell of one to all its others, to none else.
            let mut regions = [0u32; 16];
            while left != 0 {
                let mut region = 0;
                let mut found = left & left.wrapping_neg();
                while found != 0 {
                    region |= found;
                    let cells = (0..16).filter(|place| found >> place & 1 == 1);
                    let around = cells
                        .flat_map(|place| lattice.dirs().map(move |dir| lattice.neighbour(cell(place), dir)));
                    let inside = around.filter(|c| (0..4).contains(&c.x) && (0..4).contains(&c.y));
                    let cells = inside.fold(0, |cells, c| cells | 1u32 << (c.y * 4 + c.x));
                    found = cells & left & !region;
                }
                (0..16).filter(|place| region >> place & 1 == 1).for_each(|place| regions[place] = region);
                left &= !region;
            }
            for target in (0..16).filter(free) {
                for from in (0..16).filter(free) {
                    let expected =
                        if regions[from as usize] >> target & 1 == 1 { ARRIVED } else { UNREACHABLE };
                    let both = [expected as u8; 2];
                    assert_eq!(answers.next(), Some(&both[..]), "{lattice} {number:04x} {from} to {target}");
                    if expected == ARRIVED { arrived += 1 } else { unreachable += 1 }
                }
            }
        }
        assert!(answers.next().is_none());
        println!(
            "{lattice}, all maps of 4 x 4: learning arrives in {arrived} tasks, and knows of {unreachable}"
        );
    }
}

/// Printed only: how long a decision and a step take here, in C and in Rust.
#[test]
fn latency_on_this_machine() {
    for lattice in Lattice::ALL {
        let Some(driver) = Driver::new("latency", lattice) else { return };
        let map = Map::random(lattice, 60, 60, 0.1, 1).unwrap();
        let (from, to) = (map.free().next().unwrap(), map.free().last().unwrap());
        let mut input = vec![map.width(), map.height()];
        input.extend(c::rows(&map));
        input.extend([from.x, from.y, to.x, to.y].map(|number| number as u32));
        let answers = driver.numbers("latency", &input);
        let rounds = 2_000_000u32;
        let sectors: Vec<Sector> = Sector::all(lattice).collect();
        let begin = Instant::now();
        let mut sum = 0;
        for round in 0..rounds {
            let bits = std::hint::black_box(round.wrapping_mul(2_654_435_769u32) >> 8);
            sum +=
                usize::from(decide(lattice, sectors[round as usize & 7], false, bits) == Decision::Enclosed);
        }
        std::hint::black_box(sum);
        let rust = begin.elapsed().as_secs_f64() * 1e9 / f64::from(rounds);
        println!(
            "{lattice}: {:.1} ns a decision in C, {rust:.1} ns in Rust; {:.1} ns a step in C",
            f64::from(answers[0]) / 1e3,
            f64::from(answers[1]) / 1e3
        );
    }
}
