//! Terrain: what it costs to enter a cell and to make a step, which steps may be made, and where a robot must not go.

use super::padded::Padded;
use crate::error::Error;
use crate::lattice::{Cell, Dir};
use crate::map::Map;
use std::sync::Arc;

/// A map whose cells differ: slow ground and preferred ways (costs), one-way cells, keep-out areas.
///
/// - A cell's **cost** is for how many time steps it delays the wave: 1 for a plain step, up to 255. A route costs
///   the sum over the cells that it enters (all but its start).
/// - A **one-way** cell may be left only in its directions, and not be entered head-on: by a step against one of its
///   directions, unless the step's own direction is one of them too. Entering it from the side is allowed.
/// - A cell that is **kept out** of is an obstacle here. The map that the terrain was made of does not change.
/// - A **step** may have a cost of its own, another in each direction: longer ground, a climb. The cost of the cell
///   that it enters multiplies it. A step may be closed, in one direction or in both.
///
/// ```
/// use activecell::{Cell, Dir, Lattice, Map, Terrain};
/// let map = Map::parse(Lattice::Square, "S.F\n...")?;
/// let mut terrain = Terrain::new(&map);
/// terrain.set_cost([Cell::new(1, 0)], 5)?;
/// let route = terrain.wave(Cell::new(2, 0))?.route(Cell::new(0, 0));
/// assert_eq!((route.steps(), route.turns().len()), (4, 2)); // around the slow cell
/// terrain.set_one_way([Cell::new(1, 1)], &[Dir::W])?;
/// assert_eq!(terrain.wave(Cell::new(2, 0))?.cost(Cell::new(0, 0)), Some(6)); // through it
/// terrain.keep_out([Cell::new(1, 0)])?;
/// assert_eq!(terrain.wave(Cell::new(2, 0))?.cost(Cell::new(0, 0)), None);
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Terrain {
    map: Map,
    padded: Padded,
    costs: Arc<Vec<u8>>,
    /// A bit a direction; empty while no cell is one-way.
    exits: Arc<Vec<u8>>,
    /// What the steps from each place cost, in the order of directions, [`CLOSED`] for those that may not be made;
    /// empty while every step costs 1.
    steps: Arc<Vec<u16>>,
}

/// A step that may not be made.
const CLOSED: u16 = 0;

/// Every direction.
const ALL: u8 = 0b11_1111;

impl Terrain {
    /// Plain ground: every step costs 1 and may be made in both directions.
    pub fn new(map: &Map) -> Self {
        let padded = Padded::new(map);
        let costs = Arc::new(vec![1; padded.len()]);
        Self { map: map.clone(), padded, costs, exits: Arc::default(), steps: Arc::default() }
    }

    /// Sets what a step into each of these cells costs.
    ///
    /// # Errors
    /// [`Error::OutsideMap`]; [`Error::BadValue`] if the cost is 0. Nothing is changed then.
    pub fn set_cost(&mut self, cells: impl IntoIterator<Item = Cell>, cost: u8) -> Result<(), Error> {
        if cost == 0 {
            let allowed = "from 1 (a plain step) to 255";
            return Err(Error::BadValue { name: "the cost of a cell", value: 0.0, allowed });
        }
        let places = self.places(cells)?;
        let costs = Arc::make_mut(&mut self.costs);
        for (_, place) in places {
            costs[place] = cost;
        }
        Ok(())
    }

    /// Sets the directions in which each of these cells may be left; with all of them it is no one-way cell, with
    /// none it is a dead end.
    ///
    /// # Errors
    /// [`Error::OutsideMap`]; [`Error::BadValue`] if the lattice lacks a direction. Nothing is changed then.
    pub fn set_one_way(&mut self, cells: impl IntoIterator<Item = Cell>, dirs: &[Dir]) -> Result<(), Error> {
        let degree = self.map.lattice().degree();
        if let Some(dir) = dirs.iter().find(|dir| dir.0 >= degree) {
            let allowed = "below the number of a cell's neighbours";
            return Err(Error::BadValue { name: "a direction's number", value: dir.0.into(), allowed });
        }
        let mask = dirs.iter().fold(0, |mask, dir| mask | 1 << dir.0);
        let places = self.places(cells)?;
        let exits = Arc::make_mut(&mut self.exits);
        exits.resize(self.padded.len(), ALL);
        for (_, place) in places {
            exits[place] = mask;
        }
        Ok(())
    }

    /// Makes obstacles of these cells, for this terrain only; [`Map::cells_touching_m`] finds the cells of an area.
    ///
    /// # Errors
    /// [`Error::OutsideMap`]. Nothing is changed then.
    pub fn keep_out(&mut self, cells: impl IntoIterator<Item = Cell>) -> Result<(), Error> {
        for (cell, _) in self.places(cells)? {
            self.map.set_obstacle(cell, true);
        }
        Ok(())
    }

