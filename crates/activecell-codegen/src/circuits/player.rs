//! The program player's logic as a circuit: from the motion that the program wants to the control unit's inputs.

use super::{INPUTS, sum};
use crate::logic::{Circuit, Expr, sum_of_products};
use crate::model::player::{Motion, inputs};
use activecell::control::Inputs;

/// What the program player tells the control unit, from [`inputs`]: g0 to g7.
///
/// The numbers of the motions are those of [`Motion::ALL`]; the obstacles are g2 to g5, right, left, front, behind.
pub fn player() -> Circuit {
    let mut circuit = Circuit::new(
        "player_inputs",
        "What the program player tells the control unit: to do the motion of the segment, or to wait.",
    );
    let names = Motion::ALL.iter().enumerate().map(|(number, motion)| format!("{number} {}", motion.name()));
    let names = names.collect::<Vec<_>>().join(", ");
    let motion = circuit.input("motion", 2, &format!("what the segment wants: {names}"));
    let done = circuit.input("done", 1, "the program has ended");
    let go = circuit.input("go", 1, "the robot may drive");
    let obstacles =
        circuit.input("obstacles", 4, "on the right, on the left, in front, behind (bit 0 first)");
    let motion_bits = [0, 1].map(|bit| Expr::Bit(motion, bit));
    let flags = [0, 1, 2, 3].map(|bit| Expr::Bit(obstacles, bit));
    let bits = [&motion_bits[..], &[Expr::Signal(done), Expr::Signal(go)], &flags].concat();
    let free = Motion::ALL.iter().map(|&motion| {
        let cubes = sum_of_products(8, |bits| Told::of(bits).does(motion), |_| false);
        let about = format!("{} is wanted, and its way is free", motion.name());
        Expr::Signal(circuit.wire(motion.name(), sum(&cubes, &bits), &about))
    });
    let free: Vec<Expr> = free.collect();
    let variables = [&free[..], &[Expr::Signal(done)], &flags].concat();
    let wires = (0..8).map(|input| {
        let on = |values| described(values).is_some_and(|told| told.0 >> input & 1 == 1);
        let cubes = sum_of_products(9, on, |values| described(values).is_none());
        circuit.wire(&format!("g{input}"), sum(&cubes, &variables), INPUTS[input].2)
    });
    let wires = wires.collect();
    circuit.output("g", Expr::Join(wires), "the control unit's inputs g0 to g7");
    circuit
}

/// What the circuit is given.
struct Told {
    wanted: Option<Motion>,
    go: bool,
    obstacles: Inputs,
}

impl Told {
    /// From its inputs side by side, the first in the lowest bits.
    fn of(bits: u32) -> Self {
        let is_done = bits >> 2 & 1 == 1;
        let wanted = (!is_done).then(|| Motion::ALL[(bits & 3) as usize]);
        Self { wanted, go: bits >> 3 & 1 == 1, obstacles: Inputs((bits >> 4 << 2) as u8) }
    }

    fn inputs(&self) -> Inputs {
        inputs(self.wanted, self.go, self.obstacles)
    }

    /// Whether the control unit is asked for that motion.
    fn does(&self, motion: Motion) -> bool {
        let waits = inputs(self.wanted, false, self.obstacles);
        self.wanted == Some(motion) && self.inputs() != waits
    }
}

/// The control unit's inputs when the motions that may be done, the end and the obstacles are these, a bit each; `None`
/// if that never is.
fn described(values: u32) -> Option<Inputs> {
    let told =
        |bits: u32| (values >> 5 == bits >> 4 && values >> 4 & 1 == bits >> 2 & 1).then(|| Told::of(bits));
    let fits = |told: &Told| {
        let does =
            Motion::ALL.iter().enumerate().map(|(place, &motion)| u32::from(told.does(motion)) << place);
        does.sum::<u32>() == values & 15
    };
    (0..256).filter_map(told).find(fits).map(|told| told.inputs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_input_tells_what_the_model_tells() {
        let circuit = player();
        circuit.check().unwrap();
        for bits in 0..256 {
            let told = Told::of(bits).inputs().0.into();
            assert_eq!(circuit.evaluate(&[bits & 3, bits >> 2 & 1, bits >> 3 & 1, bits >> 4]), [told]);
        }
    }
}
