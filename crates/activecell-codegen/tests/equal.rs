//! The modules without state equal the core for every input, and what must never happen does not.

#![allow(clippy::unwrap_used)] // A test may panic.

mod common;

use activecell::control::{Inputs, State, TABLE};
use activecell::rule::{Decision, Sector, decide};
use activecell::{Cell, Lattice};
use activecell_codegen::logic::{Circuit, Port};
use activecell_codegen::{circuits, verilog};
use common::cxxrtl::Simulation;
use std::path::{Path, PathBuf};

/// Inputs of more bits than that are sampled where the simulator is slow.
const SLOW_BITS: u32 = 18;

/// The modules under test, with how many bits of inputs they have.
fn modules() -> Vec<(Circuit, u32)> {
    let of_rule = Lattice::ALL.map(|lattice| [circuits::sector(lattice), circuits::decision(lattice)]);
    let all = of_rule.into_iter().flatten().chain([circuits::control()]);
    all.map(|circuit| (circuit.inputs.iter().map(|port| port.width).sum(), circuit))
        .map(|(bits, circuit)| (circuit, bits))
        .collect()
}

/// What the core gives for all inputs: the inputs' ports and the outputs' ports, each from the lowest bit on.
fn core(circuit: &Circuit) -> Box<dyn Iterator<Item = (u32, u32)>> {
    for lattice in Lattice::ALL {
        if circuit.name == format!("decide_{lattice}") {
            return Box::new(decisions(lattice));
        }
        if circuit.name == format!("sector_{lattice}") {
            return Box::new(sectors(lattice));
        }
    }
    Box::new((0..8u32 << 8).map(|input| {
        let (state, g) = (input & 7, input >> 3);
        // The two numbers that are no states act as calm.
        let state = State::ALL.get(state as usize).copied().unwrap_or_default();
        let q = state.outputs().iter().rev().fold(0, |q, &output| q << 1 | u32::from(output));
        (input, TABLE[state as usize][g as usize] as u32 | q << 3)
    }))
}

fn decisions(lattice: Lattice) -> impl Iterator<Item = (u32, u32)> {
    let lanes = u32::from(lattice.degree());
    (0..1u32 << (3 * lanes)).flat_map(move |around| {
        let bits = circuits::neighbourhood(lattice, [0, 1, 2].map(|group| around >> (group * lanes)));
        Sector::all(lattice).flat_map(move |sector| {
            [false, true].map(|near| {
                let sector_bits = if lattice == Lattice::Square { 3 } else { 4 };
                let told = u32::from(sector.number()) | u32::from(near) << sector_bits;
                let decided = match decide(lattice, sector, near, bits) {
                    Decision::Move(dir) => 1 << dir.0,
                    Decision::Enclosed => 1 << lanes,
                };
                (around | told << (3 * lanes), decided)
            })
        })
    })
}

/// From even and from odd rows, to all cells of a floor.
fn sectors(lattice: Lattice) -> impl Iterator<Item = (u32, u32)> {
    let from = [Cell::new(70, 70), Cell::new(70, 71)];
    let to = (0..142).flat_map(|y| (0..142).map(move |x| Cell::new(x, y)));
    from.into_iter().flat_map(move |from| {
        to.clone().filter_map(move |to| {
            let sector = Sector::towards(lattice, from, to)?;
            let bearing = circuits::Bearing::between(lattice, from, to).inputs(lattice);
            Some((bearing.iter().rev().fold(0, |bits, bit| bits << 1 | bit), sector.number().into()))
        })
    })
}

/// Holds the outputs, by inputs, against the core; `None` where an input was left out. Gives the number of comparisons.
fn compare(circuit: &Circuit, outputs: &[Option<u32>]) -> usize {
    let compared =
        core(circuit).filter_map(|(input, expected)| Some((input, expected, outputs[input as usize]?)));
    compared
        .map(|(input, expected, output)| {
            assert_eq!(output, expected, "{}: inputs {input:b}", circuit.name);
        })
        .count()
}

fn write(folder: &Path, circuit: &Circuit) {
    std::fs::write(folder.join(format!("{}.v", circuit.name)), verilog::module(circuit)).unwrap();
}

/// The ports of a list, each with the place of its lowest bit.
fn placed<'a>(ports: impl Iterator<Item = &'a Port>) -> impl Iterator<Item = (&'a Port, u32)> {
    ports.scan(0, |place, port| {
        *place += port.width;
        Some((port, *place - port.width))
    })
}

