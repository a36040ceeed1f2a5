//! What the parts take.

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

/// An iCE40 HX8K has 7680 logic cells; where these LUTs are, the others are taken by registers alone.
const HX8K_LUTS: u64 = 5500;
const HX8K_RAMS: u64 = 32;

/// Whether a design with these sizes fits an iCE40 HX8K.
pub(super) fn fits_hx8k(sizes: &[Size]) -> bool {
    sizes.iter().all(|size| match size.what {
        LUTS => size.value <= HX8K_LUTS,
        RAMS => size.value <= HX8K_RAMS,
        _ => true,
    })
}

const LUTS: &str = "LUTs";
const RAMS: &str = "block RAMs of 4 kbit";

/// A block RAM of iCE40, four bits wide.
const RAM_TILES: u64 = 1024;

/// The program and the rule in flash, what the caller gives in RAM.
pub(super) fn firmware(map: &Map, program: &c::Program<'_>) -> Vec<Size> {
    let footprint = c::footprint(map);
    // Bytes of code on a Cortex-M0+.
    let step = if map.lattice() == Lattice::Square { 680 } else { 860 };
    vec![
        about("a step of the rule", "bytes of code", step),
        exact("map", "bytes of flash", footprint.map_bytes),
        exact("program", "bytes of flash", program.bytes()),
        exact("wave", "bytes of RAM while it is used", footprint.wave_bytes),
        exact("learning", "bytes of RAM that always suffice", footprint.levels_bytes),
    ]
}

pub(super) fn windowed(map: &Map) -> Result<Vec<Size>, Error> {
    let tiles = Banks::tiles(map)? as u64;
    let rams = tiles.div_ceil(RAM_TILES);
    let luts = if map.lattice() == Lattice::Square { 500 } else { 610 };
    Ok(vec![
        exact("windowed navigator", "bits of map", 4 * 16 * tiles),
        exact("windowed navigator", RAMS, 16 * rams),
        // Behind several block RAMs a bank, one of four bits is chosen.
        about("windowed navigator", LUTS, luts + 64 * (rams - 1)),
    ])
}

pub(super) fn fabric(map: &Map, is_fixed: bool) -> Vec<Size> {
    // In tenths a cell, free cells alone if the others are wired in; the rest is for rows and columns.
    let (cells, each) = match (map.lattice(), is_fixed) {
        (Lattice::Square, false) => (map.cells(), 94),
        (Lattice::Square, true) => (map.free_cells(), 79),
        (Lattice::Hex, false) => (map.cells(), 143),
        (Lattice::Hex, true) => (map.free_cells(), 113),
    };
    let sides = u64::from(map.width() + map.height());
    vec![about("fabric", LUTS, cells as u64 * each / 10 + 4 * sides)]
}

pub(super) fn player(program: &[Segment]) -> Result<Vec<Size>, Error> {
    let image = ProgramImage::of(program)?;
    Ok(vec![exact("program player", "bits of program", image.bits()), about("program player", LUTS, 80)])
}
