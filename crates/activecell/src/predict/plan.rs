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

/// How a robot stands that cannot turn and drive within one slot: it turns on the spot in a slot of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Facing {
    /// Where it faces.
    pub dir: Dir,
    /// Whether it can also drive backwards.
    pub reverses: bool,
}

impl Facing {
    /// The ways that lead on from a heading; without headings all do.
    fn ways(facing: Option<Self>, lattice: Lattice, heading: usize) -> impl Iterator<Item = Dir> {
        lattice.dirs().filter(move |&dir| {
            facing.is_none_or(|facing| {
                let back = facing.reverses && lattice.opposite(dir).index() == heading;
                dir.index() == heading || back
            })
        })
    }
}

/// The cells of a slot, for each heading; one plane alone where headings do not matter.
type Layer = Vec<Rows>;

/// Where the robot is at the begin of each slot.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Plan {
    lattice: Lattice,
    cells: Vec<Cell>,
    turn: Option<Dir>,
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

    /// Where to face at the first slot's end, for a robot that turns in a slot of its own
    /// ([`Avoider::plan_facing`](super::Avoider::plan_facing)); `None` for others.
    pub const fn turn(&self) -> Option<Dir> {
        self.turn
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
        self.plan_facing(cell, None, steps_to_go)
    }

    /// The same for a robot that turns in a slot of its own: the wave spreads over cells and headings.
    pub fn plan_facing(
        &self,
        cell: Cell,
        facing: Option<Facing>,
        steps_to_go: impl Fn(Cell) -> Option<u32>,
    ) -> Plan {
        let to_go = |cell: Cell| steps_to_go(cell).unwrap_or(u32::MAX);
        let headings = facing.map_or(1, |_| usize::from(self.window.lattice.degree()));
        let heading = facing.map_or(0, |facing| facing.dir.index());
        let mut start = vec![self.window.empty(); headings];
        start[heading] = both(&self.window.only(cell), &self.free);
        let mut reached = vec![start];
        let mut sure = self.reach.len();
        while reached.len() <= self.slots() {
            let slot = reached.len() - 1;
            let next = self.onward(self.planes(slot, sure), facing, &reached[slot]);
            if next.iter().flatten().any(|&row| row != 0) {
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
            reached[slot] = self.leading(slot, sure, facing, &reached[slot], &reached[slot + 1]);
        }
        let cells = |slot: usize| reached[slot].iter().flat_map(|rows| self.window.cells(rows));
        let arrives = |slot: &usize| cells(*slot).any(|cell| to_go(cell) == 0);
        let arrival = (0..=last).find(arrives);
        let until = arrival.unwrap_or(last);
        let rest = cells(until).map(to_go).min().unwrap_or(u32::MAX);
        let nearest = reached[until].iter().map(|rows| self.cells_where(rows, |cell| to_go(cell) == rest));
        let mut good: Vec<Layer> = vec![nearest.collect()];
        for slot in (0..until).rev() {
            good.push(self.leading(slot, sure, facing, &reached[slot], &good[good.len() - 1]));
        }
        good.reverse();
        good.extend(reached.drain(until + 1..));
        let states = self.follow((cell, heading), facing, &good, sure, to_go);
        let turn = facing.and_then(|_| states.get(1)).map(|&(_, heading)| Dir(heading as u8));
        Plan {
            lattice: self.window.lattice,
            cells: states.into_iter().map(|(cell, _)| cell).collect(),
            turn,
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

    /// Through cells that are all good: nearer to the target first, then rather waiting than moving, and rather facing
    /// as before.
    fn follow(
        &self,
        start: (Cell, usize),
        facing: Option<Facing>,
        good: &[Layer],
        sure: usize,
        to_go: impl Fn(Cell) -> u32,
    ) -> Vec<(Cell, usize)> {
        let lattice = self.window.lattice;
        let mut states = vec![start];
        let (mut here, mut heading) = start;
        for (slot, good) in good.iter().skip(1).enumerate() {
            let closed = self.planes(slot, sure);
            let turned = std::iter::once(heading).chain(0..good.len());
            let stays = turned.map(|heading| (None, here, heading));
            let ways = Facing::ways(facing, lattice, heading);
            let goes = ways.map(|dir| (Some(dir), lattice.neighbour(here, dir), heading));
            let next = stays
                .chain(goes)
                .filter(|&(way, ..)| !self.has(closed, here, way))
                .filter(|&(_, next, heading)| self.window.has(&good[heading], next))
                .min_by_key(|&(_, next, _)| to_go(next));
            let Some(next) = next else { break };
            (_, here, heading) = next;
            states.push((here, heading));
        }
        states
    }

    /// Where a robot in one of these cells can be after a slot: in a neighbour, or in its cell, whatever it faces then.
    fn onward(&self, closed: &Planes, facing: Option<Facing>, layer: &Layer) -> Layer {
        let stay = self.staying(closed, layer);
        let next = layer.iter().enumerate().map(|(heading, cells)| {
            let mut next = stay.clone();
            for dir in Facing::ways(facing, self.window.lattice, heading) {
                add(&mut next, &self.window.moved(&without(cells, &closed[dir.index()]), dir));
            }
            both(&next, &self.free)
        });
        next.collect()
    }

    /// Those of a slot's cells from which one of the next slot's can be reached.
    fn leading(
        &self,
        slot: usize,
        sure: usize,
        facing: Option<Facing>,
        layer: &Layer,
        next: &Layer,
    ) -> Layer {
        let closed = self.planes(slot, sure);
        let stay = self.staying(closed, next);
        let led = layer.iter().zip(next).enumerate().map(|(heading, (cells, next))| {
            let mut before = stay.clone();
            for dir in Facing::ways(facing, self.window.lattice, heading) {
                let from = self.window.moved(next, self.window.lattice.opposite(dir));
                add(&mut before, &without(&from, &closed[dir.index()]));
            }
            both(cells, &before)
        });
        led.collect()
    }

    /// The cells of any heading in which the robot can stand.
    fn staying(&self, closed: &Planes, layer: &Layer) -> Rows {
        let mut all = self.window.empty();
        for cells in layer {
            add(&mut all, cells);
        }
        without(&all, &closed[closed.len() - 1])
    }
}
