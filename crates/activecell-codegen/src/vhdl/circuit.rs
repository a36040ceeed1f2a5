//! Circuits as entities.

use crate::SourceFile;
use crate::logic::{Circuit, Expr, Port, Signal, Wire};
use crate::text::{Cases, joined, lines, whole};

/// The package of operations that entities of circuits use.
pub fn lanes() -> SourceFile {
    SourceFile::new("rtl/lanes.vhd", include_str!("templates/lanes.vhd"))
}

/// A circuit as an entity without state. It needs the package [`lanes`].
///
/// ```
/// use activecell::Lattice;
/// use activecell_codegen::{circuits, vhdl};
/// let text = vhdl::entity(&circuits::decision(Lattice::Square));
/// assert!(text.contains("entity decide_square is"));
/// ```
pub fn entity(circuit: &Circuit) -> String {
    let name = &circuit.name;
    let mut text = format!("-- {}\n", circuit.about.replace('\n', "\n-- "));
    text += "library ieee;\nuse ieee.std_logic_1164.all;\nuse ieee.numeric_std.all;\nuse work.lanes.all;\n\n";
    text += &format!("entity {name} is\n    port (\n{}    );\nend entity {name};\n\n", ports(circuit));
    text += &format!("architecture rtl of {name} is\n{}begin\n", signals(circuit));
    let statements: Vec<String> =
        circuit.wires.iter().enumerate().map(|(place, wire)| statement(circuit, place, wire)).collect();
    text + &statements.join("\n") + "end architecture rtl;\n"
}

fn ports(circuit: &Circuit) -> String {
    let inputs = circuit.inputs.iter().map(|port| ("in ", port));
    let ports: Vec<(&str, &Port)> = inputs.chain(circuit.outputs().map(|wire| ("out", &wire.port))).collect();
    let column = |length: fn(&Port) -> usize| ports.iter().map(|(_, port)| length(port)).max().unwrap_or(0);
    let (names, kinds) = (column(|port| port.name.len()), column(|port| kind(port.width).len()) + 1);
    let line = |(place, (direction, port)): (usize, &(&str, &Port))| {
        let kind = kind(port.width) + if place + 1 == ports.len() { "" } else { ";" };
        format!("        {:names$} : {direction} {kind:kinds$} -- {}\n", port.name, port.about)
    };
    ports.iter().enumerate().map(line).collect()
}

fn kind(width: u32) -> String {
    if width == 1 { "std_logic".into() } else { format!("std_logic_vector({} downto 0)", width - 1) }
}

/// The wires, and those outputs that are read inside too, which VHDL-93 does not allow.
fn signals(circuit: &Circuit) -> String {
    let places = circuit.inputs.len()..circuit.inputs.len() + circuit.wires.len();
    let inside = places.map(Signal).zip(&circuit.wires);
    let inside: Vec<(String, &Port)> = inside
        .filter(|(signal, wire)| !wire.is_output || is_read(circuit, *signal))
        .map(|(signal, wire)| (name(circuit, signal), &wire.port))
        .collect();
    let names = inside.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    let kinds = inside.iter().map(|(_, port)| kind(port.width).len()).max().unwrap_or(0) + 1;
    let line = |(name, port): &(String, &Port)| {
        let kind = kind(port.width) + ";";
        format!("    signal {name:names$} : {kind:kinds$} -- {}\n", port.about)
    };
    inside.iter().map(line).collect()
}

/// What a signal is called inside.
fn name(circuit: &Circuit, signal: Signal) -> String {
    let wire = signal.0.checked_sub(circuit.inputs.len()).map(|wire| &circuit.wires[wire]);
    let suffix = if wire.is_some_and(|wire| wire.is_output) { "_inside" } else { "" };
    format!("{}{suffix}", circuit.port(signal).name)
}

fn is_read(circuit: &Circuit, signal: Signal) -> bool {
    circuit.wires.iter().any(|wire| reads(&wire.expr, signal))
}

