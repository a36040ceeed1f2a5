//! Robot files: TOML, every key with its unit in its name and a default for each.

use crate::error::{Error, quoted};
use activecell::{Drive, Robot};
use std::ops::Range;
use toml::de::{DeTable, DeValue};
use toml_edit::DocumentMut;

/// Where a key's value goes.
enum Slot {
    Number(fn(&mut Robot) -> &mut f64),
    Count(fn(&mut Robot) -> &mut u32),
    Flag(fn(&mut Robot) -> &mut bool),
    Drive,
}

/// Every key of a robot file, with its section.
const KEYS: [(&str, Slot); 31] = [
    ("wheel_perimeter_m", Slot::Number(|robot| &mut robot.wheel_perimeter_m)),
    ("wheel_difference_rel", Slot::Number(|robot| &mut robot.wheel_difference_rel)),
    ("ticks_per_rev", Slot::Number(|robot| &mut robot.ticks_per_rev)),
    ("track_m", Slot::Number(|robot| &mut robot.track_m)),
    ("radius_m", Slot::Number(|robot| &mut robot.radius_m)),
    ("drive", Slot::Drive),
    ("can_reverse", Slot::Flag(|robot| &mut robot.can_reverse)),
    ("max_speed_mps", Slot::Number(|robot| &mut robot.max_speed_mps)),
    ("max_accel_mps2", Slot::Number(|robot| &mut robot.max_accel_mps2)),
    ("turn_rate_radps", Slot::Number(|robot| &mut robot.turn_rate_radps)),
    ("power.mass_kg", Slot::Number(|robot| &mut robot.power.mass_kg)),
    ("power.rolling_resistance", Slot::Number(|robot| &mut robot.power.rolling_resistance)),
    ("power.idle_w", Slot::Number(|robot| &mut robot.power.idle_w)),
    ("power.drive_efficiency", Slot::Number(|robot| &mut robot.power.drive_efficiency)),
    ("slopes.up_max_deg", Slot::Number(|robot| &mut robot.slopes.up_max_deg)),
    ("slopes.down_max_deg", Slot::Number(|robot| &mut robot.slopes.down_max_deg)),
    ("slopes.across_max_deg", Slot::Number(|robot| &mut robot.slopes.across_max_deg)),
    ("slopes.climb_cost_m_per_m", Slot::Number(|robot| &mut robot.slopes.climb_cost_m_per_m)),
    ("errors.wheel_perimeter_rel", Slot::Number(|robot| &mut robot.errors.wheel_perimeter_rel)),
    ("errors.wheel_difference_rel", Slot::Number(|robot| &mut robot.errors.wheel_difference_rel)),
    ("errors.track_rel", Slot::Number(|robot| &mut robot.errors.track_rel)),
    ("errors.unevenness_m_per_sqrt_m", Slot::Number(|robot| &mut robot.errors.unevenness_m_per_sqrt_m)),
    ("errors.cell_division_m", Slot::Number(|robot| &mut robot.errors.cell_division_m)),
    ("errors.stop_inertia_m", Slot::Number(|robot| &mut robot.errors.stop_inertia_m)),
    ("errors.turn_rad", Slot::Number(|robot| &mut robot.errors.turn_rad)),
    ("errors.start_m", Slot::Number(|robot| &mut robot.errors.start_m)),
    ("errors.start_rad", Slot::Number(|robot| &mut robot.errors.start_rad)),
    ("sensors.range_m", Slot::Number(|robot| &mut robot.sensors.range_m)),
    ("sensors.noise_m", Slot::Number(|robot| &mut robot.sensors.noise_m)),
    ("sensors.beams", Slot::Count(|robot| &mut robot.sensors.beams)),
    ("sensors.false_rate", Slot::Number(|robot| &mut robot.sensors.false_rate)),
];

