//! How a robot really moves when it drives what a program says: the one model of its errors, which the certificate
//! linearizes and the simulation draws.

use super::robot::{Drive, Errors, Robot};
use crate::map::PointM;
use crate::rng::Rng;

/// Where a robot is and where it faces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// x right, y up, in metres of the map's frame.
    pub at_m: PointM,
    /// Counter-clockwise from the x axis.
    pub bearing_rad: f64,
}

impl Pose {
    /// The point that lies `ahead_m` in front and `left_m` to the left.
    pub fn point(&self, ahead_m: f64, left_m: f64) -> PointM {
        let (sin, cos) = self.bearing_rad.sin_cos();
        [self.at_m[0] + ahead_m * cos - left_m * sin, self.at_m[1] + ahead_m * sin + left_m * cos]
    }
}

/// A robot's wheels as they really are, as shares of what its file says: the systematic errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wheels {
    /// The mean perimeter ÷ that of the file.
    pub perimeter: f64,
    /// How much more the right wheel's perimeter exceeds the left one's than in the file, as a share of their mean.
    pub difference: f64,
    /// The track ÷ that of the file.
    pub track: f64,
}

impl Wheels {
    /// Wheels that are as the file says.
    pub const NOMINAL: Self = Self { perimeter: 1.0, difference: 0.0, track: 1.0 };

    /// Wheels drawn by chance, as far off as `errors` says.
    pub fn drawn(errors: &Errors, rng: &mut Rng) -> Self {
        // No wheel and no track is ever less than a tenth of what it should be.
        let share = |deviation: f64| (1.0 + deviation).max(0.1);
        Self {
            perimeter: share(errors.wheel_perimeter_rel * rng.normal()),
            difference: errors.wheel_difference_rel * rng.normal(),
            track: share(errors.track_rel * rng.normal()),
        }
    }
}

/// What a run does to the heading of a robot with these wheels.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Veering {
    /// The turn that the wheels' difference makes, in radians a metre.
    pub(crate) bend: f64,
    /// The variance that the floor adds, in square radians a metre.
    pub(crate) wander: f64,
}

impl Wheels {
    /// What a run does to the heading.
    pub(crate) fn veering(&self, robot: &Robot) -> Veering {
        if robot.drive == Drive::Steered {
            return Veering { bend: 0.0, wander: 0.0 };
        }
        let track_m = robot.track_m * self.track;
        let wander = 2.0 * (robot.errors.unevenness_m_per_sqrt_m / track_m).powi(2);
        Veering { bend: self.difference * self.perimeter / track_m, wander }
    }
}

impl Veering {
    /// In how many pieces a metre is driven, so that the heading changes little in each.
    pub(crate) fn pieces_a_metre(self) -> f64 {
        (self.bend.abs() / PIECE_RAD).max(self.wander / PIECE_RAD.powi(2))
    }
}

/// The heading wanders by less than this in one piece of a run: about 6°.
const PIECE_RAD: f64 = 0.1;
/// A run is driven in this many pieces at the most.
const MAX_PIECES: f64 = 10_000.0;

/// A robot on its way. With ε, δ and τ the deviations of perimeter, difference and track ([`Wheels`]), k the
/// unevenness of the floor, b the track:
///
/// - *A run* of length s becomes s (1 + ε) long. A differential drive leaves the straight line by the angle δ s ÷ b,
///   and the wheels' ways have independent noise of variance k² s each: the run's length has variance k² s ÷ 2, the
///   heading 2 k² s ÷ b², and both bend the way while it is driven. A steered drive keeps its heading; its position
///   has variance k² s along and across.
/// - *A stop* adds noise along the heading (shaft inertia).
/// - *A turn* by α becomes α (1 + ε) ÷ (1 + τ) with a differential drive, α with a steered one, and has noise.
///
/// Source of the wheel noise: Chong and Kleeman, *Accurate Odometry and Error Modelling for a Mobile Robot*, 1997.
///
/// ```
/// use activecell::{Errors, Motion, Pose, Rng, Robot, Wheels};
/// let robot = Robot { errors: Errors::NONE, ..Robot::default() };
/// let start = Pose { at_m: [0.0, 0.0], bearing_rad: 0.0 };
/// let mut motion = Motion::new(&robot, Wheels { perimeter: 1.01, ..Wheels::NOMINAL }, start);
/// motion.roll(10.0, &mut Rng::new(1));
/// assert!((motion.pose.at_m[0] - 10.1).abs() < 1e-12); // its wheels are 1 % too large
/// ```
#[derive(Debug, Clone)]
pub struct Motion<'a> {
    robot: &'a Robot,
    wheels: Wheels,
    /// Where it really is.
    pub pose: Pose,
}

