//! What the README says of the robot: what its program counts in, and what drives it.

use super::Order;
use crate::model::player::Scale;
use crate::motors::motors;
use activecell::control::State;
use activecell::{Drive, Robot};

/// The robot that the program is for, and how far it rolls.
pub(super) fn robot(order: &Order<'_>) -> String {
    let &Order { robot, map, .. } = order;
    let scale = Scale::of(robot, map);
    let whose =
        if *robot == Robot::default() { "the default robot; `--robot FILE` takes yours" } else { "yours" };
    let drive = match robot.drive {
        Drive::Differential => "differential: two wheels, which turn the robot by rolling against each other",
        Drive::Steered => {
            "steered: wheels roll in runs only, a motor of its own turns them; front, left and right are theirs, and sensors turn with them"
        }
    };
    let of_turns = match robot.drive {
        Drive::Differential => "ticks",
        Drive::Steered => "pulse of the steering",
    };
    let rows = [
        ("robot", whose.to_owned()),
        ("drive", drive.to_owned()),
        ("wheel perimeter", format!("{} m", robot.wheel_perimeter_m)),
        (
            "ticks in a revolution",
            format!(
                "{}, as they are counted: in hardware the rising edges of channel A",
                robot.ticks_per_rev
            ),
        ),
        ("between the wheels", format!("{} m", robot.track_m)),
        ("a run to the next cell", format!("{:.4} m, {:.1} ticks", scale.step_m, scale.step_ticks)),
        ("a turn to the next direction", format!("{}°, {:.1} {of_turns}", scale.turn_deg, scale.turn_ticks)),
    ];
    rows.map(|(what, value)| format!("| {what} | {value} |\n")).concat()
}

/// What the drive is told in each state of the control unit, and what the motors do.
pub(super) fn outputs() -> String {
    let row = |state: State| {
        let [q0, q1, q2, q3] = state.outputs().map(u8::from);
        let [left, right, steered, when] = motors(state);
        format!("| {} | {q0} {q1} {q2} {q3} | {left} | {right} | {steered} | {when} |\n", state.name())
    };
    State::ALL.map(row).concat()
}
