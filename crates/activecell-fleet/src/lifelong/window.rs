//! The next steps of all robots, as planes of bits.

use super::ground::{Ground, Place};
use crate::floor::NONE;
use activecell::Lattice;

/// The columns of a plane that the wave reads: one word a row.
pub(super) const COLUMNS: i32 = 64;

/// Who is where in the steps from now (0) to the end of the window, and what is still free: a plane of free cells a step, and one
/// for each direction with the cells from which a robot moves that way. The steps lie in a ring, so that time passes
/// by counting on. After the last step all robots rest.
///
/// A row takes one word if the map is at most 64 cells wide, else some more than it needs, so that the 64 columns around a
/// robot can be cut out everywhere.
#[derive(Debug, Clone)]
pub(super) struct Window {
    steps: usize,
    /// Where step 0 lies in the ring.
    now: usize,
    kinds: usize,
    rows: usize,
    /// Words of a row.
    words: usize,
    /// Bits before the first column.
    pad: i32,
    planes: Vec<u64>,
    spots: usize,
    owners: Vec<u32>,
}

impl Window {
    /// Nobody is anywhere.
    pub(super) fn new(ground: &Ground, steps: usize) -> Self {
        let (words, pad) = if ground.width as i32 <= COLUMNS {
            (1, 0)
        } else {
            ((ground.width as i32 + COLUMNS / 2 + COLUMNS) as usize / 64 + 1, COLUMNS / 2)
        };
        let kinds = 1 + usize::from(ground.lattice.degree());
        let rows = ground.height as usize;
        let mut window = Self {
            steps,
            now: 0,
            kinds,
            rows,
            words,
            pad,
            planes: vec![0; (steps + 1) * kinds * rows * words],
            spots: ground.spots(),
            owners: vec![NONE; (steps + 1) * ground.spots()],
        };
        for step in 0..=steps {
            for cell in ground.map.free() {
                window.flip(step, 0, cell.x, cell.y);
            }
        }
        window
    }

    const fn slot(&self, step: usize) -> usize {
        let at = self.now + step;
        if at > self.steps { at - self.steps - 1 } else { at }
    }

    const fn plane(&self, step: usize, kind: usize) -> usize {
        (self.slot(step) * self.kinds + kind) * self.rows * self.words
    }

    #[inline]
    fn flip(&mut self, step: usize, kind: usize, x: i32, y: i32) {
        let bit = x + self.pad;
        let at = self.plane(step, kind) + y as usize * self.words + bit as usize / 64;
        self.planes[at] ^= 1 << (bit % 64);
    }

    #[inline]
    fn get(&self, step: usize, kind: usize, x: i32, y: i32) -> bool {
        let bit = x + self.pad;
        let at = self.plane(step, kind) + y as usize * self.words + bit as usize / 64;
        self.planes[at] >> (bit % 64) & 1 == 1
    }

    /// Who is in a cell at a step, or [`NONE`].
    #[inline]
    pub(super) fn owner(&self, step: usize, spot: u32) -> u32 {
        self.owners[self.slot(step) * self.spots + spot as usize]
    }

    /// Takes what a path takes, in the name of a robot.
    pub(super) fn reserve(&mut self, ground: &Ground, path: &[Place], robot: u32) {
        self.toggle(ground, path, robot);
    }

    /// Gives back what a path takes.
    pub(super) fn release(&mut self, ground: &Ground, path: &[Place]) {
        self.toggle(ground, path, NONE);
    }

    fn toggle(&mut self, ground: &Ground, path: &[Place], owner: u32) {
        for (step, place) in path.iter().enumerate() {
            let spot = place.spot();
            let (x, y) = (ground.x(spot), ground.y(spot));
            self.flip(step, 0, x, y);
            let slot = self.slot(step);
            self.owners[slot * self.spots + spot as usize] = owner;
            if let Some(next) = path.get(step + 1).filter(|next| next.spot() != spot) {
                let dir = ground.direction(spot, next.spot());
                self.flip(step, 1 + dir as usize, x, y);
            }
        }
    }

    /// Whether somebody comes the other way while a robot goes from one cell to a neighbour.
    #[inline]
    pub(super) fn crosses(&self, ground: &Ground, step: usize, from: u32, to: u32) -> bool {
        from != to && {
            let back = ground.direction(to, from);
            self.get(step, 1 + back as usize, ground.x(to), ground.y(to))
        }
    }

    /// A step passes: step 1 becomes step 0, and all robots rest a step longer.
    pub(super) fn pass(&mut self) {
        let size = self.rows * self.words;
        let (old, new) = (self.slot(self.steps), self.now);
        let planes = self.kinds * size;
        self.planes.copy_within(old * planes..old * planes + size, new * planes);
        self.planes[new * planes + size..(new + 1) * planes].fill(0);
        self.owners.copy_within(old * self.spots..(old + 1) * self.spots, new * self.spots);
        self.now = self.slot(1);
    }

    /// The column of the first bit of words cut out around a column.
    pub(super) const fn first_column(&self, x: i32) -> i32 {
        if self.words == 1 { 0 } else { x - (COLUMNS / 2 - 1) }
    }

    /// The words of rows of a plane, from the given column on.
    #[inline]
    pub(super) fn cut<'a>(
        &'a self,
        step: usize,
        kind: usize,
        column: i32,
        rows: std::ops::Range<usize>,
        scratch: &'a mut Vec<u64>,
    ) -> &'a [u64] {
        let plane = self.plane(step, kind);
        if self.words == 1 {
            return &self.planes[plane + rows.start..plane + rows.end];
        }
        let bit = (column + self.pad) as usize;
        let (word, shift) = (bit / 64, bit % 64);
        scratch.clear();
        let rows = self.planes[plane + rows.start * self.words..plane + rows.end * self.words]
            .chunks_exact(self.words);
        scratch.extend(rows.map(|row| row[word] >> shift | row[word + 1] << 1 << (63 - shift)));
        scratch
    }

    /// The memory that it takes, in bytes.
    pub(super) fn bytes(&self) -> usize {
        self.planes.capacity() * size_of::<u64>() + self.owners.capacity() * size_of::<u32>()
    }
}

/// How the words of a row move when cells go in a direction, by the parity of the row that they leave: bits to the left
/// (towards higher columns), or to the right.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stride {
    pub(super) rows: i32,
    pub(super) left: [u32; 2],
    pub(super) right: [u32; 2],
}

impl Stride {
    /// The strides of all directions.
    pub(super) fn all(lattice: Lattice) -> Vec<Self> {
        let stride = |dir| {
            let dx = [0, 1].map(|y| {
                let from = activecell::Cell::new(4, 4 + y);
                lattice.neighbour(from, dir).x - from.x
            });
            let from = activecell::Cell::new(4, 4);
            Self {
                rows: lattice.neighbour(from, dir).y - from.y,
                left: dx.map(|dx| dx.max(0) as u32),
                right: dx.map(|dx| (-dx).max(0) as u32),
            }
        };
        lattice.dirs().map(stride).collect()
    }
}
