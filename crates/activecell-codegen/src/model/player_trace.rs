//! What a program player does on a rough drive, for test benches that check themselves.

use super::player::{Player, Segment, Senses};
use activecell::Rng;
use activecell::control::{Inputs, State};

/// Clocks in which the player is told the same and shows the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stretch {
    /// How many.
    pub clocks: u32,
    /// What it is told at each of them.
    pub senses: Senses,
    /// What it shows after each of them: the control unit's state,
    pub state: State,
    /// the number of the segment,
    pub segment: usize,
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
/// each keeps at least four ticks.
const TICKS_MAX: u64 = 1 << 18;
/// As many segments are driven roughly; where there are more, the others straight through. Each piece of a rough drive is
/// a line of a file.
const ROUGH_MAX: u32 = 1 << 12;

/// A drive from reset to behind the end of the program, with stops, obstacles on all sides, and ticks at random, also
/// while the robot waits. It goes through every segment; those of long programs are shortened alike.
///
/// ```
/// use activecell_codegen::model::{player::{Motion, Segment}, player_trace::trace};
/// let run = Segment { motion: Motion::Forward, ticks: 3_000_000_000 };
/// let turn = Segment { motion: Motion::Left, ticks: 5 };
/// let trace = trace(&[run, turn, run], 1);
/// assert_eq!(trace.ticks_max, (1 << 18) / 3);
/// assert!(trace.stretches.last().unwrap().done);
/// ```
pub fn trace(segments: &[Segment], seed: u64) -> Trace {
    let ticks_max = ticks_max(segments);
    let shortened = |segment: &Segment| match ticks_max {
        0 => *segment,
        most => Segment { ticks: segment.ticks.min(most), ..*segment },
    };
    let mut player = Player::new(segments.iter().map(shortened).collect());
    let mut rng = Rng::new(seed);
    let mut stretches: Vec<Stretch> = Vec::new();
    let mut after_end = 0;
    while after_end < 8 {
        let is_rough = player.done() || rng.below(segments.len() as u32) < ROUGH_MAX;
        let (senses, clocks) = if is_rough {
            told(&mut rng, player.ticks_left())
        } else {
            (Senses { go: true, tick: true, ..Senses::default() }, player.ticks_left())
        };
        after_end += usize::from(player.done());
        for _ in 0..clocks {
            player.clock(senses);
            let (state, segment, done) = (player.state(), player.segment(), player.done());
            match stretches.last_mut() {
                Some(last)
                    if (last.senses, last.state, last.segment, last.done)
                        == (senses, state, segment, done) =>
                {
                    last.clocks += 1;
                }
                _ => stretches.push(Stretch { clocks: 1, senses, state, segment, done }),
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

/// Some senses, and for how many clocks: a few, or nearly to the segment's end.
fn told(rng: &mut Rng, ticks_left: u32) -> (Senses, u32) {
    let obstacles = if rng.below(3) == 0 { Inputs((rng.below(16) as u8) << 2) } else { Inputs(0) };
    let senses = Senses { go: rng.below(6) > 0, tick: rng.below(2) == 0, obstacles };
    if rng.below(6) == 0 {
        let long = ticks_left.saturating_sub(rng.below(3)).max(1);
        return (Senses { tick: true, ..senses }, long);
    }
    (senses, 1 + rng.below(4))
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
            let Trace { ticks_max, stretches } = trace(&segments, 1);
            assert_eq!(ticks_max > 0, count as u64 * u64::from(ticks) > TICKS_MAX, "{count} of {ticks}");
            let mut seen: Vec<usize> = stretches.iter().map(|stretch| stretch.segment).collect();
            seen.dedup();
            let first = usize::from(seen[0] != 0); // a first tick may end the first segment
            assert_eq!(seen, (first..=count).collect::<Vec<_>>(), "{count} of {ticks}");
            assert!(stretches.last().is_some_and(|last| last.done && last.state == State::Calm));
            let clocks: u64 = stretches.iter().map(|stretch| u64::from(stretch.clocks)).sum();
            println!("{count} segments of {ticks} ticks: {} lines, {clocks} clocks", stretches.len());
            assert!(clocks < 1 << 20 && stretches.len() < 1 << 18, "{clocks}, {}", stretches.len());
        }
    }
}
