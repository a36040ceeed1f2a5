//! Robot navigation by cellular automata with active cells.
//!
//! A robot carries a map of cells, square or hexagonal. One cell is *active*: the robot is there. The same local
//! rule in every cell decides which neighbour becomes active next. The route becomes a program of straight runs,
//! counted in wheel revolutions, and turns.
//!
//! Every stage is an immutable value made from the one before it:
//!
//! ```text
//! Map ──wave──▶ Field ──route──▶ Route ──program──▶ Program ──replay──▶ points in metres
//! ```
//!
//! ```
//! use activecell::{Lattice, Map, Robot, Rule, check_program, check_route};
//!
//! let map = Map::parse(Lattice::Square, "S.#.\n..#.\n...F")?;
//! let (from, to) = (map.mark('S').unwrap(), map.mark('F').unwrap());
//!
//! let route = map.route(Rule::Wave, from, to, 1_000_000)?;
//! assert_eq!((route.steps(), route.turns().len()), (5, 1));
//! assert!(check_route(&map, route.cells(), from, to).is_ok());
//!
//! let robot = Robot { wheel_perimeter_m: 0.5, ..Robot::default() };
//! let program = route.program(&robot, &map, None);
//! assert_eq!(program.revolutions(), 10.0);
//! assert!(check_program(&map, &robot, &program, route.cells()).is_ok());
//! # Ok::<(), activecell::Error>(())
//! ```
//!
//! The core does no I/O, has no dependencies, and gives the same result on every run.

mod calibrate;
pub mod control;
mod embedded;
mod error;
mod error_budget;
mod fleet;
mod lattice;
mod map;
pub mod predict;
mod program;
mod rng;
mod route;
pub mod rule;
mod search;
pub mod sense;
pub mod sim;
mod wave;

pub use calibrate::{
    Calibration, DriveLog, EndError, LogRow, Odometry, SquareErrors, TruthNoise, calibrate,
    deviations_squared, umbmark,
};
pub use embedded::{DirectionPlanes, EmbeddedHeader, EmbeddedMap, MoveTable};
pub use error::Error;
pub use error_budget::{Certificate, Fix, Fixes, Method, REGION_95, Region, Trust, TrustedRoute};
pub use fleet::{
    Bodies, Detection, Event, Journal, JournalFault, KeepOut, KeepOuts, MemberRecord, Moves, News, Plan,
    PlanFault, Schedule, Task, Team, check_bodies, check_journal, check_keep_outs, check_moves, check_plan,
    check_schedule, detections, schedule, strangers,
};
pub use lattice::{Cell, Dir, Lattice};
pub use map::{
    BitPlane, Clearance, Elevation, Frame, Ground, MAX_CELLS, Map, PointM, Posts, Profile, Tiling,
};
pub use program::{
    Drive, Effort, Errors, Motion, Pose, Power, Program, ProgramFault, Robot, Sensors, Slopes, Ticks,
    Waypoint, Wheels, check_program, check_slopes, replay,
};
pub use rng::Rng;
pub use route::{Outcome, Route, RouteFault, check_route, check_terrain_route};
pub use rule::Rule;
pub use search::Search;
pub use wave::{CompactField, Field, Floods, LiveField, Terrain, TileField, TileOrder, WeightedField};
