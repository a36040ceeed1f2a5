//! Re-tiling: an occupancy image becomes cells of a given size in which a robot of a given radius fits.

use super::{BitPlane, Frame, Map, PointM, mosaic_size_m};
use crate::error::Error;
use crate::lattice::{Cell, Lattice};

/// The cells to cover a floor with, and the robot that must fit in them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tiling {
    /// Squares or hexagons.
    pub lattice: Lattice,
    /// A cell from side to side.
    pub cell_m: f64,
    /// The robot's radius. Half a cell is the paper's robot, which fills its cell.
    pub radius_m: f64,
    /// The share of a cell that may be occupied, 0 to 1. At 1 only the robot's own disc counts: a cell is free
    /// if the robot fits at its centre. At 0 nothing occupied may lie anywhere in the cell.
    pub tolerance: f64,
}

/// Touching is not overlapping: a disc may come this close to a wall, in pixels.
const CONTACT_PX: f64 = 1e-6;

impl Map {
    /// Covers the floor of a square map (an occupancy image: its cells are the pixels) with other cells.
    ///
    /// A cell is free if the whole robot fits at its centre and can cross into each free neighbour: a disc of
    /// the radius, moved from centre to centre, overlaps no occupied pixel and stays on the image. Where two
    /// cells are both wide enough but the way between them is not, the one with less room around it becomes an
    /// obstacle, so that the cells alone say where a robot may go.
    ///
    /// The mosaic's top left corner is the image's; the metres of the floor stay what they were.
    ///
    /// # Errors
    /// [`Error::NotSquare`] for a map of hexagons; [`Error::BadValue`] for a tiling out of range;
    /// [`Error::MapTooLarge`] if the cells are too small for this floor.
    ///
    /// ```
    /// use activecell::{Frame, Lattice, Map, Tiling};
    /// let image = Map::parse(Lattice::Square, "......\n......\n..##..\n......\n......")?
    ///     .in_frame(Frame { cell_m: 0.1, ..Frame::default() })?;
    /// let tiling = Tiling { lattice: Lattice::Square, cell_m: 0.2, radius_m: 0.1, tolerance: 1.0 };
    /// assert_eq!(image.retile(&tiling)?.to_text(), "...\n.#.\n###\n"); // the last row leaves the image
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn retile(&self, tiling: &Tiling) -> Result<Self, Error> {
        if self.lattice != Lattice::Square {
            return Err(Error::NotSquare);
        }
        let frame = Frame { cell_m: tiling.cell_m, ..self.frame }.checked()?;
        let bad = |name, value, allowed| Err(Error::BadValue { name, value, allowed });
        if !(0.0..=1e6).contains(&tiling.radius_m) {
            return bad("the robot's radius in metres", tiling.radius_m, "between 0 and 1000000");
        }
        if !(0.0..=1.0).contains(&tiling.tolerance) {
            return bad("the tolerance", tiling.tolerance, "between 0 and 1");
        }
        let (width, height) = mosaic_cells(self.size_m(), tiling);
        let mut obstacles = BitPlane::new(width, height)?;
        let floor = Floor::new(self, tiling);
        floor.block_cells(&mut obstacles);
        floor.block_crossings(&mut obstacles);

        let size_m = mosaic_size_m(tiling.lattice, tiling.cell_m, obstacles.width(), obstacles.height());
        let origin_m = self.frame.to_floor([0.0, self.size_m()[1] - size_m[1]]);
        let tiled = Self::new(tiling.lattice, obstacles).in_frame(Frame { origin_m, ..frame })?;
        let marks = self.marks.iter().map(|&(name, cell)| (name, tiled.cell_at_m(self.centre_m(cell))));
        let marks: Vec<(char, Cell)> = marks.filter(|&(_, cell)| tiled.contains(cell)).collect();
        let tiled = Self { marks: marks.into(), ..tiled };
        Ok(match &self.relief {
            Some((elevation, ground)) => tiled.elevated(elevation.clone(), *ground),
            None => tiled,
        })
    }
}

/// How many columns and rows cover an area; huge numbers saturate and are refused by [`BitPlane::new`].
pub(super) fn mosaic_cells([width_m, height_m]: PointM, tiling: &Tiling) -> (u64, u64) {
    let (_, uy) = tiling.lattice.unit_m();
    // A floor of 3.0000000001 cells has 3.
    let whole = |count: f64| (count - 1e-6).ceil().max(1.0) as u64;
    let rows = match tiling.lattice {
        Lattice::Square => height_m / tiling.cell_m,
        Lattice::Hex => (height_m / tiling.cell_m / uy - 1.0) / 3.0,
    };
    (whole(width_m / tiling.cell_m), whole(rows))
}

