//! `activecell table control`: the control unit, printed from the table that the product runs.

use crate::args::TableFormat;
use crate::terminal::Terminal;
use activecell::control::{Inputs, PICKS, Pick, State, TABLE};
use activecell_formats::files;
use serde_json::json;
use std::path::Path;

pub(crate) fn run(format: TableFormat, picture: Option<&Path>) -> anyhow::Result<()> {
    if let Some(path) = picture {
        files::write_atomically(path, activecell_picture::control_svg().as_bytes())?;
    }
    Terminal::result(&match format {
        TableFormat::Markdown => markdown(),
        TableFormat::Csv => csv(),
        TableFormat::Json => {
            let states = State::ALL.map(|state| {
                let next = TABLE[state as usize].map(State::name);
                json!({"state": state.name(), "outputs": state.outputs().map(u8::from), "next": next.to_vec()})
            });
            serde_json::to_string(&json!({"inputs": "g0 is bit 0", "states": states}))? + "\n"
        }
    })
}

/// The letter of a state in the grids.
fn letter(state: State) -> char {
    match state {
        State::Calm => '.',
        State::Forward => 'F',
        State::Left => 'L',
        State::Right => 'R',
        State::Stopped => 'S',
        State::Reverse => 'B',
    }
}

fn markdown() -> String {
    let mut text = String::from(
        "| state | q0 calm | q1 drive | q2 left | q3 right | letter |\n|---|---|---|---|---|---|\n",
    );
    for state in State::ALL {
        let [q0, q1, q2, q3] = state.outputs().map(u8::from);
        text += &format!("| {} | {q0} | {q1} | {q2} | {q3} | {} |\n", state.name(), letter(state));
    }
    text +=
        "\nStop (g6) wins: a moving robot is stopped, a stopped one is calm one step later. Without a task\n";
    text += "(neither g0 nor g7) it is calm. Else the first row that matches (- is any):\n\n";
    text += "| g7 reverse | g5 behind | g4 front | g3 left | g2 right | g1 left side | next |\n|---|---|---|---|---|---|---|\n";
    for row in PICKS {
        let columns =
            [Inputs::REVERSE, Inputs::BEHIND, Inputs::FRONT, Inputs::LEFT, Inputs::RIGHT, Inputs::SIDE_LEFT];
        let cells = columns.map(|input| wanted(row, input).to_string()).join(" | ");
        text += &format!("| {cells} | {} |\n", row.next.name());
    }
    text += "\nEvery entry: rows g7 g6 g5 g4, columns g3 g2 g1 g0.\n";
    for (states, name) in [
        (State::Calm, "calm"),
        (State::Forward, "forward, left, right, reverse"),
        (State::Stopped, "stopped"),
    ] {
        text += &format!("\nFrom {name}:\n\n         0       4       8       12\n");
        for high in 0..16 {
            let entries = &TABLE[states as usize][16 * high..16 * high + 16];
            let letters: Vec<String> = entries.iter().map(|&next| letter(next).to_string()).collect();
            text += &format!("    {high:04b} {}\n", letters.join(" "));
        }
    }
    text
}

fn wanted(row: Pick, input: Inputs) -> char {
    match (row.ones.has(input), row.zeros.has(input)) {
        (true, _) => '1',
        (_, true) => '0',
        _ => '-',
    }
}

fn csv() -> String {
    let mut text = String::from("state,g7,g6,g5,g4,g3,g2,g1,g0,next,q0,q1,q2,q3\n");
    for state in State::ALL {
        for (inputs, next) in TABLE[state as usize].iter().enumerate() {
            let bits: Vec<String> = (0..8).rev().map(|bit| (inputs >> bit & 1).to_string()).collect();
            let outputs: Vec<String> = next.outputs().iter().map(|&q| u8::from(q).to_string()).collect();
            let (bits, outputs) = (bits.join(","), outputs.join(","));
            text += &format!("{},{bits},{},{outputs}\n", state.name(), next.name());
        }
    }
    text
}
