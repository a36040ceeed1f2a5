//! Ways over the ground: how long a straight way is, how it rises, and how steep it is along and across.

use super::elevation::{Elevation, along};
use super::{BitPlane, Frame, Map, PointM, Tiling, mosaic_size_m};
use crate::error::Error;
use crate::lattice::{Cell, Lattice};

/// What counts as the length of a step over uneven ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Ground {
    /// The straight line from the ground at one cell's centre to the ground at the next: √(d² + Δz²).
    Segments,
    /// The way over the interpolated surface: the integral of √(1 + z′²).
    #[default]
    Surface,
}

impl Ground {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Segments, Self::Surface];

    /// The name on the command line and in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Segments => "segments",
            Self::Surface => "surface",
        }
    }
}

/// What the ground does under a straight way on the map. Slopes are in metres a metre.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Profile {
    /// The way's length on the map.
    pub length_m: f64,
    /// Its length over the surface: the integral of √(1 + z′²).
    pub surface_m: f64,
    /// How much higher its end is than its start.
    pub rise_m: f64,
    /// All its climbs together; what goes down again is not taken off.
    pub climb_m: f64,
    /// The steepest place upwards; 0 if it only falls.
    pub up: f64,
    /// The steepest place downwards; 0 if it only rises.
    pub down: f64,
    /// The steepest place across it, to either side.
    pub across: f64,
}

impl Profile {
    /// The same way driven back.
    #[must_use]
    pub fn back(self) -> Self {
        let (rise_m, climb_m) = (-self.rise_m, self.climb_m - self.rise_m);
        Self { rise_m, climb_m: climb_m.max(0.0), up: self.down, down: self.up, ..self }
    }

    /// The length on the ground.
    pub fn ground_m(&self, ground: Ground) -> f64 {
        match ground {
            Ground::Segments => self.length_m.hypot(self.rise_m),
            Ground::Surface => self.surface_m,
        }
    }

    /// Adds a piece in which the slope goes evenly from `begin` to `end`, the height so along a parabola.
    fn add(&mut self, length_m: f64, [begin, end]: [f64; 2], across: f64) {
        self.surface_m += length_m * mean_stretch(begin, end);
        self.climb_m += length_m * mean_climb(begin, end);
        self.up = self.up.max(begin).max(end);
        self.down = self.down.max(-begin).max(-end);
        self.across = self.across.max(across);
    }
}

/// The mean of √(1 + s²) for slopes s from `a` to `b`: its integral is (s √(1 + s²) + asinh s) ÷ 2.
fn mean_stretch(a: f64, b: f64) -> f64 {
    let stretch = |s: f64| s.hypot(1.0);
    if (b - a).abs() < 1e-3 {
        // The difference of two nearly equal numbers would be noise; Simpson's rule is exact to 16 digits here.
        return (stretch(a) + 4.0 * stretch(f64::midpoint(a, b)) + stretch(b)) / 6.0;
    }
    let integral = |s: f64| f64::midpoint(s * stretch(s), s.asinh());
    (integral(b) - integral(a)) / (b - a)
}

/// The mean of what is positive of the slopes from `a` to `b`.
fn mean_climb(a: f64, b: f64) -> f64 {
    let (low, high) = (a.min(b), a.max(b));
    if low >= 0.0 || high <= 0.0 {
        return f64::midpoint(low, high).max(0.0);
    }
    high * high / (2.0 * (high - low))
}

