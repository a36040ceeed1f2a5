//! A line of text, read from left to right.

use crate::error::{Error, quoted_bytes};
use activecell::Cell;

/// No coordinate of a plan file is larger: sums of coordinates and steps stay far from overflow.
pub(super) const MAX_COORDINATE: u32 = 1 << 30;

/// What is left of a line.
pub(super) struct Scan<'a> {
    line: usize,
    text: &'a [u8],
    at: usize,
}

impl<'a> Scan<'a> {
    /// A line, with its number from 1. `at` is the byte to begin with.
    pub(super) const fn new(line: usize, text: &'a [u8], at: usize) -> Self {
        Self { line, text, at }
    }

    /// The next byte that is no blank.
    pub(super) fn peek(&mut self) -> Option<u8> {
        while self.text.get(self.at).is_some_and(u8::is_ascii_whitespace) {
            self.at += 1;
        }
        self.text.get(self.at).copied()
    }

    /// Whether nothing but blanks is left.
    pub(super) fn is_done(&mut self) -> bool {
        self.peek().is_none()
    }

    /// Passes a byte if it is next.
    pub(super) fn take(&mut self, byte: u8) -> bool {
        let is_next = self.peek() == Some(byte);
        self.at += usize::from(is_next);
        is_next
    }

    /// Passes a byte that must be next.
    pub(super) fn expect(&mut self, byte: u8) -> Result<(), Error> {
        if self.take(byte) { Ok(()) } else { Err(self.wanted(&format!("`{}`", char::from(byte)))) }
    }

    /// Passes `->` if it is next.
    pub(super) fn take_arrow(&mut self) -> bool {
        let is_next = self.peek() == Some(b'-') && self.text.get(self.at + 1) == Some(&b'>');
        self.at += if is_next { 2 } else { 0 };
        is_next
    }

    /// A whole number.
    pub(super) fn number(&mut self) -> Result<i32, Error> {
        let minus = self.take(b'-');
        let digits = self.text[self.at.min(self.text.len())..].iter().take_while(|b| b.is_ascii_digit());
        let (mut value, mut length) = (0u32, 0);
        for digit in digits {
            value = value.saturating_mul(10).saturating_add(u32::from(digit - b'0'));
            length += 1;
        }
        if length == 0 {
            return Err(self.wanted("a whole number"));
        }
        if value > MAX_COORDINATE {
            return Err(self.error(format!("a number above {MAX_COORDINATE}; no cell is so far off")));
        }
        self.at += length;
        Ok(if minus { -(value as i32) } else { value as i32 })
    }

    /// Two numbers in parentheses; a word after a third comma is the direction that a robot faces, and is passed over.
    pub(super) fn pair(&mut self) -> Result<[i32; 2], Error> {
        self.expect(b'(')?;
        let first = self.number()?;
        self.expect(b',')?;
        let second = self.number()?;
        if self.take(b',') {
            self.peek();
            let word = self.text[self.at..].iter().take_while(|b| b.is_ascii_alphabetic() || **b == b'_');
            let length = word.count();
            if length == 0 {
                return Err(self.wanted("a direction as `X_PLUS`, or `)`"));
            }
            self.at += length;
        }
        self.expect(b')')?;
        Ok([first, second])
    }

    /// A cell as `(x,y)`.
    pub(super) fn cell(&mut self) -> Result<Cell, Error> {
        let [x, y] = self.pair()?;
        Ok(Cell::new(x, y))
    }

    /// An error here.
    pub(super) fn error(&self, reason: impl Into<String>) -> Error {
        // All bytes that were passed are ASCII, so the byte's number is the character's.
        Error::at(self.line, self.at + 1, reason)
    }

    /// An error here that says what should be here instead.
    pub(super) fn wanted(&mut self, wanted: &str) -> Error {
        let found = if self.is_done() {
            "the end of the line".to_owned()
        } else {
            let rest = String::from_utf8_lossy(&self.text[self.at..self.text.len().min(self.at + 4)]);
            quoted_bytes(rest.chars().take(1).collect::<String>().as_bytes())
        };
        self.error(format!("expected {wanted}, found {found}"))
    }
}
