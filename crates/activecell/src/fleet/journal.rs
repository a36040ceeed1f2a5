//! What a run is in which targets keep coming: tasks, where all robots were at each step, and what they did there.

use super::Plan;
use crate::error::Error;
use crate::lattice::{Cell, Dir};
use crate::map::Map;

/// How robots move.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Moves {
    /// To any neighbour in a step.
    #[default]
    Omni,
    /// A robot has a heading. In a step it goes to the neighbour ahead, or turns by one direction of the lattice (90
    /// degrees on squares, 60 on hexagons), or waits. (The model of the League of Robot Runners.)
    Turning,
}

/// Cells that one robot has to visit, in this order: one cell, a pickup and a delivery, or more.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Task {
    /// The cells to visit, at least one.
    pub errands: Vec<Cell>,
}

impl Task {
    /// A task that is done when its robot stands in this cell.
    pub fn visit(cell: Cell) -> Self {
        Self { errands: vec![cell] }
    }

    /// Whether it can be done on this map, as far as one can tell without a robot.
    ///
    /// # Errors
    /// [`Error::EmptyTask`]; [`Error::OutsideMap`] or [`Error::TargetOccupied`] for a cell that no robot can visit.
    pub fn check(&self, map: &Map) -> Result<(), Error> {
        if self.errands.is_empty() {
            return Err(Error::EmptyTask);
        }
        self.errands.iter().try_for_each(|&cell| map.check_target(cell))
    }
}

/// What happened to a task. Steps, robots and tasks are counted from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Event {
    /// After which step; step 0 is the start.
    pub step: usize,
    /// The robot.
    pub robot: usize,
    /// The task.
    pub task: usize,
    /// What happened.
    pub news: News,
}

/// What can happen to a task. It is finished when its last errand is done.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum News {
    /// The robot got the task.
    Assigned,
    /// The robot stands where this errand of the task, counted from 0, is done.
    Done(usize),
}

/// Where all robots were at every step, and what happened to the tasks, in the order of time.
///
/// A journal may be wrong: [`check_journal`](crate::check_journal) tells. It takes 8 bytes a robot and step, 1 more
/// with headings.
///
/// ```
/// use activecell::{Cell, Event, Journal, Moves, News};
/// let [a, b] = [0, 1].map(|x| Cell::new(x, 0));
/// let done = Event { step: 1, robot: 0, task: 7, news: News::Done(0) };
/// let given = Event { step: 0, news: News::Assigned, ..done };
/// let mut journal = Journal::new(Moves::Omni, &[a], &[], &[given]);
/// journal.push(&[b], &[], &[done]);
/// assert_eq!((journal.steps(), journal.cells(1), journal.events().len()), (1, &[b][..], 2));
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Journal {
    moves: Moves,
    robots: usize,
    cells: Vec<Cell>,
    headings: Vec<Dir>,
    events: Vec<Event>,
}

impl Journal {
    /// A journal with the start alone, and what happened there. Without [`Moves::Turning`] robots have no headings.
    ///
    /// # Panics
    /// If the headings are not one a robot, or none for robots without.
    pub fn new(moves: Moves, cells: &[Cell], headings: &[Dir], events: &[Event]) -> Self {
        let mut journal =
            Self { moves, robots: cells.len(), cells: Vec::new(), headings: Vec::new(), events: Vec::new() };
        journal.push(cells, headings, events);
        journal
    }

    /// Adds a step: where the robots are after it, and what happened.
    ///
    /// # Panics
    /// If the numbers of cells and headings are not those of the robots.
    pub fn push(&mut self, cells: &[Cell], headings: &[Dir], events: &[Event]) {
        let wanted = if self.moves == Moves::Turning { self.robots } else { 0 };
        assert_eq!((cells.len(), headings.len()), (self.robots, wanted), "a cell and a heading a robot");
        self.cells.extend_from_slice(cells);
        self.headings.extend_from_slice(headings);
        self.events.extend_from_slice(events);
    }

    /// How the robots move.
    pub const fn moves(&self) -> Moves {
        self.moves
    }

    /// How many robots there are.
    pub const fn robots(&self) -> usize {
        self.robots
    }

    /// How many steps the journal has; 0 with the start alone.
    pub fn steps(&self) -> usize {
        self.cells.len().checked_div(self.robots).map_or(0, |rows| rows - 1)
    }

    /// Where all robots are after `step` steps.
    ///
    /// # Panics
    /// If there is no such step.
    pub fn cells(&self, step: usize) -> &[Cell] {
        &self.cells[step * self.robots..][..self.robots]
    }

    /// Where all robots head after `step` steps; empty where robots have no heading.
    ///
    /// # Panics
    /// If there is no such step.
    pub fn headings(&self, step: usize) -> &[Dir] {
        if self.headings.is_empty() { &[] } else { &self.headings[step * self.robots..][..self.robots] }
    }

    /// What happened to the tasks.
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// How many of these tasks were finished.
    pub fn finished(&self, tasks: &[Task]) -> usize {
        let last = |task: usize| tasks.get(task).map(|task| task.errands.len());
        let is_last =
            |event: &&Event| matches!(event.news, News::Done(errand) if Some(errand + 1) == last(event.task));
        self.events.iter().filter(is_last).count()
    }

    /// The cells as a plan, for all that reads plans. `None` if the journal is of no robots.
    pub fn plan(&self) -> Option<Plan> {
        Plan::new(self.robots, self.cells.clone()).ok()
    }
}
