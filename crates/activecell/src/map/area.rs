//! Areas in metres: which cells a polygon on the floor touches.

use super::{Map, PointM};
use crate::error::Error;
use crate::lattice::{Cell, Lattice};

/// Two areas that share less than this (in half cells) only touch.
const SLACK: f64 = 1e-9;

impl Map {
    /// The cells, free or not, that share more than a border with a polygon on the floor, in row order: for
    /// keep-out areas, lanes, and slow zones.
    ///
    /// The corners go around in either direction; the last joins the first. Where a polygon crosses itself, a place
    /// is inside if a ray from it crosses the border an odd number of times. Parts outside the map have no cells.
    ///
    /// # Errors
    /// [`Error::BadValue`] if a corner is not a number of at most a thousand million, or there are fewer than three.
    ///
    /// ```
    /// use activecell::{Cell, Lattice, Map};
    /// let map = Map::parse(Lattice::Square, "....\n....\n....")?; // cells of 1 m
    /// let touched = map.cells_touching_m(&[[1.0, 1.0], [2.5, 1.0], [2.5, 2.0], [1.0, 2.0]])?;
    /// assert_eq!(touched, [Cell::new(1, 1), Cell::new(2, 1)]);
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn cells_touching_m(&self, polygon: &[PointM]) -> Result<Vec<Cell>, Error> {
        if polygon.len() < 3 {
            let allowed = "at least 3";
            return Err(Error::BadValue {
                name: "the number of corners",
                value: polygon.len() as f64,
                allowed,
            });
        }
        for &value in polygon.iter().flatten() {
            if !(-1e9..=1e9).contains(&value) {
                let allowed = "a number of at most a thousand million";
                return Err(Error::BadValue { name: "a corner's place in metres", value, allowed });
            }
        }
        let corners: Vec<[f64; 2]> = polygon.iter().map(|&point| self.units(point)).collect();
        let sides = || corners.iter().copied().zip(corners.iter().copied().cycle().skip(1));
        let mut cells = Vec::new();
        for y in self.rows_between(&corners) {
            self.cells_inside(y, sides(), &mut cells);
            for side in sides() {
                self.cells_crossed(y, side, &mut cells);
            }
        }
        cells.sort_unstable_by_key(|cell| (cell.y, cell.x));
        cells.dedup();
        Ok(cells)
    }

    /// A point of the floor in the units of [`Lattice::centre`].
    fn units(&self, point: PointM) -> [f64; 2] {
        let (ux, uy) = self.lattice.unit_m();
        let [x, y] = self.frame.to_mosaic(point);
        [x / (ux * self.frame.cell_m), (self.size_m()[1] - y) / (uy * self.frame.cell_m)]
    }

    /// The map's rows that a polygon can touch.
    fn rows_between(&self, corners: &[[f64; 2]]) -> std::ops::Range<i32> {
        // Rows are 2 units apart on squares, 3 on hexagons; a hexagon reaches into the rows beside its own.
        let apart = (self.lattice.centre(Cell::new(0, 1)).1 - self.lattice.centre(Cell::new(0, 0)).1) as f64;
        let highest = corners.iter().fold(f64::INFINITY, |least, corner| least.min(corner[1]));
        let lowest = corners.iter().fold(f64::NEG_INFINITY, |most, corner| most.max(corner[1]));
        let row = |units: f64| (units / apart).floor() as i32;
        let from = row(highest).saturating_sub(1).clamp(0, self.height() as i32);
        from..row(lowest).saturating_add(2).clamp(from, self.height() as i32)
    }

    /// The map's columns of row `y` whose centres lie between `left` and `right`.
    fn columns_between(&self, y: i32, left: f64, right: f64) -> std::ops::Range<i32> {
        let first = self.lattice.centre(Cell::new(0, y)).0 as f64;
        let from = (((left - first) / 2.0).ceil() as i32).clamp(0, self.width() as i32);
        from..(((right - first) / 2.0).floor() as i32).saturating_add(1).clamp(from, self.width() as i32)
    }

    /// The cells of row `y` whose centres lie inside the polygon.
    fn cells_inside(&self, y: i32, sides: impl Iterator<Item = ([f64; 2], [f64; 2])>, cells: &mut Vec<Cell>) {
        let height = self.lattice.centre(Cell::new(0, y)).1 as f64;
        let mut crossings: Vec<f64> = sides
            .filter(|(a, b)| (a[1] <= height) != (b[1] <= height))
            .map(|(a, b)| a[0] + (height - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
            .collect();
        crossings.sort_by(f64::total_cmp);
        for pair in crossings.chunks_exact(2) {
            let columns = self.columns_between(y, pair[0] + SLACK, pair[1] - SLACK);
            cells.extend(columns.map(|x| Cell::new(x, y)));
        }
    }

    /// The cells of row `y` through whose inside the side runs.
    fn cells_crossed(&self, y: i32, (a, b): ([f64; 2], [f64; 2]), cells: &mut Vec<Cell>) {
        let half_height =
            self.lattice.corners().iter().map(|corner| corner.1).max().unwrap_or_default() as f64;
        let height = self.lattice.centre(Cell::new(0, y)).1 as f64;
        let Some((from, to)) = clip(a, b, [0.0, 1.0], height + half_height) else { return };
        let Some((from, to)) = clip(a, b, [0.0, -1.0], half_height - height)
            .map(|(from2, to2)| (from.max(from2), to.min(to2)))
            .filter(|(from, to)| from <= to)
        else {
            return;
        };
        let at = |part: f64| a[0] + part * (b[0] - a[0]);
        let (left, right) = (at(from).min(at(to)), at(from).max(at(to)));
        for x in self.columns_between(y, left - 1.0, right + 1.0) {
            let cell = Cell::new(x, y);
            if crosses(self.lattice, cell, a, b) {
                cells.push(cell);
            }
        }
    }
}

/// Which part of the line from `a` (0) to `b` (1) has at most `most` along `normal`.
fn clip(a: [f64; 2], b: [f64; 2], normal: [f64; 2], most: f64) -> Option<(f64, f64)> {
    let along = |point: [f64; 2]| point[0] * normal[0] + point[1] * normal[1] - most;
    let (begin, end) = (along(a), along(b));
    match (begin <= 0.0, end <= 0.0) {
        (true, true) => Some((0.0, 1.0)),
        (true, false) => Some((0.0, begin / (begin - end))),
        (false, true) => Some((begin / (begin - end), 1.0)),
        (false, false) => None,
    }
}

/// Whether the line from `a` to `b` runs through the inside of the cell (Cyrus and Beck, 1978: clipped at each of
/// its sides).
fn crosses(lattice: Lattice, cell: Cell, a: [f64; 2], b: [f64; 2]) -> bool {
    let (x, y) = lattice.centre(cell);
    let corners = lattice.corners();
    let (mut from, mut to) = (0.0f64, 1.0f64);
    for (here, next) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        // The corners go clockwise with y down, so that this points out of the cell.
        let normal = [(next.1 - here.1) as f64, (here.0 - next.0) as f64];
        let most = normal[0] * (x + here.0) as f64 + normal[1] * (y + here.1) as f64;
        let Some(part) = clip(a, b, normal, most - SLACK) else { return false };
        (from, to) = (from.max(part.0), to.min(part.1));
    }
    from <= to
}
