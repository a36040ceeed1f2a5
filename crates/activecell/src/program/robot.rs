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
    /// The way that a wheel rolls in one revolution, the mean of both wheels. Default 0.2 m.
    pub wheel_perimeter_m: f64,
    /// The right wheel's perimeter less the left one's, as a share of their mean. Default 0.
    pub wheel_difference_rel: f64,
    /// Encoder ticks in one wheel revolution. Default 2048.
    pub ticks_per_rev: f64,
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
    /// What it weighs and draws.
    pub power: Power,
    /// What it can climb.
    pub slopes: Slopes,
    /// Where it goes wrong.
    pub errors: Errors,
    /// What it sees.
    pub sensors: Sensors,
}

/// What a robot weighs and draws, for the energy of a program.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Power {
    /// Default 3 kg.
    pub mass_kg: f64,
    /// Drag of the rolling wheels, as a share of the weight. Default 0.02.
    pub rolling_resistance: f64,
    /// What it draws at rest: computer and sensors. Default 5 W.
    pub idle_w: f64,
    /// The share of the battery's power that reaches the wheels. Default 0.6.
    pub drive_efficiency: f64,
}

/// The slopes that a robot can drive on, and what climbing is worth avoiding.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slopes {
    /// The steepest way up. Default 12°.
    pub up_max_deg: f64,
    /// The steepest way down. Default 15°.
    pub down_max_deg: f64,
    /// The steepest slope to stand or drive across. Default 10°.
    pub across_max_deg: f64,
    /// The level way that the robot would rather drive than climb one metre. Default 0 m/m: shortest on the ground.
    pub climb_cost_m_per_m: f64,
}

/// One standard deviation of each of the robot's error sources.
///
/// The first three are *systematic*: drawn once for a robot, the same on its whole way. The others are *noise*: new
/// in each piece of way, at each stop, each turn. How they move the robot is told at [`Motion`](super::Motion).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Errors {
    /// Wheel geometry: relative error of the perimeter, alike on both wheels. Default 0.005.
    pub wheel_perimeter_rel: f64,
    /// Wheel geometry: error of [`Robot::wheel_difference_rel`]; differential drives only. Default 0.0005.
    pub wheel_difference_rel: f64,
    /// Wheel geometry: relative error of the track; differential drives only. Default 0.005.
    pub track_rel: f64,
    /// Uneven floor: error of a wheel's way, which grows with the square root of the way. Default 0.001 m/√m.
    pub unevenness_m_per_sqrt_m: f64,
    /// Division of the floor into cells: how far a cell's centre is from where the map says, along each axis.
    /// Default 0.005 m.
    pub cell_division_m: f64,
    /// Shaft inertia: how far the robot rolls on, or stops short, at a stop. Default 0.003 m.
    pub stop_inertia_m: f64,
    /// Each turn's angle. Default 0.01 rad.
    pub turn_rad: f64,
    /// The start position, along each axis. Default 0.01 m.
    pub start_m: f64,
    /// The start heading. Default 0.01 rad.
    pub start_rad: f64,
}

/// The robot's distance sensors: beams from its centre, at equal angles all around, the first straight ahead.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensors {
    /// How far they see, from the robot's centre. Default 2 m.
    pub range_m: f64,
    /// One standard deviation of a reading. Default 0.02 m.
    pub noise_m: f64,
    /// How many beams. Default 12, of which some look along every direction of both lattices.
    pub beams: u32,
    /// The share of readings that are false: anything between nothing and the range. Default 0.01.
    pub false_rate: f64,
}

impl Default for Robot {
    fn default() -> Self {
        Self {
            wheel_perimeter_m: 0.2,
            wheel_difference_rel: 0.0,
            ticks_per_rev: 2048.0,
            track_m: 0.16,
            radius_m: 0.1,
            drive: Drive::default(),
            can_reverse: true,
            max_speed_mps: 0.3,
            max_accel_mps2: 0.5,
            turn_rate_radps: 1.5,
            power: Power::default(),
            slopes: Slopes::default(),
            errors: Errors::default(),
            sensors: Sensors::default(),
        }
    }
}

impl Default for Power {
    fn default() -> Self {
        Self { mass_kg: 3.0, rolling_resistance: 0.02, idle_w: 5.0, drive_efficiency: 0.6 }
    }
}

impl Default for Slopes {
    fn default() -> Self {
        Self { up_max_deg: 12.0, down_max_deg: 15.0, across_max_deg: 10.0, climb_cost_m_per_m: 0.0 }
    }
}

impl Default for Errors {
    fn default() -> Self {
        Self {
            wheel_perimeter_rel: 0.005,
            wheel_difference_rel: 0.0005,
            track_rel: 0.005,
            unevenness_m_per_sqrt_m: 0.001,
            cell_division_m: 0.005,
            stop_inertia_m: 0.003,
            turn_rad: 0.01,
            start_m: 0.01,
            start_rad: 0.01,
        }
    }
}

