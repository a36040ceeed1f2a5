//! What `fleet --json` and `check --json` print (of runs without end: [`lifelong`](crate::lifelong)). The names are a contract: keys are added, never changed.

use activecell::{Cell, Plan, PlanFault};
use serde::Serialize;

/// What planning for a group came to.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FleetReport {
    /// How many robots there are.
    pub robots: usize,
    /// Whether there is a plan.
    pub solved: bool,
    /// For each robot the steps until it rests at its target for good, together; null without a plan.
    pub sum_of_costs: Option<u64>,
    /// The steps until the last robot rests; null without a plan.
    pub makespan: Option<usize>,
    /// No plan has a lower sum of costs; 0 if some robot has no way at all.
    pub lower_bound: u64,
    /// When the first plan was there, in milliseconds after the start; null without a plan.
    pub first_solution_ms: Option<f64>,
    /// When the search ended, in milliseconds.
    pub elapsed_ms: f64,
    /// The most memory that the process had; where the system does not tell, what floor, fields, search and plans took.
    pub peak_bytes: u64,
    /// Every plan found, each better than the one before: milliseconds, sum of costs.
    pub history: Vec<(f64, u64)>,
    /// `exhausted`, `first_plan`, `time`, `steps` or `memory`. An exhausted search without a plan proves that there is none.
    pub ending: &'static str,
    /// `square` or `hex`.
    pub lattice: &'static str,
    /// The seed.
    pub seed: u64,
}

/// What a check of a plan found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CheckReport {
    /// Whether the plan keeps all rules.
    pub sound: bool,
    /// `square` or `hex`.
    pub lattice: &'static str,
    /// How many robots there are.
    pub robots: usize,
    /// How many steps the plan has.
    pub steps: usize,
    /// The steps until each robot rests, together.
    pub sum_of_costs: u64,
    /// The steps until the last robot rests.
    pub makespan: usize,
    /// Whether the file or a scenario said where the robots should end.
    pub targets_known: bool,
    /// The radius of the largest robot, in cells.
    pub largest_size: u32,
    /// The least distance between robots, in cells.
    pub distance: u32,
    /// How many cells were closed, each counted once for every time.
    pub keep_outs: usize,
    /// What is wrong first; null if nothing is.
    pub fault: Option<FaultReport>,
    /// Where the file states something else than what was found.
    pub disagreements: Vec<Disagreement>,
}

/// A number that a plan file states, and that is another.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Disagreement {
    /// `sum_of_costs` or `makespan`.
    pub what: &'static str,
    /// What the file states.
    pub stated: u64,
    /// What it is.
    pub found: u64,
}

impl CheckReport {
    /// The report of a plan, and of what its file states of it: sum of costs and makespan.
    pub fn new(
        plan: &Plan,
        lattice: activecell::Lattice,
        fault: Option<PlanFault>,
        stated: [Option<u64>; 2],
    ) -> Self {
        let (sum_of_costs, makespan) = (plan.sum_of_costs(), plan.makespan());
        // Some tools count the steps of the plan, in the last of which all may rest.
        let [stated_sum, stated_makespan] =
            [stated[0], stated[1].filter(|&stated| stated != plan.steps() as u64)];
        let compared =
            [("sum_of_costs", stated_sum, sum_of_costs), ("makespan", stated_makespan, makespan as u64)];
        let differs = compared.into_iter().filter_map(|(what, stated, found)| {
            stated.filter(|&stated| stated != found).map(|stated| Disagreement { what, stated, found })
        });
        Self {
            sound: fault.is_none(),
            lattice: lattice.name(),
            robots: plan.robots(),
            steps: plan.steps(),
            sum_of_costs,
            makespan,
            targets_known: true,
            largest_size: 0,
            distance: 1,
            keep_outs: 0,
            fault: fault.map(FaultReport::from),
            disagreements: differs.collect(),
        }
    }
}

/// What is wrong with a plan.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct FaultReport {
    /// `robots`, `wrong_start`, `outside`, `blocked`, `jump`, `collision`, `swap`, `no_room`,
    /// `too_close`, `closed` or `not_arrived`.
    pub kind: &'static str,
    /// The step in which the robots arrive; null if it is no step's fault.
    pub step: Option<usize>,
    /// The robots, counted from 0.
    pub robots: Vec<usize>,
    /// The cells, [x, y]: where it is; of a jump, whence and whither; of a swap, where each is after it; of two that
    /// are too close, where each is; of a body without room or in a closed cell, where it is and that cell; of a wrong start
    /// or end, where it is and where it should be.
    pub cells: Vec<[i32; 2]>,
    /// All of it in words.
    pub message: String,
}

impl From<PlanFault> for FaultReport {
    fn from(fault: PlanFault) -> Self {
        let (kind, robots, cells): (_, Vec<usize>, Vec<Cell>) = match fault {
            PlanFault::Robots { .. } => ("robots", vec![], vec![]),
            PlanFault::WrongStart { robot, cell, start } => ("wrong_start", vec![robot], vec![cell, start]),
            PlanFault::Outside { robot, cell, .. } => ("outside", vec![robot], vec![cell]),
            PlanFault::Blocked { robot, cell, .. } => ("blocked", vec![robot], vec![cell]),
            PlanFault::Jump { robot, from, to, .. } => ("jump", vec![robot], vec![from, to]),
            PlanFault::Collision { robots, cell, .. } => ("collision", robots.into(), vec![cell]),
            PlanFault::Swap { robots, cells, .. } => ("swap", robots.into(), cells.into()),
            PlanFault::NoRoom { robot, at, covers, .. } => ("no_room", vec![robot], vec![at, covers]),
            PlanFault::TooClose { robots, cells, .. } => ("too_close", robots.into(), cells.into()),
            PlanFault::Closed { robot, at, closed, .. } => ("closed", vec![robot], vec![at, closed]),
            PlanFault::NotArrived { robot, cell, target } => ("not_arrived", vec![robot], vec![cell, target]),
        };
        let cells = cells.into_iter().map(|cell| [cell.x, cell.y]).collect();
        Self { kind, step: fault.step(), robots, cells, message: fault.to_string() }
    }
}
