//! Cells that are closed for a time, because something that is no member of the team will be there.

use crate::error::Error;
use crate::lattice::Cell;
use crate::map::{Map, PointM};
use crate::predict::{Capsule, Slots, Track, likely};
use std::collections::BTreeSet;

/// A cell that no robot may cover from one step to another, both included.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct KeepOut {
    /// The cell.
    pub cell: Cell,
    /// The first step at which it is closed; step 0 is the start of the plan.
    pub from_step: u32,
    /// The last step at which it is closed.
    pub to_step: u32,
}

/// The closed cells of a plan.
///
/// ```
/// use activecell::{Cell, KeepOut, KeepOuts, Lattice, Map};
/// let map = Map::parse(Lattice::Hex, "...")?;
/// let keep_outs = KeepOuts::new(&map, vec![KeepOut { cell: Cell::new(1, 0), from_step: 2, to_step: 4 }])?;
/// assert!(keep_outs.is_closed(Cell::new(1, 0), 4) && !keep_outs.is_closed(Cell::new(1, 0), 5));
/// assert_eq!(keep_outs.last_step(), 4);
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct KeepOuts {
    /// Sorted; those of a cell neither overlap nor touch.
    all: Vec<KeepOut>,
    last_step: u32,
}

impl KeepOuts {
    /// The last step that may be closed. What is closed for longer belongs into the map.
    pub const LAST_STEP: u32 = 9_999;

    /// These closed cells, in any order.
    ///
    /// # Errors
    /// [`Error::OutsideMap`] for a cell; [`Error::BadValue`] if a last step lies before the first or beyond
    /// [`LAST_STEP`](Self::LAST_STEP).
    pub fn new(map: &Map, mut all: Vec<KeepOut>) -> Result<Self, Error> {
        for &KeepOut { cell, from_step, to_step } in &all {
            if !map.contains(cell) {
                return Err(Error::OutsideMap { cell, width: map.width(), height: map.height() });
            }
            if to_step < from_step || to_step > Self::LAST_STEP {
                let (name, value) = ("the last step of a closed cell", to_step.into());
                return Err(Error::BadValue { name, value, allowed: "from its first step to 9999" });
            }
        }
        all.sort_unstable();
        let mut merged: Vec<KeepOut> = Vec::with_capacity(all.len());
        for next in all {
            match merged.last_mut() {
                Some(last) if last.cell == next.cell && next.from_step <= last.to_step + 1 => {
                    last.to_step = last.to_step.max(next.to_step);
                }
                _ => merged.push(next),
            }
        }
        let last_step = merged.iter().map(|keep_out| keep_out.to_step).max().unwrap_or(0);
        Ok(Self { all: merged, last_step })
    }

    /// What moving objects close, as far as `slots` looks ahead: what they can reach in the certain slots, what they are
    /// likely to be in after those. Step s of the plan is at `start_s` + s × [`Slots::slot_s`].
    ///
    /// A robot that moves is always within half a cell of the centre that it leaves or of the one that it comes to. So
    /// a cell is closed, at both ends of a slot, if in that slot an object may come as near to its centre as
    /// [`Slots::robot_radius_m`] and half a cell: whoever keeps out of closed cells is not touched by anything that
    /// keeps to its bounds, in certain slots. For a robot that covers several cells the radius must be that of a cell:
    /// from its centre to its corners.
    ///
    /// # Errors
    /// As [`Slots::checked`].
    ///
    /// ```
    /// use activecell::predict::{Bounds, Slots, Track};
    /// use activecell::{Cell, KeepOuts, Lattice, Map};
    /// let map = Map::parse(Lattice::Square, ".....\n.....\n.....")?; // cells of 1 m
    /// let bounds = Bounds { radius_m: 0.2, max_speed_mps: 1.0, max_accel_mps2: 0.0, seen_within_m: 0.0 };
    /// let mut object = Track::new(bounds)?; // comes down the middle column, a cell a second
    /// object.observe(0.0, [2.5, 4.5])?;
    /// object.observe(1.0, [2.5, 3.5])?;
    /// let keep_outs = KeepOuts::foreseen(&map, Slots::default(), 1.0, &[object])?;
    /// assert!(keep_outs.is_closed(Cell::new(2, 0), 1) && !keep_outs.is_closed(Cell::new(2, 2), 1));
    /// assert!(keep_outs.is_closed(Cell::new(2, 2), 3) && !keep_outs.is_closed(Cell::new(0, 1), 3));
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn foreseen(map: &Map, slots: Slots, start_s: f64, tracks: &[Track]) -> Result<Self, Error> {
        let slots = slots.checked()?;
        let mut closed = BTreeSet::new();
        for slot in 0..u32::from(slots.certain) + u32::from(slots.likely) {
            let from_s = start_s + slots.slot_s * f64::from(slot);
            let to_s = from_s + slots.slot_s;
            for track in tracks {
                let certain = slot < u32::from(slots.certain);
                let mut reach = track.reach(from_s, to_s);
                reach.extend(likely(track, from_s, to_s, certain).filter(|_| !certain));
                let near = touched(map, &reach, slots.robot_radius_m + map.frame().cell_m / 2.0)?;
                closed.extend(near.into_iter().map(|cell| (cell, slot)));
            }
        }
        let keep_out = |(cell, slot)| KeepOut { cell, from_step: slot, to_step: slot + 1 };
        Self::new(map, closed.into_iter().map(keep_out).collect())
    }

    /// Whether a cell is closed at a step.
    pub fn is_closed(&self, cell: Cell, step: u32) -> bool {
        let after = self.all.partition_point(|keep_out| (keep_out.cell, keep_out.from_step) <= (cell, step));
        let before = after.checked_sub(1).map(|at| self.all[at]);
        before.is_some_and(|keep_out| keep_out.cell == cell && step <= keep_out.to_step)
    }

    /// The last step at which any cell is closed; 0 if there is none.
    pub const fn last_step(&self) -> u32 {
        self.last_step
    }

    /// All of them, by cells and steps; those of a cell neither overlap nor touch.
    pub fn all(&self) -> &[KeepOut] {
        &self.all
    }

    /// Whether nothing is closed.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }
}

/// The free cells whose centre an object that stays within all these capsules may come as near as `radius_m`. None if
/// there is no capsule: of an object that was never seen nothing is known.
fn touched(map: &Map, object: &[Capsule], radius_m: f64) -> Result<Vec<Cell>, Error> {
    let Some(least) = object.iter().min_by(|a, b| extent_m(a).total_cmp(&extent_m(b))) else {
        return Ok(Vec::new());
    };
    let wide_m = least.radius_m + radius_m + map.frame().cell_m;
    let sides: [[f64; 2]; 2] = std::array::from_fn(|k| {
        [least.from_m[k].min(least.to_m[k]) - wide_m, least.from_m[k].max(least.to_m[k]) + wide_m]
    });
    let corner = |x: usize, y: usize| -> PointM { [sides[0][x], sides[1][y]] };
    let mut cells = map.cells_touching_m(&[corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)])?;
    cells.retain(|&cell| {
        let at_m = map.centre_m(cell);
        let robot = Capsule { from_m: at_m, to_m: at_m, radius_m };
        map.is_free(cell) && object.iter().all(|capsule| capsule.gap_m(&robot) <= 1e-9)
    });
    Ok(cells)
}

fn extent_m(capsule: &Capsule) -> f64 {
    let [x, y] = std::array::from_fn(|k| capsule.to_m[k] - capsule.from_m[k]);
    capsule.radius_m + f64::hypot(x, y)
}
