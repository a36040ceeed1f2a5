//! The command `activecell`: reads its arguments, runs, and turns the outcome into an exit code.

mod args;
mod commands;
mod terminal;

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = args::Cli::parse();
    let terminal = terminal::Terminal::new(cli.quiet, cli.verbose);
    match commands::run(cli.command, &terminal) {
        Ok(commands::Done::Reached) => ExitCode::SUCCESS,
        Ok(commands::Done::NotReached) => ExitCode::from(3),
        Err(error) => {
            terminal::Terminal::error(&format!("{error:#}"));
            ExitCode::FAILURE
        }
    }
}
