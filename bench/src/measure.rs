//! Timing: what a method is, how long it may take, and the records that the report reads.

use crate::cases::{Case, Digest};
use activecell::Cell;
use anyhow::{Result, bail};
use cpu_time::ThreadTime;
use serde_json::{Value, json};
use std::hint::black_box;
use std::io::Write;
use std::time::Instant;

/// Passes over the same tasks; the median of a task's times counts.
const PASSES: usize = 3;

/// A way to answer tasks. `find` alone is timed.
pub trait Paths {
    type Answer;
    fn find(&mut self, from: Cell, to: Cell) -> Self::Answer;
    /// The steps of an answer, and whether it is a way at all where that can be seen.
    fn steps(&self, from: Cell, to: Cell, answer: &Self::Answer) -> Result<Option<u32>>;
}

/// A way to compute a whole field. `field` alone is timed.
pub trait Fields {
    type Answer;
    fn field(&mut self, target: Cell) -> Self::Answer;
    /// Compares the answer with the plain queue's.
    fn check(&self, case: &Case, answer: &Self::Answer) -> Result<()>;
}

/// How long a method may be measured on one map.
#[derive(Debug, Clone, Copy)]
pub struct Budget {
    pub seconds: f64,
    /// The fewest tasks, whatever they take.
    pub least: usize,
}

impl Budget {
    /// From the environment, the same for all runners.
    pub fn from_environment() -> Self {
        let number = |name: &str, default: f64| {
            std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(default)
        };
        Self { seconds: number("BENCH_SECONDS", 2.0), least: number("BENCH_LEAST", 10.0) as usize }
    }
}

pub fn paths<M: Paths>(case: &Case, budget: Budget, method: &mut M) -> Result<Value> {
    let mut times: Vec<Vec<f64>> = Vec::new();
    let start = Instant::now();
    for pass in 0..PASSES {
        let tasks = if pass == 0 { case.tasks.len() } else { times.len() };
        for (i, task) in case.tasks.iter().enumerate().take(tasks) {
            let spent = start.elapsed().as_secs_f64() > budget.seconds;
            if spent && (pass > 0 || i >= budget.least) {
                break;
            }
            let (from, to) = Case::from_to(task);
            let clock = ThreadTime::now();
            let answer = black_box(method.find(black_box(from), black_box(to)));
            let us = clock.elapsed().as_secs_f64() * 1e6;
            let steps = method.steps(from, to, &answer)?;
            if steps != Some(task[4]) {
                bail!("from {from} to {to}: {steps:?} steps, the plain queue needs {}", task[4]);
            }
            if pass == 0 {
                times.push(Vec::new());
            }
            times[i].push(us);
        }
    }
    let us: Vec<f64> = times.iter_mut().map(|passes| median(passes)).collect();
    Ok(json!({ "us": us }))
}

pub fn fields<M: Fields>(case: &Case, budget: Budget, method: &mut M) -> Result<Value> {
    let mut ms = Vec::new();
    let start = Instant::now();
    let mut peak_kb = None;
    while ms.is_empty() || (ms.len() < 9 && start.elapsed().as_secs_f64() < budget.seconds / 2.0) {
        let clock = ThreadTime::now();
        let answer = black_box(method.field(black_box(case.target())));
        ms.push(clock.elapsed().as_secs_f64() * 1e3);
        if ms.len() == 1 {
            peak_kb = memory_kb("VmHWM:");
            method.check(case, &answer)?;
        }
    }
    Ok(json!({ "ms": median(&mut ms), "runs": ms.len(), "peak_kb": peak_kb }))
}

/// Compares a field, in row order, with the plain queue's.
pub fn same_field(case: &Case, steps: impl Iterator<Item = Option<u32>>) -> Result<()> {
    let digest = Digest::of(steps);
    if digest != case.field {
        bail!("the field is {digest:?}, the plain queue's is {:?}", case.field);
    }
    Ok(())
}

pub fn median(values: &mut [f64]) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    values[values.len() / 2]
}

/// A line of `/proc/self/status`: the peak (`VmHWM:`) or present (`VmRSS:`) memory; nothing but Linux has it.
pub fn memory_kb(line: &str) -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let rest = status.lines().find_map(|text| text.strip_prefix(line))?;
    rest.split_whitespace().next()?.parse().ok()
}

/// Runs one measurement and appends its record.
pub fn record(
    out: &mut impl Write,
    case: &Case,
    part: &str,
    method: &str,
    run: impl FnOnce() -> Result<(f64, Value)>,
) -> Result<()> {
    let before_kb = memory_kb("VmRSS:");
    let (setup_ms, mut value) = run().map_err(|error| error.context(format!("{method} on {}", case.name)))?;
    let fields = value.as_object_mut().expect("measurements are objects");
    fields.insert("case".into(), case.name.clone().into());
    fields.insert("part".into(), part.into());
    fields.insert("method".into(), method.into());
    fields.insert("clock".into(), "thread CPU time".into());
    fields.insert("setup_ms".into(), setup_ms.into());
    fields.insert("before_kb".into(), before_kb.into());
    if !fields.contains_key("peak_kb") {
        fields.insert("peak_kb".into(), memory_kb("VmHWM:").into());
    }
    writeln!(out, "{value}")?;
    Ok(out.flush()?)
}
