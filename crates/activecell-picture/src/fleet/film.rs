//! A group moving, as a GIF: frames are made of colour numbers, without drawing any shape anew but the robots' discs.

use super::{FleetPicture, thousands, title};
use crate::Error;
use crate::colour::{EDGE, FLOOR, GREEN, GREEN_TINT, GRID, OBSTACLE, PAGE, Rgb, TEXT};
use crate::figure::Figure;
use crate::font;
use crate::ink::{self, Inks};
use crate::layout::{Layout, MOVING, Style};
use crate::legend::Key;
use crate::palette::Palette;
use crate::raster;
use crate::reel::Reel;
use crate::scene::{Line, Point, Scene, Shape, Text};
use activecell::Cell;

/// The robots' radius, in cells, and the least in pixels.
const RADIUS: f64 = 0.42;
const LEAST_RADIUS_PX: f64 = 1.75;
/// Larger robots at rest have a rim of this share of their radius.
const RIM_FROM_PX: f64 = 3.5;
const RIM: f64 = 0.28;
/// How much ink robots at rest have inside, and, no more, the ways that robots have just come.
const AT_REST: f64 = 0.4;
const TRAIL: f64 = 0.4;
/// The level of the targets' cells.
const TARGET_LEVEL: usize = 1;
/// At most so many frames for a step.
const FINEST: usize = 8;
/// How long frames stay, in hundredths of a second: few stay longer, so that the film lasts about `LASTS_CS`.
const FASTEST_CS: usize = 4;
const SLOWEST_CS: usize = 8;
const LASTS_CS: usize = 1200;
const FIRST_CS: u16 = 100;
const HOLD_CS: u16 = 300;

/// How large a film may become.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FilmLimits {
    /// Pixels for the map, across and down; at least 100 each. The map takes as many of them as its shape lets it.
    pub map_px: [u32; 2],
    /// Frames.
    pub frames: usize,
    /// Bytes of the file. A single frame is written in any case.
    pub bytes: usize,
}

impl Default for FilmLimits {
    /// A map of 1020 × 720 pixels, 400 frames, 10 MB.
    fn default() -> Self {
        Self { map_px: [1020, 720], frames: 400, bytes: 10_000_000 }
    }
}

/// A film, and what was chosen to keep its limits.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FleetFilm {
    /// The GIF file.
    pub gif: Vec<u8>,
    /// How many frames it shows; those in which nothing moves are written as one.
    pub frames: usize,
    /// Frames for each step: more than 1 if robots are shown between cells.
    pub frames_a_step: usize,
    /// Steps from one frame to the next: more than 1 in a film that is sped up.
    pub steps_a_frame: usize,
}

/// How frames follow steps; one of the two is 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Pace {
    frames: usize,
    steps: usize,
}

impl Pace {
    /// The finest pace that shows so many steps in at most so many frames.
    fn fitting(steps: usize, most: usize) -> Self {
        let most = most.saturating_sub(1).max(1);
        if steps <= most {
            return Self { frames: (most / steps.max(1)).clamp(1, FINEST), steps: 1 };
        }
        Self { frames: 1, steps: steps.div_ceil(most) }
    }

    /// How many frames show so many steps, with the start.
    const fn count(self, steps: usize) -> usize {
        (steps * self.frames).div_ceil(self.steps) + 1
    }

    /// The time of a frame: whole steps, and the share of the next.
    fn time(self, frame: usize) -> (usize, f64) {
        (frame / self.frames * self.steps, (frame % self.frames) as f64 / self.frames as f64)
    }

    fn delay_cs(self, steps: usize) -> u16 {
        (LASTS_CS / self.count(steps)).clamp(FASTEST_CS, SLOWEST_CS) as u16
    }
}

