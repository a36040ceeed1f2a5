//! What the robot does, one thing after the other, and where it should then be.

use crate::map::Map;
use crate::program::{Motion, Pose, Program, Robot};
use crate::rng::Rng;

/// One thing that the robot does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Leg {
    /// Drives so many metres, backwards if negative.
    Run(f64),
    /// Comes to rest.
    Stop,
    /// Turns in radians, counter-clockwise positive.
    Turn(f64),
}

impl Leg {
    /// The pose after it, without any error.
    pub(super) fn from(self, pose: Pose) -> Pose {
        match self {
            Self::Run(length_m) => Pose { at_m: pose.point(length_m, 0.0), ..pose },
            Self::Stop => pose,
            Self::Turn(turn_rad) => Pose { bearing_rad: pose.bearing_rad + turn_rad, ..pose },
        }
    }

    /// Moves a robot with errors.
    pub(super) fn drive(self, motion: &mut Motion<'_>, rng: &mut Rng) {
        match self {
            Self::Run(length_m) => motion.roll(length_m, rng),
            Self::Stop => motion.stop(rng),
            Self::Turn(turn_rad) => motion.turn(turn_rad, rng),
        }
    }
}

/// The pose at which a program starts.
pub(super) fn start(map: &Map, program: &Program) -> Pose {
    Pose {
        at_m: map.centre_m(program.start),
        bearing_rad: program.heading.map_or(0.0, |heading| map.bearing_rad(heading)),
    }
}

/// For each waypoint what leads to it and what is done there before the next run. A robot that does not run does
/// not stop, one that does not turn has no error of turning.
pub(super) fn legs<'a>(
    map: &Map,
    robot: &Robot,
    program: &'a Program,
) -> impl Iterator<Item = (Vec<Leg>, Option<Leg>)> + 'a {
    program.waypoints.iter().zip(program.runs_m(map, robot)).map(|(waypoint, length_m)| {
        let run = if length_m == 0.0 { Vec::new() } else { vec![Leg::Run(length_m), Leg::Stop] };
        // Programs count turns clockwise, poses counter-clockwise.
        let turn_rad = -f64::from(waypoint.turn_deg).to_radians();
        (run, (waypoint.turn_deg != 0).then_some(Leg::Turn(turn_rad)))
    })
}
