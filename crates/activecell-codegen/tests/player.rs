//! The program player in Verilog does what its model does, clock by clock, and what must never happen does not.

mod common;

use activecell::control::{Inputs, State};
use activecell::{Cell, Dir, Drive, Lattice, Map, Rng, Robot, Rule};
use activecell_codegen::model::player::{Motion, Player, Segment, Senses, segments};
use activecell_codegen::model::player_top::{Pins, PlayerTop};
use activecell_codegen::{SourceFile, verilog};
use common::cxxrtl::Simulation;
use common::formal;
use std::path::{Path, PathBuf};

/// A program of a random route over a random map of either lattice, for a random robot.
fn program(rng: &mut Rng) -> Vec<Segment> {
    loop {
        let lattice = Lattice::ALL[rng.below(2) as usize];
        let cell =
            |i: u32, rng: &mut Rng| if i % 12 == 11 { '\n' } else { ['#', '.', '.'][rng.below(3) as usize] };
        let map = Map::parse(lattice, &(0..143).map(|i| cell(i, rng)).collect::<String>()).expect("a map");
        let robot = Robot {
            drive: [Drive::Steered, Drive::Differential][rng.below(2) as usize],
            ticks_per_rev: f64::from(1 + rng.below(4)),
            can_reverse: rng.below(2) == 0,
            ..Robot::default()
        };
        let [from, to] = [0, 1].map(|_| Cell::new(rng.below(11) as i32, rng.below(12) as i32));
        if let Ok(route) = map.route(Rule::Wave, from, to, 1000) {
            let heading = Dir(rng.below(lattice.degree().into()) as u8);
            return segments(&route.program(&robot, &map, Some(heading)), &robot, lattice).expect("segments");
        }
    }
}

/// Segments that no route has: many, short ones, motions in any order.
fn strange(rng: &mut Rng) -> Vec<Segment> {
    let count = rng.below(64);
    let longest = 1 + rng.below(255);
    let segment =
        |rng: &mut Rng| Segment { motion: Motion::ALL[rng.below(4) as usize], ticks: 1 + rng.below(longest) };
    (0..count).map(|_| segment(rng)).collect()
}

fn senses(rng: &mut Rng) -> Senses {
    let obstacles = if rng.below(2) == 0 { Inputs((rng.below(16) << 2) as u8) } else { Inputs::default() };
    Senses { go: rng.below(8) > 0, tick: rng.below(4) > 0, obstacles }
}

/// All but `player_top`.
const SOURCES: &str =
    "rtl/control_next.v rtl/control_unit.v rtl/player_inputs.v rtl/encoder_edge.v rtl/player.v";

/// Programs in, what the player shows after each clock out. The memory is filled anew for each program.
const MAIN: &str = r"
static int byte() { return std::getchar(); }

int main() {
    for (int words = byte(); words != EOF; words = byte()) {
        cxxrtl_design::p_player player;
        for (int place = 0; place < words; place++) {
            uint32_t word = byte();
            player.memory_p_words[place].set<uint32_t>(word | byte() << 8);
        }
        uint32_t clocks = byte();
        clocks |= byte() << 8;
        for (uint32_t clock = 0; clock < clocks + 2; clock++) {
            uint32_t told = clock < 2 ? 64 : byte();
            player.p_reset.set<bool>(told >> 6 & 1);
            player.p_go.set<bool>(told >> 5 & 1);
            player.p_tick.set<bool>(told >> 4 & 1);
            player.p_obstacles.set<uint32_t>(told & 15);
            player.p_clk.set<bool>(true);
            player.step();
            player.p_clk.set<bool>(false);
            player.step();
            std::putchar(player.p_q0.get<uint32_t>() | player.p_q1.get<uint32_t>() << 1 | player.p_q2.get<uint32_t>() << 2
                         | player.p_q3.get<uint32_t>() << 3 | player.p_done.get<uint32_t>() << 4);
            std::putchar(player.p_segment.get<uint32_t>());
        }
    }
}
";

/// A program as the simulation reads it: ticks of 8 bits, the motion above them, 1 above that; 0 is the end.
fn told(segments: &[Segment], senses: &[Senses]) -> Vec<u8> {
    let number =
        |motion: Motion| Motion::ALL.iter().position(|&other| other == motion).expect("a motion") as u32;
    let words =
        segments.iter().map(|segment| 1 << 10 | number(segment.motion) << 8 | segment.ticks).chain([0]);
    let mut bytes = vec![segments.len() as u8 + 1];
    bytes.extend(words.flat_map(|word| (word as u16).to_le_bytes()));
    bytes.extend((senses.len() as u16).to_le_bytes());
    bytes.extend(
        senses
            .iter()
            .map(|senses| u8::from(senses.go) << 5 | u8::from(senses.tick) << 4 | senses.obstacles.0 >> 2),
    );
    bytes
}

