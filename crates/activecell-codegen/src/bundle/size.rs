//! What the parts take.

use super::Language;
use crate::images::ProgramImage;
use crate::model::player::Segment;
use crate::{Banks, c};
use activecell::{Error, Lattice, Map};

/// One number of the report of sizes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Size {
    /// The part.
    pub part: &'static str,
    /// What is counted, with its unit.
    pub what: &'static str,
    /// The number.
    pub value: u64,
    /// Reckoned from what was measured on other maps (`docs/hardware.md`); `make synth` or `make size` tells exactly.
    pub estimated: bool,
}

const fn exact(part: &'static str, what: &'static str, value: u64) -> Size {
    Size { part, what, value, estimated: false }
}

const fn about(part: &'static str, what: &'static str, value: u64) -> Size {
    Size { part, what, value, estimated: true }
}

/// LUTs with four inputs of iCE40, as `make hardware` measured them.
mod measured {
    pub(super) const WINDOWED_SQUARE_LUTS: u64 = 700;
    pub(super) const WINDOWED_HEX_LUTS: u64 = 900;
    pub(super) const FABRIC_LOADED_LUTS_PER_CELL: u64 = 14;
    pub(super) const FABRIC_FIXED_LUTS_PER_CELL: u64 = 7;
    pub(super) const PLAYER_LUTS: u64 = 150;
    /// Of a Cortex-M, in bytes.
    pub(super) const RULE_CODE_BYTES: u64 = 600;
}

/// A block RAM of iCE40, four bits wide.
const RAM_TILES: u64 = 1024;

/// What the parts take of flash and memory, or of an FPGA.
pub(super) fn sizes(
    language: Language,
    map: &Map,
    program: &[Segment],
    fabric: Option<bool>,
) -> Result<Vec<Size>, Error> {
    if language == Language::C {
        let footprint = c::footprint(map);
        return Ok(vec![
            about("rule and window", "bytes of code", measured::RULE_CODE_BYTES),
            exact("map", "bytes of flash", footprint.map_bytes),
            exact("program", "bytes of flash", 8 * program.len() as u64),
            exact("wave", "bytes of RAM while it is used", footprint.wave_bytes),
            exact("learning", "bytes of RAM that always suffice", footprint.levels_bytes),
        ]);
    }
    let banks = Banks::of(map)?;
    let tiles = banks.images.first().map_or(0, Vec::len) as u64;
    let windowed = match map.lattice() {
        Lattice::Square => measured::WINDOWED_SQUARE_LUTS,
        Lattice::Hex => measured::WINDOWED_HEX_LUTS,
    };
    let image = ProgramImage::of(program)?;
    let mut sizes = vec![
        exact("windowed navigator", "bits of map", 4 * 16 * tiles),
        exact("windowed navigator", "block RAMs of 4 kbit", 16 * tiles.div_ceil(RAM_TILES)),
        about("windowed navigator", "LUTs", windowed),
    ];
    if let Some(is_fixed) = fabric {
        let each = if is_fixed {
            measured::FABRIC_FIXED_LUTS_PER_CELL
        } else {
            measured::FABRIC_LOADED_LUTS_PER_CELL
        };
        sizes.push(about("fabric", "LUTs", each * map.cells() as u64));
    }
    sizes.push(exact("program player", "bits of program", image.bits()));
    sizes.push(about("program player", "LUTs", measured::PLAYER_LUTS));
    Ok(sizes)
}
