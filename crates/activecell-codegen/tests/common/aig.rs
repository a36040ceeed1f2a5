//! Generated Verilog as gates: yosys reduces it to AND gates and inverters, which are simulated here, 64 tasks at once.

use super::{folder, programs, yosys};
use activecell_codegen::SourceFile;
use std::collections::BTreeMap;

/// A design of AND gates, inverters and registers (the AIGER format, ASCII form), a simulation a bit of each word.
///
/// Biere, Heljanko, Wieringa: *AIGER 1.9 and Beyond*, 2011. A literal is twice a variable's number, plus 1 if inverted.
#[derive(Debug, Clone)]
pub(crate) struct Aig {
    inputs: Vec<u32>,
    /// Each register's variable, and the literal that it takes over at a clock.
    registers: Vec<[u32; 2]>,
    outputs: Vec<u32>,
    /// Each gate's variable and the literals of its inputs, inputs before those that use them.
    gates: Vec<[u32; 3]>,
    names: BTreeMap<String, usize>,
    values: Vec<u64>,
    next: Vec<u64>,
    /// The gates' values follow from those of the inputs and registers.
    is_settled: bool,
}

/// Reads a design; `None`, loudly, without yosys. Wires of the top module are seen beside its outputs.
pub(crate) fn aig(test: &str, files: &[SourceFile], top: &str, wires: &[&str]) -> Option<Aig> {
    let [program] = programs(test, ["yosys"])?;
    let folder = folder(test);
    let verilog: Vec<&SourceFile> = files.iter().filter(|file| file.path.starts_with("rtl/")).collect();
    for file in &verilog {
        let path = folder.join(&file.path);
        std::fs::create_dir_all(path.parent().expect("a file lies in the folder")).expect("it can be made");
        std::fs::write(path, &file.text).expect("the target folder can be written");
    }
    let sources: Vec<&str> = verilog.iter().map(|file| file.path.as_str()).collect();
    let expose =
        wires.iter().fold(String::new(), |script, name| script + &format!("expose {top}/w:{name}; "));
    let script = format!(
        "read_verilog {}; hierarchy -check -top {top}; proc; flatten; {expose}opt; techmap; opt; \
         dfflegalize -cell $_DFF_P_ 0; setundef -zero; aigmap; opt_clean; write_aiger -ascii -symbols design.aag",
        sources.join(" ")
    );
    yosys(&program, &folder, &script);
    Some(Aig::parse(&std::fs::read_to_string(folder.join("design.aag")).expect("yosys wrote it")))
}

impl Aig {
    /// # Panics
    /// If the text is not what yosys writes.
    fn parse(text: &str) -> Self {
        let mut lines = text.lines();
        let mut numbers = || -> Vec<u32> {
            let words = lines.next().expect("a line more").split(' ');
            words.filter_map(|word| word.parse().ok()).collect()
        };
        let header = numbers();
        let [variables, inputs, registers, outputs, gates] = header[..5] else { panic!("{header:?}") };
        let inputs = (0..inputs).map(|_| numbers()[0] / 2).collect();
        let registers = (0..registers).map(|_| numbers()).map(|row| [row[0] / 2, row[1]]).collect();
        let outputs = (0..outputs).map(|_| numbers()[0]).collect();
        let gates = (0..gates).map(|_| numbers()).map(|row| [row[0] / 2, row[1], row[2]]).collect();
        let mut names = BTreeMap::new();
        for line in lines.take_while(|line| *line != "c") {
            let (place, name) = line.split_once(' ').expect("a place and a name");
            if !place.starts_with('l') {
                names.insert(name.to_owned(), place[1..].parse().expect("a number"));
            }
        }
        let values = vec![0; variables as usize + 1];
        Self { inputs, registers, outputs, gates, names, values, next: Vec::new(), is_settled: false }
    }

    /// The places of a port's bits, the lowest first.
    pub(crate) fn port(&self, name: &str) -> Vec<usize> {
        let bits: Vec<usize> =
            (0..).map_while(|bit| self.names.get(&format!("{name}[{bit}]")).copied()).collect();
        let bit = self.names.get(name).copied();
        if bits.is_empty() { bit.into_iter().collect() } else { bits }
    }

    /// Drives a bit of an input: a simulation a bit.
    pub(crate) fn drive(&mut self, place: usize, simulations: u64) {
        let value = &mut self.values[self.inputs[place] as usize];
        self.is_settled &= *value == simulations;
        *value = simulations;
    }

    /// Drives an input alike in all simulations.
    pub(crate) fn drive_all(&mut self, port: &[usize], number: u32) {
        for (bit, &place) in port.iter().enumerate() {
            self.drive(place, if number >> bit & 1 == 1 { u64::MAX } else { 0 });
        }
    }

    /// A bit of an output: a simulation a bit.
    pub(crate) fn seen(&self, place: usize) -> u64 {
        self.literal(self.outputs[place])
    }

    /// A clock; what is seen afterwards are the registers' new values and what follows from them.
    pub(crate) fn clock(&mut self) {
        if !self.is_settled {
            self.settle();
        }
        let mut next = std::mem::take(&mut self.next);
        next.clear();
        next.extend(self.registers.iter().map(|&[_, from]| self.literal(from)));
        for (&[register, _], &value) in self.registers.iter().zip(&next) {
            self.values[register as usize] = value;
        }
        self.next = next;
        self.settle();
    }

    fn settle(&mut self) {
        for &[gate, a, b] in &self.gates {
            self.values[gate as usize] = literal(&self.values, a) & literal(&self.values, b);
        }
        self.is_settled = true;
    }

    fn literal(&self, number: u32) -> u64 {
        literal(&self.values, number)
    }
}

#[inline]
fn literal(values: &[u64], number: u32) -> u64 {
    values[(number / 2) as usize] ^ u64::from(number & 1).wrapping_neg()
}