/// A point of the image in pixels, x right, y down.
type PointPx = [f64; 2];

/// The image and the robot, in pixels.
struct Floor<'a> {
    image: &'a Map,
    lattice: Lattice,
    /// A cell from side to side.
    cell_px: f64,
    radius_px: f64,
    tolerance: f64,
    room_px2: Vec<u32>,
}

impl<'a> Floor<'a> {
    fn new(image: &'a Map, tiling: &Tiling) -> Self {
        Self {
            image,
            lattice: tiling.lattice,
            cell_px: tiling.cell_m / image.frame.cell_m,
            radius_px: tiling.radius_m / image.frame.cell_m,
            tolerance: tiling.tolerance,
            room_px2: room_px2(image),
        }
    }

    fn block_cells(&self, obstacles: &mut BitPlane) {
        for y in 0..obstacles.height() {
            for x in 0..obstacles.width() {
                let centre = self.centre_px(Cell::new(x as i32, y as i32));
                let free = self.sweep_is_clear(centre, centre)
                    && (self.tolerance >= 1.0 || self.occupied_share(centre) <= self.tolerance + 1e-9);
                obstacles.set(x, y, !free);
            }
        }
    }

    fn block_crossings(&self, obstacles: &mut BitPlane) {
        let (width, height) = (obstacles.width() as i32, obstacles.height() as i32);
        let free = |obstacles: &BitPlane, cell: Cell| {
            (0..width).contains(&cell.x)
                && (0..height).contains(&cell.y)
                && !obstacles.get(cell.x as u32, cell.y as u32)
        };
        // Half of the directions: every pair of neighbours is looked at once.
        let n = self.lattice.degree();
        let onward = self.lattice.dirs().filter(|dir| (n / 4..n / 4 + n / 2).contains(&dir.0));
        let onward: Vec<_> = onward.collect();
        for y in 0..height {
            for x in 0..width {
                let cell = Cell::new(x, y);
                for &dir in &onward {
                    let other = self.lattice.neighbour(cell, dir);
                    if !free(obstacles, cell) || !free(obstacles, other) {
                        continue;
                    }
                    let (a, b) = (self.centre_px(cell), self.centre_px(other));
                    if !self.sweep_is_clear(a, b) {
                        let narrow = if self.room_at(a) < self.room_at(b) { cell } else { other };
                        obstacles.set(narrow.x as u32, narrow.y as u32, true);
                    }
                }
            }
        }
    }

    fn centre_px(&self, cell: Cell) -> PointPx {
        let (ux, uy) = self.lattice.unit_m();
        let (x, y) = self.lattice.centre(cell);
        [x as f64 * ux * self.cell_px, y as f64 * uy * self.cell_px]
    }

    /// How far the pixel under the point is from the nearest occupied one, squared; 0 outside the image.
    fn room_at(&self, [x, y]: PointPx) -> u32 {
        self.image
            .index(Cell::new(x.floor() as i32, y.floor() as i32))
            .map_or(0, |index| self.room_px2[index])
    }

    /// Whether the robot's disc, moved straight from `a` to `b`, stays on the image and overlaps nothing
    /// occupied.
    fn sweep_is_clear(&self, a: PointPx, b: PointPx) -> bool {
        let reach = (self.radius_px - CONTACT_PX).max(CONTACT_PX);
        let (low_x, high_x) = (a[0].min(b[0]) - reach, a[0].max(b[0]) + reach);
        let (low_y, high_y) = (a[1].min(b[1]) - reach, a[1].max(b[1]) + reach);
        let (width, height) = (self.image.width(), self.image.height());
        if low_x < 0.0 || low_y < 0.0 || high_x > f64::from(width) || high_y > f64::from(height) {
            return false;
        }
        // From the centre of the pixel under a point to the point, and from an occupied pixel's centre to its
        // nearest corner, it is at most half a pixel's diagonal each.
        let middle = [f64::midpoint(a[0], b[0]), f64::midpoint(a[1], b[1])];
        let half = (a[0] - b[0]).hypot(a[1] - b[1]) / 2.0;
        let room = f64::from(self.room_at(middle)).sqrt();
        if room - std::f64::consts::SQRT_2 >= self.radius_px.max(CONTACT_PX) + half {
            return true;
        }
        if room + std::f64::consts::SQRT_2 < reach {
            return false;
        }
        let last_row = (high_y.floor() as u32).min(height - 1);
        (low_y.floor() as u32..=last_row).all(|y| {
            let mut x = low_x.floor() as u32;
            while let Some(hit) = self.image.obstacles.first_one(y, x, high_x.floor() as u32 + 1) {
                if segment_to_pixel(a, b, hit, y) < reach {
                    return false;
                }
                x = hit + 1;
            }
            true
        })
    }

