//! Floors that change, that cost more here than there, and that are kept clear: against naive twins.

#![expect(clippy::unwrap_used, reason = "a test that cannot make its floors should stop")]

mod clearance;
mod live;
mod real;
mod terrain;
mod twins;
