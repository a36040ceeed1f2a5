//! Bit planes of rows and columns, and the planes that tell where a vertical sweep meets a corner.

use crate::map::{BitPlane, Map};

/// The map as rows and columns of bits, 64 cells a word, prepared for jumps.
///
/// A *forced corner* for a robot that moves down is a cell with a free cell at its side whose upper neighbour is
/// an obstacle: only from here that free cell is reached best. `down` marks the cells from which a sweep straight
/// down comes to such a corner before it comes to an obstacle; `up` likewise.
#[derive(Debug, Clone)]
pub(super) struct Planes {
    /// Words of a row.
    words: usize,
    /// Words of a column.
    deep: usize,
    rows: Vec<Row>,
    /// Free cells by columns, bit `y % 64` of word `y / 64`; one empty column on either side.
    columns: Vec<u64>,
}

/// 64 cells of a row.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Row {
    pub(super) free: u64,
    pub(super) down: u64,
    pub(super) up: u64,
}

/// Where a walk along a row stops.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stop {
    /// The column of a cell from which a vertical sweep meets a corner, or of the first obstacle.
    pub(super) x: i32,
    pub(super) down: bool,
    pub(super) up: bool,
}

/// Free cells of a row of the map, bits outside it 0.
pub(super) fn free_word(obstacles: &BitPlane, y: u32, word: usize) -> u64 {
    let columns = obstacles.width() as usize - word * 64;
    let inside = if columns >= 64 { u64::MAX } else { (1 << columns) - 1 };
    !obstacles.row(y)[word] & inside
}

impl Planes {
    pub(super) fn new(map: &Map) -> Self {
        let obstacles = map.obstacles();
        let (width, height) = (map.width() as usize, map.height() as usize);
        let (words, deep) = (width.div_ceil(64), height.div_ceil(64));
        let mut rows = vec![Row::default(); words * height];
        for y in 0..height {
            for word in 0..words {
                rows[y * words + word].free = free_word(obstacles, y as u32, word);
            }
        }
        let mut planes = Self { words, deep, rows, columns: vec![0; (width + 2) * deep] };
        for y in (1..height).rev() {
            planes.sweep(y - 1, y, |row| &mut row.down);
        }
        for y in 1..height {
            planes.sweep(y, y - 1, |row| &mut row.up);
        }
        planes.transpose(width, height);
        planes
    }

    /// Marks the cells of row `here` whose sweep through row `next` meets a corner.
    fn sweep(&mut self, here: usize, next: usize, plane: fn(&mut Row) -> &mut u64) {
        let (here, next) = (here * self.words, next * self.words);
        // Cells of the next row that open beside an obstacle of this row.
        let opens = |rows: &[Row], word: usize| rows[next + word].free & !rows[here + word].free;
        let (mut before, mut this) = (0, opens(&self.rows, 0));
        for word in 0..self.words {
            let after = if word + 1 < self.words { opens(&self.rows, word + 1) } else { 0 };
            let corners = this << 1 | before >> 63 | this >> 1 | after << 63;
            let beyond = *plane(&mut self.rows[next + word]);
            let free = self.rows[here + word].free & self.rows[next + word].free;
            *plane(&mut self.rows[here + word]) = free & (corners | beyond);
            (before, this) = (this, after);
        }
    }

    fn transpose(&mut self, width: usize, height: usize) {
        for down in 0..self.deep {
            for word in 0..self.words {
                let mut block = [0; 64];
                for (i, bits) in block.iter_mut().enumerate().take(height - down * 64) {
                    *bits = self.rows[(down * 64 + i) * self.words + word].free;
                }
                transpose_block(&mut block);
                for (i, &bits) in block.iter().enumerate().take(width - word * 64) {
                    self.columns[(word * 64 + i + 1) * self.deep + down] = bits;
                }
            }
        }
    }

    #[inline]
    pub(super) fn row(&self, x: i32, y: i32) -> Row {
        self.rows[y as usize * self.words + x as usize / 64]
    }

