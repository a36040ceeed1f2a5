//! Strangers: what is closed to a group because something that is no member will be there, as JSON.
//!
//! Cells closed by hand from one step to another, and objects that were seen at some times, with the bounds that they
//! keep to.

use crate::error::{Error, quoted};
use crate::plan::Closed;
use activecell::predict::{Bounds, Slots, Track};
use activecell::{KeepOut, KeepOuts, Lattice, Map};
use serde::Deserialize;

/// The longest file that is read, in bytes.
pub const MAX_STRANGERS_BYTES: u64 = 16 << 20;

/// The version of the files that are read.
pub const VERSION: u32 = 1;

/// The most cells that may be closed, each counted for every step in which it is.
pub const MAX_CLOSED: u64 = 1 << 22;

/// Strangers as a file tells of them.
///
/// ```
/// use activecell::{Cell, Lattice, Map};
/// let text = r#"{"activecell": "strangers", "version": 1, "keep_outs": [{"cell": [2, 0], "from": 1, "to": 3}],
///     "objects": [{"radius_m": 0.3, "max_speed_mps": 0.5, "max_accel_mps2": 1, "seen_within_m": 0.05,
///                  "seen": [[0, 6.5, 0.5], [1, 6.1, 0.5]]}]}"#;
/// let map = Map::parse(Lattice::Square, "........")?;
/// let keep_outs = activecell_formats::strangers::read(text.as_bytes())?.keep_outs(&map, 0)?;
/// assert!(keep_outs.is_closed(Cell::new(2, 0), 3) && !keep_outs.is_closed(Cell::new(2, 0), 4));
/// assert!(keep_outs.is_closed(Cell::new(5, 0), 1) && !keep_outs.is_closed(Cell::new(3, 0), 1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Strangers {
    /// Cells that are closed whoever is there.
    pub closed: Vec<KeepOut>,
    /// Objects that have been seen.
    pub tracks: Vec<Track>,
    /// When the plan starts, on the clock of the sightings; by default when the last of them was.
    pub now_s: f64,
    /// The time of a step, and how many of them are foreseen.
    pub slots: Slots,
    /// The robots' radius, deviations included, if the file says it.
    pub robot_radius_m: Option<f64>,
}

#[derive(Deserialize)]
struct Kind {
    activecell: String,
    version: u32,
}

/// A wrong key could leave a stranger out: none is passed over.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    #[serde(rename = "activecell")]
    _kind: String,
    #[serde(rename = "version")]
    _version: u32,
    step_s: Option<f64>,
    now_s: Option<f64>,
    robot_radius_m: Option<f64>,
    certain_steps: Option<u8>,
    likely_steps: Option<u8>,
    #[serde(default)]
    keep_outs: Vec<Closed>,
    #[serde(default)]
    objects: Vec<Object>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Object {
    radius_m: f64,
    max_speed_mps: f64,
    max_accel_mps2: f64,
    seen_within_m: f64,
    /// Time, x, y.
    seen: Vec<[f64; 3]>,
}

/// Reads a file of strangers.
///
/// # Errors
/// [`Error::BadFormat`] with line and column for what is no such file, has an unknown key or lacks one; with the name of
/// the object for numbers out of range, times that do not grow, and positions that its bounds do not allow.
pub fn read(bytes: &[u8]) -> Result<Strangers, Error> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let kind: Kind = serde_json::from_slice(bytes).map_err(|error| not_json(&error))?;
    if kind.activecell != "strangers" {
        let kind = quoted(&kind.activecell);
        return Err(Error::file(format!("activecell is {kind}, not `strangers`; see docs/bodies.md")));
    }
    if kind.version != VERSION {
        let version = kind.version;
        let reason = format!("version {version} is not known here, only {VERSION}; update activecell");
        return Err(Error::file(reason));
    }
    let file: Document = serde_json::from_slice(bytes).map_err(|error| not_json(&error))?;
    let usual = Slots::default();
    let slots = Slots {
        slot_s: file.step_s.unwrap_or(usual.slot_s),
        robot_radius_m: file.robot_radius_m.unwrap_or(usual.robot_radius_m),
        certain: file.certain_steps.unwrap_or(usual.certain),
        likely: file.likely_steps.unwrap_or(usual.likely),
        ..usual
    };
    let tracks = file.objects.iter().enumerate().map(|(number, object)| {
        object.track().map_err(|reason| Error::file(format!("objects[{number}]: {reason}")))
    });
    let tracks = tracks.collect::<Result<Vec<Track>, Error>>()?;
    let last_s = tracks.iter().filter_map(Track::seen_s).reduce(f64::max);
    let now_s = file.now_s.or(last_s).unwrap_or(0.0);
    let is_possible = now_s.abs() <= 1e9 && last_s.is_none_or(|last_s| last_s <= now_s);
    if !is_possible {
        let reason =
            format!("now_s is {now_s}; it must be no earlier than the last position seen, up to 10⁹");
        return Err(Error::file(reason));
    }
    Ok(Strangers {
        closed: file.keep_outs.iter().map(Closed::keep_out).collect(),
        tracks,
        now_s,
        slots: slots.checked()?,
        robot_radius_m: file.robot_radius_m,
    })
}

