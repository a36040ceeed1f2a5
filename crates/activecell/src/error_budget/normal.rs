//! The normal distribution in the plane: its ellipses, and its share inside a polygon.

use crate::map::PointM;
use std::f64::consts::{PI, TAU};

/// A covariance of two coordinates: of the first, of both, of the second.
pub(super) type Covariance = [[f64; 2]; 2];

/// A point of the plane is within the 95 % region of a normal distribution if the square of its distance from the
/// centre, measured in standard deviations, is at most this: -2 ln 0.05 (χ² with two degrees of freedom).
pub const REGION_95: f64 = 5.991_464_547_107_98;

/// The same where all scatter lies on a line: the square of the normal distribution's quantile.
const REGION_95_OF_A_LINE: f64 = 3.841_458_820_694_12;

/// The squared Mahalanobis distance within which 95 % of this normal distribution lie.
pub(super) fn region_95(covariance: &Covariance, least_m: f64) -> f64 {
    let [major, minor] = main_axes(covariance).0.map(f64::sqrt);
    // Rounding leaves a minor axis of about 1e-8 of the major one.
    if minor > least_m.max(1e-6 * major) { REGION_95 } else { REGION_95_OF_A_LINE }
}

/// Variances along the two main axes, the larger first, and the direction of the first.
pub(super) fn main_axes(covariance: &Covariance) -> ([f64; 2], f64) {
    let [[xx, xy], [_, yy]] = *covariance;
    let (middle, half) = (f64::midpoint(xx, yy), ((xx - yy) / 2.0).hypot(xy));
    // The product of both is the determinant: the small one does not come from a difference of large ones.
    let large = middle + half;
    let small = if large > 0.0 { ((xx * yy - xy * xy) / large).max(0.0) } else { 0.0 };
    ([large, small], 0.5 * (2.0 * xy).atan2(xx - yy))
}

/// The squared Mahalanobis distance of an offset; an axis without variance counts as one of the least.
pub(super) fn mahalanobis_squared(covariance: &Covariance, offset_m: [f64; 2], least_m: f64) -> f64 {
    let [u, v] = whitened(covariance, least_m)(offset_m);
    u * u + v * v
}

/// The map under which the distribution becomes the standard one.
fn whitened(covariance: &Covariance, least_m: f64) -> impl Fn([f64; 2]) -> [f64; 2] {
    let (variances, angle_rad) = main_axes(covariance);
    let (sin, cos) = angle_rad.sin_cos();
    let [major, minor] = variances.map(|variance| variance.sqrt().max(least_m));
    move |[x, y]| [(cos * x + sin * y) / major, (cos * y - sin * x) / minor]
}

/// The probability that a normal point of this mean and covariance lies in a polygon. Deviations are at least
/// `least_m`, so that a point that does not scatter is inside, or on the edge with a half, or outside.
///
/// As a sum over edges: between the origin and an edge lie right triangles, whose probability is Nicholson's
/// V function (Nicholson, *The Probability Integral for Two Variables*, 1943).
pub(super) fn share_inside(
    mean_m: PointM,
    covariance: &Covariance,
    corners_m: &[PointM],
    least_m: f64,
) -> f64 {
    let white = whitened(covariance, least_m);
    let corners: Vec<[f64; 2]> =
        corners_m.iter().map(|corner| white([corner[0] - mean_m[0], corner[1] - mean_m[1]])).collect();
    let edge = |i: usize| {
        let ([ax, ay], [bx, by]) = (corners[i], corners[(i + 1) % corners.len()]);
        let (dx, dy) = (bx - ax, by - ay);
        let length = dx.hypot(dy);
        if length == 0.0 {
            return 0.0;
        }
        // How far the edge's line is from the origin, and where on it, from the foot on, the edge lies.
        let distance = (ax * dy - ay * dx) / length;
        let along = |x: f64, y: f64| (x * dx + y * dy) / length;
        triangle(distance, along(bx, by)) - triangle(distance, along(ax, ay))
    };
    (0..corners.len()).map(edge).sum::<f64>().abs().min(1.0)
}

/// Nicholson's V: the probability of the right triangle (0, 0), (distance, 0), (distance, along), with its sign.
fn triangle(distance: f64, along: f64) -> f64 {
    if distance == 0.0 || along == 0.0 {
        return 0.0;
    }
    let (h, a) = (distance.abs(), (along / distance).abs());
    let angle = along.abs().atan2(h) / TAU;
    (angle - owen_t(h, a)) * distance.signum() * along.signum()
}

/// Owen's T (*Tables for Computing Bivariate Normal Probabilities*, 1956) for h > 0, a > 0: the probability that
/// x > h and 0 < y < a x.
fn owen_t(h: f64, a: f64) -> f64 {
    const PIECES: u32 = 40;
    if a > 1.0 {
        // Steep triangles are the rest of a corner and of a flat one.
        let (p, q) = (tail(h), tail(a * h));
        let flat = if a.is_finite() { owen_t(a * h, 1.0 / a) } else { 0.0 };
        return (f64::midpoint(p, q) - p * q - flat).max(0.0);
    }
    // Simpson's rule; the integrand is as smooth as a bell of width 1 / h, and nothing beyond h = 9.
    if h > 9.0 {
        return 0.0;
    }
    let at = |i: u32| {
        let x = a * f64::from(i) / f64::from(PIECES);
        (-h * h * (1.0 + x * x) / 2.0).exp() / (1.0 + x * x)
    };
    let inner: f64 = (1..PIECES).map(|i| at(i) * if i % 2 == 1 { 4.0 } else { 2.0 }).sum();
    (at(0) + inner + at(PIECES)) * a / (3.0 * f64::from(PIECES)) / TAU
}

