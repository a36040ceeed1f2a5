//! Circuits: named signals, each a formula over those before it.

use super::keywords::is_keyword;
use std::fmt;

/// An input, a wire or an output, by its place in the circuit: inputs first, then wires.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Signal(pub usize);

/// A signal that is given from outside.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Port {
    /// In lower case with underscores; no keyword of C, Verilog or VHDL.
    pub name: String,
    /// Bits, at most 32. Lane 0 is the lowest bit.
    pub width: u32,
    /// What it means, for the comment beside it.
    pub about: String,
}

/// A signal that is computed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Wire {
    /// Its name, width and meaning.
    pub port: Port,
    /// How it is computed.
    pub expr: Expr,
    /// Whether it is seen from outside.
    pub is_output: bool,
}

/// A formula over signals. All operations work on all lanes of a signal at once, a neighbour a lane.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Expr {
    /// The same bits.
    Signal(Signal),
    /// A number of that many bits.
    Const {
        /// Bits.
        width: u32,
        /// The number.
        value: u32,
    },
    /// One bit of a signal.
    Bit(Signal, u32),
    /// Every bit inverted.
    Not(Box<Expr>),
    /// 1 where all are.
    And(Vec<Expr>),
    /// 1 where one is.
    Or(Vec<Expr>),
    /// One bit: whether some bit is 1.
    Any(Box<Expr>),
    /// The second if the first, one bit, is 1, else the third.
    Select(Box<Expr>, Box<Expr>, Box<Expr>),
    /// The bits of a signal, each moved to the next lane, the last to the first: what lies to the left of each neighbour.
    FromLeft(Signal),
    /// Only the lowest 1 of a signal.
    Lowest(Signal),
    /// The entry of a table at the place that a signal says; behind its end the last entry.
    Lookup {
        /// The entries.
        table: Vec<u32>,
        /// Bits of each.
        width: u32,
        /// The place.
        index: Signal,
    },
    /// Signals side by side, the first in the lowest bits.
    Join(Vec<Signal>),
}

/// A combinational circuit.
///
/// ```
/// use activecell_codegen::logic::{Circuit, Expr};
/// let mut circuit = Circuit::new("common", "Whether all of three are there.");
/// let [a, b] = ["a", "b"].map(|name| circuit.input(name, 3, "three of them"));
/// let both = circuit.wire("both", Expr::And(vec![Expr::Signal(a), Expr::Signal(b)]), "in both");
/// let none = circuit.output("none", Expr::Not(Box::new(Expr::Any(Box::new(Expr::Signal(both))))), "in both none");
/// circuit.check()?;
/// assert_eq!(circuit.evaluate(&[0b110, 0b011]), [0]);
/// # let _ = none;
/// # Ok::<(), activecell_codegen::logic::Fault>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Circuit {
    /// The name of the module, entity or function.
    pub name: String,
    /// What it does, a sentence or more.
    pub about: String,
    /// What it is given.
    pub inputs: Vec<Port>,
    /// What it computes, in order.
    pub wires: Vec<Wire>,
}

/// What is wrong with a circuit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// The signal.
    pub name: String,
    /// What is wrong with it.
    pub fault: &'static str,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "signal {}: {}", self.name, self.fault)
    }
}

impl std::error::Error for Fault {}

impl Circuit {
    /// Nothing yet.
    pub fn new(name: &str, about: &str) -> Self {
        Self { name: name.into(), about: about.into(), inputs: Vec::new(), wires: Vec::new() }
    }

    /// One more input; all inputs come before the first wire.
    pub fn input(&mut self, name: &str, width: u32, about: &str) -> Signal {
        debug_assert!(self.wires.is_empty(), "inputs come first");
        self.inputs.push(Port { name: name.into(), width, about: about.into() });
        Signal(self.inputs.len() - 1)
    }

    /// One more wire.
    pub fn wire(&mut self, name: &str, expr: Expr, about: &str) -> Signal {
        let port = Port { name: name.into(), width: self.width(&expr).unwrap_or(0), about: about.into() };
        self.wires.push(Wire { port, expr, is_output: false });
        Signal(self.inputs.len() + self.wires.len() - 1)
    }

    /// One more wire that is seen from outside.
    pub fn output(&mut self, name: &str, expr: Expr, about: &str) -> Signal {
        let signal = self.wire(name, expr, about);
        if let Some(wire) = self.wires.last_mut() {
            wire.is_output = true;
        }
        signal
    }

    /// The name, width and meaning of a signal.
    ///
    /// # Panics
    /// If the circuit has no such signal.
    pub fn port(&self, signal: Signal) -> &Port {
        let wire = signal.0.checked_sub(self.inputs.len());
        wire.map_or_else(|| &self.inputs[signal.0], |wire| &self.wires[wire].port)
    }

    /// What is seen from outside, in order.
    pub fn outputs(&self) -> impl Iterator<Item = &Wire> {
        self.wires.iter().filter(|wire| wire.is_output)
    }

