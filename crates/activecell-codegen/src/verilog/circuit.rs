//! Circuits as modules.

use crate::logic::{Circuit, Expr, Port, Signal, Wire};
use crate::text::{Cases, joined, lines, whole};

/// A circuit as a module without state.
pub fn module(circuit: &Circuit) -> String {
    let inputs = circuit.inputs.iter().map(|port| ("input ", port));
    let ports: Vec<(&str, &Port)> =
        inputs.chain(circuit.outputs().map(|wire| ("output", &wire.port))).collect();
    let names = ports.iter().map(|(_, port)| port.name.len()).max().unwrap_or(0) + 1;
    let mut text = format!(
        "// {}\n`default_nettype none\n\nmodule {} (\n",
        circuit.about.replace('\n', "\n// "),
        circuit.name
    );
    for (i, (direction, Port { name, width, about })) in ports.iter().enumerate() {
        let name = if i + 1 == ports.len() { name.clone() } else { format!("{name},") };
        text += &format!("    {direction} wire {} {name:names$} // {about}\n", range(*width));
    }
    text += ");\n";
    for wire in &circuit.wires {
        text += &statement(circuit, wire);
    }
    text + "endmodule\n\n`default_nettype wire\n"
}

fn range(width: u32) -> String {
    if width == 1 { "     ".into() } else { format!("[{}:0]", width - 1) }
}

fn statement(circuit: &Circuit, wire: &Wire) -> String {
    let Port { name, width, about } = &wire.port;
    let bits = if *width == 1 { String::new() } else { format!("{} ", range(*width)) };
    let declaration = format!("wire {bits}{name}");
    let value = |expr: &Expr| lines(whole(&formula(circuit, expr)), " | ");
    match &wire.expr {
        Expr::Lookup { table, width, index } => {
            let (function, call) = lookup(circuit, wire, table, *width, *index);
            format!("\n    // {about}\n{function}    {declaration} = {call};\n")
        }
        expr if wire.is_output => format!("\n    assign {name} = {};\n", value(expr)),
        expr => format!("\n    // {about}\n    {declaration} = {};\n", value(expr)),
    }
}

/// A table as a function, which becomes gates.
/// The function, and its call.
fn lookup(circuit: &Circuit, wire: &Wire, table: &[u32], width: u32, index: Signal) -> (String, String) {
    let (name, index, digits) = (&wire.port.name, circuit.port(index), width as usize);
    let Cases { entries, default } = Cases::of(table);
    let mut text = format!(
        "    function [{}:0] {name}_of(input [{}:0] place);\n        case (place)\n",
        width - 1,
        index.width - 1,
    );
    for (entry, places) in entries {
        let places: Vec<String> = places.iter().map(|place| format!("{}'d{place}", index.width)).collect();
        text += &format!("            {}: {name}_of = {width}'b{entry:0digits$b};\n", places.join(", "));
    }
    text += &format!("            default: {name}_of = {width}'b{default:0digits$b};\n");
    text += "        endcase\n    endfunction\n";
    (text, format!("{name}_of({})", index.name))
}

fn formula(circuit: &Circuit, expr: &Expr) -> String {
    let name = |signal: &Signal| &circuit.port(*signal).name;
    let list = |parts: &[Expr], operator: &str| {
        joined(&parts.iter().map(|part| formula(circuit, part)).collect::<Vec<_>>(), operator)
    };
    match expr {
        Expr::Signal(signal) => name(signal).clone(),
        Expr::Const { width, value } => format!("{width}'d{value}"),
        Expr::Bit(signal, bit) => format!("{}[{bit}]", name(signal)),
        Expr::Not(inner) => format!("~{}", formula(circuit, inner)),
        Expr::And(parts) => list(parts, " & "),
        Expr::Or(parts) => list(parts, " | "),
        Expr::Any(inner) => format!("(|{})", formula(circuit, inner)),
        Expr::Select(condition, yes, no) => {
            let [condition, yes, no] = [condition, yes, no].map(|part| formula(circuit, part));
            format!("({condition} ? {yes} : {no})")
        }
        Expr::FromLeft(signal) => {
            let top = circuit.port(*signal).width - 1;
            format!("{{{0}[{1}:0], {0}[{top}]}}", name(signal), top - 1)
        }
        Expr::Lowest(signal) => lowest(name(signal), circuit.port(*signal).width),
        Expr::Lookup { .. } => unreachable!("a table is a wire of its own"),
        Expr::Join(parts) => {
            let parts: Vec<&str> = parts.iter().rev().map(|part| name(part).as_str()).collect();
            format!("{{{}}}", parts.join(", "))
        }
    }
}

/// A lane is the lowest if none below it is 1.
fn lowest(name: &str, width: u32) -> String {
    let below = (1..width).rev().map(|top| match top {
        1 => format!("{name}[0]"),
        _ => format!("|{name}[{}:0]", top - 1),
    });
    let below: Vec<String> = below.chain(["1'b0".into()]).collect();
    format!("({name} & ~{{{}}})", below.join(", "))
}
