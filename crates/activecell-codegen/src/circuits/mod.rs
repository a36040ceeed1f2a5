//! The circuits: the published rule, the sector of the target, the control unit, what the program player tells it.

mod control;
mod decision;
mod fabric;
mod player;
mod sector;

pub(crate) use control::INPUTS;
pub use control::control;
pub use decision::{decision, neighbourhood};
pub use fabric::fabric_cell;
pub use player::player;
pub use sector::{Bearing, sector};

use crate::logic::{Cube, Expr, Signal};

/// An or of ands over single bits: variable `i` of the cubes is `bits[i]`.
fn sum(cubes: &[Cube], bits: &[Expr]) -> Expr {
    let literal = |cube: &Cube, i: usize| {
        let bit = bits[i].clone();
        match (cube.ones >> i & 1, cube.zeros >> i & 1) {
            (1, _) => Some(bit),
            (_, 1) => Some(Expr::Not(Box::new(bit))),
            _ => None,
        }
    };
    let product = |cube: &Cube| {
        let mut literals: Vec<Expr> = (0..bits.len()).rev().filter_map(|i| literal(cube, i)).collect();
        match literals.len() {
            0 => Expr::Const { width: 1, value: 1 },
            1 => literals.remove(0),
            _ => Expr::And(literals),
        }
    };
    let mut products: Vec<Expr> = cubes.iter().map(product).collect();
    match products.len() {
        0 => Expr::Const { width: 1, value: 0 },
        1 => products.remove(0),
        _ => Expr::Or(products),
    }
}

fn not(expr: Expr) -> Expr {
    Expr::Not(Box::new(expr))
}

fn any(expr: Expr) -> Expr {
    Expr::Any(Box::new(expr))
}

fn select(condition: Signal, yes: Expr, no: Expr) -> Expr {
    Expr::Select(Box::new(Expr::Signal(condition)), Box::new(yes), Box::new(no))
}
