//! Images of 8 bits a channel: PNG, PGM and PPM.

mod netpbm;
mod portable;

pub use netpbm::{read_pgm, write_pgm};
pub(crate) use portable::{MOST_EXPANSION, damaged, decoder};
pub use portable::{read_png, write_png};

use crate::error::Error;
use activecell::MAX_CELLS;

/// What the samples of a pixel mean, in their order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Channels {
    /// Brightness, 0 black, 255 white.
    Gray,
    /// Brightness and opacity, 0 transparent, 255 opaque.
    GrayAlpha,
    /// Red, green, blue.
    Rgb,
    /// Red, green, blue, opacity.
    Rgba,
}

impl Channels {
    /// Samples a pixel.
    pub const fn count(self) -> usize {
        match self {
            Self::Gray => 1,
            Self::GrayAlpha => 2,
            Self::Rgb => 3,
            Self::Rgba => 4,
        }
    }
}

/// An image: rows from the top, pixels from the left, 8 bits a sample.
///
/// ```
/// use activecell_formats::raster::{Channels, Image};
/// let image = Image::new(2, 1, Channels::Rgb, vec![255, 0, 0, 10, 10, 10])?;
/// assert_eq!(image.pixel(1, 0), [10, 10, 10]);
/// assert_eq!(image.grays().collect::<Vec<_>>(), [76, 10]);
/// # Ok::<(), activecell_formats::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image {
    width: u32,
    height: u32,
    channels: Channels,
    samples: Vec<u8>,
}

impl Image {
    /// An image of these samples.
    ///
    /// # Errors
    /// [`Error::Core`] without a pixel or with more than [`MAX_CELLS`]; [`Error::BadFormat`] if the number of
    /// samples is not width × height × channels.
    pub fn new(width: u32, height: u32, channels: Channels, samples: Vec<u8>) -> Result<Self, Error> {
        check_size(width.into(), height.into())?;
        let wanted = width as usize * height as usize * channels.count();
        if samples.len() != wanted {
            let found = samples.len();
            return Err(Error::file(format!(
                "an image of {width} × {height} pixels needs {wanted} samples, not {found}"
            )));
        }
        Ok(Self { width, height, channels, samples })
    }

    /// Columns.
    pub const fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub const fn height(&self) -> u32 {
        self.height
    }

    /// What the samples mean.
    pub const fn channels(&self) -> Channels {
        self.channels
    }

    /// All samples, row by row from the top.
    pub fn samples(&self) -> &[u8] {
        &self.samples
    }

    /// The samples of each pixel, row by row from the top.
    pub fn pixels(&self) -> impl ExactSizeIterator<Item = &[u8]> {
        self.samples.chunks_exact(self.channels.count())
    }

    /// The samples of the pixel in column `x` of row `y` (from the top).
    ///
    /// # Panics
    /// Outside the image.
    pub fn pixel(&self, x: u32, y: u32) -> &[u8] {
        assert!(x < self.width && y < self.height, "pixel ({x},{y}) is outside the image");
        let count = self.channels.count();
        &self.samples[(y as usize * self.width as usize + x as usize) * count..][..count]
    }

    /// The brightness of each pixel, row by row from the top; opacity is left out of account.
    pub fn grays(&self) -> impl ExactSizeIterator<Item = u8> {
        self.pixels().map(gray)
    }
}

/// The brightness of a pixel as map servers since ROS 2 Jazzy count it: Rec. 601 weights on 16 bits, back to 8.
pub(crate) fn gray(pixel: &[u8]) -> u8 {
    match *pixel {
        [gray] | [gray, _] => gray,
        [r, g, b] | [r, g, b, _] => {
            let [r, g, b] = [r, g, b].map(|v| 257.0 * f64::from(v));
            let wide = (0.299 * r + 0.587 * g + 0.114 * b + 0.5).floor();
            (wide / 257.0).floor() as u8
        }
        _ => 0,
    }
}

/// Reads an image by what it contains, whatever its file is called: PNG, PGM or PPM.
///
/// # Errors
/// As [`read_png`] and [`read_pgm`].
pub fn read_image(bytes: &[u8]) -> Result<Image, Error> {
    match bytes {
        [] => Err(Error::file("the file is empty; expected a PNG or PGM image")),
        [0x89, b'P', b'N', b'G', ..] => read_png(bytes),
        [b'P', b'2' | b'3' | b'5' | b'6', ..] => read_pgm(bytes),
        _ => Err(Error::file("neither a PNG nor a PGM image; convert it to one of these")),
    }
}

/// Checks the size before memory is taken.
fn check_size(width: u64, height: u64) -> Result<(), Error> {
    if width == 0 || height == 0 {
        return Err(Error::file(format!("the image of {width} × {height} pixels is empty")));
    }
    if width.checked_mul(height).is_none_or(|pixels| pixels > MAX_CELLS) {
        return Err(activecell::Error::MapTooLarge { width, height, limit: MAX_CELLS }.into());
    }
    Ok(())
}
