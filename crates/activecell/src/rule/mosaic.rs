//! The published rule, cell view: every cell of the mosaic runs the same small automaton (figures 5–8).
//!
//! One time step has four phases. In each, a cell knows its own state and what its direct neighbours show it,
//! nothing else:
//!
//! 1. *direction*: the active cell compares its coordinates with the target's and shows each neighbour which
//!    elementary rule to apply, and in which order it will be asked (figure 6);
//! 2. *permission*: a cell that is shown a rule encodes its neighbourhood relative to the side the signal came
//!    from, the opposite cell first, and answers whether it would take the value 0 (figure 8). Permission is a
//!    signal of its own; the map's bit never changes by it;
//! 3. *activation*: the active cell raises one of its outputs Y, towards the first permitted neighbour (figure 7);
//! 4. *transition*: the cell that is shown Y becomes active, the active cell becomes inactive (figure 5).

use super::{Candidate, Decision, Sector, Wolfram};
use crate::lattice::{Cell, Dir, Lattice};
use crate::map::Map;

/// What a cell shows on one of its sides.
#[derive(Debug, Clone, Copy, Default)]
struct Side {
    /// From the active cell: apply this rule.
    apply: Option<Wolfram>,
    /// To the active cell: permitted.
    permit: bool,
    /// From the active cell: become active.
    activate: bool,
}

/// One cell of the mosaic.
#[derive(Debug, Clone, Default)]
struct CellState {
    /// The map's bit: 1 for an obstacle.
    obstacle: bool,
    /// Whether the robot is here.
    active: bool,
    /// What this cell shows each neighbour.
    sides: [Side; 6],
}

/// The whole mosaic, with one active cell on its way to a target.
///
/// ```
/// use activecell::{Cell, Lattice, Map, rule::Mosaic};
/// let map = Map::parse(Lattice::Square, "...\n.#.\n...")?;
/// let mut mosaic = Mosaic::new(&map, Cell::new(0, 2), Cell::new(1, 0));
/// while mosaic.active() != Cell::new(1, 0) {
///     mosaic.step();
/// }
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Mosaic {
    lattice: Lattice,
    width: i32,
    height: i32,
    target: Cell,
    cells: Vec<CellState>,
}

impl Mosaic {
    /// A mosaic over this map in which `start` is active.
    pub fn new(map: &Map, start: Cell, target: Cell) -> Self {
        let (width, height) = (map.width() as i32, map.height() as i32);
        let state = |i: i32| {
            let cell = Cell::new(i % width, i / width);
            CellState { obstacle: !map.is_free(cell), active: cell == start, ..CellState::default() }
        };
        let cells = (0..width * height).map(state).collect();
        Self { lattice: map.lattice(), width, height, target, cells }
    }

    /// The active cell.
    ///
    /// # Panics
    /// If the start lay outside the map: then no cell is active.
    pub fn active(&self) -> Cell {
        let index = self.cells.iter().position(|cell| cell.active).expect("the start is on the map");
        Cell::new(index as i32 % self.width, index as i32 / self.width)
    }

    /// One time step of every cell; says what the active cell did, `None` once it is at the target.
    pub fn step(&mut self) -> Option<Decision> {
        let arrived = self.active() == self.target;
        self.every_cell(Self::direction);
        self.every_cell(Self::permission);
        self.every_cell(Self::activation);
        let sides =
            self.cells.iter().find(|cell| cell.active).map_or([Side::default(); 6], |cell| cell.sides);
        self.every_cell(Self::transition);
        let raised = self.lattice.dirs().find(|dir| sides[dir.index()].activate);
        (!arrived).then(|| raised.map_or(Decision::Enclosed, Decision::Move))
    }

    /// All cells compute at once from what was shown before, then all show the result.
    fn every_cell(&mut self, phase: impl Fn(&Self, Cell) -> CellState) {
        let (width, height) = (self.width, self.height);
        let cells = (0..height).flat_map(|y| (0..width).map(move |x| Cell::new(x, y)));
        self.cells = cells.map(|cell| phase(self, cell)).collect();
    }

    fn own(&self, cell: Cell) -> &CellState {
        &self.cells[(cell.y * self.width + cell.x) as usize]
    }

    /// The neighbour's state, as far as it may be looked at: beyond the edge everything is an obstacle.
    fn neighbour(&self, cell: Cell, dir: Dir) -> CellState {
        let Cell { x, y } = self.lattice.neighbour(cell, dir);
        if (0..self.width).contains(&x) && (0..self.height).contains(&y) {
            self.own(Cell::new(x, y)).clone()
        } else {
            CellState { obstacle: true, ..CellState::default() }
        }
    }

    /// What the neighbour in this direction shows on the side that touches this cell.
    fn shown(&self, cell: Cell, dir: Dir) -> Side {
        self.neighbour(cell, dir).sides[self.lattice.opposite(dir).index()]
    }

    /// The active cell's order of looking; empty at the target.
    fn order(&self, cell: Cell) -> Vec<Candidate> {
        let near = self.lattice.distance(cell, self.target) == 1;
        let sector = Sector::towards(self.lattice, cell, self.target).into_iter();
        sector.flat_map(|sector| sector.candidates(self.lattice, near)).collect()
    }

    fn direction(&self, cell: Cell) -> CellState {
        let mut next = CellState { sides: [Side::default(); 6], ..self.own(cell).clone() };
        if next.active {
            for candidate in self.order(cell) {
                next.sides[candidate.dir.index()].apply = Some(candidate.closed_by);
            }
        }
        next
    }

    fn permission(&self, cell: Cell) -> CellState {
        let mut next = self.own(cell).clone();
        for from in self.lattice.dirs() {
            if let Some(rule) = self.shown(cell, from).apply {
                let ahead = self.lattice.opposite(from);
                let triple =
                    [-1, 0, 1].map(|turn| self.neighbour(cell, self.lattice.turned(ahead, turn)).obstacle);
                next.sides[from.index()].permit = !next.obstacle && !rule.next(triple);
            }
        }
        next
    }

    fn activation(&self, cell: Cell) -> CellState {
        let mut next = self.own(cell).clone();
        if next.active {
            let order = self.order(cell);
            let permitted =
                order.iter().map(|candidate| candidate.dir).find(|&dir| self.shown(cell, dir).permit);
            let retreat = || {
                let mut clockwise = Sector::towards(self.lattice, cell, self.target)?.clockwise(self.lattice);
                clockwise.find(|&dir| !self.neighbour(cell, dir).obstacle)
            };
            if let Some(dir) = permitted.or_else(retreat) {
                next.sides[dir.index()].activate = true;
            }
        }
        next
    }

    fn transition(&self, cell: Cell) -> CellState {
        let own = self.own(cell);
        let left = own.sides.iter().any(|side| side.activate);
        let entered = self.lattice.dirs().any(|from| self.shown(cell, from).activate);
        CellState { active: entered || own.active && !left, ..own.clone() }
    }
}
