//! The control unit: a finite state machine of six states and eight inputs, held as one table.
//!
//! It drives the robot's motors from what the route asks for (go, reverse, which side) and what the distance
//! sensors say (obstacle in front, left, right, behind). After Alzoubi and Miraz, *Enhancing Robot Navigation
//! Efficiency Using Cellular Automata with Active Cells*, section 4; the errata are told in `docs/errata.md`.
//!
//! ```
//! use activecell::control::{Control, Inputs, State};
//! let mut unit = Control::default();
//! assert_eq!(unit.tick(Inputs::GO), State::Forward);
//! // Something in front, the route would rather go left.
//! assert_eq!(unit.tick(Inputs::GO.with(Inputs::FRONT).with(Inputs::SIDE_LEFT)), State::Left);
//! assert_eq!(unit.tick(Inputs::GO.with(Inputs::STOP)), State::Stopped);
//! assert_eq!(unit.tick(Inputs::default()), State::Calm);
//! ```

/// What the control unit does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum State {
    /// Nothing: all motors are at rest.
    #[default]
    Calm,
    /// Drives straight on.
    Forward,
    /// Turns its wheels to the left and drives along the new heading.
    Left,
    /// Turns its wheels to the right and drives along the new heading.
    Right,
    /// Has just been stopped: arrived, or told to; calm one step later.
    Stopped,
    /// Drives backwards.
    Reverse,
}

impl State {
    /// All states, in the order of their numbers.
    pub const ALL: [Self; 6] =
        [Self::Calm, Self::Forward, Self::Left, Self::Right, Self::Stopped, Self::Reverse];

    /// The outputs q0 (calm), q1 (drive), q2 (wheels left), q3 (wheels right).
    ///
    /// ```
    /// use activecell::control::State;
    /// assert_eq!(State::Left.outputs(), [false, true, true, false]);
    /// ```
    pub const fn outputs(self) -> [bool; 4] {
        match self {
            Self::Calm => [true, false, false, false],
            Self::Forward => [false, true, false, false],
            Self::Left => [false, true, true, false],
            Self::Right => [false, true, false, true],
            Self::Stopped => [false; 4],
            Self::Reverse => [false, false, true, true],
        }
    }

    /// Whether the robot moves in this state.
    pub const fn moves(self) -> bool {
        !matches!(self, Self::Calm | Self::Stopped)
    }

    /// The state's name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Calm => "calm",
            Self::Forward => "forward",
            Self::Left => "left",
            Self::Right => "right",
            Self::Stopped => "stopped",
            Self::Reverse => "reverse",
        }
    }

    /// The input that tells of an obstacle where this state would drive to.
    pub const fn drives_towards(self) -> Option<Inputs> {
        match self {
            Self::Forward => Some(Inputs::FRONT),
            Self::Left => Some(Inputs::LEFT),
            Self::Right => Some(Inputs::RIGHT),
            Self::Reverse => Some(Inputs::BEHIND),
            Self::Calm | Self::Stopped => None,
        }
    }
}

/// The inputs g0 to g7, a bit each.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Inputs(pub u8);

impl Inputs {
    /// g0: a task is set, drive on.
    pub const GO: Self = Self(1 << 0);
    /// g1: of the two sides the left one is wanted; without it the right one.
    pub const SIDE_LEFT: Self = Self(1 << 1);
    /// g2: obstacle on the right.
    pub const RIGHT: Self = Self(1 << 2);
    /// g3: obstacle on the left.
    pub const LEFT: Self = Self(1 << 3);
    /// g4: obstacle in front; the route forces a turn by it.
    pub const FRONT: Self = Self(1 << 4);
    /// g5: obstacle behind.
    pub const BEHIND: Self = Self(1 << 5);
    /// g6: stop.
    pub const STOP: Self = Self(1 << 6);
    /// g7: drive backwards.
    pub const REVERSE: Self = Self(1 << 7);

    /// These inputs and those.
    #[must_use]
    pub const fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Whether all inputs of `other` are there.
    pub const fn has(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }
}

/// A row of the table by which a motion is picked: the inputs it asks for, those it must not have, and the motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pick {
    /// Inputs that must be 1.
    pub ones: Inputs,
    /// Inputs that must be 0.
    pub zeros: Inputs,
    /// The next state.
    pub next: State,
}

const fn pick(ones: Inputs, zeros: Inputs, next: State) -> Pick {
    Pick { ones, zeros, next }
}

const ANY: Inputs = Inputs(0);