/// Gives all inputs, writes two bytes of outputs for each.
fn simulate(tools: &[PathBuf; 2], circuit: &Circuit, bits: u32) -> Vec<Option<u32>> {
    let folder = common::folder(&format!("all_{}", circuit.name));
    write(&folder, circuit);
    let name = |port: &Port| port.name.replace('_', "__");
    let given: Vec<String> = placed(circuit.inputs.iter())
        .map(|(port, place)| {
            format!("top.p_{}.set<uint32_t>(n >> {place} & {});", name(port), (1u64 << port.width) - 1)
        })
        .collect();
    let seen: Vec<String> = placed(circuit.outputs().map(|wire| &wire.port))
        .map(|(port, place)| format!("top.p_{}.get<uint32_t>() << {place}", name(port)))
        .collect();
    let main = format!(
        "int main() {{\n    cxxrtl_design::p_{} top;\n    for (uint32_t n = 0; n < 1u << {bits}; n++) {{\n        {}\n        \
         top.step();\n        uint32_t seen = {};\n        std::putchar(seen & 255);\n        std::putchar(seen >> 8);\n    }}\n}}\n",
        circuit.name.replace('_', "__"),
        given.join("\n        "),
        seen.join(" | "),
    );
    let script = format!("read_verilog {0}.v; hierarchy -check -top {0}; proc; check -assert", circuit.name);
    let output = Simulation::compile(tools, &folder, &script, &main).run(&[]);
    output.chunks(2).map(|bytes| Some(u32::from(bytes[0]) | u32::from(bytes[1]) << 8)).collect()
}

#[test]
fn compiled_modules_equal_the_core_for_every_input() {
    let test = "compiled_modules_equal_the_core_for_every_input";
    let Some(tools) = common::programs(test, ["yosys", "g++"]) else { return };
    for (circuit, bits) in modules() {
        let outputs = simulate(&tools, &circuit, bits);
        assert_eq!(outputs.len(), 1 << bits);
        println!("{}: {} outputs are the core's", circuit.name, compare(&circuit, &outputs));
    }
}

/// Once more by another simulator, which reads the text itself. It is slow: of the largest module it is given every
/// neighbourhood, but with one sector each.
#[test]
fn interpreted_modules_equal_the_core() {
    let Some([iverilog, vvp]) = common::programs("interpreted_modules_equal_the_core", ["iverilog", "vvp"])
    else {
        return;
    };
    for (circuit, bits) in modules() {
        let folder = common::folder(&format!("interpreted_{}", circuit.name));
        write(&folder, &circuit);
        let connected = |ports: Vec<(&Port, u32)>, wires: &str| {
            let ports = ports.iter();
            ports
                .map(|(port, place)| format!(".{}({wires}[{place} +: {}])", port.name, port.width))
                .collect::<Vec<_>>()
        };
        let inputs = connected(placed(circuit.inputs.iter()).collect(), "n");
        let outputs = connected(placed(circuit.outputs().map(|wire| &wire.port)).collect(), "seen");
        let ports = [inputs, outputs].concat().join(", ");
        let input = |i: u32| i | (i % 31) << SLOW_BITS & ((1 << bits) - 1);
        let seen_bits = circuit.outputs().map(|wire| wire.port.width).sum::<u32>();
        let bench = format!(
            "module bench;\n    reg [31:0] n;\n    wire [{}:0] seen;\n    integer i;\n    {} dut ({ports});\n    initial\n        \
             for (i = 0; i < {}; i = i + 1) begin\n            n = i | (((i % 31) << {SLOW_BITS}) & {});\n            #1 \
             $display(\"%h\", seen);\n        end\nendmodule\n",
            seen_bits - 1,
            circuit.name,
            1u32 << bits.min(SLOW_BITS),
            (1u32 << bits) - 1,
        );
        std::fs::write(folder.join("bench.v"), bench).unwrap();
        let mut compile = common::command(&iverilog, &folder);
        common::run(compile.args(["-g2005", "-o", "bench.vvp", "bench.v", &format!("{}.v", circuit.name)]));
        let told = common::run(common::command(&vvp, &folder).args(["-n", "bench.vvp"]));
        let mut outputs = vec![None; 1 << bits];
        for (i, line) in told.lines().enumerate() {
            let seen = u32::from_str_radix(line, 16).unwrap_or_else(|_| panic!("{}: {line}", circuit.name));
            outputs[input(i as u32) as usize] = Some(seen);
        }
        println!("{}: {} outputs are the core's", circuit.name, compare(&circuit, &outputs));
    }
}