/// Makes the film, and makes it again with fewer frames if it becomes too large.
pub(super) fn make(picture: &FleetPicture<'_>, limits: &FilmLimits) -> Result<FleetFilm, Error> {
    let title = title(picture);
    let mut studio = Studio::new(picture, &title, limits)?;
    let steps = picture.plan.makespan();
    let mut pace = Pace::fitting(steps, limits.frames);
    loop {
        match studio.shoot(pace, limits.bytes)? {
            Take::Kept(gif) => {
                let (frames_a_step, steps_a_frame) = (pace.frames, pace.steps);
                return Ok(FleetFilm { gif, frames: pace.count(steps), frames_a_step, steps_a_frame });
            }
            // Less than all of the frames fit: fewer next time, in any case.
            Take::TooLong { fit } => pace = Pace::fitting(steps, fit.min(pace.count(steps) - 1)),
        }
    }
}

/// What a pace came to.
enum Take {
    Kept(Vec<u8>),
    /// About so many frames would have fitted.
    TooLong {
        fit: usize,
    },
}

/// Everything that stays the same from frame to frame.
struct Studio<'a> {
    picture: &'a FleetPicture<'a>,
    layout: Layout,
    palette: Palette,
    inks: Inks,
    /// The frame without robots, and its width in pixels.
    empty: Vec<u8>,
    size: [u32; 2],
    /// Each robot's hue.
    hues: Vec<u8>,
    /// How many robots are at their targets after each step; in a run without end, how many moved in it.
    counts: Vec<usize>,
    /// How many moves were made until after each step.
    moves: Vec<usize>,
}

impl<'a> Studio<'a> {
    fn new(picture: &'a FleetPicture<'a>, title: &str, limits: &FilmLimits) -> Result<Self, Error> {
        let [across, down] = limits.map_px.map(|px| f64::from(px.max(100)));
        let style = Style {
            room: [across, down],
            longest: across.max(down),
            band: 24.0,
            title_width: across.clamp(MOVING.least_width, 760.0),
            ..MOVING
        };
        let figure = Figure::new(picture.map, None, title, style);
        let layout = figure.layout.clone();
        let targets = picture.team.targets();
        let hues = ink::hues(picture.map, targets);
        let mut keys = if picture.endless {
            vec![Key::RobotGoingOn]
        } else {
            vec![Key::Robot, Key::RobotAtRest, Key::TargetCell]
        };
        keys.extend(figure.keys().filter(|&key| key != Key::Height));
        let mut page = figure.page(&keys, None);
        page.shapes.push(figure.floor());
        if !picture.endless {
            page.shapes.extend(target_cells(picture, &layout, &hues));
        }
        page.shapes.extend(figure.fixed());
        let drawn = raster::draw(&page)?;
        let mut palette = Palette::of(colours());
        let inks = Inks::new(&mut palette);
        let empty = palette.numbers(&drawn);
        let (steps, plan) = (picture.plan.makespan(), picture.plan);
        let there =
            |step: usize| plan.row(step).iter().zip(targets).filter(|(cell, target)| cell == target).count();
        let moved = |step: usize| {
            let pairs = plan.row(step.saturating_sub(1)).iter().zip(plan.row(step));
            pairs.filter(|(before, now)| before != now).count()
        };
        let counts =
            (0..=steps).map(|step| if picture.endless { moved(step) } else { there(step) }).collect();
        let sum = |sum: &mut usize, step| {
            *sum += moved(step);
            Some(*sum)
        };
        let moves = (0..=steps).scan(0, sum).collect();
        let size = [drawn.width(), drawn.height()];
        Ok(Self { picture, layout, palette, inks, empty, size, hues, counts, moves })
    }

