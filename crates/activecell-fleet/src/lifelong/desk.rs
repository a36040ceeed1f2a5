//! Who gets which task, and what has been done of it.

use super::ground::Ground;
use activecell::{Event, News, Task};

/// Which of the open tasks a robot gets that has none.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Assignment {
    /// The next one of the list.
    #[default]
    InOrder,
    /// Of the next ones of the list, as many as are shown for each robot, the one whose first cell is nearest as the
    /// crow flies. The League of Robot Runners shows 1.5 tasks a robot.
    Nearest {
        /// Tasks shown a robot, at least one in all.
        shown: f64,
    },
}

/// Keeps the books.
#[derive(Debug, Clone)]
pub(super) struct Desk {
    pub(super) tasks: Vec<Task>,
    assignment: Assignment,
    /// Tasks released a step; all at once if not given.
    per_step: Option<f64>,
    /// Tasks shown, in the order of the list.
    shown: Vec<usize>,
    /// The first task that is not shown yet.
    next: usize,
    /// For each robot its task and the errand of it.
    jobs: Vec<Option<(usize, usize)>>,
    /// The step in which each robot got its task.
    since: Vec<usize>,
}

impl Desk {
    pub(super) fn new(
        tasks: Vec<Task>,
        robots: usize,
        assignment: Assignment,
        per_step: Option<f64>,
    ) -> Self {
        Self {
            tasks,
            assignment,
            per_step,
            shown: Vec::new(),
            next: 0,
            jobs: vec![None; robots],
            since: vec![0; robots],
        }
    }

    /// The step in which a robot got its task.
    pub(super) fn since(&self, robot: usize) -> usize {
        self.since[robot]
    }

    /// Whether all tasks are done.
    pub(super) fn is_done(&self) -> bool {
        self.next == self.tasks.len() && self.shown.is_empty() && self.jobs.iter().all(Option::is_none)
    }

    /// The cell of a robot's next errand, and of the one after.
    pub(super) fn errands(&self, ground: &Ground, robot: usize) -> Option<(u32, Option<u32>)> {
        let (task, errand) = self.jobs[robot]?;
        let errands = &self.tasks[task].errands;
        Some((ground.spot(errands[errand]), errands.get(errand + 1).map(|&cell| ground.spot(cell))))
    }

    /// Notes what all robots do after a step where they stand, and gives tasks to those that have none. Whose errand is
    /// another one afterwards is told.
    pub(super) fn look(
        &mut self,
        ground: &Ground,
        step: usize,
        spots: impl Iterator<Item = u32>,
        events: &mut Vec<Event>,
    ) -> Vec<usize> {
        let mut changed = Vec::new();
        for (robot, spot) in spots.enumerate() {
            let mut new = false;
            loop {
                let note = |task, news| Event { step, robot, task, news };
                let Some((task, errand)) = self.jobs[robot] else {
                    let Some(task) = self.draw(ground, step, spot) else { break };
                    (self.jobs[robot], self.since[robot], new) = (Some((task, 0)), step, true);
                    events.push(note(task, News::Assigned));
                    continue;
                };
                let errands = &self.tasks[task].errands;
                if ground.spot(errands[errand]) != spot {
                    break;
                }
                events.push(note(task, News::Done(errand)));
                self.jobs[robot] = (errand + 1 < errands.len()).then_some((task, errand + 1));
                new = true;
            }
            if new {
                changed.push(robot);
            }
        }
        changed
    }

    /// Takes an open task for a robot in a cell.
    fn draw(&mut self, ground: &Ground, step: usize, spot: u32) -> Option<usize> {
        let released = self.per_step.map_or(f64::INFINITY, |rate| (rate * (step + 1) as f64).floor());
        let released = if released >= self.tasks.len() as f64 { self.tasks.len() } else { released as usize };
        let most = match self.assignment {
            Assignment::InOrder => 1,
            Assignment::Nearest { shown } => (shown * self.jobs.len() as f64).ceil().max(1.0) as usize,
        };
        while self.shown.len() < most && self.next < released {
            self.shown.push(self.next);
            self.next += 1;
        }
        let here = ground.cell(spot);
        let far = |task: usize| ground.lattice.distance(here, self.tasks[task].errands[0]);
        let best = (0..self.shown.len()).min_by_key(|&at| far(self.shown[at]))?;
        Some(self.shown.remove(best))
    }
}
