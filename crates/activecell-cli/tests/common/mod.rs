//! The command, run as a user runs it.

use serde_json::Value;
use std::path::Path;
use std::process::Command;

/// Exit code, stdout and stderr of the command, run in `folder`.
pub(crate) fn run(folder: &Path, arguments: &str) -> (i32, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_activecell"))
        .args(arguments.split_whitespace())
        .current_dir(folder)
        .output()
        .unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

/// What a command prints that is done, whether or not its target was reached.
pub(crate) fn json(folder: &Path, arguments: &str) -> Value {
    let (code, stdout, stderr) = run(folder, arguments);
    assert!(code == 0 || code == 3, "{arguments}: {stderr}");
    serde_json::from_str(&stdout).unwrap()
}
