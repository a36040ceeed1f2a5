//! The group: many active cells on one map, stepping at once. Who starts where and wants to go where, what a plan is,
//! and the checker, which knows no planner.
//!
//! Every robot stands in one cell. In a step it stays or moves to a neighbour that is free of obstacles. Never two
//! robots are in one cell, never two swap cells; one may follow another into the cell that it leaves, also around a
//! ring. Targets stay occupied after arrival.
//!
//! Source of the model: R. Stern et al., *Multi-Agent Pathfinding: Definitions, Variants, and Benchmarks*, `SoCS` 2019.

mod assign;
mod bodies;
mod check;
mod check_journal;
mod journal;
mod keep_out;
mod plan;
pub mod schedule;
mod strangers;
mod team;

pub use bodies::Bodies;
pub use check::{PlanFault, check_bodies, check_keep_outs, check_moves, check_plan};
pub use check_journal::{JournalFault, check_journal};
pub use journal::{Event, Journal, Moves, News, Task};
pub use keep_out::{KeepOut, KeepOuts};
pub use plan::Plan;
pub use schedule::{Schedule, check_schedule};
pub use strangers::{Detection, MemberRecord, detections, strangers};
pub use team::Team;
