//! PGM and PPM: plain (P2, P3) and raw (P5, P6).

use super::{Channels, Image, check_size};
use crate::error::{Error, line_and_column, quoted_bytes};

/// Reads a PGM (P2, P5) or a PPM (P3, P6); the samples are scaled to 8 bits by round(v · 255 / maxval).
///
/// Comments may stand anywhere in the header, and between the numbers of a plain image. One image a file.
///
/// # Errors
/// [`Error::BadFormat`] if it is no PGM, cut, longer than declared, or has a sample above maxval;
/// [`Error::Core`] above [`activecell::MAX_CELLS`] pixels. The declared size is compared with the file's
/// before memory is taken.
///
/// ```
/// use activecell_formats::raster::read_pgm;
/// let image = read_pgm(b"P2 # levels 0 to 4\n3 1 4\n0 2 4\n")?;
/// assert_eq!(image.samples(), [0, 128, 255]);
/// # Ok::<(), activecell_formats::Error>(())
/// ```
pub fn read_pgm(bytes: &[u8]) -> Result<Image, Error> {
    let (plain, channels) = match bytes {
        [] => return Err(Error::file("the file is empty; expected a PGM image")),
        [b'P', b'2', ..] => (true, Channels::Gray),
        [b'P', b'3', ..] => (true, Channels::Rgb),
        [b'P', b'5', ..] => (false, Channels::Gray),
        [b'P', b'6', ..] => (false, Channels::Rgb),
        _ => {
            let found = quoted_bytes(&bytes[..bytes.len().min(2)]);
            return Err(Error::file(format!(
                "not a PGM image: it begins with {found}, not with `P5` or `P2`"
            )));
        }
    };
    let mut input = Tokens { bytes, at: 2 };
    let width = input.number("width")?;
    let height = input.number("height")?;
    let maxval_at = input.here();
    let maxval = input.number("maxval")?;
    check_size_fits(bytes, input.at, width, height, channels, plain)?;
    if !(1..=65535).contains(&maxval) {
        return Err(input.error(maxval_at, format!("maxval is {maxval}; it must be from 1 to 65535")));
    }
    let count = (width * height) as usize * channels.count();
    let samples = if plain {
        plain_samples(&mut input, count, maxval)?
    } else {
        input.end_header();
        raw_samples(input.rest(count, maxval > 255), (width, height), channels.count(), maxval)?
    };
    Image::new(width as u32, height as u32, channels, samples)
}

/// Refuses sizes that the file cannot hold, before memory is taken.
fn check_size_fits(
    bytes: &[u8],
    header: usize,
    width: u64,
    height: u64,
    channels: Channels,
    plain: bool,
) -> Result<(), Error> {
    let count = width.saturating_mul(height).saturating_mul(channels.count() as u64);
    // A plain sample takes a digit, and a blank before the next one.
    let least = if plain { count.saturating_mul(2).saturating_sub(1) } else { count };
    if least > (bytes.len() - header) as u64 {
        return Err(Error::file(format!(
            "the PGM header declares {width} × {height} pixels, but the file has only {} bytes; fetch the image again",
            bytes.len()
        )));
    }
    check_size(width, height)
}

fn plain_samples(input: &mut Tokens, count: usize, maxval: u64) -> Result<Vec<u8>, Error> {
    let mut samples = Vec::with_capacity(count);
    for done in 0..count {
        input.skip_blanks();
        if input.at == input.bytes.len() {
            return Err(Error::file(format!(
                "the PGM has {done} samples of the {count} that its header declares; fetch the image again"
            )));
        }
        let at = input.at;
        let value = input.number("a sample")?;
        if value > maxval {
            return Err(input.error(at, format!("a sample is {value}, above the maxval {maxval}")));
        }
        samples.push(scaled(value, maxval));
    }
    input.skip_blanks();
    if input.at < input.bytes.len() {
        let reason = format!("more than the {count} samples that the header declares; correct the header");
        return Err(input.error(input.at, reason));
    }
    Ok(samples)
}