fn shown(player: &Player) -> [u8; 2] {
    [on_pins((player.state(), player.done())), player.segment() as u8]
}

/// q0 to q3, and done above them.
fn on_pins((state, done): (State, bool)) -> u8 {
    let outputs = state.outputs().into_iter().chain([done]);
    outputs.enumerate().map(|(place, output)| u8::from(output) << place).sum()
}

#[test]
fn verilog_plays_as_the_model_clock_by_clock() {
    let Some(tools) = common::programs("verilog_plays_as_the_model_clock_by_clock", ["yosys", "g++"]) else {
        return;
    };
    let folder = common::folder("player_cxxrtl");
    // The widest that any of the programs needs.
    let widest = Segment { motion: Motion::Forward, ticks: 255 };
    common::write(&folder, &verilog::player(&[widest; 64], Drive::Differential).unwrap());
    let script = format!("read_verilog {SOURCES}; hierarchy -check -top player; flatten");
    let simulation = Simulation::compile(&tools, &folder, &script, MAIN);
    let mut rng = Rng::new(1);
    let (mut input, mut expected) = (Vec::new(), Vec::new());
    let (mut clocks, mut ended) = (0, 0);
    for case in 0..600 {
        let segments = if case % 2 == 0 { program(&mut rng) } else { strange(&mut rng) };
        assert!(segments.len() <= 64 && segments.iter().all(|segment| segment.ticks < 256));
        let senses: Vec<Senses> = (0..4000).map(|_| senses(&mut rng)).collect();
        let mut player = Player::new(segments.clone());
        expected.extend([shown(&player); 2]);
        for &senses in &senses {
            player.clock(senses);
            expected.push(shown(&player));
        }
        clocks += senses.len();
        ended += usize::from(player.done());
        input.extend(told(&segments, &senses));
    }
    let output = simulation.run(&input);
    assert_eq!(output.len(), expected.len() * 2);
    let wrong = output.chunks(2).zip(&expected).position(|(shown, expected)| shown != expected);
    assert_eq!(wrong, None, "the first clock that differs");
    assert!(ended > 300, "{ended} programs came to their end");
    println!("600 programs, {ended} to their end, {clocks} clocks: the Verilog shows what the model shows");
}

/// What the chip's pins show, a clock after another, for what they are told: two bytes a clock.
const TOP: &str = r"
int main() {
    cxxrtl_design::p_player__top top;
    for (int told = std::getchar(); told != EOF; told = std::getchar()) {
        top.p_obstacles.set<uint32_t>(told & 15);
        top.p_reset.set<bool>(told >> 7 & 1);
        top.p_go.set<bool>(told >> 6 & 1);
        int encoders = std::getchar();
        top.p_wheel__left.set<bool>(encoders & 1);
        top.p_wheel__right.set<bool>(encoders >> 1 & 1);
        top.p_steering.set<bool>(encoders >> 2 & 1);
        top.p_clk.set<bool>(true);
        top.step();
        top.p_clk.set<bool>(false);
        top.step();
        std::putchar(top.p_q0.get<uint32_t>() | top.p_q1.get<uint32_t>() << 1 | top.p_q2.get<uint32_t>() << 2
                     | top.p_q3.get<uint32_t>() << 3 | top.p_done.get<uint32_t>() << 4);
    }
}
";

/// Pulses and pauses of random length on all encoders, stops, obstacles, and now and then a reset.
fn trains(rng: &mut Rng) -> Vec<Pins> {
    let mut encoders = [false; 3];
    let mut reset_clocks = 4;
    let mut pins = |_| {
        for level in &mut encoders {
            *level ^= rng.below(5) == 0;
        }
        if reset_clocks == 0 && rng.below(10_000) == 0 {
            reset_clocks = 1 + rng.below(6);
        }
        let reset = reset_clocks > 0;
        reset_clocks = reset_clocks.saturating_sub(1);
        let Senses { go, obstacles, .. } = senses(rng);
        Pins { reset, go, encoders, obstacles }
    };
    (0..40_000).map(&mut pins).collect()
}

