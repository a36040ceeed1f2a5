//! The one error type of the crate: one line that says where, what is wrong, and what to do.

use std::fmt;
use std::path::{Path, PathBuf};

/// Where in a file something is wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Place {
    /// The file as a whole.
    #[default]
    File,
    /// A line, counted from 1.
    Line(usize),
    /// A line and a column, both counted from 1.
    At {
        /// The line.
        line: usize,
        /// The column, in characters.
        column: usize,
    },
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File => Ok(()),
            Self::Line(line) => write!(f, "line {line}"),
            Self::At { line, column } => write!(f, "line {line}, column {column}"),
        }
    }
}

/// Why a file could not be read or written. Every message is a single line.
///
/// ```
/// use activecell_formats::movingai;
/// let error = movingai::read_map(b"type octile\nheight 1\nwidth 3\nmap\n.?.\n").unwrap_err();
/// assert_eq!(error.to_string(), "line 5, column 2: unexpected character `?`; use `.` `G` `S` `E` for free, `@` `O` `T` `W` for an obstacle");
/// ```
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The core refused the map: too large, empty, or a number out of range.
    #[error(transparent)]
    Core(activecell::Error),
    /// The bytes are not what the format asks for.
    #[error("{}{reason}", Separated(*place))]
    BadFormat {
        /// Where.
        place: Place,
        /// What is wrong there and what would be right.
        reason: String,
    },
    /// The file is longer than its kind may be.
    #[error("the file has more than {limit} bytes; {advice}")]
    TooLarge {
        /// The most bytes that are read.
        limit: u64,
        /// What to do.
        advice: &'static str,
    },
    /// The operating system refused.
    #[error("{}", io_message(path, action, cause))]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What was tried: `read`, `write`, `make`.
        action: &'static str,
        /// What the system said.
        cause: std::io::Error,
    },
    /// The file's ending names no format that is known here.
    #[error(
        "{}: the ending names no map format; use .yaml (ROS map_server), .map (MovingAI), .png, .pgm or .txt",
        shown(path)
    )]
    UnknownFormat {
        /// The file.
        path: PathBuf,
    },
    /// Another error, with the file in which it was found.
    #[error("{}{}{cause}", shown(path), if cause.place() == Place::File { ": " } else { " " })]
    InFile {
        /// The file.
        path: PathBuf,
        /// What is wrong in it.
        cause: Box<Error>,
    },
}

impl Error {
    /// An error about the file as a whole.
    pub(crate) fn file(reason: impl Into<String>) -> Self {
        Self::BadFormat { place: Place::File, reason: reason.into() }
    }

    /// An error in a line, counted from 1.
    pub(crate) fn line(line: usize, reason: impl Into<String>) -> Self {
        Self::BadFormat { place: Place::Line(line), reason: reason.into() }
    }

    /// An error at a line and a column, both counted from 1.
    pub(crate) fn at(line: usize, column: usize, reason: impl Into<String>) -> Self {
        Self::BadFormat { place: Place::At { line, column }, reason: reason.into() }
    }

    /// The same error with the file named, unless it names one already.
    #[must_use]
    pub fn in_file(self, path: &Path) -> Self {
        match self {
            named @ (Self::Io { .. } | Self::UnknownFormat { .. } | Self::InFile { .. }) => named,
            other => Self::InFile { path: path.to_owned(), cause: Box::new(other) },
        }
    }

    /// Where in its file the error lies.
    pub fn place(&self) -> Place {
        match self {
            Self::BadFormat { place, .. } => *place,
            Self::InFile { cause, .. } => cause.place(),
            _ => Place::File,
        }
    }
}

impl From<activecell::Error> for Error {
    /// A place in a text map becomes a place in the file.
    fn from(error: activecell::Error) -> Self {
        match error {
            activecell::Error::BadFormat { line, column, reason } => Self::at(line, column, reason),
            other => Self::Core(other),
        }
    }
}

/// A place followed by a colon, or nothing.
struct Separated(Place);

