//! The control unit with its state, and the program player around it.

use super::module;
use crate::images::{PlayerBench, ProgramImage};
use crate::model::player::Segment;
use crate::template::fill;
use crate::{SourceFile, circuits, motors};
use activecell::control::State;
use activecell::{Drive, Error};

/// The control unit of the core as a state machine: `control_unit`, and its table `control_next`.
///
/// ```
/// let files = activecell_codegen::verilog::control_unit();
/// let paths: Vec<&str> = files.iter().map(|file| file.path.as_str()).collect();
/// assert_eq!(paths, ["rtl/control_next.v", "rtl/control_unit.v"]);
/// ```
pub fn control_unit() -> Vec<SourceFile> {
    let calm = (State::Calm as u8).to_string();
    let unit =
        fill(include_str!("templates/control_unit.v"), &[("CALM", calm), ("STATES", motors::table("//"))]);
    vec![
        SourceFile::new("rtl/control_next.v", module(&circuits::control())),
        SourceFile::new("rtl/control_unit.v", unit),
    ]
}

/// The player of a program ([`crate::model::player`]): `player_top` for the pins of a chip, in it `player`, the
/// test bench `player_tb`, and the example `player_example_tb`. The drive tells whether a turn's ticks are the steering's.
///
/// # Errors
/// [`Error::BadValue`] for more segments than the player counts, and for segments without a tick.
///
/// ```
/// use activecell::Drive;
/// use activecell_codegen::{model::player::{Motion, Segment}, verilog};
/// let files = verilog::player(&[Segment { motion: Motion::Forward, ticks: 200 }], Drive::Differential)?;
/// let image = files.iter().find(|file| file.path == "rtl/player.hex").unwrap();
/// assert_eq!(image.text, "4c8 // 0: forward, 200 ticks\n000 // 1: the end\n");
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn player(segments: &[Segment], drive: Drive) -> Result<Vec<SourceFile>, Error> {
    let image = ProgramImage::of(segments)?;
    let bench = PlayerBench::of(segments, drive);
    let values = [
        ("SEGMENTS", image.segments.to_string()),
        ("SEGMENT_BITS", image.segment_bits.to_string()),
        ("TICK_BITS", image.tick_bits.to_string()),
        ("LINES", bench.lines.to_string()),
        ("TICKS_MAX", bench.ticks_max.to_string()),
        ("ABOUT_TICKS", bench.about),
        ("STEERED", u8::from(drive == Drive::Steered).to_string()),
        ("STATES", motors::table("//")),
        ("CASES", motors::cases(|q, name| format!("            4'b{q}: motion = \"{name}\";"))),
    ];
    let mut files = control_unit();
    files.extend([
        SourceFile::new("rtl/player_inputs.v", module(&circuits::player())),
        SourceFile::new("rtl/encoder_edge.v", include_str!("templates/encoder_edge.v")),
        SourceFile::new("rtl/player.v", fill(include_str!("templates/player.v"), &values)),
        image.hex(),
        SourceFile::new("rtl/player_top.v", fill(include_str!("templates/player_top.v"), &values)),
        SourceFile::new("tb/player_tb.v", fill(include_str!("templates/player_tb.v"), &values)),
        SourceFile::new(
            "tb/player_example_tb.v",
            fill(include_str!("templates/player_example_tb.v"), &values),
        ),
        bench.hex,
    ]);
    Ok(files)
}
