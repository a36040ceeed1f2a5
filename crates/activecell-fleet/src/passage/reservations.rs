//! Which cells and moves are taken, step by step.

use super::layout::Layout;
use crate::floor::Floor;
use activecell::Dir;

/// The paths of robots as planes of bits, one set of planes a step: the cells that are still free, and for each
/// direction the cells from which a robot moves that way. No two robots may take the same cell or move.
///
/// A path has a cell for each step from 0 on, as bits of the [`Layout`]; after its end the robot rests in its last cell.
/// Steps are kept from 0 to a last one; what holds there holds for ever after.
///
/// Source: the reservation table of D. Silver, *Cooperative Pathfinding*, AIIDE 2005, turned into planes.
///
/// ```
/// use activecell::{Cell, Lattice, Map};
/// use activecell_fleet::{Floor, Reservations};
/// let map = Map::parse(Lattice::Square, "...")?;
/// let mut taken = Reservations::new(&Floor::new(&map), 4);
/// let [west, mid, east] = [0, 1, 2].map(|x| taken.layout().bit(Cell::new(x, 0)));
/// taken.reserve(&[west, mid, east]);
/// assert!(taken.is_taken(1, mid) && !taken.is_taken(2, mid) && taken.is_taken(4, east));
/// assert!(!taken.allows(0, mid, west)); // they would swap
/// taken.release(&[west, mid, east]);
/// assert!(taken.allows(0, mid, west));
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Reservations {
    layout: Layout,
    steps: usize,
    /// Planes of a step: one of free cells, one for each direction.
    kinds: usize,
    planes: Vec<u64>,
}

impl Reservations {
    /// Nothing taken but the obstacles, for steps from 0 to `steps`.
    pub fn new(floor: &Floor, steps: usize) -> Self {
        let layout = Layout::new(floor);
        let kinds = 1 + usize::from(layout.lattice().degree());
        let free = layout.plane(floor.map().free());
        let mut planes = vec![0; (steps + 1) * kinds * layout.words()];
        for step in planes.chunks_exact_mut(kinds * layout.words()) {
            step[..layout.words()].copy_from_slice(&free);
        }
        Self { layout, steps, kinds, planes }
    }

    /// The memory that reservations for this floor take, in bytes.
    pub fn bytes(floor: &Floor, steps: usize) -> usize {
        let layout = Layout::new(floor);
        (steps + 1) * (1 + usize::from(layout.lattice().degree())) * layout.words() * size_of::<u64>()
    }

    /// Where the cells lie.
    pub const fn layout(&self) -> &Layout {
        &self.layout
    }

    /// The last step.
    pub const fn steps(&self) -> usize {
        self.steps
    }

    /// Takes the cells and moves of a path.
    ///
    /// # Panics
    /// If the path has no cell or leaves the layout.
    pub fn reserve(&mut self, path: &[u32]) {
        self.mark(path, true);
    }

    /// Gives the cells and moves of a path back.
    ///
    /// # Panics
    /// As [`Self::reserve`].
    pub fn release(&mut self, path: &[u32]) {
        self.mark(path, false);
    }

    fn mark(&mut self, path: &[u32], taken: bool) {
        let last = *path.last().expect("a path has a cell");
        for step in 0..=self.steps {
            let here = path.get(step).copied().unwrap_or(last);
            let next = path.get(step + 1).copied().unwrap_or(last);
            self.set(step, 0, here, !taken);
            if here != next && step < self.steps {
                let dir = self.dir(here, next).expect("a path leads to neighbours");
                self.set(step, 1 + dir.index(), here, taken);
            }
        }
    }

    fn dir(&self, from: u32, to: u32) -> Option<Dir> {
        self.layout.lattice().dir_between(self.layout.cell(from), self.layout.cell(to))
    }

    #[inline]
    fn set(&mut self, step: usize, kind: usize, bit: u32, value: bool) {
        let at = (step * self.kinds + kind) * self.layout.words() + bit as usize / 64;
        let word = &mut self.planes[at];
        *word = *word & !(1 << (bit % 64)) | u64::from(value) << (bit % 64);
    }

    #[inline]
    fn get(&self, step: usize, kind: usize, bit: u32) -> bool {
        let at = (step.min(self.steps) * self.kinds + kind) * self.layout.words() + bit as usize / 64;
        self.planes[at] >> (bit % 64) & 1 == 1
    }

    /// Whether a cell is an obstacle or taken at a step.
    #[inline]
    pub fn is_taken(&self, step: usize, bit: u32) -> bool {
        !self.get(step, 0, bit)
    }

    /// Whether a robot may go from a cell at `step` to the same or a neighbouring cell at the next: that cell is free then,
    /// and nobody comes the other way.
    pub fn allows(&self, step: usize, from: u32, to: u32) -> bool {
        let swaps = || {
            let back = self.dir(to, from);
            step < self.steps && back.is_some_and(|back| self.get(step, 1 + back.index(), to))
        };
        !self.is_taken(step + 1, to) && (from == to || !swaps())
    }

    /// The first step from which on a cell is free for ever; `None` if it is taken at the last step.
    pub fn free_from(&self, bit: u32) -> Option<usize> {
        let last_taken = (0..=self.steps).rev().find(|&step| self.is_taken(step, bit));
        match last_taken {
            None => Some(0),
            Some(step) if step == self.steps => None,
            Some(step) => Some(step + 1),
        }
    }

    /// The cells that are free at a step.
    #[inline]
    pub(super) fn free(&self, step: usize) -> &[u64] {
        &self.planes[step.min(self.steps) * self.kinds * self.layout.words()..][..self.layout.words()]
    }

    /// The cells from which robots move in a direction at a step; `None` where none moves any more.
    #[inline]
    pub(super) fn moving(&self, step: usize, dir: Dir) -> Option<&[u64]> {
        let words = self.layout.words();
        let at = (step * self.kinds + 1 + dir.index()) * words;
        (step < self.steps).then(|| &self.planes[at..at + words])
    }
}
