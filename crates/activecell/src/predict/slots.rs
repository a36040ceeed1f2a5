//! How time is cut into slots.

use super::window::FARTHEST;
use super::within;
use crate::error::Error;

/// How time is cut, and how far the robot looks ahead.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slots {
    /// The longest time that the robot needs to reach a neighbouring cell: turning, starting and braking included.
    /// Default 1 s.
    pub slot_s: f64,
    /// The radius of the robot, and how far it may be off its way. Default 0.2 m.
    pub robot_radius_m: f64,
    /// In so many slots all that objects can reach is closed. More: safer, and more timid. Default 3.
    pub certain: u8,
    /// Having come no nearer for so many slots, the robot looks one certain slot less ahead, down to one. Default 12.
    pub patience: u8,
    /// In so many more slots the places where they are likely to be are closed. Default 5.
    pub likely: u8,
    /// An object that has stood for so long is gone round like an obstacle. Default 3 s.
    pub parked_s: f64,
}

impl Default for Slots {
    fn default() -> Self {
        Self { slot_s: 1.0, robot_radius_m: 0.2, certain: 3, patience: 12, likely: 5, parked_s: 3.0 }
    }
}

impl Slots {
    /// Checks that the numbers make sense.
    ///
    /// # Errors
    /// [`Error::BadValue`]: at least one certain slot, at most 31 in all; times and radius are numbers, the slot's
    /// above 0.
    pub fn checked(self) -> Result<Self, Error> {
        within("the time of a slot in seconds", self.slot_s, 1e-3, 1e6, "from 0.001 to 1000000")?;
        within("the robot's radius in metres", self.robot_radius_m, 0.0, 1e6, "from 0 to 1000000")?;
        within(
            "the time after which an object is parked",
            self.parked_s,
            0.0,
            f64::INFINITY,
            "at least 0 s",
        )?;
        within("the number of certain slots", self.certain.into(), 1.0, FARTHEST.into(), "from 1 to 31")?;
        let all = f64::from(self.certain) + f64::from(self.likely);
        within(
            "the number of slots foreseen",
            all,
            1.0,
            FARTHEST.into(),
            "at most 31, certain and likely ones",
        )?;
        Ok(self)
    }

    /// How many slots are foreseen.
    pub(super) const fn count(&self) -> u8 {
        self.certain + self.likely
    }
}
