//! A field on a map that changes: it is repaired where a change matters instead of flooded anew.
//!
//! A blocked cell makes *orphans* of the cells whose every shortest way led through it. They are collected level by
//! level, then reached anew from the rim around them; a freed cell lets the wave on from where it stood. The work
//! follows the number of cells whose distance changes, not the size of the map.
//!
//! Sources: Koenig and Likhachev, *D\* Lite*, 2002 (repair from the target); Kalra, Ferguson and Stentz,
//! *Incremental Reconstruction of Generalized Voronoi Diagrams on Grids*, 2006 (raise and lower waves). All steps
//! cost the same here, so that plain queues in order of distance replace their heaps.

use super::padded::{NEVER, OBSTACLE, Padded};
use crate::error::Error;
use crate::lattice::{Cell, Dir, Lattice};
use crate::map::Map;

/// A repair gives up and floods when it touches more than one in this many cells of the map. Measured: an orphan
/// takes 8 to 25 ns, a cell of a fresh flood, with the counting of changes, as much or more.
const FLOOD_FROM_SHARE: usize = 2;

/// The distances to one target on a map whose cells become blocked and free.
///
/// After every change it answers exactly as [`Map::wave`] on the changed map would. If the target itself is blocked
/// no cell reaches it, until it is free again.
///
/// ```
/// use activecell::{Cell, Lattice, LiveField, Map};
/// let map = Map::parse(Lattice::Square, "S..\n.#.\n..F")?;
/// let mut field = LiveField::new(&map, Cell::new(2, 2))?;
/// assert_eq!(field.steps(Cell::new(0, 0)), Some(4));
/// assert_eq!(field.set(Cell::new(1, 2), true), 3); // this cell and two that came through it
/// assert_eq!(field.set(Cell::new(2, 1), true), 6); // nothing leads to the target any more
/// assert_eq!(field.steps(Cell::new(0, 0)), None);
/// assert_eq!(field.map().to_text(), "S..\n.##\n.#F\n");
/// assert_eq!(field.set(Cell::new(1, 2), false), 6);
/// assert_eq!(field.steps(Cell::new(0, 0)), Some(4));
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct LiveField {
    map: Map,
    target: Cell,
    padded: Padded,
    /// Steps + 1.
    values: Vec<u32>,
    work: Work,
}

/// Room for a repair, kept so that a change allocates nothing.
#[derive(Debug, Clone, Default)]
struct Work {
    /// Changed cells: place and value before.
    touched: Vec<(u32, u32)>,
    /// Reached cells that were blocked: value before and place.
    cut: Vec<(u32, u32)>,
    /// Cells that lost their last shortest way: value before and place.
    orphans: Vec<(u32, u32)>,
    freed: Vec<u32>,
    /// Orphans and freed cells at the rim: value from there, and place.
    seeds: Vec<(u32, u32)>,
    queue: Vec<u32>,
}

impl LiveField {
    /// Floods the map from `target`.
    ///
    /// # Errors
    /// [`Error::OutsideMap`] or [`Error::TargetOccupied`].
    pub fn new(map: &Map, target: Cell) -> Result<Self, Error> {
        let padded = Padded::new(map);
        let values = flooded(map, &padded, target)?;
        Ok(Self { map: map.clone(), target, padded, values, work: Work::default() })
    }

    /// Blocks or frees one cell; says how many cells' distances changed (blocked cells have none).
    ///
    /// Nothing happens if the cell is so already, or outside the map: there all is obstacle and stays so.
    pub fn set(&mut self, cell: Cell, blocked: bool) -> usize {
        self.set_all(&[(cell, blocked)])
    }

    /// Blocks (`true`) and frees (`false`) many cells at once, the last word on a cell counting; says how many
    /// cells' distances changed between before and after.
    pub fn set_all(&mut self, changes: &[(Cell, bool)]) -> usize {
        match self.map.lattice() {
            Lattice::Square => self.change::<4>(changes),
            Lattice::Hex => self.change::<6>(changes),
        }
    }

    /// The map as it is now. Clones of it do not change with the field.
    pub const fn map(&self) -> &Map {
        &self.map
    }

    /// Where the wave starts.
    pub const fn target(&self) -> Cell {
        self.target
    }

    /// The steps from `cell` to the target; `None` where no way leads there.
    #[inline]
    pub fn steps(&self, cell: Cell) -> Option<u32> {
        let value = self.values[self.padded.place(cell)?];
        (value != NEVER).then(|| value.checked_sub(1)).flatten()
    }

