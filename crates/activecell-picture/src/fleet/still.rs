//! Still pictures of a group: the ways of a few robots, the traffic of many.

use super::{FleetPicture, FleetView, title};
use crate::colour::{Rgb, traffic};
use crate::figure::Figure;
use crate::ink;
use crate::layout::{Layout, STILL};
use crate::legend::Key;
use crate::marks::{robot_start, robot_target};
use crate::route::simplified;
use crate::scene::{Line, Point, Scene, Shape};
use activecell::{Cell, Map, Plan};
use tiny_skia::{ColorU8, Pixmap};

/// More robots, or smaller cells in pixels, and single ways cannot be told apart.
const MOST_WAYS: usize = 200;
const LEAST_WAY_PX: f64 = 6.0;
/// How far apart ways through the same cell may be, in cells.
const SPREAD: f64 = 0.56;
/// Larger cells, in pixels, are drawn as shapes, smaller ones as an image.
const SHAPE_PX: f64 = 8.0;
/// The share of the entered cells that the scale of the traffic tells apart.
const ON_SCALE: f64 = 0.99;

pub(super) fn scene(picture: &FleetPicture<'_>) -> Scene {
    let title = title(picture);
    let figure = Figure::new(picture.map, None, &title, STILL);
    let ways = match picture.view {
        FleetView::Ways => true,
        FleetView::Traffic => false,
        FleetView::Fitting => picture.plan.robots() <= MOST_WAYS && figure.layout.cell >= LEAST_WAY_PX,
    };
    let mut shapes = vec![figure.floor()];
    let mut keys;
    if ways {
        let end = if picture.endless { Key::RobotEnd } else { Key::RobotTarget };
        keys = vec![Key::RobotStart, end, Key::RobotWay];
        shapes.extend(figure.fixed());
        shapes.extend(marks_and_ways(&figure.layout, picture));
    } else {
        let traffic = Traffic::new(picture.map, picture.plan);
        keys = traffic.most.map(Key::Traffic).into_iter().collect();
        shapes.extend(traffic.shapes(&figure));
        shapes.extend(figure.fixed());
    }
    keys.extend(figure.keys());
    let mut scene = figure.page(&keys, None);
    scene.shapes.splice(1..1, shapes);
    scene
}

/// Starts below, then the ways, then the targets.
fn marks_and_ways(layout: &Layout, picture: &FleetPicture<'_>) -> Vec<Shape> {
    let (map, plan) = (picture.map, picture.plan);
    let hues = ink::hues(map, picture.team.targets());
    let robots = plan.robots().min(hues.len());
    let on_map = |cell: Cell| map.contains(cell).then(|| layout.centre(cell));
    let mut shapes = Vec::new();
    for (robot, &hue) in hues.iter().enumerate().take(robots) {
        shapes.extend(
            on_map(picture.team.starts()[robot]).map(|at| robot_start(at, layout.cell, ink::hue(hue))),
        );
    }
    let width = (layout.cell * 0.085).clamp(1.0, 3.0);
    for (robot, &hue) in hues.iter().enumerate().take(robots) {
        let [dx, dy] = beside(robot, layout.cell);
        let middles: Vec<Point> =
            (0..=plan.steps()).filter_map(|step| on_map(plan.at(step, robot))).collect();
        if let (Some(&first), Some(&last)) = (middles.first(), middles.last()) {
            // From the middle of the first cell to that of the last.
            let beside = middles.iter().map(|[x, y]| [x + dx, y + dy]);
            let points: Vec<Point> = std::iter::once(first).chain(beside).chain([last]).collect();
            let line = Line { opacity: 0.7, ..Line::new(ink::hue(hue), width) };
            shapes.push(Shape::lines(vec![simplified(&points)], line));
        }
    }
    for (&cell, &hue) in picture.team.targets().iter().zip(&hues) {
        shapes.extend(on_map(cell).map(|at| robot_target(at, layout.cell, ink::hue(hue))));
    }
    shapes
}

/// Where a robot's way lies beside the middles of cells: spread evenly, by Martin Roberts's R2 sequence (*The
/// unreasonable effectiveness of quasirandom sequences*, 2018).
fn beside(robot: usize, cell: f64) -> Point {
    [0.754_877_666_246_693, 0.569_840_290_998_053]
        .map(|share| ((0.5 + share * robot as f64).fract() - 0.5) * SPREAD * cell)
}

/// How often robots enter each cell.
struct Traffic {
    visits: Vec<u32>,
    /// What the darkest tint means, or more; `None` if nobody moves.
    most: Option<u32>,
}

impl Traffic {
    fn new(map: &Map, plan: &Plan) -> Self {
        let mut visits = vec![0; map.cells()];
        for step in 1..=plan.steps() {
            for (&before, &now) in plan.row(step - 1).iter().zip(plan.row(step)) {
                if let Some(cell) = map.index(now).filter(|_| now != before) {
                    visits[cell] += 1;
                }
            }
        }
        let mut entered: Vec<u32> = visits.iter().copied().filter(|&visits| visits > 0).collect();
        entered.sort_unstable();
        let last = (ON_SCALE * entered.len() as f64).ceil() as usize;
        let most = entered.get(last.saturating_sub(1)).copied();
        Self { visits, most }
    }

    /// The tint of a cell, counted from 1.
    fn tint(&self, map: &Map, cell: Cell) -> Option<u8> {
        let visits = self.visits[map.index(cell)?];
        let tint = traffic::tint(visits, self.most?);
        (visits > 0).then_some(tint)
    }

    fn shapes(&self, figure: &Figure<'_>) -> Vec<Shape> {
        let map = figure.map;
        if figure.layout.cell < SHAPE_PX {
            return self.image(&figure.layout, map).into_iter().collect();
        }
        figure.bands(traffic::TINTS, |cell| self.tint(map, cell), traffic::colour)
    }

    /// The tints pixel by pixel. Where cells are smaller than pixels, the busiest shows.
    fn image(&self, layout: &Layout, map: &Map) -> Option<Shape> {
        let [width, height] = layout.map_size.map(|size| size.ceil() as u32 + 1);
        let at = layout.origin.map(f64::floor);
        let mut tints = vec![0; width as usize * height as usize];
        for (pixel, tint) in tints.iter_mut().enumerate() {
            let (x, y) = (pixel as u32 % width, pixel as u32 / width);
            let cell = layout.cell_at(at[0] as u32 + x, at[1] as u32 + y);
            *tint = self.tint(map, cell).unwrap_or(0);
        }
        for cell in map.free() {
            let [x, y] = layout.centre(cell);
            let pixel = (y - at[1]) as usize * width as usize + (x - at[0]) as usize;
            tints[pixel] = tints[pixel].max(self.tint(map, cell).unwrap_or(0));
        }
        let mut pixels = Pixmap::new(width, height)?;
        for (pixel, tint) in pixels.pixels_mut().iter_mut().zip(tints).filter(|&(_, tint)| tint > 0) {
            let Rgb(r, g, b) = traffic::colour(tint);
            *pixel = ColorU8::from_rgba(r, g, b, 0xff).premultiply();
        }
        Some(Shape::Image { at, pixels })
    }
}