    /// How many bits a formula has; `None` if its parts do not fit together.
    pub fn width(&self, expr: &Expr) -> Option<u32> {
        let known = |signal: Signal| {
            (signal.0 < self.inputs.len() + self.wires.len()).then(|| self.port(signal).width)
        };
        match expr {
            Expr::Signal(signal) | Expr::FromLeft(signal) | Expr::Lowest(signal) => known(*signal),
            &Expr::Const { width, value } => (value.checked_shr(width).unwrap_or(0) == 0).then_some(width),
            &Expr::Bit(signal, bit) => known(signal).filter(|&width| bit < width).map(|_| 1),
            Expr::Not(inner) => self.width(inner),
            Expr::And(parts) | Expr::Or(parts) => {
                let first = self.width(parts.first()?)?;
                parts.iter().all(|part| self.width(part) == Some(first)).then_some(first)
            }
            Expr::Any(inner) => self.width(inner).map(|_| 1),
            Expr::Select(condition, yes, no) => {
                let width = self.width(yes)?;
                (self.width(condition) == Some(1) && self.width(no) == Some(width)).then_some(width)
            }
            Expr::Lookup { table, width, index } => {
                let places = 1usize.checked_shl(known(*index)?)?;
                let fits = table.iter().all(|entry| entry.checked_shr(*width).unwrap_or(0) == 0);
                (!table.is_empty() && table.len() <= places && fits).then_some(*width)
            }
            Expr::Join(parts) => parts.iter().map(|&part| known(part)).sum(),
        }
    }

    /// Whether it can be written out: names that all three languages take, once each, and widths that fit.
    ///
    /// # Errors
    /// The first fault.
    pub fn check(&self) -> Result<(), Fault> {
        let ports = self.inputs.iter().chain(self.wires.iter().map(|wire| &wire.port));
        for (place, port) in ports.clone().enumerate() {
            let fault = |fault| Err(Fault { name: port.name.clone(), fault });
            let letters = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
            let name = port.name.as_str();
            let plain = name.starts_with(|c: char| c.is_ascii_lowercase())
                && name.chars().all(letters)
                && !name.ends_with('_')
                && !name.contains("__");
            if !plain {
                return fault("the name must be lower case letters, digits and single underscores");
            }
            if is_keyword(name) || name == self.name {
                return fault("the name is a keyword of a language, or that of the circuit");
            }
            if ports.clone().take(place).any(|other| other.name == port.name) {
                return fault("the name stands twice");
            }
            if port.width == 0 || port.width > 32 {
                return fault("the parts do not fit together, or have more than 32 bits");
            }
        }
        Ok(())
    }

    /// The outputs for these inputs, both in order: what the written-out circuit must compute.
    ///
    /// # Panics
    /// If there are fewer values than inputs.
    pub fn evaluate(&self, inputs: &[u32]) -> Vec<u32> {
        let mut values = inputs[..self.inputs.len()].to_vec();
        for wire in &self.wires {
            values.push(self.value(&wire.expr, &values));
        }
        let wires = self.wires.iter().zip(&values[self.inputs.len()..]);
        wires.filter(|(wire, _)| wire.is_output).map(|(_, &value)| value).collect()
    }

    fn value(&self, expr: &Expr, values: &[u32]) -> u32 {
        let of = |expr: &Expr| self.value(expr, values);
        let mask = |signal: &Signal| mask(self.port(*signal).width);
        match expr {
            Expr::Signal(signal) => values[signal.0],
            Expr::Const { value, .. } => *value,
            Expr::Bit(signal, bit) => values[signal.0] >> bit & 1,
            Expr::Not(inner) => of(inner) ^ mask_of(self.width(inner)),
            Expr::And(parts) => parts.iter().map(of).fold(u32::MAX, |a, b| a & b),
            Expr::Or(parts) => parts.iter().map(of).fold(0, |a, b| a | b),
            Expr::Any(inner) => u32::from(of(inner) != 0),
            Expr::Select(condition, yes, no) => of(if of(condition) == 1 { yes } else { no }),
            Expr::FromLeft(signal) => {
                let value = values[signal.0];
                (value << 1 | value >> (self.port(*signal).width - 1)) & mask(signal)
            }
            Expr::Lowest(signal) => values[signal.0] & values[signal.0].wrapping_neg(),
            Expr::Lookup { table, index, .. } => table[(values[index.0] as usize).min(table.len() - 1)],
            Expr::Join(parts) => parts.iter().rev().fold(0, |sum, part| {
                let bits = values[part.0];
                sum.checked_shl(self.port(*part).width).unwrap_or(0) | bits
            }),
        }
    }
}

fn mask_of(width: Option<u32>) -> u32 {
    width.map_or(0, mask)
}

/// That many ones.
pub(crate) const fn mask(width: u32) -> u32 {
    if width >= 32 { u32::MAX } else { (1 << width) - 1 }
}
