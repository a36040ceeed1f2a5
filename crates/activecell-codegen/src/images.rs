//! Memory images and traces of the program player, which Verilog and VHDL share.

use crate::SourceFile;
use crate::model::player::{Motion, OBSTACLES, Segment};
use crate::model::player_trace::{Stretch, Trace, trace};
use activecell::{Drive, Error};

/// Segments that a player's numbers of 16 bits can count.
const SEGMENTS_MAX: usize = u16::MAX as usize;

/// A program as it lies in a player's memory.
pub(crate) struct ProgramImage {
    /// How many segments.
    pub(crate) segments: usize,
    /// Bits of a segment's number, which counts to `segments`.
    pub(crate) segment_bits: u32,
    /// Bits of the ticks.
    pub(crate) tick_bits: u32,
    /// A word a segment and one for the end, each with what it means: from the top bit 1 for a segment, the motion, the
    /// ticks. The end is 0, so that a memory without its program never drives.
    pub(crate) words: Vec<(u64, String)>,
}

impl ProgramImage {
    /// Bits of the memory.
    pub(crate) const fn bits(&self) -> u64 {
        self.words.len() as u64 * self.word_bits() as u64
    }

    /// The program that these segments are.
    ///
    /// # Errors
    /// [`Error::BadValue`] for more segments than the player counts, and for segments without a tick.
    pub(crate) fn of(segments: &[Segment]) -> Result<Self, Error> {
        if segments.len() > SEGMENTS_MAX {
            return Err(Error::BadValue {
                name: "the program's number of runs and turns",
                value: segments.len() as f64,
                allowed: "at most 65535; split the route",
            });
        }
        if let Some(place) = segments.iter().position(|segment| segment.ticks == 0) {
            return Err(Error::BadValue {
                name: "the number of a segment without a tick",
                value: place as f64,
                allowed: "left out: every segment lasts at least one tick",
            });
        }
        let most = segments.iter().map(|segment| segment.ticks).max().unwrap_or(1);
        let tick_bits = bits(most);
        let word = |segment: &Segment| {
            let motion = Motion::ALL.iter().position(|&motion| motion == segment.motion).unwrap_or(0) as u64;
            let about = format!("{}, {} ticks", segment.motion.name(), segment.ticks);
            (1 << (tick_bits + 2) | motion << tick_bits | u64::from(segment.ticks), about)
        };
        let end = (0, "the end".into());
        Ok(Self {
            segments: segments.len(),
            segment_bits: bits(segments.len() as u32),
            tick_bits,
            words: segments.iter().map(word).chain([end]).collect(),
        })
    }

    /// Bits of a word: what it is and the motion stand above the ticks.
    pub(crate) const fn word_bits(&self) -> u32 {
        self.tick_bits + 3
    }

    /// For `$readmemh`.
    pub(crate) fn hex(&self) -> SourceFile {
        let digits = self.word_bits().div_ceil(4) as usize;
        let lines = self.words.iter().enumerate();
        let lines = lines.map(|(place, (word, about))| format!("{word:0digits$x} // {place}: {about}\n"));
        SourceFile::new("rtl/player.hex", lines.collect::<String>())
    }
}

/// The bits of a number, at least one.
pub(crate) const fn bits(number: u32) -> u32 {
    let bits = u32::BITS - number.leading_zeros();
    if bits == 0 { 1 } else { bits }
}

/// How many bits hold the numbers below `count`.
pub(crate) const fn bits_below(count: u32) -> u32 {
    bits(count.saturating_sub(1))
}

/// What `player_tb` is filled in with.
pub(crate) struct PlayerBench {
    /// What the player does on a rough drive: a stretch a line.
    pub(crate) hex: SourceFile,
    /// How many lines that are.
    pub(crate) lines: usize,
    /// The player's parameter.
    pub(crate) ticks_max: u32,
    /// What is said of it.
    pub(crate) about: String,
}

impl PlayerBench {
    /// For a program and its robot.
    pub(crate) fn of(segments: &[Segment], drive: Drive) -> Self {
        let Trace { ticks_max, stretches } = trace(segments, drive, 1);
        let about = match ticks_max {
            0 => "every segment lasts all its ticks".to_owned(),
            most => format!("the simulation shortens segments to {most} ticks"),
        };
        let text = stretches.iter().map(line).collect::<String>();
        Self { hex: SourceFile::new("tb/player.hex", text), lines: stretches.len(), ticks_max, about }
    }
}

/// 12 digits: clocks, done, q3 to q0, then go, the encoders that change, and the obstacles.
fn line(stretch: &Stretch) -> String {
    let bits = |bits: &[bool]| bits.iter().rev().fold(0, |number, &bit| number << 1 | u8::from(bit));
    let [left, right, steering] = stretch.pulses;
    let told = bits(&[left, right, steering, stretch.go]);
    let obstacles = (stretch.obstacles.0 & OBSTACLES.0) >> 2;
    let (clocks, done, q) = (stretch.clocks, u8::from(stretch.done), bits(&stretch.state.outputs()));
    format!("{clocks:08x}_{done:x}_{q:x}_{told:x}{obstacles:x}\n")
}
