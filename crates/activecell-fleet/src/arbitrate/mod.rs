//! One step of all robots at once, settled between neighbouring cells.
//!
//! Each robot, the one with the highest priority first, reserves the cell that it likes best. Who stands there and has
//! not decided yet inherits the priority and must find another cell at once; if it finds none, the first tries its
//! next best cell. In corridors two robots that must change places are turned round (`swap.rs`).
//!
//! Source: K. Okumura, M. Machida, X. Défago, Y. Tamura, *Priority Inheritance with Backtracking for Iterative
//! Multi-Agent Path Finding*, Artificial Intelligence 310, 2022. The hindrance among equally good cells: K. Okumura,
//! H. Nagai, *Lightweight and Effective Preference Construction in PIBT*, `SoCS` 2025.

mod bodies;
mod choices;
mod swap;

use crate::fields::{Fields, Goal};
use crate::floor::{Floor, NONE};
use crate::room::Room;
use activecell::Rng;
use bodies::Pushed;
use choices::{Choices, Orders, STAY};
use std::cmp::Ordering;

/// Settles steps of all robots.
///
/// ```
/// use activecell::{Cell, Lattice, Map};
/// use activecell_fleet::{Arbiter, Fields, Floor, NONE};
/// let map = Map::parse(Lattice::Square, "...\n...")?;
/// let floor = Floor::new(&map);
/// let [west, east] = [0, 2].map(|x| floor.number(Cell::new(x, 0)));
/// let mut fields = Fields::new(&floor);
/// let goals = fields.goals(&floor, &[east, west], 1)?;
/// let mut arbiter = Arbiter::new(&floor, &fields, goals, 7);
/// let (mut now, mut next) = (vec![west, east], vec![NONE; 2]);
/// for _ in 0..10 {
///     assert!(arbiter.step(&now, &mut next, &[0, 1], &[]));
///     std::mem::swap(&mut now, &mut next);
/// }
/// assert_eq!(now, [east, west]);
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Arbiter<'a> {
    floor: &'a Floor,
    fields: &'a Fields,
    goals: Vec<Goal>,
    /// For each robot the cell that it should try first, or [`NONE`]; empty if no robot has one. This is how guidance
    /// steers: a cell that does not touch the robot's own is passed over.
    pub wishes: Vec<u32>,
    /// Whether a robot would rather not push one that is at its target, where another cell is as good. That costs less, but
    /// in a crowd it may go on for ever: the search changes it when it makes no headway.
    pub shy: bool,
    /// Set if the robots are bodies, or cells are closed (`bodies.rs`).
    room: Option<&'a Room>,
    time: u32,
    pushed: Pushed,
    cells: Vec<Standing>,
    stack: Vec<Asked>,
    orders: Orders,
    rng: Rng,
}

/// Who stands in a cell, and who will.
#[derive(Debug, Clone, Copy)]
struct Standing {
    now: u32,
    next: u32,
}

/// A robot that was asked to leave its cell, and what it may still try.
#[derive(Debug, Clone)]
struct Asked {
    robot: u32,
    choices: Choices,
    /// It has tried its first choice only.
    first: bool,
    /// The robot to pull after it, or [`NONE`].
    partner: u32,
}

impl<'a> Arbiter<'a> {
    /// An arbiter for robots with these goals. The same seed gives the same steps.
    pub fn new(floor: &'a Floor, fields: &'a Fields, goals: Vec<Goal>, seed: u64) -> Self {
        Self {
            floor,
            fields,
            goals,
            wishes: Vec::new(),
            shy: true,
            room: None,
            time: 0,
            pushed: Pushed::default(),
            cells: vec![Standing { now: NONE, next: NONE }; floor.numbers()],
            stack: Vec::new(),
            orders: Orders::new(),
            rng: Rng::new(seed),
        }
    }

