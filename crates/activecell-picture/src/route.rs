//! The route: tinted cells, the line through them, steps, turns, and the marks of start and target.

use crate::RoutePicture;
use crate::colour::{BLUE, BLUE_TINT, PAGE, PURPLE, PURPLE_TINT, TEXT};
use crate::layout::Layout;
use crate::legend::Key;
use crate::marks::{start_mark, target_mark, turn_dot};
use crate::region;
use crate::scene::{Line, Point, Shape};
use activecell::Cell;

/// From these cell sizes on, in pixels, the route's cells are tinted and numbered.
const TINT_PX: f64 = 12.0;
const NUMBER_PX: f64 = 22.0;
/// Turns closer together than this are not shown: the dots would hide the route.
const LEAST_TURN_RADIUS: f64 = 1.8;

/// The shapes of one route.
pub(crate) struct Route<'a> {
    layout: &'a Layout,
    picture: &'a RoutePicture<'a>,
    cells: Vec<Cell>,
    cycle: Vec<Cell>,
    numbered: bool,
    turn_radius: f64,
}

impl<'a> Route<'a> {
    pub(crate) fn new(layout: &'a Layout, picture: &'a RoutePicture<'a>) -> Self {
        let on_map = |cells: &[Cell]| -> Vec<Cell> {
            cells.iter().copied().filter(|&cell| picture.map.contains(cell)).collect()
        };
        let (cells, cycle) = (on_map(picture.cells), on_map(picture.cycle));
        let mut sorted = cells.clone();
        sorted.sort_unstable();
        let once = sorted.windows(2).all(|pair| pair[0] != pair[1]);
        // Numbers would hide the regions.
        let numbered = layout.cell >= NUMBER_PX && once && cycle.is_empty() && picture.regions.is_empty();
        let turn_radius = turn_radius(layout, &cells, picture.turns.len(), numbered);
        Self { layout, picture, cells, cycle, numbered, turn_radius }
    }

    /// What the legend explains.
    pub(crate) fn keys(&self, wave: bool) -> Vec<Key> {
        let mut keys = Vec::new();
        let mut add = |shown: bool, key: Key| {
            if shown {
                keys.push(key);
            }
        };
        add(self.picture.map.contains(self.picture.from), Key::Start);
        add(self.picture.map.contains(self.picture.to), Key::Target);
        // A robot that only circles has no other line than its circle.
        add(self.cells.len() > self.cycle.len() + 1, Key::Route);
        add(self.turn_radius > 0.0 && !self.picture.turns.is_empty(), Key::Turn);
        add(!self.cycle.is_empty(), Key::Trapped);
        add(!region::shapes(self.layout, self.picture.map, self.picture.regions).is_empty(), Key::Region);
        add(wave, Key::Wave);
        keys
    }

    /// The tints of the route's cells, which lie below grid and obstacles.
    pub(crate) fn tints(&self) -> Vec<Shape> {
        if self.layout.cell < TINT_PX {
            return Vec::new();
        }
        let tint = |cells: &[Cell], colour| {
            let mut cells = cells.to_vec();
            cells.sort_unstable();
            cells.dedup();
            Shape::area(cells.iter().map(|&cell| self.layout.corners(cell)).collect(), colour)
        };
        vec![tint(&self.cells, BLUE_TINT), tint(&self.cycle, PURPLE_TINT)]
    }

    /// Everything that lies above the obstacles.
    pub(crate) fn lines_and_marks(&self) -> Vec<Shape> {
        let mut shapes = self.lines();
        if self.numbered {
            self.numbers(&mut shapes);
        }
        shapes.extend(region::shapes(self.layout, self.picture.map, self.picture.regions));
        self.turns(&mut shapes);
        shapes.extend(marks(self.layout, self.picture));
        shapes
    }

    fn lines(&self) -> Vec<Shape> {
        let width = if self.numbered { 3.0 } else { line_width(self.layout) };
        let mut shapes = line(self.layout, &self.cells, width);
        if let (Some(&first), Some(&last)) = (self.cycle.first(), self.cycle.last()) {
            let mut points: Vec<Point> = self.cycle.iter().map(|&cell| self.layout.centre(cell)).collect();
            if self.layout.lattice.dir_between(last, first).is_some() {
                points.push(self.layout.centre(first));
            }
            let run = simplified(&points);
            let width = width * 1.1;
            shapes.push(Shape::lines(vec![run.clone()], Line::new(PAGE, width + 2.0 * casing(self.layout))));
            let dash = Some((width * 1.6).max(4.0));
            shapes.push(Shape::lines(vec![run], Line { dash, ..Line::new(PURPLE, width) }));
        }
        shapes
    }

