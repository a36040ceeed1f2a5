//! The program player: the program M in a read-only memory, encoder pulses in, the control unit's outputs out.
//!
//! M becomes [`Segment`]s: a motion and how many encoder ticks it lasts. The player counts ticks, and asks the
//! control unit of the core ([`activecell::control`]) for the motion of the segment that it is in. Choices:
//!
//! - *Every tick counts while the program runs*, whatever the control unit does. Ticks tell where the robot is, and a
//!   robot that brakes for an obstacle still rolls on: what it rolls must not be driven twice.
//! - *An obstacle where the segment leads to: the robot waits.* The control unit would pick another free side, which
//!   suits a robot that finds its way by sensors alone; M has a way, and another one would lead away from its cells.
//!   So go is not passed on, the control unit becomes calm, and goes on by itself when the obstacle has gone.
//! - *Go is a level*: without it the robot waits too.
//! - *After the last tick stop is asserted* until the player is reset: stopped, then calm. It never moves again.

use activecell::control::{Control, Inputs, State};
use activecell::{Cell, Drive, Error, Lattice, Map, Program, Robot};

/// What the robot does in a segment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Motion {
    /// Drives straight on.
    Forward,
    /// Drives straight back.
    Reverse,
    /// Turns to the left.
    Left,
    /// Turns to the right.
    Right,
}

impl Motion {
    /// All motions, in the order of their numbers, which stand in the read-only memory.
    pub const ALL: [Self; 4] = [Self::Forward, Self::Reverse, Self::Left, Self::Right];

    /// Its name: that of the state in which the control unit does it.
    pub const fn name(self) -> &'static str {
        self.state().name()
    }

    /// The state of the control unit that does it.
    pub const fn state(self) -> State {
        match self {
            Self::Forward => State::Forward,
            Self::Reverse => State::Reverse,
            Self::Left => State::Left,
            Self::Right => State::Right,
        }
    }

    /// What asks the control unit for it. A turn is forced by closing the front, as the control unit wants it.
    const fn asked(self) -> Inputs {
        match self {
            Self::Forward => Inputs::GO,
            Self::Reverse => Inputs::REVERSE,
            Self::Left => Inputs::GO.with(Inputs::FRONT).with(Inputs::SIDE_LEFT),
            Self::Right => Inputs::GO.with(Inputs::FRONT),
        }
    }
}

/// A straight run or a turn of the program M.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Segment {
    /// What the robot does.
    pub motion: Motion,
    /// How long, in encoder ticks; not 0.
    pub ticks: u32,
}

/// Beyond these, counting in floating-point numbers is no longer exact.
const TICKS_MAX: f64 = (1u64 << 52) as f64;

/// The program as segments, in the ticks of [`Program::ticks`].
///
/// A tick is one of the mean of both wheels: with an encoder on each wheel, every second pulse of the two. Runs count
/// how far both wheels roll, turns of a differential drive how far they roll against each other. Where a steered
/// robot turns, its wheels do not roll: such a turn counts as many pulses of the steering as it has steps of the
/// lattice (90° on squares, 60° on hexagons). Halves are carried on to the next run or turn, so that they never add up.
/// What takes no tick is left out.
///
/// # Errors
/// [`Error::BadValue`] for runs or turns of more ticks than 32 bits hold, and for turns that the lattice does not have.
///
/// ```
/// use activecell::{Cell, Lattice, Map, Robot, Rule};
/// use activecell_codegen::model::player::{Motion, segments};
/// let map = Map::parse(Lattice::Square, "S.\n#.")?;
/// let robot = Robot { wheel_perimeter_m: 0.5, ticks_per_rev: 100.0, track_m: 0.2, ..Robot::default() };
/// let route = map.route(Rule::Wave, Cell::new(0, 0), Cell::new(1, 1), 100)?;
/// let segments = segments(&route.program(&robot, &map, None), &robot, Lattice::Square)?;
/// let segments: Vec<_> = segments.iter().map(|segment| (segment.motion, segment.ticks)).collect();
/// // 1 m, a quarter turn of the wheels' track, 1 m.
/// assert_eq!(segments, [(Motion::Forward, 200), (Motion::Right, 31), (Motion::Forward, 200)]);
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn segments(program: &Program, robot: &Robot, lattice: Lattice) -> Result<Vec<Segment>, Error> {
    let all = program.waypoints.iter().map(|w| w.revolutions.abs() + w.turn_revolutions.abs());
    let ticks = all.sum::<f64>() * robot.ticks_per_rev;
    if !(0.0..TICKS_MAX).contains(&ticks) {
        return Err(Error::BadValue {
            name: "the program's length in encoder ticks",
            value: ticks,
            allowed: "at most 2^52; use a shorter route, larger wheels or fewer ticks a revolution",
        });
    }
    let (mut runs, mut turns) = (Halves::default(), Halves::default());
    let mut segments = Vec::new();
    let mut add = |motion: Motion, ticks: i64| {
        let ticks = u32::try_from(ticks).map_err(|_| Error::BadValue {
            name: "a run or turn in encoder ticks",
            value: ticks as f64,
            allowed: "at most 4294967295; use larger wheels or fewer ticks a revolution",
        })?;
        segments.extend((ticks > 0).then_some(Segment { motion, ticks }));
        Ok(())
    };
    for (waypoint, ticks) in program.waypoints.iter().zip(program.ticks(robot)) {
        let run = runs.advance(ticks.run[0] + ticks.run[1]);
        add(if run < 0 { Motion::Reverse } else { Motion::Forward }, run.abs())?;
        let turn = match robot.drive {
            Drive::Differential => turns.advance(ticks.turn[0] - ticks.turn[1]),
            Drive::Steered => steps(waypoint.turn_deg, lattice)?,
        };
        add(if waypoint.turn_deg < 0 { Motion::Left } else { Motion::Right }, turn.abs())?;
    }
    Ok(segments)
}

