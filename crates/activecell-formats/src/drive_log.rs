//! Encoder logs with ground truth: CSV with named columns, and the runs of the `OptiOdom` data set.

use crate::error::{Error, quoted_bytes};
use activecell::{DriveLog, LogRow, Pose, Robot};
use csv::{ByteRecord, ReaderBuilder};
use std::fmt::Write as _;

/// The longest log that is read, in bytes.
pub const MAX_LOG_BYTES: u64 = 32 << 20;
/// The most rows of a log: half a day at 20 rows a second.
pub const MAX_ROWS: usize = 1_000_000;
/// The longest metadata file that is read.
pub const MAX_METADATA_BYTES: u64 = 64 << 10;

/// The columns of a log that names them, in any order; others are passed over.
pub const COLUMNS: [&str; 6] = ["time_s", "x_m", "y_m", "bearing_rad", "left_ticks", "right_ticks"];
/// The columns of an `OptiOdom` run, which has no header.
const OPTIODOM: [usize; 6] = [0, 1, 2, 3, 5, 4];

/// Reads an encoder log.
///
/// With a header line that names the [`COLUMNS`]: ticks are those since the row before; x, y and the bearing
/// (counter-clockwise from x) may be empty where the truth was not measured. Without a header: six columns as in the
/// `OptiOdom` data set (Sousa, Petry, Costa, Moreira, 2020): time, x, y, bearing, right ticks, left ticks.
///
/// # Errors
/// [`Error::BadFormat`] with line and column.
///
/// ```
/// use activecell_formats::drive_log;
/// let text = "time_s,x_m,y_m,bearing_rad,left_ticks,right_ticks\n0,0,0,0,0,0\n1,,,,90,91\n2,1.5,0,0,80,79\n";
/// let log = drive_log::read(text.as_bytes())?;
/// assert_eq!((log.rows()[1].ticks, log.end().at_m), ([90, 91], [1.5, 0.0]));
/// let error = drive_log::read(b"0,0,0,0,0,0\n1,0,nan,0,9,9\n").unwrap_err();
/// assert_eq!(error.to_string(), "line 2, column 5: y_m is `nan`; give a number");
/// # Ok::<(), activecell_formats::Error>(())
/// ```
pub fn read(bytes: &[u8]) -> Result<DriveLog, Error> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut reader = ReaderBuilder::new().has_headers(false).flexible(true).from_reader(bytes);
    let mut record = ByteRecord::new();
    let mut columns: Option<([usize; 6], usize)> = None;
    let (mut rows, mut lines) = (Vec::new(), Vec::new());
    while next(&mut reader, &mut record)? {
        let line = line_of(&record);
        if record.iter().all(|field| field.trim_ascii().is_empty()) {
            continue;
        }
        let Some((places, width)) = columns else {
            let named = named_columns(&record)?;
            columns = Some((named.unwrap_or(OPTIODOM), record.len()));
            if named.is_none() {
                if record.len() != OPTIODOM.len() {
                    let names = COLUMNS.join(",");
                    let reason =
                        format!("{} columns and no header; begin the file with {names}", record.len());
                    return Err(Error::line(line, reason));
                }
                rows.push(row(&record, &OPTIODOM)?);
                lines.push(line);
            }
            continue;
        };
        if record.len() != width {
            let reason = format!("the row has {} columns, the first line {width}", record.len());
            return Err(Error::line(line, format!("{reason}; make them agree")));
        }
        if rows.len() == MAX_ROWS {
            return Err(Error::line(line, format!("more than {MAX_ROWS} rows; split the log")));
        }
        rows.push(row(&record, &places)?);
        lines.push(line);
    }
    DriveLog::new(rows).map_err(|error| match error {
        activecell::Error::BadLog { row: Some(row), reason } => Error::line(lines[row], reason),
        other => Error::file(other.to_string()),
    })
}

fn next(reader: &mut csv::Reader<&[u8]>, record: &mut ByteRecord) -> Result<bool, Error> {
    reader.read_byte_record(record).map_err(|error| Error::file(format!("not CSV: {error}")))
}

fn line_of(record: &ByteRecord) -> usize {
    record.position().map_or(1, |position| position.line() as usize)
}

/// Where the columns stand in a header; `None` if the line begins with a number, so is none.
fn named_columns(record: &ByteRecord) -> Result<Option<[usize; 6]>, Error> {
    if number(&record[0]).is_some() {
        return Ok(None);
    }
    let mut places = [0; 6];
    for (place, name) in places.iter_mut().zip(COLUMNS) {
        let mut found = record.iter().enumerate().filter(|(_, field)| field.trim_ascii() == name.as_bytes());
        let Some((at, _)) = found.next() else {
            let names = COLUMNS.join(",");
            let first = quoted_bytes(&record[0]);
            let reason = format!("no column {name} in the header that begins with {first}; name {names}");
            return Err(Error::line(line_of(record), reason));
        };
        if let Some((again, _)) = found.next() {
            return Err(at_field(record, again, &format!("the column {name} comes twice; remove one")));
        }
        *place = at;
    }
    Ok(Some(places))
}

