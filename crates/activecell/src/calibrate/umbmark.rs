//! `UMBmark`: wheels from the return errors of squares driven both ways, in closed form.

use crate::error::Error;
use crate::map::PointM;
use crate::program::Robot;
use std::f64::consts::FRAC_PI_2;

/// Where squares ended, relative to where dead reckoning said that they ended: means over some rounds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SquareErrors {
    /// The side of the square.
    pub side_m: f64,
    /// Mean error of squares driven clockwise, in the frame of the start: x along the first side, y to its left.
    pub clockwise_m: PointM,
    /// The same for squares driven counter-clockwise.
    pub counter_clockwise_m: PointM,
}

/// The robot with the difference of its wheels and the track that the squares tell; the mean perimeter stays.
///
/// For small errors, and squares whose corners are turned in place. An older and simpler way than
/// [`calibrate`](crate::calibrate), which needs no special path.
///
/// Source: Borenstein and Feng, *Measurement and Correction of Systematic Odometry Errors in Mobile Robots*, 1996.
///
/// # Errors
/// [`Error::BadValue`] if the side is no length, or the errors are as large as the square.
///
/// ```
/// use activecell::{Robot, SquareErrors, umbmark};
/// let errors = SquareErrors { side_m: 4.0, clockwise_m: [0.05, -0.03], counter_clockwise_m: [0.05, 0.03] };
/// let robot = umbmark(&errors, &Robot::default())?;
/// assert!((robot.track_m - 0.16).abs() < 0.01);
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn umbmark(errors: &SquareErrors, robot: &Robot) -> Result<Robot, Error> {
    let SquareErrors { side_m, clockwise_m: cw, counter_clockwise_m: ccw } = *errors;
    if !(1e-6..=1e6).contains(&side_m) {
        let allowed = "between 0.000001 and 1000000";
        return Err(Error::BadValue { name: "the side of the square in metres", value: side_m, allowed });
    }
    // Of each corner the turn that is too little, of each side the angle by which it bends to the left.
    let alpha = (cw[0] + ccw[0]) / (-4.0 * side_m);
    let beta = (cw[0] - ccw[0]) / (-4.0 * side_m);
    let most = alpha.abs().max(beta.abs());
    if most.is_nan() || most > 0.3 {
        let allowed = "between 0 and 0.3; drive larger squares, or measure anew";
        return Err(Error::BadValue { name: "the error of a corner in radians", value: most, allowed });
    }
    let track = robot.track_m * FRAC_PI_2 / (FRAC_PI_2 - alpha);
    // The radius of the arc that a side really is, and the ratio of the wheels that drives it.
    let curve = 2.0 * (beta / 2.0).sin() / side_m;
    let half = curve * robot.track_m / 2.0;
    let [left, right] = robot.wheel_perimeters_m();
    let (left, right) = (left * (1.0 - half), right * (1.0 + half));
    let wheel_difference_rel = 2.0 * (right - left) / (right + left);
    Robot { track_m: track, wheel_difference_rel, ..*robot }.checked()
}
