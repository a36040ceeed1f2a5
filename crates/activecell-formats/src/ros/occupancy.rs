//! From brightness to occupancy and back, bit by bit as the map servers of ROS do it.

use super::{MapYaml, Mode};
use crate::error::Error;
use crate::raster::{Channels, Image, gray};
use activecell::{BitPlane, Frame, Lattice, Map};

/// Which map server's rules are followed; they differ where a pixel lies on a threshold, in colours and opacity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Rules {
    /// ROS 2 Humble and Iron (and, but for `scale`, ROS 1): mean of the colours, double precision, strict
    /// comparisons. In trinary mode opacity counts as a fourth colour. Gray images with opacity are read as
    /// if opaque, as `GraphicsMagick` does.
    Humble,
    /// ROS 2 Jazzy and later: weighted brightness, single precision, thresholds included, occupied first; pixels
    /// that are not opaque are unknown.
    #[default]
    Jazzy,
}

/// How an occupancy image becomes free cells and obstacles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Reading {
    /// The map server whose rules are followed.
    pub rules: Rules,
    /// Whether unknown cells are free; otherwise they are obstacles.
    pub unknown_is_free: bool,
    /// From this occupancy on (0 to 100) a cell is an obstacle.
    pub occupied_from: u8,
}

impl Default for Reading {
    /// Jazzy; unknown cells and those of occupancy 65 and more are obstacles.
    fn default() -> Self {
        Self { rules: Rules::Jazzy, unknown_is_free: false, occupied_from: 65 }
    }
}

/// The occupancy of each pixel, row 0 on TOP: 0 free to 100 occupied, −1 unknown.
///
/// ROS counts rows from the bottom: its `data[width · (height − 1 − y) + x]` is this one's `[width · y + x]`.
///
/// ```
/// use activecell_formats::raster::{Channels, Image};
/// use activecell_formats::ros::{MapYaml, Rules, occupancy};
/// let image = Image::new(3, 1, Channels::Gray, vec![0, 205, 254])?;
/// assert_eq!(occupancy(&image, &MapYaml::default(), Rules::Jazzy), [100, -1, 0]);
/// // The classic trap: with Nav2's threshold 0.25 the gray of unknown cells reads as free.
/// let nav2 = MapYaml { free_thresh: 0.25, ..MapYaml::default() };
/// assert_eq!(occupancy(&image, &nav2, Rules::Jazzy), [100, 0, 0]);
/// # Ok::<(), activecell_formats::Error>(())
/// ```
pub fn occupancy(image: &Image, yaml: &MapYaml, rules: Rules) -> Vec<i8> {
    cells(image, yaml, rules).collect()
}

/// The occupancies one by one, so that a map needs no memory for them.
fn cells<'a>(image: &'a Image, yaml: &'a MapYaml, rules: Rules) -> impl Iterator<Item = i8> + 'a {
    let of = move |pixel: &[u8]| match rules {
        Rules::Humble => humble(pixel, yaml),
        Rules::Jazzy => jazzy(pixel, yaml),
    };
    // Most maps are gray: 256 answers are all there are.
    let table: Option<Vec<i8>> =
        (image.channels() == Channels::Gray).then(|| (0..=255).map(|gray| of(&[gray])).collect());
    image
        .pixels()
        .map(move |pixel| table.as_ref().map_or_else(|| of(pixel), |table| table[pixel[0] as usize]))
}

fn humble(pixel: &[u8], yaml: &MapYaml) -> i8 {
    let (colours, opacity) = match *pixel {
        [r, g, b, a] => ([r, g, b], Some(a)),
        [r, g, b] => ([r, g, b], None),
        // Opacity beside gray alone is not seen.
        [gray, ..] => ([gray; 3], None),
        [] => return -1,
    };
    let mut sum: f64 = colours.into_iter().map(f64::from).sum();
    let mut count = 3.0;
    if let (Some(opacity), Mode::Trinary) = (opacity, yaml.mode) {
        sum += f64::from(opacity);
        count = 4.0;
    }
    let shade = sum / count / 255.0;
    let occupied = if yaml.negate { shade } else { 1.0 - shade };
    match yaml.mode {
        Mode::Raw => percent((shade * 255.0).round()),
        Mode::Scale if opacity.is_some_and(|opacity| opacity < 255) => -1,
        _ if occupied > yaml.occupied_thresh => 100,
        _ if occupied < yaml.free_thresh => 0,
        Mode::Trinary => -1,
        Mode::Scale => {
            let share = (occupied - yaml.free_thresh) / (yaml.occupied_thresh - yaml.free_thresh);
            (share * 100.0).round_ties_even() as i8
        }
    }
}

