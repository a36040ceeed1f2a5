//! The navigator whose map lies in block RAM, clock by clock.

use activecell::rule::{Decision, Sector, decide, neighbourhood};
use activecell::{Cell, Dir, Map};

/// How a task stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Status {
    /// There is none.
    #[default]
    Idle,
    /// It is under way.
    Busy,
    /// The robot is at the target.
    Arrived,
    /// All neighbours of the robot's cell are obstacles.
    Enclosed,
    /// The robot is in a cell where it was before, and would circle for ever.
    Trapped,
}

impl Status {
    /// The outputs `busy`, `arrived`, `enclosed` and `trapped`, the last in the lowest bit.
    pub const fn outputs(self) -> u8 {
        match self {
            Self::Idle => 0,
            Self::Busy => 0b1000,
            Self::Arrived => 0b0100,
            Self::Enclosed => 0b0010,
            Self::Trapped => 0b0001,
        }
    }
}

/// What the navigator is given with a clock's edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct WindowedInputs {
    /// The task is forgotten, and all else passed over.
    pub reset: bool,
    /// The step that is shown is made.
    pub enable: bool,
    /// A task begins: start and target.
    pub begin: Option<(Cell, Cell)>,
}

/// What the navigator shows in a clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Shown {
    /// The active cell.
    pub cell: Cell,
    /// The step to the next one.
    pub direction: Option<Dir>,
    /// How the task stands.
    pub status: Status,
}

/// The navigator of [`windowed`](crate::verilog::windowed): after a task has begun the window comes in the next clock, and
/// with each later one the robot makes a step, if enabled.
///
/// ```
/// use activecell::{Cell, Lattice, Map};
/// use activecell_codegen::model::{Status, Windowed, WindowedInputs};
/// let map = Map::parse(Lattice::Square, "....")?;
/// let mut navigator = Windowed::new(&map);
/// let begin = Some((Cell::new(0, 0), Cell::new(3, 0)));
/// navigator.clock(WindowedInputs { begin, ..WindowedInputs::default() });
/// let columns: Vec<i32> = (0..6).map(|_| {
///     let x = navigator.shown().cell.x;
///     navigator.clock(WindowedInputs { enable: true, ..WindowedInputs::default() });
///     x
/// }).collect();
/// assert_eq!(columns, [0, 0, 1, 2, 3, 3]);
/// assert_eq!(navigator.shown().status, Status::Arrived);
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
        let (status, direction) = self.task.map_or((Status::Idle, None), |task| self.decided(&task));
        Shown { cell: self.cell, direction, status }
    }

    fn decided(&self, task: &Task) -> (Status, Option<Dir>) {
        if !task.is_seen {
            return (Status::Busy, None);
        }
        let lattice = self.map.lattice();
        let Some(sector) = Sector::towards(lattice, self.cell, task.target) else {
            return (Status::Arrived, None);
        };
        if task.saved == Some(self.cell) {
            return (Status::Trapped, None);
        }
        let near = lattice.distance(self.cell, task.target) == 1;
        match decide(lattice, sector, near, neighbourhood(self.map, self.cell)) {
            Decision::Enclosed => (Status::Enclosed, None),
            Decision::Move(dir) => (Status::Busy, Some(dir)),
        }
    }

    /// A clock edge.
    pub fn clock(&mut self, inputs: WindowedInputs) {
        let direction = self.shown().direction.filter(|_| inputs.enable);
        if inputs.reset {
            (self.cell, self.task) = (Cell::default(), None);
        } else if let Some((start, target)) = inputs.begin {
            self.cell = start;
            self.task = Some(Task { target, is_seen: false, visited: 1, mark: 1, saved: None });
        } else if let Some(task) = &mut self.task {
            task.is_seen = true;
            if let Some(dir) = direction {
                if task.visited == task.mark {
                    task.mark *= 2;
                    task.saved = Some(self.cell);
                }
                task.visited += 1;
                self.cell = self.map.lattice().neighbour(self.cell, dir);
            }
        }
    }
}
