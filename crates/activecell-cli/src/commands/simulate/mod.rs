//! `activecell simulate`: a saved run, driven in a world with errors.

mod offline;
mod picture;
mod stage;
mod task;

use super::Done;
use crate::args::{ModeArg, SimulateArgs};
use crate::terminal::Terminal;

pub(crate) fn run(args: &SimulateArgs, terminal: &Terminal) -> anyhow::Result<Done> {
    picture::check(args)?;
    let stage = stage::set(args, terminal)?;
    match args.mode {
        ModeArg::Offline => offline::run(args, &stage, terminal),
        ModeArg::Task => task::run(args, &stage, terminal),
    }
}

/// A share for people.
fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}
