//! Elevation: heights of the ground from ESRI ASCII grids, `GeoTIFF`, gray PNG, and `NumPy` arrays.
//!
//! | ending | what | where the posts stand |
//! |---|---|---|
//! | `.asc` | ESRI ASCII grid | as its header says |
//! | `.tif`, `.tiff` | `GeoTIFF` of one band: whole numbers or floats; plain, LZW, DEFLATE or `PackBits`, in strips or tiles | as its tags say |
//! | `.png` | gray of 8 or 16 bits | not said |
//! | `.npy`, `.npz` | an array of two dimensions, of whole numbers or floats | not said |

mod asc;
mod geotiff;
mod gray;
mod numpy;

use crate::error::Error;
use activecell::{Elevation, Posts};
use std::path::Path;

/// How the values of a file become heights, and how far apart its posts stand if it does not say.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct HeightOptions {
    /// Metres that a value of 1 is worth; without it 1 m, and for PNG an error: gray has no natural height.
    pub scale: Option<f64>,
    /// The height of the value 0, in metres.
    pub offset_m: f64,
    /// The distance of the posts where the file does not say it; without it 1 m.
    pub apart_m: Option<f64>,
}

/// Where a file says that its posts stand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Georeference {
    /// It does not say.
    None,
    /// In metres.
    Metres,
    /// In degrees of longitude and latitude. The posts stand as far apart as at the latitude of the tile's middle,
    /// and the tile's lower left corner is at (0, 0).
    Degrees {
        /// That latitude.
        latitude_deg: f64,
    },
}

/// An elevation as it was read.
#[derive(Debug, Clone, PartialEq)]
pub struct Relief {
    /// The heights.
    pub elevation: Elevation,
    /// Where the file says that they are.
    pub georeference: Georeference,
}

/// Values of a file, before they become heights.
struct Values {
    columns: u32,
    rows: u32,
    /// Row by row from the top; NaN where there is none.
    heights: Vec<f32>,
    place: Place,
}

/// Where the posts stand, in the units of the file.
#[derive(Clone, Copy)]
enum Place {
    Unsaid,
    Metres { apart: [f64; 2], corner: [f64; 2] },
    Degrees { apart: [f64; 2], corner: [f64; 2] },
}

/// The kinds of files that hold heights.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HeightFormat {
    /// ESRI ASCII grid.
    Asc,
    /// `GeoTIFF`.
    GeoTiff,
    /// A gray PNG.
    Png,
    /// One `NumPy` array.
    Npy,
    /// An archive of `NumPy` arrays.
    Npz,
}

impl HeightFormat {
    /// The format that the ending names.
    pub fn of(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        match ending.as_str() {
            "asc" => Some(Self::Asc),
            "tif" | "tiff" => Some(Self::GeoTiff),
            "png" => Some(Self::Png),
            "npy" => Some(Self::Npy),
            "npz" => Some(Self::Npz),
            _ => None,
        }
    }
}

/// Reads heights.
///
/// # Errors
/// [`Error::BadFormat`] with the place where the format has one; [`Error::Core`] for numbers that make no sense.
///
/// ```
/// use activecell_formats::elevation::{Georeference, HeightFormat, HeightOptions, read};
/// let text = b"ncols 2\nnrows 1\nxllcorner 10\nyllcorner 20\ncellsize 5\nNODATA_value -1\n3 -1\n";
/// let relief = read(text, HeightFormat::Asc, &HeightOptions::default())?;
/// assert_eq!(relief.georeference, Georeference::Metres);
/// assert_eq!(relief.elevation.height_m([12.5, 22.5]), Some(3.0));
/// assert_eq!(relief.elevation.height_m([17.5, 22.5]), None);
/// # Ok::<(), activecell_formats::Error>(())
/// ```
pub fn read(bytes: &[u8], format: HeightFormat, options: &HeightOptions) -> Result<Relief, Error> {
    if bytes.is_empty() {
        return Err(Error::file("the file is empty; expected an elevation"));
    }
    let scale = match (format, options.scale) {
        (HeightFormat::Png, None) => {
            return Err(Error::file(
                "a PNG holds grays, not metres; say how many metres one step of gray is (--height-scale)",
            ));
        }
        (_, scale) => scale.unwrap_or(1.0),
    };
    let mut read = match format {
        HeightFormat::Asc => asc::read(bytes)?,
        HeightFormat::GeoTiff => geotiff::read(bytes)?,
        HeightFormat::Png => gray::read(bytes)?,
        HeightFormat::Npy => numpy::read_npy(bytes)?,
        HeightFormat::Npz => numpy::read_npz(bytes)?,
    };
    if options.scale.is_some() || options.offset_m != 0.0 {
        for height in &mut read.heights {
            *height = (f64::from(*height) * scale + options.offset_m) as f32;
        }
    }
    let (posts, georeference) = read.posts(options.apart_m.unwrap_or(1.0));
    let elevation = Elevation::new(read.columns, read.rows, read.heights, posts)?;
    Ok(Relief { elevation, georeference })
}

