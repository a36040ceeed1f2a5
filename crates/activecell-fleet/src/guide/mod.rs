//! Guidance: robots that look ahead, and dives with them.

mod dive;
mod dives;
mod local;
mod spread;
mod table;

pub(crate) use dives::{Budget, dives};

pub use dive::{Dive, dive};

use crate::fields::{Fields, Goal};
use crate::floor::Floor;

/// What is to be planned.
#[derive(Debug, Clone, Copy)]
pub struct Problem<'a> {
    /// The floor.
    pub floor: &'a Floor,
    /// The fields of the goals.
    pub fields: &'a Fields,
    /// Where each robot wants to go.
    pub goals: &'a [Goal],
    /// Where each robot starts, by the number of the cell.
    pub starts: &'a [u32],
}

impl Problem<'_> {
    /// Steps from the start of each robot to its target, if nobody were in its way: the fields are walked down.
    pub fn distances(&self) -> Vec<u32> {
        let ends = self.starts.iter().zip(self.goals);
        ends.map(|(&start, goal)| self.fields.steps(self.floor, goal.slot, start)).collect()
    }
}

/// How robots look ahead.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Guide {
    /// Not at all: each step is arbitrated by itself.
    Plain,
    /// Before each step, this many steps, from 1 to 20: best in crowds.
    Local(u32),
    /// First from start to target, spread over the floor; then as [`Guide::Local`] along that way: best where there is
    /// room.
    Spread(u32),
}