impl Errors {
    /// No error at all.
    pub const NONE: Self = Self {
        wheel_perimeter_rel: 0.0,
        wheel_difference_rel: 0.0,
        track_rel: 0.0,
        unevenness_m_per_sqrt_m: 0.0,
        cell_division_m: 0.0,
        stop_inertia_m: 0.0,
        turn_rad: 0.0,
        start_m: 0.0,
        start_rad: 0.0,
    };
}

impl Default for Sensors {
    fn default() -> Self {
        Self { range_m: 2.0, noise_m: 0.02, beams: 12, false_rate: 0.01 }
    }
}

/// The range of a value: least, most, and both in words.
type Range = (f64, f64, &'static str);
const POSITIVE: Range = (1e-6, 1e6, "between 0.000001 and 1000000");
const NOT_NEGATIVE: Range = (0.0, 1e6, "between 0 and 1000000");
/// Beyond it a wheel would be no wheel any more.
const RELATIVE: Range = (0.0, 0.3, "between 0 and 0.3");
const SLOPE: Range = (0.0, 80.0, "between 0 and 80");

impl Robot {
    /// Checks that every number is one a real robot could have.
    ///
    /// # Errors
    /// [`Error::BadValue`] names the first key that is out of its range.
    pub fn checked(self) -> Result<Self, Error> {
        let (power, slopes, errors, sensors) = (&self.power, &self.slopes, &self.errors, &self.sensors);
        let values: [(&'static str, f64, Range); 29] = [
            ("wheel_perimeter_m", self.wheel_perimeter_m, POSITIVE),
            ("wheel_difference_rel", self.wheel_difference_rel, (-0.3, 0.3, "between -0.3 and 0.3")),
            ("ticks_per_rev", self.ticks_per_rev, (1.0, 1e9, "between 1 and 1000000000")),
            ("track_m", self.track_m, POSITIVE),
            ("radius_m", self.radius_m, NOT_NEGATIVE),
            ("max_speed_mps", self.max_speed_mps, POSITIVE),
            ("max_accel_mps2", self.max_accel_mps2, POSITIVE),
            ("turn_rate_radps", self.turn_rate_radps, POSITIVE),
            ("power.mass_kg", power.mass_kg, POSITIVE),
            ("power.rolling_resistance", power.rolling_resistance, (0.0, 10.0, "between 0 and 10")),
            ("power.idle_w", power.idle_w, NOT_NEGATIVE),
            ("power.drive_efficiency", power.drive_efficiency, (0.01, 1.0, "between 0.01 and 1")),
            ("slopes.up_max_deg", slopes.up_max_deg, SLOPE),
            ("slopes.down_max_deg", slopes.down_max_deg, SLOPE),
            ("slopes.across_max_deg", slopes.across_max_deg, SLOPE),
            ("slopes.climb_cost_m_per_m", slopes.climb_cost_m_per_m, (0.0, 1e3, "between 0 and 1000")),
            ("errors.wheel_perimeter_rel", errors.wheel_perimeter_rel, RELATIVE),
            ("errors.wheel_difference_rel", errors.wheel_difference_rel, RELATIVE),
            ("errors.track_rel", errors.track_rel, RELATIVE),
            ("errors.unevenness_m_per_sqrt_m", errors.unevenness_m_per_sqrt_m, NOT_NEGATIVE),
            ("errors.cell_division_m", errors.cell_division_m, NOT_NEGATIVE),
            ("errors.stop_inertia_m", errors.stop_inertia_m, NOT_NEGATIVE),
            ("errors.turn_rad", errors.turn_rad, NOT_NEGATIVE),
            ("errors.start_m", errors.start_m, NOT_NEGATIVE),
            ("errors.start_rad", errors.start_rad, NOT_NEGATIVE),
            ("sensors.range_m", sensors.range_m, NOT_NEGATIVE),
            ("sensors.noise_m", sensors.noise_m, NOT_NEGATIVE),
            ("sensors.beams", f64::from(sensors.beams), (1.0, 3600.0, "a whole number between 1 and 3600")),
            ("sensors.false_rate", sensors.false_rate, (0.0, 0.5, "between 0 and 0.5")),
        ];
        for (name, value, (least, most, allowed)) in values {
            if !(least..=most).contains(&value) {
                return Err(Error::BadValue { name, value, allowed });
            }
        }
        Ok(self)
    }

    /// The wheel revolutions of a straight run, the mean of both wheels.
    pub fn revolutions(&self, length_m: f64) -> f64 {
        length_m / self.wheel_perimeter_m
    }

    /// The perimeters of the left and the right wheel, in metres.
    pub fn wheel_perimeters_m(&self) -> [f64; 2] {
        let half = self.wheel_difference_rel / 2.0;
        [self.wheel_perimeter_m * (1.0 - half), self.wheel_perimeter_m * (1.0 + half)]
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
