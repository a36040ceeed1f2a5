//! The checker: knows the map and the task, and nothing of how routes are made.

use crate::lattice::Cell;
use crate::map::Map;
use std::fmt;

/// What is wrong with a route, and at which step (0 is the start).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RouteFault {
    /// The route has no cell.
    Empty,
    /// It starts elsewhere.
    WrongStart(Cell),
    /// It ends elsewhere.
    WrongEnd(Cell),
    /// This step leads into an obstacle or off the map.
    Blocked(usize, Cell),
    /// This step does not lead to a neighbour.
    Jump(usize, Cell, Cell),
}

impl fmt::Display for RouteFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => write!(f, "the route has no cell"),
            Self::WrongStart(cell) => write!(f, "the route starts at {cell}, not at the start"),
            Self::WrongEnd(cell) => write!(f, "the route ends at {cell}, not at the target"),
            Self::Blocked(step, cell) => {
                write!(f, "step {step} leads into {cell}, which is an obstacle or outside")
            }
            Self::Jump(step, from, to) => write!(f, "step {step} jumps from {from} to {to}"),
        }
    }
}

impl std::error::Error for RouteFault {}

/// Checks that `cells` lead from `from` to `to`, from neighbour to neighbour, through free cells only.
///
/// # Errors
/// The first [`RouteFault`].
///
/// ```
/// use activecell::{Cell, Lattice, Map, RouteFault, check_route};
/// let map = Map::parse(Lattice::Square, "...\n.#.")?;
/// let cells = [Cell::new(0, 1), Cell::new(1, 1), Cell::new(2, 1)];
/// assert_eq!(check_route(&map, &cells, cells[0], cells[2]), Err(RouteFault::Blocked(1, cells[1])));
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn check_route(map: &Map, cells: &[Cell], from: Cell, to: Cell) -> Result<(), RouteFault> {
    let (Some(&first), Some(&last)) = (cells.first(), cells.last()) else { return Err(RouteFault::Empty) };
    if first != from {
        return Err(RouteFault::WrongStart(first));
    }
    for (step, &cell) in cells.iter().enumerate() {
        if !map.is_free(cell) {
            return Err(RouteFault::Blocked(step, cell));
        }
        if step > 0 && map.lattice().dir_between(cells[step - 1], cell).is_none() {
            return Err(RouteFault::Jump(step, cells[step - 1], cell));
        }
    }
    if last == to { Ok(()) } else { Err(RouteFault::WrongEnd(last)) }
}
