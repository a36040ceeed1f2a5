//! The control unit as a circuit: from state and inputs to the next state.

use super::sum;
use crate::logic::{Circuit, Expr, Signal, sum_of_products};
use activecell::control::{Inputs, State, TABLE};

/// The inputs g0 to g7: name, bit, meaning.
pub(crate) const INPUTS: [(&str, Inputs, &str); 8] = [
    ("GO", Inputs::GO, "a task is set"),
    ("SIDE_LEFT", Inputs::SIDE_LEFT, "of the two sides the left one is wanted"),
    ("RIGHT", Inputs::RIGHT, "obstacle on the right"),
    ("LEFT", Inputs::LEFT, "obstacle on the left"),
    ("FRONT", Inputs::FRONT, "obstacle in front; the route forces a turn by it"),
    ("BEHIND", Inputs::BEHIND, "obstacle behind"),
    ("STOP", Inputs::STOP, "stop; wins over all others"),
    ("REVERSE", Inputs::REVERSE, "drive backwards"),
];

/// The outputs q0 to q3.
const OUTPUTS: [&str; 4] = [
    "at rest",
    "forwards, each wheel that does not roll back",
    "the left wheel back, or steering to the left",
    "the right wheel back, or steering to the right",
];

/// The control unit's logic, from [`TABLE`]: the next state and the outputs q0 to q3 of the present one.
///
/// States that follow alike on every input share their formulas. The numbers 6 and 7, which are no states, act as calm,
/// so that a register that was upset recovers at the next step.
pub fn control() -> Circuit {
    let meanings = INPUTS.iter().enumerate().map(|(i, (_, _, about))| format!("\n  g{i}: {about}"));
    let meanings = meanings.collect::<Vec<_>>().concat();
    let about =
        format!("The control unit: next state and outputs of the present state. Its inputs:{meanings}");
    let mut circuit = Circuit::new("control_next", &about);
    let state = circuit.input("state", 3, &state_names());
    let inputs = circuit.input("g", 8, "the inputs g7 to g0");
    let state_bits: Vec<Expr> = (0..3).map(|bit| Expr::Bit(state, bit)).collect();
    let is_one_of = |states: &[State]| {
        let cubes = sum_of_products(3, |code| states.contains(&decoded(code)), |_| false);
        sum(&cubes, &state_bits)
    };

    let calm = TABLE[State::Calm as usize];
    let mut classes: Vec<(Vec<State>, [State; 256])> = Vec::new();
    for state in State::ALL.into_iter().filter(|&state| TABLE[state as usize] != calm) {
        let row = TABLE[state as usize];
        match classes.iter_mut().find(|class| class.1 == row) {
            Some(class) => class.0.push(state),
            None => classes.push((vec![state], row)),
        }
    }
    let mut variables: Vec<Expr> = (0..8).map(|bit| Expr::Bit(inputs, bit)).collect();
    for (states, _) in &classes {
        let names: Vec<&str> = states.iter().map(|state| state.name()).collect();
        let name = if states.iter().all(|state| state.moves()) { "moving" } else { names[0] };
        let class =
            circuit.wire(&format!("is_{name}"), is_one_of(states), &format!("in state {}", names.join(", ")));
        variables.push(Expr::Signal(class));
    }
    let next = |assignment: u32| {
        let row = match assignment >> 8 {
            0 => &calm,
            class => &classes[class.trailing_zeros() as usize].1,
        };
        row[(assignment & 255) as usize]
    };
    let steps: Vec<(State, Signal)> = State::ALL
        .into_iter()
        .filter(|&state| state as u8 != 0)
        .map(|state| {
            let cubes =
                sum_of_products(variables.len() as u32, |a| next(a) == state, |a| (a >> 8).count_ones() > 1);
            let name = format!("to_{}", state.name());
            (
                state,
                circuit.wire(&name, sum(&cubes, &variables), &format!("the next state is {}", state.name())),
            )
        })
        .collect();
    let bits: Vec<Signal> = (0..3)
        .map(|bit| {
            let steps =
                steps.iter().filter(|step| step.0 as u8 >> bit & 1 == 1).map(|step| Expr::Signal(step.1));
            circuit.wire(&format!("next{bit}"), Expr::Or(steps.collect()), "a bit of its number")
        })
        .collect();
    circuit.output("next_state", Expr::Join(bits), "the state at the next step");
    for (output, about) in OUTPUTS.iter().enumerate() {
        let states: Vec<State> = State::ALL.into_iter().filter(|state| state.outputs()[output]).collect();
        circuit.output(&format!("q{output}"), is_one_of(&states), about);
    }
    circuit
}

/// The state of that number; calm for the two numbers that are no states.
fn decoded(number: u32) -> State {
    State::ALL.get(number as usize).copied().unwrap_or(State::Calm)
}

fn state_names() -> String {
    let names = State::ALL.iter().map(|&state| format!("{} {}", state as u8, state.name()));
    names.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_state_and_input_is_followed_as_in_the_table() {
        assert!((0..8).all(|i| INPUTS[i].1.0 == 1 << i), "g0 to g7 in order");
        let circuit = control();
        circuit.check().unwrap();
        for number in 0..8 {
            for inputs in 0..256 {
                let state = decoded(number);
                let next = TABLE[state as usize][inputs as usize];
                let outputs = state.outputs().map(u32::from);
                let expected = [&[next as u32][..], &outputs].concat();
                assert_eq!(circuit.evaluate(&[number, inputs]), expected, "{state:?} {inputs:08b}");
            }
        }
    }
}
