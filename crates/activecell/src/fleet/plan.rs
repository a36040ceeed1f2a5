//! Where every robot is at every step.

use crate::error::Error;
use crate::lattice::Cell;

/// The cells of all robots at each step, from step 0, the start, on. After the last step they rest.
///
/// A plan may be wrong: [`check_plan`](crate::check_plan) tells. It takes 8 bytes a robot and step.
///
/// ```
/// use activecell::{Cell, Plan};
/// let (a, b, c) = (Cell::new(0, 0), Cell::new(1, 0), Cell::new(2, 0));
/// let plan = Plan::new(2, vec![a, b, b, c, b, c])?; // two robots, three times two cells
/// assert_eq!((plan.steps(), plan.at(1, 0), plan.at(9, 1)), (2, b, c));
/// assert_eq!((plan.sum_of_costs(), plan.makespan()), (2, 1)); // nobody moves in the last step
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Plan {
    robots: usize,
    cells: Vec<Cell>,
}

impl Plan {
    /// A plan from the cells of all robots at step 0, then at step 1 and so on.
    ///
    /// # Errors
    /// [`Error::PlanSize`] if the cells are not a whole number of steps, at least one.
    pub fn new(robots: usize, cells: Vec<Cell>) -> Result<Self, Error> {
        // Without robots there is nothing to count steps by: one step, the start.
        let whole = if robots == 0 {
            cells.is_empty()
        } else {
            !cells.is_empty() && cells.len().is_multiple_of(robots)
        };
        if whole { Ok(Self { robots, cells }) } else { Err(Error::PlanSize { robots, cells: cells.len() }) }
    }

    /// How many robots there are.
    pub const fn robots(&self) -> usize {
        self.robots
    }

    /// How many steps the plan has; 0 if all stay where they start.
    pub fn steps(&self) -> usize {
        self.cells.len().checked_div(self.robots).map_or(0, |rows| rows - 1)
    }

    /// Where a robot is after `step` steps; after the last, where it rests.
    ///
    /// # Panics
    /// If there is no such robot.
    #[inline]
    pub fn at(&self, step: usize, robot: usize) -> Cell {
        self.row(step)[robot]
    }

    /// Where all robots are after `step` steps; after the last, where they rest.
    pub fn row(&self, step: usize) -> &[Cell] {
        &self.cells[step.min(self.steps()) * self.robots..][..self.robots]
    }

    /// The cells of all robots at step 0, step 1 and so on.
    pub fn rows(&self) -> impl DoubleEndedIterator<Item = &[Cell]> {
        (0..=self.steps()).map(|step| self.row(step))
    }

    /// Each robot's cost: the steps until it comes to rest, where it is at the end, for good.
    pub fn costs(&self) -> Vec<usize> {
        let last = self.row(self.steps());
        let mut costs = vec![0; self.robots];
        for (step, row) in self.rows().enumerate() {
            for (cost, (cell, rest)) in costs.iter_mut().zip(row.iter().zip(last)) {
                if cell != rest {
                    *cost = step + 1;
                }
            }
        }
        costs
    }

    /// The sum of all robots' [`costs`](Self::costs).
    pub fn sum_of_costs(&self) -> u64 {
        self.costs().into_iter().map(|cost| cost as u64).sum()
    }

    /// The steps until the last robot comes to rest.
    pub fn makespan(&self) -> usize {
        self.costs().into_iter().max().unwrap_or(0)
    }

    /// The memory that the plan takes, in bytes.
    pub fn bytes(&self) -> usize {
        self.cells.capacity() * size_of::<Cell>()
    }
}
