//! Clearance: how far each cell is from the nearest obstacle, and obstacles grown by a radius.
//!
//! Everything outside the map is obstacle, so the map's edge counts too.

use super::{BitPlane, Map};
use crate::error::Error;
use crate::lattice::{Cell, Lattice};

/// For every cell, the steps to the nearest obstacle: 0 in an obstacle, 1 beside one or at the map's edge.
///
/// ```
/// use activecell::{Cell, Lattice, Map};
/// let clearance = Map::parse(Lattice::Square, ".....\n.....\n.....\n....#")?.clearance();
/// assert_eq!(clearance.steps(Cell::new(2, 1)), 2);
/// assert_eq!(clearance.steps(Cell::new(3, 2)), 2); // the obstacle lies across the corner
/// assert_eq!((clearance.steps(Cell::new(4, 3)), clearance.steps(Cell::new(9, 9))), (0, 0));
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Clearance {
    width: u32,
    height: u32,
    /// Row by row. With the edge as obstacle, half the shorter side bounds them: 2¹³ on the largest map.
    steps: Vec<u16>,
}

impl Clearance {
    /// The steps from the cell to the nearest obstacle; 0 outside the map.
    #[inline]
    pub fn steps(&self, cell: Cell) -> u32 {
        let (x, y) = (cell.x as u32, cell.y as u32);
        if x < self.width && y < self.height {
            self.steps[y as usize * self.width as usize + x as usize].into()
        } else {
            0
        }
    }

    /// The largest clearance on the map.
    pub fn most(&self) -> u32 {
        self.steps.iter().copied().max().unwrap_or_default().into()
    }
}

impl Map {
    /// The steps from every cell to the nearest obstacle: the wave with all walls as sources.
    ///
    /// One sweep down and one up give the same as the wave (Rosenfeld and Pfaltz, *Sequential Operations in Digital
    /// Picture Processing*, 1966): a way to the nearest obstacle needs at most two neighbouring directions, in any
    /// order, and each sweep knows half of the directions.
    pub fn clearance(&self) -> Clearance {
        let (width, height) = (self.width() as usize, self.height() as usize);
        // A border of obstacles (0) on every side: one column left, one right, a row above and below.
        let stride = width + 2;
        let mut padded = vec![0u16; stride * (height + 2)];
        for y in 0..height {
            let row = self.obstacles.row(y as u32);
            for (x, steps) in padded[(y + 1) * stride + 1..][..width].iter_mut().enumerate() {
                *steps = if row[x / 64] >> (x % 64) & 1 == 1 { 0 } else { u16::MAX };
            }
        }
        for y in 1..=height {
            let (above, from) = padded.split_at_mut(y * stride);
            nearer_from_above(self.lattice, y - 1, &above[(y - 1) * stride..], &mut from[..stride]);
        }
        for y in (1..=height).rev() {
            let (to, below) = padded.split_at_mut((y + 1) * stride);
            nearer_from_below(self.lattice, y - 1, &below[..stride], &mut to[y * stride..]);
        }
        let rows = padded.chunks_exact(stride).skip(1).take(height);
        let steps = rows.flat_map(|row| &row[1..=width]).copied().collect();
        Clearance { width: self.width(), height: self.height(), steps }
    }

    /// The map with every obstacle, and the map's edge, grown by a disc: a cell becomes an obstacle if an obstacle's
    /// centre, or that of a cell outside, lies at most `radius_cells` from its own, as the crow flies on both
    /// lattices. The unit is a cell's size, the distance between neighbours' centres.
    ///
    /// ```
    /// use activecell::{Lattice, Map};
    /// let map = Map::parse(Lattice::Square, ".......\n.......\n....#..\n.......\n.......")?;
    /// assert_eq!(map.grown(1.0)?.to_text(), "#######\n#...#.#\n#..####\n#...#.#\n#######\n");
    /// assert_eq!(map.grown(0.0)?, map);
    /// # Ok::<(), activecell::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::BadValue`] if the radius is negative or no number.
    pub fn grown(&self, radius_cells: f64) -> Result<Self, Error> {
        if !(radius_cells >= 0.0 && radius_cells.is_finite()) {
            let allowed = "0 or more";
            return Err(Error::BadValue { name: "the radius in cells", value: radius_cells, allowed });
        }
        // Squares of distances are quarters; the slack lets a radius like √3 reach what it was computed from.
        Ok(self.grown_by_quarters((4.0 * radius_cells * radius_cells * (1.0 + 1e-12)).floor() as u64))
    }

