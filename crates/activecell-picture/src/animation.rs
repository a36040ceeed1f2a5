//! Animations: the wave spreads, then the active cell moves along the route.
//!
//! A frame is put together from two canvases, one below and one above, and a few moving shapes.

use crate::colour::Rgb;
use crate::figure::Figure;
use crate::hills;
use crate::layout::{Layout, MOVING};
use crate::legend::Key;
use crate::marks::active_disc;
use crate::palette::{Palette, wave_tint};
use crate::raster;
use crate::reel::Reel;
use crate::route::{self, Route};
use crate::scene::Shape;
use crate::{Error, RoutePicture, Wave};
use activecell::{Cell, Map};
use tiny_skia::{Pixmap, PremultipliedColorU8};

const WAVE_FRAMES: u32 = 70;
const ROUTE_FRAMES: usize = 90;
/// How long frames stay, in hundredths of a second.
const WAVE_CS: u16 = 5;
const STEP_CS: u16 = 7;
/// A few steps are shown more slowly than many.
const SLOW_STEP_CS: u16 = 14;
const PAUSE_CS: u16 = 60;
const HOLD_CS: u16 = 200;
/// Smaller cells are not tinted as the active cell leaves them.
const TRAIL_PX: f64 = 4.0;

/// Makes the animation of a route.
pub(crate) fn gif(picture: &RoutePicture<'_>) -> Result<Vec<u8>, Error> {
    let figure = Figure::new(picture.map, picture.floor, picture.title, MOVING);
    let layout = &figure.layout;
    let drawn = Route::new(layout, picture);
    let mut keys = drawn.keys(picture.wave.is_some());
    if !picture.cells.is_empty() {
        keys.push(Key::Active);
    }
    keys.extend(figure.keys());
    let mut page = figure.page(&keys, Some(picture));
    page.shapes.push(figure.floor());
    page.shapes.extend(hills::tints(layout, picture.map));
    let mut stage = Stage { below: raster::draw(&page)?, above: raster::canvas(&page)? };
    raster::draw_shapes(&mut stage.above, &figure.fixed());

    let marks = route::marks(layout, picture);
    let mut film = Film::new(&stage.frame(&marks), PAUSE_CS, picture.map.elevation().is_some())?;
    if let Some(wave) = picture.wave {
        show_wave(&mut film, &mut stage, &figure, wave, &marks)?;
    }
    show_route(&mut film, &mut stage, &figure, picture, &marks)?;
    raster::draw_shapes(&mut stage.below, &drawn.tints());
    film.shoot(&stage.frame(&drawn.lines_and_marks()), HOLD_CS)?;
    film.finish()
}

/// The wave's levels, a few a frame, painted pixel by pixel: no seams, and maps of any size.
fn show_wave(
    film: &mut Film,
    stage: &mut Stage,
    figure: &Figure<'_>,
    wave: Wave<'_>,
    marks: &[Shape],
) -> Result<(), Error> {
    let Some(longest) = crate::farthest(figure.map, wave) else { return Ok(()) };
    let (columns, rows) = pixels(&figure.layout, &stage.below);
    let mut levels = Vec::new();
    for y in rows {
        for x in columns.clone() {
            if let Some(steps) = wave(figure.layout.cell_at(x, y)) {
                levels.push((steps, y * stage.below.width() + x));
            }
        }
    }
    levels.sort_unstable();
    let stride = (longest / WAVE_FRAMES).saturating_add(1);
    let mut rest = levels.as_slice();
    while let Some(&(steps, _)) = rest.first() {
        let reached = (steps / stride).saturating_add(1).saturating_mul(stride);
        let (now, later) = rest.split_at(rest.partition_point(|&(steps, _)| steps < reached));
        // The last level of all can be the largest number there is.
        let (now, later) = if now.is_empty() { (rest, &rest[..0]) } else { (now, later) };
        for &(steps, pixel) in now {
            stage.below.pixels_mut()[pixel as usize] = opaque(wave_tint(steps, longest));
        }
        rest = later;
        let delay = if rest.is_empty() { PAUSE_CS } else { WAVE_CS };
        film.shoot(&stage.frame(marks), delay)?;
    }
    Ok(())
}