impl fmt::Display for Separated {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0 == Place::File { Ok(()) } else { write!(f, "{}: ", self.0) }
    }
}

/// The most characters of the input that a message repeats.
const QUOTED_CHARS: usize = 40;

/// Line and column, from 1, of a byte in a text.
pub(crate) fn line_and_column(bytes: &[u8], index: usize) -> (usize, usize) {
    let before = &bytes[..index];
    let lines = before.split(|&b| b == b'\n');
    let last = lines.clone().next_back().unwrap_or_default();
    (lines.count(), String::from_utf8_lossy(last).chars().count() + 1)
}

/// Input as a message may show it: in backquotes, on one line, cut where it is long.
pub(crate) fn quoted(text: &str) -> String {
    let cut: String = text.chars().take(QUOTED_CHARS).collect();
    let rest = if text.chars().nth(QUOTED_CHARS).is_some() { "…" } else { "" };
    format!("`{}{rest}`", escaped(&cut))
}

/// As [`quoted`], for bytes that may not be text.
pub(crate) fn quoted_bytes(bytes: &[u8]) -> String {
    // Four bytes make a character at most; a cut character at the end is beyond what is shown.
    quoted(&String::from_utf8_lossy(&bytes[..bytes.len().min(4 * QUOTED_CHARS + 4)]))
}

/// A path as a message may show it.
pub(crate) fn shown(path: &Path) -> String {
    escaped(&path.to_string_lossy())
}

/// Characters that would break the line, or turn the text around, are written as escapes.
fn escaped(text: &str) -> String {
    let disturbs = |c: char| {
        c.is_control()
            || matches!(c, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    };
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        if disturbs(c) { out.extend(c.escape_default()) } else { out.push(c) }
    }
    out
}

fn io_message(path: &Path, action: &str, cause: &std::io::Error) -> String {
    use std::io::ErrorKind as Kind;
    let path = shown(path);
    match cause.kind() {
        Kind::NotFound if action == "read" => format!("{path}: there is no such file; check the path"),
        Kind::NotFound => format!("{path}: its folder does not exist; make the folder first"),
        Kind::IsADirectory => format!("{path}: this is a folder; name a file"),
        Kind::AlreadyExists => format!("{path}: this is a file where a folder must be; move it away"),
        Kind::PermissionDenied => format!("{path}: no permission to {action} it; change its permissions"),
        Kind::StorageFull => format!("{path}: the disk is full; make room and try again"),
        _ => format!("{path}: cannot {action} it: {}", escaped(&cause.to_string())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_is_one_line_with_its_place() {
        let path = Path::new("maps/office.yaml");
        let reason = "resolution is NaN; give metres per pixel, for example 0.05";
        for (error, expected) in [
            (Error::at(3, 13, reason), format!("maps/office.yaml line 3, column 13: {reason}")),
            (Error::line(3, reason), format!("maps/office.yaml line 3: {reason}")),
            (Error::file(reason), format!("maps/office.yaml: {reason}")),
            (Error::at(3, 13, reason).in_file(path), format!("maps/office.yaml line 3, column 13: {reason}")),
        ] {
            assert_eq!(error.in_file(path).to_string(), expected);
        }
        let core = activecell::Error::BadFormat { line: 2, column: 5, reason: "x".into() };
        assert_eq!(Error::from(core).in_file(path).to_string(), "maps/office.yaml line 2, column 5: x");
    }

    #[test]
    fn input_is_shown_on_one_line_and_cut() {
        assert_eq!(quoted("a\nb\u{1b}[31m\u{202e}é"), "`a\\nb\\u{1b}[31m\\u{202e}é`");
        assert_eq!(quoted(&"x".repeat(41)), format!("`{}…`", "x".repeat(40)));
        assert_eq!(quoted(&"x".repeat(40)), format!("`{}`", "x".repeat(40)));
        assert_eq!(quoted_bytes(b"\xff"), "`\u{fffd}`");
        assert_eq!(shown(Path::new("a\nb")), "a\\nb");
    }
}
