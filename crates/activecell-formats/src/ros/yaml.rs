//! The small part of YAML that a map needs: one mapping of names to scalars or to lists of scalars.
//!
//! It is read event by event, so that nothing is ever expanded: anchors, aliases and nesting are refused.

use crate::error::{Error, line_and_column, quoted};
use saphyr_parser::{Event, Marker, Parser, StrInput};
use std::collections::BTreeMap;

/// The longest YAML file that is read; real ones have some hundred bytes.
pub(super) const MAX_BYTES: u64 = 64 << 10;

/// A line and a column, from 1.
type At = (usize, usize);

/// A scalar and where it stands.
#[derive(Debug)]
pub(super) struct Scalar {
    pub(super) text: String,
    at: At,
}

impl Scalar {
    pub(super) fn error(&self, reason: impl Into<String>) -> Error {
        Error::at(self.at.0, self.at.1, reason)
    }

    /// The scalar as a finite number.
    pub(super) fn number(&self, name: &str, hint: &str) -> Result<f64, Error> {
        let text = self.text.as_str();
        // YAML writes .nan and .inf, in any case.
        let digits = |c: char| c.is_ascii_digit();
        let plain =
            if text.contains(digits) { text.to_owned() } else { text.to_lowercase().replace('.', "") };
        match plain.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            Ok(value) => Err(self.error(format!("{name} is {value}; {hint}"))),
            Err(_) if text.is_empty() => Err(self.error(format!("{name} is empty; {hint}"))),
            Err(_) => Err(self.error(format!("{name} is {}, not a number; {hint}", quoted(text)))),
        }
    }
}

/// The value of a key.
#[derive(Debug)]
pub(super) enum Value {
    Scalar(Scalar),
    List(Vec<Scalar>),
}

/// A key's line, its value, and where the value stands.
#[derive(Debug)]
pub(super) struct Entry {
    line: usize,
    at: At,
    value: Value,
}

impl Entry {
    pub(super) fn error(&self, reason: impl Into<String>) -> Error {
        Error::at(self.at.0, self.at.1, reason)
    }

    pub(super) fn scalar(&self, name: &str, hint: &str) -> Result<&Scalar, Error> {
        match &self.value {
            Value::Scalar(scalar) => Ok(scalar),
            Value::List(_) => Err(self.error(format!("{name} is a list; {hint}"))),
        }
    }

    pub(super) fn list(&self, name: &str, hint: &str) -> Result<&[Scalar], Error> {
        match &self.value {
            Value::List(list) => Ok(list),
            Value::Scalar(scalar) => {
                Err(self.error(format!("{name} is {}, not a list; {hint}", quoted(&scalar.text))))
            }
        }
    }
}

/// Reads the whole file.
pub(super) fn read(bytes: &[u8]) -> Result<BTreeMap<String, Entry>, Error> {
    if bytes.len() as u64 > MAX_BYTES {
        let advice = "a map's YAML has some hundred bytes; is this the right file?";
        return Err(Error::TooLarge { limit: MAX_BYTES, advice });
    }
    let mut events = Events { parser: Parser::new_from_str(text(bytes)?) };
    let mut entries: BTreeMap<String, Entry> = BTreeMap::new();
    loop {
        match events.next()? {
            (Event::StreamStart | Event::DocumentStart(_), _) => {}
            (Event::MappingStart(..), _) => break,
            (Event::StreamEnd, _) => {
                return Err(Error::file(
                    "the YAML is empty; a map needs image, resolution, origin and thresholds",
                ));
            }
            (_, (line, column)) => {
                return Err(Error::at(
                    line,
                    column,
                    "expected lines of the form `key: value`, such as `image: map.pgm`",
                ));
            }
        }
    }
    loop {
        let (key, line, column) = match events.next()? {
            (Event::Scalar(key, ..), (line, column)) => (key.into_owned(), line, column),
            (Event::MappingEnd, _) => break,
            (_, (line, column)) => return Err(Error::at(line, column, "a key must be a plain word")),
        };
        if let Some(first) = entries.get(&key) {
            let reason =
                format!("the key {} stands in line {} already; remove one", quoted(&key), first.line);
            return Err(Error::at(line, column, reason));
        }
        let (at, value) = value(&mut events)?;
        entries.insert(key, Entry { line, at, value });
    }
    loop {
        match events.next()? {
            (Event::StreamEnd, _) => return Ok(entries),
            (Event::DocumentEnd, _) => {}
            (_, (line, column)) => {
                return Err(Error::at(line, column, "a second document begins here; a map has one"));
            }
        }
    }
}

fn value(events: &mut Events) -> Result<(At, Value), Error> {
    let nested =
        |(line, column): At| Error::at(line, column, "nested values are not allowed; a map has none");
    match events.next()? {
        (Event::Scalar(text, ..), at) => Ok((at, Value::Scalar(Scalar { text: text.into_owned(), at }))),
        (Event::SequenceStart(..), at) => {
            let mut list = Vec::new();
            loop {
                match events.next()? {
                    (Event::Scalar(text, ..), at) => list.push(Scalar { text: text.into_owned(), at }),
                    (Event::SequenceEnd, _) => return Ok((at, Value::List(list))),
                    (_, at) => return Err(nested(at)),
                }
            }
        }
        (_, at) => Err(nested(at)),
    }
}

/// The events of the parser, with places, without anchors and aliases.
struct Events<'a> {
    parser: Parser<'a, StrInput<'a>>,
}

impl<'a> Events<'a> {
    fn next(&mut self) -> Result<(Event<'a>, At), Error> {
        let place = |mark: &Marker| (mark.line(), mark.col() + 1);
        match self.parser.next_event() {
            None => Ok((Event::StreamEnd, (1, 1))),
            Some(Err(error)) => {
                let (line, column) = place(error.marker());
                let reason = format!("not well-formed YAML ({}); write `key: value` lines", error.info());
                Err(Error::at(line, column, reason.replace(char::is_control, " ")))
            }
            Some(Ok((event, span))) => {
                let (line, column) = place(&span.start);
                let anchored = match &event {
                    Event::Alias(_) => true,
                    Event::Scalar(_, _, id, _) | Event::SequenceStart(id, _) | Event::MappingStart(id, _) => {
                        *id > 0
                    }
                    _ => false,
                };
                if anchored {
                    let reason = "anchors (&) and aliases (*) are not allowed; write the value itself";
                    return Err(Error::at(line, column, reason));
                }
                Ok((event, (line, column)))
            }
        }
    }
}

/// The bytes as text without control characters; the parser would take a zero byte for the end.
fn text(bytes: &[u8]) -> Result<&str, Error> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let valid = match std::str::from_utf8(bytes) {
        Ok(text) => text,
        Err(error) => std::str::from_utf8(&bytes[..error.valid_up_to()]).unwrap_or_default(),
    };
    let control = |c: char| c.is_control() && !matches!(c, '\t' | '\n' | '\r' | '\u{85}');
    let bad = valid.find(control).or_else(|| (valid.len() < bytes.len()).then_some(valid.len()));
    match bad {
        None => Ok(valid),
        Some(index) => {
            let (line, column) = line_and_column(bytes, index);
            Err(Error::at(
                line,
                column,
                format!("the byte {:#04x} is not text; is this a YAML file?", bytes[index]),
            ))
        }
    }
}
