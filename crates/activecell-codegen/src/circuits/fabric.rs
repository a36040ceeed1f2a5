//! The cell of the fabric as a circuit: the wave, the pointer, the active bit.

use super::any;
use crate::logic::{Circuit, Expr};
use activecell::Lattice;

/// What a cell of the fabric does at a clock, from what it sees of its neighbours.
///
/// The wave comes to a free cell from any neighbour, and begins at the target. The pointer shows where it came from: of
/// several neighbours at once the first, clockwise from the top, which is the wave rule of the core
/// ([`Map::direction_planes`](activecell::Map::direction_planes)). The active bit comes from the neighbour that held it
/// and points here; the start makes it when the wave has come.
pub fn fabric_cell(lattice: Lattice) -> Circuit {
    let lanes = u32::from(lattice.degree());
    let mut circuit = Circuit::new(
        &format!("fabric_step_{lattice}"),
        "What a cell of the fabric does at the next clock. Lanes are its neighbours, clockwise from the top.",
    );
    let is_free = circuit.input("is_free", 1, "the cell is no obstacle");
    let is_target = circuit.input("is_target", 1, "the robot wants to come here");
    let is_start = circuit.input("is_start", 1, "the robot stands here");
    let is_front = circuit.input("is_front", 1, "the wave has come here at this clock");
    let around = circuit.input("reached_around", lanes, "neighbours to which the wave has come");
    let entering = circuit.input("entering", lanes, "neighbours from which the robot moves here");
    let signal = Expr::Signal;
    let came = circuit.wire("is_beside", any(signal(around)), "the wave has come to a neighbour");
    circuit.output(
        "reached_next",
        Expr::And(vec![signal(is_free), Expr::Or(vec![signal(came), signal(is_target)])]),
        "whether the wave has come here",
    );
    circuit.output(
        "pointer_next",
        Expr::Lowest(around),
        "the neighbour from which it comes, if it has not come yet",
    );
    let moved = circuit.wire("is_entered", any(signal(entering)), "the robot moves here");
    circuit.output(
        "active_next",
        Expr::Or(vec![signal(moved), Expr::And(vec![signal(is_start), signal(is_front)])]),
        "whether the robot is here",
    );
    circuit
}