    /// The share of the cell's area that is occupied or outside the image.
    fn occupied_share(&self, centre: PointPx) -> f64 {
        let (ux, uy) = self.lattice.unit_m();
        let corners = self.lattice.corners().iter();
        let cell: Vec<PointPx> = corners
            .map(|&(x, y)| {
                [centre[0] + x as f64 * ux * self.cell_px, centre[1] + y as f64 * uy * self.cell_px]
            })
            .collect();
        let bounds = |axis: usize| {
            let low = cell.iter().map(|corner| corner[axis]).fold(f64::INFINITY, f64::min);
            let high = cell.iter().map(|corner| corner[axis]).fold(f64::NEG_INFINITY, f64::max);
            (low.floor() as i32, high.ceil() as i32)
        };
        let ((left, right), (top, bottom)) = (bounds(0), bounds(1));
        let mut occupied = 0.0;
        for y in top..bottom {
            for x in left..right {
                if !self.image.is_free(Cell::new(x, y)) {
                    occupied += area(&inside_pixel(&cell, f64::from(x), f64::from(y)));
                }
            }
        }
        occupied / area(&cell)
    }
}

/// The part of a convex shape that lies in a pixel (Sutherland and Hodgman 1974: one side after the other).
fn inside_pixel(shape: &[PointPx], left: f64, top: f64) -> Vec<PointPx> {
    let mut shape = shape.to_vec();
    for (axis, limit, sign) in [(0, left, 1.0), (0, left + 1.0, -1.0), (1, top, 1.0), (1, top + 1.0, -1.0)] {
        let depth = |point: PointPx| sign * (point[axis] - limit);
        let mut kept = Vec::with_capacity(shape.len() + 1);
        for (i, &b) in shape.iter().enumerate() {
            let a = shape[(i + shape.len() - 1) % shape.len()];
            let (from, to) = (depth(a), depth(b));
            if (from < 0.0) != (to < 0.0) {
                let along = from / (from - to);
                kept.push([a[0] + along * (b[0] - a[0]), a[1] + along * (b[1] - a[1])]);
            }
            if to >= 0.0 {
                kept.push(b);
            }
        }
        shape = kept;
    }
    shape
}

fn area(shape: &[PointPx]) -> f64 {
    let next = |i: usize| shape[(i + 1) % shape.len()];
    let twice: f64 = shape.iter().enumerate().map(|(i, a)| a[0] * next(i)[1] - next(i)[0] * a[1]).sum();
    twice.abs() / 2.0
}

/// More pixels than a robot is wide.
const FAR: u32 = 1 << 15;

/// For each pixel the distance from its centre to that of the nearest occupied one, squared and exact, at most
/// [`FAR`]² along the columns (A. Meijster, J. Roerdink, W. Hesselink, *A General Algorithm for Computing Distance
/// Transforms in Linear Time*, 2000): along the columns, then along each row as the lower envelope of parabolas.
fn room_px2(image: &Map) -> Vec<u32> {
    let (width, height) = (image.width() as usize, image.height() as usize);
    let mut room = vec![FAR; width * height];
    let mut learn = |y: usize, from: Option<usize>| {
        for x in 0..width {
            let near = from.map_or(FAR, |from| room[from * width + x] + 1);
            let here = &mut room[y * width + x];
            *here = if image.obstacles.get(x as u32, y as u32) { 0 } else { near.min(*here) };
        }
    };
    (0..height).for_each(|y| learn(y, y.checked_sub(1)));
    (0..height).rev().for_each(|y| learn(y, Some(y + 1).filter(|&below| below < height)));
    room.chunks_mut(width).for_each(envelope);
    room
}

/// From distances along the columns to squared distances, for one row.
fn envelope(row: &mut [u32]) {
    let up: Vec<i64> = row.iter().map(|&steps| i64::from(steps).pow(2)).collect();
    let at = |x: i64, of: usize| (x - of as i64).pow(2) + up[of];
    // Parabolas of the envelope, and the column from which each is the lowest.
    let mut lowest: Vec<(usize, i64)> = Vec::new();
    for here in 0..row.len() {
        while lowest.last().is_some_and(|&(other, from)| at(from, other) > at(from, here)) {
            lowest.pop();
        }
        let from = lowest.last().map_or(0, |&(other, _)| {
            let (i, u) = (other as i64, here as i64);
            1 + (u * u - i * i + up[here] - up[other]).div_euclid(2 * (u - i))
        });
        if from < row.len() as i64 {
            lowest.push((here, from));
        }
    }
    for (x, cell) in row.iter_mut().enumerate().rev() {
        while lowest.len() > 1 && lowest[lowest.len() - 1].1 > x as i64 {
            lowest.pop();
        }
        *cell = at(x as i64, lowest[lowest.len() - 1].0).min(i64::from(u32::MAX)) as u32;
    }
}

