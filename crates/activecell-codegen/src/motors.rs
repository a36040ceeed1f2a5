//! What the control unit's outputs say to the motors, for comments and READMEs.

use activecell::control::State;

/// What a wheel of a differential drive does: q2 rolls the left one back, q3 the right one, q1 those forwards that do not
/// roll back.
const fn wheel(drive: bool, back: bool) -> &'static str {
    match (drive, back) {
        (_, true) => "back",
        (true, false) => "forwards",
        (false, false) => "at rest",
    }
}

/// What a robot with steered wheels does, whose wheels do not roll where they turn.
const fn steered(state: State) -> &'static str {
    match state {
        State::Calm | State::Stopped => "at rest",
        State::Forward => "forwards",
        State::Left => "steering to the left",
        State::Right => "steering to the right",
        State::Reverse => "back",
    }
}

const fn when(state: State) -> &'static str {
    match state {
        State::Calm => "waits, or has ended",
        State::Stopped => "one clock at the end, then calm",
        _ => "",
    }
}

/// What the motors do in a state: the left wheel and the right one, or steered wheels; and when it comes.
pub(crate) const fn motors(state: State) -> [&'static str; 4] {
    let [_, drive, left, right] = state.outputs();
    [wheel(drive, left), wheel(drive, right), steered(state), when(state)]
}

/// The states with their outputs, a line each, as a comment; `comment` begins it.
pub(crate) fn table(comment: &str) -> String {
    let line = |q: &str, name: &str, [left, right, steered, when]: [&str; 4]| {
        let text = format!("{comment}     {q}   {name:8}  {left:10}  {right:11}  {steered:21}  {when}");
        text.trim_end().to_owned()
    };
    let rows = State::ALL.map(|state| {
        let q = state.outputs().map(|output| if output { " 1" } else { " 0" }).join(" ");
        line(&q, state.name(), motors(state))
    });
    let head = line("q0 q1 q2 q3", "state", ["left wheel", "right wheel", "or steered wheels", ""]);
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The rule by which wheels follow the outputs does in each state what the state is for.
    #[test]
    fn wheels_do_what_the_state_says() {
        let wheels = |state: State| [motors(state)[0], motors(state)[1]];
        let expected = [
            (State::Calm, ["at rest"; 2]),
            (State::Forward, ["forwards"; 2]),
            (State::Left, ["back", "forwards"]),
            (State::Right, ["forwards", "back"]),
            (State::Stopped, ["at rest"; 2]),
            (State::Reverse, ["back"; 2]),
        ];
        assert_eq!(expected.map(|(state, _)| (state, wheels(state))), expected);
        assert_eq!(expected.map(|(state, _)| state), State::ALL);
    }
}
