//! The navigators as models: what the generated hardware must do, clock by clock, in Rust.

pub mod fabric;
