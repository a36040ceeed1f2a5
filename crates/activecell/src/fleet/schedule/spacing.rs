//! The geometry: when a robot has left a cell, and how close another may follow.

use crate::error::Error;
use crate::lattice::Lattice;

/// A robot that stops this share of a cell before a centre counts as there: wheels do not stop to the tick.
pub(super) const NEAR: f64 = 0.01;
/// Robots go in step only if one may be so far ahead of its place, in cells: with less they would creep.
const LEAST_PLAY: f64 = 0.02;

/// How much room the bodies of robots leave each other. Lengths are in cells: 1 is from a cell's centre to the next.
///
/// Bodies are discs of one radius *r* around points that go from centre to centre. Robots whose cells (both, while it is
/// between two) are all different are at least 1 cell apart on squares and √3/2 on hexagons: the height of the
/// triangle of three cells that touch. What remains are a robot that leaves a cell and the next one that comes to it. With
/// the one *s* beyond the centre, the other *q* before it, and an angle *θ* by which the first turns off from the
/// way of the second, they are √(s² + q² + 2 s q cos θ) apart, and so:
///
/// - **Clear.** At s ≥ ½ + r the first is wholly in its next cell. Then the other may come as near as the centre: the
///   distance is at least s for θ ≤ 90° and s √3/2 for θ = 120°, so on hexagons s must be 4 r / √3 too, which
///   is more from r = 0.38 on.
/// - **In step.** If the other is never more than δ ahead, q ≥ 1 − s − δ, the distance is at least (1 − δ) cos(θ/2). So
///   δ may be 1 − 2 r / cos(θ/2). It is kept below what would let the other reach the centre before the first is
///   clear, and a hundredth of a cell smaller for wheels that stop early.
///
/// Round the corners of a ring of squares discs of r < 0.35 pass each other, round the sharp corners of hexagons (three
/// robots on three cells that touch) r < 0.25: with larger ones that ring cannot turn, however it is driven.
///
/// ```
/// use activecell::{Lattice, schedule::Spacing};
/// let spacing = Spacing::new(Lattice::Square, 0.3)?;
/// assert_eq!((spacing.clear(), spacing.radius()), (0.8, 0.3));
/// assert!((spacing.play(0).unwrap() - 0.19).abs() < 1e-9 && (spacing.play(90).unwrap() - 0.1415).abs() < 1e-4);
/// assert_eq!(Spacing::new(Lattice::Square, 0.45)?.play(90), None);
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spacing {
    radius: f64,
    clear: f64,
}

impl Spacing {
    /// For discs of this radius, in cells.
    ///
    /// # Errors
    /// [`Error::BadValue`] if it is not above 0 and at most 0.49 on squares, 0.42 on hexagons.
    pub fn new(lattice: Lattice, radius: f64) -> Result<Self, Error> {
        let (most, allowed, sharp) = match lattice {
            Lattice::Square => (0.49, "above 0 and at most 0.49 cells, so that robots pass each other", 2.0),
            Lattice::Hex => {
                (0.42, "above 0 and at most 0.42 cells, so that robots pass each other", 4.0 / 3f64.sqrt())
            }
        };
        if !(radius > 0.0 && radius <= most) {
            return Err(Error::BadValue { name: "the robots' radius in cells", value: radius, allowed });
        }
        Ok(Self { radius, clear: (0.5 + radius).max(sharp * radius) })
    }

    /// The radius of a robot.
    pub const fn radius(&self) -> f64 {
        self.radius
    }

    /// How far beyond a centre a robot has left the cell.
    pub const fn clear(&self) -> f64 {
        self.clear
    }

    /// How far a robot that comes to a cell may be ahead of the one that leaves it in the same step and turns off by
    /// this angle; `None` if it must wait until that one is clear.
    pub fn play(&self, bend_deg: i32) -> Option<f64> {
        let apart = 2.0 * self.radius / (f64::from(bend_deg).to_radians() / 2.0).cos();
        let play = (1.0 - apart).min(1.0 - self.clear) - NEAR;
        (play >= LEAST_PLAY).then_some(play)
    }
}
