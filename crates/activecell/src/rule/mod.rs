//! Local rules: which neighbour becomes the next active cell.
//!
//! One cell is *active*: the robot is there. A rule looks at the cells around it and says which becomes active
//! next. Three rules share one order of looking ([`Sector::candidates`]):
//!
//! - [`Rule::Published`]: the rule of Alzoubi and Miraz, *Enhancing Robot Navigation Efficiency Using Cellular
//!   Automata with Active Cells*, held as truth tables. It has no memory and may circle for ever.
//! - [`Rule::Learning`]: each cell keeps a level that only rises; it reaches every reachable target.
//! - [`Rule::Wave`]: the whole mosaic floods from the target ([`crate::Field`]); routes are shortest.
//!
//! The published rule has two views that agree on every step: [`decide`] looks at the 12 or 18 cells around the
//! robot, [`Mosaic`] runs the same small automaton in every cell.

mod learning;
mod mosaic;
mod table;

pub use learning::Levels;
pub use mosaic::Mosaic;
pub use table::{Candidate, Sector, Wolfram};

use crate::lattice::{Cell, Dir, Lattice};
use crate::map::Map;
use std::fmt;

/// Which local rule moves the active cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Rule {
    /// The paper's rule, memoryless: simple, local, and often trapped.
    Published,
    /// The paper's rule with a level in each cell: always arrives where arriving is possible, with detours.
    Learning,
    /// The flood automaton: always arrives, on a shortest route with the fewest turns.
    #[default]
    Wave,
}

impl Rule {
    /// All rules.
    pub const ALL: [Self; 3] = [Self::Published, Self::Learning, Self::Wave];

    /// The rule's name on the command line and in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Published => "published",
            Self::Learning => "learning",
            Self::Wave => "wave",
        }
    }
}

impl fmt::Display for Rule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// What the active cell does at the next time step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Decision {
    /// The neighbour in this direction becomes active.
    Move(Dir),
    /// Every neighbour is an obstacle: the robot stays.
    Enclosed,
}

/// The states of the cells around `cell`, a bit each, 1 for an obstacle: bit `j` is neighbour `j`, bit
/// `degree + k` is cell `k` of the second ring. 12 bits on the square lattice, 18 on the hexagonal.
///
/// ```
/// use activecell::{Cell, Lattice, Map, rule};
/// let map = Map::parse(Lattice::Square, ".....\n..#..\n.....\n.....\n.....\n.....")?;
/// assert_eq!(rule::neighbourhood(&map, Cell::new(2, 2)), 0b0000_0000_0001); // b1 = North
/// assert_eq!(rule::neighbourhood(&map, Cell::new(2, 3)), 0b0000_0001_0000); // b1¹ = two North
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn neighbourhood(map: &Map, cell: Cell) -> u32 {
    let lattice = map.lattice();
    let ring1 = lattice.dirs().map(|dir| lattice.neighbour(cell, dir));
    let ring2 = (0..lattice.ring2_len()).map(|k| lattice.ring2(cell, k));
    ring1.chain(ring2).enumerate().fold(0, |bits, (i, cell)| bits | u32::from(!map.is_free(cell)) << i)
}

/// The published rule, navigator view: one step, decided from the neighbourhood alone.
///
/// `near` says that the target is a neighbour of the active cell; the sector then points at it.
///
/// 1. the first candidate, in the sector's order, whose cell is *open*: free, and its table permits it;
/// 2. else, clockwise from the first direction, any free neighbour (retreat);
/// 3. else the robot is enclosed.
///
/// ```
/// use activecell::{Cell, Dir, Lattice, rule::{Decision, Sector, decide}};
/// let north_east = Sector::towards(Lattice::Square, Cell::new(0, 9), Cell::new(5, 0)).unwrap();
/// assert_eq!(decide(Lattice::Square, north_east, false, 0), Decision::Move(Dir::N));
/// // b1 is an obstacle: East instead.
/// assert_eq!(decide(Lattice::Square, north_east, false, 1), Decision::Move(Dir::E));
/// assert_eq!(decide(Lattice::Square, north_east, false, 0b1111), Decision::Enclosed);
/// ```
pub fn decide(lattice: Lattice, sector: Sector, near: bool, neighbourhood: u32) -> Decision {
    let n = lattice.degree();
    let free = |dir: Dir| neighbourhood >> dir.0 & 1 == 0;
    let ring2 = |k: u8| neighbourhood >> (n + k % (2 * n)) & 1 == 1;
    let open = sector.candidates(lattice, near).find(|candidate| {
        let ahead = 2 * candidate.dir.0;
        // Left of it, straight ahead, right of it: three neighbouring cells of the second ring.
        let triple = [ring2(ahead + 2 * n - 1), ring2(ahead), ring2(ahead + 1)];
        free(candidate.dir) && !candidate.closed_by.next(triple)
    });
    let retreat = || sector.clockwise(lattice).find(|&dir| free(dir));
    open.map(|candidate| candidate.dir).or_else(retreat).map_or(Decision::Enclosed, Decision::Move)
}