    /// [`Map::grown`] by a radius whose square is `quarters` / 4.
    pub(crate) fn grown_by_quarters(&self, quarters: u64) -> Self {
        let (width, height) = (u64::from(self.width()), self.height());
        let side = width.min(height.into());
        if quarters / 4 >= side * side {
            return self.overlaid(|plane| (0..height).for_each(|y| plane.row_mut(y).fill(u64::MAX)));
        }
        let reaches = reaches(self.lattice, quarters);
        self.overlaid(|plane| {
            // Rows so near to the top or bottom that the edge covers them, whatever their columns.
            let rows = reaches.len() - 1;
            for y in (0..height).filter(|&y| (y as usize) < rows || (height - y) as usize <= rows) {
                plane.row_mut(y).fill(u64::MAX);
            }
            // One for the rows straight above and below, one for those half a cell aside: each kind's reach grows
            // towards the middle, the two together do not.
            let mut both = [Widened::new(self.width()), Widened::new(self.width())];
            for y in 0..height {
                for wide in &mut both {
                    wide.start(self.obstacles.row(y));
                }
                // From the farthest row, where the disc is narrowest, to the middle.
                for reach in reaches.iter().rev() {
                    let wide = &mut both[usize::from(reach.shifted)];
                    wide.widen_to(reach.whole());
                    let up = y.checked_sub(reach.rows);
                    let down = Some(y + reach.rows).filter(|&to| to < height && reach.rows > 0);
                    for to in [up, down].into_iter().flatten() {
                        // An odd number of rows away hexagons lie half a cell aside.
                        wide.join(plane.row_mut(to), reach.shifted.then_some(to % 2 == 1));
                    }
                }
            }
        })
    }

    /// The map with changed obstacles.
    pub(super) fn overlaid(&self, change: impl FnOnce(&mut BitPlane)) -> Self {
        let mut plane = (*self.obstacles).clone();
        change(&mut plane);
        plane.trim();
        Self { obstacles: plane.into(), ..self.clone() }
    }

    /// The square of the distance from the cell's centre to the nearest obstacle's, or to that of a cell outside, in
    /// quarters of a cell; 0 for an obstacle.
    pub(crate) fn room_in_quarters(&self, cell: Cell) -> u64 {
        if !self.is_free(cell) {
            return 0;
        }
        // Outward row by row, until the rows alone are farther than the best.
        let mut best = u64::MAX;
        for rows in 0.. {
            if rows_apart_quarters(self.lattice, rows) >= best {
                return best;
            }
            for y in [cell.y - rows as i32, cell.y + rows as i32] {
                best = best.min(self.room_in_row(cell, y, best));
            }
        }
        best
    }

    /// [`Map::room_in_quarters`], to the cells of row `y` alone; looks no farther than `best`.
    fn room_in_row(&self, cell: Cell, y: i32, best: u64) -> u64 {
        let far = (best.isqrt() / 2 + 1).min(u64::from(self.width()) + 1) as i32;
        let quarters = |x: i32| quarters_apart(self.lattice, cell, Cell::new(x, y));
        let is_obstacle = |x: &i32| !self.is_free(Cell::new(*x, y));
        let left = (cell.x - far..=cell.x).rev().find(is_obstacle).map_or(u64::MAX, quarters);
        let right = (cell.x..=cell.x + far).find(is_obstacle).map_or(u64::MAX, quarters);
        left.min(right)
    }
}

/// The square of the distance between two cells' centres, in quarters of a cell's size.
fn quarters_apart(lattice: Lattice, a: Cell, b: Cell) -> u64 {
    let ((ax, ay), (bx, by)) = (lattice.centre(a), lattice.centre(b));
    let (dx, dy) = ((ax - bx).unsigned_abs(), (ay - by).unsigned_abs());
    match lattice {
        Lattice::Square => dx * dx + dy * dy,
        // The unit down is 1/√3 of the unit across.
        Lattice::Hex => dx * dx + dy * dy / 3,
    }
}

/// The square of the distance between two rows, in quarters.
fn rows_apart_quarters(lattice: Lattice, rows: u32) -> u64 {
    let rows = u64::from(rows);
    match lattice {
        Lattice::Square => 4 * rows * rows,
        Lattice::Hex => 3 * rows * rows,
    }
}

/// How far a disc reaches to either side, so many rows from its middle.
struct Reach {
    rows: u32,
    /// In half cells.
    half: u64,
    /// Whether the cells of those rows lie half a cell aside.
    shifted: bool,
}

