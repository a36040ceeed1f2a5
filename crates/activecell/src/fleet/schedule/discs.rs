//! Do bodies overlap? Knows where they are, and nothing of plans and schedules.

use super::NONE;
use crate::map::{Map, PointM};

/// Watches discs of one radius for overlaps. Points are in cells: x right and y down from the top left corner of the
/// mosaic's bounding box, 1 from a cell's centre to the next ([`Discs::centre`]).
///
/// ```
/// use activecell::{Lattice, Map, schedule::Discs};
/// let map = Map::parse(Lattice::Square, "...\n...")?;
/// let mut bodies = Discs::new(&map, 0.3);
/// assert_eq!(bodies.overlap(&[[0.5, 0.5], [2.5, 0.5], [1.1, 0.5]]), None); // they touch
/// assert_eq!(bodies.overlap(&[[0.5, 0.5], [2.5, 0.5], [0.9, 0.9]]), Some([0, 2]));
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Discs {
    radius: f64,
    columns: usize,
    /// The first body in each square of side 1, and of each body the next.
    first: Vec<u32>,
    next: Vec<u32>,
}

impl Discs {
    /// For discs of this radius in cells, at most a half, on this map.
    ///
    /// Takes 4 bytes for each cell of the map.
    pub fn new(map: &Map, radius: f64) -> Self {
        // Half a cell more in every second row of hexagons, and a margin all around.
        let columns = map.width() as usize + 3;
        let first = vec![NONE; columns * (map.height() as usize + 3)];
        Self { radius, columns, first, next: Vec::new() }
    }

    /// A cell's centre.
    pub fn centre(map: &Map, cell: crate::lattice::Cell) -> PointM {
        let ((x, y), (unit_x, unit_y)) = (map.lattice().centre(cell), map.lattice().unit_m());
        [x as f64 * unit_x, y as f64 * unit_y]
    }

    /// Two bodies that overlap by more than rounding; of several pairs the one that is met first.
    ///
    /// # Panics
    /// If a body is off the map.
    pub fn overlap(&mut self, points: &[PointM]) -> Option<[usize; 2]> {
        let square = |[x, y]: PointM| (y as usize + 1) * self.columns + x as usize + 1;
        self.next.clear();
        let mut found = None;
        for (body, &point) in points.iter().enumerate() {
            let middle = square(point);
            let around = [middle - self.columns, middle, middle + self.columns];
            for near in around.into_iter().flat_map(|square| square - 1..=square + 1) {
                let mut other = self.first[near];
                while other != NONE {
                    let [dx, dy] = [0, 1].map(|axis| point[axis] - points[other as usize][axis]);
                    if dx.hypot(dy) < 2.0 * self.radius - 1e-9 {
                        found = found.or(Some([other as usize, body]));
                    }
                    other = self.next[other as usize];
                }
            }
            self.next.push(std::mem::replace(&mut self.first[middle], body as u32));
        }
        for &point in points {
            self.first[square(point)] = NONE;
        }
        found
    }
}
