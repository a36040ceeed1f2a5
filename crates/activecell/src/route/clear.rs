//! Routes that keep off walls: obstacles grown as far as a way is left, and what is narrower than wanted made dear.

use crate::error::Error;
use crate::lattice::Cell;
use crate::map::Map;
use crate::wave::Terrain;

/// Into how many bands the wanted clearance is divided.
const BANDS: u32 = 4;
/// What a step costs more for each band that is missing.
const BAND_COST: u32 = 4;

impl Map {
    /// The map on which every route from `from` to `to` keeps `clearance_m` from obstacles, or, where that leaves no
    /// way, the most that leaves one: its obstacles are grown as far.
    ///
    /// Clearance is measured between the centres of cells, as the crow flies, and the map's edge counts as obstacle.
    /// So a route beside a wall has one cell's size of it. If no way leads from `from` to `to` at all, the map is
    /// returned as it is.
    ///
    /// The most is found by bisection: if obstacles grown so far leave a way, less grown ones do too.
    ///
    /// # Errors
    /// As [`Map::check_task`]; [`Error::BadValue`] if the clearance is negative or no number.
    ///
    /// ```
    /// use activecell::{Lattice, Map, Rule};
    /// let map = Map::parse(Lattice::Square, ".......\n.......\n.S.#.F.\n.......\n.......\n.......\n.......")?;
    /// let (from, to) = (map.mark('S').unwrap(), map.mark('F').unwrap());
    /// let clear = map.kept_clear(from, to, 2.0)?;
    /// let route = clear.route(Rule::Wave, from, to, 1000)?;
    /// assert_eq!(route.steps(), 8); // under the obstacle with a row between; without clearance 6
    /// assert_eq!(map.clearance_m(route.cells()), Some(2.0));
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn kept_clear(&self, from: Cell, to: Cell, clearance_m: f64) -> Result<Self, Error> {
        self.check_task(from, to)?;
        if !(clearance_m >= 0.0 && clearance_m.is_finite()) {
            let allowed = "0 or more";
            return Err(Error::BadValue { name: "the clearance in metres", value: clearance_m, allowed });
        }
        let most = self.quarters(clearance_m).min(self.room_in_quarters(from)).min(self.room_in_quarters(to));
        let way_left =
            |clear: &Self| clear.reachable(&[to]).is_ok_and(|plane| plane.get(from.x as u32, from.y as u32));
        let clear = self.with_room(most);
        if way_left(&clear) {
            return Ok(clear);
        }
        let (mut kept, mut good, mut bad) = (self.clone(), 0, most);
        while bad - good > 1 {
            let middle = good.midpoint(bad);
            let clear = self.with_room(middle);
            if way_left(&clear) {
                (kept, good) = (clear, middle);
            } else {
                bad = middle;
            }
        }
        Ok(kept)
    }

    /// The terrain on which cheapest routes from `from` to `to` keep `clearance_m` from obstacles where they can: the
    /// map [`Map::kept_clear`], with steps that cost the more the less clearance a cell has.
    ///
    /// A doorway narrower than wanted so bounds the clearance of the route there, and not elsewhere. A step costs 1
    /// with all the clearance, and 4 more for each begun quarter that is missing: 5, 9, 13, 17. So a robot makes a
    /// detour of at most four steps to spare itself one with a quarter less.
    ///
    /// # Errors
    /// As [`Map::kept_clear`].
    ///
    /// ```
    /// use activecell::{Cell, Lattice, Map};
    /// let map = Map::parse(Lattice::Square, ".......\n.......\n.S...F.\n.......\n.......\n.......\n###.###\n...K...")?;
    /// let (from, to, closet) = (map.mark('S').unwrap(), map.mark('F').unwrap(), map.mark('K').unwrap());
    /// let terrain = map.terrain_kept_clear(from, closet, 2.0)?; // the door has one cell on each side of its middle
    /// assert_eq!(terrain.cost(Cell::new(3, 3)), 1);
    /// assert_eq!(terrain.cost(Cell::new(3, 6)), 1 + 2 * 4); // half of the clearance
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn terrain_kept_clear(&self, from: Cell, to: Cell, clearance_m: f64) -> Result<Terrain, Error> {
        let clear = self.kept_clear(from, to, clearance_m)?;
        let mut terrain = Terrain::new(&clear);
        for missing in 1..=BANDS {
            let share = f64::from(BANDS + 1 - missing) / f64::from(BANDS);
            let wide = self.with_room(self.quarters(share * clearance_m));
            let narrow = clear.free().filter(|&cell| !wide.is_free(cell));
            terrain.set_cost(narrow, (1 + missing * BAND_COST) as u8)?;
        }
        Ok(terrain)
    }

    /// The least square of a distance between centres, in quarters of a cell's size, that is this clearance.
    fn quarters(&self, clearance_m: f64) -> u64 {
        let cells = clearance_m / self.frame().cell_m;
        (4.0 * cells * cells * (1.0 - 1e-12)).ceil() as u64
    }

    /// The map without the cells whose distance to an obstacle has a smaller square than this.
    fn with_room(&self, quarters: u64) -> Self {
        self.grown_by_quarters(quarters.saturating_sub(1))
    }

    /// How far these cells stay from obstacles and the map's edge, in metres between centres: the least of them;
    /// 0 if one is an obstacle, `None` without a cell.
    pub fn clearance_m(&self, cells: &[Cell]) -> Option<f64> {
        let least = cells.iter().map(|&cell| self.room_in_quarters(cell)).min()?;
        Some((least as f64).sqrt() / 2.0 * self.frame().cell_m)
    }
}