fn raw_samples(
    raster: &[u8],
    (width, height): (u64, u64),
    depth: usize,
    maxval: u64,
) -> Result<Vec<u8>, Error> {
    let count = (width * height) as usize * depth;
    let size = if maxval > 255 { 2 } else { 1 };
    let wanted = count * size;
    let only_blanks_follow = raster.get(wanted..).is_some_and(|rest| rest.trim_ascii().is_empty());
    if !only_blanks_follow {
        return Err(Error::file(format!(
            "the PGM header declares {width} × {height} pixels, {wanted} bytes, but {} follow; fetch the image again",
            raster.len()
        )));
    }
    let mut samples = Vec::with_capacity(count);
    for (i, sample) in raster[..wanted].chunks_exact(size).enumerate() {
        let value = sample.iter().fold(0, |value, &byte| value << 8 | u64::from(byte));
        if value > maxval {
            let pixel = (i / depth) as u64;
            let (x, y) = (pixel % width, pixel / width);
            return Err(Error::file(format!("pixel ({x},{y}) is {value}, above the maxval {maxval}")));
        }
        samples.push(scaled(value, maxval));
    }
    Ok(samples)
}

/// round(v · 255 / maxval) in whole numbers.
const fn scaled(value: u64, maxval: u64) -> u8 {
    ((2 * 255 * value + maxval) / (2 * maxval)) as u8
}

/// The numbers of a header or a plain image.
struct Tokens<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Tokens<'a> {
    fn skip_blanks(&mut self) {
        while let Some(&byte) = self.bytes.get(self.at) {
            if byte == b'#' {
                self.skip_comment();
            } else if byte.is_ascii_whitespace() {
                self.at += 1;
            } else {
                break;
            }
        }
    }

    /// To the end of the line; its end is left to be read.
    fn skip_comment(&mut self) {
        let rest = &self.bytes[self.at..];
        self.at += rest.iter().position(|&b| b == b'\n' || b == b'\r').unwrap_or(rest.len());
    }

    fn here(&mut self) -> usize {
        self.skip_blanks();
        self.at
    }

    fn number(&mut self, name: &str) -> Result<u64, Error> {
        let start = self.here();
        let rest = &self.bytes[start..];
        if rest.is_empty() {
            return Err(Error::file(format!("the PGM ends before its {name}; fetch the image again")));
        }
        let digits = rest.iter().take_while(|b| b.is_ascii_digit()).count();
        let end = rest.iter().position(|&b| b.is_ascii_whitespace() || b == b'#').unwrap_or(rest.len());
        let value = std::str::from_utf8(&rest[..digits]).ok().and_then(|text| text.parse().ok());
        match value {
            Some(value) if digits == end => {
                self.at += digits;
                Ok(value)
            }
            _ => {
                let found = quoted_bytes(&rest[..end]);
                Err(self.error(start, format!("{name} is {found}; give a whole number")))
            }
        }
    }

    /// Steps over what separates the header from a raw raster: one blank, or a comment up to its line's end.
    fn end_header(&mut self) {
        if self.bytes.get(self.at) == Some(&b'#') {
            self.skip_comment();
        }
        self.at = (self.at + 1).min(self.bytes.len());
    }

    /// The raster. Some writers end the header with CRLF, or with a comment after a blank; that these bytes are
    /// not pixels can be told only from the length.
    fn rest(&self, count: usize, wide: bool) -> &'a [u8] {
        let rest = &self.bytes[self.at..];
        let wanted = if wide { 2 * count } else { count };
        let extra = match rest.first() {
            Some(b'\n') if self.bytes[self.at - 1] == b'\r' => 1,
            Some(b'#') => rest.iter().position(|&b| b == b'\n').map_or(0, |end| end + 1),
            _ => 0,
        };
        if rest.len() == wanted + extra { &rest[extra..] } else { rest }
    }

    /// An error at a byte of the text.
    fn error(&self, at: usize, reason: String) -> Error {
        let (line, column) = line_and_column(self.bytes, at);
        Error::at(line, column, reason)
    }
}

/// The image as a raw PGM (P5); colours become brightness, opacity is left out.
///
/// ```
/// use activecell_formats::raster::{Channels, Image, write_pgm};
/// let image = Image::new(2, 1, Channels::Gray, vec![0, 254])?;
/// assert_eq!(write_pgm(&image), b"P5\n2 1\n255\n\x00\xfe");
/// # Ok::<(), activecell_formats::Error>(())
/// ```
pub fn write_pgm(image: &Image) -> Vec<u8> {
    let mut bytes = format!("P5\n{} {}\n255\n", image.width, image.height).into_bytes();
    bytes.extend(image.grays());
    bytes
}
