//! `NumPy` arrays of two dimensions, alone (`.npy`) or in an archive (`.npz`).

use super::{Place, Values, check_size};
use crate::error::{Error, quoted};
use npyz::{DType, NpyHeader, Order, TypeChar};
use std::io::{Cursor, Read};

/// The longest header that is read, as in `NumPy` itself.
const MAX_HEADER_BYTES: usize = 10_000;
/// The most files in an archive that are looked at.
const MAX_FILES: usize = 1000;
/// DEFLATE makes at most 1032 bytes of one.
const MOST_EXPANSION: u64 = 1032;
/// Names that an array of heights has among others.
const NAMES: [&str; 6] = ["elevation", "elevations", "height", "heights", "dem", "z"];

pub(super) fn read_npy(bytes: &[u8]) -> Result<Values, Error> {
    let header = header(bytes)?;
    let length = bytes.len() as u64;
    array(header, Cursor::new(bytes), length, bytes.len())
}

pub(super) fn read_npz(bytes: &[u8]) -> Result<Values, Error> {
    let damaged = |error: zip::result::ZipError| {
        let detail = error.to_string();
        Error::file(format!(
            "the archive is damaged or no .npz ({}); fetch it again",
            quoted(&detail).trim_matches('`')
        ))
    };
    let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).map_err(damaged)?;
    let mut found = Vec::new();
    for index in 0..archive.len().min(MAX_FILES) {
        let file = archive.by_index(index).map_err(damaged)?;
        let name = file.name().map_err(damaged)?.trim_end_matches(".npy").to_owned();
        let mut begin = Vec::new();
        file.take(MAX_HEADER_BYTES as u64 + 16)
            .read_to_end(&mut begin)
            .map_err(|error| unreadable(&error))?;
        if header(&begin).is_ok_and(|header| is_grid(&header)) {
            found.push((index, name));
        }
    }
    let named = found.iter().find(|(_, name)| NAMES.contains(&name.to_ascii_lowercase().as_str()));
    let (index, _) = match (&found[..], named) {
        ([only], _) | (_, Some(only)) => only,
        ([], None) => return Err(Error::file("no array of the archive has two dimensions of numbers")),
        (several, None) => {
            let names: Vec<String> = several.iter().take(8).map(|(_, name)| quoted(name)).collect();
            return Err(Error::file(format!(
                "the archive has several arrays: {}; save the heights alone, or as `elevation`",
                names.join(", ")
            )));
        }
    };
    let mut file = archive.by_index(*index).map_err(damaged)?;
    // What the archive says of a file's length may be a lie; what its bytes can become is not.
    let length = file.size().min(MOST_EXPANSION * bytes.len() as u64);
    let header = NpyHeader::from_reader(&mut file).map_err(|error| unreadable(&error))?;
    elements(header, file, length, bytes.len())
}

/// The header of an array, looked at before it is trusted.
fn header(bytes: &[u8]) -> Result<NpyHeader, Error> {
    if !bytes.starts_with(b"\x93NUMPY") {
        return Err(Error::file("this is no NumPy array; save one with numpy.save"));
    }
    let cut = || Error::file("the array is cut short; fetch it again");
    let (length, begin) = match bytes[6..] {
        [1, _, low, high, ..] => (u32::from(u16::from_le_bytes([low, high])), 10),
        [_, _, a, b, c, d, ..] => (u32::from_le_bytes([a, b, c, d]), 12),
        _ => return Err(cut()),
    };
    if length as usize > MAX_HEADER_BYTES {
        return Err(Error::file(format!(
            "the array's header of {length} bytes is too long; save the array anew"
        )));
    }
    let text = bytes.get(begin..begin + length as usize).ok_or_else(cut)?;
    // The parser of headers follows brackets as deep as they go.
    if text.iter().filter(|byte| b"([{".contains(byte)).count() > 64 {
        return Err(Error::file("the array's header has too many brackets; save a plain array of numbers"));
    }
    // Nor does it expect that a product of sizes is no number any more.
    let numbers =
        text.split(|byte| !byte.is_ascii_digit()).filter_map(|digits| std::str::from_utf8(digits).ok());
    let sizes =
        numbers.filter(|digits| !digits.is_empty()).map(|digits| digits.parse().unwrap_or(u64::MAX).max(1));
    if sizes.fold(1u64, u64::saturating_mul) > 1 << 62 {
        return Err(Error::file(
            "the array's header declares more than any file can hold; save the array anew",
        ));
    }
    NpyHeader::from_reader(bytes).map_err(|error| unreadable(&error))
}

