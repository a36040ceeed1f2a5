//! An object seen over time: what it can reach for certain, and where it is likely to be.

use super::capsule::Capsule;
use super::turning::{Forecast, Turning};
use super::within;
use crate::error::Error;
use crate::map::PointM;

/// What an object may do, and how well it is seen. All the robot's safety rests on these four numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// The radius of a disc that holds the object.
    pub radius_m: f64,
    /// It is never faster.
    pub max_speed_mps: f64,
    /// Its velocity never changes faster, in whatever direction: braking, speeding up or turning.
    pub max_accel_mps2: f64,
    /// A position seen is never farther from the true one. For normal noise of σ along each axis take 4 σ or more:
    /// one position in 3000 lies beyond 4 σ, one in 270,000 beyond 5 σ.
    pub seen_within_m: f64,
}

impl Bounds {
    /// Checks that the numbers make sense.
    ///
    /// # Errors
    /// [`Error::BadValue`] for a number that is negative, not a number or above a million.
    pub fn checked(self) -> Result<Self, Error> {
        let numbers = [
            ("the object's radius in metres", self.radius_m),
            ("the object's highest speed in m/s", self.max_speed_mps),
            ("the object's highest acceleration in m/s²", self.max_accel_mps2),
            ("the deviation of positions seen in metres", self.seen_within_m),
        ];
        for (name, value) in numbers {
            within(name, value, 0.0, 1e6, "from 0 to 1000000")?;
        }
        Ok(self)
    }
}

/// A position at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Seen {
    time_s: f64,
    at_m: PointM,
    /// How far the true one is at the most.
    within_m: f64,
}

/// How many older positions are kept.
const ANCHORS: usize = 8;

/// An object that is seen now and then.
///
/// With d the deviation of positions seen, v and a the bounds of speed and acceleration, the object's centre is at a
/// time s after it was last seen within *all* of these discs ([`Track::reach`]):
///
/// - d + v s around the position last seen;
/// - for each older position, seen T before the last: d (1 + 2 s ÷ T) + ½ a s (s + T) around the point to which the
///   straight line through the two leads. (The error of linear extrapolation is at most half the second derivative
///   times the product of the distances to both points. The best T is 2 √(d ÷ a), whatever s: older positions are kept
///   a quarter of it apart.)
///
/// This holds for certain while the object keeps to its bounds. Apart from it a filter tells where the object is
/// *likely* to be ([`Track::forecast`]).
///
/// ```
/// use activecell::predict::{Bounds, Track};
/// let bounds = Bounds { radius_m: 0.3, max_speed_mps: 2.0, max_accel_mps2: 0.5, seen_within_m: 0.0 };
/// let mut track = Track::new(bounds)?;
/// track.observe(0.0, [0.0, 0.0])?;
/// track.observe(1.0, [1.0, 0.0])?;
/// let [can, must] = [2.9, 2.0 + 0.5 * 0.5 * 1.0 * 2.0 + 0.01].map(|x| track.may_be_at(2.0, [x, 0.0]));
/// assert!(!can && !must); // 1 m/s for one more second, at most 0.5 m off
/// assert!(track.may_be_at(2.0, [2.4, 0.0]));
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Track {
    bounds: Bounds,
    last: Option<Seen>,
    /// Older positions, the oldest first.
    anchors: Vec<Seen>,
    /// Where and since when it has stood.
    rest: Option<Seen>,
    filter: Turning,
    breaks: u32,
}

impl Track {
    /// An object of which nothing has been seen.
    ///
    /// # Errors
    /// [`Error::BadValue`] as [`Bounds::checked`].
    pub fn new(bounds: Bounds) -> Result<Self, Error> {
        let bounds = bounds.checked()?;
        // An object at full speed can turn at a ÷ v; most are slower and can turn faster.
        let turn =
            if bounds.max_speed_mps > 0.0 { bounds.max_accel_mps2 / bounds.max_speed_mps } else { 0.0 };
        let turn = turn.min(1.0);
        let filter = Turning::new(
            bounds.seen_within_m / 4.0,
            bounds.max_accel_mps2 / 4.0,
            bounds.max_speed_mps / 2.0,
            &[0.0, turn, -turn, 2.0 * turn, -2.0 * turn],
        );
        Ok(Self { bounds, last: None, anchors: Vec::new(), rest: None, filter, breaks: 0 })
    }

    /// What the object may do.
    pub const fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// The filter that tells where the object is likely to be.
    pub const fn filter(&self) -> &Turning {
        &self.filter
    }

    /// When it was last seen.
    pub fn seen_s(&self) -> Option<f64> {
        self.last.map(|last| last.time_s)
    }

    /// Where it was last seen.
    pub fn seen_m(&self) -> Option<PointM> {
        self.last.map(|last| last.at_m)
    }

    /// Takes in a position seen as well as the bounds say; says whether it agrees with them. If not, the object or the
    /// sensor has left them: what was known before is dropped, and the track begins anew.
    ///
    /// # Errors
    /// [`Error::BadValue`] for a time less than a microsecond after the last one, and for numbers beyond 10⁹.
    pub fn observe(&mut self, time_s: f64, at_m: PointM) -> Result<bool, Error> {
        self.observe_within(time_s, at_m, self.bounds.seen_within_m)
    }