/// Reads a robot file; keys that it does not name keep their defaults ([`Robot::default`]).
///
/// # Errors
/// [`Error::BadFormat`] with line and column: not TOML, a key that no robot has (the nearest known key is
/// named), a value of another kind or out of its range.
///
/// ```
/// use activecell_formats::robot;
/// let robot = robot::read(b"wheel_perimeter_m = 0.5\ndrive = \"steered\"\n[errors]\nturn_rad = 0.02\n")?;
/// assert_eq!(robot.wheel_perimeter_m, 0.5);
/// let error = robot::read(b"weel_perimeter_m = 0.5").unwrap_err();
/// assert_eq!(error.to_string(), "line 1, column 1: unknown key `weel_perimeter_m`; did you mean `wheel_perimeter_m`?");
/// # Ok::<(), activecell_formats::Error>(())
/// ```
pub fn read(bytes: &[u8]) -> Result<Robot, Error> {
    let text = std::str::from_utf8(bytes).map_err(|_| Error::file("not UTF-8 text; a robot file is TOML"))?;
    let document = DeTable::parse(text).map_err(|error| {
        let message = error.message().lines().next().unwrap_or_default().to_owned();
        at(text, error.span().unwrap_or(0..0), format!("not TOML: {message}"))
    })?;
    let mut robot = Robot::default();
    read_table(text, "", document.get_ref(), &mut robot)?;
    Ok(robot)
}

/// The text of a robot file in which `robot` stands instead of what it says now: only values that differ are
/// written, and comments and order stay. An empty text becomes a file of what differs from the default.
///
/// Numbers that are written have seven digits.
///
/// # Errors
/// Those of [`read`], for the text as it is.
///
/// ```
/// use activecell::Robot;
/// use activecell_formats::robot;
/// let text = "# ours\ntrack_m = 0.3 # by the ruler\nradius_m = 0.2\n";
/// let robot = Robot { track_m: 0.2953, ..robot::read(text.as_bytes())? };
/// assert_eq!(robot::update(text, &robot)?, text.replace("0.3", "0.2953"));
/// # Ok::<(), activecell_formats::Error>(())
/// ```
pub fn update(text: &str, robot: &Robot) -> Result<String, Error> {
    let mut old = read(text.as_bytes())?;
    let mut robot = *robot;
    let mut document: DocumentMut = text.parse().map_err(|_| Error::file("not TOML"))?;
    for (key, slot) in &KEYS {
        let value: toml_edit::Value = match slot {
            Slot::Number(field) if field(&mut old).to_bits() == field(&mut robot).to_bits() => continue,
            Slot::Count(field) if field(&mut old) == field(&mut robot) => continue,
            Slot::Flag(field) if field(&mut old) == field(&mut robot) => continue,
            Slot::Drive if old.drive == robot.drive => continue,
            // Written with seven digits and read again.
            Slot::Number(field) => {
                format!("{:.6e}", field(&mut robot)).parse().unwrap_or(*field(&mut robot)).into()
            }
            Slot::Count(field) => i64::from(*field(&mut robot)).into(),
            Slot::Flag(field) => (*field(&mut robot)).into(),
            Slot::Drive => robot.drive.name().into(),
        };
        let (table, name) = match key.split_once('.') {
            Some((section, name)) => (document.entry(section).or_insert_with(toml_edit::table), name),
            None => (document.as_item_mut(), *key),
        };
        // A comment behind the old value stays behind the new one.
        match table.get_mut(name).and_then(toml_edit::Item::as_value_mut) {
            Some(there) => {
                let decor = there.decor().clone();
                *there = value;
                *there.decor_mut() = decor;
            }
            None => table[name] = toml_edit::value(value),
        }
    }
    Ok(document.to_string())
}

/// The robot as JSON, with the keys and sections of a robot file.
pub(crate) fn to_json(robot: &Robot) -> serde_json::Value {
    let mut copy = *robot;
    let mut json = serde_json::json!({});
    for (key, slot) in &KEYS {
        let value: serde_json::Value = match slot {
            Slot::Number(field) => (*field(&mut copy)).into(),
            Slot::Count(field) => (*field(&mut copy)).into(),
            Slot::Flag(field) => (*field(&mut copy)).into(),
            Slot::Drive => copy.drive.name().into(),
        };
        match key.split_once('.') {
            Some((section, name)) => json[section][name] = value,
            None => json[*key] = value,
        }
    }
    json
}

/// The robot of such JSON; keys that it does not name keep their defaults.
pub(crate) fn from_json(json: &serde_json::Value) -> Result<Robot, Error> {
    // TOML holds all that a robot is; a run's robot is read by the one reader of robots.
    let toml = toml::to_string(json).map_err(|error| Error::file(format!("robot: {error}")))?;
    read(toml.as_bytes()).map_err(|error| match error {
        Error::BadFormat { reason, .. } => Error::file(format!("robot: {reason}")),
        other => other,
    })
}

