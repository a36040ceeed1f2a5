//! Where an object is likely to be: filters of several turn rates that weigh each other.

use crate::map::PointM;

/// Where an object is likely to be at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Forecast {
    /// The expected centre.
    pub at_m: PointM,
    /// The standard deviation of the centre along each axis.
    pub std_m: f64,
}

impl Forecast {
    /// The radius around the expected centre that holds the true one with this probability, if both deviate
    /// normally: σ √(−2 ln (1 − p)).
    ///
    /// ```
    /// use activecell::predict::Forecast;
    /// let radius_m = Forecast { at_m: [0.0, 0.0], std_m: 1.0 }.radius_m(0.95);
    /// assert!((radius_m - 2.4477).abs() < 1e-4);
    /// ```
    pub fn radius_m(&self, probability: f64) -> f64 {
        self.std_m * (-2.0 * (1.0 - probability.clamp(0.0, 1.0 - f64::EPSILON)).ln()).sqrt()
    }
}

/// How long an object keeps turning at the same rate, on the average.
const STEADY_S: f64 = 4.0;

/// A bank of Kalman filters, one for each turn rate (0: straight on), which mix after each position seen: the
/// *interacting multiple model*.
///
/// A point of the plane is one complex number. Then a turn at a known rate ω is linear, p′ = p + v (e^{iωt} − 1) ÷ iω
/// and v′ = v e^{iωt}, and the filter is an exact Kalman filter with a 2 × 2 covariance: no linearization.
///
/// Source: Blom and Bar-Shalom, *The Interacting Multiple Model Algorithm for Systems with Markovian Switching
/// Coefficients*, IEEE Trans. Automatic Control, 1988.
///
/// ```
/// use activecell::predict::Turning;
/// let mut filter = Turning::new(0.01, 0.1, 1.0, &[0.0, 0.5, -0.5]);
/// for i in 0..40 {
///     let t: f64 = 0.25 * f64::from(i);
///     filter.observe(t, [(0.5 * t).sin(), -(0.5 * t).cos()]); // a circle, to the left
/// }
/// assert!((filter.turn_radps() - 0.5).abs() < 0.1);
/// let t: f64 = 11.0;
/// let forecast = filter.forecast(t).expect("something was seen");
/// let [x, y] = [(0.5 * t).sin(), -(0.5 * t).cos()];
/// assert!((forecast.at_m[0] - x).hypot(forecast.at_m[1] - y) < forecast.radius_m(0.99));
/// ```
#[derive(Debug, Clone)]
pub struct Turning {
    seen_var_m2: f64,
    /// Density of the white noise that the acceleration is taken for.
    wander_m2ps3: f64,
    speed_std_mps: f64,
    turn_rates_radps: Vec<f64>,
    seen_s: f64,
    models: Vec<Model>,
    innovation: Option<f64>,
}

/// One filter of the bank.
#[derive(Debug, Clone, Copy)]
struct Model {
    /// How probable it is.
    share: f64,
    at: Complex,
    velocity: Complex,
    /// Variances along each axis, and the complex covariance of position and velocity.
    at_var: f64,
    velocity_var: f64,
    cross: Complex,
}

impl Turning {
    /// A bank for positions seen with the standard deviation `seen_std_m` along each axis, of objects whose velocity
    /// wanders by `wander_mps` in a second and is at first known to `speed_std_mps`.
    pub fn new(seen_std_m: f64, wander_mps: f64, speed_std_mps: f64, turn_rates_radps: &[f64]) -> Self {
        Self {
            // Never certain to the last digit, or the filter would divide by zero.
            seen_var_m2: seen_std_m.max(1e-6).powi(2),
            wander_m2ps3: wander_mps * wander_mps,
            speed_std_mps,
            turn_rates_radps: turn_rates_radps.to_vec(),
            seen_s: 0.0,
            models: Vec::new(),
            innovation: None,
        }
    }

    /// Takes in a position.
    pub fn observe(&mut self, time_s: f64, at_m: PointM) {
        let seen = Complex(at_m[0], at_m[1]);
        let rates = self.turn_rates_radps.len();
        if self.models.is_empty() {
            let first = Model {
                share: 1.0 / rates as f64,
                at: seen,
                velocity: Complex(0.0, 0.0),
                at_var: self.seen_var_m2,
                velocity_var: self.speed_std_mps.powi(2),
                cross: Complex(0.0, 0.0),
            };
            self.models = vec![first; rates];
        } else {
            self.mix(time_s - self.seen_s);
            for (model, &rate) in self.models.iter_mut().zip(&self.turn_rates_radps) {
                *model = model.after(time_s - self.seen_s, rate, self.wander_m2ps3);
            }
            let expected = spread(&self.models);
            let off = seen.minus(Complex(expected.at_m[0], expected.at_m[1])).square();
            self.innovation = Some(off / (expected.std_m.powi(2) + self.seen_var_m2));
            self.update(seen);
        }
        self.seen_s = time_s;
    }

    /// The square of the last position's deviation from what was expected, by its variance along an axis: 2 on the
    /// average if the filter's idea of the object is right; `None` before the second position.
    pub const fn normalized_innovation(&self) -> Option<f64> {
        self.innovation
    }

    /// The expected turn rate, counter-clockwise.
    pub fn turn_radps(&self) -> f64 {
        self.models.iter().zip(&self.turn_rates_radps).map(|(model, rate)| model.share * rate).sum()
    }

    /// The expected velocity when it was last seen.
    pub fn velocity_mps(&self) -> PointM {
        let sum = self
            .models
            .iter()
            .fold(Complex(0.0, 0.0), |sum, model| sum.plus(model.velocity.times(Complex(model.share, 0.0))));
        [sum.0, sum.1]
    }