/// The probability of a standard normal number above h ≥ 0 (the series of Marsaglia, *Evaluating the Normal
/// Distribution*, 2004; exact to rounding, about 1e-16).
fn tail(h: f64) -> f64 {
    if h > 9.0 {
        return 0.0;
    }
    let (mut term, mut sum, mut k) = (h, h, 1.0);
    while term > 1e-18 * sum {
        k += 2.0;
        term *= h * h / k;
        sum += term;
    }
    (0.5 - sum * (-h * h / 2.0).exp() / (2.0 * PI).sqrt()).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Rng;

    #[test]
    fn tails_are_those_of_the_tables() {
        for (h, expected) in [(0.0, 0.5), (1.0, 0.158_655_253_931_457), (1.959_963_984_540_054, 0.025)] {
            assert!((tail(h) - expected).abs() < 1e-14, "{h}");
        }
        assert!((tail(5.0) - 2.866_515_718_791_94e-7).abs() < 1e-15);
    }

    /// Against the probability as a sum over a fine grid of strips, for polygons of both lattices' cells and
    /// covariances from round to almost a line.
    #[test]
    fn shares_agree_with_sums_over_strips() {
        let hex: Vec<PointM> =
            (0..6).map(|k| f64::from(k) * TAU / 6.0 + 0.2).map(|t| [t.cos(), t.sin()]).collect();
        let square = vec![[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]];
        let mut rng = Rng::new(3);
        for polygon in [hex, square] {
            for case in 0..200 {
                let (major, minor) = (0.05 + 2.0 * rng.unit(), 0.05 + 0.5 * rng.unit());
                let (sin, cos) = (TAU * rng.unit()).sin_cos();
                let mean = [1.5 * (rng.unit() - 0.5), 1.5 * (rng.unit() - 0.5)];
                let (a, b) = (major * major, minor * minor);
                let xy = (a - b) * sin * cos;
                let covariance = [[a * cos * cos + b * sin * sin, xy], [xy, a * sin * sin + b * cos * cos]];
                let found = share_inside(mean, &covariance, &polygon, 1e-9);
                let expected = strips(mean, &covariance, &polygon);
                assert!((found - expected).abs() < 1e-6, "{case}: {found} {expected}");
            }
        }
    }

    /// Strips along x: y given x is normal.
    fn strips([mx, my]: PointM, covariance: &Covariance, polygon: &[PointM]) -> f64 {
        let [[xx, xy], [_, yy]] = *covariance;
        let below = |z: f64| if z < 0.0 { tail(-z) } else { 1.0 - tail(z) };
        let count = 20_000;
        let ends = polygon.iter().map(|corner| corner[0]);
        let (low, high) = ends.fold((9.0f64, -9.0f64), |(low, high), x| (low.min(x), high.max(x)));
        let width = (high - low) / f64::from(count);
        let strip = |i: u32| {
            let x = low + (f64::from(i) + 0.5) * width;
            let crossings: Vec<f64> = (0..polygon.len())
                .filter_map(|i| {
                    let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
                    ((a[0] < x) != (b[0] < x)).then(|| a[1] + (x - a[0]) / (b[0] - a[0]) * (b[1] - a[1]))
                })
                .collect();
            let [first, second] = crossings[..] else { return 0.0 };
            let (mean, deviation) = (my + xy / xx * (x - mx), (yy - xy * xy / xx).sqrt());
            let inside =
                below((first.max(second) - mean) / deviation) - below((first.min(second) - mean) / deviation);
            inside * (-(x - mx).powi(2) / xx / 2.0).exp() / (TAU * xx).sqrt() * width
        };
        (0..count).map(strip).sum()
    }

    #[test]
    fn a_point_without_scatter_is_inside_or_not() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let none = [[0.0; 2]; 2];
        for (mean, expected) in
            [([0.5, 0.5], 1.0), ([0.999, 0.01], 1.0), ([1.5, 0.5], 0.0), ([1.0, 0.5], 0.5)]
        {
            assert!((share_inside(mean, &none, &square, 1e-9) - expected).abs() < 1e-6, "{mean:?}");
        }
        // A line of scatter along x.
        let line = [[1.0, 0.0], [0.0, 0.0]];
        assert!((share_inside([0.5, 0.5], &line, &square, 1e-9) - 0.382_924_922_548_026).abs() < 1e-7);
    }

    #[test]
    fn main_axes_give_the_covariance_back() {
        let (variances, angle_rad) = main_axes(&[[2.0, 0.6], [0.6, 1.0]]);
        let (sin, cos) = angle_rad.sin_cos();
        let xx = variances[0] * cos * cos + variances[1] * sin * sin;
        let xy = (variances[0] - variances[1]) * sin * cos;
        assert!((xx - 2.0).abs() < 1e-12 && (xy - 0.6).abs() < 1e-12);
    }
}
