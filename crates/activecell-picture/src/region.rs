//! The ellipses in which a robot is with 95 %.

use crate::colour::{PAGE, PURPLE};
use crate::layout::Layout;
use crate::scene::{Line, Point, Shape};
use activecell::{Map, Region};
use std::f64::consts::TAU;

/// Corners of the polygon that stands for an ellipse.
const CORNERS: u32 = 72;
/// Smaller ellipses, in pixels, are hidden by the route's line.
const LEAST_PX: f64 = 3.0;

/// The outlines of all ellipses that can be seen, cut off at the map's edge.
pub(crate) fn shapes(layout: &Layout, map: &Map, regions: &[Region]) -> Vec<Shape> {
    let px = layout.cell / map.frame().cell_m;
    let mut runs = Vec::new();
    for region in regions.iter().filter(|region| region.semi_major_m * px >= LEAST_PX) {
        let (sin, cos) = region.angle_rad.sin_cos();
        let flatness = region.semi_minor_m / region.semi_major_m;
        let points = ellipse(flatness, |along, across| {
            let (along, across) = (along * region.semi_major_m, across * region.semi_major_m);
            let [x, y] = region.centre_m;
            layout.floor_point(map, [x + along * cos - across * sin, y + along * sin + across * cos])
        });
        let inside = |point: &Point| {
            (0..2).all(|axis| {
                (layout.origin[axis]..=layout.origin[axis] + layout.map_size[axis]).contains(&point[axis])
            })
        };
        runs.extend(points.split(|point| !inside(point)).filter(|run| run.len() > 1).map(<[Point]>::to_vec));
    }
    outline(runs)
}

/// The closed line of an ellipse with semi-axes of 1 and `flatness`, as a map places it.
pub(crate) fn ellipse(flatness: f64, place: impl Fn(f64, f64) -> Point) -> Vec<Point> {
    let corner = |k: u32| {
        let (sin, cos) = (TAU * f64::from(k) / f64::from(CORNERS)).sin_cos();
        place(cos, flatness * sin)
    };
    (0..=CORNERS).map(corner).collect()
}

/// Lines with a white rim, which shows them on any ground.
pub(crate) fn outline(runs: Vec<Vec<Point>>) -> Vec<Shape> {
    if runs.is_empty() {
        return Vec::new();
    }
    vec![Shape::lines(runs.clone(), Line::new(PAGE, 4.4)), Shape::lines(runs, Line::new(PURPLE, 2.4))]
}
