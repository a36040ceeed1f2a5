//! The program player on the pins of a chip: what lies between the pins and the [`Player`].
//!
//! Inputs come at any time, so each passes two flip-flops before it is looked at; the outputs come from flip-flops too, so
//! that a motor driver sees no glitch where several change at once. A pulse of an encoder counts at its rising edge. A tick
//! is one of the mean of both wheels: their pulses together, halved.

use super::player::{Motion, Player, Segment, Senses};
use activecell::Drive;
use activecell::control::{Inputs, State};

/// The levels of the input pins.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Pins {
    /// Back to the beginning of the program.
    pub reset: bool,
    /// The robot may drive.
    pub go: bool,
    /// The encoders: left wheel, right wheel, steering.
    pub encoders: [bool; 3],
    /// Obstacles: [`Inputs::FRONT`], [`Inputs::BEHIND`], [`Inputs::LEFT`], [`Inputs::RIGHT`].
    pub obstacles: Inputs,
}

/// A player behind pins.
///
/// ```
/// use activecell::{Drive, control::State};
/// use activecell_codegen::model::player::{Motion, Segment};
/// use activecell_codegen::model::player_top::{Pins, PlayerTop};
/// let run = Segment { motion: Motion::Forward, ticks: 2 };
/// let mut top = PlayerTop::new(vec![run], Drive::Differential);
/// let go = Pins { go: true, ..Pins::default() };
/// let moving = (0..4).map(|_| { top.clock(go); top.shown().0 }).collect::<Vec<_>>();
/// assert_eq!(moving, [State::Calm, State::Calm, State::Calm, State::Forward]);
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlayerTop {
    player: Player,
    drive: Drive,
    /// The pins one and two clocks ago.
    first: Pins,
    settled: Pins,
    /// The last three levels of each encoder, the newest in bit 0.
    seen: [u8; 3],
    /// Half a tick is there.
    half: bool,
    shown: (State, bool),
}

/// As if each encoder stood in a pulse, so that only a new one counts.
const IN_PULSES: [u8; 3] = [0b111; 3];

impl PlayerTop {
    /// A player that was just reset.
    pub fn new(segments: Vec<Segment>, drive: Drive) -> Self {
        let player = Player::new(segments);
        let shown = (player.state(), player.done());
        let pins = Pins::default();
        Self { player, drive, first: pins, settled: pins, seen: IN_PULSES, half: false, shown }
    }

    /// The player within.
    pub const fn player(&self) -> &Player {
        &self.player
    }

    /// What the output pins show: the control unit's state, and whether the program has ended.
    pub const fn shown(&self) -> (State, bool) {
        self.shown
    }

    /// One clock, at which the input pins have these levels.
    pub fn clock(&mut self, pins: Pins) {
        self.shown = (self.player.state(), self.player.done());
        if self.settled.reset {
            self.player = Player::new(self.player.segments().to_vec());
            self.seen = IN_PULSES;
            self.half = false;
        } else {
            self.play();
            for (seen, level) in self.seen.iter_mut().zip(pins.encoders) {
                *seen = (*seen << 1 | u8::from(level)) & 0b111;
            }
        }
        self.settled = self.first;
        self.first = pins;
    }

    fn play(&mut self) {
        let [left, right, steering] = self.seen.map(|seen| seen >> 1 == 0b01);
        let pulses = u8::from(self.half) + u8::from(left) + u8::from(right);
        self.half = pulses % 2 == 1;
        let steers = self.drive == Drive::Steered
            && matches!(self.player.wanted(), Some(Motion::Left | Motion::Right));
        let tick = if steers { steering } else { pulses >= 2 };
        self.player.clock(Senses { go: self.settled.go, tick, obstacles: self.settled.obstacles });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use activecell::Rng;

    /// Pulses of both wheels, also at the same clock, are ticks when halved: none is lost.
    #[test]
    fn ticks_are_half_the_pulses() {
        let mut rng = Rng::new(1);
        for case in 0..100 {
            let run = Segment { motion: Motion::Forward, ticks: u32::MAX };
            let mut top = PlayerTop::new(vec![run], [Drive::Differential, Drive::Steered][case % 2]);
            let mut pins = Pins::default();
            let mut pulses = 0;
            for _ in 0..3 {
                top.clock(pins);
            }
            for _ in 0..rng.below(2000) {
                for wheel in &mut pins.encoders {
                    *wheel ^= rng.below(3) == 0;
                }
                let before = top.first.encoders;
                pulses += (0..2).filter(|&wheel| pins.encoders[wheel] && !before[wheel]).count() as u32;
                top.clock(pins);
            }
            for _ in 0..2 {
                top.clock(pins);
            }
            assert_eq!(u32::MAX - top.player.ticks_left(), pulses / 2);
        }
    }
}