/// The active cell moves along the route and leaves a tinted trail and the line.
fn show_route(
    film: &mut Film,
    stage: &mut Stage,
    figure: &Figure<'_>,
    picture: &RoutePicture<'_>,
    marks: &[Shape],
) -> Result<(), Error> {
    let layout = &figure.layout;
    let cells: Vec<Cell> = picture.cells.iter().copied().filter(|&cell| picture.map.contains(cell)).collect();
    let stride = cells.len().saturating_sub(1) / ROUTE_FRAMES + 1;
    let delay = if cells.len() <= ROUTE_FRAMES / 3 { SLOW_STEP_CS } else { STEP_CS };
    let radius = (layout.cell * 0.3).clamp(6.0, 14.0);
    let mut tinted = 0;
    for last in (0..cells.len()).step_by(stride) {
        for &cell in &cells[tinted..=last] {
            tint(stage, layout, picture.map, cell);
        }
        tinted = last + 1;
        let mut moving = route::line(layout, &cells[..=last], route::line_width(layout));
        moving.extend_from_slice(marks);
        moving.push(active_disc(layout.centre(cells[last]), radius));
        film.shoot(&stage.frame(&moving), delay)?;
    }
    Ok(())
}

fn tint(stage: &mut Stage, layout: &Layout, map: &Map, cell: Cell) {
    if layout.cell < TRAIL_PX || !map.is_free(cell) {
        return;
    }
    raster::draw_shapes(
        &mut stage.below,
        &[Shape::area(vec![layout.corners(cell)], crate::colour::BLUE_TINT)],
    );
}

/// Columns and rows of the pixels that can belong to the map.
fn pixels(layout: &Layout, canvas: &Pixmap) -> (std::ops::Range<u32>, std::ops::Range<u32>) {
    let range = |axis: usize, limit: u32| {
        let from = layout.origin[axis].floor().max(0.0) as u32;
        let to = (layout.origin[axis] + layout.map_size[axis]).ceil() as u32;
        from.min(limit)..to.min(limit)
    };
    (range(0, canvas.width()), range(1, canvas.height()))
}

fn opaque(Rgb(r, g, b): Rgb) -> PremultipliedColorU8 {
    tiny_skia::ColorU8::from_rgba(r, g, b, 0xff).premultiply()
}

/// What lies below the obstacles and changes, and what lies above and does not.
pub(crate) struct Stage {
    pub(crate) below: Pixmap,
    pub(crate) above: Pixmap,
}

impl Stage {
    /// The frame with these shapes on top.
    pub(crate) fn frame(&self, moving: &[Shape]) -> Pixmap {
        let mut frame = self.below.clone();
        for (pixel, above) in frame.data_mut().chunks_exact_mut(4).zip(self.above.data().chunks_exact(4)) {
            match above[3] {
                0 => {}
                0xff => pixel.copy_from_slice(above),
                alpha => {
                    for (below, &above) in pixel.iter_mut().zip(above) {
                        let shining = u32::from(*below) * u32::from(0xff - alpha);
                        *below = above.saturating_add(((shining + 127) / 255) as u8);
                    }
                }
            }
        }
        raster::draw_shapes(&mut frame, moving);
        frame
    }
}

/// The file as it is written, in the pictures' own palette.
pub(crate) struct Film {
    palette: Palette,
    reel: Reel,
}

impl Film {
    /// A film whose first frame covers all of it.
    pub(crate) fn new(first: &Pixmap, delay_cs: u16, uneven: bool) -> Result<Self, Error> {
        let mut palette = Palette::new(uneven);
        let numbers = palette.numbers(first);
        let reel = Reel::new(numbers, [first.width(), first.height()], delay_cs, &palette.bytes())?;
        Ok(Self { palette, reel })
    }

    /// Adds a frame.
    pub(crate) fn shoot(&mut self, frame: &Pixmap, delay_cs: u16) -> Result<(), Error> {
        let numbers = self.palette.numbers(frame);
        self.reel.shoot(&numbers, delay_cs)
    }

    pub(crate) fn finish(self) -> Result<Vec<u8>, Error> {
        self.reel.finish()
    }
}
