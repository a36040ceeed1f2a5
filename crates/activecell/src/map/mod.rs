//! Maps: which cells of the floor are obstacles, and where they lie.

mod area;
mod bits;
mod body;
mod clearance;
mod elevation;
mod frame;
mod profile;
mod retile;
mod text;

pub use bits::{BitPlane, MAX_CELLS};
pub use clearance::Clearance;
pub use elevation::{Elevation, Posts};
pub use frame::{Frame, PointM};
pub use profile::{Ground, Profile};
pub use retile::Tiling;

use crate::error::Error;
use crate::lattice::{Cell, Lattice};
use crate::rng::Rng;
use std::sync::Arc;

/// A floor covered by cells, each free or an obstacle. A value: cheap to clone, never changed.
///
/// ```
/// use activecell::{Cell, Lattice, Map};
/// let map = Map::parse(Lattice::Square, "S.#\n..#\n..F")?;
/// assert_eq!((map.width(), map.height(), map.free_cells()), (3, 3, 7));
/// assert!(!map.is_free(Cell::new(2, 0)));
/// assert!(!map.is_free(Cell::new(-1, 0))); // outside
/// assert_eq!(map.mark('F'), Some(Cell::new(2, 2)));
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Map {
    lattice: Lattice,
    obstacles: Arc<BitPlane>,
    frame: Frame,
    marks: Arc<[(char, Cell)]>,
    relief: Option<(Elevation, Ground)>,
}

impl Map {
    /// A map of these obstacles, in cells of 1 m.
    pub fn new(lattice: Lattice, obstacles: BitPlane) -> Self {
        Self {
            lattice,
            obstacles: Arc::new(obstacles),
            frame: Frame::default(),
            marks: Arc::new([]),
            relief: None,
        }
    }

    /// A map in which each cell is an obstacle with probability `density`, the same for the same seed.
    ///
    /// # Errors
    /// As [`BitPlane::new`]; [`Error::BadValue`] if the density is not between 0 and 1.
    pub fn random(lattice: Lattice, width: u32, height: u32, density: f64, seed: u64) -> Result<Self, Error> {
        if !(0.0..=1.0).contains(&density) {
            let allowed = "between 0 and 1";
            return Err(Error::BadValue { name: "the share of obstacles", value: density, allowed });
        }
        let mut rng = Rng::new(seed);
        let mut obstacles = BitPlane::new(width.into(), height.into())?;
        for y in 0..height {
            for x in 0..width {
                obstacles.set(x, y, rng.chance(density));
            }
        }
        Ok(Self::new(lattice, obstacles))
    }

    /// The same obstacles in another frame.
    ///
    /// # Errors
    /// [`Error::BadValue`] if the frame's numbers make no sense.
    pub fn in_frame(self, frame: Frame) -> Result<Self, Error> {
        Ok(Self { frame: frame.checked()?, ..self })
    }

    /// The same columns and rows read as cells of another lattice (hexagons in odd-r order).
    #[must_use]
    pub fn on(self, lattice: Lattice) -> Self {
        Self { lattice, ..self }
    }

    /// Blocks or frees a cell of the map; a plane of obstacles that other maps share is copied first.
    pub(crate) fn set_obstacle(&mut self, cell: Cell, blocked: bool) {
        Arc::make_mut(&mut self.obstacles).set(cell.x as u32, cell.y as u32, blocked);
    }

    /// The lattice.
    pub const fn lattice(&self) -> Lattice {
        self.lattice
    }

    /// Columns.
    pub fn width(&self) -> u32 {
        self.obstacles.width()
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.obstacles.height()
    }

    /// The obstacles, a bit a cell.
    pub fn obstacles(&self) -> &BitPlane {
        &self.obstacles
    }

    /// Where the map lies.
    pub const fn frame(&self) -> &Frame {
        &self.frame
    }

    /// The named cells, in the order of the map's rows.
    pub fn marks(&self) -> &[(char, Cell)] {
        &self.marks
    }

    /// The cell that the letter `name` marks.
    pub fn mark(&self, name: char) -> Option<Cell> {
        self.marks.iter().find(|mark| mark.0 == name).map(|mark| mark.1)
    }

    /// Whether the cell lies on the map.
    pub fn contains(&self, cell: Cell) -> bool {
        self.index(cell).is_some()
    }

    /// Whether a robot may be there: on the map and not an obstacle.
    pub fn is_free(&self, cell: Cell) -> bool {
        self.contains(cell) && !self.obstacles.get(cell.x as u32, cell.y as u32)
    }

