//! Elevation: the height of the ground on a regular grid of posts, and between them.

use super::{Map, PointM};
use crate::error::Error;
use std::sync::Arc;

/// How the posts of an elevation stand on the floor.
///
/// ```text
///          ┌─────┬─────┬─────┐       Each post stands in the middle of its share of the area: the area begins
///          │  ●  │  ●  │  ●  │       half a post left of the first column and ends half a post right of the
///          ├─────┼─────┼─────┤       last, as pixels do.
///          │  ●  │  ●  │  ●  │
/// corner_m ●─────┴─────┴─────┘
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Posts {
    /// From column to column and from row to row.
    pub apart_m: [f64; 2],
    /// The lower left corner of the area.
    pub corner_m: PointM,
    /// How far the grid is turned about that corner, counter-clockwise.
    pub yaw_rad: f64,
}

impl Default for Posts {
    /// Posts 1 m apart, the corner at (0, 0), not turned.
    fn default() -> Self {
        Self { apart_m: [1.0, 1.0], corner_m: [0.0, 0.0], yaw_rad: 0.0 }
    }
}

/// The height of the ground in metres, on posts and between them. A value: cheap to clone, never changed.
///
/// Between four posts the height is bilinear; in the half post around the outermost posts the last slope goes on.
///
/// ```
/// use activecell::{Elevation, Posts};
/// let ground = Elevation::new(3, 2, vec![0.0, 1.0, 4.0, 0.0, 1.0, f32::NAN], Posts::default())?;
/// assert_eq!(ground.height_m([0.5, 1.5]), Some(0.0)); // the first post, on top
/// assert_eq!(ground.height_m([1.0, 1.0]), Some(0.5));
/// assert_eq!(ground.height_m([2.0, 1.0]), None); // beside a post that has no height
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Elevation {
    columns: u32,
    rows: u32,
    heights_m: Arc<[f32]>,
    posts: Posts,
}

/// Nearer to a line of posts than this share of their distance is on it.
const ON_LINE: f64 = 1e-6;

impl Elevation {
    /// The most posts that an elevation may have.
    pub const MAX_POSTS: u64 = 1 << 27;

    /// An elevation of these heights, row by row from the top; a post without a height is no number (NaN).
    ///
    /// # Errors
    /// [`Error::BadValue`] if there are no posts, more than [`Elevation::MAX_POSTS`], or not as many heights as
    /// posts; if a height is infinite, or the grid's numbers make no sense.
    pub fn new(columns: u32, rows: u32, heights_m: Vec<f32>, posts: Posts) -> Result<Self, Error> {
        let bad = |name, value, allowed| Err(Error::BadValue { name, value, allowed });
        let count = u64::from(columns) * u64::from(rows);
        if !(1..=Self::MAX_POSTS).contains(&count) {
            return bad("the number of posts of the elevation", count as f64, "between 1 and 134217728");
        }
        if heights_m.len() as u64 != count {
            return bad("the number of heights", heights_m.len() as f64, "columns × rows");
        }
        if let Some(&height) = heights_m.iter().find(|height| height.abs() > 1e6) {
            return bad("a height in metres", height.into(), "between -1000000 and 1000000, or NaN for none");
        }
        for apart_m in posts.apart_m {
            if !(1e-6..=1e6).contains(&apart_m) {
                return bad("the metres between posts", apart_m, "between 0.000001 and 1000000");
            }
        }
        for value in [posts.corner_m[0], posts.corner_m[1], posts.yaw_rad] {
            if !(-1e9..=1e9).contains(&value) {
                return bad("the elevation's corner", value, "a number of at most a thousand million");
            }
        }
        Ok(Self { columns, rows, heights_m: heights_m.into(), posts })
    }

    /// The same heights laid over a map, corner to corner.
    ///
    /// # Errors
    /// [`Error::BadValue`] if the posts come to stand too close.
    pub fn laid_over(self, map: &Map) -> Result<Self, Error> {
        let ([width_m, height_m], frame) = (map.size_m(), map.frame());
        let apart_m = [width_m / f64::from(self.columns), height_m / f64::from(self.rows)];
        self.standing(Posts { apart_m, corner_m: frame.origin_m, yaw_rad: frame.yaw_rad })
    }

    /// The same heights on posts that stand elsewhere.
    ///
    /// # Errors
    /// As [`Elevation::new`].
    pub fn standing(self, posts: Posts) -> Result<Self, Error> {
        let empty = Self::new(1, 1, vec![0.0], posts)?;
        Ok(Self { posts: empty.posts, ..self })
    }

    /// Columns of posts.
    pub const fn columns(&self) -> u32 {
        self.columns
    }

    /// Rows of posts.
    pub const fn rows(&self) -> u32 {
        self.rows
    }

    /// How the posts stand.
    pub const fn posts(&self) -> &Posts {
        &self.posts
    }

    /// All heights, row by row from the top; NaN where there is none.
    pub fn heights_m(&self) -> &[f32] {
        &self.heights_m
    }

