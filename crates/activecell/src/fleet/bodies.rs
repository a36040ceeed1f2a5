//! How large robots are, and how far apart they must stay.

use crate::error::Error;
use crate::lattice::{Cell, Lattice};
use crate::map::Map;
use std::collections::BTreeMap;

/// The largest radius and the largest distance, in cells.
const MOST: u32 = 1 << 14;

/// The bodies of a team's robots, and the least distance between them.
///
/// A body of radius r covers the [block](Lattice::block) of that radius around the robot's cell: (2r + 1)² squares, or the
/// hexagon of the cells at most r steps away. These are the bodies that may turn on the spot within their cells and that
/// are measured alike in all directions of the lattice: a square robot needs its corners. Radius 0 is one cell.
///
/// The least distance d counts from the nearest cell of one body to the nearest of the other, in block distances
/// ([`Lattice::block_distance`]): 1 means that no cell belongs to both, 2 that there is a free cell between them, on
/// squares also aslant. Blocks make this simple: two robots keep it where their *centres* are at least
/// [`apart`](Self::apart) = r + r' + d.
///
/// ```
/// use activecell::Bodies;
/// let bodies = Bodies::new(vec![0, 1, 0], 2)?; // the second robot covers its neighbours too
/// assert_eq!((bodies.apart(0, 1), bodies.apart(0, 2)), (3, 2));
/// assert!(Bodies::default().are_cells());
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Bodies {
    /// Empty if all are 0.
    radii: Vec<u32>,
    largest: u32,
    distance: u32,
}

impl Default for Bodies {
    /// Every robot covers its cell, and no two the same.
    fn default() -> Self {
        Self { radii: Vec::new(), largest: 0, distance: 1 }
    }
}

impl Bodies {
    /// Bodies of these radii, one a robot, and a least distance, all in cells; without radii all are 0.
    ///
    /// # Errors
    /// [`Error::BadValue`] if the distance is 0, or it or a radius is above 16384.
    pub fn new(mut radii: Vec<u32>, distance: u32) -> Result<Self, Error> {
        if !(1..=MOST).contains(&distance) {
            let (name, allowed) = ("the least distance between robots, in cells", "from 1 to 16384");
            return Err(Error::BadValue { name, value: distance.into(), allowed });
        }
        if let Some(&radius) = radii.iter().find(|&&radius| radius > MOST) {
            let (name, allowed) = ("a robot's radius in cells", "from 0 to 16384");
            return Err(Error::BadValue { name, value: radius.into(), allowed });
        }
        let largest = radii.iter().copied().max().unwrap_or(0);
        if largest == 0 {
            radii.clear();
        }
        Ok(Self { radii, largest, distance })
    }

    /// A robot's radius in cells.
    pub fn radius(&self, robot: usize) -> u32 {
        self.radii.get(robot).copied().unwrap_or(0)
    }

    /// The largest radius.
    pub const fn largest(&self) -> u32 {
        self.largest
    }

    /// The least distance between two bodies, in cells.
    pub const fn distance(&self) -> u32 {
        self.distance
    }

    /// How far the centres of two robots must be apart at least, as [`Lattice::block_distance`] counts.
    pub fn apart(&self, a: usize, b: usize) -> u32 {
        self.radius(a) + self.radius(b) + self.distance
    }

    /// Whether every robot covers one cell and may touch others: the ordinary rules.
    pub const fn are_cells(&self) -> bool {
        self.radii.is_empty() && self.distance == 1
    }

    /// How many radii were given that matter: none, or one a robot.
    pub(super) const fn radii(&self) -> usize {
        self.radii.len()
    }

    /// The first pair that is too close, in the order of the higher number, then the lower, among robots in these cells,
    /// all of them on the map.
    pub(super) fn first_too_close(&self, standing: &mut Standing, cells: &[Cell]) -> Option<[usize; 2]> {
        let mut entered = 0;
        let pair = cells.iter().enumerate().find_map(|(robot, &cell)| {
            let other = self.too_close(standing, &cells[..robot], cell);
            standing.enter(cell, robot);
            entered += 1;
            other.map(|other| [other, robot])
        });
        standing.leave(&cells[..entered]);
        pair
    }

    /// Cells for so many robots that keep their distances, each the first left of the `floors` of its radius. Fewer if
    /// there is no room for the next.
    pub(super) fn placed(&self, map: &Map, robots: usize, floors: &BTreeMap<u32, Vec<Cell>>) -> Vec<Cell> {
        let mut standing = Standing::new(map);
        let mut left: BTreeMap<u32, _> =
            floors.iter().map(|(&radius, cells)| (radius, cells.iter())).collect();
        let mut cells = Vec::new();
        for robot in 0..robots {
            // What is too close for one robot is too close for all of its size that follow.
            let mut own = left.get_mut(&self.radius(robot)).into_iter().flatten();
            let Some(&cell) = own.find(|&&cell| self.too_close(&standing, &cells, cell).is_none()) else {
                break;
            };
            standing.enter(cell, robot);
            cells.push(cell);
        }
        cells
    }

    /// The lowest of the robots in `others` that is too close to the next one in `cell`.
    fn too_close(&self, standing: &Standing, others: &[Cell], cell: Cell) -> Option<usize> {
        let robot = others.len();
        let reach = self.radius(robot) + self.largest + self.distance - 1;
        let is_near =
            |&other: &usize| standing.lattice.block_distance(cell, others[other]) < self.apart(robot, other);
        // Whatever is less: to look at all cells around, or at all robots.
        let around = (2 * u64::from(reach) + 1).pow(2);
        if around > robot as u64 {
            (0..robot).find(is_near)
        } else {
            standing.lattice.block(cell, reach).filter_map(|near| standing.who(near)).filter(is_near).min()
        }
    }
}

/// Who stands where.
pub(super) struct Standing {
    lattice: Lattice,
    width: u32,
    height: u32,
    robots: Vec<u32>,
}

impl Standing {
    const NOBODY: u32 = u32::MAX;

    pub(super) fn new(map: &Map) -> Self {
        let (lattice, width, height) = (map.lattice(), map.width(), map.height());
        Self { lattice, width, height, robots: vec![Self::NOBODY; map.cells()] }
    }

    fn index(&self, cell: Cell) -> Option<usize> {
        crate::map::row_index(cell, self.width, self.height)
    }

    pub(super) fn who(&self, cell: Cell) -> Option<usize> {
        let robot = self.robots[self.index(cell)?];
        (robot != Self::NOBODY).then_some(robot as usize)
    }

    /// Puts a robot into a cell; says who was there.
    pub(super) fn enter(&mut self, cell: Cell, robot: usize) -> Option<usize> {
        let there = self.who(cell);
        if let Some(index) = self.index(cell) {
            self.robots[index] = robot as u32;
        }
        there
    }

    pub(super) fn leave(&mut self, cells: &[Cell]) {
        for &cell in cells {
            if let Some(index) = self.index(cell) {
                self.robots[index] = Self::NOBODY;
            }
        }
    }
}
