//! The scale of the robot and of the floor as constants, and what each state of the control unit asks of the motors.

use super::firmware::define;
use crate::model::player::Scale;
use crate::motors;
use activecell::control::State;
use activecell::{Cell, Drive, Error, Map, Robot};

/// Parts of a tick: fractions of ticks are carried on as such.
const PARTS: f64 = 256.0;

/// Half a turn on hexagons is three steps: so their sum, with what is owed, stays below 2^31 parts.
const TICKS_MAX: f64 = 2_097_151.0;

/// Cells and ticks of a robot on a map.
#[derive(Debug, Clone, Copy)]
pub(super) struct Units {
    scale: Scale,
    drive: Drive,
    /// The centre of cell (0, 0) on the floor, in micrometres.
    origin_um: [i64; 2],
}

impl Units {
    /// # Errors
    /// [`Error::BadValue`] for more ticks than the firmware counts with.
    pub(super) fn of(robot: &Robot, map: &Map) -> Result<Self, Error> {
        let scale = Scale::of(robot, map);
        let ticks = scale.step_ticks.max(scale.turn_ticks);
        if !(0.0..=TICKS_MAX).contains(&ticks) {
            return Err(Error::BadValue {
                name: "encoder ticks for a cell, or for a turn to the next direction",
                value: ticks,
                allowed: "at most 2097151 for firmware; use fewer ticks a revolution or smaller cells",
            });
        }
        let origin_um = map.centre_m(Cell::new(0, 0)).map(|metres| (metres * 1e6).round() as i64);
        Ok(Self { scale, drive: robot.drive, origin_um })
    }

    /// The constants of the header.
    pub(super) fn defines(&self) -> String {
        let Scale { step_m, step_ticks, turn_ticks, turn_deg } = self.scale;
        let parts = |ticks: f64| ((ticks * PARTS).round() as u64).max(1);
        let [x, y] = self.origin_um;
        let place =
            |axis: &str, um: i64, about: &str| format!("#define AC_FLOOR_{axis}_UM ({um}) /**< {about} */\n");
        let turn = format!("A turn by {turn_deg} degrees, rounded.");
        [
            format!("#define AC_DRIVE AC_DRIVE_{}\n", self.drive.name().to_uppercase()),
            define("AC_CELL_UM", (step_m * 1e6).round() as u64, "From cell to cell, in micrometres."),
            place("X", x, "The centre of cell (0, 0) on the floor, to the right, in micrometres,"),
            place("Y", y, "and upwards."),
            define("AC_TICKS_PER_CELL", step_ticks.round() as u64, "From cell to cell, rounded."),
            define("AC_TICKS_PER_TURN", turn_ticks.round() as u64, &turn),
            define("AC_CELL_TICKS_256", parts(step_ticks), "The same in 1/256 of a tick,"),
            define("AC_TURN_TICKS_256", parts(turn_ticks), "for ac_course_move."),
        ]
        .concat()
    }

    /// The same in words.
    pub(super) fn about(&self) -> String {
        let Scale { step_m, step_ticks, turn_ticks, turn_deg } = self.scale;
        let drive = self.drive.name();
        format!(
            " * For a robot with {drive} drive: {step_ticks:.3} ticks a cell of {step_m:.3} m, and {turn_ticks:.3} ticks\n \
             * for a turn by {turn_deg} degrees."
        )
    }
}

/// For each state its outputs as a word, and what they ask of the motors of either drive.
pub(super) fn state_table() -> String {
    let words = State::ALL.map(|state| {
        let bits = state.outputs().into_iter().enumerate().map(|(place, bit)| u32::from(bit) << place);
        format!("{} {}", state.name(), bits.sum::<u32>())
    });
    format!("{}\n *\n * As words, q0 in bit 0: {}.\n", motors::table(" *"), words.join(", "))
}
