//! What the control unit's outputs say to the motors, for the comments of the hardware.

use activecell::control::State;

/// What both kinds of robots do in a state: two driven wheels, or wheels that are steered.
const fn wheels(state: State) -> [&'static str; 2] {
    match state {
        State::Calm => ["at rest: waits, or has ended", "at rest"],
        State::Forward => ["both wheels roll forwards", "roll forwards"],
        State::Left => ["the left one back, the right one forwards", "the steering turns left"],
        State::Right => ["the left one forwards, the right one back", "the steering turns right"],
        State::Stopped => ["at rest: one clock at the end, then calm", "at rest"],
        State::Reverse => ["both wheels roll back", "roll back"],
    }
}

/// The states with their outputs, a line each, as a comment; `comment` begins it.
pub(crate) fn table(comment: &str) -> String {
    let line = |q: &str, name: &str, [two, steered]: [&str; 2]| {
        format!("{comment}     {q}   {name:8}  {two:42} {steered}").trim_end().to_owned()
    };
    let rows = State::ALL.map(|state| {
        let q = state.outputs().map(|output| if output { " 1" } else { " 0" }).join(" ");
        line(&q, state.name(), wheels(state))
    });
    let head = line("q0 q1 q2 q3", "state", ["two driven wheels", "steered wheels"]);
    [&[head][..], &rows].concat().join("\n")
}

/// The states by their outputs, a line each; `line` writes one from q3 to q0 and the name.
pub(crate) fn cases(line: impl Fn(&str, &str) -> String) -> String {
    let lines = State::ALL.map(|state| {
        let q: String = state.outputs().iter().rev().map(|&output| if output { '1' } else { '0' }).collect();
        line(&q, state.name())
    });
    lines.join("\n")
}
