//! What driving a program takes: encoder ticks, time, energy.

use super::{Drive, Program, Robot, Waypoint};

/// Standard gravity, m/s².
const GRAVITY_MPS2: f64 = 9.806_65;

/// What the encoders of the left and the right wheel count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Ticks {
    /// In the run to a waypoint.
    pub run: [i64; 2],
    /// In the turn made there.
    pub turn: [i64; 2],
}

/// What driving a program takes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Effort {
    /// Seconds.
    pub time_s: f64,
    /// Joules drawn from the battery.
    pub energy_j: f64,
}

impl Program {
    /// The encoder ticks of each run and turn, as whole numbers.
    ///
    /// Each wheel's revolutions are added up from the start and rounded where a run or a turn ends, so that what is
    /// rounded away in one is made good in the next: no wheel is ever more than half a tick from where it should be.
    ///
    /// ```
    /// use activecell::{Cell, Lattice, Map, Robot, Rule};
    /// let map = Map::parse(Lattice::Square, "S..\n...\n..F")?;
    /// let route = map.route(Rule::Published, Cell::new(0, 0), Cell::new(2, 2), 100)?;
    /// let robot = Robot { wheel_perimeter_m: 0.7, ticks_per_rev: 10.0, ..Robot::default() };
    /// let ticks = route.program(&robot, &map, None).ticks(&robot);
    /// // Runs of 1 m or 2 m are 14.28 or 28.57 ticks.
    /// assert!(ticks.iter().all(|ticks| ticks.run[0] % 14 <= 1));
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn ticks(&self, robot: &Robot) -> Vec<Ticks> {
        let perimeters_m = robot.wheel_perimeters_m();
        let mut sums = [0.0; 2];
        let mut counted = [0; 2];
        let mut advance = |revolutions: [f64; 2]| {
            std::array::from_fn(|wheel| {
                // Revolutions are those of a wheel of mean perimeter; the way is the same for both.
                let share = robot.wheel_perimeter_m / perimeters_m[wheel];
                sums[wheel] += revolutions[wheel] * share * robot.ticks_per_rev;
                let before = std::mem::replace(&mut counted[wheel], sums[wheel].round() as i64);
                counted[wheel] - before
            })
        };
        let waypoints = self.waypoints.iter().map(|waypoint| {
            let turn = waypoint.turn_revolutions * f64::from(waypoint.turn_deg.signum());
            Ticks { run: advance([waypoint.revolutions; 2]), turn: advance([turn, -turn]) }
        });
        waypoints.collect()
    }

    /// The time and the energy that driving it takes.
    ///
    /// Each run speeds up and slows down with the robot's acceleration, and reaches its highest speed if it is long
    /// enough. The energy is what the robot draws at rest for all that time, and for each run rolling resistance and
    /// the speed that braking wastes; a differential drive's turns cost both too. Climbing costs weight × height;
    /// nothing is gained downhill.
    ///
    /// ```
    /// use activecell::{Cell, Lattice, Map, Robot, Rule};
    /// let map = Map::parse(Lattice::Square, "S..........F")?;
    /// let robot = Robot { max_speed_mps: 1.0, max_accel_mps2: 0.5, ..Robot::default() };
    /// let route = map.route(Rule::Wave, Cell::new(0, 0), Cell::new(10, 0), 100)?;
    /// let effort = route.program(&robot, &map, None).effort(&robot);
    /// assert_eq!(effort.time_s, 12.0); // 2 s and 1 m to full speed, 8 m at 1 m/s, 2 s to brake
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn effort(&self, robot: &Robot) -> Effort {
        let parts = self.waypoints.iter().map(|waypoint| effort(robot, waypoint));
        parts.fold(Effort::default(), |sum, part| Effort {
            time_s: sum.time_s + part.time_s,
            energy_j: sum.energy_j + part.energy_j,
        })
    }
}

impl Robot {
    /// How long a run takes from rest to rest, in seconds; its length may be negative.
    ///
    /// ```
    /// let robot = activecell::Robot { max_speed_mps: 1.0, max_accel_mps2: 0.5, ..activecell::Robot::default() };
    /// assert_eq!((robot.run_s(10.0), robot.run_s(-2.0)), (12.0, 4.0));
    /// ```
    pub fn run_s(&self, length_m: f64) -> f64 {
        let (run_m, speed, accel) = (length_m.abs(), self.max_speed_mps, self.max_accel_mps2);
        if run_m * accel >= speed * speed {
            run_m / speed + speed / accel
        } else {
            2.0 * (run_m / accel).sqrt()
        }
    }

    /// How long a turn takes, in seconds.
    pub fn turn_s(&self, turn_rad: f64) -> f64 {
        turn_rad.abs() / self.turn_rate_radps
    }
}

/// Of one run and the turn after it.
fn effort(robot: &Robot, waypoint: &Waypoint) -> Effort {
    let power = &robot.power;
    let run_m = waypoint.revolutions.abs() * robot.wheel_perimeter_m;
    let top_mps = robot.max_speed_mps.min((run_m * robot.max_accel_mps2).sqrt());
    let run_s = robot.run_s(run_m);
    let turn_s = robot.turn_s(f64::from(waypoint.turn_deg).to_radians());
    let (arc_m, spin_j) = match robot.drive {
        Drive::Differential if waypoint.turn_deg != 0 => {
            // The body as a disc.
            let inertia = 0.5 * power.mass_kg * robot.radius_m.powi(2);
            (
                waypoint.turn_revolutions * robot.wheel_perimeter_m,
                0.5 * inertia * robot.turn_rate_radps.powi(2),
            )
        }
        _ => (0.0, 0.0),
    };
    let drag_j = power.mass_kg * GRAVITY_MPS2 * power.rolling_resistance * (run_m + arc_m);
    let climb_j = power.mass_kg * GRAVITY_MPS2 * waypoint.climb_m;
    let speed_j = 0.5 * power.mass_kg * top_mps.powi(2);
    let time_s = run_s + turn_s;
    let wheels_j = drag_j + climb_j + speed_j + spin_j;
    Effort { time_s, energy_j: power.idle_w * time_s + wheels_j / power.drive_efficiency }
}
