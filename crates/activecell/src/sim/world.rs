//! The true world: cells that are obstacles, some only for a while, and discs that move.

use super::mover::{Mover, Stroll};
use crate::lattice::Cell;
use crate::map::{Map, PointM};

/// An obstacle that stands in a cell from one time to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Visit {
    /// Where.
    pub cell: Cell,
    /// From this time on. If the robot is there it comes as soon as the robot has left.
    pub from_s: f64,
    /// It is gone from this time on.
    pub to_s: f64,
}

/// The world as it is, whatever the robot's map says.
///
/// ```
/// use activecell::{Lattice, Map, sim::World};
/// let world = World::new(&Map::parse(Lattice::Square, "...#")?);
/// assert_eq!(world.distance_m([0.5, 0.5], 0.0, 9.0), 2.5);
/// assert_eq!(world.gap_m([0.5, 0.5], [2.5, 0.5], 1.0), Some(0.5)); // how near it comes to an obstacle on that way
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct World {
    map: Map,
    visits: Vec<Waiting>,
    movers: Vec<Mover>,
    strolls: Vec<Stroll>,
    /// Where the movers are now.
    places_m: Vec<PointM>,
}

#[derive(Debug, Clone, Copy)]
struct Waiting {
    visit: Visit,
    stands: bool,
}

impl World {
    /// The world of a map, in which nothing moves.
    pub fn new(map: &Map) -> Self {
        Self {
            map: map.clone(),
            visits: Vec::new(),
            movers: Vec::new(),
            strolls: Vec::new(),
            places_m: Vec::new(),
        }
    }

    /// With obstacles that come and go. A cell that is an obstacle anyway stays one.
    #[must_use]
    pub fn with_visits(mut self, visits: &[Visit]) -> Self {
        let known = |visit: &&Visit| self.map.is_free(visit.cell);
        self.visits = visits.iter().filter(known).map(|&visit| Waiting { visit, stands: false }).collect();
        self
    }

    /// With discs that move.
    #[must_use]
    pub fn with_movers(mut self, movers: Vec<Mover>) -> Self {
        self.strolls = movers.iter().map(Stroll::new).collect();
        self.places_m = movers.iter().map(|mover| mover.start.at_m).collect();
        self.movers = movers;
        self
    }

    /// The cells as they are now.
    pub const fn map(&self) -> &Map {
        &self.map
    }

    /// The discs that move.
    pub fn movers(&self) -> &[Mover] {
        &self.movers
    }

    /// Lets the time go on. What is to appear in a cell that the robot's disc touches waits.
    pub fn advance(&mut self, time_s: f64, robot_m: PointM, radius_m: f64) {
        for ((mover, stroll), place_m) in self.movers.iter().zip(&mut self.strolls).zip(&mut self.places_m) {
            *place_m = stroll.at_m(mover, time_s);
        }
        for index in 0..self.visits.len() {
            let Waiting { visit, stands } = self.visits[index];
            let due = (visit.from_s..visit.to_s).contains(&time_s);
            let free = || cell_gap_m(&self.map, visit.cell, robot_m, robot_m) > radius_m;
            if due != stands && (stands || free()) {
                self.visits[index].stands = due;
                // Two visits of one cell overlap as long as one of them stands.
                let blocked = self.visits.iter().any(|other| other.stands && other.visit.cell == visit.cell);
                self.map.set_obstacle(visit.cell, blocked);
            }
        }
    }

    /// How far a beam gets before it meets a cell or a disc; `range_m` if it meets nothing.
    pub fn distance_m(&self, from_m: PointM, bearing_rad: f64, range_m: f64) -> f64 {
        let wall_m = self.map.cast(from_m, bearing_rad, range_m).map_or(range_m, |hit| hit.enter_m);
        let discs = self.movers.iter().zip(&self.places_m);
        let met = discs.filter_map(|(mover, &place_m)| mover.met_m(place_m, from_m, bearing_rad));
        met.fold(wall_m, f64::min)
    }

    /// The movers of which a detector sees something from a point, by their numbers: not farther than `range_m` to
    /// the nearest point, and the middle or one edge not hidden by an obstacle.
    pub(super) fn sighted(&self, from_m: PointM, range_m: f64) -> impl Iterator<Item = (u32, PointM)> + '_ {
        let all = (0..).zip(self.movers.iter().zip(&self.places_m));
        let seen = all.filter(move |&(_, (mover, place_m))| {
            let (dx, dy) = (place_m[0] - from_m[0], place_m[1] - from_m[1]);
            let far_m = dx.hypot(dy);
            far_m - mover.radius_m <= range_m
                && [0.0, -0.95, 0.95].into_iter().any(|share| {
                    let aside = share * mover.radius_m / far_m.max(1e-9);
                    let (x, y) = (dx - aside * dy, dy + aside * dx);
                    self.map.cast(from_m, y.atan2(x), x.hypot(y)).is_none()
                })
        });
        seen.map(|(number, (_, &place_m))| (number, place_m))
    }

    /// How near a point that goes straight from one place to another comes to a cell that is an obstacle or outside
    /// the map; `None` if not within `reach_m`.
    ///
    /// Exact where the way is shorter than the gap or than half a cell: cut longer ways into pieces.
    pub fn gap_m(&self, from_m: PointM, to_m: PointM, reach_m: f64) -> Option<f64> {
        let cell_m = self.map.frame().cell_m;
        let way_m = (to_m[0] - from_m[0]).hypot(to_m[1] - from_m[1]);
        // Cells whose centres may be near enough; no cell reaches farther than 0.71 of its size.
        let near_m = reach_m + way_m + 0.71 * cell_m;
        // The way begins in the middle cell, at most 0.58 (hexagon) or 0.71 (square) of a cell's size from its centre;
        // rows of hexagons are 0.87 of it apart, and every other one lies half a cell aside.
        let reach = near_m / cell_m + 0.71;
        let (rows, columns) = ((reach / 0.86) as i32, (reach + 0.5) as i32);
        let middle = self.map.cell_at_m(from_m);
        let mut least = f64::INFINITY;
        for y in middle.y - rows..=middle.y + rows {
            for x in middle.x - columns..=middle.x + columns {
                let cell = Cell::new(x, y);
                if self.map.is_free(cell) {
                    continue;
                }
                let centre_m = self.map.centre_m(cell);
                if (centre_m[0] - from_m[0]).hypot(centre_m[1] - from_m[1]) <= near_m {
                    least = least.min(cell_gap_m(&self.map, cell, from_m, to_m));
                }
            }
        }
        (least <= reach_m).then_some(least)
    }

    /// The disc that a robot at a point touches now, if any.
    pub fn touched(&self, robot_m: PointM, radius_m: f64) -> Option<usize> {
        self.movers
            .iter()
            .zip(&self.places_m)
            .position(|(mover, [x, y])| (x - robot_m[0]).hypot(y - robot_m[1]) < radius_m + mover.radius_m)
    }
}