impl Elevation {
    /// The ground under the straight way between two points; `None` if its height is not known all along.
    ///
    /// The way is cut where it crosses the lines between posts. In each piece the surface is bilinear: slopes along
    /// and across change evenly, so that their steepest is at one of its ends and no wall, however thin, is missed;
    /// the height follows a parabola, whose length has a closed form. A way that runs along a line of posts has its
    /// slope across from the means of both sides.
    ///
    /// ```
    /// use activecell::{Elevation, Posts};
    /// // A ridge of 1 m across the way.
    /// let ground = Elevation::new(3, 1, vec![0.0, 1.0, 0.0], Posts::default())?;
    /// let profile = ground.profile([0.5, 0.5], [2.5, 0.5]).unwrap();
    /// assert_eq!((profile.length_m, profile.rise_m, profile.climb_m), (2.0, 0.0, 1.0));
    /// assert!((profile.surface_m - 2.0 * 2f64.sqrt()).abs() < 1e-12);
    /// assert_eq!((profile.up, profile.down, profile.across), (1.0, 1.0, 0.0));
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn profile(&self, from: PointM, to: PointM) -> Option<Profile> {
        let length_m = (to[0] - from[0]).hypot(to[1] - from[1]);
        let (begin, end) = (self.in_posts(from), self.in_posts(to));
        let rise_m = self.height_m(to)? - self.height_m(from)?;
        let mut profile = Profile { length_m, rise_m, ..Profile::default() };
        if length_m == 0.0 {
            return Some(profile);
        }
        let towards = (to[1] - from[1]).atan2(to[0] - from[0]) - self.posts().yaw_rad;
        let at = |part: f64| [0, 1].map(|axis| begin[axis] + part * (end[axis] - begin[axis]));
        let mut done = 0.0;
        while done < 1.0 {
            let next = (0..2).map(|axis| next_line(begin[axis], end[axis], done)).fold(1.0, f64::min);
            let slopes = self.slopes(at(done), at(next), towards)?;
            let [(along_begin, across_begin), (along_end, across_end)] = slopes;
            profile.add(
                (next - done) * length_m,
                [along_begin, along_end],
                across_begin.abs().max(across_end.abs()),
            );
            done = next;
        }
        Some(profile)
    }

    /// The slopes along and across at both ends of a piece that crosses no line of posts.
    fn slopes(&self, begin: [f64; 2], end: [f64; 2], towards: f64) -> Option<[(f64, f64); 2]> {
        let size = [self.columns(), self.rows()];
        let middle: [f64; 2] = std::array::from_fn(|axis| f64::midpoint(begin[axis], end[axis]));
        let (column, row) = (along(middle[0], size[0])?.0, along(middle[1], size[1])?.0);
        // Along a line of posts the surface has an edge: the patches on both sides count alike.
        let on_line = |axis: usize, first: u32| {
            let near = |place: f64| (place - f64::from(first)).abs() < 1e-9;
            first > 0 && near(begin[axis]) && near(end[axis])
        };
        let beside = match (on_line(0, column), on_line(1, row)) {
            (true, _) => self.patch(column - 1, row).map(|patch| (patch, [column - 1, row])),
            (_, true) => self.patch(column, row - 1).map(|patch| (patch, [column, row - 1])),
            _ => None,
        };
        let own = self.patch(column, row).map(|patch| (patch, [column, row]));
        let count = f64::from(u8::from(own.is_some()) + u8::from(beside.is_some()));
        let (sin, cos) = towards.sin_cos();
        let slope = |at: [f64; 2]| {
            let sum = own.iter().chain(&beside).fold([0.0; 2], |sum, (patch, [column, row])| {
                let [x, y] = patch.slope([at[0] - f64::from(*column), at[1] - f64::from(*row)]);
                [sum[0] + x / count, sum[1] + y / count]
            });
            (sum[0] * cos + sum[1] * sin, sum[1] * cos - sum[0] * sin)
        };
        (count > 0.0).then(|| [slope(begin), slope(end)])
    }
}

/// The part of the way, more than `done`, at which it crosses the next whole number; 1 if there is none.
fn next_line(begin: f64, end: f64, done: f64) -> f64 {
    let step = end - begin;
    if step.abs() < 1e-9 {
        return 1.0;
    }
    let place = begin + done * step;
    // Rounding may leave the place a little before the line that it has just reached.
    let line = if step > 0.0 { (place + 1e-9).floor() + 1.0 } else { (place - 1e-9).ceil() - 1.0 };
    let part = (line - begin) / step;
    if part > done && part < 1.0 - 1e-12 { part } else { 1.0 }
}

impl Map {
    /// The map with the heights of its ground, from which lengths are then counted. Cells whose centre has no known
    /// height become obstacles.
    ///
    /// ```
    /// use activecell::{Cell, Elevation, Ground, Lattice, Map, Posts};
    /// let ramp = Elevation::new(4, 1, vec![0.0, 0.75, 1.5, f32::NAN], Posts::default())?;
    /// let map = Map::parse(Lattice::Square, "....")?.elevated(ramp, Ground::Surface);
    /// assert_eq!(map.to_text(), "...#\n");
    /// assert_eq!(map.ground_m(&[Cell::new(0, 0), Cell::new(1, 0), Cell::new(2, 0)]), 2.5);
    /// # Ok::<(), activecell::Error>(())
    /// ```
    #[must_use]
    pub fn elevated(mut self, elevation: Elevation, ground: Ground) -> Self {
        let unknown: Vec<Cell> =
            self.free().filter(|&cell| elevation.height_m(self.centre_m(cell)).is_none()).collect();
        for cell in unknown {
            self.set_obstacle(cell, true);
        }
        self.relief = Some((elevation, ground));
        self
    }