/// Whether the solver proves that `ok` is 1 for all inputs of the module `claims`, which uses the one of the circuit.
fn proves(yosys: &Path, circuit: &Circuit, text: &str, claims: &str) -> bool {
    let folder = common::folder(&format!("claims_{}", circuit.name));
    std::fs::write(folder.join("module.v"), text).unwrap();
    std::fs::write(folder.join("claims.v"), claims).unwrap();
    let script = "read_verilog module.v claims.v; hierarchy -check -top claims; proc; flatten; memory; opt; sat -prove ok 1";
    let output = common::command(yosys, &folder).args(["-p", script]).output().unwrap();
    let told = String::from_utf8_lossy(&output.stdout);
    let (holds, fails) = (told.contains("SUCCESS!"), told.contains("FAIL!"));
    assert!(output.status.success() && holds != fails, "{told}{}", String::from_utf8_lossy(&output.stderr));
    holds
}

/// The claims hold, and each change of the text, from the one to the other, makes them fail.
fn check(yosys: &Path, circuit: &Circuit, claims: &str, changes: &[(&str, &str)]) {
    let text = verilog::module(circuit);
    assert!(proves(yosys, circuit, &text, claims), "{}", circuit.name);
    for (from, to) in changes {
        let changed = text.replacen(from, to, 1);
        assert_ne!(changed, text, "{}: no `{from}` to change", circuit.name);
        assert!(!proves(yosys, circuit, &changed, claims), "{}: `{to}` does no harm", circuit.name);
    }
    println!("{}: its claims are proven, and refuted for {} changed modules", circuit.name, changes.len());
}

#[test]
fn decisions_never_lead_into_obstacles() {
    let Some([yosys]) = common::programs("decisions_never_lead_into_obstacles", ["yosys"]) else { return };
    for lattice in Lattice::ALL {
        let circuit = circuits::decision(lattice);
        let top = lattice.degree() - 1;
        let sector = circuit.inputs.iter().find(|port| port.name == "sector").unwrap().width - 1;
        let claims = format!(
            "module claims(input [{top}:0] ring1, ahead, between, input [{sector}:0] sector, input is_near, output ok);
    wire [{top}:0] go;
    wire enclosed;
    decide_{lattice} dut(.ring1(ring1), .ahead(ahead), .between(between), .sector(sector), .is_near(is_near),
        .go(go), .enclosed(enclosed));
    wire at_most_one = (go & (go - 1)) == 0;
    wire into_none = (go & ring1) == 0;
    wire enclosed_by_all = enclosed == &ring1;
    wire goes_or_enclosed = |go ^ enclosed;
    assign ok = at_most_one & into_none & enclosed_by_all & goes_or_enclosed;
endmodule
"
        );
        let changes = [("~ring1", "~(ring1 & 2)"), ("~{", "{"), ("enclosed = ", "enclosed = ~ring1[0] & ")];
        check(&yosys, &circuit, &claims, &changes);
    }
}

/// A stop stops, nothing is driven at, and there are six words of outputs, never left and right while driving on.
#[test]
fn control_never_drives_at_obstacles() {
    let Some([yosys]) = common::programs("control_never_drives_at_obstacles", ["yosys"]) else { return };
    let circuit = circuits::control();
    let words: Vec<String> = State::ALL
        .iter()
        .map(|state| {
            let word = state.outputs().iter().rev().fold(0, |word, &output| word << 1 | u8::from(output));
            format!("word == 4'd{word}")
        })
        .collect();
    let flags: Vec<String> = State::ALL
        .iter()
        .filter_map(|&state| {
            let Inputs(flag) = state.drives_towards()?;
            Some(format!("(next != 3'd{} | ~g[{}])", state as u8, flag.trailing_zeros()))
        })
        .collect();
    let [calm, stopped] = [State::Calm, State::Stopped].map(|state| state as u8);
    let claims = format!(
        "module claims(input [2:0] state, input [7:0] g, output ok);
    wire [2:0] next;
    wire [3:0] word;
    control_next now(.state(state), .g(g), .next_state(next));
    control_next then(.state(next), .g(8'd0), .q0(word[0]), .q1(word[1]), .q2(word[2]), .q3(word[3]));
    wire stop_wins = ~g[6] | next == 3'd{calm} | next == 3'd{stopped};
    wire drives_at_nothing = {};
    wire one_of_six = {};
    wire one_side = ~(word[1] & word[2] & word[3]);
    wire is_state = next < 3'd{};
    assign ok = stop_wins & drives_at_nothing & one_of_six & one_side & is_state;
endmodule
",
        flags.join(" & "),
        words.join(" | "),
        State::ALL.len(),
    );
    let changes =
        [("& ~g[6]", "& 1'b1"), ("& ~g[4]", "& 1'b1"), ("& ~g[3]", "& 1'b1"), ("q2 = ", "q2 = state[0] | ")];
    check(&yosys, &circuit, &claims, &changes);
}
