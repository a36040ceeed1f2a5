//! The fit: wheels and noise that make the logs most likely, and how sure that is.

use super::algebra::{Matrix, Vector, ZERO, apply, diagonal, inverse, plus, scaled};
use super::log::{DriveLog, TruthNoise};
use super::sweep::{Gate, Noise, Sums, Window, cuts, roughness, sweep, windows};
use crate::error::Error;
use crate::program::{Drive, Robot};
use std::f64::consts::PI;

/// About how far the robot drives between two poses that are compared.
const WINDOW_M: f64 = 1.0;
/// What is thought of the wheels before a log is seen: deviations of relative perimeter, difference and relative
/// track. What no log tells stays as it was, with these deviations.
const BEFORE: Vector = [0.05, 0.02, 0.1];
const MAX_ROUNDS: usize = 40;
/// The fit has come to rest when no parameter moves by more.
const AT_REST: f64 = 1e-7;
/// A measured pose that is off by more variances is left out: one of 50,000 good ones is.
const GATE: f64 = 24.8;
/// But no more than the worst poses beyond this share: where many are off, it is the wheels that are wrong yet.
const GOOD_SHARE: f64 = 0.85;
/// Median of the χ² distribution with three degrees of freedom.
const MEDIAN_3: f64 = 2.366;

/// What logs tell of a robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Calibration {
    /// The robot with the wheels of the fit and, in its `errors`, with their deviations, the unevenness of the floor
    /// and what that makes of a turn by 90°.
    pub robot: Robot,
    /// Deviations of the fitted mean: relative perimeter, difference, relative track.
    pub fit_rel: [f64; 3],
    /// How much sessions differ: load, floor, air in the tyres. 0 if there is but one session, or none can be seen.
    pub between_sessions_rel: [f64; 3],
    /// The noise of the ground truth. Zero where no log has more than two measured poses: then it counts as the
    /// floor's.
    pub truth: TruthNoise,
    /// Measured poses that were compared with dead reckoning.
    pub poses: usize,
    /// Those left out because they cannot be true.
    pub left_out: usize,
}

/// Fits the wheels and the noise of a differential robot to logs in sessions.
///
/// A session is what was driven at one time with one load on one floor. Perimeter, difference and track of each are
/// fitted by Gauss and Newton's method to the measured poses along all its logs, weighted by what the noise lets
/// expect there; the noises (uneven floor, ground truth) by the greatest likelihood of all sessions' differences.
/// The robot's wheels are the mean of the sessions', its deviations those of the mean and how much sessions differ,
/// as one to come will (`DerSimonian` and Laird, *Meta-analysis in clinical trials*, 1986).
///
/// # Errors
/// [`Error::BadLog`] if the robot's drive is steered, there is no log, or nothing moved; [`Error::BadValue`] if the
/// logs ask for a robot that cannot be.
///
/// ```
/// use activecell::{DriveLog, LogRow, Pose, Robot, calibrate};
/// // Ten times a metre straight on: the wheels are 1 % larger than the file says.
/// let robot = Robot { wheel_perimeter_m: 0.2, ticks_per_rev: 1000.0, ..Robot::default() };
/// let rows = (0..=10).map(|i| LogRow {
///     time_s: f64::from(i),
///     truth: Some(Pose { at_m: [1.01 * f64::from(i), 0.0], bearing_rad: 0.0 }),
///     ticks: [5000, 5000],
/// });
/// let log = DriveLog::new(rows.collect())?;
/// let found = calibrate(&[&[log]], &robot)?;
/// assert!((found.robot.wheel_perimeter_m - 0.202).abs() < 1e-5);
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn calibrate(sessions: &[&[DriveLog]], nominal: &Robot) -> Result<Calibration, Error> {
    let refuse = |reason| Err(Error::BadLog { row: None, reason });
    if nominal.drive == Drive::Steered {
        return refuse(
            "of a steered robot only the perimeter shows in a log: set wheel_perimeter_m to a measured way ÷ the wheel revolutions counted on it",
        );
    }
    if sessions.iter().all(|logs| logs.is_empty()) {
        return refuse("there is no log to fit");
    }
    let mut fit = Fit::new(sessions, nominal);
    if !fit.logs.iter().any(|log| log.log.dead_reckoning(nominal).last().is_some_and(|end| end.way_m() > 0.0))
    {
        return refuse("the encoders count nothing in any log; give logs of a robot that drives");
    }
    let mut used = Vec::new();
    let mut rounds = 0;
    loop {
        let (moved, noise) = fit.round();
        rounds += 1;
        let now: Vec<bool> = fit.logs.iter().flat_map(|piece| piece.used.iter().copied()).collect();
        if rounds == MAX_ROUNDS || (moved < AT_REST && now == used) {
            let found = fit.result(noise);
            return Ok(Calibration { robot: found.robot.checked()?, ..found });
        }
        used = now;
    }
}

