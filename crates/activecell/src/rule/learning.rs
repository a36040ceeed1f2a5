//! The learning rule: each cell keeps a level that only rises, and the active cell moves to the lowest.

use super::Sector;
use crate::lattice::{Cell, Dir};
use crate::map::Map;

/// The levels of all cells, as one robot on its way to one target has learnt them.
///
/// At first a cell's level is its lattice distance to the target. The active cell raises its own to one more
/// than the lowest of its free neighbours, then moves to the lowest, ties in the published rule's order. This
/// is LRTA* (R. Korf, *Real-Time Heuristic Search*, Artificial Intelligence 42, 1990): on a finite map it
/// reaches every reachable target, also when obstacles are only found on the way.
///
/// That a target is unreachable is known when every free cell that was ever seen beside the robot's way has
/// been visited: the robot then knows the whole of the part it is in. (A level above the number of free cells
/// proves the same, but later.)
///
/// ```
/// use activecell::{Cell, Lattice, Map, rule::Levels};
/// let map = Map::parse(Lattice::Square, "S#F\n...")?;
/// let (mut cell, target) = (Cell::new(0, 0), Cell::new(2, 0));
/// let mut levels = Levels::new(&map, target);
/// let mut steps = 0;
/// while cell != target {
///     let Some(dir) = levels.step(&map, cell) else { unreachable!() };
///     cell = map.lattice().neighbour(cell, dir);
///     steps += 1;
/// }
/// assert_eq!(steps, 4);
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Levels {
    target: Cell,
    /// Above the lattice distance; 0 where nothing was learnt.
    learnt: Vec<u32>,
    seen: Vec<Seen>,
    /// Free cells seen but not yet visited.
    frontier: usize,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Seen {
    Not,
    Beside,
    Visited,
}

impl Levels {
    /// Nothing learnt yet.
    pub fn new(map: &Map, target: Cell) -> Self {
        Self { target, learnt: vec![0; map.cells()], seen: vec![Seen::Not; map.cells()], frontier: 0 }
    }

    /// The level of a cell of the map.
    pub fn level(&self, map: &Map, cell: Cell) -> u32 {
        let learnt = map.index(cell).map_or(0, |index| self.learnt[index]);
        map.lattice().distance(cell, self.target) + learnt
    }

    /// One step from the active cell: raises its level and says where to move; `None` once it is known that the
    /// target cannot be reached (and at the target itself). `cell` must be a free cell of the map for which the levels were made.
    pub fn step(&mut self, map: &Map, cell: Cell) -> Option<Dir> {
        let lattice = map.lattice();
        self.visit(map, cell);
        if self.frontier == 0 {
            return None;
        }
        let order = Sector::towards(lattice, cell, self.target)?.candidates(lattice, false);
        let neighbours = order.map(|c| (c.dir, lattice.neighbour(cell, c.dir)));
        let free = neighbours.filter(|&(_, next)| map.is_free(next));
        // Of equal levels the first in the order.
        let lowest = free.map(|(dir, next)| (self.level(map, next), dir)).min_by_key(|&(level, _)| level);
        let (level, dir) = lowest?;
        let index = map.index(cell)?;
        let raised = (level + 1).saturating_sub(lattice.distance(cell, self.target));
        self.learnt[index] = self.learnt[index].max(raised);
        Some(dir)
    }

    /// Takes note that a cell of the map has become free or an obstacle.
    ///
    /// Where cells only close, what was learnt stays true: ways become longer. Where one opened, levels may be too
    /// high; the robot still arrives, but a high level proves nothing any more.
    pub(crate) fn changed(&mut self, map: &Map, cell: Cell) {
        let Some(index) = map.index(cell) else { return };
        let lattice = map.lattice();
        let visited = |near: Cell| map.index(near).is_some_and(|index| self.seen[index] == Seen::Visited);
        match (self.seen[index], map.is_free(cell)) {
            (Seen::Beside, false) => {
                self.seen[index] = Seen::Not;
                self.frontier -= 1;
            }
            (Seen::Not, true) if lattice.dirs().any(|dir| visited(lattice.neighbour(cell, dir))) => {
                self.seen[index] = Seen::Beside;
                self.frontier += 1;
            }
            _ => {}
        }
    }

    fn visit(&mut self, map: &Map, cell: Cell) {
        let Some(index) = map.index(cell) else { return };
        match self.seen[index] {
            Seen::Visited => return,
            Seen::Beside => self.frontier -= 1,
            Seen::Not => {}
        }
        self.seen[index] = Seen::Visited;
        for dir in map.lattice().dirs() {
            let next = map.lattice().neighbour(cell, dir);
            if let Some(index) = map.index(next).filter(|_| map.is_free(next))
                && self.seen[index] == Seen::Not
            {
                self.seen[index] = Seen::Beside;
                self.frontier += 1;
            }
        }
    }
}