    /// The number of the cell in row order, from 0; `None` outside the map.
    #[inline]
    pub fn index(&self, cell: Cell) -> Option<usize> {
        row_index(cell, self.width(), self.height())
    }

    /// How many cells the map has.
    pub fn cells(&self) -> usize {
        self.width() as usize * self.height() as usize
    }

    /// How many cells are free.
    pub fn free_cells(&self) -> usize {
        self.cells() - self.obstacles.count_ones() as usize
    }

    /// All free cells in row order.
    pub fn free(&self) -> impl Iterator<Item = Cell> + '_ {
        let (width, height) = (self.width() as i32, self.height() as i32);
        (0..height)
            .flat_map(move |y| (0..width).map(move |x| Cell::new(x, y)))
            .filter(|&cell| self.is_free(cell))
    }

    /// The free cell nearest to `cell` on an empty floor, the first in row order among equals.
    pub fn nearest_free(&self, cell: Cell) -> Option<Cell> {
        self.free().min_by_key(|&free| self.lattice.distance(cell, free))
    }

    /// Checks that a robot can stand at both ends of a task.
    ///
    /// # Errors
    /// [`Error::OutsideMap`], [`Error::StartOccupied`], [`Error::TargetOccupied`].
    pub fn check_task(&self, from: Cell, to: Cell) -> Result<(), Error> {
        if !self.contains(from) {
            return Err(Error::OutsideMap { cell: from, width: self.width(), height: self.height() });
        }
        if !self.is_free(from) {
            return Err(Error::StartOccupied { cell: from, nearest: self.nearest_free(from) });
        }
        self.check_target(to)
    }

    /// Checks that a robot can stand at the target.
    ///
    /// # Errors
    /// [`Error::OutsideMap`], [`Error::TargetOccupied`].
    pub fn check_target(&self, cell: Cell) -> Result<(), Error> {
        if !self.contains(cell) {
            return Err(Error::OutsideMap { cell, width: self.width(), height: self.height() });
        }
        if !self.is_free(cell) {
            return Err(Error::TargetOccupied { cell, nearest: self.nearest_free(cell) });
        }
        Ok(())
    }

    /// Width and height of the mosaic's bounding box in metres.
    pub fn size_m(&self) -> PointM {
        mosaic_size_m(self.lattice, self.frame.cell_m, self.width(), self.height())
    }

    /// The cell's centre on the floor.
    ///
    /// ```
    /// use activecell::{Cell, Lattice, Map};
    /// let map = Map::parse(Lattice::Square, "...\n...")?; // cells of 1 m
    /// assert_eq!(map.centre_m(Cell::new(0, 0)), [0.5, 1.5]);
    /// assert_eq!(map.cell_at_m([0.7, 1.2]), Cell::new(0, 0));
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn centre_m(&self, cell: Cell) -> PointM {
        let (ux, uy) = self.lattice.unit_m();
        let (x, y) = self.lattice.centre(cell);
        let down_m = y as f64 * uy * self.frame.cell_m;
        self.frame.to_floor([x as f64 * ux * self.frame.cell_m, self.size_m()[1] - down_m])
    }

    /// The cell's corners on the floor, clockwise from the top left (square) or the top (hexagon).
    ///
    /// ```
    /// use activecell::{Cell, Lattice, Map};
    /// let map = Map::parse(Lattice::Square, "..")?;
    /// assert_eq!(map.corners_m(Cell::new(1, 0)), [[1.0, 1.0], [2.0, 1.0], [2.0, 0.0], [1.0, 0.0]]);
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn corners_m(&self, cell: Cell) -> Vec<PointM> {
        let (ux, uy) = self.lattice.unit_m();
        let centre_m = self.centre_m(cell);
        let (sin, cos) = self.frame.yaw_rad.sin_cos();
        let corner = |&(dx, dy): &(i64, i64)| {
            let (x, y) = (dx as f64 * ux * self.frame.cell_m, -dy as f64 * uy * self.frame.cell_m);
            [centre_m[0] + cos * x - sin * y, centre_m[1] + sin * x + cos * y]
        };
        self.lattice.corners().iter().map(corner).collect()
    }

    /// The cell that contains a point of the floor; it may lie outside the map.
    pub fn cell_at_m(&self, point: PointM) -> Cell {
        let [x, y] = self.frame.to_mosaic(point);
        let (x, y) = (x / self.frame.cell_m, (self.size_m()[1] - y) / self.frame.cell_m);
        match self.lattice {
            Lattice::Square => Cell::new(x.floor() as i32, y.floor() as i32),
            Lattice::Hex => nearest_hex(x, y),
        }
    }

    /// The way from a cell's centre to the next in direction `dir`, as an angle on the floor: radians,
    /// counter-clockwise from East.
    pub fn bearing_rad(&self, dir: crate::lattice::Dir) -> f64 {
        let from = self.lattice.centre(Cell::new(0, 0));
        let to = self.lattice.centre(self.lattice.neighbour(Cell::new(0, 0), dir));
        let (ux, uy) = self.lattice.unit_m();
        let (dx, dy) = ((to.0 - from.0) as f64 * ux, (to.1 - from.1) as f64 * uy);
        (-dy).atan2(dx) + self.frame.yaw_rad
    }
}

