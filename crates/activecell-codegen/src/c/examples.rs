//! The examples: a plain program, and one for a board that is large enough.

use super::Footprint;
use crate::SourceFile;
use crate::circuits::neighbourhood;
use crate::template::fill;
use activecell::rule::{Decision, Sector, decide};
use activecell::{Dir, Lattice};

/// A board that QEMU emulates, with the memory that the linker may use.
struct Board {
    name: &'static str,
    processor: &'static str,
    machine: &'static str,
    flash_kib: u64,
    ram_kib: u64,
}

/// The smallest first. QEMU's micro:bit has a Cortex-M0, of the same instructions as the M0+.
const BOARDS: [Board; 2] = [
    Board {
        name: "the BBC micro:bit",
        processor: "cortex-m0plus",
        machine: "microbit",
        flash_kib: 256,
        ram_kib: 16,
    },
    Board {
        name: "Arm's MPS2 with a Cortex-M4 (AN386)",
        processor: "cortex-m4",
        machine: "mps2-an386",
        flash_kib: 4096,
        ram_kib: 4096,
    },
];

/// Kept free for the stack, and for the code.
const STACK_BYTES: u64 = 2048;
const CODE_BYTES: u64 = 16_384;

impl Board {
    const fn holds(&self, flash_bytes: u64, ram_bytes: u64) -> bool {
        flash_bytes <= 1024 * self.flash_kib && ram_bytes <= 1024 * self.ram_kib
    }
}

/// The examples and what they need.
pub(super) fn examples(footprint: Footprint, program_bytes: u64) -> Vec<SourceFile> {
    let flash = footprint.map_bytes + program_bytes + CODE_BYTES;
    let ram = footprint.wave_bytes + STACK_BYTES;
    let [small, large] = &BOARDS;
    let board = if small.holds(flash, ram) { small } else { large };
    let too_large = if board.holds(flash, ram) {
        String::new()
    } else {
        format!(" {flash} bytes of flash and {ram} of RAM are needed: more than {} has", board.name)
    };
    let values = [
        ("BOARD", board.name),
        ("CPU", board.processor),
        ("MACHINE", board.machine),
        ("FLASH_KIB", &board.flash_kib.to_string()),
        ("RAM_KIB", &board.ram_kib.to_string()),
        ("WAVE_BYTES", &footprint.wave_bytes.to_string()),
        ("MAP_BYTES", &footprint.map_bytes.to_string()),
        ("TOO_LARGE", &too_large),
    ];
    let files = [
        ("main.c", include_str!("templates/examples/main.c")),
        ("robot.c", include_str!("templates/examples/robot.c")),
        ("cortex_m.c", include_str!("templates/examples/cortex_m.c")),
        ("startup.c", include_str!("templates/examples/startup.c")),
        ("startup.h", include_str!("templates/examples/startup.h")),
        ("cortex_m.ld", include_str!("templates/examples/cortex_m.ld")),
        ("board.mk", include_str!("templates/examples/board.mk")),
    ];
    files.map(|(name, text)| SourceFile::new(format!("examples/{name}"), fill(text, &values))).into()
}

/// What `decisions` of the plain example gives if the rule is the core's: on squares over every input.
pub(super) fn checksum(lattice: Lattice) -> u32 {
    let lanes = u32::from(lattice.degree());
    let sectors: Vec<Sector> = Sector::all(lattice).collect();
    (0..0x1_0000u32).fold(2_166_136_261, |sum, number| {
        let input = number.wrapping_mul(2_654_435_769);
        let sector = sectors[(input >> 1) as usize % sectors.len()];
        let groups = [0, 1, 2].map(|group| input >> (4 + group * lanes));
        let next = match decide(lattice, sector, input & 1 == 1, neighbourhood(lattice, groups)) {
            Decision::Move(Dir(number)) => number.into(),
            Decision::Enclosed => ENCLOSED,
        };
        (sum ^ next).wrapping_mul(16_777_619)
    })
}

/// `AC_ENCLOSED`.
const ENCLOSED: u32 = 9;