    /// Where it is likely to be at a time not before the last position; `None` before the first.
    pub fn forecast(&self, time_s: f64) -> Option<Forecast> {
        let ahead_s = (time_s - self.seen_s).max(0.0);
        let then: Vec<Model> = (self.models.iter().zip(&self.turn_rates_radps))
            .map(|(model, &rate)| model.after(ahead_s, rate, self.wander_m2ps3))
            .collect();
        (!then.is_empty()).then(|| spread(&then))
    }

    /// Lets each filter begin from what all believe, as far as the object may have changed its turn rate.
    fn mix(&mut self, elapsed_s: f64) {
        let others = (self.models.len() as f64 - 1.0).max(1.0);
        let stays = if self.models.len() > 1 { (-elapsed_s / STEADY_S).exp() } else { 1.0 };
        let changes = (1.0 - stays) / others;
        let before = self.models.clone();
        for (j, model) in self.models.iter_mut().enumerate() {
            let weight = |i: usize| before[i].share * if i == j { stays } else { changes };
            let share: f64 = (0..before.len()).map(weight).sum();
            *model = mixture(&before, |i| weight(i) / share, share);
        }
    }

    /// Corrects each filter by the position seen, and weighs it by how well it foresaw it.
    fn update(&mut self, seen: Complex) {
        let mut logs = Vec::with_capacity(self.models.len());
        for model in &mut self.models {
            let variance = model.at_var + self.seen_var_m2;
            let off = seen.minus(model.at);
            logs.push(model.share.ln() - variance.ln() - off.square() / (2.0 * variance));
            model.at = model.at.plus(off.times(Complex(model.at_var / variance, 0.0)));
            model.velocity =
                model.velocity.plus(off.times(model.cross.conjugate()).times(Complex(1.0 / variance, 0.0)));
            model.velocity_var -= model.cross.square() / variance;
            model.cross = model.cross.times(Complex(self.seen_var_m2 / variance, 0.0));
            model.at_var *= self.seen_var_m2 / variance;
        }
        let best = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        // A model is never quite given up, so that it can come back.
        let weights: Vec<f64> = logs.iter().map(|log| (log - best).exp().max(1e-9)).collect();
        let sum: f64 = weights.iter().sum();
        for (model, weight) in self.models.iter_mut().zip(weights) {
            model.share = weight / sum;
        }
    }
}

impl Model {
    /// What it expects after a time at its turn rate.
    fn after(&self, elapsed_s: f64, turn_radps: f64, wander: f64) -> Self {
        let angle = turn_radps * elapsed_s;
        let turned = Complex(angle.cos(), angle.sin());
        let way = if angle.abs() < 1e-6 {
            Complex(elapsed_s, 0.0)
        } else {
            // (e^{iα} − 1) ÷ iω
            Complex(angle.sin() / turn_radps, (1.0 - angle.cos()) / turn_radps)
        };
        let along = way.conjugate().times(self.cross).0;
        let cross = self.cross.plus(way.times(Complex(self.velocity_var, 0.0)));
        let noise = Complex(wander * elapsed_s.powi(2) / 2.0, 0.0);
        Self {
            share: self.share,
            at: self.at.plus(way.times(self.velocity)),
            velocity: self.velocity.times(turned),
            at_var: self.at_var
                + 2.0 * along
                + way.square() * self.velocity_var
                + wander * elapsed_s.powi(3) / 3.0,
            velocity_var: self.velocity_var + wander * elapsed_s,
            cross: cross.times(turned.conjugate()).plus(noise),
        }
    }
}

/// One normal distribution with the mean and the covariance of a weighted sum of them.
fn mixture(models: &[Model], weight: impl Fn(usize) -> f64, share: f64) -> Model {
    let zero = Complex(0.0, 0.0);
    let mut sum = Model { share, at: zero, velocity: zero, at_var: 0.0, velocity_var: 0.0, cross: zero };
    for (i, model) in models.iter().enumerate() {
        let by = Complex(weight(i), 0.0);
        sum.at = sum.at.plus(model.at.times(by));
        sum.velocity = sum.velocity.plus(model.velocity.times(by));
    }
    for (i, model) in models.iter().enumerate() {
        let (at, velocity) = (model.at.minus(sum.at), model.velocity.minus(sum.velocity));
        let apart = at.times(velocity.conjugate()).times(Complex(0.5, 0.0));
        sum.at_var += weight(i) * (model.at_var + at.square() / 2.0);
        sum.velocity_var += weight(i) * (model.velocity_var + velocity.square() / 2.0);
        sum.cross = sum.cross.plus(model.cross.plus(apart).times(Complex(weight(i), 0.0)));
    }
    sum
}

fn spread(models: &[Model]) -> Forecast {
    let all = mixture(models, |i| models[i].share, 1.0);
    Forecast { at_m: [all.at.0, all.at.1], std_m: all.at_var.max(0.0).sqrt() }
}

/// A point of the plane as a number: x + i y.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Complex(f64, f64);

impl Complex {
    fn plus(self, other: Self) -> Self {
        Self(self.0 + other.0, self.1 + other.1)
    }

    fn minus(self, other: Self) -> Self {
        Self(self.0 - other.0, self.1 - other.1)
    }

    fn times(self, other: Self) -> Self {
        Self(self.0 * other.0 - self.1 * other.1, self.0 * other.1 + self.1 * other.0)
    }

    fn conjugate(self) -> Self {
        Self(self.0, -self.1)
    }

    /// The square of its length.
    fn square(self) -> f64 {
        self.0 * self.0 + self.1 * self.1
    }
}
