//! One start, one target: a shortest path on the bare map, without touching the rest of it.
//!
//! Four exact methods, of which the map's look chooses one, since each is ahead of the others somewhere
//! (mean time of a query, own measurement on `MovingAI` maps):
//!
//! | method | file | chosen for |
//! |---|---|---|
//! | jump points on bit planes | `jump.rs` | squares with few corners: rooms, streets, caves, mazes |
//! | A* by detours, 8 × 8 cells at a time | `detour.rs` | squares strewn with small obstacles |
//! | cell by cell, dead ends closed | `ways.rs` | squares with mazes of one-cell ways or dense clutter |
//! | floods from both ends, 8 × 8 cells at a time | `meet.rs` | hexagons |

mod detour;
mod jump;
mod meet;
mod planes;
#[cfg(test)]
mod tests;
mod tiles;
mod ways;

use crate::error::Error;
use crate::lattice::{Cell, Lattice};
use crate::map::Map;
use detour::Detours;
use jump::Jumps;
use meet::Floods;
use planes::free_word;
use ways::Ways;

/// Above this share of corners among the free cells the map is strewn with obstacles: jumps become too short.
/// Measured: rooms, streets, caves and mazes stay below 0.05, a floor with 10 % of single obstacles has 0.16.
const STREWN: f64 = 0.1;

/// Above this many runs of free cells, along rows and columns, for each free cell the map is a maze of one-cell ways
/// or nearly one: words of cells hold little of a rim each.
/// Measured: such mazes have 0.9 to 1.0, single obstacles on 40 % of the floor 0.80, on 37 % 0.74.
const ONE_CELL_WAYS: f64 = 0.775;

/// A map prepared for shortest paths between two cells.
///
/// Preparing takes 0.1 to 0.3 ms for a million cells; in mazes of one-cell ways and dense clutter the first query adds
/// up to 4 ms for a million cells, in which it closes the dead ends. A query touches what lies on its way; what it touched is
/// cleaned before the next one, the rest of the map is left alone. Planes and rims together take at
/// most one byte a cell; maps of fewer than 512 × 512 cells may take 64 KiB more, and 64 bytes for each 8 cells
/// along the border (columns and rows counted in whole words of 64).
///
/// ```
/// use activecell::{Cell, Lattice, Map, Search, check_route};
/// let map = Map::parse(Lattice::Square, "S.#.\n..#.\n...F")?;
/// let (from, to) = (Cell::new(0, 0), Cell::new(3, 2));
/// let mut search = Search::new(&map);
/// let path = search.path(from, to)?.expect("there is a way");
/// assert_eq!(path.len(), 6); // both ends included
/// assert!(check_route(&map, &path, from, to).is_ok());
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Search {
    map: Map,
    method: Method,
    engine: Engine,
    /// Whether the engine is not the method's, but answered a query that the method had no room for.
    stands_in: bool,
}

/// How a map is searched.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Method {
    /// Jump points; squares only.
    Jump,
    /// A* by detours; squares only.
    Detour,
    /// Cell by cell with the dead ends closed; squares only.
    Ways,
    /// Two floods that meet; hexagons only.
    Meet,
}

/// Why a search ended without an answer: its rim outgrew the memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct OutOfRoom;

/// A method with its planes and its rim.
#[derive(Debug, Clone, Default)]
enum Engine {
    Jump(Box<Jumps>),
    Detour(Box<Detours>),
    Ways(Box<Ways>),
    Meet(Box<Floods>),
    /// Between two methods: the memory of the one is given back before the other takes its own.
    #[default]
    None,
}

impl Search {
    /// Prepares a map.
    pub fn new(map: &Map) -> Self {
        Self::by(map, Method::of(map))
    }

    /// Prepares a map for one method.
    pub(crate) fn by(map: &Map, method: Method) -> Self {
        // Hexagons know one method, and no other lattice knows it.
        let method = match map.lattice() {
            Lattice::Hex => Method::Meet,
            Lattice::Square if method == Method::Meet => Method::of(map),
            Lattice::Square => method,
        };
        Self { map: map.clone(), method, engine: Engine::new(map, method), stands_in: false }
    }

    /// A shortest path from `from` to `to`, cell by cell, both ends included; `None` if there is none.
    ///
    /// The same map and the same ends give the same path, whatever was asked before.
    ///
    /// # Errors
    /// As [`Map::check_task`]: [`Error::OutsideMap`], [`Error::StartOccupied`], [`Error::TargetOccupied`].
    pub fn path(&mut self, from: Cell, to: Cell) -> Result<Option<Vec<Cell>>, Error> {
        let Some(steps) = self.steps(from, to)? else { return Ok(None) };
        if from == to {
            return Ok(Some(vec![from]));
        }
        Ok(Some(match &self.engine {
            Engine::Jump(jumps) => jumps.path(from, to, steps),
            Engine::Detour(detours) => detours.path(from, to, steps),
            Engine::Ways(ways) => ways.path(from, to, steps),
            Engine::Meet(floods) => floods.path(from, to, steps),
            Engine::None => Vec::new(),
        }))
    }

