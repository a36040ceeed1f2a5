//! The same step for bodies of several cells, robots that keep a distance, and cells that are closed for a time.
//!
//! A robot that wants a cell asks *all* who would then be too close and have not decided yet; each inherits its
//! priority and must find another cell at once. If one finds none, what the others decided on the way is undone and the
//! first tries its next best cell. A robot with nobody above it can always stay, unless its cell is about to close:
//! who is in such a cell comes first.
//!
//! Source: the priority inheritance with backtracking of Okumura et al., 2022; that it asks several at once, and undoes
//! what they did, is new.

use super::Arbiter;
use super::choices::{Choices, STAY};
use crate::floor::{Floor, NONE};
use crate::room::Room;

/// How many cells may be tried for one robot with nobody above it and all whom it pushes, beside one a robot. Undoing
/// could go on for ever; whoever runs out of tries stays.
const TRIES: usize = 200;

/// A robot that was asked to leave its cell.
#[derive(Debug, Clone)]
pub(super) struct Moving {
    robot: u32,
    choices: Choices,
    /// How many had decided before it, and how many were still to be asked.
    decided: usize,
    asked: usize,
    /// It has reserved a cell, and asks those who are in its way.
    reserved: bool,
}

/// What a step of bodies needs to remember.
#[derive(Debug, Clone, Default)]
pub(super) struct Pushed {
    moving: Vec<Moving>,
    /// Those who must still be asked, by whoever is on top of `moving`, then by those below.
    asked: Vec<u32>,
    /// Who decided, in that order.
    decided: Vec<u32>,
}

/// Who would be too close to a robot in a cell.
enum Near {
    /// One who has decided: the robot cannot go there.
    Decided,
    /// One who has not, and can be asked.
    Undecided(u32),
}

impl<'a> Arbiter<'a> {
    /// The same robots as bodies among closed cells.
    #[must_use]
    pub fn in_room(self, room: &'a Room) -> Self {
        Self { room: Some(room), ..self }
    }

