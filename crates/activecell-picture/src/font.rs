//! Letters: how wide a text is, and its outlines for the raster back end.

use std::sync::LazyLock;
use tiny_skia::PathBuilder;
use ttf_parser::{Face, OutlineBuilder};

/// A font of the pictures. The SVG names the same family first, so that widths agree.
struct Font(Option<Face<'static>>);

static REGULAR: LazyLock<Font> = LazyLock::new(|| Font(Face::parse(dejavu::sans::regular(), 0).ok()));
static BOLD: LazyLock<Font> = LazyLock::new(|| Font(Face::parse(dejavu::sans::bold(), 0).ok()));

fn face(bold: bool) -> Option<&'static Face<'static>> {
    if bold { BOLD.0.as_ref() } else { REGULAR.0.as_ref() }
}

/// The width of a text in pixels at a font size of `size` pixels.
pub(crate) fn width(text: &str, size: f64, bold: bool) -> f64 {
    let Some(face) = face(bold) else { return 0.6 * size * text.chars().count() as f64 };
    let units: u32 = text.chars().map(|c| advance(face, c)).sum();
    f64::from(units) * size / f64::from(face.units_per_em())
}

/// The text, or as much of its beginning as fits in `room` pixels with `…` behind it.
pub(crate) fn shorten(text: &str, size: f64, bold: bool, room: f64) -> String {
    if width(text, size, bold) <= room {
        return text.to_owned();
    }
    let mut kept = String::new();
    let mut used = width("…", size, bold);
    for c in text.chars() {
        used += width(c.encode_utf8(&mut [0; 4]), size, bold);
        if used > room {
            break;
        }
        kept.push(c);
    }
    format!("{}…", kept.trim_end())
}

/// Adds the outlines of a text that begins at (x, y) on its base line.
pub(crate) fn outline(path: &mut PathBuilder, text: &str, x: f64, y: f64, size: f64, bold: bool) {
    let Some(face) = face(bold) else { return };
    let scale = size / f64::from(face.units_per_em());
    let mut x = x;
    for c in text.chars() {
        let glyph = face.glyph_index(c).unwrap_or_default();
        face.outline_glyph(glyph, &mut Pen { path, x: x as f32, y: y as f32, scale: scale as f32 });
        x += f64::from(advance(face, c)) * scale;
    }
}

fn advance(face: &Face<'_>, c: char) -> u32 {
    face.glyph_hor_advance(face.glyph_index(c).unwrap_or_default()).unwrap_or(0).into()
}

/// Draws a glyph (y up, in font units) on a canvas (y down, in pixels).
struct Pen<'a> {
    path: &'a mut PathBuilder,
    x: f32,
    y: f32,
    scale: f32,
}

impl Pen<'_> {
    fn at(&self, x: f32, y: f32) -> (f32, f32) {
        (self.x + x * self.scale, self.y - y * self.scale)
    }
}

impl OutlineBuilder for Pen<'_> {
    fn move_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.at(x, y);
        self.path.move_to(x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.at(x, y);
        self.path.line_to(x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let ((x1, y1), (x, y)) = (self.at(x1, y1), self.at(x, y));
        self.path.quad_to(x1, y1, x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let ((x1, y1), (x2, y2), (x, y)) = (self.at(x1, y1), self.at(x2, y2), self.at(x, y));
        self.path.cubic_to(x1, y1, x2, y2, x, y);
    }

    fn close(&mut self) {
        self.path.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shortened_text_fits() {
        assert_eq!(shorten("office", 16.0, true, 200.0), "office");
        for room in [0.0, 20.0, 60.0, 100.0] {
            let short = shorten("a rather long title · hexagonal", 16.0, true, room);
            assert!(short.ends_with('…'));
            assert!(width(&short, 16.0, true) <= room.max(width("…", 16.0, true)));
        }
    }
}