    /// Sets what the step from a cell in one direction costs; `None` closes it.
    ///
    /// # Errors
    /// [`Error::OutsideMap`]; [`Error::BadValue`] if the cost is 0 or the lattice lacks the direction. Nothing is
    /// changed then.
    ///
    /// ```
    /// use activecell::{Cell, Dir, Lattice, Map, Terrain};
    /// let mut terrain = Terrain::new(&Map::parse(Lattice::Square, "S.F")?);
    /// terrain.set_step(Cell::new(1, 0), Dir::E, Some(500))?; // uphill
    /// terrain.set_step(Cell::new(1, 0), Dir::W, None)?; // too steep on the way back
    /// assert_eq!(terrain.wave(Cell::new(2, 0))?.cost(Cell::new(0, 0)), Some(501));
    /// assert_eq!(terrain.wave(Cell::new(0, 0))?.cost(Cell::new(2, 0)), None);
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn set_step(&mut self, from: Cell, dir: Dir, cost: Option<u16>) -> Result<(), Error> {
        let degree = self.map.lattice().degree();
        let bad = |name, value, allowed| Err(Error::BadValue { name, value, allowed });
        if dir.0 >= degree {
            return bad("a direction's number", dir.0.into(), "below the number of a cell's neighbours");
        }
        if cost == Some(CLOSED) {
            return bad("the cost of a step", 0.0, "from 1 to 65535");
        }
        let (width, height) = (self.map.width(), self.map.height());
        let place = self.padded.place(from).ok_or(Error::OutsideMap { cell: from, width, height })?;
        let steps = Arc::make_mut(&mut self.steps);
        if steps.is_empty() {
            steps.resize(self.padded.len() * usize::from(degree), 1);
        }
        steps[place * usize::from(degree) + dir.index()] = cost.unwrap_or(CLOSED);
        Ok(())
    }

    /// The map with the cells kept out of as obstacles.
    pub const fn map(&self) -> &Map {
        &self.map
    }

    /// What a step into the cell costs; 1 outside the map.
    pub fn cost(&self, cell: Cell) -> u8 {
        self.padded.place(cell).map_or(1, |place| self.costs[place])
    }

    /// Whether the cell may be left in this direction, as far as one-way rules go; true outside the map.
    pub fn may_leave(&self, cell: Cell, dir: Dir) -> bool {
        let place = self.padded.place(cell).filter(|_| !self.exits.is_empty());
        place.is_none_or(|place| self.exits[place] >> dir.0 & 1 == 1)
    }

    /// What the step from `cell` in this direction costs of its own; `None` if it is closed, 1 outside the map.
    pub fn own_cost(&self, cell: Cell, dir: Dir) -> Option<u16> {
        let place = self.padded.place(cell).filter(|_| !self.steps.is_empty());
        let cost = place
            .map_or(1, |place| self.steps[place * usize::from(self.map.lattice().degree()) + dir.index()]);
        (cost != CLOSED).then_some(cost)
    }

    /// What the step from `cell` in this direction costs in all: its own cost times that of the cell that it enters,
    /// at most 65535; `None` if the robot may not make it.
    pub fn step_cost(&self, cell: Cell, dir: Dir) -> Option<u32> {
        let next = self.map.lattice().neighbour(cell, dir);
        let own = self.own_cost(cell, dir).filter(|_| self.may_step(cell, dir))?;
        Some(product(own, self.cost(next)))
    }

    /// Whether a robot may step from `cell` in this direction: both cells free, not against a one-way cell, and the
    /// step not closed.
    pub fn may_step(&self, cell: Cell, dir: Dir) -> bool {
        let lattice = self.map.lattice();
        let next = lattice.neighbour(cell, dir);
        let head_on = !self.may_leave(next, dir) && self.may_leave(next, lattice.opposite(dir));
        let open = self.own_cost(cell, dir).is_some();
        open && self.map.is_free(cell) && self.map.is_free(next) && self.may_leave(cell, dir) && !head_on
    }

    /// The most that a step can cost.
    pub(crate) fn dearest_step(&self) -> u32 {
        let own = self.steps.iter().copied().max().unwrap_or(1);
        product(own, self.costs.iter().copied().max().unwrap_or(1)).max(1)
    }

    pub(super) const fn padded(&self) -> &Padded {
        &self.padded
    }

    /// The costs, at their places.
    pub(super) fn costs(&self) -> &[u8] {
        &self.costs
    }

    /// The directions in which cells may be left, at their places; empty if no cell is one-way.
    pub(super) fn exits(&self) -> &[u8] {
        &self.exits
    }

    /// What the steps from each place cost, 0 if closed; empty if each costs 1.
    pub(super) fn steps(&self) -> &[u16] {
        &self.steps
    }

    fn places(&self, cells: impl IntoIterator<Item = Cell>) -> Result<Vec<(Cell, usize)>, Error> {
        let (width, height) = (self.map.width(), self.map.height());
        let place = |cell| self.padded.place(cell).ok_or(Error::OutsideMap { cell, width, height });
        cells.into_iter().map(|cell| Ok((cell, place(cell)?))).collect()
    }
}

/// What a step costs: its own cost times the cell's, 0 if it is closed.
#[inline]
pub(super) fn product(own: u16, cell: u8) -> u32 {
    (u32::from(own) * u32::from(cell)).min(u16::MAX.into())
}
