//! The map that a robot believes in: what it was given, and what it has seen since.

use super::{Estimate, Ray};
use crate::lattice::Cell;
use crate::map::Map;
use crate::program::Sensors;

/// Log-odds that a cell is an obstacle: at most and at least, so that it can always change again.
const MOST: f64 = 4.0;
/// What one reading says.
const HIT: f64 = 2.0;
const MISS: f64 = -1.0;
/// A cell that the given map calls free: two readings close it, not one.
const GIVEN_FREE: f64 = -2.5;
/// Hits on a free cell that lie more looks apart than this have nothing to do with each other: false readings do not
/// add up over a long way.
const APART: u32 = 5;
/// From here on a closed cell is sure enough to find one's position by it.
const SURE: f64 = 2.0;

/// A cell that closed (`true`) or opened.
pub type Change = (Cell, bool);

/// What a robot believes of each cell: an occupancy grid with log-odds (Moravec and Elfes, *High Resolution Maps from
/// Wide Angle Sonar*, 1985; Thrun, Burgard, Fox, *Probabilistic Robotics*, 2005, chapter 9).
///
/// A reading speaks for an obstacle in the cell where it ends and against one in each cell that it passed. A false
/// reading is outvoted by the next good ones, and an obstacle that went away is too.
///
/// A robot does not know exactly where it is: a reading counts for a cell only if two parallels to the beam, as far
/// aside as the beam may be, end in the same cell, or pass it too.
///
/// ```
/// use activecell::{Cell, Errors, Lattice, Map, Pose, Sensors, sense::{Belief, Estimate}};
/// let mut belief = Belief::new(&Map::parse(Lattice::Square, ".....")?);
/// let estimate = Estimate::new(Pose { at_m: [0.5, 0.5], bearing_rad: 0.0 }, &Errors::default());
/// let sensors = Sensors { beams: 1, range_m: 9.0, ..Sensors::default() };
/// assert_eq!(belief.observe(&estimate, &sensors, &[2.5]), []);
/// assert_eq!(belief.observe(&estimate, &sensors, &[2.5]), [(Cell::new(3, 0), true)]);
/// assert!(!belief.map().is_free(Cell::new(3, 0)));
/// // It goes away again.
/// let changes = (0..5).flat_map(|_| belief.observe(&estimate, &sensors, &[4.5]));
/// assert_eq!(changes.collect::<Vec<_>>(), [(Cell::new(3, 0), false)]);
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Belief {
    given: Map,
    map: Map,
    log_odds: Vec<f64>,
    /// Looks so far, and the last that met something in a cell.
    looks: u32,
    met: Vec<u32>,
}

impl Belief {
    /// As the map says.
    pub fn new(map: &Map) -> Self {
        let mut log_odds = vec![MOST; map.cells()];
        for cell in map.free() {
            if let Some(index) = map.index(cell) {
                log_odds[index] = GIVEN_FREE;
            }
        }
        Self { given: map.clone(), map: map.clone(), log_odds, looks: 0, met: vec![0; map.cells()] }
    }

    /// The map as it is believed now.
    pub const fn map(&self) -> &Map {
        &self.map
    }

    /// Whether the cell is an obstacle without much doubt, or outside the map.
    pub fn is_sure(&self, cell: Cell) -> bool {
        self.map.index(cell).is_none_or(|index| self.log_odds[index] >= SURE)
    }

    /// Whether the cell is closed though the given map calls it free.
    pub fn is_found(&self, cell: Cell) -> bool {
        self.given.is_free(cell) && !self.map.is_free(cell)
    }

