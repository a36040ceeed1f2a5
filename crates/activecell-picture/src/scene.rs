//! What is to be drawn, before it becomes SVG text or pixels: both back ends read this one list.

use crate::colour::Rgb;
use tiny_skia::Pixmap;

/// A point in pixels from the top left corner.
pub(crate) type Point = [f64; 2];

/// A picture: its size in pixels and its shapes, the lowest first.
#[derive(Debug, Clone)]
pub(crate) struct Scene {
    pub(crate) width: f64,
    pub(crate) height: f64,
    /// Read out by screen readers: a heading and a sentence.
    pub(crate) title: String,
    pub(crate) description: String,
    pub(crate) shapes: Vec<Shape>,
}

/// One shape. Lines have round joints.
#[derive(Debug, Clone)]
pub(crate) enum Shape {
    /// Runs of points; a fill obeys the even-odd rule, so that a loop inside another is a hole.
    Path {
        runs: Vec<Vec<Point>>,
        closed: bool,
        fill: Option<Rgb>,
        line: Option<Line>,
    },
    Disc {
        centre: Point,
        radius: f64,
        fill: Rgb,
        line: Option<Line>,
    },
    Text(Text),
    /// Pixels with their upper left corner at a point.
    Image {
        at: Point,
        pixels: Pixmap,
    },
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Line {
    pub(crate) colour: Rgb,
    pub(crate) width: f64,
    /// Length of the dashes and of the gaps.
    pub(crate) dash: Option<f64>,
    /// From 0, not to be seen, to 1.
    pub(crate) opacity: f64,
}

/// A line of text; `at` is on its base line.
#[derive(Debug, Clone)]
pub(crate) struct Text {
    pub(crate) at: Point,
    pub(crate) size: f64,
    pub(crate) centred: bool,
    pub(crate) bold: bool,
    pub(crate) colour: Rgb,
    pub(crate) content: String,
}

impl Line {
    pub(crate) const fn new(colour: Rgb, width: f64) -> Self {
        Self { colour, width, dash: None, opacity: 1.0 }
    }
}

impl Shape {
    pub(crate) fn area(runs: Vec<Vec<Point>>, fill: Rgb) -> Self {
        Self::Path { runs, closed: true, fill: Some(fill), line: None }
    }

    pub(crate) fn lines(runs: Vec<Vec<Point>>, line: Line) -> Self {
        Self::Path { runs, closed: false, fill: None, line: Some(line) }
    }

    /// Text whose middle is at a point, both ways.
    pub(crate) fn label(middle: Point, size: f64, bold: bool, colour: Rgb, content: String) -> Self {
        // Capitals and digits are about 0.73 of the size high.
        let at = [middle[0], middle[1] + 0.365 * size];
        Self::Text(Text { at, size, centred: true, bold, colour, content })
    }
}

/// Text without what no picture can show: control characters, and code points that XML forbids.
pub(crate) fn printable(text: &str) -> String {
    text.chars()
        .map(|c| if matches!(c, '\t' | '\n' | '\r') { ' ' } else { c })
        .filter(|&c| !c.is_control() && !matches!(c, '\u{fffe}' | '\u{ffff}'))
        .collect()
}
