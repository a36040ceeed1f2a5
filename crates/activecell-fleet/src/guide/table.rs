//! Who means to be where when: the ways of all robots through the next steps.

use crate::floor::NONE;

/// What a step costs that collides with another robot's, beside the step itself.
pub(super) const COLLISION: u32 = 2;

/// The cells of each robot's way, and the robots of each cell, at each time of a window. A time is known by its slot, the
/// remainder of a power of two.
#[derive(Debug, Clone)]
pub(super) struct Table {
    slots: u32,
    spots: Vec<Spot>,
    /// The robot last entered in each cell and slot, or [`NONE`].
    heads: Vec<u32>,
    /// For each robot and slot, the robot entered in the same cell and slot before it.
    nexts: Vec<u32>,
    /// The cell of each robot and slot.
    ways: Vec<u32>,
}

/// A cell, with a bit for each slot.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Spot {
    /// Whether a way leads through here.
    taken: u32,
    /// Whether the search for a way has been here.
    seen: u32,
    /// Whether a robot rests here.
    rest: bool,
    /// Where the searching robot's way from start to target goes on from here: the cell's number plus one, or 0.
    pub(super) lead: u32,
}

impl Table {
    /// For times that differ by less than `times`, at most 32.
    pub(super) fn new(cells: usize, robots: usize, times: u32) -> Self {
        let slots = times.next_power_of_two();
        let entries = |count: usize| vec![NONE; count * slots as usize];
        let spots = vec![Spot::default(); cells];
        Self { slots, spots, heads: entries(cells), nexts: entries(robots), ways: entries(robots) }
    }

    /// The memory that a table takes, in bytes.
    pub(super) const fn bytes(cells: usize, robots: usize, times: u32) -> usize {
        let slots = times.next_power_of_two() as usize;
        cells * size_of::<Spot>() + (cells + 2 * robots) * slots * size_of::<u32>()
    }

    /// The cell of a robot's way at a time.
    #[inline]
    pub(super) fn cell(&self, robot: u32, time: u32) -> u32 {
        self.ways[self.entry(robot, time)]
    }

    #[inline]
    pub(super) fn spot(&mut self, cell: u32) -> &mut Spot {
        &mut self.spots[cell as usize]
    }

    pub(super) fn rest(&mut self, cell: u32, rests: bool) {
        self.spots[cell as usize].rest = rests;
    }

    /// Whether the search has been in a cell at a time.
    #[inline]
    pub(super) fn seen(&self, cell: u32, time: u32) -> bool {
        self.spots[cell as usize].seen & self.bit(time) != 0
    }

    /// Notes that the search is in a cell at a time; false if it has been there.
    #[inline]
    pub(super) fn see(&mut self, cell: u32, time: u32) -> bool {
        let bit = self.bit(time);
        let spot = &mut self.spots[cell as usize];
        let new = spot.seen & bit == 0;
        spot.seen |= bit;
        new
    }

    #[inline]
    pub(super) fn forget(&mut self, cell: u32) {
        self.spots[cell as usize].seen = 0;
    }

    /// What it costs to collide in the step that leads from one cell to another from this time on: with whom is there
    /// then or comes the other way, and, beside, `rest` with whom rests there.
    #[inline]
    pub(super) fn price(&self, here: u32, there: u32, time: u32, rest: u32) -> u32 {
        let (now, then) = (self.bit(time), self.bit(time + 1));
        let spot = self.spots[there as usize];
        let taken = spot.taken & then != 0
            || spot.taken & now != 0
                && self.spots[here as usize].taken & then != 0
                && self.opposed(here, there, time).is_some();
        u32::from(taken) * COLLISION + u32::from(spot.rest) * rest
    }

    /// A robot that comes from `there` to `here` in the step from this time on.
    pub(super) fn opposed(&self, here: u32, there: u32, time: u32) -> Option<u32> {
        let mut robots = self.robots(there, time).filter(|_| here != there);
        robots.find(|&robot| self.cell(robot, time + 1) == here)
    }

    /// The robots whose ways lead through a cell at a time.
    pub(super) fn robots(&self, cell: u32, time: u32) -> impl Iterator<Item = u32> + '_ {
        let some = |robot: u32| (robot != NONE).then_some(robot);
        let first = some(self.heads[self.place(cell, time)]);
        std::iter::successors(first, move |&robot| some(self.nexts[self.entry(robot, time)]))
    }

    /// Enters where a robot means to be at a time.
    pub(super) fn enter(&mut self, robot: u32, cell: u32, time: u32) {
        let (place, entry, bit) = (self.place(cell, time), self.entry(robot, time), self.bit(time));
        self.ways[entry] = cell;
        self.nexts[entry] = std::mem::replace(&mut self.heads[place], robot);
        self.spots[cell as usize].taken |= bit;
    }

    /// Takes back what was entered for a robot at a time.
    pub(super) fn withdraw(&mut self, robot: u32, time: u32) {
        let entry = self.entry(robot, time);
        let (cell, next, bit) = (self.ways[entry], self.nexts[entry], self.bit(time));
        let place = self.place(cell, time);
        if self.heads[place] == robot {
            self.heads[place] = next;
            if next == NONE {
                self.spots[cell as usize].taken &= !bit;
            }
            return;
        }
        let before = self.robots(cell, time).find(|&other| self.nexts[self.entry(other, time)] == robot);
        if let Some(before) = before {
            let entry = self.entry(before, time);
            self.nexts[entry] = next;
        }
    }

    #[inline]
    const fn slot(&self, time: u32) -> u32 {
        time & (self.slots - 1)
    }

    #[inline]
    const fn bit(&self, time: u32) -> u32 {
        1 << self.slot(time)
    }

    #[inline]
    const fn place(&self, cell: u32, time: u32) -> usize {
        cell as usize * self.slots as usize + self.slot(time) as usize
    }

    #[inline]
    const fn entry(&self, robot: u32, time: u32) -> usize {
        robot as usize * self.slots as usize + self.slot(time) as usize
    }
}
