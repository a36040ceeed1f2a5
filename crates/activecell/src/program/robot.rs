//! The robot: its wheels, its size, its errors and sensors, each with a unit and a default.

use crate::error::Error;
use std::f64::consts::TAU;

/// How a robot turns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Drive {
    /// The paper's: the wheels turn to the new direction, the body does not; a turn costs no revolution.
    Steered,
    /// Two driven wheels: the body turns in place, each wheel rolling an arc of angle × track ÷ 2, with
    /// opposite signs.
    #[default]
    Differential,
}

impl Drive {
    /// The drive's name in the robot file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Steered => "steered",
            Self::Differential => "differential",
        }
    }
}

/// A robot. The defaults are a small one with wheels of 64 mm.
///
/// ```
/// use activecell::Robot;
/// let robot = Robot { wheel_perimeter_m: 1.0, ..Robot::default() };
/// assert_eq!(robot.revolutions(10.0), 10.0); // 10 m at a perimeter of 1 m
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Robot {
    /// The way that a wheel rolls in one revolution. Default 0.2 m.
    pub wheel_perimeter_m: f64,
    /// The distance between the two driven wheels. Default 0.16 m.
    pub track_m: f64,
    /// The radius of the disc that the robot covers. Default 0.1 m.
    pub radius_m: f64,
    /// How it turns. Default differential.
    pub drive: Drive,
    /// Whether it can drive backwards. Default true.
    pub can_reverse: bool,
    /// Highest speed. Default 0.3 m/s.
    pub max_speed_mps: f64,
    /// Highest acceleration. Default 0.5 m/s².
    pub max_accel_mps2: f64,
    /// Highest turn rate. Default 1.5 rad/s.
    pub turn_rate_radps: f64,
    /// Where it goes wrong.
    pub errors: Errors,
    /// What it sees.
    pub sensors: Sensors,
}

/// One standard deviation of each of the robot's error sources.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Errors {
    /// Wheel geometry: relative error of the perimeter. Default 0.005.
    pub wheel_perimeter_rel: f64,
    /// Uneven floor: position error that grows with the square root of the way. Default 0.005 m/√m.
    pub unevenness_m_per_sqrt_m: f64,
    /// Division of the floor into cells: how far a cell's centre is from where the map says. Default 0.005 m.
    pub cell_division_m: f64,
    /// Shaft inertia: how far the robot rolls on at a stop. Default 0.003 m.
    pub stop_inertia_m: f64,
    /// Each turn's angle. Default 0.01 rad.
    pub turn_rad: f64,
    /// The start position. Default 0.01 m.
    pub start_m: f64,
    /// The start heading. Default 0.01 rad.
    pub start_rad: f64,
}

/// The robot's distance sensors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensors {
    /// How far they see. Default 2 m.
    pub range_m: f64,
    /// One standard deviation of a reading. Default 0.02 m.
    pub noise_m: f64,
}

impl Default for Robot {
    fn default() -> Self {
        Self {
            wheel_perimeter_m: 0.2,
            track_m: 0.16,
            radius_m: 0.1,
            drive: Drive::default(),
            can_reverse: true,
            max_speed_mps: 0.3,
            max_accel_mps2: 0.5,
            turn_rate_radps: 1.5,
            errors: Errors::default(),
            sensors: Sensors::default(),
        }
    }
}

impl Default for Errors {
    fn default() -> Self {
        Self {
            wheel_perimeter_rel: 0.005,
            unevenness_m_per_sqrt_m: 0.005,
            cell_division_m: 0.005,
            stop_inertia_m: 0.003,
            turn_rad: 0.01,
            start_m: 0.01,
            start_rad: 0.01,
        }
    }
}

impl Default for Sensors {
    fn default() -> Self {
        Self { range_m: 2.0, noise_m: 0.02 }
    }
}

impl Robot {
    /// Checks that every number is one a real robot could have.
    ///
    /// # Errors
    /// [`Error::BadValue`] names the first key that is out of its range.
    pub fn checked(self) -> Result<Self, Error> {
        let (errors, sensors) = (&self.errors, &self.sensors);
        let positive = [
            ("wheel_perimeter_m", self.wheel_perimeter_m),
            ("track_m", self.track_m),
            ("max_speed_mps", self.max_speed_mps),
            ("max_accel_mps2", self.max_accel_mps2),
            ("turn_rate_radps", self.turn_rate_radps),
        ];
        let not_negative = [
            ("radius_m", self.radius_m),
            ("errors.wheel_perimeter_rel", errors.wheel_perimeter_rel),
            ("errors.unevenness_m_per_sqrt_m", errors.unevenness_m_per_sqrt_m),
            ("errors.cell_division_m", errors.cell_division_m),
            ("errors.stop_inertia_m", errors.stop_inertia_m),
            ("errors.turn_rad", errors.turn_rad),
            ("errors.start_m", errors.start_m),
            ("errors.start_rad", errors.start_rad),
            ("sensors.range_m", sensors.range_m),
            ("sensors.noise_m", sensors.noise_m),
        ];
        for (name, value) in positive {
            if !(1e-6..=1e6).contains(&value) {
                return Err(Error::BadValue { name, value, allowed: "between 0.000001 and 1000000" });
            }
        }
        for (name, value) in not_negative {
            if !(0.0..=1e6).contains(&value) {
                return Err(Error::BadValue { name, value, allowed: "between 0 and 1000000" });
            }
        }
        Ok(self)
    }

    /// The wheel revolutions of a straight run.
    pub fn revolutions(&self, length_m: f64) -> f64 {
        length_m / self.wheel_perimeter_m
    }

    /// The revolutions that each wheel makes in a turn in place; none if the wheels are steered.
    pub fn turn_revolutions(&self, turn_deg: i32) -> f64 {
        match self.drive {
            Drive::Steered => 0.0,
            Drive::Differential => {
                let angle_rad = f64::from(turn_deg.abs()) / 360.0 * TAU;
                self.revolutions(angle_rad * self.track_m / 2.0)
            }
        }
    }
}
