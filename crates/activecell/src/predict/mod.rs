//! Moving objects: where they will be, which cells that closes when, and how the robot waits or goes round them in
//! space and time. The paper's *movement trajectory prediction unit*.
//!
//! ```text
//! positions seen ──Track──▶ reach, forecast ──Closures──▶ closed cells a slot ──wave in space-time──▶ Plan
//! ```
//!
//! Time is cut into *slots*: in each the robot stays in its cell or moves to a neighbour.

mod avoid;
mod capsule;
mod closures;
mod contact;
mod plan;
mod slots;
mod track;
mod turning;
mod window;

pub use avoid::Avoider;
pub use capsule::Capsule;
pub use closures::Closures;
pub(crate) use closures::likely;
pub use contact::{Contact, first_contact};
pub use plan::{Facing, Plan, Step};
pub use slots::Slots;
pub use track::{Bounds, Track};
pub use turning::{Forecast, Turning};

use crate::error::Error;

/// Refuses a number that is not within `least..=most`, NaN among them.
fn within(name: &'static str, value: f64, least: f64, most: f64, allowed: &'static str) -> Result<(), Error> {
    if (least..=most).contains(&value) { Ok(()) } else { Err(Error::BadValue { name, value, allowed }) }
}
