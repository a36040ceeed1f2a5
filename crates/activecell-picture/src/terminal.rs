//! Pictures made of characters, for a terminal.

use crate::RoutePicture;
use crate::colour::{
    BLUE, BLUE_TINT, FLOOR, GREEN, OBSTACLE, ORANGE, PAGE, PURPLE, PURPLE_TINT, Rgb, TEXT, VERMILLION, wave,
};
use crate::sample::Sampled;
use activecell::{Cell, Dir, Lattice};
use std::collections::BTreeMap;
use std::fmt::Write;

const SQUARE_ARROWS: [char; 4] = ['↑', '→', '↓', '←'];
const HEX_ARROWS: [char; 6] = ['↗', '→', '↘', '↙', '←', '↖'];

/// What is to be seen at a place; of several things in a block the greatest shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Mark {
    Route(char),
    Turn(char),
    Trapped(char),
    Target,
    Start,
}

/// Draws a route in at most `columns` × `rows` characters.
pub(crate) fn draw(picture: &RoutePicture<'_>, columns: usize, rows: usize, colour: bool) -> String {
    if columns == 0 || rows == 0 {
        return String::new();
    }
    let (width, height) = (picture.map.width() as usize, picture.map.height() as usize);
    let shift = usize::from(picture.map.lattice() == Lattice::Hex && height > 1);
    if 2 * width + shift <= columns && height <= rows {
        return cells(picture, colour);
    }
    let block = width.div_ceil(columns).max(height.div_ceil(2 * rows)) as u32;
    halves(picture, block, colour)
}

/// The marks of the route, by block.
fn marks(picture: &RoutePicture<'_>, block: i32) -> BTreeMap<Cell, Mark> {
    let lattice = picture.map.lattice();
    let arrow = |from: Cell, to: Option<&Cell>| {
        let dir = to.and_then(|&to| lattice.dir_between(from, to));
        dir.map_or('o', |Dir(dir)| match lattice {
            Lattice::Square => SQUARE_ARROWS[usize::from(dir)],
            Lattice::Hex => HEX_ARROWS[usize::from(dir)],
        })
    };
    let mut found = BTreeMap::new();
    let mut put = |cell: Cell, mark: Mark| {
        if picture.map.contains(cell) {
            let place = found.entry(Cell::new(cell.x / block, cell.y / block)).or_insert(mark);
            *place = mark.max(*place);
        }
    };
    let mut arrows = BTreeMap::new();
    for (i, &cell) in picture.cells.iter().enumerate() {
        let arrow = arrow(cell, picture.cells.get(i + 1));
        arrows.insert(cell, arrow);
        put(cell, Mark::Route(arrow));
    }
    for &cell in picture.turns {
        put(cell, Mark::Turn(arrows.get(&cell).copied().unwrap_or('o')));
    }
    for (i, &cell) in picture.cycle.iter().enumerate() {
        let next = picture.cycle.get(i + 1).or(picture.cycle.first());
        put(cell, Mark::Trapped(arrow(cell, next)));
    }
    put(picture.to, Mark::Target);
    put(picture.from, Mark::Start);
    found
}

/// Two characters a cell; odd rows of hexagons stand one character further right.
fn cells(picture: &RoutePicture<'_>, colour: bool) -> String {
    let map = picture.map;
    let marks = marks(picture, 1);
    let longest = picture.wave.and_then(|wave| crate::farthest(map, wave));
    let mut pen = Pen::new(colour);
    for y in 0..map.height() as i32 {
        if map.lattice() == Lattice::Hex && y & 1 == 1 {
            pen.out.push(' ');
        }
        for x in 0..map.width() as i32 {
            let cell = Cell::new(x, y);
            if let Some(&mark) = marks.get(&cell) {
                let (letter, ink, paper) = look(mark);
                pen.put(ink, Some(paper));
                pen.out.extend([' ', letter]);
            } else if map.is_free(cell) {
                let steps = picture.wave.and_then(|wave| wave(cell));
                let paper = match (steps, longest) {
                    (Some(steps), Some(longest)) => wave(f64::from(steps) / f64::from(longest.max(1))),
                    _ => FLOOR,
                };
                pen.put(TEXT.mix(paper, 0.7), Some(paper));
                pen.out.push_str(" .");
            } else {
                pen.put(OBSTACLE, Some(OBSTACLE));
                pen.out.push_str("##");
            }
        }
        pen.end_line();
    }
    pen.out
}

