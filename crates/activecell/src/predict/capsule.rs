//! Capsules: what a disc sweeps over while its centre moves straight on.

use crate::map::PointM;

/// All points within `radius_m` of a straight line: what a disc sweeps over between two times.
///
/// ```
/// use activecell::predict::Capsule;
/// let robot = Capsule { from_m: [0.0, 0.0], to_m: [1.0, 0.0], radius_m: 0.2 };
/// let object = Capsule { from_m: [0.5, 2.0], to_m: [0.5, 0.5], radius_m: 0.25 };
/// assert!((robot.gap_m(&object) - 0.05).abs() < 1e-12);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Capsule {
    /// Where the centre begins.
    pub from_m: PointM,
    /// Where it ends.
    pub to_m: PointM,
    /// How far the disc extends.
    pub radius_m: f64,
}

impl Capsule {
    /// How far apart two capsules are; negative where they overlap.
    pub fn gap_m(&self, other: &Self) -> f64 {
        let (a, b) = ((self.from_m, self.to_m), (other.from_m, other.to_m));
        let apart = if cross(a, b) {
            0.0
        } else {
            let ends = [to_line(a.0, b), to_line(a.1, b), to_line(b.0, a), to_line(b.1, a)];
            ends.into_iter().fold(f64::INFINITY, f64::min)
        };
        apart - self.radius_m - other.radius_m
    }
}

fn minus(a: PointM, b: PointM) -> PointM {
    [a[0] - b[0], a[1] - b[1]]
}

/// Which side of the line from `a` to `b` the point lies on, and how far, times the line's length.
fn side(a: PointM, b: PointM, point: PointM) -> f64 {
    let ([x, y], [px, py]) = (minus(b, a), minus(point, a));
    x * py - y * px
}

/// Whether two lines cross within both. Where they only touch, an end lies on the other line.
fn cross(a: (PointM, PointM), b: (PointM, PointM)) -> bool {
    side(a.0, a.1, b.0) * side(a.0, a.1, b.1) < 0.0 && side(b.0, b.1, a.0) * side(b.0, b.1, a.1) < 0.0
}

/// From a point to the nearest point of a line with two ends.
fn to_line(point: PointM, (from, to): (PointM, PointM)) -> f64 {
    let ([x, y], [px, py]) = (minus(to, from), minus(point, from));
    let square = x * x + y * y;
    let share = if square > 0.0 { ((x * px + y * py) / square).clamp(0.0, 1.0) } else { 0.0 };
    (px - share * x).hypot(py - share * y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Rng;

    #[test]
    fn the_gap_is_the_least_distance_of_sampled_points() {
        let mut rng = Rng::new(3);
        for _ in 0..2000 {
            let mut capsule = |radius_m| {
                let mut point = || [4.0 * rng.unit(), 4.0 * rng.unit()];
                Capsule { from_m: point(), to_m: point(), radius_m }
            };
            let (a, b) = (capsule(0.0), capsule(0.0));
            let along = |c: &Capsule, i: u32| -> PointM {
                std::array::from_fn(|k| c.from_m[k] + (c.to_m[k] - c.from_m[k]) * f64::from(i) / 60.0)
            };
            let mut least = f64::INFINITY;
            for i in 0..=60 {
                for j in 0..=60 {
                    let [x, y] = minus(along(&a, i), along(&b, j));
                    least = least.min(x.hypot(y));
                }
            }
            let gap = a.gap_m(&b);
            assert!(gap <= least + 1e-12 && gap >= least - 0.1, "{a:?} {b:?}: {gap} {least}");
            let (wide, wider) = (Capsule { radius_m: 0.3, ..a }, Capsule { radius_m: 0.5, ..b });
            assert!((wide.gap_m(&wider) - gap + 0.8).abs() < 1e-12);
        }
    }
}
