//! Closed cells over time: the same floor once for each slot.

use crate::colour::{BLUE, EDGE, FLOOR, OBSTACLE, ORANGE, PAGE, Rgb, TEXT, VERMILLION};
use crate::outline;
use crate::scene::{Line, Point, Scene, Shape, Text};
use activecell::predict::{Closures, Plan};
use activecell::{Cell, Map};

const MARGIN: f64 = 24.0;
const HEAD: f64 = 62.0;
const GAP: f64 = 34.0;
/// The width of a floor.
const FLOOR_PX: f64 = 400.0;
const ACROSS: usize = 2;

/// The scene of the first `slots` slots of a plan.
pub(crate) fn scene(map: &Map, closures: &Closures, plan: &Plan, slots: usize) -> Scene {
    let [width_m, height_m] = map.size_m();
    let scale = FLOOR_PX / width_m;
    let panel = [FLOOR_PX, height_m * scale];
    let slots = slots.min(closures.slots()).min(plan.cells().len() - 1);
    let down = slots.div_ceil(ACROSS) as f64;
    let width = 2.0 * MARGIN + ACROSS as f64 * panel[0] + (ACROSS as f64 - 1.0) * GAP;
    let height = HEAD + down * (panel[1] + GAP) + 8.0;
    let page = vec![[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]];
    let mut shapes = vec![Shape::area(vec![page], PAGE)];
    let text = |at: Point, bold: bool, content: String| {
        let size = if bold { 17.0 } else { 13.0 };
        Shape::Text(Text { at, size, centred: false, bold, colour: TEXT, content })
    };
    shapes.push(text([MARGIN, 30.0], true, "Closed cells, slot by slot".to_owned()));
    let keys = [(tint(VERMILLION), "can be reached"), (tint(ORANGE), "likely"), (BLUE, "robot")];
    for ((colour, label), x) in keys.into_iter().zip([width - 300.0, width - 166.0, width - 82.0]) {
        shapes.push(Shape::Disc { centre: [x, 25.0], radius: 6.5, fill: colour, line: None });
        shapes.push(text([x + 12.0, 30.0], false, label.to_owned()));
    }
    for slot in 0..slots {
        let corner = [
            MARGIN + (slot % ACROSS) as f64 * (panel[0] + GAP),
            HEAD + (slot / ACROSS) as f64 * (panel[1] + GAP),
        ];
        shapes.push(text([corner[0], corner[1] - 6.0], false, format!("slot {}", slot + 1)));
        floor(&mut shapes, map, closures, slot, corner, scale);
        let [from, to] = [plan.cells()[slot], plan.cells()[slot + 1]];
        let [a, b] = [from, to].map(|cell| place(map, map.lattice().centre(cell), corner, scale));
        shapes.push(Shape::lines(vec![vec![a, b]], Line::new(BLUE, 5.0)));
        let line = Some(Line::new(PAGE, 1.5));
        shapes.push(Shape::Disc { centre: b, radius: 0.26 * scale * map.frame().cell_m, fill: BLUE, line });
    }
    Scene {
        width,
        height,
        title: "Closed cells, slot by slot".to_owned(),
        description: "For each slot the floor, the cells that moving objects can reach or are likely to be in, and the robot's step.".to_owned(),
        shapes,
    }
}

fn tint(colour: Rgb) -> Rgb {
    colour.mix(PAGE, 0.45)
}

fn floor(shapes: &mut Vec<Shape>, map: &Map, closures: &Closures, slot: usize, corner: Point, scale: f64) {
    let area = |inside: &dyn Fn(Cell) -> bool| -> Vec<Vec<Point>> {
        let loops = outline::trace(map.lattice(), map.width(), map.height(), inside);
        loops
            .into_iter()
            .map(|run| run.into_iter().map(|at| place(map, at, corner, scale)).collect())
            .collect()
    };
    let reach = |cell: Cell| map.is_free(cell) && closures.is_closed(slot, cell, None);
    let likely = |cell: Cell| map.is_free(cell) && closures.is_likely_closed(slot, cell, None);
    let layers: [(&dyn Fn(Cell) -> bool, Rgb); 4] = [
        (&|_| true, OBSTACLE),
        (&|cell| map.is_free(cell), FLOOR),
        (&reach, tint(VERMILLION)),
        (&likely, tint(ORANGE)),
    ];
    for (inside, colour) in layers {
        shapes.push(Shape::area(area(inside), colour));
    }
    let lattice = map.lattice();
    let edges = map.free().map(|cell| {
        let (x, y) = lattice.centre(cell);
        let corners = lattice.corners().iter().chain(lattice.corners().first());
        corners.map(|c| place(map, (x + c.0, y + c.1), corner, scale)).collect()
    });
    shapes.push(Shape::lines(edges.collect(), Line::new(EDGE, 0.6)));
}

/// Where a point of the lattice lies on the page.
fn place(map: &Map, (x, y): (i64, i64), corner: Point, scale: f64) -> Point {
    let (ux, uy) = map.lattice().unit_m();
    let px = scale * map.frame().cell_m;
    [corner[0] + x as f64 * ux * px, corner[1] + y as f64 * uy * px]
}