fn reads(expr: &Expr, signal: Signal) -> bool {
    match expr {
        Expr::Signal(read) | Expr::Bit(read, _) | Expr::FromLeft(read) | Expr::Lowest(read) => {
            *read == signal
        }
        Expr::Const { .. } => false,
        Expr::Not(inner) | Expr::Any(inner) => reads(inner, signal),
        Expr::And(parts) | Expr::Or(parts) => parts.iter().any(|part| reads(part, signal)),
        Expr::Select(condition, yes, no) => [condition, yes, no].iter().any(|part| reads(part, signal)),
        Expr::Lookup { index, .. } => *index == signal,
        Expr::Join(parts) => parts.contains(&signal),
    }
}

fn statement(circuit: &Circuit, place: usize, wire: &Wire) -> String {
    let signal = Signal(circuit.inputs.len() + place);
    let is_inside = !wire.is_output || is_read(circuit, signal);
    let name = if is_inside { name(circuit, signal) } else { wire.port.name.clone() };
    let assignment = match &wire.expr {
        Expr::Lookup { table, width, index } => lookup(circuit, &name, table, *width, *index),
        Expr::Select(condition, yes, no) => {
            let [condition, yes, no] = [condition, yes, no].map(|part| formula(circuit, part));
            format!("    {name} <= {} when {condition} = '1' else {};\n", whole(&yes), whole(&no))
        }
        expr => format!("    {name} <= {};\n", lines(whole(&formula(circuit, expr)), " or ")),
    };
    let output = if wire.is_output && is_inside {
        format!("    {} <= {name};\n", wire.port.name)
    } else {
        String::new()
    };
    assignment + &output
}

/// A table as a conditional assignment, which becomes gates. Not a selected one: GHDL 2.0 loses the last choice of those
/// when it writes Verilog, and the proof that VHDL and Verilog are equal goes that way.
fn lookup(circuit: &Circuit, name: &str, table: &[u32], width: u32, index: Signal) -> String {
    let Cases { entries, default } = Cases::of(table);
    let (index_name, index_bits) = (self::name(circuit, index), circuit.port(index).width);
    let mut text = format!("    {name} <=\n");
    for (entry, places) in entries {
        let places = places.iter().map(|&place| literal(place as u32, index_bits));
        let places: Vec<String> = places.map(|place| format!("{index_name} = {place}")).collect();
        text += &format!("        {} when {} else\n", literal(entry, width), places.join(" or "));
    }
    text + &format!("        {};\n", literal(default, width))
}

fn literal(value: u32, width: u32) -> String {
    let digits = width as usize;
    let quote = if width == 1 { '\'' } else { '"' };
    format!("{quote}{value:0digits$b}{quote}")
}

fn formula(circuit: &Circuit, expr: &Expr) -> String {
    let name = |signal: &Signal| name(circuit, *signal);
    let list = |parts: &[Expr], operator: &str| {
        joined(&parts.iter().map(|part| formula(circuit, part)).collect::<Vec<_>>(), operator)
    };
    match expr {
        Expr::Signal(signal) => name(signal),
        Expr::Const { width, value } => literal(*value, *width),
        Expr::Bit(signal, _) if circuit.port(*signal).width == 1 => name(signal),
        Expr::Bit(signal, bit) => format!("{}({bit})", name(signal)),
        Expr::Not(inner) => format!("not {}", formula(circuit, inner)),
        Expr::And(parts) => list(parts, " and "),
        Expr::Or(parts) => list(parts, " or "),
        Expr::Any(inner) if circuit.width(inner) == Some(1) => formula(circuit, inner),
        Expr::Any(inner) => format!("or_reduce({})", whole(&formula(circuit, inner))),
        Expr::Select(condition, yes, no) => {
            let parts = [condition, yes, no].map(|part| formula(circuit, part));
            format!("mux({})", parts.join(", "))
        }
        Expr::FromLeft(signal) => {
            let top = circuit.port(*signal).width - 1;
            format!("({0}({1} downto 0) & {0}({top}))", name(signal), top - 1)
        }
        // Negated, all lanes above the lowest 1 are inverted.
        Expr::Lowest(signal) => format!("({0} and std_logic_vector(unsigned(not {0}) + 1))", name(signal)),
        Expr::Lookup { .. } => unreachable!("a table is a wire of its own"),
        Expr::Join(parts) => {
            let parts: Vec<String> = parts.iter().rev().map(name).collect();
            format!("({})", parts.join(" & "))
        }
    }
}
