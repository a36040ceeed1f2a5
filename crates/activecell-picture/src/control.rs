//! The control unit's states and what leads from one to another: the paper's figure 1.

use crate::colour::{BLUE, BLUE_TINT, EDGE, FLOOR, GREEN, OBSTACLE, PAGE, Rgb, TEXT, VERMILLION};
use crate::scene::{Line, Point, Scene, Shape, Text};
use activecell::control::State;

const SIZE: Point = [900.0, 500.0];
const NODE: Point = [128.0, 58.0];
/// The box around the four moving states: left, top, right, bottom.
const MOVING: [f64; 4] = [310.0, 60.0, 630.0, 420.0];

/// Where a state stands.
const fn place(state: State) -> Point {
    match state {
        State::Calm => [120.0, 240.0],
        State::Forward => [470.0, 130.0],
        State::Left => [395.0, 240.0],
        State::Right => [545.0, 240.0],
        State::Reverse => [470.0, 350.0],
        State::Stopped => [780.0, 240.0],
    }
}

/// The scene of the state graph.
pub(crate) fn scene() -> Scene {
    let [left, top, right, bottom] = MOVING;
    let page = vec![[0.0, 0.0], [SIZE[0], 0.0], SIZE, [0.0, SIZE[1]]];
    let moving = vec![[left, top], [right, top], [right, bottom], [left, bottom]];
    let mut shapes = vec![Shape::area(vec![page], PAGE)];
    let line = Some(Line { dash: Some(6.0), ..Line::new(EDGE, 1.4) });
    shapes.push(Shape::Path { runs: vec![moving], closed: true, fill: Some(FLOOR), line });
    text(&mut shapes, [470.0, top + 22.0], "moving: the first row of the table that matches");
    let motions = [State::Forward, State::Left, State::Right, State::Reverse];
    for (i, &a) in motions.iter().enumerate() {
        for &b in &motions[i + 1..] {
            shapes.push(Shape::lines(vec![vec![place(a), place(b)]], Line::new(EDGE, 2.0)));
        }
    }
    let calm_right = place(State::Calm)[0] + NODE[0] / 2.0;
    let stopped_left = place(State::Stopped)[0] - NODE[0] / 2.0;
    arrow(&mut shapes, &[[calm_right, 222.0], [left, 222.0]]);
    text(&mut shapes, [247.0, 196.0], "task: g0 or g7");
    text(&mut shapes, [247.0, 212.0], "without g6");
    arrow(&mut shapes, &[[left, 258.0], [calm_right, 258.0]]);
    text(&mut shapes, [247.0, 280.0], "no task,");
    text(&mut shapes, [247.0, 296.0], "or boxed in");
    arrow(&mut shapes, &[[right, 240.0], [stopped_left, 240.0]]);
    text(&mut shapes, [673.0, 230.0], "g6: stop");
    let below = place(State::Calm)[1] + NODE[1] / 2.0;
    let (calm_x, stopped_x) = (place(State::Calm)[0], place(State::Stopped)[0]);
    arrow(&mut shapes, &[[stopped_x, below], [stopped_x, 458.0], [calm_x, 458.0], [calm_x, below]]);
    text(&mut shapes, [470.0, 450.0], "one step later, whatever is asked");
    for state in State::ALL {
        node(&mut shapes, state);
    }
    let description = "From calm a task leads to one of four motions, which change among each other; stop leads from a motion to stopped, and stopped to calm.";
    let title = "The control unit".to_owned();
    shapes.push(Shape::Text(Text {
        at: [24.0, 34.0],
        size: 17.0,
        centred: false,
        bold: true,
        colour: TEXT,
        content: "The control unit: six states, eight inputs, outputs q0 q1 q2 q3".to_owned(),
    }));
    Scene { width: SIZE[0], height: SIZE[1], title, description: description.to_owned(), shapes }
}

fn colours(state: State) -> (Rgb, Rgb) {
    match state {
        State::Calm => (GREEN, PAGE),
        State::Stopped => (VERMILLION, PAGE),
        _ => (BLUE, BLUE_TINT),
    }
}

/// A state's name and its outputs in a box.
fn node(shapes: &mut Vec<Shape>, state: State) {
    let [x, y] = place(state);
    let [w, h] = NODE.map(|side| side / 2.0);
    let (edge, fill) = colours(state);
    let corners = vec![[x - w, y - h], [x + w, y - h], [x + w, y + h], [x - w, y + h]];
    let line = Some(Line::new(edge, 2.4));
    shapes.push(Shape::Path { runs: vec![corners], closed: true, fill: Some(fill), line });
    shapes.push(Shape::label([x, y - 10.0], 15.0, true, TEXT, state.name().to_owned()));
    let outputs = state.outputs().map(|q| if q { "1" } else { "0" }).join(" ");
    shapes.push(Shape::label([x, y + 13.0], 14.0, false, OBSTACLE, outputs));
}

/// A line with a head at its end.
fn arrow(shapes: &mut Vec<Shape>, points: &[Point]) {
    let [.., before, end] = points else { return };
    let (dx, dy) = (end[0] - before[0], end[1] - before[1]);
    let length = dx.hypot(dy).max(1e-9);
    let (ux, uy) = (dx / length, dy / length);
    let back = [end[0] - 12.0 * ux, end[1] - 12.0 * uy];
    let head = vec![*end, [back[0] - 6.0 * uy, back[1] + 6.0 * ux], [back[0] + 6.0 * uy, back[1] - 6.0 * ux]];
    let mut run = points.to_vec();
    let last = run.len() - 1;
    run[last] = back;
    shapes.push(Shape::lines(vec![run], Line::new(OBSTACLE, 2.0)));
    shapes.push(Shape::area(vec![head], OBSTACLE));
}

fn text(shapes: &mut Vec<Shape>, middle: Point, content: &str) {
    shapes.push(Shape::label(middle, 13.0, false, TEXT, content.to_owned()));
}