/// The number of a cell in row order, from 0; `None` outside `width` × `height` cells.
#[inline]
pub(crate) fn row_index(cell: Cell, width: u32, height: u32) -> Option<usize> {
    // A negative coordinate becomes a huge unsigned one.
    let (x, y) = (cell.x as u32, cell.y as u32);
    (x < width && y < height).then(|| y as usize * width as usize + x as usize)
}

/// Width and height in metres of the box around `width` × `height` cells.
fn mosaic_size_m(lattice: Lattice, cell_m: f64, width: u32, height: u32) -> PointM {
    let (ux, uy) = lattice.unit_m();
    let (across, down) = match lattice {
        Lattice::Square => (2 * i64::from(width), 2 * i64::from(height)),
        // One row alone is not shifted.
        Lattice::Hex => (2 * i64::from(width) + i64::from(height > 1), 3 * i64::from(height) + 1),
    };
    [across as f64 * ux * cell_m, down as f64 * uy * cell_m]
}

/// The hexagon (1 m from side to side) that contains the point, x right and y down from the mosaic's corner:
/// of the cells near the estimated row and column, the one whose centre is nearest.
fn nearest_hex(x: f64, y: f64) -> Cell {
    let (ux, uy) = Lattice::Hex.unit_m();
    let row = (y / (3.0 * uy)).floor() as i32;
    let mut best = (f64::INFINITY, Cell::default());
    for y_cell in row.saturating_sub(1)..=row.saturating_add(1) {
        let column = (x - 0.5 * f64::from(y_cell & 1)).floor() as i32;
        let cell = Cell::new(column, y_cell);
        let (cx, cy) = Lattice::Hex.centre(cell);
        let distance = (cx as f64 * ux - x).powi(2) + (cy as f64 * uy - y).powi(2);
        if distance < best.0 {
            best = (distance, cell);
        }
    }
    best.1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn metres_and_cells_are_inverse() {
        for lattice in Lattice::ALL {
            let frame = Frame { cell_m: 0.35, origin_m: [-3.2, 7.5], yaw_rad: 0.4 };
            let map = Map::random(lattice, 9, 7, 0.0, 1).unwrap().in_frame(frame).unwrap();
            for cell in map.free() {
                let [x, y] = map.centre_m(cell);
                for (dx, dy) in [(0.0, 0.0), (0.17, 0.0), (-0.1, 0.1), (0.0, -0.17)] {
                    assert_eq!(map.cell_at_m([x + dx, y + dy]), cell, "{lattice}");
                }
                for dir in lattice.dirs() {
                    let [nx, ny] = map.centre_m(lattice.neighbour(cell, dir));
                    let bearing = map.bearing_rad(dir);
                    assert!((nx - x - 0.35 * bearing.cos()).abs() < 1e-9);
                    assert!((ny - y - 0.35 * bearing.sin()).abs() < 1e-9);
                }
            }
        }
    }

    #[test]
    fn the_box_holds_every_cell_and_no_more() {
        for lattice in Lattice::ALL {
            for (width, height) in [(1, 1), (4, 1), (3, 4), (5, 5)] {
                let map = Map::random(lattice, width, height, 0.0, 1).unwrap();
                let (ux, uy) = lattice.unit_m();
                let corners = map.free().flat_map(|cell| {
                    let (x, y) = lattice.centre(cell);
                    lattice.corners().iter().map(move |c| ((x + c.0) as f64 * ux, (y + c.1) as f64 * uy))
                });
                let (mut right, mut bottom) = (0f64, 0f64);
                for (x, y) in corners {
                    assert!(x >= -1e-9 && y >= -1e-9);
                    (right, bottom) = (right.max(x), bottom.max(y));
                }
                let [w, h] = map.size_m();
                assert!((right - w).abs() < 1e-9 && (bottom - h).abs() < 1e-9, "{lattice} {width}x{height}");
            }
        }
    }
}
