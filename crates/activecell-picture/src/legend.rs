//! The footer: scale bar and legend, in as many rows as they need.

use crate::colour::{
    self, BLUE, BLUE_TINT, CLOSED, EDGE, GREEN, OBSTACLE, ORANGE, PAGE, PURPLE, PURPLE_TINT, Rgb, TEXT,
    VERMILLION, traffic,
};
use crate::font;
use crate::ink;
use crate::layout::{Layout, round_length};
use crate::marks;
use crate::region;
use crate::scene::{Line, Point, Shape, Text};
use activecell::{Elevation, Map};

/// Something that the legend explains.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Key {
    Start,
    Target,
    Route,
    Turn,
    Trapped,
    Region,
    Active,
    Wave,
    Obstacle,
    Closed,
    Height,
    Planned,
    Driven,
    Believed,
    Ends,
    Contact,
    Found,
    Beam,
    Mover,
    Expected,
    RobotStart,
    RobotTarget,
    RobotEnd,
    RobotWay,
    Robot,
    RobotGoingOn,
    RobotAtRest,
    TargetCell,
    /// The visits to the busiest cells.
    Traffic(u32),
}

/// Swatches of the wave's colours.
const SWATCHES: usize = 16;

impl Key {
    fn label(self, map: &Map) -> String {
        let label = match self {
            Self::Start | Self::RobotStart => "start",
            Self::Target | Self::RobotTarget | Self::TargetCell => "target",
            Self::Route => "route",
            Self::Turn => "turn",
            Self::Trapped => "trapped",
            Self::Region => "where it is, 95 %",
            Self::Active => "active cell",
            Self::Wave => "wave, near to far",
            Self::Obstacle => "obstacle",
            Self::Closed => "no room",
            Self::Planned => "planned",
            Self::Driven => "driven",
            Self::Believed => "believed",
            Self::Ends => "ends of drives",
            Self::Contact => "contact",
            Self::Found => "found obstacle",
            Self::Beam => "beams",
            Self::Mover => "walker",
            Self::Expected => "expected there",
            Self::RobotEnd => "at the end",
            Self::RobotWay => "way",
            Self::Robot => "robot, in its target's colour",
            Self::RobotGoingOn => "robot, coloured by where it is at the end",
            Self::RobotAtRest => "at its target",
            Self::Height => return heights(map),
            Self::Traffic(most) => return format!("visits a cell: 1 to {most} or more"),
        };
        label.to_owned()
    }

    /// Width of the icon, in multiples of the text's size.
    const fn icon_width(self) -> f64 {
        match self {
            Self::Route
            | Self::Trapped
            | Self::Region
            | Self::Planned
            | Self::Driven
            | Self::Believed
            | Self::Beam
            | Self::RobotWay => 2.0,
            Self::Robot | Self::RobotGoingOn | Self::RobotAtRest => 2.9,
            Self::Wave | Self::Height => 4.0,
            Self::Traffic(_) => 8.0,
            Self::Turn => 0.8,
            _ => 1.2,
        }
    }

