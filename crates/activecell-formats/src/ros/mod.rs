//! Maps of the ROS `map_server`: a YAML file and an image.

mod occupancy;
mod yaml;

pub use occupancy::{Reading, Rules, from_map, occupancy, to_image, to_map};

use crate::error::{Error, quoted};
use std::fmt::Write as _;

/// The longest YAML file that is read, in bytes.
pub const MAX_YAML_BYTES: u64 = yaml::MAX_BYTES;

/// How the image's brightness becomes occupancy.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Mode {
    /// Free, occupied, or unknown.
    #[default]
    Trinary,
    /// As trinary, with 0 to 100 between the thresholds.
    Scale,
    /// The brightness itself is the occupancy, 0 to 100; all else is unknown.
    Raw,
}

impl Mode {
    /// The word for it in the YAML file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Trinary => "trinary",
            Self::Scale => "scale",
            Self::Raw => "raw",
        }
    }
}

/// What a map's YAML file states.
///
/// ```
/// use activecell_formats::ros::{MapYaml, Mode};
/// let text = "image: office.pgm\nresolution: 0.05\norigin: [-1.5, 2.0, 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
/// let yaml = MapYaml::read(text.as_bytes())?;
/// assert_eq!((yaml.resolution_m, yaml.origin_m, yaml.mode), (0.05, [-1.5, 2.0], Mode::Trinary));
/// assert_eq!(MapYaml::read(yaml.write().as_bytes())?, yaml);
/// # Ok::<(), activecell_formats::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct MapYaml {
    /// The image's path, relative to the YAML's folder.
    pub image: String,
    /// A pixel from side to side, in metres.
    pub resolution_m: f64,
    /// The lower left corner of the image on the floor, in metres.
    pub origin_m: [f64; 2],
    /// How far the image is turned about its origin, counter-clockwise, in radians.
    pub yaw_rad: f64,
    /// Whether white is occupied and black free.
    pub negate: bool,
    /// Occupied from this probability on, 0 to 1.
    pub occupied_thresh: f64,
    /// Free up to this probability, 0 to 1.
    pub free_thresh: f64,
    /// How brightness becomes occupancy.
    pub mode: Mode,
}

impl Default for MapYaml {
    /// For an image without a YAML file: pixels of 0.05 m, the origin at (0, 0), thresholds 0.65 and 0.196, trinary.
    fn default() -> Self {
        Self {
            image: String::new(),
            resolution_m: 0.05,
            origin_m: [0.0, 0.0],
            yaw_rad: 0.0,
            negate: false,
            occupied_thresh: 0.65,
            free_thresh: 0.196,
            mode: Mode::Trinary,
        }
    }
}

const REQUIRED: [&str; 6] = ["image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh"];
const ORIGIN_HINT: &str = "give [x, y, yaw] in metres and radians, for example [-10.0, -10.0, 0.0]";

impl MapYaml {
    /// Reads a YAML file. All keys but `mode` are mandatory, unknown keys are left out of account.
    ///
    /// # Errors
    /// [`Error::BadFormat`] with line and column; [`Error::TooLarge`] above [`MAX_YAML_BYTES`].
    pub fn read(bytes: &[u8]) -> Result<Self, Error> {
        let entries = yaml::read(bytes)?;
        let missing: Vec<String> = REQUIRED
            .iter()
            .filter(|&&key| !entries.contains_key(key))
            .map(|key| format!("`{key}`"))
            .collect();
        if !missing.is_empty() {
            let keys = if missing.len() == 1 { "key is" } else { "keys are" };
            return Err(Error::file(format!(
                "the {keys} missing: {}; a map needs image, resolution, origin, negate, occupied_thresh, free_thresh",
                missing.join(", ")
            )));
        }
        let image = &entries["image"].scalar("image", "name one image")?;
        if image.text.is_empty() || image.text == "~" {
            return Err(image.error("image is empty; name the image's file, for example `image: map.pgm`"));
        }
        let (origin_m, yaw_rad) = read_origin(&entries["origin"])?;
        let (occupied_thresh, free_thresh) = read_thresholds(&entries)?;
        Ok(Self {
            image: image.text.clone(),
            resolution_m: read_resolution(&entries["resolution"])?,
            origin_m,
            yaw_rad,
            negate: read_negate(&entries["negate"])?,
            occupied_thresh,
            free_thresh,
            mode: entries.get("mode").map_or(Ok(Mode::default()), read_mode)?,
        })
    }