    /// All such cells, in row order.
    pub fn found(&self) -> impl Iterator<Item = Cell> + '_ {
        self.given.free().filter(|&cell| !self.map.is_free(cell))
    }

    /// Takes in the readings of one look from the estimated pose; says which cells closed or opened by it.
    pub fn observe(&mut self, estimate: &Estimate, sensors: &Sensors, readings_m: &[f64]) -> Vec<Change> {
        let pose = estimate.pose();
        let own = self.map.cell_at_m(pose.at_m);
        let mut changes = Vec::new();
        self.looks = self.looks.saturating_add(1);
        // Where the robot is, nothing else is.
        changes.extend(self.learn(own, MISS));
        for (bearing_rad, &reading_m) in sensors.bearings_rad(pose.bearing_rad).zip(readings_m) {
            let (passed, end) = self.read(estimate, sensors, bearing_rad, reading_m);
            for cell in passed {
                changes.extend(self.learn(cell, MISS));
            }
            changes.extend(end.filter(|&cell| cell != own).and_then(|cell| self.meet(cell)));
        }
        changes
    }

    /// The cells in which readings from the estimated pose surely end.
    pub fn ends(&self, estimate: &Estimate, sensors: &Sensors, readings_m: &[f64]) -> Vec<Cell> {
        let beams = sensors.bearings_rad(estimate.pose().bearing_rad).zip(readings_m);
        beams.filter_map(|(bearing_rad, &m)| self.read(estimate, sensors, bearing_rad, m).1).collect()
    }

    /// The cells that a beam surely passed, and the one in which it surely ended, if it met anything.
    fn read(
        &self,
        estimate: &Estimate,
        sensors: &Sensors,
        bearing_rad: f64,
        reading_m: f64,
    ) -> (Vec<Cell>, Option<Cell>) {
        let at_m = estimate.pose().at_m;
        let cell_m = self.map.frame().cell_m;
        // Even perfect sensors round.
        let spread_m = (2.0 * estimate.aside_m(reading_m)).clamp(cell_m / 100.0, cell_m / 4.0);
        let slack_m = (3.0 * sensors.noise_m.hypot(estimate.spread_m())).max(cell_m / 100.0);
        let (sin, cos) = bearing_rad.sin_cos();
        let beam = |aside_m: f64| {
            let from_m = [at_m[0] - aside_m * sin, at_m[1] + aside_m * cos];
            self.passed(Ray::new(&self.map, from_m, bearing_rad), reading_m, slack_m)
        };
        let [(left, left_end), (mut passed, end), (right, right_end)] = [spread_m, 0.0, -spread_m].map(beam);
        passed.retain(|cell| left.contains(cell) && right.contains(cell));
        let sure = reading_m < sensors.range_m && left_end == end && right_end == end;
        (passed, sure.then_some(end))
    }

    /// Closes a cell of the map by force, until readings say otherwise.
    pub fn close(&mut self, cell: Cell) -> Option<Change> {
        self.learn(cell, 2.0 * MOST)
    }

    /// The cells that a beam passed, and the one in which it ended. An obstacle stops a beam where it enters: a beam
    /// that got well into a cell has passed it. Where one of the cells in which it may have ended is an obstacle
    /// already, that one explains the reading.
    fn passed(&self, ray: Ray, reading_m: f64, slack_m: f64) -> (Vec<Cell>, Cell) {
        let cells: Vec<_> = ray.take_while(|crossing| crossing.enter_m <= reading_m + slack_m).collect();
        let surely = cells.partition_point(|crossing| crossing.enter_m < reading_m - slack_m);
        let known = cells[surely..].iter().find(|crossing| !self.map.is_free(crossing.cell));
        let end = known.or(cells.last()).map_or(Cell::default(), |crossing| crossing.cell);
        let passed = cells[..surely].iter().map(|crossing| crossing.cell).filter(|&cell| cell != end);
        (passed.collect(), end)
    }

    fn meet(&mut self, cell: Cell) -> Option<Change> {
        let index = self.map.index(cell)?;
        let last = std::mem::replace(&mut self.met[index], self.looks);
        if self.map.is_free(cell) && self.looks - last > APART {
            self.log_odds[index] = self.log_odds[index].min(GIVEN_FREE);
        }
        self.learn(cell, HIT)
    }

    fn learn(&mut self, cell: Cell, evidence: f64) -> Option<Change> {
        let index = self.map.index(cell)?;
        let odds = &mut self.log_odds[index];
        *odds = (*odds + evidence).clamp(-MOST, MOST);
        // In between all stays as it was.
        let closed = if *odds >= 1.0 {
            true
        } else if *odds <= -1.0 {
            false
        } else {
            return None;
        };
        if closed != self.map.is_free(cell) {
            return None;
        }
        self.map.set_obstacle(cell, closed);
        Some((cell, closed))
    }
}
