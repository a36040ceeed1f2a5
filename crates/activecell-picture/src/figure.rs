//! The figure: page, title, floor, obstacles, wave and footer, put together into a scene.

use crate::colour::{self, CLOSED, EDGE, FLOOR, GRID, OBSTACLE, PAGE, TEXT};
use crate::font;
use crate::hills;
use crate::layout::{Layout, Style};
use crate::legend::{self, Key};
use crate::outline;
use crate::route;
use crate::sample::Sampled;
use crate::scene::{Line, Point, Scene, Shape, Text, printable};
use crate::{RoutePicture, Wave};
use activecell::{Cell, Lattice, Map};
use std::fmt::Write;

/// Cells of at least so many pixels are told apart by thin lines.
const GRID_PX: f64 = 8.0;
/// The wave's tints in a still picture.
const BANDS: u8 = 12;

/// A map on its page.
pub(crate) struct Figure<'a> {
    pub(crate) map: &'a Map,
    /// The floor that the map was made of, if its walls are to be seen.
    behind: Option<&'a Map>,
    pub(crate) layout: Layout,
    title: String,
    sampled: Sampled<'a>,
}

impl<'a> Figure<'a> {
    pub(crate) fn new(map: &'a Map, behind: Option<&'a Map>, title: &str, style: Style) -> Self {
        let title = printable(title);
        let layout = Layout::new(map, &title, style);
        let sampled = Sampled::for_drawing(map, layout.cell);
        Self { map, behind, layout, title, sampled }
    }

    /// The scene of a still picture, with a route or without.
    pub(crate) fn still(&self, picture: Option<&RoutePicture<'_>>) -> Scene {
        let mut keys = Vec::new();
        let mut shapes = vec![self.floor()];
        shapes.extend(hills::tints(&self.layout, self.map));
        let mut above = Vec::new();
        if let Some(picture) = picture {
            let drawn = route::Route::new(&self.layout, picture);
            // On uneven ground the tints show its height.
            let wave = picture.wave.filter(|_| self.map.elevation().is_none());
            if let Some(wave) = wave {
                shapes.extend(self.wave(wave));
            }
            shapes.extend(drawn.tints());
            above = drawn.lines_and_marks();
            keys = drawn.keys(wave.is_some());
        }
        keys.extend(self.keys());
        shapes.extend(self.fixed());
        shapes.extend(above);
        let mut scene = self.page(&keys, picture);
        scene.shapes.splice(1..1, shapes);
        scene
    }

    /// The page: its background, then title and footer.
    pub(crate) fn page(&self, keys: &[Key], picture: Option<&RoutePicture<'_>>) -> Scene {
        let Layout { style, title_size, origin, map_size, width, .. } = self.layout;
        let bottom = (origin[1] + map_size[1]).ceil() + style.margin * 0.75;
        let (footer, height) = legend::footer(&self.layout, self.map, keys, bottom);
        let height = (bottom + height + style.margin * 0.75).ceil();
        let corners = vec![[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]];
        let mut shapes = vec![Shape::area(vec![corners], PAGE)];
        shapes.push(Shape::Text(Text {
            at: [style.margin, style.margin + style.title_size * 0.9],
            size: title_size,
            centred: false,
            bold: true,
            colour: TEXT,
            content: font::shorten(&self.title, title_size, true, width - 2.0 * style.margin),
        }));
        shapes.extend(footer);
        Scene { width, height, title: self.title.clone(), description: self.describe(picture), shapes }
    }

    /// What a reader who does not see the picture should know.
    fn describe(&self, picture: Option<&RoutePicture<'_>>) -> String {
        let map = self.map;
        let lattice = match map.lattice() {
            Lattice::Square => "square",
            Lattice::Hex => "hexagonal",
        };
        let (width, height) = (map.width(), map.height());
        let obstacles = map.cells() - map.free_cells();
        let mut text = format!("Map of {width} × {height} {lattice} cells, {obstacles} of them obstacles.");
        if let Some(picture) = picture {
            // Writing to a string cannot fail.
            let steps = picture.cells.len().saturating_sub(1);
            let (from, to, turns) = (picture.from, picture.to, picture.turns.len());
            let _ = write!(text, " Route from cell {from} to cell {to}: {steps} steps, {turns} turns.");
            if !picture.cycle.is_empty() {
                let _ = write!(text, " The robot is trapped in a circle of {} cells.", picture.cycle.len());
            }
        }
        text
    }

    /// What the legend says of the map itself.
    pub(crate) fn keys(&self) -> impl Iterator<Item = Key> {
        let walls = self.behind.unwrap_or(self.map);
        let obstacle = has_obstacles(walls).then_some(Key::Obstacle);
        let closed = (self.behind.is_some() && has_obstacles(self.map)).then_some(Key::Closed);
        let height = self.map.elevation().map(|_| Key::Height);
        height.into_iter().chain(obstacle).chain(closed)
    }

    /// The floor, under everything.
    pub(crate) fn floor(&self) -> Shape {
        Shape::area(self.traced(|_| true), FLOOR)
    }

    /// What lies above tints and does not change: grid, obstacles, the floor's edge.
    pub(crate) fn fixed(&self) -> Vec<Shape> {
        let mut shapes: Vec<Shape> = hills::shading(&self.layout, self.map).into_iter().collect();
        // Light and shadow are to be seen, not lines across them.
        if self.layout.cell >= GRID_PX && self.map.elevation().is_none() {
            shapes.push(Shape::lines(self.grid(), Line::new(GRID, 1.0)));
        }
        if has_obstacles(self.map) {
            let colour = if self.behind.is_some() { CLOSED } else { OBSTACLE };
            shapes.push(Shape::area(self.traced(|cell| self.sampled.is_obstacle(cell)), colour));
        }
        let line = Some(Line::new(EDGE, 1.0));
        shapes.push(Shape::Path { runs: self.traced(|_| true), closed: true, fill: None, line });
        shapes.extend(self.behind.map(|floor| Shape::area(self.walls(floor), OBSTACLE)));
        shapes
    }

