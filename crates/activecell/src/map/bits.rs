//! A plane of bits, one a cell: the form in which obstacles are kept.

use crate::error::Error;

/// The most cells a map may have: 2²⁸, 32 MiB of bits.
pub const MAX_CELLS: u64 = 1 << 28;

/// One bit for each cell of `width` columns and `height` rows, 0 where nothing was set.
///
/// Rows begin at whole words; the bits behind the last column stay 0.
///
/// ```
/// let mut plane = activecell::BitPlane::new(100, 3)?;
/// plane.set(70, 2, true);
/// assert!(plane.get(70, 2));
/// assert_eq!(plane.count_ones(), 1);
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BitPlane {
    width: u32,
    height: u32,
    words_per_row: usize,
    words: Vec<u64>,
}

impl BitPlane {
    /// A plane of zeros.
    ///
    /// # Errors
    /// [`Error::EmptyMap`] without a column or a row, [`Error::MapTooLarge`] above [`MAX_CELLS`].
    pub fn new(width: u64, height: u64) -> Result<Self, Error> {
        if width == 0 || height == 0 {
            return Err(Error::EmptyMap);
        }
        // Rows are padded to words, so a very tall and narrow plane counts as if it were 64 cells wide.
        if width.max(64).checked_mul(height).is_none_or(|cells| cells > MAX_CELLS) {
            return Err(Error::MapTooLarge { width, height, limit: MAX_CELLS });
        }
        let words_per_row = width.div_ceil(64) as usize;
        let words = vec![0; words_per_row * height as usize];
        Ok(Self { width: width as u32, height: height as u32, words_per_row, words })
    }

    /// The words of row `y`, to be changed; [`BitPlane::trim`] belongs after it.
    pub(crate) fn row_mut(&mut self, y: u32) -> &mut [u64] {
        &mut self.words[y as usize * self.words_per_row..][..self.words_per_row]
    }

    /// Sets the bits behind the last column to 0 again.
    pub(crate) fn trim(&mut self) {
        let beyond = self.width % 64;
        if beyond > 0 {
            for last in self.words.chunks_exact_mut(self.words_per_row).filter_map(|row| row.last_mut()) {
                *last &= !(u64::MAX << beyond);
            }
        }
    }

    /// Columns.
    pub const fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub const fn height(&self) -> u32 {
        self.height
    }

    /// The bit in column `x` of row `y`.
    ///
    /// # Panics
    /// Outside the plane.
    #[inline]
    pub fn get(&self, x: u32, y: u32) -> bool {
        assert!(x < self.width && y < self.height, "bit ({x},{y}) is outside the plane");
        self.words[y as usize * self.words_per_row + x as usize / 64] >> (x % 64) & 1 == 1
    }

    /// Sets the bit in column `x` of row `y`.
    ///
    /// # Panics
    /// Outside the plane.
    #[inline]
    pub fn set(&mut self, x: u32, y: u32, value: bool) {
        assert!(x < self.width && y < self.height, "bit ({x},{y}) is outside the plane");
        let word = &mut self.words[y as usize * self.words_per_row + x as usize / 64];
        *word = *word & !(1 << (x % 64)) | u64::from(value) << (x % 64);
    }

    /// The words of row `y`; bit `x % 64` of word `x / 64` is column `x`.
    ///
    /// # Panics
    /// Outside the plane.
    pub fn row(&self, y: u32) -> &[u64] {
        &self.words[y as usize * self.words_per_row..][..self.words_per_row]
    }

    /// How many bits are 1.
    pub fn count_ones(&self) -> u64 {
        self.words.iter().map(|word| u64::from(word.count_ones())).sum()
    }

    /// The first column in `from..to` of row `y` whose bit is 1.
    ///
    /// # Panics
    /// Outside the plane.
    pub fn first_one(&self, y: u32, from: u32, to: u32) -> Option<u32> {
        let row = self.row(y);
        let to = to.min(self.width);
        let mut x = from;
        while x < to {
            let rest = row[x as usize / 64] >> (x % 64);
            if rest != 0 {
                let found = x + rest.trailing_zeros();
                return (found < to).then_some(found);
            }
            x = (x / 64 + 1) * 64;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn first_one_equals_a_scan() {
        let mut plane = BitPlane::new(200, 2).unwrap();
        for x in [0, 63, 64, 130, 199] {
            plane.set(x, 1, true);
        }
        for from in 0..200 {
            for to in from..=205 {
                let scan = (from..to.min(200)).find(|&x| plane.get(x, 1));
                assert_eq!(plane.first_one(1, from, to), scan);
            }
        }
    }

    #[test]
    fn sizes_are_checked_before_memory_is_taken() {
        assert_eq!(BitPlane::new(0, 3), Err(Error::EmptyMap));
        assert!(matches!(BitPlane::new(4_000_000_000, 4), Err(Error::MapTooLarge { .. })));
        assert!(matches!(BitPlane::new(1, u64::MAX), Err(Error::MapTooLarge { .. })));
        assert!(BitPlane::new(1 << 14, 1 << 14).is_ok());
    }
}