impl<'a> Motion<'a> {
    /// A robot with these wheels at that pose.
    pub const fn new(robot: &'a Robot, wheels: Wheels, pose: Pose) -> Self {
        Self { robot, wheels, pose }
    }

    /// A robot with wheels and a start pose drawn by chance around `pose`.
    pub fn drawn(robot: &'a Robot, pose: Pose, rng: &mut Rng) -> Self {
        let errors = &robot.errors;
        let wheels = Wheels::drawn(errors, rng);
        let [x, y] = pose.at_m;
        let at_m = [x + errors.start_m * rng.normal(), y + errors.start_m * rng.normal()];
        Self::new(
            robot,
            wheels,
            Pose { at_m, bearing_rad: pose.bearing_rad + errors.start_rad * rng.normal() },
        )
    }

    /// Drives a run of this length, or a part of one, backwards if it is negative. Driving it in parts is the same
    /// in law.
    pub fn roll(&mut self, length_m: f64, rng: &mut Rng) {
        let variance_m = self.robot.errors.unevenness_m_per_sqrt_m.powi(2); // a metre
        let veering = self.wheels.veering(self.robot);
        let Veering { bend, wander } = veering;
        let pieces = (length_m.abs() * veering.pieces_a_metre()).ceil().clamp(1.0, MAX_PIECES);
        let piece_m = length_m / pieces;
        for _ in 0..pieces as u32 {
            let size_m = piece_m.abs();
            let turned = bend * piece_m + (wander * size_m).sqrt() * rng.normal();
            let (ahead_variance, left_variance) = match self.robot.drive {
                Drive::Steered => (variance_m * size_m, variance_m * size_m),
                // What the heading did inside the piece, beyond half of what it did over it.
                Drive::Differential => (variance_m * size_m / 2.0, wander * size_m.powi(3) / 12.0),
            };
            let ahead_m = piece_m * self.wheels.perimeter + ahead_variance.sqrt() * rng.normal();
            self.arc(ahead_m, left_variance.sqrt() * rng.normal(), turned);
        }
    }

    /// A piece of way along an arc.
    fn arc(&mut self, ahead_m: f64, left_m: f64, turned_rad: f64) {
        let half = turned_rad / 2.0;
        let chord = if half == 0.0 { ahead_m } else { ahead_m * half.sin() / half };
        self.pose.bearing_rad += half;
        self.pose.at_m = self.pose.point(chord, left_m);
        self.pose.bearing_rad += half;
    }

    /// Comes to rest after a run.
    pub fn stop(&mut self, rng: &mut Rng) {
        self.pose.at_m = self.pose.point(self.robot.errors.stop_inertia_m * rng.normal(), 0.0);
    }

    /// Turns by this angle, counter-clockwise positive.
    pub fn turn(&mut self, turn_rad: f64, rng: &mut Rng) {
        let scale = match self.robot.drive {
            Drive::Steered => 1.0,
            Drive::Differential => self.wheels.perimeter / self.wheels.track,
        };
        self.pose.bearing_rad += turn_rad * scale + self.robot.errors.turn_rad * rng.normal();
    }
}
