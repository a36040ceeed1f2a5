//! Moving up: how a robot comes on in a crowd in which nobody can get out of its way.
//!
//! A robot that makes way goes where *it* would like to go, and where cells are full that leads deeper into the crowd, seldom
//! to a free cell. But at the end of the window all robots rest for ever: the floor there is a sliding puzzle. So the
//! next cell is emptied by a row of robots that all move up by one at the same step, the last one into a free cell, or into
//! the cell that the first one leaves. A breadth-first search finds the shortest such row.
//!
//! Source: pushing a row of robots to the nearest free cell: R. Luna, K. Bekris, *Push and Swap: Fast Cooperative
//! Path-Finding with Completeness Guarantees*, 2011. Own: at the end of windows, all at one step, and around in a ring.

use super::{Crew, Scene};
use crate::floor::NONE;
use crate::lifelong::ground::{Ground, Place};

/// Cells looked at before the search for a free one is given up.
const CELLS: usize = 400;
/// So many of them take as long as one path.
const CELLS_A_PATH: usize = 16;

/// The cells seen in a search, and from where.
#[derive(Debug, Clone)]
pub(super) struct Row {
    from: Vec<u32>,
    queue: Vec<u32>,
}

impl Row {
    pub(super) fn new(ground: &Ground) -> Self {
        Self { from: vec![NONE; ground.spots()], queue: Vec::new() }
    }

    fn see(&mut self, spot: u32, from: u32) {
        if self.from[spot as usize] == NONE {
            self.from[spot as usize] = from;
            self.queue.push(spot);
        }
    }

    fn forget(&mut self) {
        for spot in self.queue.drain(..) {
            self.from[spot as usize] = NONE;
        }
    }

    pub(super) fn bytes(&self) -> usize {
        (self.from.capacity() + self.queue.capacity()) * size_of::<u32>()
    }
}

/// A robot that moves up, the direction, and the cell to which it comes.
#[derive(Debug, Clone, Copy)]
struct Shift {
    robot: usize,
    dir: u32,
    to: u32,
}

impl Crew {
    /// Brings the end of a robot's path nearer to its target, cell by cell as long as the window lasts, and says whether it
    /// did: whoever rests in the next cell moves up, and whoever rests where that one goes, and so on. Only those move
    /// that others may move.
    pub(in crate::lifelong) fn move_up(&mut self, scene: Scene<'_>, robot: usize) -> bool {
        let mut nearer = false;
        while self.move_up_once(scene, robot) {
            nearer = true;
        }
        nearer
    }

    fn move_up_once(&mut self, scene: Scene<'_>, robot: usize) -> bool {
        let arrives = |target: u32| self.path(robot).iter().any(|place| place.spot() == target);
        if scene.wants[robot].is_none_or(|want| arrives(want.target)) {
            return false;
        }
        self.work += 1;
        for dir in self.ways_on(scene, robot) {
            let row = self.find_row(scene.ground, self.end(robot).spot(), dir);
            self.work += (self.row.queue.len() / CELLS_A_PATH) as u64;
            self.row.forget();
            if let Some((row, step)) = row {
                self.shift(scene, &row, step);
                return true;
            }
        }
        false
    }

    /// The directions that lead a robot from the end of its path nearer to its target, the shortest way first.
    fn ways_on(&self, scene: Scene<'_>, robot: usize) -> Vec<u32> {
        let (ground, end) = (scene.ground, self.end(robot));
        let here = end.spot();
        let left = |spot: u32, dir: u32| scene.distance(robot, Place::new(spot, facing(ground, dir)));
        // Who cannot leave before the window ends is not asked: distances may be known only as far as that.
        let mut ways: Vec<(u32, u32)> = Ground::directions(ground.open(here))
            .filter(|&dir| self.leaves(ground, here, dir) < self.length - 1)
            .map(|dir| (left(ground.ahead(here, dir), dir), dir))
            .filter(|&(steps, dir)| steps < left(here, dir))
            .map(|(steps, dir)| (steps + turns(ground, end, dir) as u32, dir))
            .collect();
        ways.sort_unstable();
        ways.into_iter().map(|(_, dir)| dir).collect()
    }

