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

/// A trace has no more clocks than these, so that a simulation ends in good time.
const CLOCKS_MAX: u32 = 1 << 20;
/// Nor more stretches than these: they are lines of a file.
const STRETCHES_MAX: usize = 1 << 16;

/// A drive from reset to behind the end of the program, with stops, obstacles on all sides, and ticks at random, also
/// while the robot waits. Long programs are followed through their first clocks only.
///
/// ```
/// use activecell_codegen::model::{player::{Motion, Segment}, player_trace::trace};
/// let trace = trace(&[Segment { motion: Motion::Left, ticks: 5 }], 1);
/// assert!(!trace[0].done && trace.last().unwrap().done);
/// ```
pub fn trace(segments: &[Segment], seed: u64) -> Vec<Stretch> {
    let mut rng = Rng::new(seed);
    let mut player = Player::new(segments.to_vec());
    let mut stretches: Vec<Stretch> = Vec::new();
    let (mut clocks, mut after_end) = (0, 0);
    while after_end < 8 && clocks < CLOCKS_MAX && stretches.len() < STRETCHES_MAX {
        let (senses, long) = told(&mut rng, player.ticks_left());
        let long = long.min(CLOCKS_MAX - clocks);
        clocks += long;
        after_end += usize::from(player.done());
        for _ in 0..long {
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
    stretches
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