    /// The floor that a robot moves on.
    #[inline]
    pub fn floor_of(&self, robot: u32) -> &'a Floor {
        self.room.map_or(self.floor, |room| room.floor(robot))
    }

    /// The step after this one, as long as it matters which step it is; always 0 where no cell is closed.
    #[inline]
    pub(crate) fn time_after(&self, time: u32) -> u32 {
        self.room.map_or(0, |room| room.after(time))
    }

    /// Whether robots that are at their targets may rest there for good.
    #[inline]
    pub(crate) fn may_rest(&self, time: u32) -> bool {
        self.room.is_none_or(|room| room.may_rest(time))
    }

    /// Which step is settled next, from 0, the first; it matters where cells are closed.
    pub(crate) const fn set_time(&mut self, time: u32) {
        self.time = time;
    }

    /// [`Arbiter::step`] for bodies. Who stands where is in `cells`, and is cleaned up by the caller.
    pub(super) fn step_bodies(
        &mut self,
        room: &'a Room,
        now: &[u32],
        next: &mut [u32],
        order: &[u32],
        fixed: &[(u32, u32)],
    ) -> bool {
        self.pushed.decided.clear();
        for &(robot, cell) in fixed {
            if self.is_taken(room, robot, cell, now, next) {
                return false;
            }
            self.reserve(robot, cell, next);
        }
        // Who cannot stay comes first.
        for &robot in order {
            let here = now[robot as usize];
            if next[robot as usize] == NONE
                && self.is_taken(room, robot, here, now, next)
                && !self.settle_body(room, robot, now, next)
            {
                return false;
            }
        }
        order.iter().all(|&robot| next[robot as usize] != NONE || self.settle_body(room, robot, now, next))
    }

    fn reserve(&mut self, robot: u32, cell: u32, next: &mut [u32]) {
        self.cells[cell as usize].next = robot;
        next[robot as usize] = cell;
        self.pushed.decided.push(robot);
    }

    /// Takes back what was decided after the first so many decisions.
    fn undo(&mut self, decided: usize, next: &mut [u32]) {
        for robot in self.pushed.decided.drain(decided..) {
            self.cells[next[robot as usize] as usize].next = NONE;
            next[robot as usize] = NONE;
        }
    }

    /// Settles one robot and all whom it pushes; false if it cannot even stay.
    fn settle_body(&mut self, room: &'a Room, robot: u32, now: &[u32], next: &mut [u32]) -> bool {
        let here = now[robot as usize];
        let at_home = here == self.goals[robot as usize].target && self.wishes.is_empty();
        if at_home && !self.is_taken(room, robot, here, now, next) {
            self.reserve(robot, here, next);
            return true;
        }
        let mut tries = TRIES + now.len();
        self.ask_body(room, robot, now, next);
        while let Some(top) = self.pushed.moving.last_mut() {
            if top.reserved {
                if self.pushed.asked.len() == top.asked {
                    self.pushed.moving.pop();
                } else if let Some(other) = self.pushed.asked.pop()
                    && next[other as usize] == NONE
                {
                    self.ask_body(room, other, now, next);
                }
                continue;
            }
            let (robot, decided, asked) = (top.robot, top.decided, top.asked);
            let here = now[robot as usize];
            let Some(slot) = top.choices.next().filter(|_| tries > 0) else {
                self.pushed.moving.pop();
                let Some(below) = self.pushed.moving.last_mut() else {
                    // Out of tries, whoever has nobody above it stays.
                    let stays = tries == 0 && !self.is_taken(room, robot, here, now, next);
                    if stays {
                        self.reserve(robot, here, next);
                    }
                    return stays;
                };
                below.reserved = false;
                let (decided, asked) = (below.decided, below.asked);
                self.pushed.asked.truncate(asked);
                self.undo(decided, next);
                continue;
            };
            tries -= 1;
            let there = room.floor(robot).beside(here, slot);
            debug_assert_eq!((decided, asked), (self.pushed.decided.len(), self.pushed.asked.len()));
            if self.is_taken(room, robot, there, now, next) {
                continue;
            }
            top_mut(&mut self.pushed.moving).reserved = true;
            let mut others = std::mem::take(&mut self.pushed.asked);
            self.near(room, robot, there, next, |near| {
                if let Near::Undecided(other) = near {
                    others.push(other);
                }
                true
            });
            self.pushed.asked = others;
            self.reserve(robot, there, next);
        }
        true
    }

    /// Puts a robot on the stack with its choices.
    fn ask_body(&mut self, room: &'a Room, robot: u32, now: &[u32], next: &[u32]) {
        let choices = self.body_choices(room, robot, now[robot as usize], next);
        let Pushed { moving, asked, decided } = &mut self.pushed;
        let (decided, asked) = (decided.len(), asked.len());
        moving.push(Moving { robot, choices, decided, asked, reserved: false });
    }

    /// The slots around `here`: nearer ones first, then staying, then farther ones; among them those first in which nobody
    /// must be asked. Robots at their targets are asked last, as in [`Arbiter::choices`].
    fn body_choices(&mut self, room: &'a Room, robot: u32, here: u32, next: &[u32]) -> Choices {
        let chance = self.rng.next_u64();
        let links = room.floor(robot).links(here);
        let [nearer, level, farther] = self.fields.field(self.goals[robot as usize].slot).split(here, links);
        let level = level | 1 << STAY;
        let [mut asking, mut home] = [0, 0];
        for (slot, &there) in links.iter().enumerate() {
            self.near(room, robot, there, next, |near| {
                if let Near::Undecided(other) = near {
                    asking |= 1 << slot;
                    let at = self.goals[other as usize].target;
                    home |= u32::from(self.shy && self.cells[at as usize].now == other) << slot;
                }
                true
            });
        }
        let parts = |class: u32| [class & !asking, class & asking & !home];
        let [quiet, pushing] = parts(nearer);
        let [level, level_pushing] = parts(level);
        let [far, far_pushing] = parts(farther);
        let classes =
            [quiet, pushing, nearer & home, level, level_pushing, far, far_pushing, (farther | level) & home];
        let choices = self.orders.choose(chance, classes);
        self.wished(links, robot, here, choices)
    }

    /// Whether a robot cannot go to a cell: it is closed at the end of this step, or someone who has decided is too close
    /// then, or swaps cells with it.
    fn is_taken(&self, room: &Room, robot: u32, cell: u32, now: &[u32], next: &[u32]) -> bool {
        let other = self.cells[cell as usize].now;
        if room.is_closed(robot, cell, self.time + 1)
            || other != NONE && other != robot && next[other as usize] == now[robot as usize]
        {
            return true;
        }
        !self.near(room, robot, cell, next, |near| matches!(near, Near::Undecided(_)))
    }

    /// Calls `see` for all who would be too close to a robot in a cell, until it says false; says whether it never did.
    fn near(
        &self,
        room: &Room,
        robot: u32,
        cell: u32,
        next: &[u32],
        mut see: impl FnMut(Near) -> bool,
    ) -> bool {
        let floor = self.floor;
        let (map, centre) = (floor.map(), floor.cell(cell));
        let lattice = map.lattice();
        let mut around = lattice.block(centre, room.reach(robot)).filter(|&cell| map.contains(cell));
        around.all(|at| {
            let standing = self.cells[floor.number(at) as usize];
            let close = |other: u32| {
                other != NONE
                    && other != robot
                    && lattice.block_distance(centre, at) < room.apart(robot, other)
            };
            let undecided = |other: u32| close(other) && next[other as usize] == NONE;
            (!close(standing.next) || see(Near::Decided))
                && (!undecided(standing.now) || see(Near::Undecided(standing.now)))
        })
    }
}

fn top_mut(moving: &mut [Moving]) -> &mut Moving {
    let last = moving.len() - 1;
    &mut moving[last]
}
