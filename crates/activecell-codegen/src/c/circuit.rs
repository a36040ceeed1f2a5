//! Circuits as functions.

use crate::logic::{Circuit, Expr, Port, Signal, Wire, mask};
use std::collections::{BTreeMap, BTreeSet};

/// A circuit as a function without state: `static`, its name and its types prefixed `ac_`. Lanes are bits of `uint32_t`.
///
/// It calls `ac_bit`, which makes 1 or 0 of a condition: `ac_bit.h` of [`super::firmware()`].
///
/// With one output the function returns it, with several a structure of them.
///
/// ```
/// use activecell::Lattice;
/// use activecell_codegen::{c, circuits};
/// let text = c::function(&circuits::decision(Lattice::Square));
/// assert!(text.contains("static ac_decide_square_outputs ac_decide_square("));
/// ```
pub fn function(circuit: &Circuit) -> String {
    let name = format!("ac_{}", circuit.name);
    let outputs: Vec<&Wire> = circuit.outputs().collect();
    let mut text = String::new();
    let result = if outputs.len() == 1 {
        "uint32_t".into()
    } else {
        text += &structure(&name, &outputs);
        format!("{name}_outputs")
    };
    let about: String = circuit.inputs.iter().map(|port| item(&port.name, &port.about)).collect();
    text += &comment(&format!("{}\n{}", circuit.about, about.trim_end()));
    let inputs: Vec<String> = circuit.inputs.iter().map(|port| format!("uint32_t {}", port.name)).collect();
    text += &format!("static {result} {name}({})\n{{\n", wrapped(&inputs));
    text += &unused(circuit);
    text += &tables(circuit);
    for wire in &circuit.wires {
        text += &statement(circuit, wire);
    }
    if let [output] = outputs[..] {
        return text + &format!("\n    return {};\n}}\n", output.port.name);
    }
    text += &format!("    const {result} outputs = {{ ");
    text += &outputs.iter().map(|wire| wire.port.name.as_str()).collect::<Vec<_>>().join(", ");
    text + " };\n\n    return outputs;\n}\n"
}

/// Inputs that the circuit does without; a compiler would warn of them.
fn unused(circuit: &Circuit) -> String {
    let mut signals = BTreeSet::new();
    for wire in &circuit.wires {
        collect(&wire.expr, &mut signals);
    }
    let inputs = circuit.inputs.iter().enumerate();
    let mut text = String::new();
    for (_, port) in inputs.filter(|(place, _)| !signals.contains(&Signal(*place))) {
        text += &format!("    (void){}; /* makes no difference */\n", port.name);
    }
    text
}

/// The signals that a formula reads.
fn collect(expr: &Expr, signals: &mut BTreeSet<Signal>) {
    match expr {
        Expr::Const { .. } => {}
        Expr::Signal(signal) | Expr::Bit(signal, _) | Expr::FromLeft(signal) | Expr::Lowest(signal) => {
            signals.insert(*signal);
        }
        Expr::Lookup { index, .. } => {
            signals.insert(*index);
        }
        Expr::Not(inner) | Expr::Any(inner) => collect(inner, signals),
        Expr::And(parts) | Expr::Or(parts) => parts.iter().for_each(|part| collect(part, signals)),
        Expr::Select(asked, yes, no) => [asked, yes, no].iter().for_each(|part| collect(part, signals)),
        Expr::Join(parts) => signals.extend(parts),
    }
}

fn structure(name: &str, outputs: &[&Wire]) -> String {
    let mut text = comment(&format!("What {name} says."));
    text += "typedef struct {\n";
    for wire in outputs {
        text += &format!("    uint32_t {}; /* {} */\n", wire.port.name, wire.port.about);
    }
    text + &format!("}} {name}_outputs;\n\n")
}

fn item(name: &str, about: &str) -> String {
    format!("- {name}: {about}\n")
}

/// A block comment; long lines are broken.
pub(super) fn comment(text: &str) -> String {
    let mut comment = String::from("/*\n");
    for line in text.lines() {
        let mut length = 0;
        for word in line.split(' ') {
            if length + word.len() > 100 {
                length = 0;
            }
            let before = if length == 0 { " * " } else { " " };
            let begins = if length == 0 && comment.len() > 3 { "\n" } else { "" };
            comment += &format!("{begins}{before}{word}");
            length += before.len() + word.len();
        }
    }
    comment + "\n */\n"
}

/// Parameters, on lines of their own if they are many.
fn wrapped(parameters: &[String]) -> String {
    let line = parameters.join(", ");
    if line.len() < 70 { line } else { format!("\n    {}", parameters.join(",\n    ")) }
}

