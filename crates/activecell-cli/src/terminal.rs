//! What the user sees: results on stdout, notes, progress and errors on stderr.

use indicatif::{ProgressBar, ProgressStyle};
use std::io::{self, IsTerminal, Write};
use std::time::Duration;

/// How much to say, and to whom.
pub(crate) struct Terminal {
    quiet: bool,
    verbose: bool,
}

impl Terminal {
    pub(crate) fn new(quiet: bool, verbose: bool) -> Self {
        Self { quiet, verbose }
    }

    /// A result. A reader that has gone away (as `head` does) is no error.
    pub(crate) fn result(text: &str) -> anyhow::Result<()> {
        let mut stdout = io::stdout().lock();
        match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
            Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
                Err(anyhow::anyhow!("cannot write the result: {error}"))
            }
            _ => Ok(()),
        }
    }

    /// A note that the user should see unless they asked for silence.
    pub(crate) fn note(&self, text: &str) {
        if !self.quiet {
            Self::error(text);
        }
    }

    /// A note for those who asked for more.
    pub(crate) fn detail(&self, text: &str) {
        if self.verbose {
            Self::error(text);
        }
    }

    /// One line on stderr; if even that is closed there is nobody to tell.
    pub(crate) fn error(text: &str) {
        let _ = writeln!(io::stderr().lock(), "activecell: {text}");
    }

    /// A moving sign that something is being done; it goes away when dropped. Only on a terminal.
    pub(crate) fn working(&self, what: impl Into<String>) -> Working {
        let bar = if self.quiet { ProgressBar::hidden() } else { ProgressBar::new_spinner() };
        bar.set_message(what.into());
        bar.enable_steady_tick(Duration::from_millis(120));
        Working(bar)
    }

    /// A bar that counts to `length`. Only on a terminal.
    pub(crate) fn counting(&self, length: u64, what: impl Into<String>) -> Working {
        let bar = if self.quiet { ProgressBar::hidden() } else { ProgressBar::new(length) };
        if let Ok(style) = ProgressStyle::with_template("{msg} {wide_bar} {pos}/{len} {eta}") {
            bar.set_style(style);
        }
        bar.set_message(what.into());
        Working(bar)
    }

    /// Columns and rows of the terminal on stdout; `None` if it is none.
    pub(crate) fn size() -> Option<(usize, usize)> {
        if !io::stdout().is_terminal() {
            return None;
        }
        let (width, height) = terminal_size::terminal_size_of(io::stdout())?;
        Some((width.0.into(), height.0.into()))
    }

    /// The width that the environment asks for where stdout is no terminal.
    pub(crate) fn columns_wanted() -> Option<usize> {
        std::env::var("COLUMNS").ok()?.parse().ok().filter(|&columns| columns > 0)
    }

    /// Whether colours are wanted on stdout (<https://no-color.org>).
    pub(crate) fn colour() -> bool {
        let set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
        io::stdout().is_terminal()
            && !set("NO_COLOR")
            && std::env::var_os("TERM").is_none_or(|term| term != "dumb")
    }
}

/// Progress on the screen while it lives.
pub(crate) struct Working(ProgressBar);

impl Working {
    /// What is being done now.
    pub(crate) fn say(&self, what: impl Into<String>) {
        self.0.set_message(what.into());
    }

    /// One more is done.
    pub(crate) fn step(&self) {
        self.0.inc(1);
    }
}

impl Drop for Working {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