    /// The film at a pace, as long as it stays below the limit.
    fn shoot(&mut self, pace: Pace, bytes: usize) -> Result<Take, Error> {
        let steps = self.moves.len() - 1;
        let frames = pace.count(steps);
        let delay_cs = pace.delay_cs(steps);
        let colours = self.palette.bytes();
        let mut reel: Option<Reel> = None;
        let mut first = 0;
        for number in 0..frames {
            let frame = self.frame(pace, number)?;
            let delay_cs = if number + 1 == frames { HOLD_CS } else { delay_cs };
            let Some(reel) = &mut reel else {
                reel = Some(Reel::new(frame, self.size, delay_cs.max(FIRST_CS), &colours)?);
                continue;
            };
            reel.shoot(&frame, delay_cs)?;
            // The more moves, the more bytes: those until now tell how long the file will be.
            let done = self.moves[pace.time(number).0.min(steps)] as f64 / self.moves[steps].max(1) as f64;
            if number == 2 {
                first = reel.bytes();
            }
            let expected = first as f64 + (reel.bytes() - first) as f64 / done.max(0.01);
            if frames > 2 && (reel.bytes() > bytes || done > 0.1 && expected > 1.3 * bytes as f64) {
                let fit = (0.93 * frames as f64 * bytes as f64 / expected) as usize;
                return Ok(Take::TooLong { fit: fit.max(2) });
            }
        }
        let Some(reel) = reel else { return Ok(Take::Kept(Vec::new())) };
        let gif = reel.finish()?;
        if gif.len() > bytes && frames > 2 {
            return Ok(Take::TooLong {
                fit: (0.95 * frames as f64 * bytes as f64 / gif.len() as f64) as usize,
            });
        }
        Ok(Take::Kept(gif))
    }

    /// A frame: the robots, moving ones over resting ones over the ways that they came.
    fn frame(&mut self, pace: Pace, number: usize) -> Result<Vec<u8>, Error> {
        let steps = self.moves.len() - 1;
        let (step, share) = pace.time(number);
        let step = step.min(steps);
        let mut frame = self.empty.clone();
        let plan = self.picture.plan;
        let robots = plan.robots().min(self.hues.len());
        let radius = (RADIUS * self.layout.cell).max(LEAST_RADIUS_PX);
        if pace.steps > 1 {
            for robot in 0..robots {
                for before in step.saturating_sub(pace.steps)..step {
                    let from = self.between(plan.at(before, robot), plan.at(before + 1, robot), 0.0);
                    self.disc(&mut frame, robot, from, 0.6 * radius, Ink::Trail);
                }
            }
        }
        for robot in 0..robots {
            let (now, next) = (plan.at(step, robot), plan.at(step + 1, robot));
            let at = self.between(now, next, share);
            // Robots that only pass their targets do not flicker.
            let rests = !self.picture.endless && now == next && now == self.picture.team.targets()[robot];
            let ink = if rests { Ink::Resting } else { Ink::Moving };
            self.disc(&mut frame, robot, at, radius, ink);
        }
        self.band(&mut frame, pace, step)?;
        Ok(frame)
    }

    /// The point between the middles of two cells.
    fn between(&self, from: Cell, to: Cell, share: f64) -> Point {
        let (from, to) = (self.layout.centre(from), self.layout.centre(to));
        [0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) * share)
    }

    /// A robot's disc, with soft edges.
    fn disc(&self, frame: &mut [u8], robot: usize, [x, y]: Point, radius: f64, ink: Ink) {
        let [width, height] = self.size.map(|size| size as usize);
        let rim = if radius < RIM_FROM_PX { 0.0 } else { (RIM * radius).max(1.2) };
        let range = |at: f64, limit: usize| {
            let clamped = |at: f64| at.clamp(0.0, limit as f64) as usize;
            clamped((at - radius - 0.5).floor())..clamped((at + radius + 1.5).floor())
        };
        for row in range(y, height) {
            for column in range(x, width) {
                let far = (column as f64 + 0.5 - x).hypot(row as f64 + 0.5 - y);
                let cover = |radius: f64| (radius + 0.5 - far).clamp(0.0, 1.0);
                let share = match ink {
                    Ink::Moving => cover(radius),
                    Ink::Trail => TRAIL * cover(radius),
                    Ink::Resting if rim > 0.0 => cover(radius) - (1.0 - AT_REST) * cover(radius - rim),
                    Ink::Resting => AT_REST * cover(radius),
                };
                self.inks.put(&mut frame[row * width + column], self.hues[robot], share);
            }
        }
    }

    /// The band between title and map: the step, how many robots are at their targets, and both as a curve that grows.
    fn band(&mut self, frame: &mut [u8], pace: Pace, step: usize) -> Result<(), Error> {
        let what = if self.picture.endless { "moved" } else { "at target" };
        let scene = band(&self.layout, &self.counts, what, self.hues.len(), pace, step);
        let drawn = raster::draw(&scene)?;
        let from = (self.layout.origin[1] - self.layout.style.band) as usize * drawn.width() as usize;
        let numbers = self.palette.numbers(&drawn);
        frame[from..from + numbers.len()].copy_from_slice(&numbers);
        Ok(())
    }
}