    /// A map of the elevation's whole area: cells whose centre has a height are free. Of squares as large as the
    /// distance of its posts, cells are posts.
    ///
    /// # Errors
    /// [`Error::MapTooLarge`], or [`Error::BadValue`] for the cell size.
    pub fn over(elevation: Elevation, lattice: Lattice, cell_m: f64, ground: Ground) -> Result<Self, Error> {
        let &super::Posts { corner_m, yaw_rad, .. } = elevation.posts();
        let frame = Frame { cell_m, origin_m: corner_m, yaw_rad }.checked()?;
        let size_m = elevation.size_m();
        let tiling = Tiling { lattice, cell_m, radius_m: 0.0, tolerance: 1.0 };
        let (width, height) = super::retile::mosaic_cells(size_m, &tiling);
        let map = Self::new(lattice, BitPlane::new(width, height)?);
        // The upper left corners meet; the mosaic may reach further down and right.
        let reach_m = mosaic_size_m(lattice, cell_m, map.width(), map.height())[1];
        let origin_m = frame.to_floor([0.0, size_m[1] - reach_m]);
        Ok(map.in_frame(Frame { origin_m, ..frame })?.elevated(elevation, ground))
    }

    /// The heights of the ground, if they are known.
    pub const fn elevation(&self) -> Option<&Elevation> {
        match &self.relief {
            Some((elevation, _)) => Some(elevation),
            None => None,
        }
    }

    /// What counts as the length of a step; without an elevation both are the same.
    pub fn ground(&self) -> Ground {
        self.relief.as_ref().map_or(Ground::default(), |relief| relief.1)
    }

    /// The ground under the straight way between the centres of two cells: flat without an elevation, `None` where
    /// a height is missing.
    pub fn profile(&self, from: Cell, to: Cell) -> Option<Profile> {
        let (from_m, to_m) = (self.centre_m(from), self.centre_m(to));
        match self.elevation() {
            Some(elevation) => elevation.profile(from_m, to_m),
            None => Some(self.flat(from_m, to_m)),
        }
    }

    /// As [`Map::profile`], and where a height is missing as if the ground were flat there.
    pub fn profile_or_flat(&self, from: Cell, to: Cell) -> Profile {
        self.profile(from, to).unwrap_or_else(|| self.flat(self.centre_m(from), self.centre_m(to)))
    }

    fn flat(&self, from_m: PointM, to_m: PointM) -> Profile {
        let apart_m = (to_m[0] - from_m[0]).hypot(to_m[1] - from_m[1]);
        // The distance of neighbours is the cell size to the last digit.
        let near = (apart_m - self.frame().cell_m).abs() < 1e-6 * self.frame().cell_m;
        let length_m = if near { self.frame().cell_m } else { apart_m };
        Profile { length_m, surface_m: length_m, ..Profile::default() }
    }

    /// All climbs of a way from cell to cell, in metres; what goes down again is not taken off.
    pub fn climb_m(&self, cells: &[Cell]) -> f64 {
        if self.relief.is_none() {
            return 0.0;
        }
        let climbs = cells.windows(2).map(|pair| self.profile_or_flat(pair[0], pair[1]).climb_m);
        climbs.fold(0.0, |sum, climb_m| sum + climb_m)
    }

    /// The length on the ground of a way from cell to cell.
    pub fn ground_m(&self, cells: &[Cell]) -> f64 {
        if self.relief.is_none() {
            return cells.len().saturating_sub(1) as f64 * self.frame().cell_m;
        }
        let steps = cells.windows(2).map(|pair| self.profile_or_flat(pair[0], pair[1]));
        steps.map(|profile| profile.ground_m(self.ground())).fold(0.0, |sum, length_m| sum + length_m)
    }
}
