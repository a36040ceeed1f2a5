//! The control unit with its state, and the program player around it.

use super::{bench_lines, entity, lanes};
use crate::images::{PlayerBench, ProgramImage};
use crate::model::player::Segment;
use crate::template::fill;
use crate::{SourceFile, circuits, motors};
use activecell::control::State;
use activecell::{Drive, Error};

/// The control unit of the core as a state machine: `control_unit`, and its table `control_next`.
///
/// ```
/// let files = activecell_codegen::vhdl::control_unit();
/// let paths: Vec<&str> = files.iter().map(|file| file.path.as_str()).collect();
/// assert_eq!(paths, ["rtl/lanes.vhd", "rtl/control_next.vhd", "rtl/control_unit.vhd"]);
/// ```
pub fn control_unit() -> Vec<SourceFile> {
    let calm = format!("{:03b}", State::Calm as u8);
    let unit =
        fill(include_str!("templates/control_unit.vhd"), &[("CALM", calm), ("STATES", motors::table("--"))]);
    vec![
        lanes(),
        SourceFile::new("rtl/control_next.vhd", entity(&circuits::control())),
        SourceFile::new("rtl/control_unit.vhd", unit),
    ]
}

/// The player of a program ([`crate::model::player`]): `player_top` for the pins of a chip, in it `player`, the test
/// bench `player_tb`, and the example `player_example_tb`. What [`crate::verilog::player`] reads from a file is a package here, which every tool takes.
///
/// The files are in the order in which they can be analysed.
///
/// # Errors
/// [`Error::BadValue`] for more segments than the player counts, and for segments without a tick.
///
/// ```
/// use activecell::Drive;
/// use activecell_codegen::{model::player::{Motion, Segment}, vhdl};
/// let files = vhdl::player(&[Segment { motion: Motion::Forward, ticks: 200 }], Drive::Differential)?;
/// let program = files.iter().find(|file| file.path == "rtl/player_program.vhd").unwrap();
/// assert!(program.text.contains(r#"0 => "10011001000", -- forward, 200 ticks"#));
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn player(segments: &[Segment], drive: Drive) -> Result<Vec<SourceFile>, Error> {
    let image = ProgramImage::of(segments)?;
    let bench = PlayerBench::of(segments, drive);
    let values = [
        ("TICKS_MAX", bench.ticks_max.to_string()),
        ("ABOUT_TICKS", bench.about),
        ("STEERED", (drive == Drive::Steered).to_string()),
        ("STATES", motors::table("--")),
        ("CASES", motors::cases(|q, name| format!("            when \"{q}\" => return \"{name}\";"))),
    ];
    let mut files = control_unit();
    files.extend([
        SourceFile::new("rtl/player_inputs.vhd", entity(&circuits::player())),
        SourceFile::new("rtl/encoder_edge.vhd", include_str!("templates/encoder_edge.vhd")),
        SourceFile::new("rtl/player_program.vhd", program(&image)),
        SourceFile::new("rtl/player.vhd", include_str!("templates/player.vhd")),
        SourceFile::new("rtl/player_top.vhd", fill(include_str!("templates/player_top.vhd"), &values)),
        bench_lines(),
        SourceFile::new("tb/player_tb.vhd", fill(include_str!("templates/player_tb.vhd"), &values)),
        SourceFile::new(
            "tb/player_example_tb.vhd",
            fill(include_str!("templates/player_example_tb.vhd"), &values),
        ),
        bench.hex,
    ]);
    Ok(files)
}

fn program(image: &ProgramImage) -> String {
    let digits = image.word_bits() as usize;
    let lines = image.words.iter().enumerate().take(image.segments);
    let lines =
        lines.map(|(place, (word, about))| format!("        {place} => \"{word:0digits$b}\", -- {about}\n"));
    let values = [
        ("SEGMENTS", image.segments.to_string()),
        ("SEGMENT_BITS", image.segment_bits.to_string()),
        ("TICK_BITS", image.tick_bits.to_string()),
        ("WORDS", lines.collect()),
    ];
    fill(include_str!("templates/player_program.vhd"), &values)
}
