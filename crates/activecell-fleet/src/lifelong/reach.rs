//! The wave through the window: where one robot can be at each step among all others, and the best path there.
//!
//! As in [`Passage`](crate::Passage), the cells reached are planes of bits. Here a plane is 64 columns wide, cut out
//! around the robot, one word a row, and robots that turn have one for each heading.

use super::distances::View;
use super::ground::{Ground, Place};
use super::window::{Stride, Window};
use activecell::Cell;
use std::ops::Range;

/// Where a robot wants to go within the window.
#[derive(Debug, Clone, Copy)]
pub(super) struct Goal<'a> {
    /// The cell of its next errand.
    pub(super) target: u32,
    /// The distances to it.
    pub(super) view: View<'a>,
    /// The cell after that, if it is known, the distances to that, and how far the one is from the other.
    pub(super) next: Option<(View<'a>, u32)>,
}

/// Among whom a path is looked for, and the chance that decides between equally good ones.
#[derive(Debug, Clone, Copy)]
pub(super) struct Look<'a> {
    pub(super) ground: &'a Ground,
    pub(super) window: &'a Window,
    pub(super) chance: u64,
}

/// Which places a robot likes.
#[derive(Debug, Clone, Copy)]
enum Wish<'a> {
    /// Those near to its target.
    Distance(View<'a>),
    /// Those near to this cell, for a robot that has nothing else to do.
    Near(Cell),
}

impl Wish<'_> {
    #[inline]
    fn left(self, ground: &Ground, place: Place) -> u64 {
        match self {
            Self::Distance(view) => u64::from(view.at(ground, place.spot(), place.heading())),
            Self::Near(cell) => u64::from(ground.lattice.distance(ground.cell(place.spot()), cell)),
        }
    }
}

/// Rows that are kept zero around those in use: moves read a row beyond, twice.
const GUARD: usize = 2;

/// Finds paths in a window, and keeps its memory between them.
#[derive(Debug, Clone)]
pub(super) struct Reach {
    strides: Vec<Stride>,
    /// Whether robots turn: a plane a heading.
    turning: bool,
    rows: usize,
    headings: usize,
    steps: usize,
    /// The planes on the way to the target, and after it.
    before: Vec<u64>,
    after: Vec<u64>,
    scratch: Vec<u64>,
    start: Place,
    column: i32,
    /// The row of the map that is the first of the planes, guards included.
    top: i32,
}

impl Reach {
    pub(super) fn new(ground: &Ground, steps: usize) -> Self {
        let headings = ground.headings() as usize;
        let rows = 2 * steps + 1 + 2 * GUARD;
        let planes = vec![0; (steps + 1) * headings * rows];
        Self {
            strides: Stride::all(ground.lattice),
            turning: headings > 1,
            rows,
            headings,
            steps,
            before: planes.clone(),
            after: planes,
            scratch: Vec::new(),
            start: Place::default(),
            column: 0,
            top: 0,
        }
    }

    /// Writes the best path through the window for a robot, and says what it costs: the steps to its target; if it does not
    /// come so far, those of the window and the distance that is left. Without a goal it stays as near as it can, at no
    /// cost. `None` if it cannot be anywhere at some step. The robot itself must not be in the window.
    pub(super) fn find(
        &mut self,
        look: Look<'_>,
        start: Place,
        goal: Option<&Goal<'_>>,
        path: &mut [Place],
    ) -> Option<u32> {
        self.set_out(look, start);
        let spot = start.spot();
        let soonest = goal.map_or(usize::MAX, |goal| goal.view.at(look.ground, spot, start.heading()).into());
        for step in 0..self.steps {
            if !self.spread(look, step, false) {
                return None;
            }
            if let Some(goal) = goal.filter(|_| step + 1 >= soonest)
                && let Some(cost) = self.arrive(look, step + 1, goal, path)
            {
                return Some(cost);
            }
        }
        let wish = goal.map_or(Wish::Near(look.ground.cell(spot)), |goal| Wish::Distance(goal.view));
        let (end, left) = self.best(look, wish, false);
        self.trace(look, end, 0..self.steps, wish, path);
        Some(if goal.is_some() { self.steps as u32 + left } else { 0 })
    }