    /// The same with a position that is better or worse known than others: `within_m` instead of
    /// [`Bounds::seen_within_m`].
    ///
    /// # Errors
    /// As [`Track::observe`], and for a `within_m` that is negative or beyond a million.
    pub fn observe_within(&mut self, time_s: f64, at_m: PointM, within_m: f64) -> Result<bool, Error> {
        within("the deviation of a position seen, in metres", within_m, 0.0, 1e6, "from 0 to 1000000")?;
        for value in at_m {
            within("a position seen, in metres", value, -1e9, 1e9, "a number of at most a thousand million")?;
        }
        let earliest = self.last.map_or(-1e9, |last| last.time_s + 1e-6);
        within(
            "the time of a position, in seconds",
            time_s,
            earliest,
            1e9,
            "later than the last, up to 10⁹",
        )?;
        let keeps = self.may_be_seen_at(time_s, at_m, within_m);
        if !keeps {
            self.breaks += 1;
            *self = Self { breaks: self.breaks, ..Self::new(self.bounds)? };
        }
        let seen = Seen { time_s, at_m, within_m };
        if let Some(last) = self.last.replace(seen) {
            let apart_s = (4.0 * self.bounds.seen_within_m / self.bounds.max_accel_mps2).sqrt() / 4.0;
            // Without acceleration all times are equally good, so the first position serves for ever.
            if self.anchors.last().is_none_or(|anchor| last.time_s - anchor.time_s >= apart_s) {
                if self.anchors.len() == ANCHORS {
                    self.anchors.remove(0);
                }
                self.anchors.push(last);
            }
        }
        let stays = |rest: &Seen| distance(rest.at_m, at_m) <= rest.within_m + within_m + 0.01;
        self.rest = self.rest.filter(stays).or(Some(seen));
        self.filter.observe(time_s, at_m);
        Ok(keeps)
    }

    /// How often a position was seen that the bounds do not allow.
    pub const fn breaks(&self) -> u32 {
        self.breaks
    }

    /// How long it has stood, as far as its positions tell; 0 before the first.
    pub fn rests_s(&self) -> f64 {
        self.rest.zip(self.last).map_or(0.0, |(rest, last)| last.time_s - rest.time_s)
    }

    /// Where the object's disc can be at any time from `from_s` to `to_s`, as long as it keeps to its bounds: within
    /// every one of these capsules. None if it was never seen: it may be anywhere.
    ///
    /// Times before the last position count as its time.
    pub fn reach(&self, from_s: f64, to_s: f64) -> Vec<Capsule> {
        let mut reach = self.centres(from_s, to_s);
        for capsule in &mut reach {
            capsule.radius_m += self.bounds.radius_m;
        }
        reach
    }

    /// Whether the object's centre can be there at that time.
    pub fn may_be_at(&self, time_s: f64, at_m: PointM) -> bool {
        let point = Capsule { from_m: at_m, to_m: at_m, radius_m: 0.0 };
        self.centres(time_s, time_s).iter().all(|capsule| capsule.gap_m(&point) <= 1e-9)
    }

    /// Where the object's centre is likely to be; `None` if it was never seen.
    pub fn forecast(&self, time_s: f64) -> Option<Forecast> {
        self.filter.forecast(time_s)
    }

    fn may_be_seen_at(&self, time_s: f64, at_m: PointM, within_m: f64) -> bool {
        let seen = Capsule { from_m: at_m, to_m: at_m, radius_m: within_m };
        self.centres(time_s, time_s).iter().all(|capsule| capsule.gap_m(&seen) <= 1e-9)
    }

    /// What [`Track::reach`] says, of the centre alone.
    fn centres(&self, from_s: f64, to_s: f64) -> Vec<Capsule> {
        let Some(last) = self.last else { return Vec::new() };
        let Bounds { max_speed_mps, max_accel_mps2, .. } = self.bounds;
        let (begin_s, end_s) = ((from_s - last.time_s).max(0.0), (to_s - last.time_s).max(0.0));
        let around = last.within_m + max_speed_mps * end_s;
        let mut centres = vec![Capsule { from_m: last.at_m, to_m: last.at_m, radius_m: around }];
        for anchor in &self.anchors {
            let base_s = last.time_s - anchor.time_s;
            let ahead = |s: f64| -> PointM {
                std::array::from_fn(|k| last.at_m[k] + (last.at_m[k] - anchor.at_m[k]) / base_s * s)
            };
            centres.push(Capsule {
                from_m: ahead(begin_s),
                to_m: ahead(end_s),
                radius_m: last.within_m
                    + (last.within_m + anchor.within_m) * end_s / base_s
                    + 0.5 * max_accel_mps2 * end_s * (end_s + base_s),
            });
        }
        centres
    }
}

fn distance(a: PointM, b: PointM) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}
