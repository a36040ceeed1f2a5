//! `activecell fleet`: a plan for many robots at once, or a run with task after task.

mod lifelong;
mod once;
mod shared;

use super::Done;
use crate::args::FleetArgs;
use crate::terminal::Terminal;

pub(crate) fn run(args: &FleetArgs, terminal: &Terminal) -> anyhow::Result<Done> {
    if lifelong::is_asked(args)? { lifelong::run(args, terminal) } else { once::run(args, terminal) }
}