impl Values {
    fn posts(&self, unsaid_m: f64) -> (Posts, Georeference) {
        match self.place {
            Place::Unsaid => (Posts { apart_m: [unsaid_m; 2], ..Posts::default() }, Georeference::None),
            Place::Metres { apart, corner } => {
                (Posts { apart_m: apart, corner_m: corner, yaw_rad: 0.0 }, Georeference::Metres)
            }
            Place::Degrees { apart, corner } => {
                let latitude_deg = corner[1] + apart[1] * f64::from(self.rows) / 2.0;
                let degree_m = degree_m(latitude_deg.clamp(-89.0, 89.0));
                let apart_m = [apart[0] * degree_m[0], apart[1] * degree_m[1]];
                (Posts { apart_m, ..Posts::default() }, Georeference::Degrees { latitude_deg })
            }
        }
    }
}

/// The metres of a degree of longitude and of latitude there, on the ellipsoid WGS 84 (series of the National
/// Geospatial-Intelligence Agency, *Length of a Degree of Latitude and Longitude*).
fn degree_m(latitude_deg: f64) -> [f64; 2] {
    let cos = |times: f64| (times * latitude_deg.to_radians()).cos();
    let longitude = 111_412.84 * cos(1.0) - 93.5 * cos(3.0) + 0.118 * cos(5.0);
    let latitude = 111_132.92 - 559.82 * cos(2.0) + 1.175 * cos(4.0) - 0.0023 * cos(6.0);
    [longitude, latitude]
}

/// Whether a grid without units is in degrees: its cells are a hundredth or less, and it lies on the globe and not
/// at (0, 0), where floors begin.
fn looks_like_degrees(apart: [f64; 2], corner: [f64; 2], size: [u32; 2]) -> bool {
    let far = [0, 1].map(|axis| corner[axis] + apart[axis] * f64::from(size[axis]));
    let on_globe = corner[0] >= -360.0 && far[0] <= 360.0 && corner[1] >= -90.0 && far[1] <= 90.0;
    apart[0] <= 0.01 && apart[1] <= 0.01 && on_globe && corner != [0.0, 0.0]
}

/// Checks the size before memory is taken: `most` is how many posts the bytes can hold.
fn check_size(columns: u64, rows: u64, most: u64, bytes: usize) -> Result<(u32, u32), Error> {
    let posts = columns.saturating_mul(rows);
    if posts == 0 {
        return Err(Error::file(format!("the elevation of {columns} × {rows} posts is empty")));
    }
    if posts > Elevation::MAX_POSTS {
        let limit = Elevation::MAX_POSTS;
        return Err(Error::file(format!(
            "the elevation of {columns} × {rows} posts is too large: at most {limit} posts; cut out a part of it"
        )));
    }
    if posts > most {
        return Err(Error::file(format!(
            "the header declares {columns} × {rows} posts, more than the file's {bytes} bytes can hold; fetch it again"
        )));
    }
    Ok((columns as u32, rows as u32))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degrees_are_as_long_as_the_tables_say() {
        for (latitude_deg, expected) in
            [(0.0, [111_320.0, 110_574.0]), (45.0, [78_847.0, 111_132.0]), (60.0, [55_800.0, 111_412.0])]
        {
            for (found, expected) in degree_m(latitude_deg).into_iter().zip(expected) {
                assert!((found - expected).abs() < 2.0, "{found} {expected}");
            }
        }
    }
}
