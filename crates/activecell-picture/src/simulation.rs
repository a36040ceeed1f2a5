//! Simulations: the way planned, the way driven, what was found and touched, and where many trials ended.

use crate::animation::{Film, Stage};
use crate::colour::{BLUE, BLUE_TINT, GREEN, ORANGE, PAGE, PURPLE, Rgb, VERMILLION};
use crate::figure::Figure;
use crate::layout::{Layout, MOVING, STILL};
use crate::legend::Key;
use crate::marks::{active_disc, contact, hatching, start_mark, target_mark};
use crate::route::simplified;
use crate::scene::{Line, Point, Scene, Shape};
use crate::{Error, encode_png, raster, region, svg};
use activecell::sense::Change;
use activecell::{Cell, Map, PointM, Pose, Region, Sensors};

/// More end points than this are not drawn: the cloud is as dark as it can be.
const MOST_ENDS: usize = 3000;
/// Frames of an animation, and how long each stays, in hundredths of a second.
const FRAMES: usize = 160;
const FRAME_CS: u16 = 8;
const HOLD_CS: u16 = 250;

/// A simulation, to be drawn. What is empty is left out.
#[derive(Debug, Clone, Copy)]
pub struct SimulationPicture<'a> {
    /// The world as it was at the start.
    pub world: &'a Map,
    /// The line above it.
    pub title: &'a str,
    /// Where the robot starts.
    pub from: Cell,
    /// Where it is to go.
    pub to: Cell,
    /// The cells of the planned route.
    pub planned: &'a [Cell],
    /// Where the robot went.
    pub way: &'a [Pose],
    /// Where it believed to go.
    pub believed: &'a [Pose],
    /// Where trials ended.
    pub ends_m: &'a [PointM],
    /// Where 95 % of them should end.
    pub region: Option<Region>,
    /// Where the robot touched something.
    pub contacts_m: &'a [PointM],
    /// Obstacles that its map did not have and that it found.
    pub found: &'a [Cell],
}

/// The simulation as an SVG document.
///
/// ```
/// use activecell::{Cell, Lattice, Map};
/// use activecell_picture::{SimulationPicture, simulation_svg};
/// let map = Map::parse(Lattice::Square, "...\n.#.")?;
/// let picture = SimulationPicture { world: &map, title: "one drive", from: Cell::new(0, 0), to: Cell::new(2, 0),
///     planned: &[Cell::new(0, 0), Cell::new(1, 0), Cell::new(2, 0)], way: &[], believed: &[], ends_m: &[[2.4, 1.6]],
///     region: None, contacts_m: &[], found: &[Cell::new(1, 1)] };
/// assert!(simulation_svg(&picture).contains("found obstacle"));
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn simulation_svg(picture: &SimulationPicture<'_>) -> String {
    svg::write(&still(picture))
}

/// The simulation as a PNG file.
///
/// # Errors
/// [`Error::Canvas`], [`Error::Encoding`].
pub fn simulation_png(picture: &SimulationPicture<'_>) -> Result<Vec<u8>, Error> {
    encode_png(&still(picture))
}

fn still(picture: &SimulationPicture<'_>) -> Scene {
    let figure = Figure::new(picture.world, None, picture.title, STILL);
    let keys: Vec<Key> = keys(picture).into_iter().chain(figure.keys()).collect();
    let mut scene = figure.page(&keys, None);
    let mut shapes = vec![figure.floor()];
    shapes.extend(figure.fixed());
    shapes.extend(found(&figure.layout, picture.found));
    shapes.extend(planned(&figure.layout, picture.planned));
    shapes.extend(ends(&figure.layout, picture));
    shapes.extend(marks(&figure.layout, picture));
    shapes.extend(track(&figure.layout, picture.world, picture.way, VERMILLION));
    let believed = track(&figure.layout, picture.world, picture.believed, BLUE);
    shapes.extend(believed.into_iter().map(dashed));
    shapes.extend(region::shapes(&figure.layout, picture.world, picture.region.as_slice()));
    for &at_m in picture.contacts_m {
        contact(&mut shapes, figure.layout.floor_point(picture.world, at_m), 6.0);
    }
    scene.shapes.splice(1..1, shapes);
    scene
}