    fn traced(&self, inside: impl Fn(Cell) -> bool) -> Vec<Vec<Point>> {
        let sampled = &self.sampled;
        let loops = outline::trace(sampled.lattice, sampled.width(), sampled.height(), inside);
        self.layout.loops(sampled, &loops)
    }

    /// The outlines of what is occupied on the floor itself, over the cells that were made of it.
    fn walls(&self, floor: &Map) -> Vec<Vec<Point>> {
        let sampled =
            Sampled::for_drawing(floor, self.layout.cell * floor.frame().cell_m / self.map.frame().cell_m);
        let loops = outline::trace(sampled.lattice, sampled.width(), sampled.height(), |cell| {
            sampled.is_obstacle(cell)
        });
        let corner = |&(x, y): &(i64, i64)| {
            // The corners of pixels come in half pixels from the top left.
            let half = f64::from(sampled.block) * floor.frame().cell_m / 2.0;
            let [width_m, height_m] = floor.size_m();
            let local = [(x as f64 * half).min(width_m), (height_m - y as f64 * half).max(0.0)];
            self.layout.floor_point(self.map, floor.frame().to_floor(local))
        };
        loops.iter().map(|corners| corners.iter().map(corner).collect()).collect()
    }

    /// The lines between cells, as long as they can be. The map's own edge is drawn elsewhere.
    fn grid(&self) -> Vec<Vec<Point>> {
        let (width, height) = (i64::from(self.map.width()), i64::from(self.map.height()));
        let point = |x, y| self.layout.point((x, y));
        if self.layout.lattice == Lattice::Square {
            let down = (1..width).map(|x| vec![point(2 * x, 0), point(2 * x, 2 * height)]);
            let across = (1..height).map(|y| vec![point(0, 2 * y), point(2 * width, 2 * y)]);
            return down.chain(across).collect();
        }
        let mut runs = Vec::new();
        for y in 0..height {
            let shift = y & 1;
            runs.extend((1..width).map(|x| {
                let x = 2 * x + shift;
                vec![point(x, 3 * y + 1), point(x, 3 * y + 3)]
            }));
            if y > 0 {
                // The zigzag between this row and the one above, over the length that they share.
                let tooth = |x: i64| point(x, if (x + shift) % 2 == 0 { 3 * y + 1 } else { 3 * y });
                runs.push((1..=2 * width).map(tooth).collect());
            }
        }
        runs
    }

    /// The cells that the wave reached, in bands from near to far.
    fn wave(&self, wave: Wave<'_>) -> Vec<Shape> {
        let Some(longest) = crate::farthest(self.map, wave) else { return Vec::new() };
        let bands = u32::from(BANDS).min(longest.saturating_add(1)) as u8;
        let band = |steps: u32| 1 + (u64::from(steps) * u64::from(bands) / (u64::from(longest) + 1)) as u8;
        let share = |band: u8| f64::from(band - 1) / f64::from((bands - 1).max(1));
        self.bands(bands, |cell| wave(cell).map(band), |band| colour::wave(share(band)))
    }

    /// Cells in bands, counted from 1, each of its colour.
    pub(crate) fn bands(
        &self,
        bands: u8,
        band: impl Fn(Cell) -> Option<u8>,
        colour: impl Fn(u8) -> colour::Rgb,
    ) -> Vec<Shape> {
        let levels = self.levels(band);
        let width = self.sampled.width() as usize;
        let level = |cell: Cell| levels[cell.y as usize * width + cell.x as usize];
        // Each band lies on the one before, which reaches below it: no seam between them.
        (1..=bands).map(|band| Shape::area(self.traced(|cell| level(cell) >= band), colour(band))).collect()
    }

    /// The band of every block, 0 for none. Obstacles, which will cover it, get a neighbour's band: the
    /// outlines of the bands then need not go around every obstacle.
    fn levels(&self, band: impl Fn(Cell) -> Option<u8>) -> Vec<u8> {
        let (width, height) = (self.sampled.width() as usize, self.sampled.height() as usize);
        let cell = |i: usize| Cell::new((i % width) as i32, (i / width) as i32);
        let mut levels: Vec<u8> =
            (0..width * height).map(|i| self.sampled.first(self.map, cell(i), &band).unwrap_or(0)).collect();
        let hidden = |levels: &[u8], i: usize| levels[i] == 0 && self.sampled.is_obstacle(cell(i));
        for i in 0..levels.len() {
            if hidden(&levels, i) {
                let left = if i % width > 0 { levels[i - 1] } else { 0 };
                let above = if i >= width { levels[i - width] } else { 0 };
                levels[i] = if left > 0 { left } else { above };
            }
        }
        for i in (0..levels.len()).rev() {
            if hidden(&levels, i) {
                let right = if (i + 1) % width > 0 { levels[i + 1] } else { 0 };
                let below = if i + width < levels.len() { levels[i + width] } else { 0 };
                levels[i] = if right > 0 { right } else { below };
            }
        }
        levels
    }
}

fn has_obstacles(map: &Map) -> bool {
    map.free_cells() < map.cells()
}