/// Character, ink and paper of a mark.
fn look(mark: Mark) -> (char, Rgb, Rgb) {
    match mark {
        Mark::Route(arrow) => (arrow, BLUE, BLUE_TINT),
        Mark::Turn(arrow) => (arrow, TEXT, ORANGE),
        Mark::Trapped(arrow) => (arrow, TEXT, PURPLE_TINT.mix(PURPLE, 0.5)),
        Mark::Target => ('F', PAGE, VERMILLION),
        Mark::Start => ('S', PAGE, GREEN),
    }
}

/// Half a character a block of cells.
fn halves(picture: &RoutePicture<'_>, block: u32, colour: bool) -> String {
    let sampled = Sampled::new(picture.map, block);
    let marks = marks(picture, sampled.block as i32);
    let (width, height) = (sampled.width() as i32, sampled.height() as i32);
    let paint = |cell: Cell| match marks.get(&cell) {
        Some(Mark::Route(_) | Mark::Turn(_)) => BLUE,
        Some(Mark::Trapped(_)) => PURPLE,
        Some(Mark::Target) => VERMILLION,
        Some(Mark::Start) => GREEN,
        None if sampled.is_obstacle(cell) => OBSTACLE,
        None => FLOOR,
    };
    let mut pen = Pen::new(colour);
    for y in (0..height).step_by(2) {
        for x in 0..width {
            let (upper, lower) = (Cell::new(x, y), Cell::new(x, y + 1));
            let below = lower.y < height;
            if colour {
                pen.put(paint(upper), below.then(|| paint(lower)));
                let mark = marks.get(&upper).max(if below { marks.get(&lower) } else { None });
                if let Some(&mark @ (Mark::Start | Mark::Target)) = mark {
                    let (letter, ink, paper) = look(mark);
                    pen.put(ink, Some(paper));
                    pen.out.push(letter);
                } else {
                    pen.out.push('▀');
                }
                continue;
            }
            let mark = marks.get(&upper).max(if below { marks.get(&lower) } else { None });
            pen.out.push(match (mark, sampled.is_obstacle(upper), below && sampled.is_obstacle(lower)) {
                (Some(Mark::Start), ..) => 'S',
                (Some(Mark::Target), ..) => 'F',
                (Some(Mark::Trapped(_)), ..) => 'x',
                (Some(_), ..) => 'o',
                (None, true, true) => '█',
                (None, true, false) => '▀',
                (None, false, true) => '▄',
                (None, false, false) => ' ',
            });
        }
        pen.end_line();
    }
    pen.out
}

/// Text with colours, which are named only where they change.
struct Pen {
    out: String,
    colour: bool,
    now: Option<(Rgb, Option<Rgb>)>,
}

impl Pen {
    const fn new(colour: bool) -> Self {
        Self { out: String::new(), colour, now: None }
    }

    /// Sets the ink, and the paper or none.
    fn put(&mut self, ink: Rgb, paper: Option<Rgb>) {
        if !self.colour || self.now == Some((ink, paper)) {
            return;
        }
        self.now = Some((ink, paper));
        let Rgb(r, g, b) = ink;
        // Writing to a string cannot fail.
        let _ = write!(self.out, "\x1b[38;2;{r};{g};{b}m");
        let _ = match paper {
            Some(Rgb(r, g, b)) => write!(self.out, "\x1b[48;2;{r};{g};{b}m"),
            None => write!(self.out, "\x1b[49m"),
        };
    }

    fn end_line(&mut self) {
        if self.colour {
            self.out.push_str("\x1b[0m");
            self.now = None;
        }
        self.out.push('\n');
    }
}
