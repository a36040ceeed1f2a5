//! Maps and scenarios of the `MovingAI` benchmarks (Sturtevant 2012).

use crate::error::{Error, quoted_bytes};
use crate::lines::Lines;
use activecell::{BitPlane, Cell, Lattice, Map};
use std::fmt::Write as _;

/// Reads a `.map`: squares of 1 m, row 0 on top.
///
/// `.` `G` `S` are free, and `E`, the stations of the League of Robot Runners; `@` `O` `T` `W` are obstacles.
/// The header is `type octile`, `height H`, `width W`, `map`; the type may be missing. Lines end in LF or CRLF,
/// the last may lack its end, blank lines may follow.
///
/// # Errors
/// [`Error::BadFormat`] with line and column; [`Error::Core`] if the map is too large or empty. The declared
/// size is compared with the bytes at hand before memory is taken.
///
/// ```
/// use activecell_formats::movingai;
/// let map = movingai::read_map(b"type octile\nheight 2\nwidth 3\nmap\n..@\nT..\n")?;
/// assert_eq!((map.width(), map.height(), map.free_cells()), (3, 2, 4));
/// # Ok::<(), activecell_formats::Error>(())
/// ```
pub fn read_map(bytes: &[u8]) -> Result<Map, Error> {
    let mut lines = Lines::new(bytes);
    let (width, height) = read_header(&mut lines)?;
    let present = lines.rest.len() as u64;
    // Each row ends in one byte at least, the last one perhaps not.
    let needed = width.saturating_add(1).saturating_mul(height).saturating_sub(1);
    if width > present || needed > present {
        return Err(Error::file(format!(
            "the header declares {width} columns × {height} rows, but the file has only {} bytes; correct the header or fetch the whole file",
            bytes.len()
        )));
    }
    let mut obstacles = BitPlane::new(width, height)?;
    for y in 0..obstacles.height() {
        let Some((line, row)) = lines.next() else {
            return Err(Error::file(format!(
                "the header declares {height} rows, but the map has {y}; correct the header or fetch the whole file"
            )));
        };
        read_row(line, row, y, &mut obstacles)?;
    }
    match lines.find(|(_, text)| !text.trim_ascii().is_empty()) {
        None => Ok(Map::new(Lattice::Square, obstacles)),
        Some((line, _)) => Err(Error::line(
            line,
            format!("text after the {height} rows that the header declares; correct `height` or remove it"),
        )),
    }
}

/// Reads the header up to `map`: columns and rows.
fn read_header(lines: &mut Lines) -> Result<(u64, u64), Error> {
    let (mut width, mut height) = (None, None);
    let mut last_line = 1;
    for (line, text) in lines.by_ref() {
        last_line = line;
        let mut words = text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        let Some(key) = words.next() else { continue };
        let value = words.next();
        if words.next().is_some() {
            return Err(Error::line(line, format!("{} has more than one value", quoted_bytes(key))));
        }
        match (key, value) {
            (b"type", Some(b"octile")) => {}
            (b"type", other) => {
                let found = quoted_bytes(other.unwrap_or_default());
                return Err(Error::line(line, format!("the map type is {found}; only `octile` is known")));
            }
            (b"width", value) => set_once(&mut width, "width", value, line)?,
            (b"height", value) => set_once(&mut height, "height", value, line)?,
            (b"map", None) => {
                return match (width, height) {
                    (Some(width), Some(height)) => Ok((width, height)),
                    (None, _) => Err(Error::line(line, "`map` before `width W`; state the columns first")),
                    _ => Err(Error::line(line, "`map` before `height H`; state the rows first")),
                };
            }
            _ => {
                let reason =
                    "is not a MovingAI header line; expected `type octile`, `height H`, `width W`, `map`";
                return Err(Error::line(line, format!("{} {reason}", quoted_bytes(text))));
            }
        }
    }
    Err(Error::line(
        last_line,
        "the file ends before the line `map`; it is not a MovingAI map, or it was cut",
    ))
}