/// The distance from the segment `a`–`b` to the pixel in column `x` of row `y`.
fn segment_to_pixel(a: PointPx, b: PointPx, x: u32, y: u32) -> f64 {
    let (left, top) = (f64::from(x), f64::from(y));
    let (right, bottom) = (left + 1.0, top + 1.0);
    if segment_meets_box(a, b, [left, top], [right, bottom]) {
        return 0.0;
    }
    let to_box = |p: PointPx| {
        let dx = (left - p[0]).max(p[0] - right).max(0.0);
        let dy = (top - p[1]).max(p[1] - bottom).max(0.0);
        dx.hypot(dy)
    };
    let corners = [[left, top], [right, top], [left, bottom], [right, bottom]];
    corners.iter().map(|&corner| point_to_segment(corner, a, b)).fold(to_box(a).min(to_box(b)), f64::min)
}

fn point_to_segment(p: PointPx, a: PointPx, b: PointPx) -> f64 {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let length2 = dx * dx + dy * dy;
    let along = if length2 > 0.0 { ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / length2 } else { 0.0 };
    let along = along.clamp(0.0, 1.0);
    (p[0] - a[0] - along * dx).hypot(p[1] - a[1] - along * dy)
}

/// Whether a segment meets a box: it is clipped by the box's four sides (Liang and Barsky 1984).
fn segment_meets_box(a: PointPx, b: PointPx, low: PointPx, high: PointPx) -> bool {
    let (mut enter, mut leave) = (0.0f64, 1.0f64);
    for axis in 0..2 {
        let delta = b[axis] - a[axis];
        if delta == 0.0 {
            if a[axis] < low[axis] || a[axis] > high[axis] {
                return false;
            }
            continue;
        }
        let (t0, t1) = ((low[axis] - a[axis]) / delta, (high[axis] - a[axis]) / delta);
        enter = enter.max(t0.min(t1));
        leave = leave.min(t0.max(t1));
    }
    enter <= leave
}

#[cfg(test)]
mod tests {
    use super::*;

    fn floor_of(image: &Map, tiling: &Tiling) -> (Map, Vec<[f64; 4]>) {
        let tiled = image.retile(tiling).unwrap();
        let squares = (0..image.height())
            .flat_map(|y| (0..image.width()).map(move |x| (x, y)))
            .filter(|&(x, y)| image.obstacles().get(x, y))
            .map(|(x, y)| {
                let [cx, cy] = image.centre_m(Cell::new(x as i32, y as i32));
                let half = image.frame().cell_m / 2.0;
                [cx - half, cy - half, cx + half, cy + half]
            })
            .collect();
        (tiled, squares)
    }

    /// Sampled, in metres, knowing nothing of pixels: how close does the way from `a` to `b` come to a square?
    fn closest(a: [f64; 2], b: [f64; 2], squares: &[[f64; 4]]) -> f64 {
        let mut closest = f64::INFINITY;
        for i in 0..=20 {
            let t = f64::from(i) / 20.0;
            let (x, y) = (a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t);
            for s in squares {
                let (dx, dy) = ((s[0] - x).max(x - s[2]).max(0.0), (s[1] - y).max(y - s[3]).max(0.0));
                closest = closest.min(dx.hypot(dy));
            }
        }
        closest
    }

