//! Tasks drawn by chance.

use activecell::{Cell, Map, Rng, Task};

/// Tasks that each ask for one visit of a cell, drawn from these.
///
/// ```
/// use activecell::{Lattice, Map};
/// use activecell_fleet::visits;
/// let map = Map::parse(Lattice::Square, "....\n.##.")?;
/// let cells: Vec<_> = map.free().collect();
/// let tasks = visits(&cells, 100, 7);
/// assert_eq!((tasks.len(), tasks[0].errands.len()), (100, 1));
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn visits(cells: &[Cell], count: usize, seed: u64) -> Vec<Task> {
    let mut rng = Rng::new(seed);
    if cells.is_empty() {
        return Vec::new();
    }
    (0..count).map(|_| Task::visit(draw(cells, &mut rng))).collect()
}

/// Tasks that each ask for a pickup at one cell and a delivery at another, drawn from these.
pub fn deliveries(pickups: &[Cell], drops: &[Cell], count: usize, seed: u64) -> Vec<Task> {
    let mut rng = Rng::new(seed);
    if pickups.is_empty() || drops.is_empty() {
        return Vec::new();
    }
    (0..count).map(|_| Task { errands: vec![draw(pickups, &mut rng), draw(drops, &mut rng)] }).collect()
}

/// The cells of a map that a robot in `from` can come to, row by row: cells from which to draw.
pub fn within_reach(map: &Map, from: Cell) -> Vec<Cell> {
    let Ok(reached) = map.reachable(&[from]) else { return Vec::new() };
    map.free().filter(|cell| reached.get(cell.x as u32, cell.y as u32)).collect()
}

fn draw(cells: &[Cell], rng: &mut Rng) -> Cell {
    cells[rng.below(cells.len() as u32) as usize]
}