/// What a disc stands for.
#[derive(Clone, Copy)]
enum Ink {
    Moving,
    Resting,
    Trail,
}

fn band(layout: &Layout, counts: &[usize], what: &str, robots: usize, pace: Pace, step: usize) -> Scene {
    let Layout { style, origin, map_size, width, .. } = layout;
    let (size, height) = (style.text_size, style.band - 6.0);
    let steps = counts.len() - 1;
    let [left, right] = [origin[0].min(style.margin), (origin[0] + map_size[0]).max(width - style.margin)];
    let speed = if pace.steps > 1 { format!(" · {} a frame", pace.steps) } else { String::new() };
    let time = |step: usize| format!("step {step} of {steps}{speed}");
    let count = |count: usize| format!("{} of {} {what}", thousands(count as u64), thousands(robots as u64));
    // As wide as they will ever be: the curve does not move.
    let [before, behind] = [time(steps), count(robots)].map(|text| font::width(&text, size, false) + size);
    let (from, to) = (left + before, right - behind);
    let point = |at: usize| {
        let share = counts[at] as f64 / robots.max(1) as f64;
        [from + (to - from) * at as f64 / steps.max(1) as f64, height - 1.0 - (height - 3.0) * share]
    };
    let box_ = |to: f64| vec![[from, 1.0], [to, 1.0], [to, height], [from, height]];
    let page = vec![[0.0, 0.0], [*width, 0.0], [*width, style.band], [0.0, style.band]];
    let mut shapes = vec![Shape::area(vec![page], PAGE)];
    if to > from {
        shapes.push(Shape::area(vec![box_(to)], FLOOR));
        shapes.push(Shape::area(vec![box_(point(step)[0])], GRID));
        let curve: Vec<Point> = (0..=step).map(point).collect();
        let mut area = vec![[from, height]];
        area.extend(&curve);
        area.push([point(step)[0], height]);
        shapes.push(Shape::area(vec![area], GREEN_TINT));
        shapes.push(Shape::lines(vec![curve], Line::new(GREEN, 1.5)));
        let line = Some(Line::new(EDGE, 1.0));
        shapes.push(Shape::Path { runs: vec![box_(to)], closed: true, fill: None, line });
    }
    let mut text = |x: f64, content: String| {
        let at = [x, height / 2.0 + 0.36 * size + 0.5];
        shapes.push(Shape::Text(Text { at, size, centred: false, bold: false, colour: TEXT, content }));
    };
    text(left, time(step));
    let now = count(counts[step]);
    text(right - font::width(&now, size, false), now);
    Scene { width: *width, height: style.band, title: String::new(), description: String::new(), shapes }
}

/// Each target's cell, tinted like its robot.
fn target_cells(picture: &FleetPicture<'_>, layout: &Layout, hues: &[u8]) -> Vec<Shape> {
    let cells_of = |hue: u8| {
        let targets = picture.team.targets().iter().zip(hues);
        let own = targets.filter(|&(&cell, &of)| of == hue && picture.map.contains(cell));
        own.map(|(&cell, _)| layout.corners(cell)).collect()
    };
    (0..ink::HUES as u8).map(|hue| Shape::area(cells_of(hue), ink::tint(hue, TARGET_LEVEL))).collect()
}

