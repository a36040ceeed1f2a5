//! The checker: knows the map and the task, and nothing of how routes are made.

use crate::lattice::Cell;
use crate::map::Map;
use crate::wave::Terrain;
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
    /// This step leads against a one-way cell.
    WrongWay(usize, Cell, Cell),
    /// This step is closed: on uneven ground, too steep.
    Closed(usize, Cell, Cell),
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
            Self::WrongWay(step, from, to) => {
                write!(f, "step {step} leads from {from} to {to}, against a one-way cell")
            }
            Self::Closed(step, from, to) => {
                write!(f, "step {step} leads from {from} to {to}, which is closed or too steep")
            }
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

/// Checks a route over terrain as [`check_route`] does, and that no step leaves a one-way cell in another direction
/// than its own or enters one head-on, and that none is closed; says what the route costs.
///
/// # Errors
/// The first [`RouteFault`]; a cell to keep out of is [`RouteFault::Blocked`].
///
/// ```
/// use activecell::{Cell, Dir, Lattice, Map, RouteFault, Terrain, check_terrain_route};
/// let mut terrain = Terrain::new(&Map::parse(Lattice::Square, "...")?);
/// let cells = [Cell::new(0, 0), Cell::new(1, 0), Cell::new(2, 0)];
/// terrain.set_cost([cells[2]], 9)?;
/// assert_eq!(check_terrain_route(&terrain, &cells, cells[0], cells[2]), Ok(10));
/// terrain.set_one_way([cells[1]], &[Dir::W])?;
/// let fault = RouteFault::WrongWay(1, cells[0], cells[1]);
/// assert_eq!(check_terrain_route(&terrain, &cells, cells[0], cells[2]), Err(fault));
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn check_terrain_route(
    terrain: &Terrain,
    cells: &[Cell],
    from: Cell,
    to: Cell,
) -> Result<u64, RouteFault> {
    check_route(terrain.map(), cells, from, to)?;
    let lattice = terrain.map().lattice();
    let mut cost = 0;
    for (step, pair) in cells.windows(2).enumerate() {
        let fault = RouteFault::WrongWay(step + 1, pair[0], pair[1]);
        let dir = lattice.dir_between(pair[0], pair[1]).ok_or(fault)?;
        let back = lattice.opposite(dir);
        let head_on = terrain.may_leave(pair[1], back) && !terrain.may_leave(pair[1], dir);
        if head_on || !terrain.may_leave(pair[0], dir) {
            return Err(fault);
        }
        let own = terrain.own_cost(pair[0], dir).ok_or(RouteFault::Closed(step + 1, pair[0], pair[1]))?;
        cost += (u64::from(own) * u64::from(terrain.cost(pair[1]))).min(u16::MAX.into());
    }
    Ok(cost)
}
