//! Pictures of activecell: maps and routes as SVG, PNG, animated GIF, and in a terminal.
//!
//! ```
//! use activecell::{Cell, Lattice, Map};
//! use activecell_picture::{RoutePicture, svg};
//!
//! let map = Map::parse(Lattice::Square, "...\n.#.\n...")?;
//! let cells = [Cell::new(0, 0), Cell::new(1, 0), Cell::new(2, 0), Cell::new(2, 1)];
//! let picture = RoutePicture {
//!     map: &map,
//!     floor: None,
//!     title: "a small floor",
//!     from: cells[0],
//!     to: cells[3],
//!     cells: &cells,
//!     turns: &[cells[2]],
//!     cycle: &[],
//!     regions: &[],
//!     wave: None,
//! };
//! assert!(svg(&picture).starts_with("<svg"));
//! # Ok::<(), activecell::Error>(())
//! ```
//!
//! # Large maps
//!
//! A still picture gives the longer side of the map about 1100 pixels, an animation about 690. Maps of more
//! than 2²² cells, or with cells below a quarter of a pixel, are looked at in blocks of 2ᵏ × 2ᵏ cells before they
//! are drawn: a block is an obstacle if at least half of its cells are. Memory and time stay bounded: a second
//! or two for the largest map. The route is never sampled away.
//!
//! The same input gives the same bytes.

mod animation;
mod colour;
mod control;
mod drives;
mod figure;
mod fleet;
mod font;
mod hills;
mod ink;
mod layout;
mod legend;
mod marks;
mod outline;
mod palette;
mod prediction;
mod raster;
mod reel;
mod region;
mod route;
mod sample;
mod scene;
mod simulation;
mod svg;
mod terminal;

use activecell::predict::{Closures, Plan};
use activecell::{Cell, Map, Region};
pub use drives::{DrivePanel, drives_png, drives_svg};
use figure::Figure;
pub use fleet::{FilmLimits, FleetFilm, FleetPicture, FleetView, fleet_gif, fleet_png, fleet_svg};
pub use simulation::{
    Moment, MovingPicture, SimulationPicture, simulation_gif, simulation_png, simulation_svg,
};

/// When the wave from the target reached a cell; `None` where it did not come.
pub type Wave<'a> = &'a dyn Fn(Cell) -> Option<u32>;

/// A route on a map, to be drawn.
///
/// Cells outside the map are left out.
#[derive(Clone, Copy)]
pub struct RoutePicture<'a> {
    /// The map.
    pub map: &'a Map,
    /// The floor from which the map was re-tiled, if it was: its walls are drawn over the cells.
    pub floor: Option<&'a Map>,
    /// The line above the map; shortened with `…` if it is too long. Control characters are left out.
    pub title: &'a str,
    /// Where the robot starts, marked S.
    pub from: Cell,
    /// Where it is to go, marked F.
    pub to: Cell,
    /// Every cell of the route from the start on. It may visit a cell twice and need not reach the target.
    pub cells: &'a [Cell],
    /// The cells in which the robot turns.
    pub turns: &'a [Cell],
    /// The cells in which the robot circles for ever, in order; empty if it does not.
    pub cycle: &'a [Cell],
    /// The ellipses in which the robot is with 95 %, from its certificate.
    pub regions: &'a [Region],
    /// The wave from the target over this map, if the route was found with one.
    pub wave: Option<Wave<'a>>,
}

/// Why a picture could not be made.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// There is no memory for a canvas of this size.
    #[error("a picture of {width} x {height} pixels does not fit into memory; ask for SVG")]
    Canvas {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
    },
    /// The encoder of the file format refused the picture.
    #[error("the picture cannot be encoded: {0}")]
    Encoding(String),
}

/// The route as an SVG document.
pub fn svg(picture: &RoutePicture<'_>) -> String {
    svg::write(&still(picture))
}

