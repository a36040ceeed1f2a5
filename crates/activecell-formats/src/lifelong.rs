//! What `fleet --json` prints of a run without end. The names are a contract: keys are added, never changed.

use serde::Serialize;

/// What a run came to in which robots get task after task.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LifelongReport {
    /// How many robots there are.
    pub robots: usize,
    /// `omni` or `turning`.
    pub motion: &'static str,
    /// `square` or `hex`.
    pub lattice: &'static str,
    /// The seed.
    pub seed: u64,
    /// Steps gone.
    pub steps: usize,
    /// Tasks whose last errand is done.
    pub tasks_finished: usize,
    /// Of these, how many a step.
    pub tasks_per_step: f64,
    /// How long planning a step took, in milliseconds.
    pub planning_ms: PlanningMs,
    /// How long the whole run took, in milliseconds.
    pub elapsed_ms: f64,
    /// The most memory that the process had; where the system does not tell, what the run took.
    pub peak_bytes: u64,
    /// `steps` if they are all gone, `tasks` if these are all done.
    pub ending: &'static str,
}

/// How long planning a step took, in milliseconds; 0 where there was no step.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct PlanningMs {
    /// Half of the steps took no longer.
    pub median: f64,
    /// 95 of 100 steps took no longer.
    pub p95: f64,
    /// The longest.
    pub max: f64,
}

impl PlanningMs {
    /// Of the times of all steps, in microseconds.
    ///
    /// ```
    /// use activecell_formats::lifelong::PlanningMs;
    /// let times_us: Vec<u64> = (1..=100).rev().map(|ms| 1000 * ms).collect();
    /// assert_eq!(PlanningMs::of(&times_us), PlanningMs { median: 50.0, p95: 95.0, max: 100.0 });
    /// assert_eq!(PlanningMs::of(&[]), PlanningMs::default());
    /// ```
    pub fn of(times_us: &[u64]) -> Self {
        let mut sorted = times_us.to_vec();
        sorted.sort_unstable();
        let within = |percent: usize| {
            let at = (sorted.len() * percent).div_ceil(100).saturating_sub(1);
            sorted.get(at).map_or(0.0, |&us| us as f64 / 1e3)
        };
        Self { median: within(50), p95: within(95), max: within(100) }
    }
}
