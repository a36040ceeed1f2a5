//! ESRI ASCII grids: a header of a few lines, then the heights row by row from the top, parted by white space.

use super::{Place, Values, check_size, looks_like_degrees};
use crate::error::{Error, line_and_column, quoted_bytes};

/// What the header may state.
#[derive(Default)]
struct Header {
    columns: Option<u64>,
    rows: Option<u64>,
    /// The left and the lower edge, and whether they are those of the outermost cells' centres instead.
    left: Option<(f64, bool)>,
    bottom: Option<(f64, bool)>,
    across: Option<f64>,
    down: Option<f64>,
    nodata: Option<f64>,
}

/// What stands for no height in a grid that does not say (Esri, *ASCII raster format*).
const NODATA: f64 = -9999.0;

pub(super) fn read(bytes: &[u8]) -> Result<Values, Error> {
    let mut words = Words { bytes, at: 0 };
    let mut header = Header::default();
    let mut begin = 0;
    while let Some((at, word)) = words.next() {
        if !word[0].is_ascii_alphabetic() {
            break;
        }
        header.set(bytes, at, word, words.next())?;
        begin = words.at;
    }
    let end = |name: &str| {
        let (line, _) = line_and_column(bytes, begin);
        Error::line(line, format!("the header has no `{name}`; is this an ESRI ASCII grid?"))
    };
    let (columns, rows) =
        (header.columns.ok_or_else(|| end("ncols"))?, header.rows.ok_or_else(|| end("nrows"))?);
    let across = header.across.ok_or_else(|| end("cellsize"))?;
    let apart = [across, header.down.unwrap_or(across)];
    // A number and a blank are two bytes.
    let (columns, rows) = check_size(columns, rows, (bytes.len() - begin) as u64 / 2 + 1, bytes.len())?;
    let edge = |given: Option<(f64, bool)>, apart: f64| {
        given.map_or(0.0, |(edge, of_centre)| if of_centre { edge - apart / 2.0 } else { edge })
    };
    let corner = [edge(header.left, apart[0]), edge(header.bottom, apart[1])];
    let place = if looks_like_degrees(apart, corner, [columns, rows]) {
        Place::Degrees { apart, corner }
    } else {
        Place::Metres { apart, corner }
    };
    let heights = heights(bytes, begin, columns as usize * rows as usize, header.nodata.or(Some(NODATA)))?;
    Ok(Values { columns, rows, heights, place })
}

impl Header {
    fn set(
        &mut self,
        bytes: &[u8],
        at: usize,
        key: &[u8],
        value: Option<(usize, &[u8])>,
    ) -> Result<(), Error> {
        let name = String::from_utf8_lossy(key).to_ascii_lowercase();
        let known = [
            "ncols",
            "nrows",
            "xllcorner",
            "xllcenter",
            "yllcorner",
            "yllcenter",
            "cellsize",
            "dx",
            "dy",
            "nodata_value",
        ];
        if !known.contains(&name.as_str()) {
            let reason = format!(
                "unknown key {}; a grid has ncols, nrows, xllcorner, yllcorner, cellsize, NODATA_value",
                quoted_bytes(key)
            );
            return Err(error(bytes, at, reason));
        }
        let (at, word) =
            value.ok_or_else(|| error(bytes, at, format!("{name} has no value; is the file cut?")))?;
        let number = || {
            number(word)
                .ok_or_else(|| error(bytes, at, format!("{name} is {}; give a number", quoted_bytes(word))))
        };
        let count = || {
            let count = std::str::from_utf8(word).ok().and_then(|text| text.parse().ok());
            count.ok_or_else(|| {
                error(bytes, at, format!("{name} is {}; give a whole number", quoted_bytes(word)))
            })
        };
        match name.as_str() {
            "ncols" => self.columns = Some(count()?),
            "nrows" => self.rows = Some(count()?),
            "xllcorner" | "xllcenter" => self.left = Some((number()?, name == "xllcenter")),
            "yllcorner" | "yllcenter" => self.bottom = Some((number()?, name == "yllcenter")),
            "cellsize" | "dx" => self.across = Some(number()?),
            "dy" => self.down = Some(number()?),
            _ => self.nodata = Some(number()?),
        }
        Ok(())
    }
}

fn heights(bytes: &[u8], begin: usize, count: usize, nodata: Option<f64>) -> Result<Vec<f32>, Error> {
    let mut values = Vec::with_capacity(count);
    for (at, word) in (Words { bytes, at: begin }) {
        if values.len() == count {
            return Err(error(
                bytes,
                at,
                format!("a height after the {count} that the header declares; correct ncols or nrows"),
            ));
        }
        let height = number(word)
            .ok_or_else(|| error(bytes, at, format!("{} is no height; give a number", quoted_bytes(word))))?;
        values.push(if Some(height) == nodata { f32::NAN } else { height as f32 });
    }
    if values.len() < count {
        let found = values.len();
        return Err(Error::file(format!(
            "the header declares {count} heights, the file has {found}; fetch the whole file"
        )));
    }
    Ok(values)
}

/// A number that is one, NaN for none.
fn number(word: &[u8]) -> Option<f64> {
    let number: f64 = std::str::from_utf8(word).ok()?.parse().ok()?;
    (!number.is_infinite()).then_some(number)
}

fn error(bytes: &[u8], at: usize, reason: String) -> Error {
    let (line, column) = line_and_column(bytes, at);
    Error::at(line, column, reason)
}

/// Words and where they begin.
struct Words<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Iterator for Words<'a> {
    type Item = (usize, &'a [u8]);

    fn next(&mut self) -> Option<Self::Item> {
        let rest = &self.bytes[self.at..];
        let begin = self.at + rest.iter().position(|byte| !byte.is_ascii_whitespace())?;
        let word = &self.bytes[begin..];
        let length = word.iter().position(u8::is_ascii_whitespace).unwrap_or(word.len());
        self.at = begin + length;
        Some((begin, &word[..length]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grid_that_does_not_say_has_the_usual_number_for_no_height() {
        let read = |nodata: &str| {
            read(format!("ncols 3\nnrows 1\ncellsize 1\n{nodata}-9999 -1 2\n").as_bytes()).unwrap().heights
        };
        let unsaid = read("");
        assert!(unsaid[0].is_nan() && unsaid[1..] == [-1.0, 2.0]);
        let said = read("NODATA_value -1\n");
        assert!(said[1].is_nan() && (said[0], said[2]) == (-9999.0, 2.0));
    }
}