/// How far a robot rolls for the lattice's smallest motions, in the ticks of [`segments`] before they are rounded.
///
/// ```
/// use activecell::{Lattice, Map, Robot};
/// use activecell_codegen::model::player::Scale;
/// let robot = Robot { wheel_perimeter_m: 0.5, ticks_per_rev: 100.0, ..Robot::default() };
/// let scale = Scale::of(&robot, &Map::parse(Lattice::Square, "..")?);
/// assert_eq!((scale.step_m, scale.step_ticks), (1.0, 200.0));
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// From the centre of a cell to that of a neighbour, in metres.
    pub step_m: f64,
    /// The same in ticks.
    pub step_ticks: f64,
    /// From a direction of the lattice to the next one, in degrees.
    pub turn_deg: u32,
    /// The same in ticks: of the wheels for a differential drive, of the steering for a steered robot.
    pub turn_ticks: f64,
}

impl Scale {
    /// Of a robot on a map.
    pub fn of(robot: &Robot, map: &Map) -> Self {
        let turn_deg = 360 / u32::from(map.lattice().degree());
        let [a, b] = [0, 1].map(|x| map.centre_m(Cell::new(x, 0)));
        let step_m = (a[0] - b[0]).hypot(a[1] - b[1]);
        Self {
            step_m,
            step_ticks: step_m / robot.wheel_perimeter_m * robot.ticks_per_rev,
            turn_deg,
            turn_ticks: match robot.drive {
                Drive::Differential => robot.turn_revolutions(turn_deg as i32) * robot.ticks_per_rev,
                Drive::Steered => 1.0,
            },
        }
    }
}

/// A turn in steps of the lattice.
fn steps(turn_deg: i32, lattice: Lattice) -> Result<i64, Error> {
    let step_deg = 360 / i32::from(lattice.degree());
    if turn_deg % step_deg != 0 {
        return Err(Error::BadValue {
            name: "turn_deg",
            value: turn_deg.into(),
            allowed: "a multiple of 90 on squares, of 60 on hexagons; use the lattice that the program is for",
        });
    }
    Ok((turn_deg / step_deg).into())
}

/// Half of a sum that grows, in whole numbers: what is left of one part is made good in the next.
#[derive(Default)]
struct Halves {
    sum: i64,
}

impl Halves {
    const fn advance(&mut self, part: i64) -> i64 {
        let before = self.sum.div_euclid(2);
        self.sum += part;
        self.sum.div_euclid(2) - before
    }
}

/// What the player is told at a clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Senses {
    /// The robot may drive.
    pub go: bool,
    /// An encoder pulse came.
    pub tick: bool,
    /// Obstacles: [`Inputs::FRONT`], [`Inputs::BEHIND`], [`Inputs::LEFT`], [`Inputs::RIGHT`].
    pub obstacles: Inputs,
}