/// The colours of the film: the inks, the page's own, and what its edges blend into.
fn colours() -> impl Iterator<Item = Rgb> {
    let own = [PAGE, FLOOR, GRID, EDGE, OBSTACLE, TEXT, GREEN, GREEN_TINT];
    let blends = [
        (FLOOR, OBSTACLE, 12),
        (PAGE, TEXT, 12),
        (PAGE, OBSTACLE, 8),
        (GREEN_TINT, GREEN, 4),
        (GRID, GREEN, 4),
        (GRID, GREEN_TINT, 3),
        (GRID, OBSTACLE, 5),
        (FLOOR, EDGE, 4),
    ];
    let blends = blends.into_iter().flat_map(|(a, b, steps): (Rgb, Rgb, u8)| {
        (1..steps).map(move |i| a.mix(b, f64::from(i) / f64::from(steps)))
    });
    own.into_iter().chain(Inks::colours()).chain(blends)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::FleetView;
    use activecell::{Lattice, Map, Team};
    use activecell_fleet::{Limits, Options, solve};

    #[test]
    fn paces_keep_the_limit_of_frames() {
        for steps in [0, 1, 5, 49, 50, 100, 399, 400, 1234] {
            for most in [2, 9, 50, 400] {
                let pace = Pace::fitting(steps, most);
                assert!(pace.count(steps) <= most, "{steps} {most} {pace:?}");
                assert!(pace.frames == 1 || pace.steps == 1);
                assert!(pace.time(pace.count(steps) - 1).0 >= steps, "the end is shown");
            }
        }
    }

    /// Robots on a floor, some of which rest early.
    fn case(lattice: Lattice, seed: u64) -> (Map, Team, activecell::Plan) {
        let map = Map::random(lattice, 14, 11, 0.1, seed).expect("a map");
        let team = Team::random(&map, 20, seed).expect("a team");
        let limits = Limits { time: None, steps: Some(10_000), first: true, ..Limits::default() };
        let options = Options { limits, ..Options::default() };
        let plan = solve(&map, &team, &options, |_| {}).expect("a floor").plan;
        (map, team, plan.expect("a plan"))
    }

    #[test]
    fn discs_are_where_the_plan_says() {
        for (lattice, seed) in Lattice::ALL.into_iter().flat_map(|lattice| [(lattice, 3), (lattice, 8)]) {
            let (map, team, plan) = case(lattice, seed);
            let (endless, view) = (seed == 8, FleetView::Fitting);
            let picture = FleetPicture {
                map: &map,
                title: "",
                team: &team,
                plan: &plan,
                lower_bound: None,
                endless,
                view,
            };
            let mut studio = Studio::new(&picture, "", &FilmLimits::default()).expect("a canvas");
            for (frames, steps) in [(1, 1), (4, 1), (1, 3)] {
                let pace = Pace { frames, steps };
                for number in (0..pace.count(plan.makespan())).step_by(frames) {
                    let frame = studio.frame(pace, number).expect("a frame");
                    let step = (number / frames * steps).min(plan.makespan());
                    for robot in 0..team.robots() {
                        let [x, y] = studio.layout.centre(plan.at(step, robot)).map(|at| at as usize);
                        let drawn = frame[y * studio.size[0] as usize + x];
                        let target = team.targets()[robot];
                        let rests =
                            !endless && [step, step + 1].iter().all(|&step| plan.at(step, robot) == target);
                        let mut wanted = 0;
                        let share = if rests { AT_REST } else { 1.0 };
                        studio.inks.put(&mut wanted, studio.hues[robot], share);
                        assert_eq!(drawn, wanted, "{lattice} robot {robot} step {step}");
                    }
                }
            }
        }
    }
}
