//! What a robot sensed and decided on its way.

use crate::control::{Inputs, State};
use crate::lattice::Cell;
use crate::map::PointM;
use crate::program::Pose;
use crate::sense::Change;

/// How a task ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Ending {
    /// In the target's cell, as far as the robot knows.
    Arrived,
    /// It believes that no way leads there, after it looked again at everything that it found in its way.
    Unreachable,
    /// It took longer than was allowed.
    GaveUp,
}

impl Ending {
    /// The ending's name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Arrived => "arrived",
            Self::Unreachable => "unreachable",
            Self::GaveUp => "gave_up",
        }
    }
}

/// One step of the control unit: what was known when it was made, and what was decided.
#[derive(Debug, Clone, PartialEq)]
pub struct Tick {
    /// When, from the start on.
    pub time_s: f64,
    /// Where the robot is.
    pub truth: Pose,
    /// Where it believes to be.
    pub estimate: Pose,
    /// One standard deviation of the believed position.
    pub spread_m: f64,
    /// The last reading of each beam.
    pub readings_m: Vec<f64>,
    /// What the control unit was told.
    pub inputs: Inputs,
    /// What it did.
    pub state: State,
    /// The cell in which the robot believes to be.
    pub cell: Cell,
    /// The cell to whose centre it wants to go: its own, or a neighbour.
    pub aim: Cell,
    /// The cells that closed (`true`) and opened since the tick before.
    pub changes: Vec<Change>,
}

/// A contact: when, and where the robot was.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// When it began.
    pub time_s: f64,
    /// The robot's centre.
    pub at_m: PointM,
    /// The moving disc that was touched, by its number; `None` for an obstacle.
    pub mover: Option<usize>,
}

/// A whole run in the task mode.
#[derive(Debug, Clone, PartialEq)]
pub struct Trace {
    /// How it ended.
    pub ending: Ending,
    /// Every step of the control unit.
    pub ticks: Vec<Tick>,
    /// Everything that the robot touched.
    pub contacts: Vec<Contact>,
    /// Closed cells that the given map calls free, at the end, in row order.
    pub found: Vec<Cell>,
    /// The way really driven.
    pub length_m: f64,
}
