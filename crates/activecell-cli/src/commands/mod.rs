//! The commands, one file or folder each.

mod calibrate;
mod certificate;
mod check;
mod control;
mod convert;
mod earlier;
mod embed;
mod fleet;
mod generate;
mod group;
mod info;
mod load;
mod outputs;
mod relief;
mod route;
mod scen;
mod simulate;
mod success;
mod table;
mod team;

use crate::args::{Cli, Command, TableKind};
use crate::terminal::Terminal;
use clap::CommandFactory;

/// How a command that did not fail has ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Done {
    /// Everything that was asked for.
    Reached,
    /// The work is done, but a target was not reached.
    NotReached,
}

/// Runs a command.
pub(crate) fn run(command: Command, terminal: &Terminal) -> anyhow::Result<Done> {
    match command {
        Command::Route(args) => return route::run(&args, terminal),
        Command::Simulate(args) => return simulate::run(&args, terminal),
        Command::Fleet(args) => return fleet::run(&args, terminal),
        Command::Check(args) => check::run(args, terminal)?,
        Command::Scen(args) => return scen::run(&args, terminal),
        Command::Info(args) => info::run(&args, terminal)?,
        Command::Convert(args) => convert::run(&args, terminal)?,
        Command::Embed(args) => embed::run(&args, terminal)?,
        Command::Generate(args) => generate::run(&args, terminal)?,
        Command::Calibrate(args) => calibrate::run(&args, terminal)?,
        Command::Table(args) => match args.table {
            TableKind::Rule { lattice, format } => Terminal::result(&table::rule(lattice.into(), format)?)?,
            TableKind::Control { format, picture } => control::run(format, picture.as_deref())?,
            TableKind::Success { size, pairs, seed, format } => {
                success::run(&success::Experiment { size, pairs, seed }, format, terminal)?;
            }
        },
        Command::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(shell, &mut Cli::command(), "activecell", &mut script);
            Terminal::result(&String::from_utf8_lossy(&script))?;
        }
    }
    Ok(Done::Reached)
}

/// `1 trial`, `2 trials`.
fn counted(count: u64, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}
