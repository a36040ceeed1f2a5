//! Rays over the floor: every cell that one passes, exactly, on both lattices.

use crate::lattice::{Cell, Dir, Lattice};
use crate::map::{Map, PointM};

/// A cell on a ray's way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// The cell.
    pub cell: Cell,
    /// How far from the ray's beginning it enters the cell; 0 for the first.
    pub enter_m: f64,
    /// The direction from the cell before to this one, whose common side the ray crosses; `None` for the first.
    pub side: Option<Dir>,
}

/// A half-line over a map's cells: the cells that it passes, in order, without end (beyond the map too).
///
/// A cell is where its sides' half-planes meet, on squares as on hexagons, so that one step serves both: of the sides
/// that the ray looks towards it leaves through the one that it reaches first. (On squares this is the traversal of
/// Amanatides and Woo, *A Fast Voxel Traversal Algorithm for Ray Tracing*, 1987.)
///
/// ```
/// use activecell::{Cell, Lattice, Map, sense::Ray};
/// let map = Map::parse(Lattice::Square, "....")?;
/// let ways: Vec<(i32, f64)> = Ray::new(&map, [0.5, 0.5], 0.0).take(3).map(|c| (c.cell.x, c.enter_m)).collect();
/// assert_eq!(ways, [(0, 0.0), (1, 0.5), (2, 1.5)]);
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Ray {
    lattice: Lattice,
    /// The beginning and the direction, in cells from the mosaic's top left corner, x right and y down.
    at: [f64; 2],
    way: [f64; 2],
    cell_m: f64,
    next: Crossing,
}

impl Ray {
    /// The ray from a point of the floor along a bearing.
    pub fn new(map: &Map, from_m: PointM, bearing_rad: f64) -> Self {
        let frame = map.frame();
        let [x, y] = frame.to_mosaic(from_m);
        let (sin, cos) = (bearing_rad - frame.yaw_rad).sin_cos();
        Self {
            lattice: map.lattice(),
            at: [x / frame.cell_m, (map.size_m()[1] - y) / frame.cell_m],
            way: [cos, -sin],
            cell_m: frame.cell_m,
            next: Crossing { cell: map.cell_at_m(from_m), enter_m: 0.0, side: None },
        }
    }
}

impl Iterator for Ray {
    type Item = Crossing;

    fn next(&mut self) -> Option<Crossing> {
        let now = self.next;
        let (ux, uy) = self.lattice.unit_m();
        let (x, y) = self.lattice.centre(now.cell);
        let from = [self.at[0] - x as f64 * ux, self.at[1] - y as f64 * uy];
        let ways = self.lattice.dirs().filter_map(|dir| {
            let normal = normal(self.lattice, dir);
            let closing = dot(self.way, normal);
            // A side lies half a cell from the centre.
            (closing > 1e-12).then(|| ((0.5 - dot(from, normal)) / closing, dir))
        });
        let (leave, dir) = ways.min_by(|a, b| a.0.total_cmp(&b.0))?;
        self.next = Crossing {
            cell: self.lattice.neighbour(now.cell, dir),
            // Rounding must not lead back.
            enter_m: (leave * self.cell_m).max(now.enter_m),
            side: Some(dir),
        };
        Some(now)
    }
}

/// The step in a direction, in cells, x right and y down.
fn normal(lattice: Lattice, dir: Dir) -> [f64; 2] {
    let (ux, uy) = lattice.unit_m();
    let (ax, ay) = lattice.centre(Cell::new(0, 0));
    let (bx, by) = lattice.centre(lattice.neighbour(Cell::new(0, 0), dir));
    [(bx - ax) as f64 * ux, (by - ay) as f64 * uy]
}

const fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

impl Map {
    /// The first cell along a ray that is no free one, if the ray enters it within `range_m`.
    ///
    /// ```
    /// use activecell::{Cell, Lattice, Map};
    /// let map = Map::parse(Lattice::Hex, "...#")?;
    /// let hit = map.cast([0.5, 0.5], 0.0, 10.0).unwrap();
    /// assert_eq!((hit.cell, hit.enter_m), (Cell::new(3, 0), 2.5));
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn cast(&self, from_m: PointM, bearing_rad: f64, range_m: f64) -> Option<Crossing> {
        let within = Ray::new(self, from_m, bearing_rad).take_while(|crossing| crossing.enter_m <= range_m);
        within.into_iter().find(|crossing| !self.is_free(crossing.cell))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Frame, Rng};

    /// The naive twin: a point moved in small steps.
    fn stepped(map: &Map, from_m: PointM, bearing_rad: f64, range_m: f64, step_m: f64) -> Option<f64> {
        let (sin, cos) = bearing_rad.sin_cos();
        let steps = 0..=(range_m / step_m) as u32;
        let mut ways = steps.map(|step| f64::from(step) * step_m);
        ways.find(|way| !map.is_free(map.cell_at_m([from_m[0] + way * cos, from_m[1] + way * sin])))
    }

    #[test]
    fn rays_meet_what_small_steps_meet() {
        let mut rng = Rng::new(3);
        let (mut hits, mut corners) = (0, 0);
        for seed in 0..400 {
            let frame = Frame { cell_m: 0.3, origin_m: [-2.0, 1.0], yaw_rad: 0.3 };
            let map = Map::random(Lattice::ALL[seed as usize % 2], 9, 7, 0.2, seed).unwrap();
            let map = map.in_frame(frame).unwrap();
            let Some(cell) = map.free().nth(seed as usize % 40) else { continue };
            let [x, y] = map.centre_m(cell);
            let from_m = [x + 0.1 * (rng.unit() - 0.5), y + 0.1 * (rng.unit() - 0.5)];
            for beam in 0..12 {
                let bearing_rad = f64::from(beam) * 0.52 + rng.unit();
                let hit = map.cast(from_m, bearing_rad, 1.5).map(|hit| hit.enter_m);
                match (hit, stepped(&map, from_m, bearing_rad, 1.5, 5e-4)) {
                    (None, None) => {}
                    (Some(hit), Some(step)) if (step - hit).abs() <= 6e-4 => hits += 1,
                    // Small steps jump over the very tips of corners, the ray does not.
                    (Some(hit), step) if step.is_none_or(|step| step > hit) => corners += 1,
                    (hit, step) => panic!("{seed} {beam}: {hit:?} {step:?}"),
                }
            }
        }
        println!("{hits} hits, {corners} tips of corners");
        assert!(hits > 3000 && corners < hits / 200);
    }

    #[test]
    fn a_ray_never_stands_still() {
        for lattice in Lattice::ALL {
            let map = Map::random(lattice, 5, 5, 0.0, 1).unwrap();
            let mut rng = Rng::new(1);
            for turn in 0..720 {
                // Through centres, corners and sides of cells.
                let from_m = if turn % 2 == 0 { map.centre_m(Cell::new(2, 2)) } else { [rng.unit(), 2.0] };
                let ray = Ray::new(&map, from_m, f64::from(turn).to_radians() / 2.0);
                let cells: Vec<Crossing> = ray.take(60).collect();
                assert!(cells.windows(2).all(|pair| pair[0].enter_m <= pair[1].enter_m));
                assert!(cells[59].enter_m > 20.0, "{lattice} {turn}");
            }
        }
    }
}