/// The tables of the circuit, those that are looked up by the same signal side by side.
fn tables(circuit: &Circuit) -> String {
    let mut text = String::new();
    for (index, wires) in lookups(circuit) {
        let Port { name: index, width, .. } = circuit.port(index);
        let columns: Vec<(&str, &[u32], u32)> = wires.iter().filter_map(|wire| column(wire)).collect();
        let rows = columns.iter().map(|column| column.1.len()).max().unwrap_or(0);
        let bits = columns.iter().map(|column| column.2).max().unwrap_or(0);
        let bits = [8, 16, 32].into_iter().find(|enough| bits <= *enough).unwrap_or(32);
        let names: Vec<&str> = columns.iter().map(|column| column.0).collect();
        text += &format!("    /* For each {index}: {}. */\n", names.join(", "));
        text += &format!("    static const uint{bits}_t by_{index}[{rows}][{}] = {{\n", columns.len());
        for row in 0..rows {
            let entries = columns.iter().filter_map(|column| column.1.get(row).or(column.1.last()));
            let entries: Vec<String> = entries.map(|entry| number(*entry)).collect();
            text += &format!("        {{ {} }},\n", entries.join(", "));
        }
        text += "    };\n";
        // Behind the end of a table its last entry.
        let row = if rows == 1 << width {
            index.clone()
        } else {
            format!("({index} < {rows}U) ? {index} : {}U", rows - 1)
        };
        text += &format!("    const uint{bits}_t *const row = by_{index}[{row}];\n");
    }
    text
}

/// Wires that are looked up, by the signal that says the place.
fn lookups(circuit: &Circuit) -> BTreeMap<Signal, Vec<&Wire>> {
    let mut lookups: BTreeMap<Signal, Vec<&Wire>> = BTreeMap::new();
    for wire in &circuit.wires {
        if let Expr::Lookup { index, .. } = &wire.expr {
            lookups.entry(*index).or_default().push(wire);
        }
    }
    lookups
}

/// The name, the entries and their width of a wire that is looked up.
fn column(wire: &Wire) -> Option<(&str, &[u32], u32)> {
    match &wire.expr {
        Expr::Lookup { table, width, .. } => Some((&wire.port.name, table, *width)),
        _ => None,
    }
}

fn statement(circuit: &Circuit, wire: &Wire) -> String {
    let Port { name, about, .. } = &wire.port;
    let value = match &wire.expr {
        Expr::Lookup { index, .. } => {
            let columns = &lookups(circuit)[index];
            let column = columns.iter().position(|column| column.port.name == *name).unwrap_or(0);
            format!("row[{column}]")
        }
        expr => whole(&formula(circuit, expr)).to_owned(),
    };
    let assignment = format!("    const uint32_t {name} = {value};");
    if assignment.len() + about.len() < 100 {
        format!("{assignment} /* {about} */\n")
    } else {
        format!("    /* {name}: {about} */\n{}\n", broken(&assignment))
    }
}

/// Long formulas go on in the next lines, behind the outermost operators.
fn broken(statement: &str) -> String {
    if statement.len() < 100 {
        return statement.into();
    }
    let mut depth = 0;
    let operators: Vec<(i32, usize)> = statement
        .char_indices()
        .filter_map(|(place, c)| {
            depth += i32::from(c == '(') - i32::from(c == ')');
            (["| ", "& "].iter().any(|operator| statement[place..].starts_with(operator)))
                .then_some((depth, place + 1))
        })
        .collect();
    let outermost = operators.iter().map(|operator| operator.0).min();
    let mut lines = String::new();
    let mut from = 0;
    for (_, place) in operators.iter().filter(|operator| Some(operator.0) == outermost) {
        lines += &format!("{}\n        ", &statement[from..*place]);
        from = place + 1;
    }
    lines + &statement[from..]
}

/// Without the outermost brackets.
pub(crate) fn whole(text: &str) -> &str {
    let balanced = |text: &str| {
        let mut depth = 0;
        text.chars().all(|c| {
            depth += i32::from(c == '(') - i32::from(c == ')');
            depth >= 0
        })
    };
    let inner = text.strip_prefix('(').and_then(|text| text.strip_suffix(')'));
    inner.filter(|inner| balanced(inner)).unwrap_or(text)
}

