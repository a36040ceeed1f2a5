//! Driven logs as small multiples: the truth, and two dead reckonings of it.

use crate::colour::{BLUE, EDGE, FLOOR, GREEN, OBSTACLE, PAGE, Rgb, TEXT, VERMILLION};
use crate::scene::{Line, Point, Scene, Shape, Text, printable};
use crate::{Error, encode_png, font, svg};
use activecell::PointM;

/// One log: paths in metres, x right, y up.
#[derive(Debug, Clone, Copy)]
pub struct DrivePanel<'a> {
    /// Above the panel; shortened with `…` if it is too long.
    pub title: &'a str,
    /// Below the title, in small letters.
    pub note: &'a str,
    /// Where the robot really was.
    pub truth: &'a [PointM],
    /// Where it was by the ticks and the nominal robot.
    pub nominal: &'a [PointM],
    /// Where it was by the ticks and the calibrated robot.
    pub calibrated: &'a [PointM],
}

/// The most panels that are drawn.
const MAX_PANELS: usize = 60;
const PANEL: Point = [236.0, 250.0];
const GAP: f64 = 14.0;
const MARGIN: f64 = 20.0;
/// Room of the titles above a panel's drawing, of the scale below it, and at its sides.
const HEAD: f64 = 46.0;
const FOOT: f64 = 26.0;
const SIDE: f64 = 16.0;
const TOP: f64 = 74.0;
/// A panel shows so many metres at least.
const LEAST_M: f64 = 0.1;

