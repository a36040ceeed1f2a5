//! Plans for groups: one active cell per robot on a shared mosaic, all stepping at once.
//!
//! ```text
//! Map + Team ──fields──▶ arbitrate, a step of all robots ──search, dives──▶ Plan ──refine──▶ Plan ──check──▶ ok | first fault
//! ```
//!
//! [`solve`] does it all. [`Floor`] numbers the cells, [`Fields`] keeps a field of one or two bits a cell for each target,
//! [`Arbiter`] settles one step of all robots between neighbouring cells, [`Search`] makes that complete and better
//! with time, [`dive`] makes plans by robots that look ahead, [`Refiner`] makes plans better. What a plan is, and who
//! checks it, is in [`activecell`].
//!
//! ```
//! use activecell::{Lattice, Map, Team, check_plan};
//! use activecell_fleet::{Options, solve};
//! let map = Map::parse(Lattice::Hex, "A..B\n.#..")?;
//! let [a, b] = ['A', 'B'].map(|name| map.mark(name).unwrap());
//! let team = Team::new(&map, vec![a, b], vec![b, a])?;
//! let outcome = solve(&map, &team, &Options::default(), |_| {})?;
//! assert_eq!(check_plan(&map, &team, &outcome.plan.unwrap()), Ok(()));
//! # Ok::<(), activecell::Error>(())
//! ```

mod arbitrate;
mod fields;
mod floor;
mod guide;
mod lifelong;
mod passage;
mod priorities;
mod refine;
mod room;
mod search;
mod solve;

pub use arbitrate::Arbiter;
pub use fields::{Fields, Goal};
pub use floor::{Floor, NONE};
pub use guide::{Dive, Guide, Problem, dive};
pub use lifelong::{
    Assignment, Lifelong, LifelongOptions, MAX_WINDOW, StepReport, deliveries, visits, within_reach,
};
pub use passage::{Layout, Passage, Reservations};
pub use refine::Refiner;
pub use room::Room;
pub use search::{Advance, Search};
pub use solve::{Ending, Improvement, Limits, Options, Outcome, solve, solve_past};
