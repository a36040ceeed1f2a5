//! Groups of robots: their ways or their traffic, still, and all of them moving.

mod film;
mod still;

use crate::{Error, encode_png, svg};
use activecell::{Map, Plan, Team};
pub use film::{FilmLimits, FleetFilm};

/// A plan for a group, to be drawn.
///
/// Robots that the team or the plan lacks, and cells outside the map, are left out.
#[derive(Debug, Clone, Copy)]
pub struct FleetPicture<'a> {
    /// The map.
    pub map: &'a Map,
    /// What the picture shows, such as the map's name; the numbers of the plan are added behind it.
    pub title: &'a str,
    /// Who starts where and wants to go where.
    pub team: &'a Team,
    /// Where every robot is at every step.
    pub plan: &'a Plan,
    /// What no plan's sum of costs is below, if it is known: as [`Team::lower_bound`].
    pub lower_bound: Option<u64>,
    /// Whether the robots would go on after the plan: then its last cells are no targets, and its costs mean nothing.
    pub endless: bool,
    /// What a still picture shows.
    pub view: FleetView,
}

/// What a still picture of a group shows.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum FleetView {
    /// The ways of at most 200 robots on cells of at least 6 pixels, else the traffic.
    #[default]
    Fitting,
    /// Each robot's way, in its colour, a little beside the middles of the cells, so that many ways show as many.
    Ways,
    /// How often each cell is entered.
    Traffic,
}

/// The group as an SVG document.
///
/// ```
/// use activecell::{Lattice, Map, Plan, Team};
/// use activecell_picture::{FleetPicture, FleetView, fleet_svg};
/// let map = Map::parse(Lattice::Square, "A.B\n...")?;
/// let [a, b] = ['A', 'B'].map(|name| map.mark(name).unwrap());
/// let team = Team::new(&map, vec![a], vec![b])?;
/// let plan = Plan::new(1, vec![a, activecell::Cell::new(1, 0), b])?;
/// let lower_bound = team.lower_bound(&map)?;
/// let (endless, view) = (false, FleetView::Fitting);
/// let picture =
///     FleetPicture { map: &map, title: "aisle", team: &team, plan: &plan, lower_bound, endless, view };
/// assert!(fleet_svg(&picture).contains("aisle · 1 robot, 2 steps, sum of costs 2 (lower bound 2)"));
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn fleet_svg(picture: &FleetPicture<'_>) -> String {
    svg::write(&still::scene(picture))
}

/// The group as a PNG file.
///
/// # Errors
/// [`Error::Canvas`], [`Error::Encoding`].
pub fn fleet_png(picture: &FleetPicture<'_>) -> Result<Vec<u8>, Error> {
    encode_png(&still::scene(picture))
}

/// The group moving, as an animated GIF file. Robots have the colour of their target, and become pale where they come to
/// rest there; in a run without end, that of where they stop. Short plans are shown with several frames a step, long ones
/// with several steps a frame: what was chosen is told with the film.
///
/// # Errors
/// [`Error::Canvas`], [`Error::Encoding`].
///
/// ```
/// # use activecell::{Lattice, Map, Plan, Team};
/// # use activecell_picture::{FilmLimits, FleetPicture, FleetView, fleet_gif};
/// # let map = Map::parse(Lattice::Hex, "AB")?;
/// # let [a, b] = ['A', 'B'].map(|name| map.mark(name).unwrap());
/// # let team = Team::new(&map, vec![a], vec![b])?;
/// # let plan = Plan::new(1, vec![a, b])?;
/// # let picture = FleetPicture {
/// #     map: &map, title: "", team: &team, plan: &plan, lower_bound: None, endless: false, view: FleetView::Fitting };
/// let film = fleet_gif(&picture, &FilmLimits::default())?;
/// assert!(film.gif.starts_with(b"GIF89a"));
/// assert_eq!((film.frames, film.frames_a_step, film.steps_a_frame), (9, 8, 1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn fleet_gif(picture: &FleetPicture<'_>, limits: &FilmLimits) -> Result<FleetFilm, Error> {
    film::make(picture, limits)
}

/// The title with the numbers of the plan.
fn title(picture: &FleetPicture<'_>) -> String {
    let plan = picture.plan;
    let mut text = format!(
        "{}{}{}, {}",
        picture.title,
        if picture.title.is_empty() { "" } else { " · " },
        counted(plan.robots(), "robot"),
        counted(plan.makespan(), "step"),
    );
    if picture.endless {
        return text;
    }
    text += &format!(", sum of costs {}", thousands(plan.sum_of_costs()));
    if let Some(bound) = picture.lower_bound {
        text += &format!(" (lower bound {})", thousands(bound));
    }
    text
}

/// `1 robot`, `2 robots`.
fn counted(count: usize, noun: &str) -> String {
    format!("{} {noun}{}", thousands(count as u64), if count == 1 { "" } else { "s" })
}

/// A number with narrow spaces between groups of three digits, from 10 000 on.
fn thousands(number: u64) -> String {
    let digits = number.to_string();
    if digits.len() < 5 {
        return digits;
    }
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_numbers_are_grouped() {
        let written = [7, 9999, 10_000, 1_234_567].map(thousands);
        assert_eq!(written, ["7", "9999", "10\u{202f}000", "1\u{202f}234\u{202f}567"]);
    }
}
