//! Text maps: `.` free, `#` obstacle, a letter names a free cell.

use super::{BitPlane, Map};
use crate::error::Error;
use crate::lattice::{Cell, Lattice};

impl Map {
    /// Reads a text map: one line a row, `.` free, `#` obstacle, each ASCII letter a free cell of that name.
    ///
    /// Lines end in LF or CRLF; the last may lack its end. Empty lines at the end are left out.
    ///
    /// # Errors
    /// [`Error::BadFormat`] with line and column; [`Error::EmptyMap`]; [`Error::MapTooLarge`].
    ///
    /// ```
    /// use activecell::{Cell, Lattice, Map};
    /// let map = Map::parse(Lattice::Hex, "S..\n.#.\n..F\n")?;
    /// assert_eq!(map.mark('S'), Some(Cell::new(0, 0)));
    /// assert_eq!(map.to_text(), "S..\n.#.\n..F\n");
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn parse(lattice: Lattice, text: &str) -> Result<Self, Error> {
        let text = text.trim_end_matches(['\n', '\r']);
        let width = text.lines().next().map_or(0, |line| line.chars().count());
        let mut obstacles = BitPlane::new(width as u64, text.lines().count() as u64)?;
        let mut marks: Vec<(char, Cell)> = Vec::new();
        for (y, line) in text.lines().enumerate() {
            let length = line.chars().count();
            if length != width {
                let reason =
                    format!("the row has {length} cells, the first row has {width}; make all rows as long");
                return Err(Error::BadFormat { line: y + 1, column: length.min(width) + 1, reason });
            }
            for (x, character) in line.chars().enumerate() {
                let at = |reason| Error::BadFormat { line: y + 1, column: x + 1, reason };
                match character {
                    '.' => {}
                    '#' => obstacles.set(x as u32, y as u32, true),
                    name if name.is_ascii_alphabetic() => {
                        if let Some((_, first)) = marks.iter().find(|mark| mark.0 == name) {
                            return Err(at(format!(
                                "the letter `{name}` marks the cell {first} already; use another letter"
                            )));
                        }
                        marks.push((name, Cell::new(x as i32, y as i32)));
                    }
                    other => {
                        return Err(at(format!(
                            "unexpected character `{}`; use `.` for free, `#` for an obstacle, letters for named cells",
                            other.escape_default()
                        )));
                    }
                }
            }
        }
        Ok(Self { marks: marks.into(), ..Self::new(lattice, obstacles) })
    }

    /// The map as text, in the form that [`Map::parse`] reads.
    pub fn to_text(&self) -> String {
        let mut text = String::with_capacity((self.width() as usize + 1) * self.height() as usize);
        for y in 0..self.height() {
            for x in 0..self.width() {
                let cell = Cell::new(x as i32, y as i32);
                let mark = self.marks.iter().find(|mark| mark.1 == cell).map_or('.', |mark| mark.0);
                text.push(if self.is_free(cell) { mark } else { '#' });
            }
            text.push('\n');
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error(text: &str) -> String {
        Map::parse(Lattice::Square, text).unwrap_err().to_string()
    }

    #[test]
    fn bad_text_is_told_by_place() {
        assert_eq!(
            error("..\n...\n"),
            "map line 2, column 3: the row has 3 cells, the first row has 2; make all rows as long"
        );
        assert_eq!(
            error("S.\n.S"),
            "map line 2, column 2: the letter `S` marks the cell (0,0) already; use another letter"
        );
        assert!(error("..\n.\u{1b}").contains("\\u{1b}"));
        assert_eq!(error("\n\n"), Error::EmptyMap.to_string());
    }

    #[test]
    fn line_ends_do_not_matter() {
        let map = Map::parse(Lattice::Square, "A.#\n#..").unwrap();
        assert_eq!(map, Map::parse(Lattice::Square, "A.#\r\n#..\r\n\r\n").unwrap());
        assert_eq!(map.to_text(), "A.#\n#..\n");
    }
}