fn keys(picture: &SimulationPicture<'_>) -> Vec<Key> {
    let shown = [
        (true, Key::Start),
        (true, Key::Target),
        (picture.planned.len() > 1, Key::Planned),
        (picture.way.len() > 1, Key::Driven),
        (picture.believed.len() > 1, Key::Believed),
        (!picture.ends_m.is_empty(), Key::Ends),
        (picture.region.is_some(), Key::Region),
        (!picture.contacts_m.is_empty(), Key::Contact),
        (!picture.found.is_empty(), Key::Found),
    ];
    shown.into_iter().filter(|(shown, _)| *shown).map(|(_, key)| key).collect()
}

fn marks(layout: &Layout, picture: &SimulationPicture<'_>) -> Vec<Shape> {
    let radius = (layout.cell * 0.34).clamp(layout.style.least_mark, 16.0);
    let mut shapes = Vec::new();
    target_mark(&mut shapes, layout.centre(picture.to), radius);
    start_mark(&mut shapes, layout.centre(picture.from), radius);
    shapes
}

/// The planned route: a broad pale line below all others.
fn planned(layout: &Layout, cells: &[Cell]) -> Vec<Shape> {
    if cells.len() < 2 {
        return Vec::new();
    }
    let points: Vec<Point> = cells.iter().map(|&cell| layout.centre(cell)).collect();
    vec![Shape::lines(vec![simplified(&points)], Line::new(BLUE_TINT, (layout.cell * 0.45).clamp(4.0, 14.0)))]
}

fn track(layout: &Layout, map: &Map, poses: &[Pose], colour: Rgb) -> Option<Shape> {
    let points: Vec<Point> = poses.iter().map(|pose| layout.floor_point(map, pose.at_m)).collect();
    (points.len() > 1).then(|| Shape::lines(vec![simplified(&points)], Line::new(colour, 2.2)))
}

fn dashed(shape: Shape) -> Shape {
    match shape {
        Shape::Path { runs, closed, fill, line } => {
            let line = line.map(|line| Line { dash: Some(6.0), width: 1.8, ..line });
            Shape::Path { runs, closed, fill, line }
        }
        other => other,
    }
}

/// Hatches each found obstacle.
fn found(layout: &Layout, cells: &[Cell]) -> Vec<Shape> {
    let mut shapes = Vec::new();
    for &cell in cells {
        let corners = layout.corners(cell);
        let runs = hatching(&corners, (layout.cell / 5.0).clamp(4.0, 9.0));
        shapes.push(Shape::lines(runs, Line::new(ORANGE, 1.8)));
        let line = Some(Line::new(ORANGE, 2.0));
        shapes.push(Shape::Path { runs: vec![corners], closed: true, fill: None, line });
    }
    shapes
}

fn ends(layout: &Layout, picture: &SimulationPicture<'_>) -> Vec<Shape> {
    let stride = picture.ends_m.len().div_ceil(MOST_ENDS).max(1);
    let points = picture.ends_m.iter().step_by(stride).map(|&at_m| layout.floor_point(picture.world, at_m));
    let dot = |centre: Point| Shape::Disc { centre, radius: 1.1, fill: PURPLE, line: None };
    points.filter(|&point| is_on_map(layout, point)).map(dot).collect()
}

/// Whether a point lies in the map's box, outside which titles and legends are.
fn is_on_map(layout: &Layout, point: Point) -> bool {
    (0..2).all(|axis| (0.0..=layout.map_size[axis]).contains(&(point[axis] - layout.origin[axis])))
}

/// One moment of a drive.
#[derive(Debug, Clone, Copy)]
pub struct Moment<'a> {
    /// Where the robot is.
    pub pose: Pose,
    /// What its beams read; empty if no sensor was asked.
    pub readings_m: &'a [f64],
    /// The cells that closed (`true`) and opened for it since the moment before.
    pub changes: &'a [Change],
    /// Discs that move: where they are, and their radii.
    pub movers: &'a [(PointM, f64)],
    /// Where the robot expects them: middle and radius.
    pub forecasts: &'a [(PointM, f64)],
}

/// A drive, to be shown moving.
#[derive(Debug, Clone, Copy)]
pub struct MovingPicture<'a> {
    /// What stands still; its ways are left out, as they are drawn while they are driven.
    pub still: SimulationPicture<'a>,
    /// The drive.
    pub moments: &'a [Moment<'a>],
    /// The robot's radius in metres.
    pub radius_m: f64,
    /// Its sensors.
    pub sensors: &'a Sensors,
}

