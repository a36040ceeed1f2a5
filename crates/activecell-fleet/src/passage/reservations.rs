//! Which cells and moves are taken, step by step.

use super::layout::Layout;
use crate::floor::Floor;

/// The paths of robots as planes of bits, one set of planes a step: the cells that are still free, and for each kind of
/// edge the edges that a robot crosses, either way. No two robots may take the same cell or edge.
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
    /// Planes of a step: one of free cells, one for each kind of edge.
    kinds: usize,
    planes: Vec<u64>,
}

impl Reservations {
    /// Nothing taken but the obstacles, for steps from 0 to `steps`.
    pub fn new(floor: &Floor, steps: usize) -> Self {
        let layout = Layout::new(floor);
        let kinds = 1 + layout.edges();
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
        (steps + 1) * (1 + layout.edges()) * layout.words() * size_of::<u64>()
    }

    /// The memory that they take, in bytes.
    pub(crate) const fn bytes_kept(&self) -> usize {
        self.planes.capacity() * size_of::<u64>()
    }

    /// Where the cells lie.
    pub const fn layout(&self) -> &Layout {
        &self.layout
    }

    /// The last step.
    pub const fn steps(&self) -> usize {
        self.steps
    }

    /// Takes the cells and edges of a path.
    ///
    /// # Panics
    /// If the path has no cell or leaves the layout.
    pub fn reserve(&mut self, path: &[u32]) {
        self.mark(path.iter().copied(), true);
    }

    /// Gives the cells and edges of a path back.
    ///
    /// # Panics
    /// As [`Self::reserve`].
    pub fn release(&mut self, path: &[u32]) {
        self.mark(path.iter().copied(), false);
    }

    pub(crate) fn mark(&mut self, mut path: impl Iterator<Item = u32>, taken: bool) {
        let words = self.layout.words();
        let mut put = |plane: usize, bit: u32, value: bool| {
            let word = &mut self.planes[plane * words + bit as usize / 64];
            *word = *word & !(1 << (bit % 64)) | u64::from(value) << (bit % 64);
        };
        let mut here = path.next().expect("a path has a cell");
        let mut rests = 0;
        for (step, next) in (0..self.steps).zip(path) {
            let plane = step * self.kinds;
            put(plane, here, !taken);
            if here != next {
                let (kind, edge) = self.layout.edge(here, next);
                put(plane + 1 + kind, edge, taken);
            }
            here = next;
            rests = step + 1;
        }
        (rests..=self.steps).for_each(|step| put(step * self.kinds, here, !taken));
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
    #[inline]
    pub fn allows(&self, step: usize, from: u32, to: u32) -> bool {
        !self.is_taken(step + 1, to) && !self.crosses(step, from, to)
    }

    /// Whether a robot comes the other way.
    #[inline]
    pub(super) fn crosses(&self, step: usize, from: u32, to: u32) -> bool {
        let (kind, edge) = self.layout.edge(from, to);
        from != to && self.get(step, 1 + kind, edge)
    }

    /// The first step, from `least` on, from which on a cell is free for ever; `None` if it is taken at the last step.
    pub fn free_from(&self, bit: u32, least: usize) -> Option<usize> {
        let last_taken = (least..=self.steps.max(least)).rev().find(|&step| self.is_taken(step, bit));
        match last_taken {
            None => Some(least),
            Some(step) if step >= self.steps => None,
            Some(step) => Some(step + 1),
        }
    }

    /// The cells that are free at a step.
    #[inline]
    pub(super) fn free(&self, step: usize) -> &[u64] {
        self.plane(step, 0)
    }

    /// The edges of a kind that are crossed after a step; none after the last.
    #[inline]
    pub(super) fn crossed(&self, step: usize, kind: usize) -> &[u64] {
        self.plane(step, 1 + kind)
    }

    fn plane(&self, step: usize, plane: usize) -> &[u64] {
        let words = self.layout.words();
        &self.planes[(step.min(self.steps) * self.kinds + plane) * words..][..words]
    }
}
