//! The wave in space-time: one step a slot, through what is open then.

use super::closures::{Closures, Planes};
use super::window::{Rows, add, both, without};
use crate::lattice::{Cell, Dir, Lattice};

/// What the robot does in the next slot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Step {
    /// It stays in its cell.
    Wait,
    /// It moves to the neighbour in this direction.
    Go(Dir),
    /// Whatever it does, an object may touch it: it should stand still and warn.
    NoSafeStep,
}

/// Where the robot is at the begin of each slot.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Plan {
    lattice: Lattice,
    cells: Vec<Cell>,
    sure: usize,
    certain: usize,
    arrival_slots: Option<u32>,
}

impl Plan {
    /// The cells, the present one first. After the safe slots they keep off the places where objects are *likely* to
    /// be, as long as there is a way to.
    pub fn cells(&self) -> &[Cell] {
        &self.cells
    }

    /// For how many slots the plan is safe from all that objects can reach: at most [`Slots::certain`](super::Slots).
    pub fn safe_slots(&self) -> usize {
        self.sure
    }

    /// Whether it is safe for as many slots as were looked at.
    pub fn is_safe(&self) -> bool {
        self.sure == self.certain
    }

    /// After how many slots the robot arrives, if no object gets in its way after those foreseen; `None` where no way
    /// leads to the target.
    pub const fn arrival_slots(&self) -> Option<u32> {
        self.arrival_slots
    }

    /// What to do in the first slot.
    pub fn step(&self) -> Step {
        match self.cells[..] {
            [from, to, ..] if self.sure > 0 => {
                self.lattice.dir_between(from, to).map_or(Step::Wait, Step::Go)
            }
            _ => Step::NoSafeStep,
        }
    }
}

impl Closures {
    /// The plan from `cell` that stays safe longest; then it keeps off the likely places of objects; among such plans it
    /// is the one that arrives first. `steps_to_go` tells how far a cell is from the target:
    /// [`Field::steps`](crate::Field::steps) of the map without moving objects.
    ///
    /// In each slot the wave spreads to the neighbours, and stays where it is, through all that is open: with a bit a
    /// cell, a whole row at once. From its last front it is followed back, which leaves only cells from which the
    /// robot can still be safe to the end: it never enters a trap for an earlier arrival. (Macek, Vasquez, Fraichard
    /// and Siegwart, *Towards Safe Vehicle Navigation in Dynamic Urban Scenarios*, Automatika 2009; Fraichard and
    /// Asama, *Inevitable Collision States*, Advanced Robotics 2004.)
    ///
    /// `cell` must be the one that the closures were made for.
    ///
    /// ```
    /// use activecell::predict::{Closures, Slots, Step};
    /// use activecell::{Cell, Dir, Lattice, Map};
    /// let map = Map::parse(Lattice::Square, "S...F")?;
    /// let field = map.wave(Cell::new(4, 0))?;
    /// let closures = Closures::new(&map, Cell::new(0, 0), Slots::default(), 0.0, &[])?;
    /// let plan = closures.plan(Cell::new(0, 0), |cell| field.steps(cell));
    /// assert_eq!((plan.step(), plan.arrival_slots()), (Step::Go(Dir::E), Some(4)));
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn plan(&self, cell: Cell, steps_to_go: impl Fn(Cell) -> Option<u32>) -> Plan {
        let to_go = |cell: Cell| steps_to_go(cell).unwrap_or(u32::MAX);
        let mut reached = vec![both(&self.window.only(cell), &self.free)];
        let mut sure = self.reach.len();
        while reached.len() <= self.slots() {
            let slot = reached.len() - 1;
            let next = self.onward(self.planes(slot, sure), &reached[slot]);
            if next.iter().any(|&row| row != 0) {
                reached.push(next);
            } else if slot < sure {
                sure = slot;
            } else {
                break;
            }
        }
        let last = reached.len() - 1;
        // Only what leads on to the end.
        for slot in (0..last).rev() {
            reached[slot] = both(&reached[slot], &self.back(self.planes(slot, sure), &reached[slot + 1]));
        }
        let arrives = |slot: &usize| self.window.cells(&reached[*slot]).any(|cell| to_go(cell) == 0);
        let arrival = (0..=last).find(arrives);
        let until = arrival.unwrap_or(last);
        let rest = self.window.cells(&reached[until]).map(to_go).min().unwrap_or(u32::MAX);
        let mut good = vec![self.cells_where(&reached[until], |cell| to_go(cell) == rest)];
        for slot in (0..until).rev() {
            let before = both(&reached[slot], &self.back(self.planes(slot, sure), &good[good.len() - 1]));
            good.push(before);
        }
        good.reverse();
        good.extend(reached.drain(until + 1..));
        Plan {
            lattice: self.window.lattice,
            cells: self.follow(cell, &good, sure, to_go),
            sure,
            certain: self.reach.len(),
            arrival_slots: (rest != u32::MAX).then(|| rest.saturating_add(until as u32)),
        }
    }

    fn cells_where(&self, rows: &[u64], wanted: impl Fn(Cell) -> bool) -> Rows {
        let mut found = self.window.empty();
        for cell in self.window.cells(rows).filter(|&cell| wanted(cell)) {
            self.window.set(&mut found, cell);
        }
        found
    }

    /// Through cells that are all good: nearer to the target first, then rather waiting than moving.
    fn follow(&self, start: Cell, good: &[Rows], sure: usize, to_go: impl Fn(Cell) -> u32) -> Vec<Cell> {
        let lattice = self.window.lattice;
        let mut cells = vec![start];
        let mut here = start;
        for (slot, good) in good.iter().skip(1).enumerate() {
            let ways = std::iter::once(None).chain(lattice.dirs().map(Some));
            let next = ways
                .filter(|&way| !self.has(self.planes(slot, sure), here, way))
                .map(|way| way.map_or(here, |dir| lattice.neighbour(here, dir)))
                .filter(|&next| self.window.has(good, next))
                .min_by_key(|&next| to_go(next));
            let Some(next) = next else { break };
            cells.push(next);
            here = next;
        }
        cells
    }

    /// Where a robot in one of these cells can be after a slot.
    fn onward(&self, closed: &Planes, cells: &[u64]) -> Rows {
        let mut next = without(cells, &closed[closed.len() - 1]);
        for dir in self.window.lattice.dirs() {
            add(&mut next, &self.window.moved(&without(cells, &closed[dir.index()]), dir));
        }
        both(&next, &self.free)
    }

    /// Where a robot can be that is in one of these cells after a slot.
    fn back(&self, closed: &Planes, cells: &[u64]) -> Rows {
        let mut before = without(cells, &closed[closed.len() - 1]);
        for dir in self.window.lattice.dirs() {
            let from = self.window.moved(cells, self.window.lattice.opposite(dir));
            add(&mut before, &without(&from, &closed[dir.index()]));
        }
        before
    }
}