/// One log in the fit.
struct Piece<'a> {
    log: &'a DriveLog,
    session: usize,
    cuts: Vec<usize>,
    windows: Vec<Window>,
    used: Vec<bool>,
}

struct Fit<'a> {
    nominal: Robot,
    /// Of each session: relative perimeter, difference and relative track beyond those of the nominal robot.
    wheels: Vec<Vector>,
    logs: Vec<Piece<'a>>,
    /// The least noise of a measured pose: encoders tell no less than a tick.
    tick: Noise,
    noise: Option<Noise>,
    /// Variances by which a measured pose may be off.
    gate: f64,
    /// Some log has measured poses on its way, which tell the noise of the truth from that of the floor.
    tells_truth: bool,
}

impl<'a> Fit<'a> {
    fn new(sessions: &[&'a [DriveLog]], nominal: &Robot) -> Self {
        let tick_m = nominal.wheel_perimeter_m / nominal.ticks_per_rev;
        let tick = Noise {
            unevenness: 1.0,
            position: tick_m / 6.0_f64.sqrt(),
            bearing: tick_m / (3.0_f64.sqrt() * nominal.track_m),
        };
        let mut logs = Vec::new();
        for (session, session_logs) in sessions.iter().enumerate() {
            for log in *session_logs {
                let cuts = cuts(log, nominal, WINDOW_M);
                logs.push(Piece { log, session, cuts, windows: Vec::new(), used: Vec::new() });
            }
        }
        let tells_truth = logs.iter().any(|piece| piece.cuts.len() > 2);
        Self {
            nominal: *nominal,
            wheels: vec![[0.0; 3]; sessions.len()],
            logs,
            tick,
            noise: None,
            gate: GATE,
            tells_truth,
        }
    }

    /// The nominal robot with other wheels.
    fn robot(&self, [perimeter, difference, track]: Vector) -> Robot {
        Robot {
            wheel_perimeter_m: self.nominal.wheel_perimeter_m * (1.0 + perimeter),
            wheel_difference_rel: self.nominal.wheel_difference_rel + difference,
            track_m: self.nominal.track_m * (1.0 + track),
            ..self.nominal
        }
    }

    /// One step of every session's wheels and of the noise; how far the wheels moved at the most.
    fn round(&mut self) -> (f64, Noise) {
        let robots: Vec<Robot> = self.wheels.iter().map(|&wheels| self.robot(wheels)).collect();
        for piece in &mut self.logs {
            piece.windows = windows(piece.log, &piece.cuts, &robots[piece.session]);
        }
        let noise = self.noise.unwrap_or_else(|| self.first_noise());
        let seen = self.with_ticks(&noise);
        let mut all = Vec::new();
        for piece in &mut self.logs {
            let mut squared = Vec::with_capacity(piece.windows.len());
            sweep(piece.log.start(), &piece.windows, &seen, Gate::Judge(self.gate, &mut squared));
            piece.used = squared.iter().map(|&squared| squared <= self.gate).collect();
            all.append(&mut squared);
        }
        self.gate = share_of(&mut all, GOOD_SHARE).max(GATE);
        let noise = self.likeliest(noise, if self.noise.is_none() { 1.0 } else { 0.1 });
        self.noise = Some(noise);
        let mut moved: f64 = 0.0;
        for session in 0..self.wheels.len() {
            let sums = self.sums(&noise, |other| other == session);
            let old = self.wheels[session];
            let before = before();
            let pull: Vector = std::array::from_fn(|i| sums.pull[i] - old[i] * before[i][i]);
            let Some(spread) = inverse(&plus(&sums.information, &before)) else { continue };
            let step = apply(&spread, &pull);
            let new: Vector = std::array::from_fn(|i| (old[i] + step[i].clamp(-0.1, 0.1)).clamp(-0.5, 0.5));
            moved = (0..3).map(|i| (new[i] - old[i]).abs()).fold(moved, f64::max);
            self.wheels[session] = new;
        }
        (moved, noise)
    }

    /// From the median window, so that a few wrong poses do not matter.
    fn first_noise(&mut self) -> Noise {
        let each =
            self.logs.iter().flat_map(|piece| roughness(piece.log.start(), &piece.windows, &self.tick));
        let mut squared: Vec<f64> = each.collect();
        let unevenness = (share_of(&mut squared, 0.5) / MEDIAN_3).sqrt().clamp(1e-6, 0.1);
        self.gate = (share_of(&mut squared, GOOD_SHARE) / unevenness.powi(2)).max(GATE);
        let (position, bearing) = if self.tells_truth { (1e-3, 3e-3) } else { (0.0, 0.0) };
        Noise { unevenness, position, bearing }
    }

    fn with_ticks(&self, noise: &Noise) -> Noise {
        Noise {
            unevenness: noise.unevenness,
            position: noise.position.hypot(self.tick.position),
            bearing: noise.bearing.hypot(self.tick.bearing),
        }
    }

    /// The sums over some sessions' logs.
    fn sums(&self, noise: &Noise, session: impl Fn(usize) -> bool) -> Sums {
        let noise = self.with_ticks(noise);
        let logs = self.logs.iter().filter(|piece| session(piece.session));
        logs.map(|piece| sweep(piece.log.start(), &piece.windows, &noise, Gate::As(&piece.used)))
            .fold(Sums::NONE, |sums, log| sums.plus(&log))
    }

    /// The likeliest noises, by trying steps of their logarithms that become shorter (Hooke and Jeeves, *Direct
    /// Search*, 1961).
    fn likeliest(&self, from: Noise, step: f64) -> Noise {
        let unlikely = |noise: &Noise| self.sums(noise, |_| true).unlikely;
        let tried = |noise: &Noise, which: usize, factor: f64| {
            let mut noise = *noise;
            match which {
                0 => noise.unevenness = (noise.unevenness * factor).clamp(1e-7, 1.0),
                1 => noise.position = (noise.position * factor).clamp(1e-6, 1.0),
                _ => noise.bearing = (noise.bearing * factor).clamp(1e-6, 1.0),
            }
            noise
        };
        let (mut best, mut least) = (from, unlikely(&from));
        let mut step = step;
        while step > 4e-3 {
            let before = least;
            for which in 0..if self.tells_truth { 3 } else { 1 } {
                for factor in [step.exp(), (-step).exp()] {
                    let other = tried(&best, which, factor);
                    let value = unlikely(&other);
                    if value < least {
                        (best, least) = (other, value);
                        break;
                    }
                }
            }
            let gained = before - least > 1e-6 * before.abs();
            if !gained {
                step /= 2.0;
            }
        }
        best
    }

    fn result(&self, noise: Noise) -> Calibration {
        let used = self.sums(&noise, |_| true).used;
        // Three parameters a session took part of the differences away.
        let (seen, taken) = (3.0 * used as f64, 3.0 * self.wheels.len() as f64);
        let lost = if seen > taken { (seen / (seen - taken)).sqrt() } else { 1.0 };
        let each: Vec<(Vector, Matrix)> = (0..self.wheels.len())
            .filter_map(|session| {
                let sums = self.sums(&noise, |other| other == session);
                let spread = inverse(&plus(&sums.information, &before()))?;
                Some((self.wheels[session], scaled(&spread, lost * lost)))
            })
            .collect();
        let between = std::array::from_fn(|i| {
            // A session that tells next to nothing of a parameter is no witness of how sessions differ.
            let tells = |spread: &Matrix| spread[i][i] < 0.25 * BEFORE[i].powi(2);
            let each = each.iter().filter(|(_, spread)| tells(spread));
            let fits: Vec<_> = each.map(|(wheels, spread)| (wheels[i], 1.0 / spread[i][i])).collect();
            beyond(&fits)
        });
        let (wheels, spread) = together(&each, between);
        let fit_rel = std::array::from_fn(|i| spread[i][i].sqrt());
        let mut robot = self.robot(wheels);
        // A session to come differs from the mean of these by its own part and by the mean's error.
        let whole = |i: usize| between[i].hypot(fit_rel[i]).min(0.3);
        robot.errors.wheel_perimeter_rel = whole(0);
        robot.errors.wheel_difference_rel = whole(1);
        robot.errors.track_rel = whole(2);
        robot.errors.unevenness_m_per_sqrt_m = noise.unevenness * lost;
        // Each wheel rolls a quarter of π × track in a turn by 90°.
        robot.errors.turn_rad = noise.unevenness * lost * (PI / (2.0 * robot.track_m)).sqrt();
        let truth = TruthNoise { position_m: noise.position, bearing_rad: noise.bearing };
        let all: usize = self.logs.iter().map(|piece| piece.used.len()).sum();
        let (poses, left_out) = (used, all - used);
        Calibration { robot, fit_rel, between_sessions_rel: between, truth, poses, left_out }
    }
}

/// The number below which this share of the numbers lies; 1 if there is none.
fn share_of(numbers: &mut [f64], share: f64) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers.get((numbers.len() as f64 * share) as usize).copied().unwrap_or(1.0)
}

