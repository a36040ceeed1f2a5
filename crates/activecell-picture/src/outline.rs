//! Outlines of regions of cells: what lies between inside and outside, as closed loops.
//!
//! Drawing a region as one shape instead of cell by cell leaves no hairlines between its cells and keeps
//! pictures of large maps small.

use activecell::{Cell, Lattice};

/// Corners of a loop in the whole units of [`Lattice::centre`].
pub(crate) type Loop = Vec<(i64, i64)>;

/// Traces the outlines of the cells of a `width` × `height` lattice for which `inside` holds.
///
/// `inside` is asked only about cells of the lattice; everything else is outside. Outer loops run clockwise,
/// holes counter-clockwise; corners between collinear sides are left out.
pub(crate) fn trace(lattice: Lattice, width: u32, height: u32, inside: impl Fn(Cell) -> bool) -> Vec<Loop> {
    let inside = |cell: Cell| {
        (cell.x as u32) < width && (cell.y as u32) < height && cell.x >= 0 && cell.y >= 0 && inside(cell)
    };
    let index = |cell: Cell| cell.y as usize * width as usize + cell.x as usize;
    // One bit a side: whether the walk has passed it.
    let mut passed = vec![0u8; width as usize * height as usize];
    let mut loops = Vec::new();
    for y in 0..height as i32 {
        for x in 0..width as i32 {
            let first = Cell::new(x, y);
            if !inside(first) {
                continue;
            }
            for dir in lattice.dirs() {
                let bit = 1 << dir.0;
                if passed[index(first)] & bit != 0 || inside(lattice.neighbour(first, dir)) {
                    continue;
                }
                let mut corners = Loop::new();
                let (mut cell, mut dir) = (first, dir);
                let mut came = None;
                while passed[index(cell)] & (1 << dir.0) == 0 {
                    passed[index(cell)] |= 1 << dir.0;
                    if came != Some(dir) {
                        corners.push(corner(lattice, cell, dir.index()));
                    }
                    came = Some(dir);
                    // Round the corner at the side's end, over the cells inside, to the next side.
                    dir = lattice.turned(dir, 1);
                    while inside(lattice.neighbour(cell, dir)) {
                        cell = lattice.neighbour(cell, dir);
                        dir = lattice.turned(lattice.opposite(dir), 1);
                    }
                }
                // The walk began in the middle of a straight side.
                if came == Some(dir) {
                    corners.remove(0);
                }
                loops.push(corners);
            }
        }
    }
    loops
}

/// Corner `j` of a cell.
fn corner(lattice: Lattice, cell: Cell, j: usize) -> (i64, i64) {
    let (x, y) = lattice.centre(cell);
    let (dx, dy) = lattice.corners()[j];
    (x + dx, y + dy)
}

#[cfg(test)]
mod tests {
    use super::*;
    use activecell::Map;

    /// Whether a horizontal ray from the point crosses the loops an odd number of times. The ray lies a little
    /// below the centre, so that it meets no corner.
    fn encloses(loops: &[Loop], (px, py): (i64, i64)) -> bool {
        let y = py as f64 + 0.25;
        let mut crossings = 0;
        for corners in loops {
            for (i, &(x0, y0)) in corners.iter().enumerate() {
                let (x1, y1) = corners[(i + 1) % corners.len()];
                let (x0, y0, x1, y1) = (x0 as f64, y0 as f64, x1 as f64, y1 as f64);
                if (y0 > y) != (y1 > y) && x0 + (y - y0) / (y1 - y0) * (x1 - x0) > px as f64 {
                    crossings += 1;
                }
            }
        }
        crossings % 2 == 1
    }

    #[test]
    fn outlines_enclose_exactly_the_obstacles() {
        for lattice in Lattice::ALL {
            for (seed, density) in [(1, 0.1), (2, 0.3), (3, 0.5), (4, 0.8), (5, 1.0), (6, 0.0)] {
                let map = Map::random(lattice, 17, 13, density, seed).unwrap();
                let loops = trace(lattice, 17, 13, |cell| !map.is_free(cell));
                for y in 0..13 {
                    for x in 0..17 {
                        let cell = Cell::new(x, y);
                        let inside = encloses(&loops, lattice.centre(cell));
                        assert_eq!(inside, !map.is_free(cell), "{lattice} {seed} {cell}");
                    }
                }
            }
        }
    }

    #[test]
    fn straight_sides_are_one_line() {
        let map = Map::parse(Lattice::Square, "####\n#..#\n####").unwrap();
        let loops = trace(Lattice::Square, 4, 3, |cell| !map.is_free(cell));
        assert_eq!(loops.len(), 2);
        assert!(loops.iter().all(|corners| corners.len() == 4), "{loops:?}");
        let all = trace(Lattice::Hex, 3, 3, |_| true);
        assert_eq!(all.len(), 1);
    }
}