/// The panels as an SVG document; at most 60 of them.
///
/// ```
/// use activecell_picture::{DrivePanel, drives_svg};
/// let (truth, drifted) = ([[0.0, 0.0], [1.0, 0.0]], [[0.0, 0.0], [1.0, 0.1]]);
/// let panel = DrivePanel { title: "run 1", note: "", truth: &truth, nominal: &drifted, calibrated: &truth };
/// assert!(drives_svg(&[panel]).contains("run 1"));
/// ```
pub fn drives_svg(panels: &[DrivePanel<'_>]) -> String {
    svg::write(&scene(panels))
}

/// The panels as a PNG file.
///
/// # Errors
/// [`Error::Canvas`], [`Error::Encoding`].
pub fn drives_png(panels: &[DrivePanel<'_>]) -> Result<Vec<u8>, Error> {
    encode_png(&scene(panels))
}

fn scene(all: &[DrivePanel<'_>]) -> Scene {
    let panels = &all[..all.len().min(MAX_PANELS)];
    // About as wide as high, so that a page or a screen shows them all.
    let columns = ((panels.len() as f64).sqrt().ceil() as usize).clamp(3, 6);
    let rows = panels.len().div_ceil(columns).max(1);
    let width = 2.0 * MARGIN + columns as f64 * (PANEL[0] + GAP) - GAP;
    let height = TOP + rows as f64 * (PANEL[1] + GAP) - GAP + MARGIN;
    let mut shapes = vec![Shape::area(vec![rectangle([0.0, 0.0], [width, height])], PAGE)];
    heading(&mut shapes);
    for (i, panel) in panels.iter().enumerate() {
        let at = [(i % columns) as f64 * (PANEL[0] + GAP), (i / columns) as f64 * (PANEL[1] + GAP)];
        draw(&mut shapes, [MARGIN + at[0], TOP + at[1]], panel);
    }
    let description = format!("{} of {} logs, each drawn to its own scale.", panels.len(), all.len());
    Scene { width, height, title: "Dead reckoning beside the truth".to_owned(), description, shapes }
}

/// Title and legend.
fn heading(shapes: &mut Vec<Shape>) {
    text(shapes, [MARGIN, 34.0], 17.0, true, "Dead reckoning beside the truth");
    let mut x = MARGIN;
    for (line, label) in
        [(truth(), "truth"), (nominal(), "nominal robot"), (calibrated(), "calibrated robot")]
    {
        shapes.push(Shape::lines(vec![vec![[x, 56.0], [x + 30.0, 56.0]]], line));
        text(shapes, [x + 37.0, 60.5], 13.0, false, label);
        x += 37.0 + font::width(label, 13.0, false) + 22.0;
    }
    shapes.push(dot([x + 5.0, 56.0], GREEN));
    text(shapes, [x + 15.0, 60.5], 13.0, false, "start, and the ends in the colours of their lines");
}

const fn truth() -> Line {
    Line::new(EDGE, 4.5)
}

const fn nominal() -> Line {
    Line::new(VERMILLION, 1.5)
}

const fn calibrated() -> Line {
    Line::new(BLUE, 1.7)
}

fn dot(centre: Point, fill: Rgb) -> Shape {
    Shape::Disc { centre, radius: 4.2, fill, line: Some(Line::new(PAGE, 1.0)) }
}

fn rectangle([x, y]: Point, [width, height]: Point) -> Vec<Point> {
    vec![[x, y], [x + width, y], [x + width, y + height], [x, y + height]]
}

fn text(shapes: &mut Vec<Shape>, at: Point, size: f64, bold: bool, content: &str) {
    let content = printable(content);
    shapes.push(Shape::Text(Text { at, size, centred: false, bold, colour: TEXT, content }));
}

fn draw(shapes: &mut Vec<Shape>, [x, y]: Point, panel: &DrivePanel<'_>) {
    let frame = rectangle([x, y], PANEL);
    shapes.push(Shape::area(vec![frame], FLOOR));
    let room = PANEL[0] - 2.0 * SIDE;
    let shortened = |text: &str, size, bold| font::shorten(&printable(text), size, bold, room);
    text(shapes, [x + SIDE, y + 21.0], 13.0, true, &shortened(panel.title, 13.0, true));
    text(shapes, [x + SIDE, y + 38.0], 11.5, false, &shortened(panel.note, 11.5, false));

    let paths = [panel.truth, panel.nominal, panel.calibrated];
    let points = paths.iter().flat_map(|path| path.iter());
    let mut low = [f64::INFINITY; 2];
    let mut high = [f64::NEG_INFINITY; 2];
    for point in points {
        for axis in 0..2 {
            low[axis] = low[axis].min(point[axis]);
            high[axis] = high[axis].max(point[axis]);
        }
    }
    if low[0] > high[0] {
        return;
    }
    let tall = PANEL[1] - HEAD - FOOT;
    // A turn in place is a point, not a picture of the noise of a position.
    let size = [(high[0] - low[0]).max(LEAST_M), (high[1] - low[1]).max(LEAST_M)];
    let px_per_m = (room / size[0]).min(tall / size[1]);
    let middle = [x + PANEL[0] / 2.0, y + HEAD + tall / 2.0];
    let place = |point: &PointM| -> Point {
        [
            middle[0] + (point[0] - f64::midpoint(low[0], high[0])) * px_per_m,
            middle[1] - (point[1] - f64::midpoint(low[1], high[1])) * px_per_m,
        ]
    };
    for (path, line) in paths.into_iter().zip([truth(), nominal(), calibrated()]) {
        shapes.push(Shape::lines(vec![thinned(path.iter().map(place))], line));
    }
    for (path, colour) in paths.into_iter().zip([OBSTACLE, VERMILLION, BLUE]) {
        shapes.extend(path.last().map(|end| dot(place(end), colour)));
    }
    shapes.extend(panel.truth.first().map(|start| dot(place(start), GREEN)));
    scale_bar(shapes, [x + SIDE, y + PANEL[1] - 11.0], px_per_m);
}

/// The points without those that lie within a quarter of a pixel of the one before.
fn thinned(points: impl Iterator<Item = Point>) -> Vec<Point> {
    let mut kept: Vec<Point> = Vec::new();
    let mut last = None;
    for point in points {
        if kept.last().is_none_or(|k: &Point| (k[0] - point[0]).hypot(k[1] - point[1]) >= 0.25) {
            kept.push(point);
        }
        last = Some(point);
    }
    kept.extend(last);
    kept
}

/// A bar of a round length, about a quarter of the panel.
fn scale_bar(shapes: &mut Vec<Shape>, [x, y]: Point, px_per_m: f64) {
    let wanted_m = PANEL[0] / 4.0 / px_per_m;
    let decade = 10.0_f64.powf(wanted_m.log10().floor());
    let length_m = decade * [5.0, 2.0, 1.0].into_iter().find(|step| step * decade <= wanted_m).unwrap_or(1.0);
    let right = x + length_m * px_per_m;
    let bar = vec![[x, y - 3.0], [x, y + 3.0], [x, y], [right, y], [right, y + 3.0], [right, y - 3.0]];
    shapes.push(Shape::lines(vec![bar], Line::new(OBSTACLE, 1.2)));
    let label =
        if length_m < 1.0 { format!("{:.0} cm", length_m * 100.0) } else { format!("{length_m:.0} m") };
    text(shapes, [right + 7.0, y + 4.0], 11.5, false, &label);
}