    /// Whether the cell is free; a column of `-1` or beyond the last is not.
    #[inline]
    pub(super) fn is_free(&self, x: i32, y: i32) -> bool {
        self.columns[(x + 1) as usize * self.deep + y as usize / 64] >> (y % 64) & 1 == 1
    }

    /// Walks east from (x, y) to the first cell where a sweep pays, or the first obstacle.
    #[inline]
    pub(super) fn walk_east(&self, x: i32, y: i32) -> Stop {
        let row = &self.rows[y as usize * self.words..][..self.words];
        let x = x as usize + 1;
        let mut word = x / 64;
        let mut ahead = u64::MAX << (x % 64);
        while let Some(cells) = row.get(word) {
            let stops = (!cells.free | cells.down | cells.up) & ahead;
            if stops != 0 {
                let bit = stops.trailing_zeros();
                return stop(word, bit, *cells);
            }
            word += 1;
            ahead = u64::MAX;
        }
        Stop { x: (self.words * 64) as i32, down: false, up: false }
    }

    /// Walks west likewise.
    #[inline]
    pub(super) fn walk_west(&self, x: i32, y: i32) -> Stop {
        let row = &self.rows[y as usize * self.words..][..self.words];
        let mut ahead = !(u64::MAX << (x % 64));
        for word in (0..=x as usize / 64).rev() {
            let cells = row[word];
            let stops = (!cells.free | cells.down | cells.up) & ahead;
            if stops != 0 {
                return stop(word, stops.ilog2(), cells);
            }
            ahead = u64::MAX;
        }
        Stop { x: -1, down: false, up: false }
    }

    /// The row of the next forced corner below (x, y); there must be one, as `down` tells.
    #[inline]
    pub(super) fn corner_below(&self, x: i32, y: i32) -> i32 {
        let west = &self.columns[x as usize * self.deep..][..self.deep];
        let east = &self.columns[(x as usize + 2) * self.deep..][..self.deep];
        let y = y as usize + 1;
        let mut word = y / 64;
        let mut ahead = u64::MAX << (y % 64);
        let carry = |column: &[u64], word: usize| if word == 0 { 1 } else { column[word - 1] >> 63 };
        let (mut above_w, mut above_e) = (carry(west, word), carry(east, word));
        while word < self.deep {
            let (w, e) = (west[word], east[word]);
            let corners = (w & !(w << 1 | above_w) | e & !(e << 1 | above_e)) & ahead;
            if corners != 0 {
                return (word * 64) as i32 + corners.trailing_zeros() as i32;
            }
            (above_w, above_e) = (w >> 63, e >> 63);
            word += 1;
            ahead = u64::MAX;
        }
        debug_assert!(false, "no corner below");
        y as i32 - 1
    }

    /// The row of the next forced corner above (x, y); there must be one, as `up` tells.
    #[inline]
    pub(super) fn corner_above(&self, x: i32, y: i32) -> i32 {
        let west = &self.columns[x as usize * self.deep..][..self.deep];
        let east = &self.columns[(x as usize + 2) * self.deep..][..self.deep];
        let start = y as usize / 64;
        let mut ahead = !(u64::MAX << (y % 64));
        let carry = |column: &[u64]| if start + 1 < self.deep { column[start + 1] << 63 } else { 0 };
        let (mut below_w, mut below_e) = (carry(west), carry(east));
        for word in (0..=start).rev() {
            let (w, e) = (west[word], east[word]);
            let corners = (w & !(w >> 1 | below_w) | e & !(e >> 1 | below_e)) & ahead;
            if corners != 0 {
                return (word * 64) as i32 + corners.ilog2() as i32;
            }
            (below_w, below_e) = (w << 63, e << 63);
            ahead = u64::MAX;
        }
        debug_assert!(false, "no corner above");
        y
    }

