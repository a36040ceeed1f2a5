//! Terrain: what it costs to enter a cell, which way it may be left, and where a robot must not go.

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
}

/// Every direction.
const ALL: u8 = 0b11_1111;

impl Terrain {
    /// Plain ground: every step costs 1 and may be made in both directions.
    pub fn new(map: &Map) -> Self {
        let padded = Padded::new(map);
        let costs = Arc::new(vec![1; padded.len()]);
        Self { map: map.clone(), padded, costs, exits: Arc::default() }
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

    /// Whether a robot may step from `cell` in this direction: both cells free, and not against a one-way cell.
    pub fn may_step(&self, cell: Cell, dir: Dir) -> bool {
        let lattice = self.map.lattice();
        let next = lattice.neighbour(cell, dir);
        let head_on = !self.may_leave(next, dir) && self.may_leave(next, lattice.opposite(dir));
        self.map.is_free(cell) && self.map.is_free(next) && self.may_leave(cell, dir) && !head_on
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

    fn places(&self, cells: impl IntoIterator<Item = Cell>) -> Result<Vec<(Cell, usize)>, Error> {
        let (width, height) = (self.map.width(), self.map.height());
        let place = |cell| self.padded.place(cell).ok_or(Error::OutsideMap { cell, width, height });
        cells.into_iter().map(|cell| Ok((cell, place(cell)?))).collect()
    }
}