/// For both kinds of robots, every clock from the first reset on.
#[test]
fn the_pins_show_what_the_model_shows() {
    let Some(tools) = common::programs("the_pins_show_what_the_model_shows", ["yosys", "g++"]) else {
        return;
    };
    let mut rng = Rng::new(3);
    for drive in [Drive::Differential, Drive::Steered] {
        let segments = [Motion::Forward, Motion::Left, Motion::Reverse, Motion::Right, Motion::Forward]
            .map(|motion| Segment { motion, ticks: 1 + rng.below(400) });
        let folder = common::folder("player_top_cxxrtl");
        common::write(&folder, &verilog::player(&segments, drive).unwrap());
        let script =
            format!("read_verilog {SOURCES} rtl/player_top.v; hierarchy -check -top player_top; flatten");
        let simulation = Simulation::compile(&tools, &folder, &script, TOP);
        let pins = trains(&mut rng);
        let told = pins.iter().flat_map(|pins| {
            let encoders = (0..3).map(|place| u8::from(pins.encoders[place]) << place).sum();
            [u8::from(pins.reset) << 7 | u8::from(pins.go) << 6 | pins.obstacles.0 >> 2, encoders]
        });
        let mut top = PlayerTop::new(segments.to_vec(), drive);
        let (mut ended, mut resets) = (0, 0);
        let expected = pins.iter().map(|&pins| {
            let was_done = top.player().done();
            top.clock(pins);
            ended += usize::from(!was_done && top.player().done());
            resets += usize::from(was_done && !top.player().done());
            on_pins(top.shown())
        });
        let expected: Vec<u8> = expected.collect();
        let shown = simulation.run(&told.collect::<Vec<u8>>());
        let wrong = shown.iter().zip(&expected).skip(3).position(|(shown, expected)| shown != expected);
        assert_eq!(wrong, None, "the first clock that differs, {drive:?}");
        assert_eq!(shown.len(), expected.len());
        assert!(ended > 1 && resets > 0, "{ended} {resets}");
        println!(
            "{drive:?}: {} clocks of raw pulses, {ended} ends: the pins show what the model shows",
            pins.len()
        );
    }
}

/// For every program of seven segments (the memory holds anything) and all inputs; wrong players are found out.
#[test]
fn it_never_drives_at_obstacles_nor_after_the_end() {
    let Some(tools) = common::programs("it_never_drives_at_obstacles_nor_after_the_end", formal::TOOLS)
    else {
        return;
    };
    let mutants = [
        ("rtl/player_inputs.v", "wire left = ~obstacles[1] &", "wire left ="),
        ("rtl/player.v", ".done(done), .go", ".done(1'b0), .go"),
        ("rtl/player.v", "tick & ~done & count == ticks", "tick & count == ticks"),
        ("rtl/control_unit.v", "state <= reset ? 3'd0 : next_state", "state <= next_state"),
        ("rtl/control_next.v", "wire next0 = ", "wire next0 = from_stopped | "),
    ];
    let whole = ("rtl/player.v", "", "");
    for (place, (path, right, wrong)) in [whole].into_iter().chain(mutants).enumerate() {
        let folder = common::folder(&format!("player_formal_{place}"));
        let mut files =
            verilog::player(&[Segment { motion: Motion::Forward, ticks: 7 }; 7], Drive::Differential)
                .unwrap();
        for file in &mut files {
            if file.path == "rtl/player.hex" {
                file.text = "xx\n".repeat(8);
            }
            if file.path == path {
                assert!(file.text.contains(right), "{}", file.text);
                file.text = file.text.replacen(right, wrong, 1);
            }
        }
        common::write(&folder, &files);
        std::fs::write(folder.join("properties.v"), include_str!("formal/player.v")).unwrap();
        let holds = formal::holds(&tools, &folder, &format!("properties.v {SOURCES}"), "player_formal", 12);
        assert_eq!(holds, place == 0, "{path} {wrong}");
    }
    println!("proven for every program of seven segments; {} wrong players refuted", mutants.len());
}

/// Ticks of a segment that no simulation could wait for.
const LONG: u32 = 3_000_000_000;

/// The test bench also says where the player itself is when the bench ends.
fn must_end(files: &mut [SourceFile]) {
    let image = files.iter().find(|file| file.path == "rtl/player.hex").expect("the program");
    assert!(image.text.contains("3000000000 ticks"), "the chip counts all ticks");
    let bench = files.iter_mut().find(|file| file.path == "tb/player_tb.v").expect("the test bench");
    let end = "        $finish;";
    assert!(bench.text.contains(end));
    bench.text = bench.text.replace(
        end,
        &format!("        if (done && q == 4'b0001) $display(\"ended after %0d segments\", dut.player.segment);\n{end}"),
    );
}

/// What a test bench of the files in the folder prints.
fn simulated([iverilog, vvp]: &[PathBuf; 2], folder: &Path, bench: &str) -> String {
    let mut compile = common::command(iverilog, folder);
    compile.args(["-g2005", "-Wall", "-Wno-timescale", "-o", "bench", "-s", bench]);
    compile.args([&format!("tb/{bench}.v"), "rtl/player_top.v"]).args(SOURCES.split(' '));
    let warnings = compile.output().expect("a program that was found can be run");
    assert!(warnings.status.success() && warnings.stderr.is_empty(), "{warnings:?}");
    common::run(common::command(vvp, folder).args(["-n", "bench"]))
}