/// The inputs that are obstacle flags: g2 to g5.
pub const OBSTACLES: Inputs = Inputs::RIGHT.with(Inputs::LEFT).with(Inputs::FRONT).with(Inputs::BEHIND);

/// What the control unit is told: `wanted` is the motion of the segment, `None` when the program has ended.
///
/// If there is no obstacle where the motion leads to, the control unit picks it, else becomes calm; whatever the other
/// obstacles.
pub const fn inputs(wanted: Option<Motion>, go: bool, obstacles: Inputs) -> Inputs {
    let obstacles = Inputs(obstacles.0 & OBSTACLES.0);
    let Some(motion) = wanted else { return obstacles.with(Inputs::STOP) };
    let blocked = match motion.state().drives_towards() {
        Some(flag) => obstacles.has(flag),
        None => false,
    };
    if go && !blocked { obstacles.with(motion.asked()) } else { obstacles }
}

/// A player of segments.
///
/// ```
/// use activecell::control::{Inputs, State};
/// use activecell_codegen::model::player::{Motion, Player, Segment, Senses};
/// let mut player = Player::new(vec![Segment { motion: Motion::Forward, ticks: 2 }]);
/// let go = Senses { go: true, ..Senses::default() };
/// player.clock(go);
/// assert_eq!(player.state(), State::Forward);
/// player.clock(Senses { obstacles: Inputs::FRONT, tick: true, ..go });
/// assert_eq!(player.state(), State::Calm); // it waits
/// player.clock(Senses { tick: true, ..go });
/// assert!(player.done());
/// player.clock(go);
/// assert_eq!(player.state(), State::Stopped);
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Player {
    segments: Vec<Segment>,
    control: Control,
    segment: usize,
    /// Of the segment.
    ticks: u32,
}

impl Player {
    /// A player that was just reset: calm, before the first tick of the first segment.
    pub fn new(segments: Vec<Segment>) -> Self {
        Self { segments, control: Control::default(), segment: 0, ticks: 0 }
    }

    /// The segments.
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// What the control unit does.
    pub const fn state(&self) -> State {
        self.control.state()
    }

    /// The segment that it is in, counted from 0; behind the last one their number.
    pub const fn segment(&self) -> usize {
        self.segment
    }

    /// The motion of that segment; `None` after the last.
    pub fn wanted(&self) -> Option<Motion> {
        self.segments.get(self.segment).map(|segment| segment.motion)
    }

    /// Whether the program has ended.
    pub const fn done(&self) -> bool {
        self.segment == self.segments.len()
    }

    /// Ticks that the segment still has.
    pub fn ticks_left(&self) -> u32 {
        self.segments.get(self.segment).map_or(0, |segment| segment.ticks - self.ticks)
    }

