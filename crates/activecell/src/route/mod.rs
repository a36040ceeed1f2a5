//! Routes: the active cell followed to its end by one of the rules.

mod check;
mod clear;
mod downhill;
mod priced;

pub use check::{RouteFault, check_route, check_terrain_route};
pub(crate) use priced::STEP;

use crate::error::Error;
use crate::lattice::{Cell, Dir, Lattice};
use crate::map::Map;
use crate::rule::{Decision, Levels, Rule, Sector, decide, neighbourhood};
use std::collections::HashMap;
use std::fmt;

/// How a walk ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Outcome {
    /// At the target.
    Arrived,
    /// The published rule came back to a cell: it would circle for ever.
    Trapped,
    /// It is proven that no way leads to the target.
    Unreachable,
    /// All neighbours of the robot's cell are obstacles.
    Enclosed,
}

impl Outcome {
    /// The outcome's name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Arrived => "arrived",
            Self::Trapped => "trapped",
            Self::Unreachable => "unreachable",
            Self::Enclosed => "enclosed",
        }
    }
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The cells that were active, one after the other.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Route {
    lattice: Lattice,
    outcome: Outcome,
    cells: Vec<Cell>,
    cycle: Vec<Cell>,
}

impl Route {
    /// The route along given cells, from the first to the last.
    ///
    /// # Errors
    /// The first [`RouteFault`], as of [`check_route`].
    ///
    /// ```
    /// use activecell::{Cell, Lattice, Map, Route};
    /// let map = Map::parse(Lattice::Square, "..\n..")?;
    /// let route = Route::through(&map, [(0, 0), (1, 0), (1, 1)].map(|(x, y)| Cell::new(x, y)).to_vec())?;
    /// assert_eq!((route.steps(), route.turns()), (2, vec![Cell::new(1, 0)]));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn through(map: &Map, cells: Vec<Cell>) -> Result<Self, RouteFault> {
        let ends = [cells.first(), cells.last()].map(|cell| cell.copied().unwrap_or_default());
        check_route(map, &cells, ends[0], ends[1])?;
        Ok(Self { lattice: map.lattice(), outcome: Outcome::Arrived, cells, cycle: Vec::new() })
    }

    /// The lattice.
    pub const fn lattice(&self) -> Lattice {
        self.lattice
    }

    /// How it ended.
    pub const fn outcome(&self) -> Outcome {
        self.outcome
    }

    /// The active cells from the start on. If trapped, the last is the first that came twice.
    pub fn cells(&self) -> &[Cell] {
        &self.cells
    }

    /// The cells that a trapped robot would visit again and again, each once; else none.
    pub fn cycle(&self) -> &[Cell] {
        &self.cycle
    }

    /// How many steps were made.
    pub fn steps(&self) -> usize {
        self.cells.len().saturating_sub(1)
    }

    /// Checks the route, knowing nothing of how it was found: it must lead from `from` through free cells, from
    /// neighbour to neighbour, and end at `to` if the outcome says so.
    ///
    /// # Errors
    /// The first [`RouteFault`].
    pub fn check(&self, map: &Map, from: Cell, to: Cell) -> Result<(), RouteFault> {
        let end = if self.outcome == Outcome::Arrived { to } else { *self.cells.last().unwrap_or(&to) };
        check_route(map, &self.cells, from, end)
    }

    /// The direction of each step.
    pub fn dirs(&self) -> impl Iterator<Item = Dir> + '_ {
        self.cells.windows(2).filter_map(|pair| self.lattice.dir_between(pair[0], pair[1]))
    }

    /// The cells in which the direction changes.
    pub fn turns(&self) -> Vec<Cell> {
        let dirs: Vec<Dir> = self.dirs().collect();
        let changes = dirs.windows(2).zip(&self.cells[1.min(self.cells.len())..]);
        changes.filter(|(pair, _)| pair[0] != pair[1]).map(|(_, &cell)| cell).collect()
    }
}

impl Map {
    /// Follows the active cell from `from` towards `to` by `rule`.
    ///
    /// With [`Rule::Wave`] the route is shortest, and among the shortest has the fewest turns. With
    /// [`Rule::Learning`] and [`Rule::Wave`] the outcome is [`Outcome::Arrived`] wherever a way exists, else
    /// [`Outcome::Unreachable`]. With [`Rule::Published`] it is never `Unreachable`: that rule cannot know.
    ///
    /// # Errors
    /// [`Error::OutsideMap`], [`Error::StartOccupied`], [`Error::TargetOccupied`]; [`Error::StepLimit`] if
    /// learning makes more than `max_steps` steps.
    ///
    /// ```
    /// use activecell::{Cell, Lattice, Map, Outcome, Rule};
    /// let map = Map::parse(Lattice::Square, "S.#.\n..#.\n...F")?;
    /// let route = map.route(Rule::Wave, Cell::new(0, 0), Cell::new(3, 2), 1000)?;
    /// assert_eq!((route.outcome(), route.steps(), route.turns().len()), (Outcome::Arrived, 5, 1));
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn route(&self, rule: Rule, from: Cell, to: Cell, max_steps: usize) -> Result<Route, Error> {
        self.check_task(from, to)?;
        match rule {
            Rule::Published => Ok(published(self, from, to)),
            Rule::Learning => learning(self, from, to, max_steps),
            Rule::Wave => Ok(self.wave(to)?.route(from)),
        }
    }
}

/// The published rule has no memory, so a cell that comes twice proves a cycle.
fn published(map: &Map, from: Cell, to: Cell) -> Route {
    let lattice = map.lattice();
    let mut cells = vec![from];
    let mut first_visit = HashMap::from([(from, 0)]);
    let mut cell = from;
    let (outcome, cycle) = loop {
        let Some(sector) = Sector::towards(lattice, cell, to) else { break (Outcome::Arrived, Vec::new()) };
        let near = lattice.distance(cell, to) == 1;
        let Decision::Move(dir) = decide(lattice, sector, near, neighbourhood(map, cell)) else {
            break (Outcome::Enclosed, Vec::new());
        };
        cell = lattice.neighbour(cell, dir);
        cells.push(cell);
        if let Some(first) = first_visit.insert(cell, cells.len() - 1) {
            break (Outcome::Trapped, cells[first..cells.len() - 1].to_vec());
        }
    };
    Route { lattice, outcome, cells, cycle }
}

fn learning(map: &Map, from: Cell, to: Cell, max_steps: usize) -> Result<Route, Error> {
    let mut levels = Levels::new(map, to);
    let mut cells = vec![from];
    let mut cell = from;
    let outcome = loop {
        if cell == to {
            break Outcome::Arrived;
        }
        if cells.len() > max_steps {
            return Err(Error::StepLimit { steps: max_steps });
        }
        let Some(dir) = levels.step(map, cell) else { break Outcome::Unreachable };
        cell = map.lattice().neighbour(cell, dir);
        cells.push(cell);
    };
    Ok(Route { lattice: map.lattice(), outcome, cells, cycle: Vec::new() })
}
