//! Hill shading: the ground tinted by its height and lit from the north-west.
//!
//! Slopes are weighted as by Berthold Horn, *Hill shading and the reflectance map* (1981): the eight points around,
//! those straight ahead counted twice. The light stands 45° high; gentle ground is lit as if it were steeper.

use crate::colour::{self, Rgb};
use crate::layout::Layout;
use crate::scene::Shape;
use activecell::{Elevation, Map, PointM};
use std::f64::consts::FRAC_1_SQRT_2;
use tiny_skia::{ColorU8, Pixmap};

/// Steps of the tints and of the shading: few enough for small files, too many to be seen.
const TINTS: f64 = 60.0;
const SHADES: f64 = 100.0;
/// How dark the darkest slope becomes and how bright the brightest.
const DARKEST: f64 = 0.5;
const BRIGHTEST: f64 = 0.55;
/// The steepest ground is lit as if it were so steep, and at most so many times as steep as it is.
const LIT_SLOPE: f64 = 0.8;
const MOST_TIMES: f64 = 12.0;

/// The ground's tints, under everything that is drawn on it; none for a flat map.
pub(crate) fn tints(layout: &Layout, map: &Map) -> Option<Shape> {
    let elevation = map.elevation()?;
    let [low, high] = elevation.range_m()?;
    image(layout, map, |point| {
        let share = (elevation.height_m(point)? - low) / (high - low).max(1e-9);
        let Rgb(r, g, b) = colour::height((share * TINTS).round() / TINTS);
        Some(ColorU8::from_rgba(r, g, b, 0xff))
    })
}

/// Light and shadow, over all tints; none for a flat map.
pub(crate) fn shading(layout: &Layout, map: &Map) -> Option<Shape> {
    let elevation = map.elevation()?;
    let apart_m = elevation.posts().apart_m;
    // At least a pixel, and at least half a post: nearer the surface shows its edges.
    let reach_m = (map.frame().cell_m / layout.cell).max(0.5 * apart_m[0].min(apart_m[1]));
    let steepest = elevation.steepest_deg().to_radians().tan();
    let times = (LIT_SLOPE / steepest.max(1e-9)).clamp(1.0, MOST_TIMES);
    image(layout, map, |point| {
        let [east, north] = slope(elevation, point, reach_m)?.map(|slope| times * slope);
        let level = FRAC_1_SQRT_2;
        let light = (0.5 * east - 0.5 * north + level) / east.hypot(north).hypot(1.0);
        let (grey, alpha) = if light < level {
            (0, DARKEST * (level - light.max(0.0)) / level)
        } else {
            (0xff, BRIGHTEST * (light - level) / (1.0 - level))
        };
        let alpha = (alpha * SHADES).round() / SHADES;
        Some(ColorU8::from_rgba(grey, grey, grey, (255.0 * alpha) as u8))
    })
}

/// The slope to the east and to the north, by Horn's weights.
fn slope(elevation: &Elevation, [x, y]: PointM, reach_m: f64) -> Option<[f64; 2]> {
    let here = elevation.height_m([x, y])?;
    let height = |dx: f64, dy: f64| elevation.height_m([x + dx * reach_m, y + dy * reach_m]);
    // Where the ground ends its slope goes on.
    let beyond = |dx: f64, dy: f64| height(-dx, -dy).map_or(here, |opposite| 2.0 * here - opposite);
    let at = |dx: f64, dy: f64| height(dx, dy).unwrap_or_else(|| beyond(dx, dy));
    let [nw, n, ne] = [at(-1.0, 1.0), at(0.0, 1.0), at(1.0, 1.0)];
    let [sw, s, se] = [at(-1.0, -1.0), at(0.0, -1.0), at(1.0, -1.0)];
    let [w, e] = [at(-1.0, 0.0), at(1.0, 0.0)];
    let east = (ne + 2.0 * e + se) - (nw + 2.0 * w + sw);
    let north = (nw + 2.0 * n + ne) - (sw + 2.0 * s + se);
    Some([east / (8.0 * reach_m), north / (8.0 * reach_m)])
}

/// An image of the map's cells, of one colour a pixel.
fn image(layout: &Layout, map: &Map, colour: impl Fn(PointM) -> Option<ColorU8>) -> Option<Shape> {
    let [width, height] = layout.map_size.map(|size| size.ceil() as u32);
    let mut pixels = Pixmap::new(width, height)?;
    let at = layout.origin.map(f64::floor);
    for y in 0..height {
        for x in 0..width {
            let (page_x, page_y) = (at[0] as u32 + x, at[1] as u32 + y);
            if map.contains(layout.cell_at(page_x, page_y))
                && let Some(colour) =
                    colour(layout.point_m(map, [f64::from(page_x) + 0.5, f64::from(page_y) + 0.5]))
            {
                pixels.pixels_mut()[(y * width + x) as usize] = colour.premultiply();
            }
        }
    }
    Some(Shape::Image { at, pixels })
}