impl Reach {
    /// Whole cells to either side; a row that lies aside has one cell more, on the side to which it lies.
    const fn whole(&self) -> u32 {
        (if self.shifted { self.half.div_ceil(2) - 1 } else { self.half / 2 }) as u32
    }
}

/// The rows of a disc, from the middle outward.
fn reaches(lattice: Lattice, quarters: u64) -> Vec<Reach> {
    let rows = (0u32..).map_while(|rows| {
        let half = quarters.checked_sub(rows_apart_quarters(lattice, rows))?.isqrt();
        Some(Reach { rows, half, shifted: lattice == Lattice::Hex && rows % 2 == 1 })
    });
    // Half a cell is needed to reach a cell that lies half a cell aside.
    rows.take_while(|reach| !reach.shifted || reach.half > 0).collect()
}

/// A row of obstacles that grows wider and wider to both sides, with obstacles beyond its ends.
struct Widened {
    width: u32,
    /// How far it was widened.
    by: u32,
    /// A word of obstacles before and after the row.
    words: Vec<u64>,
    next: Vec<u64>,
}

impl Widened {
    fn new(width: u32) -> Self {
        let words = width.div_ceil(64) as usize + 2;
        Self { width, by: 0, words: vec![0; words], next: vec![u64::MAX; words] }
    }

    fn start(&mut self, row: &[u64]) {
        let last = row.len() + 1;
        self.words[0] = u64::MAX;
        self.words[1..last].copy_from_slice(row);
        self.words[last] = u64::MAX;
        let beyond = self.width % 64;
        if beyond > 0 {
            self.words[last - 1] |= u64::MAX << beyond;
        }
        self.by = 0;
    }

    /// Widens by shifts of growing length: what reaches `by` cells can jump over a gap of twice that.
    fn widen_to(&mut self, by: u32) {
        while self.by < by {
            let shift = (by - self.by).min(2 * self.by + 1).min(63);
            let (words, end) = (&self.words, self.words.len());
            let beside = words[..end - 2].iter().zip(&words[2..]);
            let row = self.next[1..end - 1].iter_mut().zip(&words[1..end - 1]);
            for ((next, here), (before, after)) in row.zip(beside) {
                let right = here << shift | before >> (64 - shift);
                let left = here >> shift | after << (64 - shift);
                *next = here | left | right;
            }
            std::mem::swap(&mut self.words, &mut self.next);
            self.by += shift;
        }
    }

    /// Joins the obstacles to a row; `aside` says that this row's cells reach one cell more to the left (`true`) or
    /// to the right.
    fn join(&self, row: &mut [u64], aside: Option<bool>) {
        let end = self.words.len();
        let (before, here, after) = (&self.words[..end - 2], &self.words[1..end - 1], &self.words[2..]);
        let pairs = row.iter_mut().zip(here);
        match aside {
            None => pairs.for_each(|(row, here)| *row |= here),
            // The row lies to the right of this one: its cell x touches the cells x and x + 1 here.
            Some(true) => {
                pairs.zip(after).for_each(|((row, here), after)| *row |= here | here >> 1 | after << 63);
            }
            Some(false) => {
                pairs.zip(before).for_each(|((row, here), before)| *row |= here | here << 1 | before >> 63);
            }
        }
    }
}

/// Takes what comes from the row above and from the left. Rows have a border of one column on both sides.
fn nearer_from_above(lattice: Lattice, y: usize, above: &[u16], row: &mut [u16]) {
    let inner = 1..row.len() - 1;
    for x in inner.clone() {
        row[x] = row[x].min(nearest_beside(lattice, y, above, x) + 1);
    }
    for x in inner {
        row[x] = row[x].min(row[x - 1] + 1);
    }
}

/// Takes what comes from the row below and from the right.
fn nearer_from_below(lattice: Lattice, y: usize, below: &[u16], row: &mut [u16]) {
    let inner = 1..row.len() - 1;
    for x in inner.clone() {
        row[x] = row[x].min(nearest_beside(lattice, y, below, x) + 1);
    }
    for x in inner.rev() {
        row[x] = row[x].min(row[x + 1] + 1);
    }
}

/// The least of the neighbours in the row above or below; both rows lie alike beside an odd or even one.
#[inline]
fn nearest_beside(lattice: Lattice, y: usize, other: &[u16], x: usize) -> u16 {
    match (lattice, y % 2) {
        (Lattice::Square, _) => other[x],
        (Lattice::Hex, 0) => other[x - 1].min(other[x]),
        (Lattice::Hex, _) => other[x].min(other[x + 1]),
    }
}
