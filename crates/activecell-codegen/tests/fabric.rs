//! The generated fabric against its model and the core.

#![expect(clippy::unwrap_used, reason = "a test that cannot prepare itself should stop")]

mod common;

use activecell::{Cell, Lattice, Map, Rng};
use activecell_codegen::model::fabric::{Fabric, Inputs, Outputs};
use activecell_codegen::verilog;
use common::aig::{Aig, aig};

const INPUTS: [&str; 8] =
    ["reset", "load_map", "scan_in", "begin_task", "start_x", "start_y", "target_x", "target_y"];
const OUTPUTS: [&str; 9] =
    ["busy", "moving", "at_x", "at_y", "arrived", "unreachable", "reached", "active", "pointer"];

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
        let gates = aig(test, &files, "fabric", &OUTPUTS[6..])?;
        let inputs = INPUTS.map(|name| gates.port(name)).to_vec();
        let outputs = OUTPUTS.iter().flat_map(|name| gates.port(name)).collect();
        let lanes = map.lattice().degree();
        let mut pair = Self { fabric: Fabric::new(map), gates, inputs, outputs, lanes, clocks: 0 };
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
            // A bit more than cells, for all that lies outside.
            .chain(self.fabric.reached().chain([false]))
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
        }
    }
    let (lattice, width, height) = (first.lattice(), first.width(), first.height());
    let kind = if loadable { "loaded" } else { "fixed" };
    println!(
        "fabric {lattice} {width} x {height}: {} {kind} maps, {} tasks, {} clocks as the model",
        maps.len(),
        3 * tasks * maps.len(),
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
        for (width, height) in [(8, 8), (11, 3), (1, 6)] {
            let maps = random_maps(lattice, width, height, 150);
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