    fn set_out(&mut self, look: Look<'_>, start: Place) {
        let (x, y) = (look.ground.x(start.spot()), look.ground.y(start.spot()));
        self.start = start;
        self.column = look.window.first_column(x);
        self.top = y - (self.steps + GUARD) as i32;
        let row = GUARD + self.steps;
        for heading in 0..self.headings {
            let plane = &mut self.before[heading * self.rows..][row - GUARD..=row + GUARD];
            plane.fill(0);
            plane[GUARD] = u64::from(heading == start.heading() as usize) << (x - self.column);
        }
    }

    #[inline]
    const fn bit(&self, x: i32) -> u64 {
        1 << (x - self.column)
    }

    /// The rows of the map in use at a step.
    fn used(&self, ground: &Ground, step: usize) -> Range<usize> {
        let (y, step) = (ground.y(self.start.spot()), step as i32);
        (y - step).max(0) as usize..((y + step + 1) as usize).min(ground.height as usize)
    }

    #[inline]
    fn reached(&self, ground: &Ground, step: usize, place: Place, after: bool) -> bool {
        let planes = if after { &self.after } else { &self.before };
        let (x, y) = (ground.x(place.spot()), ground.y(place.spot()));
        let row = (y - self.top) as usize;
        let column = x - self.column;
        // The planes of a step are written where the robot can be by its distance alone.
        if y.abs_diff(ground.y(self.start.spot())) as usize > step || !(0..64).contains(&column) {
            return false;
        }
        planes[(step * self.headings + place.heading() as usize) * self.rows + row] >> column & 1 == 1
    }

    /// Spreads a step; false if nothing is reached.
    fn spread(&mut self, look: Look<'_>, step: usize, after: bool) -> bool {
        let Look { ground, window, .. } = look;
        let used = self.used(ground, step + 1);
        let Self { strides, rows, headings, before, after: later, scratch, column, top, turning, .. } = self;
        let planes = if after { later } else { before };
        let size = *headings * *rows;
        let (old, new) = planes[step * size..].split_at_mut(size);
        let first = (used.start as i32 - *top) as usize;
        let here = first..first + used.len();
        for heading in 0..*headings {
            let new = &mut new[heading * *rows..][..*rows];
            new[here.start - GUARD..here.start].fill(0);
            new[here.end..here.end + GUARD].fill(0);
            new[here.clone()].copy_from_slice(&old[heading * *rows..][here.clone()]);
            if *turning {
                for by in [-1, 1] {
                    let other = ground.turned(heading as u32, by) as usize;
                    let old = &old[other * *rows..][here.clone()];
                    new[here.clone()].iter_mut().zip(old).for_each(|(new, old)| *new |= old);
                }
            }
        }
        for (dir, stride) in strides.iter().enumerate() {
            let heading = if *turning { dir } else { 0 };
            let back = ground.turned_back(dir as u32) as usize;
            let against = window.cut(step, 1 + back, *column, used.clone(), scratch);
            let from = (here.start as i32 - stride.rows) as usize;
            let old = &old[heading * *rows..][from..from + used.len()];
            let new = &mut new[heading * *rows..][here.clone()];
            let parity = (used.start as i32 - stride.rows) as usize & 1;
            advance(old, against, stride, parity, new);
        }
        let free = window.cut(step + 1, 0, *column, used, scratch);
        let mut any = 0;
        for heading in 0..*headings {
            for (new, free) in new[heading * *rows..][here.clone()].iter_mut().zip(free) {
                *new &= free;
                any |= *new;
            }
        }
        any != 0
    }

