//! What the program player on a chip's pins does on a rough drive, for test benches that check themselves.

use super::player::Segment;
use super::player_top::{Pins, PlayerTop};
use activecell::control::{Inputs, State};
use activecell::{Drive, Rng};

/// Clocks in which the player is told the same and shows the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stretch {
    /// How many.
    pub clocks: u32,
    /// What it is told at each of them: whether the robot may drive,
    pub go: bool,
    /// which encoders change their level at every clock (left wheel, right wheel, steering),
    pub pulses: [bool; 3],
    /// and where obstacles are.
    pub obstacles: Inputs,
    /// What it shows after each of them: the control unit's state,
    pub state: State,
    /// and whether the program has ended.
    pub done: bool,
}

/// A drive through a whole program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Trace {
    /// The ticks after which a segment ends that has more of them; 0 if all their ticks are driven.
    pub ticks_max: u32,
    /// What happens, from reset to behind the end.
    pub stretches: Vec<Stretch>,
}

/// Programs of more ticks are shortened to these, so that a simulation ends in good time. Segments are at most 65535, so
/// each keeps at least two ticks.
const TICKS_MAX: u64 = 1 << 17;
/// As many segments are driven roughly; where there are more, the others straight through. Each piece of a rough drive is
/// a line of a file.
const ROUGH_MAX: u32 = 1 << 12;
/// Clocks of the reset with which it begins.
const RESET_CLOCKS: u32 = 4;

/// A drive from reset to behind the end of the program, with stops, obstacles on all sides, and pulses at random, also
/// while the robot waits. It goes through every segment; those of long programs are shortened alike.
///
/// ```
/// use activecell::Drive;
/// use activecell_codegen::model::{player::{Motion, Segment}, player_trace::trace};
/// let run = Segment { motion: Motion::Forward, ticks: 3_000_000_000 };
/// let turn = Segment { motion: Motion::Left, ticks: 5 };
/// let trace = trace(&[run, turn, run], Drive::Differential, 1);
/// assert_eq!(trace.ticks_max, (1 << 17) / 3);
/// assert!(trace.stretches.last().unwrap().done);
/// ```
pub fn trace(segments: &[Segment], drive: Drive, seed: u64) -> Trace {
    let ticks_max = ticks_max(segments);
    let shortened = |segment: &Segment| match ticks_max {
        0 => *segment,
        most => Segment { ticks: segment.ticks.min(most), ..*segment },
    };
    let mut top = PlayerTop::new(segments.iter().map(shortened).collect(), drive);
    for _ in 0..RESET_CLOCKS {
        top.clock(Pins { reset: true, ..Pins::default() });
    }
    let mut rng = Rng::new(seed);
    let mut stretches: Vec<Stretch> = Vec::new();
    let mut pins = Pins::default();
    let mut after_end = 0;
    while after_end < 8 {
        let is_rough = top.shown().1 || rng.below(segments.len() as u32) < ROUGH_MAX;
        let told = if is_rough { rough(&mut rng, &top) } else { straight(&top) };
        after_end += usize::from(top.shown().1);
        pins = Pins { go: told.go, obstacles: told.obstacles, ..pins };
        for _ in 0..told.clocks {
            for (level, changes) in pins.encoders.iter_mut().zip(told.pulses) {
                *level ^= changes;
            }
            top.clock(pins);
            let (state, done) = top.shown();
            let stretch = Stretch { clocks: 1, state, done, ..told };
            match stretches.last_mut() {
                Some(last) if *last == (Stretch { clocks: last.clocks, ..stretch }) => last.clocks += 1,
                _ => stretches.push(stretch),
            }
        }
    }
    Trace { ticks_max, stretches }
}

/// What each segment is shortened to, 0 if the program is short enough.
fn ticks_max(segments: &[Segment]) -> u32 {
    let ticks = segments.iter().map(|segment| u64::from(segment.ticks)).sum::<u64>();
    if ticks > TICKS_MAX { (TICKS_MAX / segments.len() as u64).max(1) as u32 } else { 0 }
}

/// To the end of the segment without a stop: all encoders give a pulse in two clocks.
fn straight(top: &PlayerTop) -> Stretch {
    let (state, done) = top.shown();
    let clocks = top.player().ticks_left().saturating_mul(2).max(1);
    Stretch { clocks, go: true, pulses: [true; 3], obstacles: Inputs(0), state, done }
}

/// Anything, for a few clocks or nearly to the segment's end.
fn rough(rng: &mut Rng, top: &PlayerTop) -> Stretch {
    let straight = straight(top);
    let obstacles = if rng.below(3) == 0 { Inputs((rng.below(16) as u8) << 2) } else { Inputs(0) };
    let go = rng.below(6) > 0;
    if rng.below(6) == 0 {
        let clocks = straight.clocks.saturating_sub(rng.below(6)).max(1);
        return Stretch { clocks, go, obstacles, ..straight };
    }
    let pulses = [(); 3].map(|()| rng.below(2) == 0);
    Stretch { clocks: 1 + rng.below(4), go, pulses, obstacles, ..straight }
}

#[cfg(test)]
mod tests {
    use super::super::player::Motion;
    use super::*;

    /// Whatever the program: every segment in its turn, then the end, in a bounded number of clocks and lines.
    #[test]
    fn every_program_comes_to_its_end() {
        for (count, ticks) in [
            (0, 1),
            (1, 1),
            (1, u32::MAX),
            (7, 3_000_000_000),
            (300, 2048),
            (5000, 100),
            (65535, 1),
            (65535, u32::MAX),
        ] {
            let segments: Vec<Segment> =
                (0..count).map(|place| Segment { motion: Motion::ALL[place % 4], ticks }).collect();
            let drive = [Drive::Differential, Drive::Steered][count % 2];
            let Trace { ticks_max, stretches } = trace(&segments, drive, 1);
            assert_eq!(ticks_max > 0, count as u64 * u64::from(ticks) > TICKS_MAX, "{count} of {ticks}");
            assert!(stretches.last().is_some_and(|last| last.done && last.state == State::Calm));
            let clocks: u64 = stretches.iter().map(|stretch| u64::from(stretch.clocks)).sum();
            println!("{count} segments of {ticks} ticks: {} lines, {clocks} clocks", stretches.len());
            assert!(clocks < 1 << 20 && stretches.len() < 1 << 18, "{clocks}, {}", stretches.len());
        }
    }
}