/// The run as an animated GIF file: the robot's disc, its beams, its way, and the cells that close and open for it.
///
/// # Errors
/// [`Error::Canvas`], [`Error::Encoding`].
pub fn simulation_gif(picture: &MovingPicture<'_>) -> Result<Vec<u8>, Error> {
    let still = &picture.still;
    let figure = Figure::new(still.world, None, still.title, MOVING);
    let layout = &figure.layout;
    let mut keys = vec![Key::Start, Key::Target, Key::Planned, Key::Driven];
    keys.extend(picture.moments.iter().any(|moment| !moment.readings_m.is_empty()).then_some(Key::Beam));
    keys.extend(picture.moments.iter().any(|moment| !moment.changes.is_empty()).then_some(Key::Found));
    keys.extend(picture.moments.iter().any(|moment| !moment.movers.is_empty()).then_some(Key::Mover));
    keys.extend(picture.moments.iter().any(|moment| !moment.forecasts.is_empty()).then_some(Key::Expected));
    keys.extend(figure.keys());
    let mut page = figure.page(&keys, None);
    page.shapes.push(figure.floor());
    let mut stage = Stage { below: raster::draw(&page)?, above: raster::canvas(&page)? };
    raster::draw_shapes(&mut stage.below, &figure.fixed());
    raster::draw_shapes(&mut stage.below, &planned(layout, still.planned));
    raster::draw_shapes(&mut stage.above, &marks(layout, still));

    let stride = picture.moments.len().div_ceil(FRAMES).max(1);
    let mut film: Option<Film> = None;
    let mut closed: Vec<Cell> = Vec::new();
    let mut way: Vec<Pose> = Vec::new();
    for (number, moment) in picture.moments.iter().enumerate() {
        follow(&mut closed, moment);
        way.push(moment.pose);
        let last = number + 1 == picture.moments.len();
        if number % stride != 0 && !last {
            continue;
        }
        let mut shapes = found(layout, &closed);
        shapes.extend(movers(layout, still.world, moment));
        shapes.extend(track(layout, still.world, &way, VERMILLION));
        shapes.push(beams(layout, still.world, moment, picture.sensors));
        let radius = (picture.radius_m / still.world.frame().cell_m * layout.cell).max(4.0);
        shapes.push(active_disc(layout.floor_point(still.world, moment.pose.at_m), radius));
        let frame = stage.frame(&shapes);
        let delay = if last { HOLD_CS } else { FRAME_CS };
        match &mut film {
            Some(film) => film.shoot(&frame, delay)?,
            None => film = Some(Film::new(&frame, delay, false)?),
        }
    }
    film.ok_or_else(|| Error::Encoding("the drive has no moment".into()))?.finish()
}

/// Follows the cells that closed and opened.
fn follow(closed: &mut Vec<Cell>, moment: &Moment<'_>) {
    for &(cell, blocked) in moment.changes {
        closed.retain(|&other| other != cell);
        if blocked {
            closed.push(cell);
        }
    }
}

/// Where movers are expected, pale, and where they are.
fn movers(layout: &Layout, map: &Map, moment: &Moment<'_>) -> Vec<Shape> {
    let disc = |&(at_m, radius_m): &(PointM, f64), fill: Rgb, line: Option<Line>| Shape::Disc {
        centre: layout.floor_point(map, at_m),
        radius: radius_m / map.frame().cell_m * layout.cell,
        fill,
        line,
    };
    let pale = ORANGE.mix(PAGE, 0.6);
    let expected = moment.forecasts.iter().map(|place| disc(place, pale, None));
    let there = moment.movers.iter().map(|place| disc(place, PURPLE, Some(Line::new(PAGE, 1.2))));
    expected.chain(there).collect()
}

fn beams(layout: &Layout, map: &Map, moment: &Moment<'_>, sensors: &Sensors) -> Shape {
    let from = layout.floor_point(map, moment.pose.at_m);
    let beams = sensors.bearings_rad(moment.pose.bearing_rad).zip(moment.readings_m);
    let runs = beams.map(|(bearing_rad, &reading_m)| {
        let pose = Pose { bearing_rad, ..moment.pose };
        vec![from, layout.floor_point(map, pose.point(reading_m, 0.0))]
    });
    Shape::lines(runs.collect(), Line::new(GREEN, 1.2))
}
