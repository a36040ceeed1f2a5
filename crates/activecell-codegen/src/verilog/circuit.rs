//! Circuits as modules.

use crate::logic::{Circuit, Expr, Port, Signal, Wire};

/// A circuit as a module without state.
pub fn module(circuit: &Circuit) -> String {
    let ports: Vec<(&str, &Port)> = circuit
        .inputs
        .iter()
        .map(|port| ("input ", port))
        .chain(circuit.outputs().map(|wire| ("output", &wire.port)))
        .collect();
    let last = ports.len() - 1;
    let mut text = format!("// {}\nmodule {} (\n", circuit.about, circuit.name);
    for (i, (direction, port)) in ports.into_iter().enumerate() {
        let comma = if i == last { " " } else { "," };
        text +=
            &format!("    {direction} wire {}{}{comma} // {}\n", range(port.width), port.name, port.about);
    }
    text += ");\n";
    for wire in &circuit.wires {
        text += &statement(circuit, wire);
    }
    text + "endmodule\n"
}

fn range(width: u32) -> String {
    if width == 1 { "      ".into() } else { format!("[{}:0] ", width - 1) }
}

fn statement(circuit: &Circuit, wire: &Wire) -> String {
    let Port { name, width, about } = &wire.port;
    let declaration =
        if wire.is_output { String::new() } else { format!("    wire {}{name};\n", range(*width)) };
    let comment = if wire.is_output { String::new() } else { format!("\n    // {name}: {about}\n") };
    let assignment = match &wire.expr {
        Expr::Lookup { table, width, index } => lookup(circuit, wire, table, *width, *index),
        expr => format!("    assign {name} = {};\n", whole(&formula(circuit, expr))),
    };
    comment + &declaration + &assignment
}

/// A table as a function: synthesis tools make gates of it.
fn lookup(circuit: &Circuit, wire: &Wire, table: &[u32], width: u32, index: Signal) -> String {
    let (name, index) = (&wire.port.name, circuit.port(index));
    let digits = width as usize;
    let mut text = format!(
        "    function [{}:0] {name}_of(input [{}:0] {}_in);\n        case ({}_in)\n",
        width - 1,
        index.width - 1,
        index.name,
        index.name
    );
    let (last, entries) = table.split_last().expect("a table has entries");
    for (place, entry) in entries.iter().enumerate() {
        text += &format!("            {}'d{place}: {name}_of = {width}'b{entry:0digits$b};\n", index.width);
    }
    text += &format!("            default: {name}_of = {width}'b{last:0digits$b};\n");
    text + &format!("        endcase\n    endfunction\n    assign {name} = {name}_of({});\n", index.name)
}

/// Without the outermost brackets.
fn whole(text: &str) -> &str {
    text.strip_prefix('(')
        .and_then(|text| text.strip_suffix(')'))
        .filter(|text| balanced(text))
        .unwrap_or(text)
}

fn balanced(text: &str) -> bool {
    let mut depth = 0;
    text.chars().all(|c| {
        depth += i32::from(c == '(') - i32::from(c == ')');
        depth >= 0
    })
}

fn formula(circuit: &Circuit, expr: &Expr) -> String {
    let name = |signal: &Signal| &circuit.port(*signal).name;
    let list = |parts: &[Expr], operator: &str| {
        let parts: Vec<String> = parts.iter().map(|part| formula(circuit, part)).collect();
        if parts.len() == 1 { parts[0].clone() } else { format!("({})", parts.join(operator)) }
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