    /// The YAML file's text; numbers in as many digits as they need to be read back unchanged.
    pub fn write(&self) -> String {
        let [x, y] = self.origin_m;
        let lines = [
            format!("image: {}", written_text(&self.image)),
            format!("mode: {}", self.mode.name()),
            format!("resolution: {}", written(self.resolution_m)),
            format!("origin: [{}, {}, {}]", written(x), written(y), written(self.yaw_rad)),
            format!("negate: {}", u8::from(self.negate)),
            format!("occupied_thresh: {}", written(self.occupied_thresh)),
            format!("free_thresh: {}", written(self.free_thresh)),
        ];
        lines.join("\n") + "\n"
    }
}

fn read_resolution(entry: &yaml::Entry) -> Result<f64, Error> {
    let hint = "give metres per pixel, for example 0.05";
    let resolution = entry.scalar("resolution", hint)?.number("resolution", hint)?;
    // The same range as a map's frame has; here the line is known.
    if (1e-6..=1e6).contains(&resolution) {
        Ok(resolution)
    } else {
        Err(entry.error(format!("resolution is {resolution}; {hint}")))
    }
}

fn read_origin(entry: &yaml::Entry) -> Result<([f64; 2], f64), Error> {
    let list = entry.list("origin", ORIGIN_HINT)?;
    let [x, y, yaw] = list else {
        return Err(entry.error(format!("origin has {} numbers; {ORIGIN_HINT}", list.len())));
    };
    let number = |scalar: &yaml::Scalar, name: &str| {
        let value = scalar.number(name, ORIGIN_HINT)?;
        if value.abs() <= 1e9 {
            Ok(value)
        } else {
            Err(scalar.error(format!("{name} is {value}, beyond a thousand million; {ORIGIN_HINT}")))
        }
    };
    Ok(([number(x, "origin x")?, number(y, "origin y")?], number(yaw, "origin yaw")?))
}

fn read_thresholds(entries: &std::collections::BTreeMap<String, yaml::Entry>) -> Result<(f64, f64), Error> {
    let threshold = |key: &str, hint: &str| {
        let value = entries[key].scalar(key, hint)?.number(key, hint)?;
        if (0.0..=1.0).contains(&value) {
            Ok(value)
        } else {
            Err(entries[key].error(format!("{key} is {value}; {hint}")))
        }
    };
    let occupied = threshold("occupied_thresh", "give a probability from 0 to 1, for example 0.65")?;
    let free = threshold("free_thresh", "give a probability from 0 to 1, for example 0.25")?;
    if free < occupied {
        Ok((occupied, free))
    } else {
        let reason = format!("free_thresh {free} is not below occupied_thresh {occupied}; make it smaller");
        Err(entries["free_thresh"].error(reason))
    }
}

fn read_negate(entry: &yaml::Entry) -> Result<bool, Error> {
    let hint = "give 0 (black is occupied) or 1 (white is occupied)";
    let text = &entry.scalar("negate", hint)?.text;
    match text.to_ascii_lowercase().as_str() {
        "0" | "false" => Ok(false),
        "1" | "true" => Ok(true),
        _ => Err(entry.error(format!("negate is {}; {hint}", quoted(text)))),
    }
}

fn read_mode(entry: &yaml::Entry) -> Result<Mode, Error> {
    let hint = "give trinary, scale or raw";
    let text = &entry.scalar("mode", hint)?.text;
    let modes = [Mode::Trinary, Mode::Scale, Mode::Raw];
    let found = modes.into_iter().find(|mode| mode.name().eq_ignore_ascii_case(text));
    found.ok_or_else(|| entry.error(format!("mode is {}; {hint}", quoted(text))))
}

/// A number with a decimal point and no exponent: YAML 1.1 readers take `1e-7` for a word.
fn written(number: f64) -> String {
    let text = number.to_string();
    if text.contains('.') || !number.is_finite() { text } else { text + ".0" }
}

/// Text as a YAML scalar: plain where nothing in it has a meaning, otherwise in double quotes.
fn written_text(text: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '.' | '/' | '-');
    if text.starts_with(|c: char| c.is_ascii_alphabetic()) && text.chars().all(plain) {
        return text.to_owned();
    }
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            c if c.is_control() || matches!(c, '\u{2028}' | '\u{2029}' | '\u{feff}') => {
                // Writing to a string cannot fail.
                let _ = write!(out, "\\u{:04x}", c as u32);
            }
            c => out.push(c),
        }
    }
    out + "\""
}
