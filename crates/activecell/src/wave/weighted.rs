//! The wave over terrain: a cell that costs more holds the wave back for longer.
//!
//! The delays are small whole numbers, so the cells that the wave enters in the next 255 time steps lie in a ring of
//! buckets, one a time step (Dial, *Algorithm 360: shortest-path forest with topological ordering*, 1969). The wave
//! runs from the target against the steps, and a cell delays all that comes through it alike; so the first time step
//! at which it reaches a cell is final, and every cell enters a bucket once.

use super::padded::{NEVER, OBSTACLE};
use super::terrain::Terrain;
use crate::error::Error;
use crate::lattice::{Cell, Dir, Lattice};

/// One more than the largest cost.
const RING: usize = 256;

/// For every cell, the cost of the cheapest way from it to the target.
///
/// Where all costs are 1 and no cell is one-way it equals the [`crate::Field`] of the terrain's map.
#[derive(Debug, Clone, PartialEq)]
pub struct WeightedField {
    terrain: Terrain,
    target: Cell,
    /// Cost + 1.
    values: Vec<u32>,
}

impl Terrain {
    /// Floods the terrain from `target`.
    ///
    /// # Errors
    /// [`Error::OutsideMap`] or [`Error::TargetOccupied`]; [`Error::BadValue`] if a route may cost more than about
    /// four thousand million.
    ///
    /// ```
    /// use activecell::{Cell, Lattice, Map, Terrain};
    /// let map = Map::parse(Lattice::Square, "S..F")?;
    /// let mut terrain = Terrain::new(&map);
    /// terrain.set_cost([Cell::new(2, 0), Cell::new(0, 0)], 7)?;
    /// let field = terrain.wave(Cell::new(3, 0))?;
    /// assert_eq!(field.cost(Cell::new(0, 0)), Some(1 + 7 + 1)); // the start is not entered
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn wave(&self, target: Cell) -> Result<WeightedField, Error> {
        let map = self.map();
        map.check_target(target)?;
        let mut field = WeightedField { terrain: self.clone(), target, values: self.padded().blank(map) };
        match (map.lattice(), self.exits().is_empty()) {
            (Lattice::Square, true) => field.spread::<4, false>(),
            (Lattice::Square, false) => field.spread::<4, true>(),
            (Lattice::Hex, true) => field.spread::<6, false>(),
            (Lattice::Hex, false) => field.spread::<6, true>(),
        }?;
        Ok(field)
    }
}

impl WeightedField {
    /// The terrain.
    pub const fn terrain(&self) -> &Terrain {
        &self.terrain
    }

    /// Where the wave started.
    pub const fn target(&self) -> Cell {
        self.target
    }

    /// The cost of the cheapest way from `cell` to the target; `None` where no way leads there.
    #[inline]
    pub fn cost(&self, cell: Cell) -> Option<u32> {
        let value = self.values[self.terrain.padded().place(cell)?];
        (value != NEVER).then(|| value.checked_sub(1)).flatten()
    }

    /// The directions of the steps with which a cheapest way to the target begins; none at the target and where no
    /// way leads there.
    pub fn nearer(&self, cell: Cell) -> impl Iterator<Item = Dir> + '_ {
        let lattice = self.terrain.map().lattice();
        let here = self.cost(cell);
        lattice.dirs().filter(move |&dir| {
            let next = lattice.neighbour(cell, dir);
            let through = self.cost(next).map(|cost| cost + u32::from(self.terrain.cost(next)));
            here.is_some() && through == here && self.terrain.may_step(cell, dir)
        })
    }

    fn spread<const N: usize, const ONE_WAY: bool>(&mut self) -> Result<(), Error> {
        let (padded, costs) = (self.terrain.padded(), self.terrain.costs());
        let exits = self.terrain.exits();
        let values = &mut self.values;
        let mut ring: Vec<Vec<u32>> = vec![Vec::new(); RING];
        let origin = padded.place(self.target).expect("the target was checked");
        values[origin] = 1;
        ring[(1 + usize::from(costs[origin])) % RING].push(origin as u32);
        // The time step at which cells let the wave out, and how many still hold it back.
        let (mut now, mut waiting) = (1u32, 1);
        while waiting > 0 {
            now += 1;
            if now > NEVER - RING as u32 {
                let allowed = "at most about 4294967000; use smaller costs";
                return Err(Error::BadValue { name: "the cost of a route", value: now.into(), allowed });
            }
            let mut bucket = std::mem::take(&mut ring[now as usize % RING]);
            waiting -= bucket.len();
            for &place in &bucket {
                let place = place as usize;
                for (side, near) in padded.around::<N>(place).into_iter().enumerate() {
                    if values[near] > now && (!ONE_WAY || passes::<N>(exits, near, place, side)) {
                        values[near] = now;
                        ring[(now as usize + usize::from(costs[near])) % RING].push(near as u32);
                        waiting += 1;
                    }
                }
            }
            bucket.clear();
            // The bucket's memory serves again, 256 time steps from now.
            ring[now as usize % RING] = bucket;
        }
        debug_assert!(values.iter().all(|&value| value == OBSTACLE || value > 0));
        Ok(())
    }
}

/// Whether one-way rules let a robot step from `near`, the neighbour of `place` in direction `side`, into `place`.
#[inline]
fn passes<const N: usize>(exits: &[u8], near: usize, place: usize, side: usize) -> bool {
    let step = (side + N / 2) % N;
    let head_on = exits[place] >> step & 1 == 0 && exits[place] >> side & 1 == 1;
    exits[near] >> step & 1 == 1 && !head_on
}
