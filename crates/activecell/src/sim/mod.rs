//! Simulation: a robot with errors and sensors in a world that its map may not tell all about.
//!
//! - [`Offline`]: the program M alone, no sensor asked.
//! - [`Task`]: the same errand corrected by the control unit and the sensors; its [`Trace`] tells all.
//! - [`World`]: what is really there: cells, some only for a while ([`Visit`]), and discs that move ([`Mover`]).
//! - [`trials`]: many runs at once, on any number of threads, with the same result.
//!
//! Everything is drawn from a seed. The same seed gives the same numbers.

mod avoid;
mod guide;
mod mover;
mod offline;
mod runner;
mod task;
mod trace;
mod trials;
mod world;

pub use avoid::Tally;
pub use mover::{Gait, Leg, Mover};
pub use offline::{Offline, Trial};
pub use task::Task;
pub use trace::{Contact, Ending, Foreseen, Sighting, Tick, Trace};
pub use trials::{trial_rng, trials};
pub use world::{Visit, World};