fn read_table(text: &str, section: &str, table: &DeTable<'_>, robot: &mut Robot) -> Result<(), Error> {
    // In the order of the file, so that the first mistake is the one that is told.
    let mut entries: Vec<_> = table.iter().collect();
    entries.sort_by_key(|(key, _)| key.span().start);
    for (key, value) in entries {
        let path = format!("{section}{}", key.get_ref());
        let is_section =
            section.is_empty() && KEYS.iter().any(|(known, _)| known.starts_with(&format!("{path}.")));
        match (KEYS.iter().find(|(known, _)| *known == path), value.get_ref()) {
            (Some((name, slot)), value_read) => {
                set(slot, value_read, robot).map_err(|expected| {
                    let found = quoted(text.get(value.span()).unwrap_or_default());
                    at(text, value.span(), format!("{name} is {found}; it must be {expected}"))
                })?;
                let checked = robot.checked();
                checked.map_err(|error| at(text, value.span(), error.to_string()))?;
            }
            (None, DeValue::Table(inner)) if is_section => {
                read_table(text, &format!("{path}."), inner, robot)?;
            }
            (None, _) if is_section => {
                return Err(at(text, value.span(), format!("{path} must be a section: [{path}]")));
            }
            (None, _) => {
                let is_table = matches!(value.get_ref(), DeValue::Table(_));
                let (kind, known) =
                    if is_table { ("section", nearest_section(&path)) } else { ("key", nearest(&path)) };
                let reason = format!("unknown {kind} {}; did you mean {known}?", quoted(&path));
                return Err(at(text, key.span(), reason));
            }
        }
    }
    Ok(())
}

/// What a count must be, before its range is looked at.
const COUNT: &str = "a whole number from 0 to 4294967295";

