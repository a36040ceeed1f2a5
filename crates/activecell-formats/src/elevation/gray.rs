//! Gray PNG as heights: 8 or 16 bits, one value a pixel.

use super::{Place, Values, check_size};
use crate::error::Error;
use crate::raster::{MOST_EXPANSION, damaged, decoder};
use png::{BitDepth, ColorType, DecodingError};

pub(super) fn read(bytes: &[u8]) -> Result<Values, Error> {
    let mut decoder = decoder(bytes);
    let header = decoder.read_header_info().map_err(|error| damaged(&error))?;
    let wide = match (header.color_type, header.bit_depth) {
        (ColorType::Grayscale, BitDepth::Eight) => 1,
        (ColorType::Grayscale, BitDepth::Sixteen) => 2,
        (kind, depth) => {
            return Err(Error::file(format!(
                "a PNG of {kind:?} with {depth:?} bits holds no heights; save it as gray of 16 bits"
            )));
        }
    };
    let most = MOST_EXPANSION * bytes.len() as u64 / wide as u64;
    let (columns, rows) = check_size(header.width.into(), header.height.into(), most, bytes.len())?;
    let mut reader = decoder.read_info().map_err(|error| damaged(&error))?;
    let size = reader.output_buffer_size().ok_or_else(|| damaged(&DecodingError::LimitsExceeded))?;
    let mut samples = vec![0; size];
    let frame = reader.next_frame(&mut samples).map_err(|error| damaged(&error))?;
    if (frame.width, frame.height) != (columns, rows) {
        return Err(Error::file(
            "the PNG's first frame is smaller than the image; save it without animation",
        ));
    }
    samples.truncate(frame.buffer_size());
    let heights = match wide {
        1 => samples.iter().map(|&gray| gray.into()).collect(),
        _ => samples.chunks_exact(2).map(|pair| u16::from_be_bytes([pair[0], pair[1]]).into()).collect(),
    };
    Ok(Values { columns, rows, heights, place: Place::Unsaid })
}