    /// The floor.
    pub const fn floor(&self) -> &'a Floor {
        self.floor
    }

    /// The fields.
    pub const fn fields(&self) -> &'a Fields {
        self.fields
    }

    /// Where the robots want to go.
    pub fn goals(&self) -> &[Goal] {
        &self.goals
    }

    /// Chance, the same for the same seed.
    pub const fn rng(&mut self) -> &mut Rng {
        &mut self.rng
    }

    /// Fills `next` with where the robots in `now` go. Robots are settled in the `order` given, highest priority first;
    /// those of `fixed` go to the cell given with them, their own or one that it touches. False if no step was
    /// found; then `next` has no meaning. Without `fixed` robots a step is always found.
    ///
    /// # Panics
    /// If `now`, `next`, `order` and the goals are not equally many, or a number is none of the floor's.
    pub fn step(&mut self, now: &[u32], next: &mut [u32], order: &[u32], fixed: &[(u32, u32)]) -> bool {
        let robots = self.goals.len();
        assert!([now.len(), next.len(), order.len()] == [robots; 3], "one cell, goal and priority a robot");
        next.fill(NONE);
        for (robot, &cell) in now.iter().enumerate() {
            self.cells[cell as usize].now = robot as u32;
        }
        let settled = if let Some(room) = self.room {
            self.step_bodies(room, now, next, order, fixed)
        } else {
            fixed.iter().all(|&(robot, cell)| self.fix(robot, cell, now, next))
                && order.iter().all(|&robot| next[robot as usize] != NONE || self.settle(robot, now, next))
        };
        for (&now, &next) in now.iter().zip(next.iter()) {
            self.cells[now as usize].now = NONE;
            if next != NONE {
                self.cells[next as usize].next = NONE;
            }
        }
        settled
    }

    fn fix(&mut self, robot: u32, cell: u32, now: &[u32], next: &mut [u32]) -> bool {
        let Standing { now: other, next: taken } = self.cells[cell as usize];
        let here = now[robot as usize];
        if taken != NONE || other != NONE && other != robot && next[other as usize] == here {
            return false;
        }
        self.cells[cell as usize].next = robot;
        next[robot as usize] = cell;
        true
    }

    /// Settles one robot and all whom it pushes; false if it cannot even stay.
    fn settle(&mut self, robot: u32, now: &[u32], next: &mut [u32]) -> bool {
        let here = now[robot as usize];
        if here == self.goals[robot as usize].target
            && self.cells[here as usize].next == NONE
            && self.wishes.get(robot as usize).is_none_or(|&wish| wish == here || wish == NONE)
        {
            // At home, and nobody wants in.
            self.cells[here as usize].next = robot;
            next[robot as usize] = here;
            return true;
        }
        self.stack.clear();
        self.ask(robot, now, next);
        while let Some(asked) = self.stack.last_mut() {
            let robot = asked.robot;
            let here = now[robot as usize];
            let Some(slot) = asked.choices.next() else {
                // It stays, and who wanted in must look elsewhere.
                self.cells[here as usize].next = robot;
                next[robot as usize] = here;
                self.stack.pop();
                if let Some(asked) = self.stack.last_mut() {
                    asked.first = false;
                }
                continue;
            };
            let there = self.floor.beside(here, slot);
            let Standing { now: other, next: taken } = self.cells[there as usize];
            if taken != NONE || other != NONE && next[other as usize] == here {
                asked.first = false;
                continue;
            }
            self.cells[there as usize].next = robot;
            next[robot as usize] = there;
            if other == NONE || other == robot || next[other as usize] != NONE {
                self.pull(now, next);
                return true;
            }
            self.ask(other, now, next);
        }
        false
    }

    /// Puts a robot on the stack with its choices.
    fn ask(&mut self, robot: u32, now: &[u32], next: &[u32]) {
        let here = now[robot as usize];
        let mut choices = self.choices(robot, here);
        let wish = choices.first().map_or(here, |slot| self.floor.beside(here, slot));
        let partner = self.partner(robot, here, wish, next);
        if partner.is_some() {
            choices = choices.reversed();
        }
        self.stack.push(Asked { robot, choices, first: true, partner: partner.unwrap_or(NONE) });
    }

    /// All on the stack have found a cell: those that back out of a corridor pull their partner along.
    fn pull(&mut self, now: &[u32], next: &mut [u32]) {
        while let Some(asked) = self.stack.pop() {
            let here = now[asked.robot as usize];
            if asked.partner != NONE
                && asked.first
                && next[asked.partner as usize] == NONE
                && self.cells[here as usize].next == NONE
            {
                self.cells[here as usize].next = asked.partner;
                next[asked.partner as usize] = here;
            }
        }
    }

    /// The slots around `here`: nearer ones first, then staying, then farther ones.
    fn choices(&mut self, robot: u32, here: u32) -> Choices {
        let chance = self.rng.next_u64();
        let field = self.fields.field(self.goals[robot as usize].slot);
        let [nearer, level, farther] = field.split(here, self.floor.links(here));
        let level = level | 1 << STAY;
        let pushed = self.cells[here as usize].next != NONE;
        let [once, twice, home] =
            if nearer.count_ones() > 1 || pushed { self.hindered(here) } else { [0; 3] };
        let home = if self.shy { home } else { 0 };
        let parts = |class: u32| {
            let class = class & !home;
            [class & !once, class & once & !twice, class & twice]
        };
        let disturbing = |class: u32| [class & home, 0, 0];
        let last = disturbing(level | farther);
        let classes = [parts(nearer), disturbing(nearer), parts(level), parts(farther), last];
        let choices = self.orders.choose(chance, classes.into_iter().flatten());
        self.wished(self.floor.links(here), robot, here, choices)
    }

    /// The choices with the robot's wish first.
    #[inline]
    fn wished(&self, links: &[u32], robot: u32, here: u32, choices: Choices) -> Choices {
        let Some(&wish) = self.wishes.get(robot as usize) else { return choices };
        match links.iter().position(|&cell| cell == wish) {
            Some(slot) => choices.after(slot as u32),
            None if wish == here => choices.after(STAY),
            None => choices,
        }
    }

    /// The slots in which a robot that leaves `here` would be in the way of a neighbour that comes through `here`: of one
    /// at least, and of two at least; and those of robots that are at their targets.
    fn hindered(&self, here: u32) -> [u32; 3] {
        let links = self.floor.links(here);
        let [mut once, mut twice, mut home] = [0, 0, 0];
        for (slot, &from) in links.iter().enumerate() {
            let other = self.cells[from as usize].now;
            if other == NONE {
                continue;
            }
            let goal = self.goals[other as usize];
            if goal.target == from {
                home |= 1 << slot;
                continue;
            }
            let field = self.fields.field(goal.slot);
            if field.compare(from, here) == Ordering::Less {
                let [ways, ..] = field.split(here, links);
                (once, twice) = (once | ways, twice | once & ways);
            }
        }
        [once, twice, home]
    }
}
