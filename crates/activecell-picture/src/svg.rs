//! The SVG back end: a scene as text.

use crate::scene::{Line, Point, Scene, Shape, Text};
use std::fmt::Write;

const FONTS: &str = "DejaVu Sans,Verdana,Helvetica,Arial,sans-serif";

/// Writes a scene as an SVG document.
pub(crate) fn write(scene: &Scene) -> String {
    let mut out = Svg(String::new());
    let (w, h) = (number(scene.width), number(scene.height));
    out.put(format_args!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\" \
         role=\"img\" font-family=\"{FONTS}\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n"
    ));
    out.put(format_args!("<title>{}</title>\n", escape(&scene.title)));
    out.put(format_args!("<desc>{}</desc>\n", escape(&scene.description)));
    for shape in &scene.shapes {
        out.shape(shape);
    }
    out.0.push_str("</svg>\n");
    out.0
}

/// The document so far.
struct Svg(String);

impl Svg {
    fn put(&mut self, text: std::fmt::Arguments<'_>) {
        // Writing to a string cannot fail.
        let _ = self.0.write_fmt(text);
    }

    fn shape(&mut self, shape: &Shape) {
        match shape {
            Shape::Path { runs, closed, fill, line } => {
                if runs.iter().all(Vec::is_empty) {
                    return;
                }
                self.0.push_str("<path d=\"");
                for run in runs {
                    self.run(run, *closed);
                }
                match fill {
                    Some(colour) if *closed => {
                        self.put(format_args!("\" fill=\"{}\" fill-rule=\"evenodd\"", colour.hex()));
                    }
                    _ => self.0.push_str("\" fill=\"none\""),
                }
                self.line(line.as_ref());
                self.0.push_str("/>\n");
            }
            Shape::Disc { centre, radius, fill, line } => {
                let [x, y] = centre.map(number);
                let (r, fill) = (number(*radius), fill.hex());
                self.put(format_args!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{r}\" fill=\"{fill}\""));
                self.line(line.as_ref());
                self.0.push_str("/>\n");
            }
            Shape::Text(text) => self.text(text),
            Shape::Image { at, pixels } => {
                // An image that cannot be written is left out; it explains, and is not what is explained.
                let Ok(png) = pixels.encode_png() else { return };
                let ([x, y], w, h) = (at.map(number), pixels.width(), pixels.height());
                let data = base64(&png);
                self.put(format_args!("<image x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" href=\"data:image/png;base64,{data}\"/>\n"));
            }
        }
    }

    fn line(&mut self, line: Option<&Line>) {
        let Some(line) = line else { return };
        let width = number(line.width);
        self.put(format_args!(" stroke=\"{}\" stroke-width=\"{width}\"", line.colour.hex()));
        if line.opacity < 1.0 {
            self.put(format_args!(" stroke-opacity=\"{}\"", number(line.opacity)));
        }
        if let Some(dash) = line.dash {
            self.put(format_args!(" stroke-dasharray=\"{}\" stroke-linecap=\"butt\"", number(dash)));
        }
    }

    fn text(&mut self, text: &Text) {
        let [x, y] = text.at.map(number);
        self.put(format_args!("<text x=\"{x}\" y=\"{y}\" font-size=\"{}\"", number(text.size)));
        if text.centred {
            self.0.push_str(" text-anchor=\"middle\"");
        }
        if text.bold {
            self.0.push_str(" font-weight=\"bold\"");
        }
        self.put(format_args!(" fill=\"{}\">{}</text>\n", text.colour.hex(), escape(&text.content)));
    }

    /// A run of points, each relative to the one before. Points are rounded before they are subtracted, so
    /// that errors do not add up.
    fn run(&mut self, run: &[Point], closed: bool) {
        let Some(&first) = run.first() else { return };
        let (mut x, mut y) = hundredths(first);
        self.0.push('M');
        self.offset(x, y);
        let mut command = 'M';
        for &point in &run[1..] {
            let (dx, dy) = (hundredths(point).0 - x, hundredths(point).1 - y);
            (x, y) = (x + dx, y + dy);
            let next = match (dx, dy) {
                (_, 0) => 'h',
                (0, _) => 'v',
                _ => 'l',
            };
            // A line may follow a line without naming it again.
            if next != command {
                self.0.push(next);
            } else if next != 'l' || dx >= 0 {
                self.0.push(' ');
            }
            command = next;
            match next {
                'h' => self.hundredths(dx),
                'v' => self.hundredths(dy),
                _ => self.offset(dx, dy),
            }
        }
        if closed {
            self.0.push('z');
        } else if run.len() == 1 {
            self.0.push_str("h0");
        }
    }

    fn offset(&mut self, x: i64, y: i64) {
        self.hundredths(x);
        if y >= 0 {
            self.0.push(' ');
        }
        self.hundredths(y);
    }

    fn hundredths(&mut self, value: i64) {
        let sign = if value < 0 { "-" } else { "" };
        let (whole, rest) = (value.unsigned_abs() / 100, value.unsigned_abs() % 100);
        match (whole, rest) {
            (_, 0) => self.put(format_args!("{sign}{whole}")),
            (0, _) if rest % 10 == 0 => self.put(format_args!("{sign}.{}", rest / 10)),
            (0, _) => self.put(format_args!("{sign}.{rest:02}")),
            _ if rest % 10 == 0 => self.put(format_args!("{sign}{whole}.{}", rest / 10)),
            _ => self.put(format_args!("{sign}{whole}.{rest:02}")),
        }
    }
}

fn hundredths([x, y]: Point) -> (i64, i64) {
    ((x * 100.0).round() as i64, (y * 100.0).round() as i64)
}

/// A number with at most two decimals.
fn number(value: f64) -> String {
    let mut out = Svg(String::new());
    out.hundredths((value * 100.0).round() as i64);
    out.0
}

/// Bytes as text (RFC 4648).
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let word =
            three.iter().fold(0u32, |word, &byte| word << 8 | u32::from(byte)) << (8 * (3 - three.len()));
        for digit in 0..4 {
            let known = digit <= three.len();
            text.push(if known { DIGITS[(word >> (18 - 6 * digit) & 63) as usize].into() } else { '=' });
        }
    }
    text
}

/// Text in which nothing reads as mark-up.
fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            _ => escaped.push(c),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let written: Vec<String> = [0.0, 1.0, -1.0, 0.5, -0.25, 12.345, 0.05].map(number).to_vec();
        assert_eq!(written, ["0", "1", "-1", ".5", "-.25", "12.35", ".05"]);
    }

    #[test]
    fn bytes_become_text_as_the_standard_says() {
        let written = ["", "f", "fo", "foo", "foob", "fooba", "foobar"].map(|text| base64(text.as_bytes()));
        assert_eq!(written, ["", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"]);
    }

    #[test]
    fn paths_are_relative() {
        let mut svg = Svg(String::new());
        svg.run(&[[1.0, 1.0], [3.0, 1.0], [3.0, 2.5], [2.0, 2.0], [1.0, 1.5]], true);
        assert_eq!(svg.0, "M1 1h2v1.5l-1-.5-1-.5z");
    }
}
