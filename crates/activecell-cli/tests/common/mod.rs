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

/// What a command prints that ends with one of these exit codes.
pub(crate) fn json(folder: &Path, arguments: &str, codes: &[i32]) -> Value {
    let (code, stdout, stderr) = run(folder, arguments);
    assert!(codes.contains(&code), "{arguments}: {code}, {stderr}");
    serde_json::from_str(&stdout).unwrap()
}
