//! The distance control module: a plan becomes a program for every robot and the order in which robots pass each cell,
//! and whoever is late only makes others wait.
//!
//! ```text
//! Map + Plan ──Schedule──▶ moves, programs, order of passing ──Runner──▶ permits, from reported revolutions
//! ```
//!
//! A plan says who is where at which step; real robots do not keep steps. What must be kept is the order: a robot may
//! enter a cell only when the robot that the plan has there before it has left. These are the edges of an *action
//! dependency graph* (W. Hönig, S. Kiesel, A. Tinka, J. W. Durham, N. Ayanian, *Persistent and Robust Execution of MAPF
//! Schedules in Warehouses*, IEEE RA-L 2019); here each move has one of them at most, to the visit before it in its
//! cell, since all others follow.
//!
//! Plans let a robot follow into a cell in the very step in which it is left, even all around a ring, where everyone
//! waits for everyone. Such moves go *in step*: the follower may be a little behind its place in the plan, or a little
//! ahead, but never so far that the two bodies could touch ([`Spacing`]). The moves of a ring are so one joint action,
//! and with every ring taken as one the graph has no cycle: every dependency leads from a step of the plan to the same
//! or a later one, and within a step only rings close. [`check_schedule`] checks it.
//!
//! Hence nobody is ever stuck for good. Of all unfinished moves look at those of the earliest step of the plan: all
//! before them are done, so each follows a robot that has left, or one that moves in the same step; where such a chain
//! ends, the way is free, and in a ring the one who is furthest behind may always drive on.

mod build;
mod check;
mod discs;
mod execute;
mod run;
mod spacing;

pub use check::{ScheduleFault, check_schedule};
pub use discs::Discs;
pub use execute::{Delays, Executed, Execution, ExecutionFault, Stop};
pub use run::Runner;
pub use spacing::Spacing;

use crate::lattice::{Cell, Dir, Lattice};
use crate::map::Map;
use crate::program::{Program, Robot};
use crate::route::Route;

/// No visit, no robot.
const NONE: u32 = u32::MAX;

/// A robot in a cell: at its start, and once for every move.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Visit {
    /// The cell.
    pub cell: Cell,
    /// The step of the plan in which the robot comes there; 0 for its start.
    pub step: usize,
    /// Who is in this cell before: the robot, and the number of its visit, from 0. The robot itself, if it comes back and
    /// nobody was there meanwhile; `None` if the cell was never used.
    pub after: Option<(usize, usize)>,
    /// If the plan lets that robot leave in the very step in which this one comes, so that they go in step: by how much it
    /// turns off from the way of this one, in degrees, 0 to 120.
    pub bend_deg: Option<i32>,
}

/// A plan without its clock: the cells that each robot visits, and the order in which each cell is visited.
///
/// It takes 12 bytes a visit.
///
/// ```
/// use activecell::{Cell, Lattice, Map, Plan, Robot, Schedule};
/// let map = Map::parse(Lattice::Square, "...")?;
/// let [a, b, c] = [0, 1, 2].map(|x| Cell::new(x, 0));
/// // Robot 1 goes on from b to c; a step later robot 0 follows from a to b.
/// let plan = Plan::new(2, vec![a, b, a, c, b, c])?;
/// let schedule = Schedule::new(&map, &plan)?;
/// let visits: Vec<_> = schedule.visits(0).collect();
/// assert_eq!((visits[1].cell, visits[1].step, visits[1].after), (b, 2, Some((1, 0))));
/// assert_eq!(schedule.passing(b), [(1, 0), (0, 1)]); // robot 1 at its start, then robot 0's first move
/// assert_eq!(schedule.program(&map, 0, &Robot::default()).revolutions(), 5.0);
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Schedule {
    lattice: Lattice,
    /// Columns of the map.
    width: u32,
    /// The number of each robot's first visit, and of all visits.
    first: Vec<u32>,
    /// Of each visit: its cell, row by row.
    cells: Vec<u32>,
    /// Of each visit: the step of the plan in which it begins.
    steps: Vec<u32>,
    /// Of each visit: the one before it in its cell.
    before: Vec<u32>,
    /// The rings: of each the visits that its robots come to, each behind the one that it follows.
    rings: Vec<Vec<u32>>,
}

impl Schedule {
    /// How many robots there are.
    pub const fn robots(&self) -> usize {
        self.first.len() - 1
    }

    /// How many moves all robots make.
    pub const fn moves(&self) -> usize {
        self.cells.len() - self.robots()
    }

    /// The visits of a robot, from its start to where it rests.
    ///
    /// # Panics
    /// If there is no such robot; so do all methods that are given one.
    pub fn visits(&self, robot: usize) -> impl ExactSizeIterator<Item = Visit> {
        let first = self.first[robot] as usize;
        (first..self.first[robot + 1] as usize).map(|visit| self.numbered(visit as u32))
    }