fn row(record: &ByteRecord, places: &[usize; 6]) -> Result<LogRow, Error> {
    let is_empty = |which: usize| record[places[which]].trim_ascii().is_empty();
    let wrong = |which: usize, wanted: &str| {
        let (name, found) = (COLUMNS[which], quoted_bytes(&record[places[which]]));
        at_field(record, places[which], &format!("{name} is {found}; give {wanted}"))
    };
    let value = |which: usize| {
        number(&record[places[which]])
            .filter(|value| value.is_finite())
            .ok_or_else(|| wrong(which, "a number"))
    };
    let count = |which: usize| {
        // Some programs write whole numbers as 12.0 or 1.2e1.
        let value = number(&record[places[which]]).filter(|value| value.fract() == 0.0 && value.abs() < 1e15);
        value
            .map(|value| value as i64)
            .ok_or_else(|| wrong(which, "a whole number of ticks since the row before"))
    };
    let truth = if (1..=3).all(is_empty) {
        None
    } else if let Some(empty) = (1..=3).find(|&which| is_empty(which)) {
        return Err(wrong(empty, "x, y and bearing, or leave all three empty"));
    } else {
        Some(Pose { at_m: [value(1)?, value(2)?], bearing_rad: value(3)? })
    };
    Ok(LogRow { time_s: value(0)?, truth, ticks: [count(4)?, count(5)?] })
}

fn number(field: &[u8]) -> Option<f64> {
    std::str::from_utf8(field.trim_ascii()).ok()?.parse().ok()
}

/// An error in a field; its column is counted as if no field before it were quoted.
fn at_field(record: &ByteRecord, field: usize, reason: &str) -> Error {
    let before = record.iter().take(field).map(|field| String::from_utf8_lossy(field).chars().count() + 1);
    Error::at(line_of(record), 1 + before.sum::<usize>(), reason)
}

/// A log as CSV with named columns.
///
/// ```
/// # use activecell_formats::drive_log;
/// let text = "time_s,x_m,y_m,bearing_rad,left_ticks,right_ticks\n0,0,0,0,0,0\n1,,,,90,91\n2,1.5,0,0,80,79\n";
/// assert_eq!(drive_log::write(&drive_log::read(text.as_bytes())?), text);
/// # Ok::<(), activecell_formats::Error>(())
/// ```
pub fn write(log: &DriveLog) -> String {
    let mut text = COLUMNS.join(",") + "\n";
    for row in log.rows() {
        // Writing to a string cannot fail.
        let _ = match row.truth {
            Some(Pose { at_m: [x, y], bearing_rad }) => write!(text, "{},{x},{y},{bearing_rad}", row.time_s),
            None => write!(text, "{},,,", row.time_s),
        };
        let _ = writeln!(text, ",{},{}", row.ticks[0], row.ticks[1]);
    }
    text
}

/// The robot of an `OptiOdom` metadata file: gear × encoder resolution, distance and diameters of the wheels.
///
/// # Errors
/// [`Error::BadFormat`] if it names no differential robot.
///
/// ```
/// use activecell_formats::drive_log;
/// let robot = drive_log::read_metadata(b"type,diff,\nngear,43.7,\nencRes,64,\nLi,0.2,\nDi,0.084,0.084\n")?;
/// assert!((robot.ticks_per_rev - 2796.8).abs() < 1e-9 && robot.track_m == 0.2);
/// # Ok::<(), activecell_formats::Error>(())
/// ```
pub fn read_metadata(bytes: &[u8]) -> Result<Robot, Error> {
    let mut reader = ReaderBuilder::new().has_headers(false).flexible(true).from_reader(bytes);
    let mut record = ByteRecord::new();
    let (mut gear, mut resolution, mut track, mut diameters) = (None, None, None, None);
    while next(&mut reader, &mut record)? {
        let value = |field: usize| {
            let number = record.get(field).and_then(number).filter(|number| number.is_finite());
            number.ok_or_else(|| {
                at_field(&record, field, &format!("{} needs a number here", quoted_bytes(&record[0])))
            })
        };
        match &record[0] {
            b"type" if record.get(1) != Some(b"diff") => {
                return Err(Error::line(
                    line_of(&record),
                    "only the type `diff` (two driven wheels) is known",
                ));
            }
            b"ngear" => gear = Some(value(1)?),
            b"encRes" => resolution = Some(value(1)?),
            b"Li" => track = Some(value(1)?),
            b"Di" => diameters = Some([value(1)?, value(2)?]),
            _ => {}
        }
    }
    let (Some(gear), Some(resolution), Some(track_m), Some([first, second])) =
        (gear, resolution, track, diameters)
    else {
        return Err(Error::file("an OptiOdom metadata file names ngear, encRes, Li and Di; one is missing"));
    };
    // In the order of the ticks: the right wheel first.
    let mean = f64::midpoint(first, second);
    let robot = Robot {
        wheel_perimeter_m: std::f64::consts::PI * mean,
        wheel_difference_rel: (first - second) / mean,
        ticks_per_rev: gear * resolution,
        track_m,
        ..Robot::default()
    };
    Ok(robot.checked()?)
}
