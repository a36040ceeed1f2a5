//! VHDL-93.

mod circuit;
mod fabric;
mod player;
mod windowed;

pub use circuit::{entity, lanes};
pub use fabric::fabric;
pub use player::{control_unit, player};
pub use windowed::windowed;

use crate::SourceFile;

/// The package with which test benches read their files.
fn bench_lines() -> SourceFile {
    SourceFile::new("tb/hex_lines.vhd", include_str!("templates/hex_lines.vhd"))
}