impl Object {
    fn track(&self) -> Result<Track, String> {
        let said = |error: activecell::Error| error.to_string();
        let Self { radius_m, max_speed_mps, max_accel_mps2, seen_within_m, .. } = *self;
        let bounds = Bounds { radius_m, max_speed_mps, max_accel_mps2, seen_within_m };
        let mut track = Track::new(bounds).map_err(said)?;
        if self.seen.is_empty() {
            return Err(
                "`seen` is empty, so that it may be anywhere; give a position, [s, x m, y m]".to_owned()
            );
        }
        for (number, &[time_s, x_m, y_m]) in self.seen.iter().enumerate() {
            let agrees = track.observe(time_s, [x_m, y_m]);
            if !agrees.map_err(|error| format!("seen[{number}]: {error}"))? {
                return Err(format!(
                    "seen[{number}] is farther than its bounds allow; correct it, or raise max_speed_mps, max_accel_mps2 or seen_within_m"
                ));
            }
        }
        Ok(track)
    }
}

impl Strangers {
    /// The closed cells for robots whose largest covers a block of this radius, in cells.
    ///
    /// # Errors
    /// [`Error::BadFormat`] if more than [`MAX_CLOSED`] cells were closed, before memory is taken for them;
    /// [`Error::Core`] as [`KeepOuts::new`].
    pub fn keep_outs(&self, map: &Map, largest: u32) -> Result<KeepOuts, Error> {
        let slots = Slots { robot_radius_m: self.robot_radius_m(map, largest), ..self.slots };
        let spans = self.closed.iter().map(|it| u64::from(it.to_step.saturating_sub(it.from_step)) + 1);
        let reached = self.tracks.iter().map(|track| self.most_reached(map, &slots, track));
        if spans.chain(reached).fold(0, u64::saturating_add) > MAX_CLOSED {
            return Err(Error::file(format!(
                "more than {MAX_CLOSED} cells may be closed, counted for each step; draw what stays into the map, bound objects more closely, or foresee fewer steps"
            )));
        }
        let mut all = self.closed.clone();
        all.extend(KeepOuts::foreseen(map, slots, self.now_s, &self.tracks)?.all());
        Ok(KeepOuts::new(map, all)?)
    }

    /// The radius of what may be touched within a covered cell. A body of several cells may fill them to the corners.
    fn robot_radius_m(&self, map: &Map, largest: u32) -> f64 {
        let corner_m = match map.lattice() {
            Lattice::Square => map.frame().cell_m / 2f64.sqrt(),
            Lattice::Hex => map.frame().cell_m / 3f64.sqrt(),
        };
        match self.robot_radius_m {
            Some(radius_m) if largest == 0 => radius_m,
            Some(radius_m) => radius_m.max(corner_m),
            None => corner_m,
        }
    }

    /// No more cells, counted for each slot, can be closed by this object.
    fn most_reached(&self, map: &Map, slots: &Slots, track: &Track) -> u64 {
        let Bounds { radius_m, max_speed_mps, seen_within_m, .. } = *track.bounds();
        let count = f64::from(slots.certain) + f64::from(slots.likely);
        let after_s = self.now_s - track.seen_s().unwrap_or(self.now_s) + count * slots.slot_s;
        let reach_m = radius_m + seen_within_m + max_speed_mps * after_s + slots.robot_radius_m;
        // Rows of hexagons are nearer than cells; a cell more on each side.
        let across = 2.0 * reach_m / (0.86 * map.frame().cell_m) + 4.0;
        let within = |cells: u32| across.min(f64::from(cells));
        (within(map.width()) * within(map.height()) * count) as u64
    }
}

/// The place and the first line of what is wrong.
fn not_json(error: &serde_json::Error) -> Error {
    let text = error.to_string();
    let reason = text.split(" at line ").next().unwrap_or_default().replace('\n', " ");
    let reason = format!("not a file of strangers: {}; see docs/bodies.md", reason.trim());
    if error.line() == 0 { Error::file(reason) } else { Error::at(error.line(), error.column(), reason) }
}
