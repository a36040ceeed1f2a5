//! Three by three: as much linear algebra as three parameters and a pose need.

/// A vector of three.
pub(super) type Vector = [f64; 3];
/// Rows of a matrix.
pub(super) type Matrix = [Vector; 3];

pub(super) const ZERO: Matrix = [[0.0; 3]; 3];

pub(super) const fn diagonal([a, b, c]: Vector) -> Matrix {
    [[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]]
}

fn each(entry: impl Fn(usize, usize) -> f64) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)))
}

pub(super) fn plus(a: &Matrix, b: &Matrix) -> Matrix {
    each(|i, j| a[i][j] + b[i][j])
}

pub(super) fn minus(a: &Matrix, b: &Matrix) -> Matrix {
    each(|i, j| a[i][j] - b[i][j])
}

pub(super) fn scaled(a: &Matrix, factor: f64) -> Matrix {
    each(|i, j| a[i][j] * factor)
}

pub(super) fn times(a: &Matrix, b: &Matrix) -> Matrix {
    each(|i, j| (0..3).map(|k| a[i][k] * b[k][j]).sum())
}

pub(super) fn transposed(a: &Matrix) -> Matrix {
    each(|i, j| a[j][i])
}

/// a m aᵀ: how a covariance passes through a linear map.
pub(super) fn through(a: &Matrix, m: &Matrix) -> Matrix {
    times(&times(a, m), &transposed(a))
}

pub(super) fn apply(a: &Matrix, v: &Vector) -> Vector {
    std::array::from_fn(|i| dot(&a[i], v))
}

pub(super) fn dot(a: &Vector, b: &Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(super) fn determinant(a: &Matrix) -> f64 {
    dot(&a[0], &cross(&a[1], &a[2]))
}

/// The inverse of a symmetric matrix; `None` unless it is positive definite.
///
/// Rows and columns are first scaled to a diagonal of ones: metres and radians differ by orders of magnitude.
pub(super) fn inverse(a: &Matrix) -> Option<Matrix> {
    if !(0..3).all(|i| a[i][i] > 0.0 && a[i][i].is_finite()) {
        return None;
    }
    let size: Vector = std::array::from_fn(|i| a[i][i].sqrt());
    let unit = each(|i, j| a[i][j] / (size[i] * size[j]));
    let whole = determinant(&unit);
    if !(whole > 1e-14 && whole.is_finite()) {
        return None;
    }
    let rows = [cross(&unit[1], &unit[2]), cross(&unit[2], &unit[0]), cross(&unit[0], &unit[1])];
    Some(each(|i, j| rows[j][i] / (whole * size[i] * size[j])))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Rng;

    #[test]
    fn a_matrix_times_its_inverse_is_one() {
        let mut rng = Rng::new(1);
        for _ in 0..500 {
            let root = each(|_, _| 0.0).map(|row| row.map(|_| rng.normal()));
            let size = diagonal([1e-3, 1.0, 30.0]);
            let a = through(&size, &plus(&times(&root, &transposed(&root)), &diagonal([0.1; 3])));
            let one = times(&a, &inverse(&a).expect("positive definite"));
            for (i, row) in one.iter().enumerate() {
                for (j, &entry) in row.iter().enumerate() {
                    assert!((entry - f64::from(u8::from(i == j))).abs() < 1e-6, "{one:?}");
                }
            }
        }
        assert_eq!(inverse(&ZERO), None);
        assert_eq!(inverse(&[[1.0; 3]; 3]), None);
        assert_eq!(inverse(&diagonal([1.0, f64::NAN, 1.0])), None);
    }
}