/// The route as a PNG file.
///
/// # Errors
/// [`Error::Canvas`], [`Error::Encoding`].
///
/// ```
/// # use activecell::{Cell, Lattice, Map};
/// # use activecell_picture::{RoutePicture, png};
/// # let map = Map::parse(Lattice::Hex, "...\n.#.\n...")?;
/// # let picture = RoutePicture { map: &map, floor: None, title: "", from: Cell::new(0, 0), to: Cell::new(2, 2),
/// #     cells: &[], turns: &[], cycle: &[], regions: &[], wave: None };
/// assert!(png(&picture)?.starts_with(b"\x89PNG"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn png(picture: &RoutePicture<'_>) -> Result<Vec<u8>, Error> {
    encode_png(&still(picture))
}

/// The route as an animated GIF file: the wave spreads from the target, then the active cell moves along the
/// route; after two seconds it begins again. Without a wave only the active cell moves.
///
/// # Errors
/// [`Error::Canvas`], [`Error::Encoding`].
pub fn gif(picture: &RoutePicture<'_>) -> Result<Vec<u8>, Error> {
    animation::gif(picture)
}

/// A map alone as an SVG document, with a scale bar.
///
/// ```
/// # use activecell::{Lattice, Map};
/// let map = Map::parse(Lattice::Hex, "...\n.#.\n...")?;
/// assert!(activecell_picture::map_svg(&map, "floor <1>").contains("floor &lt;1&gt;"));
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn map_svg(map: &Map, title: &str) -> String {
    svg::write(&Figure::new(map, None, title, layout::STILL).still(None))
}

/// The states of the control unit and what leads from one to another, as an SVG document.
///
/// ```
/// assert!(activecell_picture::control_svg().contains("boxed in"));
/// ```
pub fn control_svg() -> String {
    svg::write(&control::scene())
}

/// The cells that moving objects close, and the robot's steps between them, for the first `slots` slots of a plan, as an
/// SVG document. For small floors: each is drawn 400 pixels wide.
///
/// ```
/// use activecell::predict::{Closures, Slots};
/// use activecell::{Cell, Lattice, Map};
/// let map = Map::parse(Lattice::Square, "S...F")?;
/// let closures = Closures::new(&map, Cell::new(0, 0), Slots::default(), 0.0, &[])?;
/// let plan = closures.plan(Cell::new(0, 0), |cell| map.lattice().distance(cell, Cell::new(4, 0)).into());
/// assert!(activecell_picture::prediction_svg(&map, &closures, &plan, 4).contains("slot 4"));
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn prediction_svg(map: &Map, closures: &Closures, plan: &Plan, slots: usize) -> String {
    svg::write(&prediction::scene(map, closures, plan, slots))
}

/// The route as text for a terminal, at most `columns` wide and `rows` high; lines end in LF.
///
/// A map that fits is drawn with two characters a cell, a larger one with half blocks `▀`, each the upper and
/// the lower of two blocks of cells. A block is an obstacle if at least half of its cells are, but the route,
/// the start and the target show in any case. With `colour` the text holds 24-bit ANSI colour codes.
///
/// ```
/// # use activecell::{Cell, Lattice, Map};
/// # use activecell_picture::{RoutePicture, terminal};
/// let map = Map::parse(Lattice::Square, "...\n.#.")?;
/// let cells = [Cell::new(0, 0), Cell::new(1, 0), Cell::new(2, 0), Cell::new(2, 1)];
/// let picture = RoutePicture { map: &map, floor: None, title: "", from: cells[0], to: cells[3], cells: &cells,
///     turns: &[], cycle: &[], regions: &[], wave: None };
/// assert_eq!(terminal(&picture, 80, 24, false), " S → ↓\n .## F\n");
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn terminal(picture: &RoutePicture<'_>, columns: usize, rows: usize, colour: bool) -> String {
    terminal::draw(picture, columns, rows, colour)
}

/// How far the wave came on the map; `None` if it reached no cell of it.
fn farthest(map: &Map, wave: Wave<'_>) -> Option<u32> {
    map.free().filter_map(wave).max()
}

fn still(picture: &RoutePicture<'_>) -> scene::Scene {
    Figure::new(picture.map, picture.floor, picture.title, layout::STILL).still(Some(picture))
}

fn encode_png(scene: &scene::Scene) -> Result<Vec<u8>, Error> {
    raster::draw(scene)?.encode_png().map_err(|error| Error::Encoding(error.to_string()))
}