fn set_once(slot: &mut Option<u64>, name: &str, value: Option<&[u8]>, line: usize) -> Result<(), Error> {
    let value = value.unwrap_or_default();
    let Some(number) = parse::<u64>(value) else {
        let found = quoted_bytes(value);
        return Err(Error::line(line, format!("{name} is {found}; give a whole number of cells")));
    };
    if slot.replace(number).is_some() {
        return Err(Error::line(line, format!("{name} is stated twice; remove one of the lines")));
    }
    Ok(())
}

fn read_row(line: usize, row: &[u8], y: u32, obstacles: &mut BitPlane) -> Result<(), Error> {
    let width = obstacles.width();
    for (x, &byte) in row.iter().enumerate() {
        let blocked = match byte {
            b'.' | b'G' | b'S' | b'E' => false,
            b'@' | b'O' | b'T' | b'W' => true,
            _ => {
                // All bytes before are ASCII, so the byte's number is the character's.
                let character = String::from_utf8_lossy(&row[x..row.len().min(x + 4)]);
                let found = crate::error::quoted(&character.chars().take(1).collect::<String>());
                let reason = format!(
                    "unexpected character {found}; use `.` `G` `S` `E` for free, `@` `O` `T` `W` for an obstacle"
                );
                return Err(Error::at(line, x + 1, reason));
            }
        };
        if blocked && (x as u64) < u64::from(width) {
            obstacles.set(x as u32, y, true);
        }
    }
    if row.len() != width as usize {
        let reason = format!("the row has {} cells, the header declares {width} columns", row.len());
        return Err(Error::line(line, format!("{reason}; make them agree")));
    }
    Ok(())
}

/// The map as a `.map` file: `.` free, `@` obstacle. The frame, the lattice and the names are not written.
///
/// ```
/// use activecell::{Lattice, Map};
/// let map = Map::parse(Lattice::Square, "..#")?;
/// let text = activecell_formats::movingai::write_map(&map);
/// assert_eq!(text, "type octile\nheight 1\nwidth 3\nmap\n..@\n");
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn write_map(map: &Map) -> String {
    let (width, height) = (map.width(), map.height());
    let mut text = format!("type octile\nheight {height}\nwidth {width}\nmap\n");
    text.reserve((width as usize + 1) * height as usize);
    for y in 0..height {
        text.extend((0..width).map(|x| if map.obstacles().get(x, y) { '@' } else { '.' }));
        text.push('\n');
    }
    text
}

/// One task of a scenario: a line of a `.scen` file.
#[derive(Debug, Clone, PartialEq)]
pub struct Task {
    /// The line in the file, from 1.
    pub line: usize,
    /// The benchmark's group of about equally long tasks.
    pub bucket: u32,
    /// The map's file name as the scenario states it.
    pub map: String,
    /// Columns of the map as the scenario states them; 0 where it does not say.
    pub width: u32,
    /// Rows of the map as the scenario states them; 0 where it does not say.
    pub height: u32,
    /// The start.
    pub from: Cell,
    /// The target.
    pub to: Cell,
    /// The published length of the shortest path with eight directions, in cells; often 0 where unknown.
    pub expected: f64,
}

const FIELDS: [&str; 9] = [
    "bucket",
    "map",
    "map width",
    "map height",
    "start x",
    "start y",
    "target x",
    "target y",
    "expected length",
];

