//! `GeoTIFF`, by way of the `tiff` crate, with the size checked before memory is taken.
//!
//! Source of tags and keys: Open Geospatial Consortium, *OGC `GeoTIFF` Standard 1.1*, 2019.

use super::{Place, Values, check_size, looks_like_degrees};
use crate::error::{Error, quoted};
use std::io::Cursor;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;
use tiff::{ColorType, TiffError};

/// LZW makes at most about 2600 bytes of one: strings of 3839 bytes from codes of 12 bits.
const MOST_EXPANSION: u64 = 2600;
/// The longest strip or tile.
const CHUNK_BYTES: usize = 256 << 20;
/// The longest tag.
const TAG_BYTES: usize = 16 << 20;

const MODEL_TYPE: u16 = 1024;
const RASTER_TYPE: u16 = 1025;
const LINEAR_UNIT: u16 = 3076;
const GEOGRAPHIC: u16 = 2;
const PIXEL_IS_POINT: u16 = 2;

type Tiff<'a> = Decoder<Cursor<&'a [u8]>>;

pub(super) fn read(bytes: &[u8]) -> Result<Values, Error> {
    let mut limits = Limits::default();
    limits.intermediate_buffer_size = CHUNK_BYTES;
    limits.ifd_value_size = TAG_BYTES;
    let mut tiff = Decoder::new(Cursor::new(bytes)).map_err(|error| damaged(&error))?;
    let (columns, rows) = tiff.dimensions().map_err(|error| damaged(&error))?;
    let bits = match tiff.colortype().map_err(|error| damaged(&error))? {
        ColorType::Gray(bits) => u64::from(bits),
        other => {
            return Err(Error::file(format!(
                "a TIFF of {other:?} holds no heights; save one band of numbers (gdal_translate -b 1)"
            )));
        }
    };
    let most = (bytes.len() as u64).saturating_mul(8 * MOST_EXPANSION) / bits.max(1);
    let (columns, rows) = check_size(columns.into(), rows.into(), most, bytes.len())?;
    // Tags are counted against the same limit.
    limits.decoding_buffer_size =
        (columns as usize * rows as usize * bits.div_ceil(8) as usize).max(TAG_BYTES);
    let mut tiff = tiff.with_limits(limits);
    let place = place(&mut tiff, [columns, rows])?;
    let nodata = text(&mut tiff, Tag::GdalNodata)?.and_then(|text| text.trim().parse::<f64>().ok());
    let image = tiff.read_image().map_err(|error| damaged(&error))?;
    let heights = floats(image, nodata);
    if heights.len() != columns as usize * rows as usize {
        return Err(Error::file("the TIFF has not as many heights as it declares; fetch it again"));
    }
    Ok(Values { columns, rows, heights, place })
}

/// The image as numbers; those that stand for no height become NaN.
fn floats(image: DecodingResult, nodata: Option<f64>) -> Vec<f32> {
    // Compared as floats of 32 bits: such a one is written with more digits than it has. Adding 0 makes −0 a 0.
    let short = |value: f64| (value as f32 + 0.0).to_bits();
    let missing = |value: f64| nodata.is_some_and(|nodata| short(value) == short(nodata));
    let height = |value: f64| if missing(value) || value.is_infinite() { f32::NAN } else { value as f32 };
    match image {
        DecodingResult::U8(values) => values.into_iter().map(|value| height(value.into())).collect(),
        DecodingResult::U16(values) => values.into_iter().map(|value| height(value.into())).collect(),
        DecodingResult::U32(values) => values.into_iter().map(|value| height(value.into())).collect(),
        DecodingResult::U64(values) => values.into_iter().map(|value| height(value as f64)).collect(),
        DecodingResult::I8(values) => values.into_iter().map(|value| height(value.into())).collect(),
        DecodingResult::I16(values) => values.into_iter().map(|value| height(value.into())).collect(),
        DecodingResult::I32(values) => values.into_iter().map(|value| height(value.into())).collect(),
        DecodingResult::I64(values) => values.into_iter().map(|value| height(value as f64)).collect(),
        DecodingResult::F16(values) => values.into_iter().map(|value| height(value.into())).collect(),
        DecodingResult::F32(values) => values.into_iter().map(|value| height(value.into())).collect(),
        DecodingResult::F64(values) => values.into_iter().map(height).collect(),
    }
}

