//! The group: many active cells on one map, stepping at once. Who starts where and wants to go where, what a plan is,
//! and the checker, which knows no planner.
//!
//! Every robot stands in one cell. In a step it stays or moves to a neighbour that is free of obstacles. Never two
//! robots are in one cell, never two swap cells; one may follow another into the cell that it leaves, also around a
//! ring. Targets stay occupied after arrival.
//!
//! Source of the model: R. Stern et al., *Multi-Agent Pathfinding: Definitions, Variants, and Benchmarks*, `SoCS` 2019.

mod check;
mod check_journal;
mod journal;
mod plan;
mod team;

pub use check::{PlanFault, check_plan};
pub use check_journal::{JournalFault, check_journal};
pub use journal::{Event, Journal, Moves, News, Task};
pub use plan::Plan;
pub use team::Team;