    /// The number of steps of a shortest path from `from` to `to`; `None` if there is none.
    ///
    /// ```
    /// use activecell::{Cell, Lattice, Map, Search};
    /// let map = Map::parse(Lattice::Hex, "..#.\n..#.\n..#.")?;
    /// let mut search = Search::new(&map);
    /// assert_eq!(search.steps(Cell::new(0, 0), Cell::new(1, 2))?, Some(2));
    /// assert_eq!(search.steps(Cell::new(0, 0), Cell::new(3, 2))?, None);
    /// # Ok::<(), activecell::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`Map::check_task`]: [`Error::OutsideMap`], [`Error::StartOccupied`], [`Error::TargetOccupied`].
    pub fn steps(&mut self, from: Cell, to: Cell) -> Result<Option<u32>, Error> {
        self.map.check_task(from, to)?;
        if from == to {
            return Ok(Some(0));
        }
        if self.stands_in {
            self.engine = Engine::default();
            self.engine = Engine::new(&self.map, self.method);
            self.stands_in = false;
        }
        if let Ok(steps) = self.engine.run(from, to) {
            return Ok(steps);
        }
        // The rim outgrew its memory: the query is answered by detours, in the same memory.
        // The old planes go before the new ones come.
        self.engine = Engine::default();
        self.engine = Engine::new(&self.map, Method::Detour);
        self.stands_in = true;
        Ok(self.engine.run(from, to).unwrap_or_default())
    }

    /// The memory held at present, in bytes: planes, back-trace and rims, without the map itself.
    ///
    /// ```
    /// use activecell::{Lattice, Map, Search};
    /// let map = Map::random(Lattice::Square, 1000, 1000, 0.1, 1)?;
    /// assert!(Search::new(&map).bytes() < 1_000_000 + (1 << 16));
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn bytes(&self) -> usize {
        match &self.engine {
            Engine::Jump(jumps) => jumps.bytes(),
            Engine::Detour(detours) => detours.bytes(),
            Engine::Ways(ways) => ways.bytes(),
            Engine::Meet(floods) => floods.bytes(),
            Engine::None => 0,
        }
    }
}

impl Engine {
    fn new(map: &Map, method: Method) -> Self {
        match method {
            // One byte a cell in all, of which the planes take half; small maps get more.
            Method::Jump => Self::Jump(Box::new(Jumps::new(map, map.cells(), 1 << 16))),
            Method::Detour => Self::Detour(Box::new(Detours::new(map))),
            // Five eighths for the planes, a quarter for the rims.
            Method::Ways => Self::Ways(Box::new(Ways::new(map, (map.cells() / 48).max(1 << 10)))),
            Method::Meet => Self::Meet(Box::new(Floods::new(map))),
        }
    }

    /// The length of a shortest way between two different free cells.
    fn run(&mut self, from: Cell, to: Cell) -> Result<Option<u32>, OutOfRoom> {
        match self {
            Self::Jump(jumps) => jumps.run(from, to),
            Self::Detour(detours) => {
                let empty = Lattice::Square.distance(from, to);
                Ok(detours.run(from, to).map(|detours| empty + 2 * detours))
            }
            Self::Ways(ways) => ways.run(from, to),
            Self::Meet(floods) => Ok(floods.run(from, to)),
            Self::None => Ok(None),
        }
    }
}

impl Method {
    /// The method for a map, by its lattice and its share of corners.
    fn of(map: &Map) -> Self {
        match map.lattice() {
            Lattice::Hex => Self::Meet,
            Lattice::Square if map.clutter() > ONE_CELL_WAYS => Self::Ways,
            Lattice::Square if corner_share(map) > STREWN => Self::Detour,
            Lattice::Square => Self::Jump,
        }
    }
}

/// The share of free cells that are forced corners of a walk down.
fn corner_share(map: &Map) -> f64 {
    let words = map.width().div_ceil(64) as usize;
    let (mut corners, mut free) = (0, 0);
    let mut above = vec![0; words];
    for y in 0..map.height() {
        // Cells of this row below an obstacle, of the word before and of this one.
        let mut opens_before = 0;
        let mut here_before = 0;
        for (word, above) in above.iter_mut().enumerate() {
            let here = free_word(map.obstacles(), y, word);
            let opens = here & !*above;
            let passes = here & *above;
            corners += (passes & (opens << 1 | opens_before >> 63)).count_ones()
                + (passes & opens >> 1).count_ones()
                + (here_before >> 63 & opens & 1) as u32;
            free += here.count_ones();
            (opens_before, here_before, *above) = (opens, passes, here);
        }
    }
    f64::from(corners) / f64::from(free.max(1))
}
