//! The rule that leads on from each cell, on a map that changes as it is seen.

use crate::error::Error;
use crate::lattice::{Cell, Dir, Lattice};
use crate::map::Map;
use crate::rule::{Levels, Rule};
use crate::sense::Change;
use crate::wave::LiveField;

/// A rule at work.
#[derive(Debug, Clone)]
pub(super) enum Guide {
    /// The field is repaired where the map changed.
    Wave(Box<LiveField>),
    /// `opened`: levels may be too high, so that they are no proof that there is no way.
    Learning { map: Box<Map>, levels: Levels, target: Cell, opened: bool },
}

impl Guide {
    pub(super) fn new(map: &Map, rule: Rule, target: Cell) -> Result<Self, Error> {
        map.check_target(target)?;
        match rule {
            Rule::Wave => Ok(Self::Wave(LiveField::new(map, target)?.into())),
            Rule::Learning => Ok(Self::Learning {
                map: map.clone().into(),
                levels: Levels::new(map, target),
                target,
                opened: false,
            }),
            Rule::Published => Err(Error::NoMemory),
        }
    }

    /// The map that it leads over.
    pub(super) const fn map(&self) -> &Map {
        match self {
            Self::Wave(field) => field.map(),
            Self::Learning { map, .. } => map,
        }
    }

    /// Closes and opens cells.
    pub(super) fn set(&mut self, changes: &[Change]) {
        match self {
            Self::Wave(field) => {
                field.set_all(changes);
            }
            Self::Learning { map, levels, opened, .. } => {
                for &(cell, closed) in changes {
                    if map.contains(cell) && map.is_free(cell) == closed {
                        map.set_obstacle(cell, closed);
                        levels.changed(map, cell);
                        *opened |= !closed;
                    }
                }
            }
        }
    }

    /// Where to go from a cell that is not the target, for a robot that faces along `facing`; `None` if no way leads
    /// to the target. Of equally short ways the one with the smallest turn; straight back counts as half a turn.
    pub(super) fn next(&mut self, cell: Cell, facing: Dir) -> Option<Dir> {
        match self {
            Self::Wave(field) => {
                let lattice = field.map().lattice();
                field.nearer(cell).min_by_key(|&dir| turn(lattice, facing, dir))
            }
            Self::Learning { map, levels, target, opened } => {
                if !map.is_free(*target) {
                    return None;
                }
                // A closed cell may have cut off what was seen but not visited; no way is longer than all cells.
                if levels.level(map, cell) as usize > map.free_cells() {
                    if !std::mem::take(opened) {
                        return None;
                    }
                    *levels = Levels::new(map, *target);
                }
                levels.step(map, cell)
            }
        }
    }
}

fn turn(lattice: Lattice, facing: Dir, dir: Dir) -> i32 {
    let turn_deg = lattice.turn_deg(facing, dir).abs();
    if turn_deg == 180 { 30 } else { turn_deg }
}
