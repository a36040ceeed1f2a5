//! The wave over terrain: a cell that costs more holds the wave back for longer.
//!
//! The delays are small whole numbers, so the cells that the wave enters in the next 255 time steps lie in a ring of
//! buckets, one a time step (Dial, *Algorithm 360: shortest-path forest with topological ordering*, 1969). The wave
//! runs from the target against the steps, and a cell delays all that comes through it alike; so the first time step
//! at which it reaches a cell is final, and every cell enters a bucket once.
//!
//! Where steps have costs of their own, a cell may be reached sooner by a wave that set out later. It then enters a
//! bucket again, and the late bucket finds it done.

use super::padded::{NEVER, OBSTACLE};
use super::terrain::{Terrain, product};
use crate::error::Error;
use crate::lattice::{Cell, Dir, Lattice};

/// One more than the largest cost of a cell.
const RING: usize = 256;

/// For every cell, the cost of the cheapest way from it to the target.
///
/// Where all costs are 1, no cell is one-way and no step closed it equals the [`crate::Field`] of the terrain's map.
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
        match (map.lattice(), self.exits().is_empty(), self.steps().is_empty()) {
            (Lattice::Square, true, true) => field.spread::<4, false>(),
            (Lattice::Square, false, true) => field.spread::<4, true>(),
            (Lattice::Square, _, false) => field.spread_by_steps::<4>(),
            (Lattice::Hex, true, true) => field.spread::<6, false>(),
            (Lattice::Hex, false, true) => field.spread::<6, true>(),
            (Lattice::Hex, _, false) => field.spread_by_steps::<6>(),
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
            let through =
                self.cost(next).zip(self.terrain.step_cost(cell, dir)).map(|(rest, step)| rest + step);
            here.is_some() && through == here
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
            check_time(now, RING)?;
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

    /// As [`Self::spread`], where steps have costs of their own.
    fn spread_by_steps<const N: usize>(&mut self) -> Result<(), Error> {
        let (padded, costs) = (self.terrain.padded(), self.terrain.costs());
        let (exits, steps) = (self.terrain.exits(), self.terrain.steps());
        let values = &mut self.values;
        let buckets = self.terrain.dearest_step() as usize + 1;
        let mut ring: Vec<Vec<u32>> = vec![Vec::new(); buckets];
        let origin = padded.place(self.target).expect("the target was checked");
        values[origin] = 1;
        ring[1 % buckets].push(origin as u32);
        let (mut now, mut waiting) = (1u32, 1);
        while waiting > 0 {
            check_time(now, buckets)?;
            let mut bucket = std::mem::take(&mut ring[now as usize % buckets]);
            waiting -= bucket.len();
            for place in bucket.drain(..).map(|place| place as usize) {
                if values[place] != now {
                    continue; // It was reached sooner.
                }
                for (side, near) in padded.around::<N>(place).into_iter().enumerate() {
                    let own = steps[near * N + (side + N / 2) % N];
                    let time = now + product(own, costs[place]);
                    if own != 0
                        && values[near] > time
                        && (exits.is_empty() || passes::<N>(exits, near, place, side))
                    {
                        values[near] = time;
                        ring[time as usize % buckets].push(near as u32);
                        waiting += 1;
                    }
                }
            }
            ring[now as usize % buckets] = bucket;
            now += 1;
        }
        Ok(())
    }
}

/// Refuses waves that last longer than can be counted.
fn check_time(now: u32, buckets: usize) -> Result<(), Error> {
    if now > NEVER - buckets as u32 {
        let allowed = "at most about 4294900000; use smaller costs";
        return Err(Error::BadValue { name: "the cost of a route", value: now.into(), allowed });
    }
    Ok(())
}

/// Whether one-way rules let a robot step from `near`, the neighbour of `place` in direction `side`, into `place`.
#[inline]
fn passes<const N: usize>(exits: &[u8], near: usize, place: usize, side: usize) -> bool {
    let step = (side + N / 2) % N;
    let head_on = exits[place] >> step & 1 == 0 && exits[place] >> side & 1 == 1;
    exits[near] >> step & 1 == 1 && !head_on
}