/// Faults between the pins and the player, which the test bench must find, and the kind of robot that shows them.
const FAULTS: [(&str, &str, &str, Drive); 6] = [
    ("rtl/player_top.v", "left_pulse & right_pulse | has_half", "has_half", Drive::Differential),
    ("rtl/player_top.v", "has_half ^ left_pulse", "left_pulse", Drive::Differential),
    ("rtl/player_top.v", "STEERED != 0 && turning", "turning", Drive::Differential),
    ("rtl/player_top.v", "STEERED != 0 && turning", "1'b0", Drive::Steered),
    ("rtl/player_top.v", "shown <= {ended, q}", "shown <= {ended, q[3:2], q[0], q[1]}", Drive::Steered),
    ("rtl/encoder_edge.v", "settled & ~earlier", "settled", Drive::Differential),
];

#[test]
fn the_test_bench_finds_faults_between_pins_and_player() {
    let test = "the_test_bench_finds_faults_between_pins_and_player";
    let Some(tools) = common::programs(test, ["iverilog", "vvp"]) else { return };
    let folder = common::folder("player_faults");
    let segments = Motion::ALL.map(|motion| Segment { motion, ticks: 50 });
    for (path, right, wrong, drive) in FAULTS {
        let mut files = verilog::player(&segments, drive).unwrap();
        let file = files.iter_mut().find(|file| file.path == path).expect("the file");
        assert!(file.text.contains(right), "{}", file.text);
        file.text = file.text.replacen(right, wrong, 1);
        common::write(&folder, &files);
        assert!(simulated(&tools, &folder, "player_tb").contains("FAIL player"), "{path} {wrong}");
    }
    println!("{} faults between pins and player: the test bench finds them", FAULTS.len());
}

/// The example drives every segment for all its ticks; without its program it moves not at all.
#[test]
fn the_example_drives_its_program() {
    let Some(tools) = common::programs("the_example_drives_its_program", ["iverilog", "vvp"]) else { return };
    let mut rng = Rng::new(4);
    let folder = common::folder("player_example");
    for drive in [Drive::Differential, Drive::Steered] {
        for case in 0..4 {
            let segments = if case == 0 { Vec::new() } else { program(&mut rng) };
            common::write(&folder, &verilog::player(&segments, drive).unwrap());
            let said = simulated(&tools, &folder, "player_example_tb");
            let ticks: u32 = segments.iter().map(|segment| segment.ticks).sum();
            let end = format!("PASS example: the program has ended after {ticks} ticks");
            assert!(said.contains(&end), "{segments:?} {said}");
            std::fs::remove_file(folder.join("rtl/player.hex")).unwrap();
            let said = simulated(&tools, &folder, "player_example_tb");
            assert!(said.contains("FAIL example: the outputs are unknown"), "{said}");
        }
    }
    println!("8 programs: the example ends after all their ticks, and tells of a program that is not there");
}

/// The test bench as it is shipped passes, and fails if what it expects is wrong.
#[test]
fn the_test_bench_passes_and_finds_faults() {
    let Some(tools) = common::programs("the_test_bench_passes_and_finds_faults", ["iverilog", "vvp"]) else {
        return;
    };
    let mut rng = Rng::new(2);
    let folder = common::folder("player_bench");
    let mut clocks = 0;
    for case in 0..30 {
        let segments = match case {
            0 => Vec::new(),
            1 => vec![Segment { motion: Motion::Reverse, ticks: 100_000 }],
            3 => Motion::ALL.repeat(3).into_iter().map(|motion| Segment { motion, ticks: LONG }).collect(),
            _ => program(&mut rng),
        };
        let drive = [Drive::Differential, Drive::Steered][case / 3 % 2];
        let mut files = verilog::player(&segments, drive).unwrap();
        if case == 3 {
            must_end(&mut files);
        }
        let is_wrong = case % 3 == 2;
        if is_wrong {
            let trace = files.last_mut().unwrap();
            let place = trace.text.len() - 5; // q3 to q0 of the last line
            trace.text.replace_range(place..=place, "2");
        }
        common::write(&folder, &files);
        let said = simulated(&tools, &folder, "player_tb");
        assert_eq!(said.contains("FAIL player"), is_wrong, "{said}");
        assert_eq!(said.contains("ended after 12 segments"), case == 3, "{said}");
        assert_eq!(said.contains("PASS player"), !is_wrong, "{said}");
        clocks += said.split_whitespace().find_map(|word| word.parse::<usize>().ok()).unwrap_or(0);
    }
    println!("30 programs, {clocks} clocks: 20 benches pass, 10 with a wrong expectation fail");
}
