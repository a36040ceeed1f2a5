//! The map's frame: where a cell lies in metres.

use crate::error::Error;

/// A point on the floor in metres: x right, y up (ROS REP 103).
pub type PointM = [f64; 2];

/// How the mosaic lies on the floor.
///
/// ```text
///          x' (yaw 0: East)            origin_m: the lower left corner of the mosaic's bounding box
///    y'  ┌───────────────┐             cell_m:   a cell from side to side, which is also the distance
///    ▲   │ row 0         │                       between the centres of neighbours, on both lattices
///    │   │ …             │             yaw_rad:  the box turned about its origin, counter-clockwise
///        │ last row      │
/// origin ●───────────────┘ ──▶ x'
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// A cell from side to side.
    pub cell_m: f64,
    /// The lower left corner of the mosaic in the floor's coordinates.
    pub origin_m: PointM,
    /// How far the mosaic is turned, counter-clockwise.
    pub yaw_rad: f64,
}

impl Default for Frame {
    /// Cells of 1 m, the origin at (0, 0), not turned.
    fn default() -> Self {
        Self { cell_m: 1.0, origin_m: [0.0, 0.0], yaw_rad: 0.0 }
    }
}

impl Frame {
    /// Checks that the numbers make sense.
    ///
    /// # Errors
    /// [`Error::BadValue`] if the cell size is not a positive number or anything is not finite.
    pub fn checked(self) -> Result<Self, Error> {
        let bad = |name, value, allowed| Err(Error::BadValue { name, value, allowed });
        if !(1e-6..=1e6).contains(&self.cell_m) {
            return bad("the cell size in metres", self.cell_m, "between 0.000001 and 1000000");
        }
        for value in [self.origin_m[0], self.origin_m[1], self.yaw_rad] {
            if !(-1e9..=1e9).contains(&value) {
                return bad("the map's origin", value, "a number of at most a thousand million");
            }
        }
        Ok(self)
    }

    /// From the mosaic's own metres (x' right, y' up, from the origin) to the floor's.
    pub fn to_floor(&self, [x, y]: PointM) -> PointM {
        let (sin, cos) = self.yaw_rad.sin_cos();
        [self.origin_m[0] + cos * x - sin * y, self.origin_m[1] + sin * x + cos * y]
    }

    /// From the floor's metres to the mosaic's own.
    pub fn to_mosaic(&self, [x, y]: PointM) -> PointM {
        let (sin, cos) = self.yaw_rad.sin_cos();
        let (dx, dy) = (x - self.origin_m[0], y - self.origin_m[1]);
        [cos * dx + sin * dy, -sin * dx + cos * dy]
    }
}