    /// If the robot can be at its target at a step and somewhere until the end of the window, writes the path and says
    /// what it costs.
    fn arrive(&mut self, look: Look<'_>, step: usize, goal: &Goal<'_>, path: &mut [Place]) -> Option<u32> {
        let ground = look.ground;
        let target = |heading: usize| Place::new(goal.target, heading as u32);
        if !(0..self.headings).any(|heading| self.reached(ground, step, target(heading), false)) {
            return None;
        }
        let size = self.headings * self.rows;
        self.after[step * size..(step + 1) * size].fill(0);
        let row = (ground.y(goal.target) - self.top) as usize;
        for heading in 0..self.headings {
            if self.reached(ground, step, target(heading), false) {
                self.after[step * size + heading * self.rows + row] = self.bit(ground.x(goal.target));
            }
        }
        for later in step..self.steps {
            if !self.spread(look, later, true) {
                return None;
            }
        }
        let wish = goal.next.map_or(Wish::Near(ground.cell(goal.target)), |(view, _)| Wish::Distance(view));
        let (end, left) = self.best(look, wish, true);
        let at_target = self.trace(look, end, step..self.steps, wish, path);
        self.trace(look, at_target, 0..step, Wish::Distance(goal.view), path);
        Some(goal.next.map_or(step as u32, |(_, leg)| (self.steps as u32 + left).saturating_sub(leg)))
    }

    /// Of the places reached at the end of the window the one that is liked best, by chance among equals, and how far it
    /// is from there.
    fn best(&self, look: Look<'_>, wish: Wish<'_>, after: bool) -> (Place, u32) {
        let planes = if after { &self.after } else { &self.before };
        let mut best = (u64::MAX, self.start);
        for heading in 0..self.headings {
            let plane = &planes[(self.steps * self.headings + heading) * self.rows..][..self.rows];
            for y in self.used(look.ground, self.steps) {
                let mut word = plane[(y as i32 - self.top) as usize];
                while word != 0 {
                    let x = self.column + word.trailing_zeros() as i32;
                    word &= word - 1;
                    let place = Place::new(look.ground.spot(Cell::new(x, y as i32)), heading as u32);
                    let key = wish.left(look.ground, place) << 32 | draw(place, look.chance);
                    if key < best.0 {
                        best = (key, place);
                    }
                }
            }
        }
        (best.1, (best.0 >> 32) as u32)
    }

    /// Writes a path backwards from a place at the end of some steps to their start, and says where it is then. It goes
    /// early where it goes at all, so that less is left to chance.
    fn trace(
        &self,
        look: Look<'_>,
        end: Place,
        steps: Range<usize>,
        wish: Wish<'_>,
        path: &mut [Place],
    ) -> Place {
        let ground = look.ground;
        let after = steps.start > 0;
        path[steps.end] = end;
        let mut here = end;
        for step in steps.rev() {
            let mut best = (u64::MAX, here);
            let mut consider = |from: Place| {
                if self.reached(ground, step, from, after)
                    && !look.window.crosses(ground, step, from.spot(), here.spot())
                {
                    let key = wish.left(ground, from) << 32 | draw(from, look.chance ^ step as u64);
                    if key < best.0 {
                        best = (key, from);
                    }
                }
            };
            consider(here);
            ground.before(here, consider);
            here = best.1;
            path[step] = here;
        }
        here
    }

    /// The memory that it keeps, in bytes.
    pub(super) fn bytes(&self) -> usize {
        (self.before.capacity() + self.after.capacity() + self.scratch.capacity()) * size_of::<u64>()
    }
}

/// A number below 2³² that chance gives to a place.
#[inline]
fn draw(place: Place, chance: u64) -> u64 {
    (u64::from(place.raw()) ^ chance).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32
}

/// Adds to `new` the cells of `old` that go a step in a direction where nobody comes against them. The first row of
/// `old` has this parity.
#[inline]
fn advance(old: &[u64], against: &[u64], stride: &Stride, parity: usize, new: &mut [u64]) {
    let size = new.len();
    let (old, against) = (&old[..size], &against[..size]);
    let (left, right) = (stride.left, stride.right);
    if left[0] == left[1] && right[0] == right[1] {
        for i in 0..size {
            new[i] |= old[i] << left[0] >> right[0] & !against[i];
        }
    } else {
        for i in 0..size {
            let row = (parity + i) & 1;
            new[i] |= old[i] << left[row] >> right[row] & !against[i];
        }
    }
}
