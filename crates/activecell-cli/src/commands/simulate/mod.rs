//! `activecell simulate`: a saved run, driven in a world with errors, or a plan, executed with delays.

mod offline;
mod picture;
mod plan;
mod stage;
mod task;

use super::{Done, outputs};
use crate::args::{ModeArg, SimulateArgs, WrongArgument};
use crate::terminal::Terminal;

pub(crate) fn run(args: &SimulateArgs, terminal: &Terminal) -> anyhow::Result<Done> {
    outputs::pictures(&args.picture)?;
    if let Some(file) = plan::read(args, terminal)? {
        return plan::run(args, &file, terminal);
    }
    if let Some(option) = args.delays.given() {
        let path = args.run.display();
        return Err(WrongArgument(format!("{option} is for plans; {path} is a run")).into());
    }
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