/// Where the posts stand.
fn place(tiff: &mut Tiff<'_>, size: [u32; 2]) -> Result<Place, Error> {
    let keys = keys(tiff)?;
    let key = |wanted: u16| keys.iter().find(|key| key.0 == wanted).map(|key| key.1);
    let Some((mut apart, mut upper_left)) = grid(tiff)? else { return Ok(Place::Unsaid) };
    if key(RASTER_TYPE) == Some(PIXEL_IS_POINT) {
        upper_left = [upper_left[0] - apart[0] / 2.0, upper_left[1] + apart[1] / 2.0];
    }
    let degrees = match key(MODEL_TYPE) {
        Some(kind) => kind == GEOGRAPHIC,
        None => {
            looks_like_degrees(apart, [upper_left[0], upper_left[1] - apart[1] * f64::from(size[1])], size)
        }
    };
    if !degrees {
        let unit_m = match key(LINEAR_UNIT) {
            None | Some(9001 | 32767) => 1.0,
            Some(9002) => 0.3048,
            Some(9003) => 1200.0 / 3937.0,
            Some(unit) => {
                return Err(Error::file(format!(
                    "the GeoTIFF counts lengths in the unit EPSG {unit}; convert it to metres (gdalwarp)"
                )));
            }
        };
        apart = apart.map(|length| length * unit_m);
        upper_left = upper_left.map(|length| length * unit_m);
    }
    let corner = [upper_left[0], upper_left[1] - apart[1] * f64::from(size[1])];
    Ok(if degrees { Place::Degrees { apart, corner } } else { Place::Metres { apart, corner } })
}

/// The distance of the posts, and the upper left corner.
type Grid = ([f64; 2], [f64; 2]);

/// Where the tags put the posts.
fn grid(tiff: &mut Tiff<'_>) -> Result<Option<Grid>, Error> {
    if let (Some(scale), Some(tie)) =
        (numbers(tiff, Tag::ModelPixelScaleTag)?, numbers(tiff, Tag::ModelTiepointTag)?)
        && let ([across, down, ..], [column, row, _, x, y, ..]) = (&scale[..], &tie[..])
    {
        return Ok(Some(([across.abs(), down.abs()], [x - column * across.abs(), y + row * down.abs()])));
    }
    if let Some(matrix) = numbers(tiff, Tag::ModelTransformationTag)?
        && let [across, b, _, x, c, down, _, y, ..] = matrix[..]
    {
        if b != 0.0 || c != 0.0 || across <= 0.0 || down >= 0.0 {
            return Err(Error::file("the GeoTIFF is turned; lay it north up first (gdalwarp)"));
        }
        return Ok(Some(([across, -down], [x, y])));
    }
    Ok(None)
}

/// The keys that have a value of their own.
fn keys(tiff: &mut Tiff<'_>) -> Result<Vec<(u16, u16)>, Error> {
    let tag = tiff.find_tag(Tag::GeoKeyDirectoryTag).map_err(|error| damaged(&error))?;
    let words = tag.and_then(|value| value.into_u16_vec().ok()).unwrap_or_default();
    let entries = words.chunks_exact(4).skip(1);
    Ok(entries.filter(|entry| entry[1] == 0).map(|entry| (entry[0], entry[3])).collect())
}

fn numbers(tiff: &mut Tiff<'_>, tag: Tag) -> Result<Option<Vec<f64>>, Error> {
    let Some(value) = tiff.find_tag(tag).map_err(|error| damaged(&error))? else { return Ok(None) };
    let numbers = value.into_f64_vec().map_err(|error| damaged(&error))?;
    Ok(Some(numbers).filter(|numbers| numbers.iter().all(|number| number.is_finite())))
}

fn text(tiff: &mut Tiff<'_>, tag: Tag) -> Result<Option<String>, Error> {
    let value = tiff.find_tag(tag).map_err(|error| damaged(&error))?;
    let text = value.and_then(|value| value.into_string().ok());
    Ok(text.map(|text| text.trim_end_matches('\0').to_owned()))
}

fn damaged(error: &TiffError) -> Error {
    let detail = error.to_string();
    let detail = quoted(detail.trim_end_matches('.'));
    let detail = detail.trim_matches('`');
    Error::file(match error {
        TiffError::UnsupportedError(_) => {
            format!("the TIFF is of a kind that is not read ({detail}); save it with -co COMPRESS=DEFLATE")
        }
        TiffError::LimitsExceeded => "the TIFF needs too much memory; cut out a part of it".to_owned(),
        _ => format!("the TIFF is damaged or not a TIFF ({detail}); fetch it again"),
    })
}