    /// Draws the icon about (x + width / 2, y).
    fn icon(self, shapes: &mut Vec<Shape>, [x, y]: Point, size: f64) {
        let width = self.icon_width() * size;
        let middle = [x + width / 2.0, y];
        let band = |shapes: &mut Vec<Shape>, fill, line: Line| {
            shapes.push(Shape::area(vec![rectangle(x, y - 0.5 * size, width, size)], fill));
            shapes.push(Shape::lines(vec![vec![[x + 3.0, y], [x + width - 3.0, y]]], line));
        };
        match self {
            Self::Start => marks::start_mark(shapes, middle, 0.62 * size),
            Self::Target => marks::target_mark(shapes, middle, 0.62 * size),
            Self::Turn => shapes.push(marks::turn_dot(middle, 0.3 * size)),
            Self::Active => shapes.push(marks::active_disc(middle, 0.45 * size)),
            Self::Route => band(shapes, BLUE_TINT, Line::new(BLUE, 0.26 * size)),
            Self::Trapped => {
                let line = Line { dash: Some(0.4 * size), ..Line::new(PURPLE, 0.3 * size) };
                band(shapes, PURPLE_TINT, line);
            }
            Self::Region => {
                let ellipse = region::ellipse(0.4, |across, up| [middle[0] + across * size, y - up * size]);
                shapes.extend(region::outline(vec![ellipse]));
            }
            Self::Wave => scale(shapes, [x, y], [width, size], SWATCHES, colour::wave),
            Self::Height => scale(shapes, [x, y], [width, size], SWATCHES, colour::height),
            Self::Planned | Self::Driven | Self::Believed | Self::Beam => {
                let (colour, stroke, dash) = match self {
                    Self::Planned => (BLUE_TINT, 0.7 * size, None),
                    Self::Driven => (VERMILLION, 2.2, None),
                    Self::Believed => (BLUE, 1.8, Some(6.0)),
                    _ => (GREEN, 1.2, None),
                };
                let run = vec![[x + 3.0, y], [x + width - 3.0, y]];
                shapes.push(Shape::lines(vec![run], Line { dash, ..Line::new(colour, stroke) }));
            }
            Self::Ends => {
                for (dx, dy) in [(-4.0, 1.0), (-1.5, -2.5), (0.5, 2.5), (2.0, -0.5), (4.5, -3.0), (4.0, 3.0)]
                {
                    let centre = [middle[0] + dx, middle[1] + dy];
                    shapes.push(Shape::Disc { centre, radius: 1.1, fill: PURPLE, line: None });
                }
            }
            Self::Contact => marks::contact(shapes, middle, 0.36 * size),
            Self::Mover | Self::Expected => {
                let pale = matches!(self, Self::Expected);
                let fill = if pale { ORANGE.mix(PAGE, 0.6) } else { PURPLE };
                shapes.push(Shape::Disc { centre: middle, radius: 0.42 * size, fill, line: None });
            }
            Self::Found => {
                let side = 0.95 * size;
                let square = rectangle(middle[0] - side / 2.0, y - side / 2.0, side, side);
                shapes.push(Shape::lines(marks::hatching(&square, 4.0), Line::new(ORANGE, 1.4)));
                let line = Some(Line::new(ORANGE, 1.6));
                shapes.push(Shape::Path { runs: vec![square], closed: true, fill: None, line });
            }
            Self::Obstacle | Self::Closed => {
                let fill = if self == Self::Obstacle { OBSTACLE } else { CLOSED };
                let side = 0.95 * size;
                let square = rectangle(middle[0] - side / 2.0, y - side / 2.0, side, side);
                shapes.push(Shape::area(vec![square], fill));
            }
            _ => self.fleet_icon(shapes, [x, y], size),
        }
    }

    /// The icons of groups of robots.
    fn fleet_icon(self, shapes: &mut Vec<Shape>, [x, y]: Point, size: f64) {
        let width = self.icon_width() * size;
        let middle = [x + width / 2.0, y];
        match self {
            Self::Traffic(most) => {
                let tints = most.clamp(1, traffic::TINTS.into());
                let visits = |share: f64| 1 + (share * f64::from(most - 1)).round() as u32;
                let tint = |share| traffic::colour(traffic::tint(visits(share), most));
                scale(shapes, [x, y], [width, size], tints as usize, tint);
            }
            Self::RobotStart => shapes.push(marks::robot_start(middle, 1.3 * size, BLUE)),
            Self::RobotTarget | Self::RobotEnd => shapes.push(marks::robot_target(middle, 1.5 * size, BLUE)),
            Self::RobotWay => {
                let line = Line { opacity: 0.7, ..Line::new(BLUE, 2.0) };
                shapes.push(Shape::lines(vec![vec![[x + 3.0, y], [x + width - 3.0, y]]], line));
            }
            Self::Robot | Self::RobotGoingOn | Self::RobotAtRest => {
                marks::three_robots(shapes, [x, y], size, self == Self::RobotAtRest);
            }
            Self::TargetCell => {
                let side = 0.95 * size;
                let square = rectangle(middle[0] - side / 2.0, y - side / 2.0, side, side);
                shapes.push(Shape::area(vec![square], ink::tint(6, 1)));
            }
            _ => {}
        }
    }
}