    /// The directions that lead one step nearer to the target; none at the target and where no way leads there.
    pub fn nearer(&self, cell: Cell) -> impl Iterator<Item = Dir> + '_ {
        let wanted = self.steps(cell).and_then(|steps| steps.checked_sub(1));
        let lattice = self.map.lattice();
        lattice
            .dirs()
            .filter(move |&dir| wanted.is_some() && self.steps(lattice.neighbour(cell, dir)) == wanted)
    }

    fn change<const N: usize>(&mut self, changes: &[(Cell, bool)]) -> usize {
        self.apply(changes);
        let limit = self.map.cells() / FLOOD_FROM_SHARE;
        if self.work.touched.len() > limit.max(64) || !self.collect_orphans::<N>(limit.max(64)) {
            return self.flood_anew();
        }
        let reached = self.reach_anew::<N>();
        // Every reached cell was written once; what is written is a change, but for orphans, which may get back
        // what they had.
        let (mut changed, mut known) = (self.work.cut.len(), 0);
        for &(before, place) in &self.work.orphans {
            let now = self.values[place as usize];
            changed += usize::from(now != before);
            known += usize::from(now != NEVER);
        }
        changed + reached - known
    }

    /// Writes the changes into map and values, and sorts out what they mean.
    fn apply(&mut self, changes: &[(Cell, bool)]) {
        let Work { touched, cut, orphans, freed, .. } = &mut self.work;
        for list in [&mut *touched, &mut *cut, orphans] {
            list.clear();
        }
        freed.clear();
        for &(cell, blocked) in changes {
            if let Some(place) = self.padded.place(cell)
                && self.map.is_free(cell) == blocked
            {
                self.map.set_obstacle(cell, blocked);
                touched.push((place as u32, self.values[place]));
                self.values[place] = if blocked { OBSTACLE } else { NEVER };
            }
        }
        // Of a cell that was changed more than once the first value before and the last state count.
        touched.sort_by_key(|&(place, _)| place);
        touched.dedup_by_key(|&mut (place, _)| place);
        touched.retain(|&(place, before)| {
            let now = &mut self.values[place as usize];
            match (before == OBSTACLE, *now == OBSTACLE) {
                (true, false) => freed.push(place),
                (false, true) if before != NEVER => cut.push((before, place)),
                (false, true) => {}
                _ => {
                    *now = before;
                    return false;
                }
            }
            true
        });
        cut.sort_unstable();
    }

    /// Finds the cells whose every shortest way led through blocked cells and takes their values away. Gives up,
    /// with `false`, when there are more than `limit`.
    fn collect_orphans<const N: usize>(&mut self, limit: usize) -> bool {
        let Work { cut, orphans, .. } = &mut self.work;
        let values = &mut self.values;
        let (mut next_cut, mut next_orphan) = (0, 0);
        // In order of level: when a level is looked at, all orphans of the level before are known.
        loop {
            let (level, place) = match (cut.get(next_cut), orphans.get(next_orphan)) {
                (Some(&cut), Some(&orphan)) if orphan.0 < cut.0 => (next_orphan += 1, orphan).1,
                (Some(&cut), _) => (next_cut += 1, cut).1,
                (None, Some(&orphan)) => (next_orphan += 1, orphan).1,
                (None, None) => return true,
            };
            for near in self.padded.around::<N>(place as usize) {
                if values[near] == level + 1
                    && self.padded.around::<N>(near).iter().all(|&other| values[other] != level)
                {
                    values[near] = NEVER;
                    orphans.push((level + 1, near as u32));
                }
            }
            if orphans.len() > limit {
                return false;
            }
        }
    }

    /// Lets the wave into orphans and freed cells from their rim, and on from there wherever it comes nearer;
    /// says how many cells it reached.
    fn reach_anew<const N: usize>(&mut self) -> usize {
        let Work { orphans, freed, seeds, queue, .. } = &mut self.work;
        let values = &mut self.values;
        let target = self.padded.place(self.target);
        seeds.clear();
        queue.clear();
        for place in orphans.iter().map(|orphan| orphan.1).chain(freed.iter().copied()) {
            let nearest = self.padded.around::<N>(place as usize).map(|near| values[near].wrapping_sub(1));
            // One less, obstacles become the largest value and cells without way the largest but one.
            let least = nearest.into_iter().fold(u32::MAX, u32::min);
            if Some(place as usize) == target {
                seeds.push((1, place));
            } else if least < NEVER - 1 {
                seeds.push((least + 2, place));
            }
        }
        seeds.sort_unstable();
        let (mut waiting, mut next, mut reached) = (seeds.iter().copied().peekable(), 0, 0);
        loop {
            // Seeds join the queue one step ahead of the wave, so that every cell is written once.
            let value = match (queue.get(next), waiting.peek()) {
                (Some(&place), _) => values[place as usize],
                (None, Some(seed)) => seed.0 - 1,
                (None, None) => return reached,
            };
            while let Some((seed, place)) = waiting.next_if(|seed| seed.0 <= value + 1) {
                if values[place as usize] > seed {
                    values[place as usize] = seed;
                    reached += 1;
                    queue.push(place);
                }
            }
            let Some(&place) = queue.get(next) else { continue };
            next += 1;
            let value = values[place as usize];
            for near in self.padded.around::<N>(place as usize) {
                if values[near] > value + 1 {
                    values[near] = value + 1;
                    reached += 1;
                    queue.push(near as u32);
                }
            }
        }
    }

    /// Floods the map from the target, for changes that touch much of it.
    fn flood_anew(&mut self) -> usize {
        for &(before, place) in &self.work.orphans {
            self.values[place as usize] = before;
        }
        for &(place, before) in &self.work.touched {
            self.values[place as usize] = before;
        }
        let values =
            flooded(&self.map, &self.padded, self.target).unwrap_or_else(|_| self.padded.blank(&self.map));
        let distance = |value: u32| if value == OBSTACLE { NEVER } else { value };
        let pairs = self.values.iter().zip(&values);
        let changed = pairs.filter(|&(&before, &now)| distance(before) != distance(now)).count();
        self.values = values;
        changed
    }
}

/// The values of a fresh flood.
fn flooded(map: &Map, padded: &Padded, target: Cell) -> Result<Vec<u32>, Error> {
    let field = map.wave(target)?;
    let mut values = padded.blank(map);
    for cell in map.free() {
        if let (Some(place), Some(steps)) = (padded.place(cell), field.steps(cell)) {
            values[place] = steps + 1;
        }
    }
    Ok(values)
}
