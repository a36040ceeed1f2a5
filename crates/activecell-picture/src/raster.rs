//! The raster back end: a scene as pixels.

use crate::Error;
use crate::colour::Rgb;
use crate::font;
use crate::scene::{Line, Point, Scene, Shape, Text};
use tiny_skia::{
    FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, PixmapPaint, Stroke, StrokeDash, Transform,
};

/// A canvas without colour.
pub(crate) fn canvas(scene: &Scene) -> Result<Pixmap, Error> {
    let (width, height) = (scene.width.ceil() as u32, scene.height.ceil() as u32);
    Pixmap::new(width, height).ok_or(Error::Canvas { width, height })
}

/// Draws a scene on a canvas of its size.
pub(crate) fn draw(scene: &Scene) -> Result<Pixmap, Error> {
    let mut pixmap = canvas(scene)?;
    draw_shapes(&mut pixmap, &scene.shapes);
    Ok(pixmap)
}

/// Draws shapes on what is there already.
pub(crate) fn draw_shapes(pixmap: &mut Pixmap, shapes: &[Shape]) {
    for shape in shapes {
        match shape {
            Shape::Path { runs, closed, fill, line } => {
                let fill = fill.filter(|_| *closed);
                draw_path(pixmap, path(runs, *closed), fill, line.as_ref());
            }
            Shape::Disc { centre, radius, fill, line } => {
                let disc = PathBuilder::from_circle(centre[0] as f32, centre[1] as f32, *radius as f32);
                draw_path(pixmap, disc, Some(*fill), line.as_ref());
            }
            Shape::Text(text) => draw_text(pixmap, text),
            Shape::Image { at: [x, y], pixels } => {
                let paint = PixmapPaint::default();
                pixmap.draw_pixmap(
                    *x as i32,
                    *y as i32,
                    pixels.as_ref(),
                    &paint,
                    Transform::identity(),
                    None,
                );
            }
        }
    }
}

fn draw_text(pixmap: &mut Pixmap, text: &Text) {
    let Text { at: [mut x, y], size, centred, bold, colour, ref content } = *text;
    if centred {
        x -= font::width(content, size, bold) / 2.0;
    }
    let mut path = PathBuilder::new();
    font::outline(&mut path, content, x, y, size, bold);
    if let Some(path) = path.finish() {
        pixmap.fill_path(&path, &paint(colour, 1.0), FillRule::Winding, Transform::identity(), None);
    }
}

fn path(runs: &[Vec<Point>], closed: bool) -> Option<Path> {
    let points = runs.iter().map(Vec::len).sum::<usize>();
    let mut path = PathBuilder::with_capacity(points + 2 * runs.len(), points + runs.len());
    for run in runs {
        let Some(&[x, y]) = run.first() else { continue };
        path.move_to(x as f32, y as f32);
        for &[x, y] in &run[1..] {
            path.line_to(x as f32, y as f32);
        }
        if closed {
            path.close();
        } else if run.len() == 1 {
            path.line_to(x as f32, y as f32);
        }
    }
    path.finish()
}

fn draw_path(pixmap: &mut Pixmap, path: Option<Path>, fill: Option<Rgb>, line: Option<&Line>) {
    let Some(path) = path else { return };
    if let Some(colour) = fill {
        pixmap.fill_path(&path, &paint(colour, 1.0), FillRule::EvenOdd, Transform::identity(), None);
    }
    if let Some(line) = line {
        let dash = line.dash.and_then(|dash| StrokeDash::new(vec![dash as f32; 2], 0.0));
        let stroke = Stroke {
            width: line.width as f32,
            line_cap: if dash.is_some() { LineCap::Butt } else { LineCap::Round },
            line_join: LineJoin::Round,
            dash,
            ..Stroke::default()
        };
        let paint = paint(line.colour, line.opacity);
        pixmap.stroke_path(&path, &paint, &stroke, Transform::identity(), None);
    }
}

fn paint(Rgb(r, g, b): Rgb, opacity: f64) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color_rgba8(r, g, b, (255.0 * opacity).round() as u8);
    paint
}
