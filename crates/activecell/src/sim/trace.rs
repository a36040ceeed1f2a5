//! What a robot sensed and decided on its way.

use super::avoid::Tally;
use crate::control::{Inputs, State};
use crate::lattice::{Cell, Dir};
use crate::map::PointM;
use crate::predict::Forecast;
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
    /// The moving objects that it reckons with.
    pub objects: Vec<Sighting>,
    /// The plan past them, where one was made.
    pub foreseen: Option<Foreseen>,
}

/// A moving object as the robot knows it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sighting {
    /// Its number.
    pub number: u32,
    /// Where it was last seen, as placed by where the robot believed to be.
    pub at_m: PointM,
    /// When.
    pub seen_s: f64,
    /// Where it is likely to be a slot later.
    pub then: Forecast,
}

/// What was foreseen when a slot began.
#[derive(Debug, Clone, PartialEq)]
pub struct Foreseen {
    /// For how many slots the plan is safe.
    pub safe_slots: usize,
    /// Whether the robot waits in this one.
    pub waits: bool,
    /// Where it is to turn to on the spot.
    pub turn: Option<Dir>,
    /// The cells that are closed to stand in during this slot.
    pub closed: Vec<Cell>,
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
    /// Whether the robot drove; if not, it was run into.
    pub driving: bool,
    /// Whether the plan had called the slot safe from this mover: then the mover broke its bounds, or the promise was.
    pub promised: bool,
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
    /// What moving objects cost it.
    pub tally: Tally,
}