    /// One clock. The control unit sees the segment as it was before this clock's tick.
    pub fn clock(&mut self, senses: Senses) {
        self.control.tick(inputs(self.wanted(), senses.go, senses.obstacles));
        if !senses.tick || self.done() {
            return;
        }
        self.ticks += 1;
        if self.ticks_left() == 0 {
            self.segment += 1;
            self.ticks = 0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use activecell::control::TABLE;
    use activecell::{Rng, Rule};

    /// The control unit picks just the motion of the segment, or waits: from every state that is followed by a choice.
    #[test]
    fn the_control_unit_does_the_motion_or_waits() {
        for bits in 0..16u8 {
            let obstacles = Inputs(bits << 2);
            for from in State::ALL.into_iter().filter(|&state| state != State::Stopped) {
                let next = |inputs: Inputs| TABLE[from as usize][usize::from(inputs.0)];
                for motion in Motion::ALL {
                    let flag = motion.state().drives_towards().unwrap();
                    let expected = if obstacles.has(flag) { State::Calm } else { motion.state() };
                    assert_eq!(next(inputs(Some(motion), true, obstacles)), expected);
                    assert_eq!(next(inputs(Some(motion), false, obstacles)), State::Calm);
                }
                let stopped = if from.moves() { State::Stopped } else { State::Calm };
                assert_eq!(next(inputs(None, true, obstacles)), stopped);
            }
        }
    }

    /// On random maps: the segments' ticks are those of the program, within a tick.
    #[test]
    fn ticks_do_not_get_lost() {
        let mut rng = Rng::new(1);
        let mut turned = 0;
        for case in 0..400 {
            let lattice = Lattice::ALL[case % 2];
            let cells: String = (0..144)
                .map(|i| {
                    if i % 12 == 11 {
                        '\n'
                    } else if rng.below(4) == 0 {
                        '#'
                    } else {
                        '.'
                    }
                })
                .collect();
            let map = Map::parse(lattice, &cells).unwrap();
            let drive = if rng.below(2) == 0 { Drive::Steered } else { Drive::Differential };
            let robot = Robot {
                drive,
                ticks_per_rev: f64::from(1 + rng.below(50)) / 3.0,
                wheel_difference_rel: f64::from(rng.below(100)) / 1000.0,
                can_reverse: rng.below(2) == 0,
                ..Robot::default()
            };
            let robot = Robot { ticks_per_rev: robot.ticks_per_rev.max(1.0), ..robot };
            let [from, to] = [0, 1].map(|_| Cell::new(rng.below(11) as i32, rng.below(12) as i32));
            let Ok(route) = map.route(Rule::Wave, from, to, 1000) else { continue };
            let program = route.program(&robot, &map, Some(activecell::Dir(0)));
            let segments = segments(&program, &robot, lattice).unwrap();
            let sum = |motion: Motion| {
                let ticks = segments.iter().filter(|segment| segment.motion == motion);
                ticks.map(|segment| i64::from(segment.ticks)).sum::<i64>()
            };
            let ticks = program.ticks(&robot);
            let runs: i64 = ticks.iter().map(|ticks| ticks.run[0] + ticks.run[1]).sum();
            assert_eq!(sum(Motion::Forward) - sum(Motion::Reverse), runs.div_euclid(2));
            let turns = match drive {
                Drive::Steered => {
                    i64::from(program.waypoints.iter().map(|w| w.turn_deg).sum::<i32>())
                        / (360 / i64::from(lattice.degree()))
                }
                Drive::Differential => {
                    ticks.iter().map(|ticks| ticks.turn[0] - ticks.turn[1]).sum::<i64>().div_euclid(2)
                }
            };
            assert_eq!(sum(Motion::Right) - sum(Motion::Left), turns);
            let scale = Scale::of(&robot, &map);
            // Wheels of different size count differently; in each run half a tick is rounded away.
            let rolled = route.steps() as f64 * scale.step_ticks;
            let counted = (sum(Motion::Forward) + sum(Motion::Reverse)) as f64;
            let slack = program.waypoints.len() as f64;
            assert!((counted - rolled).abs() < slack + 0.003 * rolled, "{counted} {rolled}");
            let turned_by = program.waypoints.iter().map(|w| w.turn_deg).sum::<i32>();
            let turned_by = f64::from(turned_by) / f64::from(scale.turn_deg) * scale.turn_ticks;
            assert!(
                (turns as f64 - turned_by).abs() < slack + 0.003 * turned_by.abs(),
                "{turns} {turned_by}"
            );
            assert!(segments.iter().all(|segment| segment.ticks > 0));
            turned += usize::from(turns != 0);
        }
        assert!(turned > 50);
    }

    #[test]
    fn programs_that_no_player_can_hold_are_refused() {
        let map = Map::parse(Lattice::Square, "S.\n#.").unwrap();
        let robot = Robot::default();
        let route = map.route(Rule::Wave, Cell::new(0, 0), Cell::new(1, 1), 100).unwrap();
        let program = route.program(&robot, &map, None);
        let of = |revolutions: f64, turn_deg: i32, drive: Drive| {
            let mut program = program.clone();
            program.waypoints[0].revolutions = revolutions;
            program.waypoints[0].turn_deg = turn_deg;
            segments(&program, &Robot { drive, ..robot }, Lattice::Square).map_err(|error| error.to_string())
        };
        for revolutions in [f64::NAN, f64::INFINITY, -1e300, 1e14, 1e8] {
            let error = of(revolutions, 90, Drive::Differential).unwrap_err();
            assert!(error.contains("encoder ticks"), "{error}");
        }
        let error = of(1.0, 45, Drive::Steered).unwrap_err();
        assert!(error.contains("turn_deg is 45"), "{error}");
        assert_eq!(of(0.0, 0, Drive::Steered).unwrap().len(), 1);
    }
}