    #[test]
    fn every_free_cell_and_crossing_is_clear_and_no_other_is_blocked_without_reason() {
        for seed in 0..60 {
            let frame = Frame { cell_m: 0.1, origin_m: [1.0, -2.0], yaw_rad: 0.0 };
            let density = [0.004, 0.02, 0.1][seed as usize % 3];
            let image = Map::random(Lattice::Square, 60, 45, density, seed).unwrap().in_frame(frame).unwrap();
            let lattice = Lattice::ALL[seed as usize % 2];
            let cell_m = [0.13, 0.25, 0.5][seed as usize / 2 % 3];
            let radius_m = [0.0, 0.06, 0.125, 0.25][seed as usize / 6 % 4];
            let tiling = Tiling { lattice, cell_m, radius_m, tolerance: 1.0 };
            let (tiled, squares) = floor_of(&image, &tiling);
            let mut free_fits = 0;
            for y in 0..tiled.height() as i32 {
                for x in 0..tiled.width() as i32 {
                    let cell = Cell::new(x, y);
                    let a = tiled.centre_m(cell);
                    // A robot that is a point may still not stand on the image's edge.
                    let reach = if radius_m > 0.0 { radius_m - 1e-9 } else { 1e-9 };
                    let inside = (reach..=6.0 - reach).contains(&(a[0] - 1.0))
                        && (reach..=4.5 - reach).contains(&(a[1] + 2.0));
                    let distance = closest(a, a, &squares);
                    let fits = inside && distance >= (radius_m - 1e-7).max(1e-9);
                    if !tiled.is_free(cell) {
                        let crossing_blocked = lattice.dirs().any(|dir| {
                            let other = lattice.neighbour(cell, dir);
                            tiled.contains(other)
                                && closest(a, tiled.centre_m(other), &squares) < radius_m + 0.005
                        });
                        assert!(!fits || crossing_blocked, "{cell} of {tiling:?} is blocked for nothing");
                        continue;
                    }
                    assert!(fits, "the robot does not fit in {cell} of {tiling:?}");
                    free_fits += 1;
                    for dir in lattice.dirs() {
                        let other = lattice.neighbour(cell, dir);
                        if tiled.is_free(other) {
                            let distance = closest(a, tiled.centre_m(other), &squares);
                            assert!(distance >= radius_m - 1e-7, "{cell} to {other} of {tiling:?}");
                        }
                    }
                }
            }
            assert!(free_fits > 0 || radius_m > 0.1 && density > 0.01, "{tiling:?} {density}");
        }
    }

    #[test]
    fn tolerance_counts_what_lies_in_the_cell() {
        // One of the sixteen pixels of the cell is occupied, in its corner; the robot itself does not touch it.
        let image = Map::parse(Lattice::Square, "#...\n....\n....\n....").unwrap();
        let tiling = |tolerance| Tiling { lattice: Lattice::Square, cell_m: 4.0, radius_m: 1.0, tolerance };
        assert_eq!(image.retile(&tiling(1.0)).unwrap().free_cells(), 1);
        assert_eq!(image.retile(&tiling(0.0625)).unwrap().free_cells(), 1);
        assert_eq!(image.retile(&tiling(0.06)).unwrap().free_cells(), 0);
    }

    #[test]
    fn no_tolerance_means_that_nothing_reaches_into_a_cell() {
        // The pixel (4,2) reaches into the cell from x 4.8 on by a fifth of its width only.
        let image = Map::parse(Lattice::Square, "......\n......\n....#.\n......\n......\n......").unwrap();
        let tiling = |tolerance| Tiling { lattice: Lattice::Square, cell_m: 1.6, radius_m: 0.1, tolerance };
        let cell = Cell::new(3, 1);
        assert!(image.retile(&tiling(1.0)).unwrap().is_free(cell));
        assert!(!image.retile(&tiling(0.0)).unwrap().is_free(cell));
    }

    #[test]
    fn room_is_the_distance_to_the_nearest_pixel() {
        for seed in 0..200 {
            let (width, height) = (1 + seed as u32 % 17, 1 + seed as u32 / 17);
            let density = [0.0, 0.02, 0.2, 0.9][seed as usize % 4];
            let image = Map::random(Lattice::Square, width, height, density, seed).unwrap();
            let occupied: Vec<(u32, u32)> = (0..height)
                .flat_map(|y| (0..width).map(move |x| (x, y)))
                .filter(|&(x, y)| image.obstacles().get(x, y))
                .collect();
            for (i, &room) in room_px2(&image).iter().enumerate() {
                let (x, y) = (i as u32 % width, i as u32 / width);
                let nearest = occupied.iter().map(|o| o.0.abs_diff(x).pow(2) + o.1.abs_diff(y).pow(2)).min();
                assert_eq!(room, nearest.unwrap_or(FAR * FAR), "{}", image.to_text());
            }
        }
    }

    #[test]
    fn a_floor_can_be_too_large_for_its_cells() {
        let image = Map::parse(Lattice::Square, "..\n..").unwrap();
        let tiling = Tiling { lattice: Lattice::Hex, cell_m: 1e-5, radius_m: 0.0, tolerance: 1.0 };
        assert!(matches!(image.retile(&tiling), Err(Error::MapTooLarge { .. })));
        assert_eq!(image.clone().on(Lattice::Hex).retile(&tiling), Err(Error::NotSquare));
        let nan = Tiling { cell_m: f64::NAN, ..tiling };
        assert!(matches!(image.retile(&nan), Err(Error::BadValue { .. })));
    }
}
