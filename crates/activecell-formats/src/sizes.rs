//! The sizes of a group's robots: whole numbers, separated by commas, white space or lines.

use crate::error::{Error, quoted};

/// The longest file that is read, in bytes.
pub const MAX_SIZES_BYTES: u64 = 16 << 20;

/// Reads radii in cells. Lines that begin with `#` are remarks.
///
/// # Errors
/// [`Error::BadFormat`] with the line of what is no whole number, or if there is none at all.
///
/// ```
/// use activecell_formats::sizes;
/// assert_eq!(sizes::read(b"# a large one, two small ones\n1\n0, 0\n")?, [1, 0, 0]);
/// let error = sizes::read(b"1\n0.5").unwrap_err();
/// assert_eq!(error.to_string(), "line 2: `0.5` is no radius in whole cells; give 0 for a robot of one cell, 1 for one that covers its neighbours too");
/// # Ok::<(), activecell_formats::Error>(())
/// ```
pub fn read(bytes: &[u8]) -> Result<Vec<u32>, Error> {
    let text = String::from_utf8_lossy(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes));
    let mut sizes = Vec::new();
    for (number, line) in text.lines().enumerate().filter(|(_, line)| !line.starts_with('#')) {
        for word in line.split([',', ' ', '\t', '\r']).filter(|word| !word.is_empty()) {
            let radius = word.parse().map_err(|_| {
                let word = quoted(word);
                let reason = format!(
                    "{word} is no radius in whole cells; give 0 for a robot of one cell, 1 for one that covers its neighbours too"
                );
                Error::line(number + 1, reason)
            })?;
            sizes.push(radius);
        }
    }
    if sizes.is_empty() { Err(Error::file("no radius is given; give one for each robot")) } else { Ok(sizes) }
}