    /// The shortest row of robots that can move up so that the one that rests in a cell goes on in a direction, and the
    /// step in which all move.
    fn find_row(&mut self, ground: &Ground, here: u32, dir: u32) -> Option<(Vec<Shift>, usize)> {
        let last = self.length - 1;
        let first = ground.ahead(here, dir);
        self.row.see(first, here);
        for next in 0..CELLS {
            let &spot = self.row.queue.get(next)?;
            if spot == here || self.window.owner(last, spot) == NONE {
                return Some(self.row_to(ground, here, spot));
            }
            if self.firm.owner(last, spot) != NONE {
                continue;
            }
            for dir in Ground::directions(ground.open(spot)) {
                let ahead = ground.ahead(spot, dir);
                let swaps = spot == first && ahead == here;
                if !swaps && self.leaves(ground, spot, dir) < last {
                    self.row.see(ahead, spot);
                }
            }
        }
        None
    }

    /// The row that ends in a cell, and the step in which all can move.
    fn row_to(&self, ground: &Ground, here: u32, end: u32) -> (Vec<Shift>, usize) {
        let last = self.length - 1;
        let is_taken = |&step: &usize| self.window.owner(step, end) != NONE;
        // Who is still in the last cell leaves it while the row moves up, or before.
        let mut step = if end == here { 0 } else { (0..last).rev().find(is_taken).unwrap_or(0) };
        let mut row = Vec::new();
        let mut to = end;
        loop {
            let from = self.row.from[to as usize];
            let dir = ground.direction(from, to);
            step = step.max(self.leaves(ground, from, dir));
            row.push(Shift { robot: self.window.owner(last, from) as usize, dir, to });
            if from == here {
                return (row, step);
            }
            to = from;
        }
    }

    /// Lets all of a row move up in the step after this one.
    fn shift(&mut self, scene: Scene<'_>, row: &[Shift], start: usize) {
        let ground = scene.ground;
        for shift in row {
            let path = &self.paths[shift.robot * self.length..][..self.length];
            self.window.release(ground, path);
        }
        for &Shift { robot, dir, to } in row {
            let since = self.rests_from(robot);
            let path = &mut self.paths[robot * self.length..][..self.length];
            for step in since + 1..path.len() {
                path[step] = if step > start {
                    Place::new(to, facing(ground, dir))
                } else {
                    turned_towards(ground, path[step - 1], dir)
                };
            }
            self.window.reserve(ground, path, robot as u32);
            self.costs[robot] = scene.cost(robot, self.path(robot));
        }
    }

    fn end(&self, robot: usize) -> Place {
        self.path(robot)[self.length - 1]
    }

    /// The step from which on a robot stays in its last cell.
    fn rests_from(&self, robot: usize) -> usize {
        let (path, end) = (self.path(robot), self.end(robot).spot());
        path.iter().rposition(|place| place.spot() != end).map_or(0, |step| step + 1)
    }

    /// The step in which whoever rests in a cell at the end of the window can leave it in a direction.
    fn leaves(&self, ground: &Ground, spot: u32, dir: u32) -> usize {
        let robot = self.window.owner(self.length - 1, spot) as usize;
        let since = self.rests_from(robot);
        since + turns(ground, self.path(robot)[since], dir)
    }
}

/// The heading of a robot that has gone in a direction.
const fn facing(ground: &Ground, dir: u32) -> u32 {
    if ground.headings() == 1 { 0 } else { dir }
}

/// The turns that a robot needs before it goes in a direction.
fn turns(ground: &Ground, place: Place, dir: u32) -> usize {
    if ground.headings() == 1 { 0 } else { ground.turns(place.heading(), 1 << dir).into() }
}

/// A step of turning towards a direction, or waiting.
fn turned_towards(ground: &Ground, place: Place, dir: u32) -> Place {
    let turned = [-1, 1].map(|by| Place::new(place.spot(), ground.turned(place.heading(), by)));
    let nearest = turned.into_iter().min_by_key(|&place| turns(ground, place, dir));
    nearest.filter(|_| turns(ground, place, dir) > 0).unwrap_or(place)
}