    /// A visit of a robot, counted from 0.
    ///
    /// # Panics
    /// If it has no such visit.
    pub fn visit(&self, robot: usize, number: usize) -> Visit {
        let visit = self.first[robot] as usize + number;
        assert!(visit < self.first[robot + 1] as usize, "robot {robot} has no visit {number}");
        self.numbered(visit as u32)
    }

    /// The step of the plan in which a robot comes to rest.
    pub fn cost(&self, robot: usize) -> usize {
        self.steps[self.first[robot + 1] as usize - 1] as usize
    }

    /// Who passes a cell, in order: the robot and the number of its visit. Looks at all visits.
    pub fn passing(&self, cell: Cell) -> Vec<(usize, usize)> {
        let mut here: Vec<usize> =
            (0..self.cells.len()).filter(|&visit| self.cell(visit as u32) == cell).collect();
        here.sort_unstable_by_key(|&visit| self.steps[visit]);
        here.into_iter().map(|visit| self.named(visit as u32)).collect()
    }

    /// The rings: of each its step, and its robots, each followed by the one whose cell it enters.
    ///
    /// ```
    /// use activecell::{Cell, Lattice, Map, Plan, Schedule};
    /// let map = Map::parse(Lattice::Square, "..\n..")?;
    /// let ring = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(x, y)| Cell::new(x, y));
    /// let turned = [ring[1], ring[2], ring[3], ring[0]];
    /// let schedule = Schedule::new(&map, &Plan::new(4, [ring, turned].concat())?)?;
    /// assert_eq!(schedule.rings().collect::<Vec<_>>(), [(1, vec![0, 1, 2, 3])]);
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn rings(&self) -> impl ExactSizeIterator<Item = (usize, Vec<usize>)> {
        self.rings.iter().map(|ring| {
            let robots = ring.iter().map(|&visit| self.named(visit).0).collect();
            (self.steps[ring[0] as usize] as usize, robots)
        })
    }

    /// The program that drives a robot along its cells. Where it has to wait is not in it: that is up to the
    /// [`Runner`].
    ///
    /// # Panics
    /// If the map is not the schedule's.
    pub fn program(&self, map: &Map, robot: usize, body: &Robot) -> Program {
        let cells = self.visits(robot).map(|visit| visit.cell).collect();
        let route = Route::through(map, cells).expect("the plan was checked");
        route.program(body, map, None)
    }

    /// The memory that it takes, in bytes.
    pub fn bytes(&self) -> usize {
        let rings = self.rings.iter().map(|ring| ring.capacity() * size_of::<u32>() + size_of::<Vec<u32>>());
        let flat = [&self.first, &self.cells, &self.steps, &self.before];
        rings.sum::<usize>() + flat.iter().map(|part| part.capacity() * size_of::<u32>()).sum::<usize>()
    }

    fn numbered(&self, visit: u32) -> Visit {
        let before = self.before[visit as usize];
        Visit {
            cell: self.cell(visit),
            step: self.steps[visit as usize] as usize,
            after: (before != NONE).then(|| self.named(before)),
            bend_deg: self.is_in_step(visit).then(|| self.bend_deg(visit)),
        }
    }

    /// A visit's robot, and its number among that robot's visits.
    fn named(&self, visit: u32) -> (usize, usize) {
        let robot = self.owner(visit);
        (robot, (visit - self.first[robot]) as usize)
    }

    fn owner(&self, visit: u32) -> usize {
        self.first.partition_point(|&first| first <= visit) - 1
    }

    const fn last(&self, robot: usize) -> u32 {
        self.first.as_slice()[robot + 1] - 1
    }

    fn cell(&self, visit: u32) -> Cell {
        let index = self.cells[visit as usize];
        Cell::new((index % self.width) as i32, (index / self.width) as i32)
    }

    /// Whether a visit begins in the step in which the one before it in the cell ends.
    fn is_in_step(&self, visit: u32) -> bool {
        let before = self.before[visit as usize];
        let left = before.wrapping_add(1);
        left != visit && before != NONE && self.steps.get(left as usize) == Some(&self.steps[visit as usize])
    }

    /// By how much the one that leaves turns off from the one that comes, in degrees, 0 to 180: the robot of the visit
    /// before this one, in its next move, against the robot of this visit in the move to it.
    fn bend_deg(&self, visit: u32) -> i32 {
        let before = self.before[visit as usize];
        self.lattice.turn_deg(self.way(visit), self.way(before + 1)).abs()
    }

    /// The direction of the move to a visit.
    fn way(&self, visit: u32) -> Dir {
        self.lattice.dir_between(self.cell(visit - 1), self.cell(visit)).expect("the plan was checked")
    }
}