    /// The first and the last row that are seen from (x, y) straight up and down.
    pub(super) fn sight(&self, x: i32, y: i32, height: i32) -> (i32, i32) {
        let column = &self.columns[(x as usize + 1) * self.deep..][..self.deep];
        let start = y as usize / 64;
        let mut first = 0;
        let mut seen = !(u64::MAX << (y % 64));
        for word in (0..=start).rev() {
            let walls = !column[word] & seen;
            if walls != 0 {
                first = (word * 64) as i32 + 64 - walls.leading_zeros() as i32;
                break;
            }
            seen = u64::MAX;
        }
        seen = u64::MAX << (y % 64);
        for (word, bits) in column.iter().enumerate().skip(start) {
            let walls = !bits & seen;
            if walls != 0 {
                return (first, (word * 64) as i32 + walls.trailing_zeros() as i32 - 1);
            }
            seen = u64::MAX;
        }
        (first, height - 1)
    }

    pub(super) fn bytes(&self) -> usize {
        self.rows.capacity() * size_of::<Row>() + self.columns.capacity() * 8
    }
}

#[inline]
fn stop(word: usize, bit: u32, cells: Row) -> Stop {
    Stop {
        x: (word * 64) as i32 + bit as i32,
        down: cells.down >> bit & 1 == 1,
        up: cells.up >> bit & 1 == 1,
    }
}

/// Turns a block of 64 × 64 bits about its diagonal, halves first (Henry S. Warren, *Hacker's Delight*, 2002).
fn transpose_block(block: &mut [u64; 64]) {
    let mut side = 32;
    let mut mask = 0x0000_0000_ffff_ffff_u64;
    while side != 0 {
        let mut i = 0;
        while i < 64 {
            let swap = (block[i] >> side ^ block[i + side]) & mask;
            block[i] ^= swap << side;
            block[i + side] ^= swap;
            i = (i + side + 1) & !side;
        }
        side /= 2;
        mask ^= mask << side;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lattice::{Cell, Lattice};

    /// Whether a robot that comes to `cell` by a step `dy` must look aside there.
    fn forced(map: &Map, cell: Cell, dy: i32) -> bool {
        [-1, 1].iter().any(|dx| {
            map.is_free(Cell::new(cell.x + dx, cell.y)) && !map.is_free(Cell::new(cell.x + dx, cell.y - dy))
        })
    }

    #[test]
    fn sweeps_equal_walks_cell_by_cell() {
        for (seed, (w, h)) in
            [(1, 1), (1, 70), (70, 1), (64, 64), (65, 63), (130, 129)].into_iter().enumerate()
        {
            for density in [0.0, 0.05, 0.3] {
                let map = Map::random(Lattice::Square, w, h, density, seed as u64).unwrap();
                let planes = Planes::new(&map);
                for cell in map.free() {
                    for (dy, bits) in
                        [(1, planes.row(cell.x, cell.y).down), (-1, planes.row(cell.x, cell.y).up)]
                    {
                        let mut walk = (1..).map(|i| Cell::new(cell.x, cell.y + i * dy));
                        let end = walk.find(|&at| !map.is_free(at) || forced(&map, at, dy)).unwrap();
                        let found = bits >> (cell.x % 64) & 1 == 1;
                        assert_eq!(found, map.is_free(end), "{cell} {dy}");
                        if found {
                            let corner = if dy == 1 {
                                planes.corner_below(cell.x, cell.y)
                            } else {
                                planes.corner_above(cell.x, cell.y)
                            };
                            assert_eq!(corner, end.y);
                        }
                    }
                    let (first, last) = planes.sight(cell.x, cell.y, h as i32);
                    assert!((first..=last).all(|y| map.is_free(Cell::new(cell.x, y))));
                    assert!(
                        !map.is_free(Cell::new(cell.x, first - 1))
                            && !map.is_free(Cell::new(cell.x, last + 1))
                    );
                }
            }
        }
    }
}
