//! The navigator whose map lies in block RAM, clock by clock.

use activecell::rule::{Decision, Sector, decide, neighbourhood};
use activecell::{Cell, Dir, Map};

/// What the navigator shows in a clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Shown {
    /// The active cell.
    pub cell: Cell,
    /// The step to the next one.
    pub go: Option<Dir>,
    /// A task is under way.
    pub busy: bool,
    /// The robot is at the target.
    pub arrived: bool,
    /// All its neighbours are obstacles.
    pub enclosed: bool,
    /// It is in a cell where it was before.
    pub trapped: bool,
}

/// The navigator of [`windowed`](crate::verilog::windowed): after a task is loaded the window comes in the next clock, and
/// with each later one the robot makes a step.
///
/// ```
/// use activecell::{Cell, Lattice, Map};
/// use activecell_codegen::model::Windowed;
/// let map = Map::parse(Lattice::Square, "....")?;
/// let mut navigator = Windowed::new(&map);
/// navigator.clock(Some((Cell::new(0, 0), Cell::new(3, 0))));
/// let columns: Vec<i32> = (0..6).map(|_| {
///     let x = navigator.shown().cell.x;
///     navigator.clock(None);
///     x
/// }).collect();
/// assert_eq!(columns, [0, 0, 1, 2, 3, 3]);
/// assert!(navigator.shown().arrived);
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Windowed<'a> {
    map: &'a Map,
    cell: Cell,
    task: Option<Task>,
}

#[derive(Debug, Clone, Copy)]
struct Task {
    target: Cell,
    /// Whether the window about the active cell has been read.
    is_seen: bool,
    /// Cells visited, the start included.
    visited: u64,
    /// The next number of visited cells at which the cell is saved.
    mark: u64,
    saved: Option<Cell>,
}

impl<'a> Windowed<'a> {
    /// Just reset.
    pub fn new(map: &'a Map) -> Self {
        Self { map, cell: Cell::default(), task: None }
    }

    /// What is seen before the next clock edge.
    pub fn shown(&self) -> Shown {
        let idle = Shown { cell: self.cell, ..Shown::default() };
        let Some(task) = self.task else { return idle };
        let Some(sector) = self.sector(&task) else {
            return Shown { arrived: task.is_seen, busy: !task.is_seen, ..idle };
        };
        if !task.is_seen {
            return Shown { busy: true, ..idle };
        }
        let near = self.map.lattice().distance(self.cell, task.target) == 1;
        let decision = decide(self.map.lattice(), sector, near, neighbourhood(self.map, self.cell));
        let trapped = task.saved == Some(self.cell);
        match decision {
            Decision::Enclosed => Shown { enclosed: true, trapped, ..idle },
            Decision::Move(_) if trapped => Shown { trapped, ..idle },
            Decision::Move(dir) => Shown { go: Some(dir), busy: true, ..idle },
        }
    }

    /// A clock edge; with it a task may be loaded, from the one cell to the other, both free.
    pub fn clock(&mut self, load: Option<(Cell, Cell)>) {
        let go = self.shown().go;
        if let Some((start, target)) = load {
            self.cell = start;
            self.task = Some(Task { target, is_seen: false, visited: 1, mark: 1, saved: None });
        } else if let Some(task) = &mut self.task {
            task.is_seen = true;
            if let Some(dir) = go {
                if task.visited == task.mark {
                    task.mark *= 2;
                    task.saved = Some(self.cell);
                }
                task.visited += 1;
                self.cell = self.map.lattice().neighbour(self.cell, dir);
            }
        }
    }

    fn sector(&self, task: &Task) -> Option<Sector> {
        Sector::towards(self.map.lattice(), self.cell, task.target)
    }
}