/// What is known before a log is seen, as information.
fn before() -> Matrix {
    diagonal(BEFORE.map(|deviation| deviation.powi(-2)))
}

/// The mean of the sessions' wheels and its covariance: each weighs by its own covariance and what sessions differ.
fn together(each: &[(Vector, Matrix)], between: Vector) -> (Vector, Matrix) {
    let differ = diagonal(between.map(|deviation| deviation.powi(2)));
    let (mut weights, mut sum) = (ZERO, [0.0; 3]);
    for (wheels, spread) in each {
        let Some(weight) = inverse(&plus(spread, &differ)) else { continue };
        let weighed = apply(&weight, wheels);
        weights = plus(&weights, &weight);
        sum = std::array::from_fn(|i| sum[i] + weighed[i]);
    }
    let unknown = diagonal(BEFORE.map(|deviation| deviation.powi(2)));
    let spread = inverse(&weights).unwrap_or(unknown);
    (apply(&spread, &sum), spread)
}

/// The deviation of values beyond their own, each with its weight 1 ÷ variance (`DerSimonian` and Laird, 1986).
fn beyond(values: &[(f64, f64)]) -> f64 {
    let weights: f64 = values.iter().map(|value| value.1).sum();
    let squares: f64 = values.iter().map(|value| value.1.powi(2)).sum();
    let room = weights - squares / weights;
    if values.len() < 2 || room.is_nan() || room <= 0.0 {
        return 0.0;
    }
    let mean = values.iter().map(|(value, weight)| value * weight).sum::<f64>() / weights;
    let spread: f64 = values.iter().map(|(value, weight)| weight * (value - mean).powi(2)).sum();
    ((spread - (values.len() - 1) as f64) / room).max(0.0).sqrt()
}
