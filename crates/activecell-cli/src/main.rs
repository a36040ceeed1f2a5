//! The command `activecell`: reads its arguments, runs, and turns the outcome into an exit code.

mod args;
mod commands;
mod terminal;

use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = args::Cli::read();
    // Without a handler an interrupt only leaves a temporary file behind; that is no reason not to start.
    let _ = ctrlc::set_handler(|| {
        activecell_formats::files::abandon_writes();
        std::process::exit(130);
    });
    let terminal = terminal::Terminal::new(cli.quiet, cli.verbose);
    match commands::run(cli.command, &terminal) {
        Ok(commands::Done::Reached) => ExitCode::SUCCESS,
        Ok(commands::Done::NotReached) => ExitCode::from(3),
        Err(error) => {
            terminal::Terminal::error(&format!("{error:#}"));
            ExitCode::from(if error.is::<args::WrongArgument>() { 2 } else { 1 })
        }
    }
}
