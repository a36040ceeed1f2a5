//! The wave: the flood automaton. From the target on, a free cell that has a reached neighbour is reached at the
//! next time step.

mod live;
mod padded;
mod terrain;
mod weighted;

pub use live::LiveField;
pub use terrain::Terrain;
pub use weighted::WeightedField;

use crate::error::Error;
use crate::lattice::{Cell, Dir, Lattice};
use crate::map::Map;

const NEVER: u32 = u32::MAX;

/// For every cell, the time step at which the wave from the target reached it: its distance.
///
/// ```
/// use activecell::{Cell, Lattice, Map};
/// let map = Map::parse(Lattice::Square, "S#.\n..F\n##.")?;
/// let field = map.wave(Cell::new(2, 1))?;
/// assert_eq!(field.steps(Cell::new(0, 0)), Some(3));
/// assert_eq!(field.steps(Cell::new(1, 0)), None); // an obstacle
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Field {
    lattice: Lattice,
    width: u32,
    height: u32,
    target: Cell,
    steps: Vec<u32>,
}

impl Map {
    /// Floods the map from `target`.
    ///
    /// # Errors
    /// [`Error::OutsideMap`] or [`Error::TargetOccupied`].
    pub fn wave(&self, target: Cell) -> Result<Field, Error> {
        self.check_task(target, target).map_err(|error| match error {
            Error::StartOccupied { cell, nearest } => Error::TargetOccupied { cell, nearest },
            other => other,
        })?;
        Ok(self.flood(target, None))
    }

    /// Floods the map from `target` until the wave reaches `start` or stops; cells farther away are unknown.
    ///
    /// # Errors
    /// [`Error::OutsideMap`], [`Error::StartOccupied`] or [`Error::TargetOccupied`].
    pub fn wave_to(&self, target: Cell, start: Cell) -> Result<Field, Error> {
        self.check_task(start, target)?;
        Ok(self.flood(target, Some(start)))
    }

    /// How many cells each part of the floor has that no way connects to another, largest first.
    ///
    /// ```
    /// use activecell::{Lattice, Map};
    /// assert_eq!(Map::parse(Lattice::Square, "..#\n.#.")?.regions(), [3, 1]);
    /// assert_eq!(Map::parse(Lattice::Hex, "..#\n.#.")?.regions(), [3, 1]);
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn regions(&self) -> Vec<usize> {
        let mut field = Field::new(self, Cell::default());
        let mut regions = Vec::new();
        for cell in self.free() {
            if field.steps(cell).is_none() {
                regions.push(field.spread(self, cell, None));
            }
        }
        regions.sort_unstable_by(|a, b| b.cmp(a));
        regions
    }

    fn flood(&self, target: Cell, until: Option<Cell>) -> Field {
        let mut field = Field::new(self, target);
        field.spread(self, target, until);
        field
    }
}

impl Field {
    fn new(map: &Map, target: Cell) -> Self {
        let (width, height) = (map.width(), map.height());
        Self { lattice: map.lattice(), width, height, target, steps: vec![NEVER; map.cells()] }
    }

    /// Spreads the wave from `origin` until it reaches `until` or stops; says how many cells it reached.
    fn spread(&mut self, map: &Map, origin: Cell, until: Option<Cell>) -> usize {
        let mut rim = vec![origin];
        let mut next = Vec::new();
        let (mut step, mut reached) = (0, 1);
        self.reach(origin, 0);
        while !rim.is_empty() && until.is_none_or(|start| self.steps(start).is_none()) {
            step += 1;
            for cell in rim.drain(..) {
                for dir in self.lattice.dirs() {
                    let neighbour = self.lattice.neighbour(cell, dir);
                    if map.is_free(neighbour) && self.steps(neighbour).is_none() {
                        self.reach(neighbour, step);
                        next.push(neighbour);
                    }
                }
            }
            reached += next.len();
            std::mem::swap(&mut rim, &mut next);
        }
        reached
    }

    /// The lattice.
    pub const fn lattice(&self) -> Lattice {
        self.lattice
    }

    /// Where the wave started.
    pub const fn target(&self) -> Cell {
        self.target
    }

    /// The steps from `cell` to the target; `None` where the wave did not come.
    #[inline]
    pub fn steps(&self, cell: Cell) -> Option<u32> {
        let steps = self.steps[self.index(cell)?];
        (steps != NEVER).then_some(steps)
    }

    /// The number of the cell in row order, from 0; `None` outside the map.
    #[inline]
    pub(crate) fn index(&self, cell: Cell) -> Option<usize> {
        let (x, y) = (cell.x as u32, cell.y as u32);
        (x < self.width && y < self.height).then(|| y as usize * self.width as usize + x as usize)
    }

    /// How many cells the map has.
    pub(crate) fn cells(&self) -> usize {
        self.steps.len()
    }

    /// The directions that lead one step nearer to the target; none at the target and where the wave did not
    /// come.
    pub fn nearer(&self, cell: Cell) -> impl Iterator<Item = Dir> + '_ {
        let wanted = self.steps(cell).and_then(|steps| steps.checked_sub(1));
        self.lattice
            .dirs()
            .filter(move |&dir| wanted.is_some() && self.steps(self.lattice.neighbour(cell, dir)) == wanted)
    }

    fn reach(&mut self, cell: Cell, step: u32) {
        let index = self.index(cell).expect("only cells of the map are reached");
        self.steps[index] = step;
    }
}