/// How a motion is picked while a task is set: the first row that matches.
pub const PICKS: [Pick; 8] = [
    pick(Inputs::REVERSE, Inputs::BEHIND, State::Reverse),
    pick(ANY, Inputs::REVERSE.with(Inputs::FRONT), State::Forward),
    pick(Inputs::SIDE_LEFT, Inputs::LEFT, State::Left),
    pick(ANY, Inputs::RIGHT.with(Inputs::SIDE_LEFT), State::Right),
    pick(ANY, Inputs::LEFT, State::Left),
    pick(ANY, Inputs::RIGHT, State::Right),
    pick(ANY, Inputs::BEHIND, State::Reverse),
    // Boxed in.
    pick(ANY, ANY, State::Calm),
];

/// The next state for each state (in the order of [`State::ALL`]) and all 256 inputs: the whole control unit. What
/// is printed and generated is derived from it.
///
/// - Stop wins over all: a moving robot is stopped, a stopped one becomes calm one step later.
/// - Without a task (neither go nor reverse) it is calm.
/// - Else the first row of [`PICKS`] that matches.
pub const TABLE: [[State; 256]; 6] = table();

const fn table() -> [[State; 256]; 6] {
    let mut table = [[State::Calm; 256]; 6];
    let mut state = 0;
    while state < 6 {
        let mut inputs = 0;
        while inputs < 256 {
            table[state][inputs] = decided(State::ALL[state], Inputs(inputs as u8));
            inputs += 1;
        }
        state += 1;
    }
    table
}

const fn decided(state: State, inputs: Inputs) -> State {
    if matches!(state, State::Stopped) {
        return State::Calm;
    }
    if inputs.has(Inputs::STOP) {
        return if state.moves() { State::Stopped } else { State::Calm };
    }
    if !inputs.has(Inputs::GO) && !inputs.has(Inputs::REVERSE) {
        return State::Calm;
    }
    let mut row = 0;
    while !(inputs.has(PICKS[row].ones) && inputs.0 & PICKS[row].zeros.0 == 0) {
        row += 1;
    }
    PICKS[row].next
}

/// A running control unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Control {
    state: State,
}

impl Control {
    /// The state.
    pub const fn state(self) -> State {
        self.state
    }

    /// One step: the state that follows.
    pub fn tick(&mut self, inputs: Inputs) -> State {
        self.state = TABLE[self.state as usize][usize::from(inputs.0)];
        self.state
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entries() -> impl Iterator<Item = (State, Inputs, State)> {
        let inputs = (0..=255u8).map(Inputs);
        State::ALL.into_iter().flat_map(move |state| {
            inputs.clone().map(move |inputs| (state, inputs, TABLE[state as usize][usize::from(inputs.0)]))
        })
    }

    #[test]
    fn every_entry_is_safe() {
        assert_eq!(entries().count(), 6 * 256);
        for (state, inputs, next) in entries() {
            let place = format!("{state:?} {:08b} {next:?}", inputs.0);
            if let Some(obstacle) = next.drives_towards() {
                assert!(!inputs.has(obstacle), "drives towards an obstacle: {place}");
                assert!(
                    inputs.has(Inputs::GO) || inputs.has(Inputs::REVERSE),
                    "drives without a task: {place}"
                );
            }
            if inputs.has(Inputs::STOP) {
                assert!(!next.moves(), "does not stop: {place}");
                assert!(!state.moves() || next == State::Stopped, "{place}");
            }
            assert!(next != State::Stopped || state.moves() && inputs.has(Inputs::STOP), "{place}");
            // Asked to go on and back at once: backwards only if that is free, never forwards.
            if inputs.has(Inputs::REVERSE) {
                assert_ne!(next, State::Forward, "{place}");
            }
            // It rests only if it must: stop, no task, just stopped, or boxed in.
            let boxed_in = Inputs::RIGHT.with(Inputs::LEFT).with(Inputs::BEHIND);
            let front = inputs.has(Inputs::FRONT) || inputs.has(Inputs::REVERSE);
            let task = inputs.has(Inputs::GO) || inputs.has(Inputs::REVERSE);
            if state != State::Stopped && task && !inputs.has(Inputs::STOP) {
                assert_eq!(next == State::Calm, inputs.has(boxed_in) && front, "{place}");
            }
        }
    }

    /// Row counts that an independent hardware prototype of the same reading had.
    #[test]
    fn counts_of_the_prototype() {
        let count =
            |state: State, next: State| TABLE[state as usize].iter().filter(|&&entry| entry == next).count();
        let row = |state| State::ALL.map(|next| count(state, next));
        assert_eq!(row(State::Calm), [170, 16, 18, 18, 0, 34]);
        for state in [State::Forward, State::Left, State::Right, State::Reverse] {
            assert_eq!(row(state), [42, 16, 18, 18, 128, 34]);
        }
        assert_eq!(row(State::Stopped), [256, 0, 0, 0, 0, 0]);
    }

    #[test]
    fn six_words_of_sixteen_are_outputs() {
        let mut words = State::ALL.map(State::outputs).to_vec();
        words.sort_unstable();
        words.dedup();
        assert_eq!(words.len(), 6);
    }
}