fn jazzy(pixel: &[u8], yaml: &MapYaml) -> i8 {
    let gray = gray(pixel);
    let opaque = match *pixel {
        [_, opacity] | [_, _, _, opacity] => opacity == 255,
        _ => true,
    };
    let bright = f32::from(gray) / 255.0;
    let occupied = if yaml.negate { bright } else { 1.0 - bright };
    let (from, to) = (yaml.free_thresh as f32, yaml.occupied_thresh as f32);
    match yaml.mode {
        Mode::Raw => percent(f64::from(gray)),
        _ if !opaque => -1,
        _ if occupied >= to => 100,
        _ if occupied <= from => 0,
        Mode::Trinary => -1,
        Mode::Scale => ((occupied - from) / (to - from) * 100.0).round() as i8,
    }
}

/// What is not a percentage is unknown.
fn percent(value: f64) -> i8 {
    if (0.0..=100.0).contains(&value) { value as i8 } else { -1 }
}

/// The map that an image shows: a square cell a pixel, in the frame that the YAML states.
///
/// # Errors
/// [`Error::Core`] if the image is too large or the frame's numbers make no sense.
///
/// ```
/// use activecell_formats::raster::{Channels, Image};
/// use activecell_formats::ros::{MapYaml, Reading, to_map};
/// let image = Image::new(3, 1, Channels::Gray, vec![0, 255, 128])?;
/// let map = to_map(&image, &MapYaml::default(), &Reading::default())?;
/// assert_eq!((map.to_text().as_str(), map.frame().cell_m), ("#.#\n", 0.05));
/// let map = to_map(&image, &MapYaml::default(), &Reading { unknown_is_free: true, ..Reading::default() })?;
/// assert_eq!(map.to_text(), "#..\n");
/// # Ok::<(), activecell_formats::Error>(())
/// ```
pub fn to_map(image: &Image, yaml: &MapYaml, reading: &Reading) -> Result<Map, Error> {
    let mut obstacles = BitPlane::new(image.width().into(), image.height().into())?;
    let mut occupancies = cells(image, yaml, reading.rules);
    for y in 0..image.height() {
        for (x, occupancy) in (0..image.width()).zip(&mut occupancies) {
            // Only −1 is negative.
            let obstacle = u8::try_from(occupancy)
                .map_or(!reading.unknown_is_free, |value| value >= reading.occupied_from);
            if obstacle {
                obstacles.set(x, y, true);
            }
        }
    }
    let frame = Frame { cell_m: yaml.resolution_m, origin_m: yaml.origin_m, yaw_rad: yaml.yaw_rad };
    Ok(Map::new(Lattice::Square, obstacles).in_frame(frame)?)
}

/// The map as a gray image: a pixel a cell, 254 free, 0 obstacle. Hexagons are written in odd-r order.
///
/// # Errors
/// None that a valid map could cause; those of [`Image::new`].
pub fn to_image(map: &Map) -> Result<Image, Error> {
    let (width, height) = (map.width(), map.height());
    let mut samples = Vec::with_capacity(map.cells());
    for y in 0..height {
        samples.extend((0..width).map(|x| if map.obstacles().get(x, y) { 0 } else { 254 }));
    }
    Image::new(width, height, Channels::Gray, samples)
}

/// The map as a map server wants it: trinary, thresholds 0.65 and 0.196, read back alike under all [`Rules`].
/// The image's file name is left empty; the names of cells are not written.
///
/// # Errors
/// [`Error::BadFormat`] for a map of hexagons: pixels are squares.
///
/// ```
/// use activecell::{Lattice, Map};
/// use activecell_formats::ros::{Reading, from_map, to_map};
/// let map = Map::parse(Lattice::Square, "..#\n#..")?;
/// let (yaml, image) = from_map(&map)?;
/// assert_eq!(to_map(&image, &yaml, &Reading::default())?, map);
/// # Ok::<(), activecell_formats::Error>(())
/// ```
pub fn from_map(map: &Map) -> Result<(MapYaml, Image), Error> {
    if map.lattice() != Lattice::Square {
        return Err(Error::file(
            "a ROS map has square cells, this map has hexagons; write it as .txt or .map, or re-tile it",
        ));
    }
    let frame = map.frame();
    let yaml = MapYaml {
        resolution_m: frame.cell_m,
        origin_m: frame.origin_m,
        yaw_rad: frame.yaw_rad,
        free_thresh: 0.196,
        ..MapYaml::default()
    };
    Ok((yaml, to_image(map)?))
}
