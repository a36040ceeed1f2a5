//! Slopes: the terrain of an uneven map for a robot that can climb only so much, and the check of a route over it.

use super::{Robot, Slopes};
use crate::error::Error;
use crate::lattice::{Cell, Dir};
use crate::map::{Elevation, Ground, Map, PointM, Profile};
use crate::route::RouteFault;
use crate::wave::Terrain;

impl Terrain {
    /// What a step of one cell on level ground costs where the ground counts ([`Map::terrain_for`]).
    pub const CELL_COST: u16 = 64;
}

/// A slope may exceed a limit by this share: limits are round numbers, and so are ramps.
const SLACK: f64 = 1e-6;

impl Slopes {
    /// Whether a robot may drive over this ground.
    pub fn allow(&self, profile: &Profile) -> bool {
        let within = |slope: f64, most_deg: f64| slope <= most_deg.to_radians().tan() * (1.0 + SLACK) + 1e-9;
        within(profile.up, self.up_max_deg)
            && within(profile.down, self.down_max_deg)
            && within(profile.across, self.across_max_deg)
    }

    /// What a step costs: its length on the ground and what climbing is worth avoiding, in parts of a cell.
    fn cost(&self, profile: &Profile, ground: Ground, cell_m: f64) -> u16 {
        let way_m = profile.ground_m(ground) + self.climb_cost_m_per_m * profile.climb_m;
        (way_m / cell_m * f64::from(Terrain::CELL_COST)).round().clamp(1.0, f64::from(u16::MAX)) as u16
    }
}

impl Map {
    /// The terrain of this map for a robot on uneven ground: its steps cost their length on the ground, plus what
    /// the robot would rather drive than climb ([`Slopes::climb_cost_m_per_m`]), in 64ths of a cell
    /// ([`Terrain::CELL_COST`]); steps that are too steep for it up, down or across, anywhere on their way, are
    /// closed. Cells that no step leads into or out of are obstacles.
    ///
    /// Without an elevation it is plain ground.
    ///
    /// # Errors
    /// None that a map can cause; the signature is that of [`Terrain::set_step`].
    ///
    /// ```
    /// use activecell::{Cell, Elevation, Ground, Lattice, Map, Posts, Robot};
    /// // A wall of 1 m, with a gap at its lower end.
    /// let heights = vec![0.0, 0.0, 1.0, 0.0, 0.0,
    ///                    0.0, 0.0, 1.0, 0.0, 0.0,
    ///                    0.0, 0.0, 0.0, 0.0, 0.0,
    ///                    0.0, 0.0, 0.0, 0.0, 0.0];
    /// let walled = Elevation::new(5, 4, heights, Posts::default())?;
    /// let map = Map::parse(Lattice::Square, ".....\n.....\n.....\n.....")?.elevated(walled, Ground::Surface);
    /// let field = map.terrain_for(&Robot::default())?.wave(Cell::new(4, 0))?;
    /// assert_eq!(field.route(Cell::new(0, 0)).steps(), 10); // around the wall; over it are 4
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn terrain_for(&self, robot: &Robot) -> Result<Terrain, Error> {
        let mut terrain = Terrain::new(self);
        let Some(elevation) = self.elevation() else { return Ok(terrain) };
        let lattice = self.lattice();
        let half = lattice.degree() / 2;
        let mut used = vec![false; self.cells()];
        for cell in self.free() {
            for dir in (0..half).map(Dir) {
                let next = lattice.neighbour(cell, dir);
                if !self.is_free(next) {
                    continue;
                }
                // A step and the one back are measured once, so that they agree.
                let there = elevation.profile(self.centre_m(cell), self.centre_m(next));
                let mut set = |from: Cell, dir: Dir, profile: Option<Profile>| {
                    let cost = profile
                        .filter(|profile| robot.slopes.allow(profile))
                        .map(|profile| robot.slopes.cost(&profile, self.ground(), self.frame().cell_m));
                    if cost.is_some() {
                        for end in [cell, next].into_iter().filter_map(|end| self.index(end)) {
                            used[end] = true;
                        }
                    }
                    terrain.set_step(from, dir, cost)
                };
                set(cell, dir, there)?;
                set(next, lattice.opposite(dir), there.map(Profile::back))?;
            }
        }
        let alone = self.free().filter(|&cell| self.index(cell).is_some_and(|index| !used[index]));
        terrain.keep_out(alone)?;
        Ok(terrain)
    }
}

/// Checks that no step of a route over uneven ground is too steep for the robot: by probing the heights along it and
/// beside it, knowing nothing of how slopes are found elsewhere. Anything goes on a map without an elevation.
///
/// A slope between two probes may be a little steeper than they tell, so a twentieth above a limit passes.
///
/// # Errors
/// [`RouteFault::Closed`] for the first step that is too steep or whose heights are not known.
///
/// ```
/// use activecell::{Cell, Elevation, Ground, Lattice, Map, Posts, Robot, RouteFault, check_slopes};
/// let step = Elevation::new(3, 1, vec![0.0, 0.1, 1.0], Posts::default())?;
/// let map = Map::parse(Lattice::Square, "...")?.elevated(step, Ground::Surface);
/// let cells = [Cell::new(0, 0), Cell::new(1, 0), Cell::new(2, 0)];
/// assert_eq!(check_slopes(&map, &Robot::default(), &cells[..2]), Ok(()));
/// let fault = RouteFault::Closed(2, cells[1], cells[2]);
/// assert_eq!(check_slopes(&map, &Robot::default(), &cells), Err(fault));
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn check_slopes(map: &Map, robot: &Robot, cells: &[Cell]) -> Result<(), RouteFault> {
    let Some(elevation) = map.elevation() else { return Ok(()) };
    let Slopes { up_max_deg, down_max_deg, across_max_deg, .. } = robot.slopes;
    let most = [up_max_deg, down_max_deg, across_max_deg].map(|deg| 1.05 * deg.to_radians().tan() + 1e-6);
    for (step, pair) in cells.windows(2).enumerate() {
        let probed = probe(elevation, map.centre_m(pair[0]), map.centre_m(pair[1]));
        if probed.is_none_or(|steepest| steepest.iter().zip(most).any(|(&slope, most)| slope > most)) {
            return Err(RouteFault::Closed(step + 1, pair[0], pair[1]));
        }
    }
    Ok(())
}

/// The steepest slopes up, down and across between probes, eight for each post on the way.
fn probe(elevation: &Elevation, from: PointM, to: PointM) -> Option<[f64; 3]> {
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    let (length_m, apart_m) = (dx.hypot(dy), elevation.posts().apart_m);
    let post_m = apart_m[0].min(apart_m[1]);
    let pieces = (8.0 * length_m / post_m).ceil().clamp(8.0, 1e6);
    // To the left, so far that rounding does not show and the surface hardly bends.
    let aside = [-dy, dx].map(|part| part / length_m * post_m / 64.0);
    let mut before = elevation.height_m(from)?;
    let mut steepest = [0.0f64; 3];
    for i in 1..=pieces as u32 {
        let part = f64::from(i) / pieces;
        let [x, y] = [from[0] + part * dx, from[1] + part * dy];
        let height = elevation.height_m([x, y])?;
        let left = elevation.height_m([x + aside[0], y + aside[1]]).unwrap_or(height);
        let right = elevation.height_m([x - aside[0], y - aside[1]]).unwrap_or(height);
        let slope = (height - before) * pieces / length_m;
        let across = (left - right).abs() / (post_m / 32.0);
        steepest = [steepest[0].max(slope), steepest[1].max(-slope), steepest[2].max(across)];
        before = height;
    }
    Some(steepest)
}