/// A band of `count` swatches whose colours run from share 0 to share 1.
fn scale(
    shapes: &mut Vec<Shape>,
    [x, y]: Point,
    [width, height]: [f64; 2],
    count: usize,
    colour: impl Fn(f64) -> Rgb,
) {
    for i in 0..count {
        let share = i as f64 / (count - 1).max(1) as f64;
        let left = x + i as f64 * width / count as f64;
        // Each swatch reaches below all that follow: no seams.
        let rest = x + width - left;
        shapes.push(Shape::area(vec![rectangle(left, y - 0.5 * height, rest, height)], colour(share)));
    }
    outline(shapes, rectangle(x, y - 0.5 * height, width, height));
}

/// The lowest and the highest ground.
fn heights(map: &Map) -> String {
    let [low, high] = map.elevation().and_then(Elevation::range_m).unwrap_or_default();
    let digits = usize::from(high - low < 20.0);
    format!("ground {low:.digits$} to {high:.digits$} m")
}

fn rectangle(x: f64, y: f64, width: f64, height: f64) -> Vec<Point> {
    vec![[x, y], [x + width, y], [x + width, y + height], [x, y + height]]
}

fn outline(shapes: &mut Vec<Shape>, corners: Vec<Point>) {
    let line = Some(Line::new(EDGE, 1.0));
    shapes.push(Shape::Path { runs: vec![corners], closed: true, fill: None, line });
}

/// The footer's shapes below `top`, and its height.
pub(crate) fn footer(layout: &Layout, map: &Map, keys: &[Key], top: f64) -> (Vec<Shape>, f64) {
    let size = layout.style.text_size;
    let (left, right) = (layout.style.margin, layout.width - layout.style.margin);
    let (gap, space) = (1.7 * size, 0.5 * size);
    let row = 2.0 * size;
    let mut shapes = Vec::new();
    let mut at = [left, top + row / 2.0];
    at[0] += scale_bar(&mut shapes, layout, map, at) + gap;
    for key in keys {
        let label = key.label(map);
        let width = key.icon_width() * size + space + font::width(&label, size, false);
        if at[0] + width > right && at[0] > left {
            at = [left, at[1] + row];
        }
        key.icon(&mut shapes, at, size);
        text(&mut shapes, [at[0] + key.icon_width() * size + space, at[1]], size, &label);
        at[0] += width + gap;
    }
    (shapes, at[1] + row / 2.0 - top)
}

/// A bar of a round length, about a fifth of the map; returns its width with the label.
fn scale_bar(shapes: &mut Vec<Shape>, layout: &Layout, map: &Map, [x, y]: Point) -> f64 {
    let size = layout.style.text_size;
    let metre = layout.cell / map.frame().cell_m;
    let (metres, label) = round_length((layout.map_size[0] / 5.0).clamp(64.0, 220.0) / metre);
    let length = metres * metre;
    let tick = 0.32 * size;
    let ends = [x, x + length].map(|x| vec![[x, y - tick], [x, y + tick]]);
    let mut runs = vec![vec![[x, y], [x + length, y]]];
    runs.extend(ends);
    shapes.push(Shape::lines(runs, Line::new(TEXT, 1.6)));
    let space = 0.6 * size;
    text(shapes, [x + length + space, y], size, &label);
    length + space + font::width(&label, size, false)
}

/// Text whose middle is at height y.
fn text(shapes: &mut Vec<Shape>, [x, y]: Point, size: f64, text: &str) {
    let at = [x, y + 0.36 * size];
    let content = text.to_owned();
    shapes.push(Shape::Text(Text { at, size, centred: false, bold: false, colour: TEXT, content }));
}