/// Reads a `.scen` file.
///
/// Fields are separated by tabs, so that map names may contain blanks, or else by blanks. The line `version 1`
/// may be missing, empty lines are skipped, lines end in LF or CRLF. Whether the cells lie on the map, and
/// whether the stated size is the map's, is for the caller to see.
///
/// # Errors
/// [`Error::BadFormat`] with the line and the field.
///
/// ```
/// use activecell::Cell;
/// let tasks = activecell_formats::movingai::read_scen(b"version 1\n0\tarena.map\t49\t49\t1\t11\t2\t13\t2.41421356\n")?;
/// assert_eq!((tasks[0].line, tasks[0].from, tasks[0].to), (2, Cell::new(1, 11), Cell::new(2, 13)));
/// # Ok::<(), activecell_formats::Error>(())
/// ```
pub fn read_scen(bytes: &[u8]) -> Result<Vec<Task>, Error> {
    let mut tasks = Vec::new();
    let mut first = true;
    for (line, text) in Lines::new(bytes) {
        let text = text.trim_ascii();
        if text.is_empty() {
            continue;
        }
        let header = std::mem::take(&mut first).then(|| text.strip_prefix(b"version")).flatten();
        match header.map(<[u8]>::trim_ascii) {
            None => tasks.push(read_task(line, text)?),
            Some(b"1" | b"1.0") => {}
            Some(other) => {
                let found = quoted_bytes(other);
                return Err(Error::line(line, format!("the scenario's version is {found}; only 1 is known")));
            }
        }
    }
    Ok(tasks)
}

fn read_task(line: usize, text: &[u8]) -> Result<Task, Error> {
    let by_tabs: Vec<&[u8]> = text.split(|&b| b == b'\t').map(<[u8]>::trim_ascii).take(10).collect();
    let words = || text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).take(10);
    let fields = if by_tabs.len() == FIELDS.len() { by_tabs } else { words().collect() };
    if fields.len() != FIELDS.len() {
        let count = if fields.len() > 9 { "more".into() } else { fields.len().to_string() };
        let reason =
            format!("expected 9 fields separated by tabs, found {count}: bucket, map, its width and height");
        return Err(Error::line(line, format!("{reason}, start x y, target x y, expected length")));
    }
    let bad = |index: usize, wanted: &str| {
        let found = quoted_bytes(fields[index]);
        Error::line(line, format!("{} is {found}; give {wanted}", FIELDS[index]))
    };
    let whole = |index: usize| parse::<u32>(fields[index]).ok_or_else(|| bad(index, "a whole number from 0"));
    let cell = |index: usize| {
        let coordinate = |i| parse::<i32>(fields[i]).filter(|&v| v >= 0);
        let at = |i| coordinate(i).ok_or_else(|| bad(i, "a whole number from 0"));
        Ok::<_, Error>(Cell::new(at(index)?, at(index + 1)?))
    };
    let length = |index: usize| parse::<f64>(fields[index]).filter(|v| v.is_finite());
    Ok(Task {
        line,
        bucket: whole(0)?,
        map: String::from_utf8_lossy(fields[1]).into_owned(),
        width: whole(2)?,
        height: whole(3)?,
        from: cell(4)?,
        to: cell(6)?,
        expected: length(8).ok_or_else(|| bad(8, "a number of cells"))?,
    })
}

/// The tasks as a `.scen` file, separated by tabs, lengths in as many digits as they need.
///
/// Control characters in map names become blanks; they would break the line.
///
/// ```
/// use activecell_formats::movingai;
/// let text = "version 1\n0\tarena.map\t49\t49\t1\t11\t2\t13\t2.41421356\n";
/// assert_eq!(movingai::write_scen(&movingai::read_scen(text.as_bytes())?), text);
/// # Ok::<(), activecell_formats::Error>(())
/// ```
pub fn write_scen(tasks: &[Task]) -> String {
    let mut text = String::from("version 1\n");
    for task in tasks {
        let map = task.map.replace(char::is_control, " ");
        let Task { bucket, width, height, from, to, expected, .. } = task;
        let ends = format!("{}\t{}\t{}\t{}", from.x, from.y, to.x, to.y);
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{bucket}\t{map}\t{width}\t{height}\t{ends}\t{expected}");
    }
    text
}

fn parse<T: std::str::FromStr>(bytes: &[u8]) -> Option<T> {
    std::str::from_utf8(bytes).ok()?.parse().ok()
}