/// Puts the value where it belongs, or says what it should be.
fn set(slot: &Slot, value: &DeValue<'_>, robot: &mut Robot) -> Result<(), &'static str> {
    match (slot, value) {
        (Slot::Number(field), DeValue::Float(number)) => {
            *field(robot) = number.as_str().parse().map_err(|_| "a number")?;
        }
        (Slot::Number(field), DeValue::Integer(number)) => {
            *field(robot) = match number.radix() {
                10 => number.as_str().parse().map_err(|_| "a number")?,
                radix => i64::from_str_radix(number.as_str(), radix).map_err(|_| "a number")? as f64,
            };
        }
        (Slot::Count(field), DeValue::Integer(number)) => {
            let count = u32::from_str_radix(number.as_str(), number.radix());
            *field(robot) = count.map_err(|_| COUNT)?;
        }
        (Slot::Flag(field), DeValue::Boolean(flag)) => *field(robot) = *flag,
        (Slot::Drive, DeValue::String(name)) => {
            let known = [Drive::Steered, Drive::Differential].into_iter().find(|drive| drive.name() == name);
            robot.drive = known.ok_or("\"steered\" or \"differential\"")?;
        }
        (Slot::Number(_), _) => return Err("a number"),
        (Slot::Count(_), _) => return Err(COUNT),
        (Slot::Flag(_), _) => return Err("true or false"),
        (Slot::Drive, _) => return Err("\"steered\" or \"differential\""),
    }
    Ok(())
}

/// The known key that is most like this one; a key in the wrong section is told by its section.
fn nearest(path: &str) -> String {
    let own_name = |path: &str| path.rsplit('.').next().unwrap_or_default().to_owned();
    let likeness = |known: &str| {
        let names = strsim::jaro_winkler(&own_name(known), &own_name(path));
        let paths = strsim::jaro_winkler(known, path);
        names + 0.1 * paths
    };
    let best = KEYS.iter().map(|(known, _)| *known).max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
    match best.unwrap_or_default().split_once('.') {
        Some((section, name)) => format!("`{name}` in [{section}]"),
        None => format!("`{}`", best.unwrap_or_default()),
    }
}

/// The known section that is most like this one.
fn nearest_section(path: &str) -> String {
    let sections = KEYS.iter().filter_map(|(known, _)| Some(known.split_once('.')?.0));
    let likeness = |section: &str| strsim::jaro_winkler(section, path);
    let best = sections.max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
    format!("[{}]", best.unwrap_or_default())
}

fn at(text: &str, span: Range<usize>, reason: String) -> Error {
    let before = text.get(..span.start).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |end| end + 1);
    Error::at(before.matches('\n').count() + 1, before[line_start..].chars().count() + 1, reason)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_empty_file_is_the_default_robot() {
        assert_eq!(read(b"").unwrap(), Robot::default());
    }

    #[test]
    fn what_is_written_is_read_again() {
        let mut robot = Robot { drive: Drive::Steered, can_reverse: false, ..Robot::default() };
        robot.wheel_perimeter_m = 0.263_000_123_4;
        robot.errors.track_rel = 1.0 / 3.0 / 7.0;
        robot.sensors.beams = 5;
        for text in [
            "",
            "track_m = 0.5\n[errors] # here\nturn_rad = 1\n\n[power]\nidle_w = 3\n",
            "errors = { track_rel = 0.1 }",
        ] {
            let written = update(text, &robot).unwrap();
            let back = read(written.as_bytes()).unwrap();
            assert!((back.errors.track_rel / robot.errors.track_rel - 1.0).abs() < 1e-6, "{written}");
            assert!((back.wheel_perimeter_m - 0.263_000_1).abs() < 1e-12);
            let same = Robot { wheel_perimeter_m: robot.wheel_perimeter_m, errors: robot.errors, ..back };
            assert_eq!(same, robot, "{written}");
        }
        assert_eq!(update("", &Robot::default()).unwrap(), "");
        assert!(update("[", &robot).is_err());
    }

    #[test]
    fn every_key_is_read_into_its_own_place() {
        // Each key alone changes the robot, and no two change it alike.
        let mut robots = Vec::new();
        for (key, slot) in &KEYS {
            let value = match slot {
                Slot::Number(_) if *key != "ticks_per_rev" => "0.25",
                Slot::Number(_) | Slot::Count(_) => "7",
                Slot::Flag(_) => "false",
                Slot::Drive => "\"steered\"",
            };
            let text = match key.split_once('.') {
                Some((section, name)) => format!("[{section}]\n{name} = {value}\n"),
                None => format!("{key} = {value}\n"),
            };
            let robot = read(text.as_bytes()).unwrap();
            assert_ne!(robot, Robot::default(), "{key}");
            assert!(!robots.contains(&robot), "{key}");
            robots.push(robot);
        }
    }

    #[test]
    fn mistakes_are_told_by_place_and_nearest_key() {
        let error = |text: &str| read(text.as_bytes()).unwrap_err().to_string();
        let cases = [
            ("track_m = -1", "line 1, column 11: track_m is -1; it must be between 0.000001 and 1000000"),
            ("\nradius_m = nan", "line 2, column 12: radius_m is NaN; it must be between 0 and 1000000"),
            ("track_m = \"0.2\"", "line 1, column 11: track_m is `\"0.2\"`; it must be a number"),
            (
                "drive = \"tank\"",
                "line 1, column 9: drive is `\"tank\"`; it must be \"steered\" or \"differential\"",
            ),
            (
                "sensors.beams = -1",
                "line 1, column 17: sensors.beams is `-1`; it must be a whole number from 0 to 4294967295",
            ),
            (
                "track_m = 1e300",
                "line 1, column 11: track_m is 1e300; it must be between 0.000001 and 1000000",
            ),
            ("[error]\nturn_rad = 1", "line 1, column 2: unknown section `error`; did you mean [errors]?"),
            (
                "turn_rad = 0.1",
                "line 1, column 1: unknown key `turn_rad`; did you mean `turn_rad` in [errors]?",
            ),
            (
                "[errors]\nwheel_perimeter = 0.1",
                "line 2, column 1: unknown key `errors.wheel_perimeter`; did you mean `wheel_perimeter_rel` in [errors]?",
            ),
            ("errors = 3", "line 1, column 10: errors must be a section: [errors]"),
        ];
        for (text, expected) in cases {
            assert_eq!(error(text), expected);
        }
        for text in ["[", "a = ", "track_m = 1\ntrack_m = 2", "\u{0}"] {
            let message = error(text);
            assert!(message.contains("not TOML") && !message.contains('\n'), "{message}");
        }
    }
}
