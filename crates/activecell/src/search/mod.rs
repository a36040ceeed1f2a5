//! One start, one target: a shortest path on the bare map, without touching the rest of it.

mod detour;
mod jump;
mod meet;
mod planes;
#[cfg(test)]
mod tests;
mod tiles;

use crate::error::Error;
use crate::lattice::{Cell, Lattice};
use crate::map::Map;
use detour::Detours;
use jump::{Jumps, OutOfRoom};
use meet::Floods;

/// A map prepared for shortest paths between two cells.
#[derive(Debug, Clone)]
pub struct Search {
    map: Map,
    engine: Engine,
}

/// How the map is searched.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// Jump points.
    Jump,
    /// A* on tiles by detours.
    Detour,
    /// Two floods that meet.
    Meet,
}

#[derive(Debug, Clone)]
enum Engine {
    Jump(Box<Jumps>),
    Detour(Detours),
    Meet(Floods),
}

impl Search {
    /// Prepares a map.
    pub fn new(map: &Map) -> Self {
        let method = Method::of(map);
        Self::by(map, method)
    }

    pub fn by(map: &Map, method: Method) -> Self {
        let engine = match method {
            Method::Jump => Engine::Jump(Box::new(Jumps::new(map, usize::MAX))),
            Method::Detour => Engine::Detour(Detours::new(map)),
            Method::Meet => Engine::Meet(Floods::new(map)),
        };
        Self { map: map.clone(), engine }
    }

    /// A shortest path, cell by cell, both ends included; `None` if there is none.
    pub fn path(&mut self, from: Cell, to: Cell) -> Result<Option<Vec<Cell>>, Error> {
        let Some(steps) = self.steps(from, to)? else { return Ok(None) };
        if from == to {
            return Ok(Some(vec![from]));
        }
        Ok(Some(match &self.engine {
            Engine::Jump(jumps) => jumps.path(from, to, steps),
            Engine::Detour(detours) => detours.path(from, to, steps),
            Engine::Meet(floods) => floods.path(from, to, steps),
        }))
    }

    /// The length of a shortest path; `None` if there is none.
    pub fn steps(&mut self, from: Cell, to: Cell) -> Result<Option<u32>, Error> {
        self.map.check_task(from, to)?;
        if from == to {
            return Ok(Some(0));
        }
        Ok(match &mut self.engine {
            Engine::Jump(jumps) => match jumps.run(from, to) {
                Ok(steps) => steps,
                Err(OutOfRoom) => panic!("room"),
            },
            Engine::Detour(detours) => {
                let empty = Lattice::Square.distance(from, to);
                detours.run(from, to).map(|detours| empty + 2 * detours)
            }
            Engine::Meet(floods) => floods.run(from, to),
        })
    }

    pub fn bytes(&self) -> usize {
        match &self.engine {
            Engine::Jump(jumps) => jumps.bytes(),
            Engine::Detour(detours) => detours.bytes(),
            Engine::Meet(floods) => floods.bytes(),
        }
    }
}

impl Method {
    fn of(map: &Map) -> Self {
        match map.lattice() {
            Lattice::Hex => Self::Meet,
            Lattice::Square => Self::Jump,
        }
    }
}
