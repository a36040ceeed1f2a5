//! The marks of all pictures, which the legend shows too.

use crate::colour::{GREEN, ORANGE, ORANGE_RIM, PAGE, Rgb, VERMILLION, YELLOW};
use crate::ink::{hue, tint};
use crate::scene::{Line, Point, Shape};

/// A disc with an S.
pub(crate) fn start_mark(shapes: &mut Vec<Shape>, centre: Point, radius: f64) {
    let line = Some(Line::new(PAGE, 1.6));
    shapes.push(Shape::Disc { centre, radius, fill: GREEN, line });
    shapes.push(Shape::label(centre, radius * 1.2, true, PAGE, "S".into()));
}

/// A rounded square with an F.
pub(crate) fn target_mark(shapes: &mut Vec<Shape>, [x, y]: Point, radius: f64) {
    let round = radius * 0.25;
    let a = radius * 0.94 - round;
    let square = vec![vec![[x - a, y - a], [x + a, y - a], [x + a, y + a], [x - a, y + a]]];
    for (colour, width) in [(PAGE, 2.0 * round + 1.6), (VERMILLION, 2.0 * round)] {
        let line = Some(Line::new(colour, width));
        shapes.push(Shape::Path { runs: square.clone(), closed: true, fill: Some(colour), line });
    }
    shapes.push(Shape::label([x, y], radius * 1.2, true, PAGE, "F".into()));
}

/// The dot of a turn.
pub(crate) fn turn_dot(centre: Point, radius: f64) -> Shape {
    let line = Some(Line::new(ORANGE_RIM, (radius * 0.3).clamp(0.6, 1.2)));
    Shape::Disc { centre, radius, fill: ORANGE, line }
}

/// Lines from lower left to upper right through a convex shape, so far apart.
pub(crate) fn hatching(corners: &[Point], step: f64) -> Vec<Vec<Point>> {
    let heights = corners.iter().map(|&[x, y]| x + y);
    let (low, high) =
        heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)));
    let mut runs = Vec::new();
    let mut at = (low / step).floor() * step + step;
    while at < high {
        let mut run: Vec<Point> = Vec::new();
        for (i, a) in corners.iter().enumerate() {
            let b = corners[(i + 1) % corners.len()];
            let (from, to) = (a[0] + a[1] - at, b[0] + b[1] - at);
            if (from < 0.0) != (to < 0.0) {
                let share = from / (from - to);
                run.push([a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])]);
            }
        }
        if run.len() == 2 {
            runs.push(run);
        }
        at += step;
    }
    runs
}

/// A cross on white.
pub(crate) fn contact(shapes: &mut Vec<Shape>, [x, y]: Point, arm: f64) {
    let runs =
        vec![vec![[x - arm, y - arm], [x + arm, y + arm]], vec![[x - arm, y + arm], [x + arm, y - arm]]];
    shapes.push(Shape::lines(runs.clone(), Line::new(PAGE, 0.9 * arm)));
    shapes.push(Shape::lines(runs, Line::new(VERMILLION, 0.45 * arm)));
}

/// The cell that is active now.
pub(crate) fn active_disc(centre: Point, radius: f64) -> Shape {
    Shape::Disc { centre, radius, fill: YELLOW, line: Some(Line::new(ORANGE_RIM, (radius * 0.2).max(1.4))) }
}

/// Three robots side by side, for the legend.
pub(crate) fn three_robots(shapes: &mut Vec<Shape>, [x, y]: Point, size: f64, at_rest: bool) {
    let radius = 0.42 * size;
    for (i, number) in [1, 8, 15].into_iter().enumerate() {
        let centre = [x + (0.5 + 0.95 * i as f64) * size, y];
        let (fill, rim) = if at_rest { (tint(number, 2), 0.28 * radius) } else { (hue(number), 0.0) };
        let line = (rim > 0.0).then(|| Line::new(hue(number), rim));
        shapes.push(Shape::Disc { centre, radius: radius - rim / 2.0, fill, line });
    }
}

/// A hollow disc: a robot starts here.
pub(crate) fn robot_start(centre: Point, cell: f64, colour: Rgb) -> Shape {
    let line = Some(Line::new(colour, (cell * 0.09).clamp(1.2, 3.0)));
    Shape::Disc { centre, radius: 0.33 * cell, fill: PAGE, line }
}

/// A full disc: a robot's target.
pub(crate) fn robot_target(centre: Point, cell: f64, colour: Rgb) -> Shape {
    Shape::Disc { centre, radius: 0.26 * cell, fill: colour, line: Some(Line::new(PAGE, 1.2)) }
}
