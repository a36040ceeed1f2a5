//! Complex numbers, as far as they are needed: the plane's points, x + iy, and turns, e^(i angle).

use std::ops::{Add, AddAssign, Mul, Sub};

#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Complex {
    pub(super) re: f64,
    pub(super) im: f64,
}

impl Complex {
    pub(super) const ZERO: Self = Self::new(0.0, 0.0);

    pub(super) const fn new(re: f64, im: f64) -> Self {
        Self { re, im }
    }

    /// The number's exponential function.
    pub(super) fn exp(self) -> Self {
        let (sin, cos) = self.im.sin_cos();
        Self::new(cos, sin) * self.re.exp()
    }

    pub(super) const fn conj(self) -> Self {
        Self::new(self.re, -self.im)
    }

    /// The square of its size.
    pub(super) const fn norm(self) -> f64 {
        self.re * self.re + self.im * self.im
    }
}

impl Add for Complex {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::new(self.re + other.re, self.im + other.im)
    }
}

impl AddAssign for Complex {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Sub for Complex {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::new(self.re - other.re, self.im - other.im)
    }
}

impl Mul for Complex {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self::new(self.re * other.re - self.im * other.im, self.re * other.im + self.im * other.re)
    }
}

impl Mul<f64> for Complex {
    type Output = Self;
    fn mul(self, other: f64) -> Self {
        Self::new(self.re * other, self.im * other)
    }
}

/// The mean of e^(a u + b v + c (1 - u - v)) over the triangle u, v ≥ 0, u + v ≤ 1, ÷ 2; which is the divided
/// difference of the exponential function at three points (the formula of Hermite and Genocchi).
///
/// As a power series, Σ hₖ ÷ (k + 2)! with hₖ the sum of all products of k of the points: exact to rounding for
/// points of a size of about 1, coinciding or not, where quotients of differences would cancel.
pub(super) fn exp_over_triangle(a: Complex, b: Complex, c: Complex) -> Complex {
    series([a, b, c], 2.0)
}

/// The mean of e^(a u + b (1 - u)) over u from 0 to 1: the divided difference at two points.
pub(super) fn exp_over_line(a: Complex, b: Complex) -> Complex {
    series([a, b, Complex::ZERO], 1.0)
}

/// Σ hₖ ÷ (k + order)!; a point 0 adds nothing to hₖ.
fn series([a, b, c]: [Complex; 3], order: f64) -> Complex {
    // The products of k points: those of a alone, of a and b, of all three.
    let one = Complex::new(1.0, 0.0);
    let (mut of_a, mut of_ab, mut of_abc) = (one, one, one);
    let mut factor = 1.0 / order; // 1 / order!, as the order is 1 or 2
    let mut sum = one * factor;
    for k in 1..60 {
        of_a = of_a * a;
        of_ab = of_ab * b + of_a;
        of_abc = of_abc * c + of_ab;
        factor /= f64::from(k) + order;
        let term = of_abc * factor;
        sum += term;
        if term.norm() <= 1e-36 * sum.norm() {
            break;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums over many small pieces.
    #[test]
    fn means_of_the_exponential_are_integrals() {
        let points = [
            Complex::ZERO,
            Complex::new(-0.3, 0.8),
            Complex::new(-1e-9, 1e-5),
            Complex::new(-0.3, 0.8),
            Complex::new(0.0, -1.0),
        ];
        let pieces = 400;
        let at = |i: u32| (f64::from(i) + 0.5) / f64::from(pieces);
        for a in points {
            for b in points {
                let line = (0..pieces).map(|i| (a * at(i) + b * (1.0 - at(i))).exp());
                let line = line.fold(Complex::ZERO, Complex::add) * (1.0 / f64::from(pieces));
                assert!((line - exp_over_line(a, b)).norm().sqrt() < 1e-5);
                for c in points {
                    // The triangle as a square: u = s, v = (1 - s) t.
                    let mut sum = Complex::ZERO;
                    for s in (0..pieces).map(at) {
                        let inner = exp_over_line(b * (1.0 - s), c * (1.0 - s));
                        sum += (a * s).exp() * inner * (1.0 - s);
                    }
                    let sum = sum * (1.0 / f64::from(pieces));
                    assert!((sum - exp_over_triangle(a, b, c)).norm().sqrt() < 1e-5);
                }
            }
        }
    }
}
