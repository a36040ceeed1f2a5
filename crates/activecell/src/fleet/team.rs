//! Who starts where, and wants to go where.

use super::bodies::{Bodies, Standing};
use crate::error::Error;
use crate::lattice::Cell;
use crate::map::Map;
use crate::rng::Rng;
use crate::search::Search;
use std::collections::{BTreeMap, BTreeSet};

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
    bodies: Bodies,
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
        Ok(Self { starts, targets, bodies: Bodies::default() })
    }

    /// The same robots with bodies of other sizes, or a distance that they keep.
    ///
    /// # Errors
    /// [`Error::BadValue`] if there is another number of radii than of robots; [`Error::OfRobot`] with
    /// [`Error::NoRoom`] for the first robot whose body does not fit at its start or target; [`Error::TooClose`] for
    /// two at their starts or at their targets.
    ///
    /// ```
    /// use activecell::{Bodies, Cell, Lattice, Map, Team};
    /// let map = Map::parse(Lattice::Square, "......\n......\n......")?;
    /// let row = |x: i32| Cell::new(x, 1);
    /// let team = Team::new(&map, vec![row(1), row(3)], vec![row(4), row(2)])?;
    /// let wide = team.clone().with_bodies(&map, Bodies::new(vec![1, 0], 1)?)?;
    /// assert_eq!(wide.bodies().radius(0), 1);
    /// let error = team.with_bodies(&map, Bodies::new(vec![1, 0], 2)?).unwrap_err();
    /// assert_eq!(
    ///     error.to_string(),
    ///     "robots 0 and 1 at (1,1) and (3,1) are too close; their centres must be at least 3 cells apart"
    /// );
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn with_bodies(self, map: &Map, bodies: Bodies) -> Result<Self, Error> {
        if ![0, self.robots()].contains(&bodies.radii()) {
            let (name, value) = ("the number of radii", bodies.radii() as f64);
            return Err(Error::BadValue { name, value, allowed: "one a robot" });
        }
        let team = Self { bodies, ..self };
        team.check_bodies(map)?;
        Ok(team)
    }

    /// Checks that the team can also stand on this map.
    ///
    /// # Errors
    /// As [`Team::new`] and [`Team::with_bodies`].
    pub fn check(&self, map: &Map) -> Result<(), Error> {
        Self::new(map, self.starts.clone(), self.targets.clone())?;
        self.check_bodies(map)
    }

    fn check_bodies(&self, map: &Map) -> Result<(), Error> {
        if self.bodies.are_cells() {
            return Ok(());
        }
        // Distances first: bodies that do not overlap are no more cells than the map has.
        let mut standing = Standing::new(map);
        for cells in [&self.starts, &self.targets] {
            if let Some(robots) = self.bodies.first_too_close(&mut standing, cells) {
                let least = self.bodies.apart(robots[0], robots[1]);
                return Err(Error::TooClose { robots, cells: robots.map(|robot| cells[robot]), least });
            }
        }
        for (robot, (&from, &to)) in self.starts.iter().zip(&self.targets).enumerate() {
            let radius = self.bodies.radius(robot);
            for at in [from, to] {
                if let Some(covers) = map.lattice().block(at, radius).find(|&cell| !map.is_free(cell)) {
                    let error = Box::new(Error::NoRoom { at, radius, covers });
                    return Err(Error::OfRobot { robot, error });
                }
            }
        }
        Ok(())
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
            shuffle(&mut cells, robots, &mut rng);
            cells[..robots].to_vec()
        };
        Self::new(map, draw(), draw())
    }

    /// The same for robots with bodies: each starts and ends on the largest region of the floor of its size, and all keep
    /// their distances there. Robots are placed one after the other, wherever there is still room: large ones find
    /// more of it if they come first.
    ///
    /// # Errors
    /// [`Error::TeamSize`] if there is no room for so many, with the number of those for which there was;
    /// [`Error::BadValue`] as [`Team::with_bodies`].
    ///
    /// ```
    /// use activecell::{Bodies, Lattice, Map, Team};
    /// let map = Map::parse(Lattice::Hex, "......\n......\n......\n......")?;
    /// let team = Team::random_bodies(&map, Bodies::new(vec![1, 0], 2)?, 2, 1)?;
    /// assert!(map.lattice().block_distance(team.starts()[0], team.starts()[1]) >= 3);
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn random_bodies(map: &Map, bodies: Bodies, robots: usize, seed: u64) -> Result<Self, Error> {
        if bodies.are_cells() {
            return Self::random(map, robots, seed);
        }
        let mut rng = Rng::new(seed);
        let radii = (0..robots).map(|robot| bodies.radius(robot)).collect::<BTreeSet<u32>>();
        let mut floors: BTreeMap<u32, Vec<Cell>> =
            radii.into_iter().map(|radius| (radius, map.for_body(radius).largest_region())).collect();
        let mut draw = || {
            for cells in floors.values_mut() {
                let count = cells.len();
                shuffle(cells, count, &mut rng);
            }
            let cells = bodies.placed(map, robots, &floors);
            if cells.len() == robots {
                return Ok(cells);
            }
            Err(Error::TeamSize { starts: robots, targets: robots, free: cells.len() })
        };
        Self::new(map, draw()?, draw()?)?.with_bodies(map, bodies)
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

    /// The robots' bodies, and the distance that they keep.
    pub const fn bodies(&self) -> &Bodies {
        &self.bodies
    }

    /// The sum of the robots' distances to their targets: no plan has a lower sum of costs. `None` if some robot has no
    /// way to its target.
    ///
    /// # Errors
    /// As [`Search::steps`], if this is not the map that the team was made for.
    pub fn lower_bound(&self, map: &Map) -> Result<Option<u64>, Error> {
        let radii = (0..self.robots()).map(|robot| self.bodies.radius(robot));
        let mut sum = 0;
        for radius in radii.clone().collect::<BTreeSet<u32>>() {
            let map = map.for_body(radius);
            let mut search = Search::new(&map);
            let ends = self.starts.iter().zip(&self.targets).zip(radii.clone());
            for ((&from, &to), _) in ends.filter(|&(_, own)| own == radius) {
                let Some(steps) = search.steps(from, to)? else { return Ok(None) };
                sum += u64::from(steps);
            }
        }
        Ok(Some(sum))
    }
}

/// Draws so many of the cells to their front.
fn shuffle(cells: &mut [Cell], count: usize, rng: &mut Rng) {
    for drawn in 0..count {
        let other = drawn + rng.below((cells.len() - drawn) as u32) as usize;
        cells.swap(drawn, other);
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
