//! PNG, by way of the `png` crate, with the header checked before memory is taken.

use super::{Channels, Image, check_size};
use crate::error::Error;
use png::{BitDepth, ColorType, Decoder, DecodingError, Limits, Transformations};
use std::io::Cursor;

/// DEFLATE makes at most 1032 bytes of one: 258 bytes from a match of two bits.
pub(crate) const MOST_EXPANSION: u64 = 1032;
/// For ancillary chunks and the rows at work; the image itself is counted apart.
const DECODER_BYTES: usize = 64 << 20;

/// Reads a PNG: palettes become colours, 16 bits become the upper 8, fewer than 8 are spread over 8.
/// Of an animation the default image is read.
///
/// # Errors
/// [`Error::BadFormat`] if it is no PNG, cut, damaged, or declares more pixels than its bytes can hold;
/// [`Error::Core`] above [`activecell::MAX_CELLS`] pixels.
pub fn read_png(bytes: &[u8]) -> Result<Image, Error> {
    if bytes.is_empty() {
        return Err(Error::file("the file is empty; expected a PNG image"));
    }
    let mut decoder = decoder(bytes);
    decoder.set_transformations(Transformations::EXPAND | Transformations::STRIP_16);
    let header = decoder.read_header_info().map_err(|error| damaged(&error))?;
    let (width, height) = (u64::from(header.width), u64::from(header.height));
    let bits = header.bits_per_pixel() as u64;
    let needed = (width * bits).div_ceil(8).saturating_add(1).saturating_mul(height);
    if needed > MOST_EXPANSION * bytes.len() as u64 {
        return Err(Error::file(format!(
            "the PNG header declares {width} × {height} pixels, more than its {} bytes can hold; fetch the image again",
            bytes.len()
        )));
    }
    check_size(width, height)?;
    let mut reader = decoder.read_info().map_err(|error| damaged(&error))?;
    let size = reader.output_buffer_size().ok_or_else(|| damaged(&DecodingError::LimitsExceeded))?;
    let mut samples = vec![0; size];
    let frame = reader.next_frame(&mut samples).map_err(|error| damaged(&error))?;
    let channels = match (frame.color_type, frame.bit_depth) {
        (ColorType::Grayscale, BitDepth::Eight) => Channels::Gray,
        (ColorType::GrayscaleAlpha, BitDepth::Eight) => Channels::GrayAlpha,
        (ColorType::Rgb, BitDepth::Eight) => Channels::Rgb,
        (ColorType::Rgba, BitDepth::Eight) => Channels::Rgba,
        (kind, depth) => {
            return Err(Error::file(format!(
                "PNG of {kind:?} with {depth:?} bits is not supported; save it as 8-bit gray"
            )));
        }
    };
    if (u64::from(frame.width), u64::from(frame.height)) != (width, height) {
        return Err(Error::file(
            "the PNG's first frame is smaller than the image; save it without animation",
        ));
    }
    samples.truncate(frame.buffer_size());
    Image::new(frame.width, frame.height, channels, samples)
}

/// A decoder that takes little memory and reads the image alone.
pub(crate) fn decoder(bytes: &[u8]) -> Decoder<Cursor<&[u8]>> {
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), Limits { bytes: DECODER_BYTES });
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    decoder
}

pub(crate) fn damaged(error: &DecodingError) -> Error {
    let cut = |error: &std::io::Error| error.kind() == std::io::ErrorKind::UnexpectedEof;
    Error::file(match error {
        DecodingError::IoError(error) if cut(error) => {
            "the PNG is cut short; fetch the image again".to_owned()
        }
        DecodingError::LimitsExceeded => "the PNG needs too much memory; save it as 8-bit gray".to_owned(),
        other => {
            let detail = other.to_string();
            let detail = crate::error::quoted(detail.trim_end_matches('.'));
            format!("the PNG is damaged or not a PNG ({}); fetch the image again", detail.trim_matches('`'))
        }
    })
}

/// The image as a PNG, with the same channels.
///
/// # Errors
/// [`Error::BadFormat`] if the encoder refuses it, which no valid image makes it do.
///
/// ```
/// use activecell_formats::raster::{Channels, Image, read_png, write_png};
/// let image = Image::new(2, 1, Channels::Gray, vec![0, 254])?;
/// assert_eq!(read_png(&write_png(&image)?)?, image);
/// # Ok::<(), activecell_formats::Error>(())
/// ```
pub fn write_png(image: &Image) -> Result<Vec<u8>, Error> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, image.width, image.height);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_color(match image.channels {
        Channels::Gray => ColorType::Grayscale,
        Channels::GrayAlpha => ColorType::GrayscaleAlpha,
        Channels::Rgb => ColorType::Rgb,
        Channels::Rgba => ColorType::Rgba,
    });
    let refused = |error: png::EncodingError| Error::file(format!("the PNG cannot be written: {error}"));
    let mut writer = encoder.write_header().map_err(refused)?;
    writer.write_image_data(&image.samples).map_err(refused)?;
    writer.finish().map_err(refused)?;
    Ok(bytes)
}