fn formula(circuit: &Circuit, expr: &Expr) -> String {
    let name = |signal: &Signal| &circuit.port(*signal).name;
    let list = |parts: &[Expr], operator: &str| {
        joined(&parts.iter().map(|part| formula(circuit, part)).collect::<Vec<_>>(), operator)
    };
    match expr {
        _ if is_question(expr) => format!("ac_bit{}", bracketed(&condition(circuit, expr))),
        Expr::Signal(signal) => name(signal).clone(),
        Expr::Const { value, .. } => number(*value),
        Expr::Not(inner) => {
            format!("({} ^ {})", formula(circuit, inner), number(mask(circuit.width(inner).unwrap_or(0))))
        }
        Expr::And(parts) => list(parts, " & "),
        Expr::Or(parts) => list(parts, " | "),
        Expr::Select(asked, yes, no) => {
            let [yes, no] = [yes, no].map(|part| formula(circuit, part));
            format!("({} ? {yes} : {no})", condition(circuit, asked))
        }
        Expr::FromLeft(signal) => {
            let (name, width) = (name(signal), circuit.port(*signal).width);
            format!("((({name} << 1U) | ({name} >> {}U)) & {})", width - 1, number(mask(width)))
        }
        Expr::Lowest(signal) => format!("({0} & (0U - {0}))", name(signal)),
        Expr::Join(parts) => join(circuit, parts),
        Expr::Bit(..) | Expr::Any(_) => unreachable!("a question"),
        Expr::Lookup { .. } => unreachable!("a table is a wire of its own"),
    }
}

/// Whether it is better asked with `&&` and `||` than computed with `&` and `|`: it looks into a signal of many bits.
fn is_question(expr: &Expr) -> bool {
    match expr {
        Expr::Bit(..) | Expr::Any(_) => true,
        Expr::Not(inner) => is_question(inner),
        Expr::And(parts) | Expr::Or(parts) => parts.iter().any(is_question),
        _ => false,
    }
}

/// One bit as a condition.
fn condition(circuit: &Circuit, expr: &Expr) -> String {
    match expr {
        Expr::Any(inner) => format!("({} != 0U)", formula(circuit, inner)),
        Expr::Not(inner) => match &**inner {
            Expr::Any(inner) => format!("({} == 0U)", formula(circuit, inner)),
            Expr::Bit(signal, bit) => {
                format!("(({} & {}) == 0U)", circuit.port(*signal).name, number(1 << bit))
            }
            inner => format!("({} == 0U)", formula(circuit, inner)),
        },
        Expr::Or(parts) => {
            joined(&parts.iter().map(|part| condition(circuit, part)).collect::<Vec<_>>(), " || ")
        }
        Expr::And(parts) => joined(&factors(circuit, parts), " && "),
        Expr::Bit(signal, bit) => {
            format!("(({} & {}) != 0U)", circuit.port(*signal).name, number(1 << bit))
        }
        expr => format!("({} != 0U)", formula(circuit, expr)),
    }
}

/// What must hold together. Bits of one signal are compared at once.
fn factors(circuit: &Circuit, parts: &[Expr]) -> Vec<String> {
    let mut bits: BTreeMap<Signal, (u32, u32)> = BTreeMap::new();
    let mut factors = Vec::new();
    for part in parts {
        let (bit, value) = match part {
            Expr::Not(inner) => (&**inner, 0),
            part => (part, 1),
        };
        if let Expr::Bit(signal, bit) = bit {
            let (ones, values) = bits.entry(*signal).or_default();
            *ones |= 1 << bit;
            *values |= value << bit;
        } else {
            factors.push(condition(circuit, part));
        }
    }
    let compared = bits.into_iter().map(|(signal, (ones, values))| {
        format!("(({} & {}) == {})", circuit.port(signal).name, number(ones), number(values))
    });
    factors.extend(compared);
    factors
}

fn bracketed(text: &str) -> String {
    if text.starts_with('(') && whole(text) != text { text.into() } else { format!("({text})") }
}

fn joined(parts: &[String], operator: &str) -> String {
    if let [part] = parts { part.clone() } else { format!("({})", parts.join(operator)) }
}

/// Lanes are easier to see in hexadecimal digits.
pub(super) fn number(value: u32) -> String {
    if value < 10 { format!("{value}U") } else { format!("0x{value:02X}U") }
}

fn join(circuit: &Circuit, parts: &[Signal]) -> String {
    let mut lane = 0;
    let mut terms = Vec::new();
    for part in parts {
        let port = circuit.port(*part);
        terms.push(if lane == 0 { port.name.clone() } else { format!("({} << {lane}U)", port.name) });
        lane += port.width;
    }
    joined(&terms, " | ")
}
