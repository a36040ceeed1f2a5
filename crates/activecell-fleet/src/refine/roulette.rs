//! Which kinds of neighbourhoods pay.

use super::choose::Kind;
use activecell::Rng;

/// Kinds and sizes of neighbourhoods, each drawn by what it has brought for its work.
///
/// Source: the adaptive choice of S. Ropke and D. Pisinger, *An Adaptive Large Neighborhood Search Heuristic for the
/// Pickup and Delivery Problem with Time Windows*, Transportation Science 40, 2006.
#[derive(Debug)]
pub(super) struct Roulette {
    arms: Vec<Arm>,
}

/// A kind and a size, with what they have brought and taken.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arm {
    pub(super) kind: Kind,
    pub(super) size: usize,
    gain: f64,
    work: f64,
}

/// What an arm keeps of its past each time.
const FADE: f64 = 0.99;

impl Roulette {
    pub(super) fn new() -> Self {
        let mut arms = vec![Arm { kind: Kind::Alone, size: 1, gain: 1.0, work: 1.0 }];
        for kind in [Kind::Late, Kind::Busy, Kind::Target, Kind::Chance] {
            for size in [2, 4, 8, 16] {
                arms.push(Arm { kind, size, gain: 1.0, work: 1.0 });
            }
        }
        Self { arms }
    }

    /// An arm by its number.
    pub(super) fn arm(&self, arm: usize) -> Arm {
        self.arms[arm]
    }

    /// Draws an arm.
    pub(super) fn draw(&self, rng: &mut Rng) -> usize {
        let best = self.arms.iter().map(|arm| arm.gain / arm.work).fold(0.0, f64::max);
        // Every arm keeps a share, so that what does not pay now may pay later.
        let weight = |arm: &Arm| arm.gain / arm.work + 0.05 * best;
        let all: f64 = self.arms.iter().map(weight).sum();
        let mut at = rng.unit() * all;
        for (i, arm) in self.arms.iter().enumerate() {
            at -= weight(arm);
            if at < 0.0 {
                return i;
            }
        }
        0
    }

    /// Learns what an arm has brought.
    pub(super) fn learn(&mut self, arm: usize, gain: u64, work: usize) {
        let arm = &mut self.arms[arm];
        arm.gain = arm.gain * FADE + gain as f64;
        arm.work = arm.work * FADE + work as f64;
    }
}
