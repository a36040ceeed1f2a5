//! The control unit with its state, and the program player around it.

use super::{bench_lines, entity, lanes};
use crate::images::{PlayerBench, ProgramImage};
use crate::model::player::Segment;
use crate::template::fill;
use crate::{SourceFile, circuits};
use activecell::Error;
use activecell::control::State;

/// The control unit of the core as a state machine: `control_unit`, and its table `control_next`.
///
/// ```
/// let files = activecell_codegen::vhdl::control_unit();
/// let paths: Vec<&str> = files.iter().map(|file| file.path.as_str()).collect();
/// assert_eq!(paths, ["rtl/lanes.vhd", "rtl/control_next.vhd", "rtl/control_unit.vhd"]);
/// ```
pub fn control_unit() -> Vec<SourceFile> {
    let calm = format!("{:03b}", State::Calm as u8);
    let unit = fill(include_str!("templates/control_unit.vhd"), &[("CALM", &calm)]);
    vec![
        lanes(),
        SourceFile::new("rtl/control_next.vhd", entity(&circuits::control())),
        SourceFile::new("rtl/control_unit.vhd", unit),
    ]
}

/// The player of a program ([`crate::model::player`]): `player_top` for the pins of a chip, in it `player`, and the test
/// bench `player_tb`. What [`crate::verilog::player`] reads from a file is a package here, which every tool takes.
///
/// The files are in the order in which they can be analysed.
///
/// # Errors
/// [`Error::BadValue`] for more segments than the player counts, and for segments without a tick.
///
/// ```
/// use activecell_codegen::{model::player::{Motion, Segment}, vhdl};
/// let files = vhdl::player(&[Segment { motion: Motion::Forward, ticks: 200 }])?;
/// let program = files.iter().find(|file| file.path == "rtl/player_program.vhd").unwrap();
/// assert!(program.text.contains(r#"0 => "00011001000", -- forward, 200 ticks"#));
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn player(segments: &[Segment]) -> Result<Vec<SourceFile>, Error> {
    let image = ProgramImage::of(segments)?;
    let bench = PlayerBench::of(segments);
    let bench_values = [("TICKS_MAX", bench.ticks_max.to_string()), ("ABOUT_TICKS", bench.about)];
    let mut files = control_unit();
    files.extend([
        SourceFile::new("rtl/player_inputs.vhd", entity(&circuits::player())),
        SourceFile::new("rtl/encoder_edge.vhd", include_str!("templates/encoder_edge.vhd")),
        SourceFile::new("rtl/player_program.vhd", program(&image)),
        SourceFile::new("rtl/player.vhd", include_str!("templates/player.vhd")),
        SourceFile::new("rtl/player_top.vhd", include_str!("templates/player_top.vhd")),
        bench_lines(),
        SourceFile::new("tb/player_tb.vhd", fill(include_str!("templates/player_tb.vhd"), &bench_values)),
        bench.hex,
    ]);
    Ok(files)
}

fn program(image: &ProgramImage) -> String {
    let digits = image.word_bits() as usize;
    let lines = image.words.iter().enumerate().take(image.segments);
    let lines =
        lines.map(|(place, (word, about))| format!("        {place} => \"{word:0digits$b}\", -- {about}\n"));
    let end = image.words.last().map_or(0, |(word, _)| *word);
    let values = [
        ("SEGMENTS", image.segments.to_string()),
        ("SEGMENT_BITS", image.segment_bits.to_string()),
        ("TICK_BITS", image.tick_bits.to_string()),
        ("WORDS", lines.collect()),
        ("END", format!("{end:0digits$b}")),
    ];
    fill(include_str!("templates/player_program.vhd"), &values)
}