/// From a short straight way to a cell: 0 if an end of it lies inside.
fn cell_gap_m(map: &Map, cell: Cell, from_m: PointM, to_m: PointM) -> f64 {
    let corners = map.corners_m(cell);
    let sides = || corners.iter().zip(corners.iter().cycle().skip(1));
    let ends = [from_m, to_m].map(|end_m| {
        if map.cell_at_m(end_m) == cell {
            return 0.0;
        }
        sides().map(|(&a, &b)| to_segment_m(end_m, a, b)).fold(f64::INFINITY, f64::min)
    });
    let tips = corners.iter().map(|&corner| to_segment_m(corner, from_m, to_m));
    tips.fold(ends[0].min(ends[1]), f64::min)
}

/// From a point to a segment.
fn to_segment_m(point: PointM, a: PointM, b: PointM) -> f64 {
    let (way, off) = ([b[0] - a[0], b[1] - a[1]], [point[0] - a[0], point[1] - a[1]]);
    let square = way[0] * way[0] + way[1] * way[1];
    let share =
        if square > 0.0 { ((off[0] * way[0] + off[1] * way[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
    (off[0] - share * way[0]).hypot(off[1] - share * way[1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Frame, Lattice, Rng};

    /// The naive twin: points of the way against points of all obstacles' sides.
    fn sampled_gap_m(map: &Map, from_m: PointM, to_m: PointM) -> f64 {
        let mut least = f64::INFINITY;
        for y in -1..=map.height() as i32 {
            for x in -1..=map.width() as i32 {
                let cell = Cell::new(x, y);
                if map.is_free(cell) {
                    continue;
                }
                let corners = map.corners_m(cell);
                for (i, a) in corners.iter().enumerate() {
                    let b = corners[(i + 1) % corners.len()];
                    for share in (0..=20).map(|i| f64::from(i) / 20.0) {
                        let on = [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])];
                        for share in (0..=20).map(|i| f64::from(i) / 20.0) {
                            let at = [
                                from_m[0] + share * (to_m[0] - from_m[0]),
                                from_m[1] + share * (to_m[1] - from_m[1]),
                            ];
                            least = least.min((on[0] - at[0]).hypot(on[1] - at[1]));
                        }
                    }
                }
            }
        }
        least
    }

    #[test]
    fn gaps_are_those_of_sampled_points() {
        let mut rng = Rng::new(8);
        let mut compared = 0;
        for seed in 0..200 {
            let map = Map::random(Lattice::ALL[seed as usize % 2], 6, 5, 0.25, seed).unwrap();
            let map = map.in_frame(Frame { cell_m: 0.5, origin_m: [3.0, -1.0], yaw_rad: -0.4 }).unwrap();
            let world = World::new(&map);
            let Some(cell) = map.free().nth(seed as usize % 9) else { continue };
            let [x, y] = map.centre_m(cell);
            let from_m = [x + 0.3 * (rng.unit() - 0.5), y + 0.3 * (rng.unit() - 0.5)];
            let to_m = [from_m[0] + 0.1 * (rng.unit() - 0.5), from_m[1] + 0.1 * (rng.unit() - 0.5)];
            if !map.is_free(map.cell_at_m(from_m)) || !map.is_free(map.cell_at_m(to_m)) {
                continue;
            }
            let sampled = sampled_gap_m(&map, from_m, to_m);
            match world.gap_m(from_m, to_m, 0.6) {
                Some(gap) => {
                    assert!(gap <= sampled + 1e-9 && gap > sampled - 0.02, "{seed}: {gap} {sampled}");
                }
                None => assert!(sampled > 0.6, "{seed}: {sampled}"),
            }
            compared += 1;
        }
        assert!(compared > 120, "{compared}");
    }

    #[test]
    fn visits_come_and_go_but_never_onto_the_robot() {
        let map = Map::parse(Lattice::Square, "...").unwrap();
        let cell = Cell::new(1, 0);
        let mut world = World::new(&map).with_visits(&[Visit { cell, from_s: 2.0, to_s: 5.0 }]);
        let mut free_at = |time_s, x| {
            world.advance(time_s, [x, 0.5], 0.1);
            world.map().is_free(cell)
        };
        assert!(free_at(1.0, 0.5));
        assert!(free_at(2.5, 0.95), "the robot touches it");
        assert!(!free_at(3.0, 0.5));
        assert!(free_at(5.0, 0.5));
    }
}