    /// Width and height of the area that the posts stand for.
    pub fn size_m(&self) -> PointM {
        [f64::from(self.columns) * self.posts.apart_m[0], f64::from(self.rows) * self.posts.apart_m[1]]
    }

    /// The height of the ground there; `None` outside the area and beside posts without a height.
    pub fn height_m(&self, point: PointM) -> Option<f64> {
        let [u, v] = self.in_posts(point);
        let ((column, right), (row, down)) = (along(u, self.columns)?, along(v, self.rows)?);
        let mut height_m = 0.0;
        for (x, across) in [(column, 1.0 - right), (column + 1, right)] {
            for (y, share) in [(row, across * (1.0 - down)), (row + 1, across * down)] {
                // A post that has no share need not exist.
                if share != 0.0 {
                    height_m += share * self.post_m(x, y)?;
                }
            }
        }
        Some(height_m)
    }

    /// The lowest and the highest post; `None` if no post has a height.
    pub fn range_m(&self) -> Option<[f64; 2]> {
        let known = || self.heights_m.iter().copied().filter(|height| !height.is_nan());
        let (low, high) = (known().reduce(f32::min)?, known().reduce(f32::max)?);
        Some([low.into(), high.into()])
    }

    /// The steepest slope of the surface anywhere, in degrees; 0 if no four posts beside each other have heights.
    ///
    /// Between four posts the steepest place is a post.
    pub fn steepest_deg(&self) -> f64 {
        let mut steepest = 0.0f64;
        for row in 0..self.rows.saturating_sub(1).max(1) {
            for column in 0..self.columns.saturating_sub(1).max(1) {
                let Some(patch) = self.patch(column, row) else { continue };
                for corner in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]] {
                    let [x, y] = patch.slope(corner);
                    steepest = steepest.max(x.hypot(y));
                }
            }
        }
        steepest.atan().to_degrees()
    }

    /// A point in columns and rows of posts: 0 is the first column and the top row. On a line of posts the number is
    /// whole.
    pub fn in_posts(&self, [x, y]: PointM) -> [f64; 2] {
        let (sin, cos) = self.posts.yaw_rad.sin_cos();
        let (dx, dy) = (x - self.posts.corner_m[0], y - self.posts.corner_m[1]);
        let column = (cos * dx + sin * dy) / self.posts.apart_m[0] - 0.5;
        let row = f64::from(self.rows) - 0.5 - (cos * dy - sin * dx) / self.posts.apart_m[1];
        [column, row].map(|place| {
            let line = place.round();
            if (place - line).abs() < ON_LINE { line } else { place }
        })
    }

    /// The height of a post.
    fn post_m(&self, column: u32, row: u32) -> Option<f64> {
        if column >= self.columns || row >= self.rows {
            return None;
        }
        let height = self.heights_m[row as usize * self.columns as usize + column as usize];
        (!height.is_nan()).then_some(height.into())
    }

    /// The surface between a post and those right of it and below; a grid of one column or row has no slope across.
    pub(super) fn patch(&self, column: u32, row: u32) -> Option<Patch> {
        let right = (column + 1).min(self.columns - 1);
        let below = (row + 1).min(self.rows - 1);
        let heights_m = [
            [self.post_m(column, row)?, self.post_m(right, row)?],
            [self.post_m(column, below)?, self.post_m(right, below)?],
        ];
        Some(Patch { heights_m, apart_m: self.posts.apart_m })
    }
}

/// Between which lines of `count` posts a place lies: the first of the two, and how far it is from there, below 0
/// and above 1 in the half post outside.
pub(super) fn along(place: f64, count: u32) -> Option<(u32, f64)> {
    if !(-0.5 - ON_LINE..=f64::from(count) - 0.5 + ON_LINE).contains(&place) {
        return None;
    }
    let first = place.floor().clamp(0.0, f64::from(count.saturating_sub(2)));
    Some((first as u32, if count == 1 { 0.0 } else { place - first }))
}

/// The bilinear surface between four posts.
#[derive(Debug, Clone, Copy)]
pub(super) struct Patch {
    /// The upper and the lower row.
    heights_m: [[f64; 2]; 2],
    apart_m: [f64; 2],
}

impl Patch {
    /// The slope to the right and upwards (in the picture), in metres a metre, at a place counted in posts from the
    /// patch's upper left one.
    pub(super) fn slope(&self, [right, down]: [f64; 2]) -> [f64; 2] {
        let [[a, b], [c, d]] = self.heights_m;
        let across = (b - a) * (1.0 - down) + (d - c) * down;
        let downwards = (c - a) * (1.0 - right) + (d - b) * right;
        [across / self.apart_m[0], -downwards / self.apart_m[1]]
    }
}

impl PartialEq for Elevation {
    /// Posts without a height are alike.
    fn eq(&self, other: &Self) -> bool {
        let same = |(a, b): (&f32, &f32)| a == b || a.is_nan() && b.is_nan();
        (self.columns, self.rows, self.posts) == (other.columns, other.rows, other.posts)
            && (Arc::ptr_eq(&self.heights_m, &other.heights_m)
                || self.heights_m.iter().zip(&*other.heights_m).all(same))
    }
}
