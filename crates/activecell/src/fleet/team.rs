//! Who starts where, and wants to go where.

use crate::error::Error;
use crate::lattice::Cell;
use crate::map::Map;
use crate::rng::Rng;
use crate::search::Search;
use std::collections::BTreeMap;

/// The robots of a group: each has a start and a target. No two share a start, no two share a target.
///
/// ```
/// use activecell::{Cell, Lattice, Map, Team};
/// let map = Map::parse(Lattice::Square, "....\n.##.")?;
/// let (west, east) = (Cell::new(0, 0), Cell::new(3, 0));
/// let team = Team::new(&map, vec![west, east], vec![east, west])?;
/// assert_eq!((team.robots(), team.lower_bound(&map)?), (2, Some(6)));
/// let error = Team::new(&map, vec![west, west], vec![east, west]).unwrap_err();
/// assert_eq!(error.to_string(), "robots 0 and 1 have the same start (0,0); give every robot its own");
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Team {
    starts: Vec<Cell>,
    targets: Vec<Cell>,
}

impl Team {
    /// A group on this map; the robots are counted from 0.
    ///
    /// # Errors
    /// [`Error::TeamSize`] if the numbers of starts and targets differ or are more than the free cells;
    /// [`Error::OfRobot`] with the reason for the first robot that cannot stand at its start or target;
    /// [`Error::SharedStart`] or [`Error::SharedTarget`].
    pub fn new(map: &Map, starts: Vec<Cell>, targets: Vec<Cell>) -> Result<Self, Error> {
        if starts.len() != targets.len() || starts.len() > map.free_cells() {
            return Err(Error::TeamSize {
                starts: starts.len(),
                targets: targets.len(),
                free: map.free_cells(),
            });
        }
        for (robot, (&from, &to)) in starts.iter().zip(&targets).enumerate() {
            map.check_task(from, to).map_err(|error| Error::OfRobot { robot, error: Box::new(error) })?;
        }
        if let Some((robots, cell)) = shared(&starts) {
            return Err(Error::SharedStart { robots, cell });
        }
        if let Some((robots, cell)) = shared(&targets) {
            return Err(Error::SharedTarget { robots, cell });
        }
        Ok(Self { starts, targets })
    }

    /// A group with starts and targets by chance, all on the map's [largest region](Map::largest_region), so that no
    /// robot's way to its target is closed by obstacles.
    ///
    /// # Errors
    /// [`Error::TeamSize`] if the robots are more than the region's cells.
    ///
    /// ```
    /// use activecell::{Lattice, Map, Team};
    /// let map = Map::parse(Lattice::Square, "....\n.##.")?;
    /// let team = Team::random(&map, 3, 1)?;
    /// assert_eq!((team.robots(), &team), (3, &Team::random(&map, 3, 1)?)); // the seed decides
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn random(map: &Map, robots: usize, seed: u64) -> Result<Self, Error> {
        let mut cells = map.largest_region();
        if robots > cells.len() {
            return Err(Error::TeamSize { starts: robots, targets: robots, free: cells.len() });
        }
        let mut rng = Rng::new(seed);
        let mut draw = || {
            for drawn in 0..robots {
                let other = drawn + rng.below((cells.len() - drawn) as u32) as usize;
                cells.swap(drawn, other);
            }
            cells[..robots].to_vec()
        };
        Self::new(map, draw(), draw())
    }

    /// How many robots there are.
    pub const fn robots(&self) -> usize {
        self.starts.len()
    }

    /// Where each robot starts.
    pub fn starts(&self) -> &[Cell] {
        &self.starts
    }

    /// Where each robot wants to go.
    pub fn targets(&self) -> &[Cell] {
        &self.targets
    }

    /// The sum of the robots' distances to their targets: no plan has a lower sum of costs. `None` if some robot has no
    /// way to its target.
    ///
    /// # Errors
    /// As [`Search::steps`], if this is not the map that the team was made for.
    pub fn lower_bound(&self, map: &Map) -> Result<Option<u64>, Error> {
        let mut search = Search::new(map);
        let mut sum = 0;
        for (&from, &to) in self.starts.iter().zip(&self.targets) {
            let Some(steps) = search.steps(from, to)? else { return Ok(None) };
            sum += u64::from(steps);
        }
        Ok(Some(sum))
    }
}

/// Two that have the same cell: the first that meets it again, and who had it before.
pub(super) fn shared(cells: &[Cell]) -> Option<([usize; 2], Cell)> {
    let mut owners = BTreeMap::new();
    cells.iter().enumerate().find_map(|(robot, &cell)| {
        let before = owners.insert(cell, robot)?;
        Some(([before, robot], cell))
    })
}