fn is_grid(header: &NpyHeader) -> bool {
    let number = matches!(header.dtype(), DType::Plain(kind) if matches!(kind.type_char(), TypeChar::Int | TypeChar::Uint | TypeChar::Float));
    number && header.shape().len() == 2
}

fn array(header: NpyHeader, mut bytes: impl Read, length: u64, file_bytes: usize) -> Result<Values, Error> {
    NpyHeader::from_reader(&mut bytes).map_err(|error| unreadable(&error))?;
    elements(header, bytes, length, file_bytes)
}

/// The array's elements; `length` is how many bytes there can be of them.
fn elements(header: NpyHeader, bytes: impl Read, length: u64, file_bytes: usize) -> Result<Values, Error> {
    if !is_grid(&header) {
        let dtype = quoted(&header.dtype().descr());
        return Err(Error::file(format!(
            "an array of {} dimensions of {} holds no heights; save one of two dimensions of numbers",
            header.shape().len(),
            dtype.trim_matches('`')
        )));
    }
    let (rows, columns, order) = (header.shape()[0], header.shape()[1], header.order());
    let DType::Plain(kind) = header.dtype() else {
        return Err(Error::file("the array has no plain numbers"));
    };
    let width = kind.num_bytes().unwrap_or(1).max(1) as u64;
    let (columns, rows) = check_size(columns, rows, length / width, file_bytes)?;
    let values = match (kind.type_char(), width) {
        (TypeChar::Float, 4) => numbers::<f32>(header, bytes, |value| value),
        (TypeChar::Float, 8) => numbers::<f64>(header, bytes, |value| value as f32),
        (TypeChar::Int, 1) => numbers::<i8>(header, bytes, f32::from),
        (TypeChar::Int, 2) => numbers::<i16>(header, bytes, f32::from),
        (TypeChar::Int, 4) => numbers::<i32>(header, bytes, |value| value as f32),
        (TypeChar::Int, 8) => numbers::<i64>(header, bytes, |value| value as f32),
        (TypeChar::Uint, 1) => numbers::<u8>(header, bytes, f32::from),
        (TypeChar::Uint, 2) => numbers::<u16>(header, bytes, f32::from),
        (TypeChar::Uint, 4) => numbers::<u32>(header, bytes, |value| value as f32),
        (TypeChar::Uint, 8) => numbers::<u64>(header, bytes, |value| value as f32),
        _ => {
            return Err(Error::file(format!(
                "numbers of {} bits are not read; save floats of 32 bits",
                8 * width
            )));
        }
    }?;
    let heights = match order {
        Order::C => values,
        Order::Fortran => {
            let (columns, rows) = (columns as usize, rows as usize);
            (0..rows * columns).map(|i| values[i % columns * rows + i / columns]).collect()
        }
    };
    Ok(Values { columns, rows, heights, place: Place::Unsaid })
}

fn numbers<T: npyz::Deserialize>(
    header: NpyHeader,
    bytes: impl Read,
    height: fn(T) -> f32,
) -> Result<Vec<f32>, Error> {
    let file = npyz::NpyFile::with_header(header, bytes);
    let numbers =
        file.data::<T>().map_err(|error| Error::file(format!("the array cannot be read: {error}")))?;
    let heights = numbers.map(|number| number.map(height).map_err(|error| unreadable(&error)));
    // Infinite heights are none.
    heights.map(|value| value.map(|value| if value.is_infinite() { f32::NAN } else { value })).collect()
}

fn unreadable(error: &std::io::Error) -> Error {
    if error.kind() == std::io::ErrorKind::UnexpectedEof {
        return Error::file("the array is cut short; fetch it again");
    }
    let detail = error.to_string();
    Error::file(format!("the array cannot be read ({}); save it anew", quoted(&detail).trim_matches('`')))
}