    /// Each cell's step on a white bead, so that the line does not hide it.
    fn numbers(&self, shapes: &mut Vec<Shape>) {
        for (step, &cell) in self.cells.iter().enumerate() {
            if cell == self.picture.from || cell == self.picture.to {
                continue;
            }
            let middle = self.layout.centre(cell);
            let radius = (self.layout.cell * 0.33).min(17.0);
            let line = Some(Line::new(BLUE, 1.4));
            shapes.push(Shape::Disc { centre: middle, radius, fill: PAGE, line });
            let text = step.to_string();
            let size = (radius * 0.92).min(1.75 * radius / (0.64 * text.len() as f64));
            shapes.push(Shape::label(middle, size, false, TEXT, text));
        }
    }

    fn turns(&self, shapes: &mut Vec<Shape>) {
        if self.turn_radius == 0.0 {
            return;
        }
        let mut turns: Vec<Cell> = self.picture.turns.to_vec();
        turns.retain(|&cell| self.picture.map.contains(cell));
        turns.sort_unstable_by_key(|cell| (cell.y, cell.x));
        turns.dedup();
        for cell in turns {
            let [x, y] = self.layout.centre(cell);
            // Beside the number, or the letter of a mark; else on the line.
            let marked = cell == self.picture.from || cell == self.picture.to;
            let aside = if self.numbered || marked { self.layout.cell.max(14.0) * 0.27 } else { 0.0 };
            shapes.push(turn_dot([x + aside, y - aside], self.turn_radius));
        }
    }
}

/// The radius of the dots at turns; 0 if there are too many to show.
fn turn_radius(layout: &Layout, cells: &[Cell], turns: usize, numbered: bool) -> f64 {
    if numbered {
        return (layout.cell * 0.12).clamp(3.0, 6.0);
    }
    let length = cells.len() as f64 * layout.cell;
    let radius = (line_width(layout) * 0.85).clamp(3.0, 5.0).min(0.2 * length / turns.max(1) as f64);
    if radius < LEAST_TURN_RADIUS { 0.0 } else { radius }
}

/// The width of the route's line.
pub(crate) fn line_width(layout: &Layout) -> f64 {
    (layout.cell * 0.26).clamp(3.0, 8.0)
}

/// The line through cells, with a white rim; nothing for a single cell.
pub(crate) fn line(layout: &Layout, cells: &[Cell], width: f64) -> Vec<Shape> {
    if cells.len() < 2 {
        return Vec::new();
    }
    let points: Vec<Point> = cells.iter().map(|&cell| layout.centre(cell)).collect();
    let run = simplified(&points);
    let rim = Line::new(PAGE, width + 2.0 * casing(layout));
    vec![Shape::lines(vec![run.clone()], rim), Shape::lines(vec![run], Line::new(BLUE, width))]
}

/// The width of the white rim on each side of the line.
fn casing(layout: &Layout) -> f64 {
    (layout.cell * 0.06).clamp(1.0, 1.6)
}

/// The marks of start and target that lie on the map. Where both are one cell, the target's shows behind.
pub(crate) fn marks(layout: &Layout, picture: &RoutePicture<'_>) -> Vec<Shape> {
    let radius = (layout.cell * 0.38).clamp(layout.style.least_mark, 19.0);
    let mut shapes = Vec::new();
    let same = picture.from == picture.to;
    if picture.map.contains(picture.to) {
        target_mark(&mut shapes, layout.centre(picture.to), if same { radius * 1.3 } else { radius });
    }
    if picture.map.contains(picture.from) {
        start_mark(&mut shapes, layout.centre(picture.from), if same { radius * 0.85 } else { radius });
    }
    shapes
}

/// A run without the points that no one would miss: those in the middle of a straight piece, and those closer
/// than half a pixel to the one before.
pub(crate) fn simplified(points: &[Point]) -> Vec<Point> {
    let mut kept: Vec<Point> = Vec::new();
    for (i, &point) in points.iter().enumerate() {
        if let Some(last) = kept.last()
            && (point[0] - last[0]).hypot(point[1] - last[1]) < 0.5
            && i + 1 < points.len()
        {
            continue;
        }
        if let [.., a, b] = kept[..] {
            let (ax, ay, bx, by) = (b[0] - a[0], b[1] - a[1], point[0] - b[0], point[1] - b[1]);
            if (ax * by - ay * bx).abs() < 1e-6 && ax * bx + ay * by > 0.0 {
                kept.pop();
            }
        }
        kept.push(point);
    }
    kept
}
