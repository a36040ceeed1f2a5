//! The moves of one robot as words: `E3 N .2 (7,4)` is three steps east, one north, two rests, and a jump to (7,4).

use super::scan::Scan;
use crate::error::{Error, quoted};
use activecell::{Cell, Lattice};

/// What comes after a word's direction.
struct Run<'a> {
    /// The direction's name, `.` to rest, or a cell in parentheses.
    what: &'a str,
    /// How many steps.
    steps: usize,
}

impl<'a> Run<'a> {
    fn read(word: &'a str) -> Result<Self, Error> {
        if word.starts_with('(') {
            return Ok(Self { what: word, steps: 1 });
        }
        let what = word.trim_end_matches(|c: char| c.is_ascii_digit());
        let digits = &word[what.len()..];
        let steps = if digits.is_empty() { Ok(1) } else { digits.parse() };
        match steps {
            Ok(steps) if steps > 0 && !what.is_empty() => Ok(Self { what, steps }),
            _ => Err(Error::file(format!("{} is no move; write them as `E3` or `.2`", quoted(word)))),
        }
    }
}

/// How many steps the moves take; `None` if they are more than can be counted.
pub(super) fn steps(moves: &str) -> Result<Option<usize>, Error> {
    let mut sum = Some(0usize);
    for word in moves.split_ascii_whitespace() {
        let run = Run::read(word)?;
        sum = sum.and_then(|sum| sum.checked_add(run.steps));
    }
    Ok(sum)
}

/// Tells `stand` of every cell of a robot that starts here, the start first; gives the last. Count the [`steps`] before.
pub(super) fn walk(
    lattice: Lattice,
    start: Cell,
    moves: &str,
    mut stand: impl FnMut(Cell),
) -> Result<Cell, Error> {
    let mut cell = start;
    stand(cell);
    for word in moves.split_ascii_whitespace() {
        let run = Run::read(word)?;
        let dir = match run.what {
            "." => None,
            jump if jump.starts_with('(') => {
                let mut scan = Scan::new(1, jump.as_bytes(), 0);
                let is_cell = scan.cell().ok().filter(|_| scan.is_done());
                cell = is_cell.ok_or_else(|| {
                    Error::file(format!("{} is no cell; write it as `(7,4)`", quoted(jump)))
                })?;
                None
            }
            name => Some(lattice.dir_named(name).ok_or_else(|| {
                let names: Vec<&str> = lattice.dirs().map(|dir| lattice.dir_name(dir)).collect();
                let names = names.join(", ");
                Error::file(format!("{} is no move on this lattice; use {names} or `.`", quoted(word)))
            })?),
        };
        for _ in 0..run.steps {
            cell = dir.map_or(cell, |dir| lattice.neighbour(cell, dir));
            stand(cell);
        }
    }
    Ok(cell)
}

/// The path as words; the rest at its end is left out.
pub(super) fn write(lattice: Lattice, path: &[Cell]) -> String {
    let last = path.iter().rposition(|cell| Some(cell) != path.last()).map_or(0, |before| before + 1);
    let mut words: Vec<(String, usize)> = Vec::new();
    for pair in path[..=last.min(path.len() - 1)].windows(2) {
        let word = match (pair[0] == pair[1], lattice.dir_between(pair[0], pair[1])) {
            (true, _) => ".".to_owned(),
            (false, Some(dir)) => lattice.dir_name(dir).to_owned(),
            // A jump is no move, but a file can hold it.
            (false, None) => format!("({},{})", pair[1].x, pair[1].y),
        };
        match words.last_mut() {
            Some((before, steps)) if *before == word && !word.starts_with('(') => *steps += 1,
            _ => words.push((word, 1)),
        }
    }
    let words =
        words.into_iter().map(|(word, steps)| if steps == 1 { word } else { format!("{word}{steps}") });
    words.collect::<Vec<_>>().join(" ")
}
