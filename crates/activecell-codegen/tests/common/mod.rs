//! The tools that the proofs run: where they are, and a loud word where one is missing.

#![allow(dead_code, reason = "each test uses some of these")]

pub(crate) mod aig;
pub(crate) mod cxxrtl;
pub(crate) mod formal;

use activecell::{Cell, Map, Rule};
use activecell_codegen::SourceFile;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The folder of the workspace.
pub(crate) fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

/// The full path of a program: from the project's own environment (`make tools`), else from the system's.
pub(crate) fn program(name: &str) -> Option<PathBuf> {
    let own = root().join(".venv/bin");
    let own = [own.join(format!("yowasp-{name}")), own.join(name)];
    let path = std::env::var_os("PATH").unwrap_or_default();
    let system = std::env::split_paths(&path).map(|folder| folder.join(name));
    own.into_iter().chain(system.collect::<Vec<_>>()).find(|file| file.is_file())
}

/// The programs, or `None` after saying loudly that a test does not run, and how it would.
pub(crate) fn programs<const N: usize>(test: &str, names: [&str; N]) -> Option<[PathBuf; N]> {
    let found = names.map(program);
    let missing: Vec<&str> =
        names.into_iter().zip(&found).filter(|(_, file)| file.is_none()).map(|(name, _)| name).collect();
    if missing.is_empty() {
        return Some(found.map(Option::unwrap_or_default));
    }
    eprintln!(
        "NOT RUN: {test}: {} missing; `make tools` installs yosys and z3, `make deps` the others",
        missing.join(", ")
    );
    None
}

/// A fresh folder for a test, within the target folder. Programs are run in it with relative paths: those that are
/// compiled to WebAssembly see nothing else.
pub(crate) fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("the target folder can be written");
    folder
}

/// Writes generated files below a folder.
pub(crate) fn write(folder: &Path, files: &[SourceFile]) {
    for file in files {
        let path = folder.join(&file.path);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("the folder can be made");
        std::fs::write(path, &file.text).expect("the file can be written");
    }
}

/// A command to be run in a folder.
pub(crate) fn command(program: &Path, folder: &Path) -> Command {
    let mut command = Command::new(program);
    command.current_dir(folder).env("YOWASP_CACHE_DIR", root().join("target/yowasp"));
    command
}

/// Runs it and gives its output.
///
/// # Panics
/// If it cannot be run or fails, with what it said.
pub(crate) fn run(command: &mut Command) -> String {
    let Output { status, stdout, stderr } = command.output().expect("a program that was found can be run");
    let text = String::from_utf8_lossy(&stdout).into_owned();
    assert!(status.success(), "{command:?} failed:\n{text}{}", String::from_utf8_lossy(&stderr));
    text
}

/// What an example prints, a line a cell, must be the published rule's way, which arrives.
pub(crate) fn check_example(map: &Map, told: &str) {
    let cell = |line: &str| {
        let place = line.split(['(', ',', ')']).filter_map(|number| number.parse().ok()).collect::<Vec<_>>();
        Cell::new(place[0], place[1])
    };
    let cells: Vec<Cell> = told.lines().map(cell).collect();
    let way = map.route(Rule::Published, cells[0], cells[cells.len() - 1], 0).expect("its ends are free");
    assert_eq!(cells, way.cells());
    let steps = way.dirs().map(|dir| format!("step {}", map.lattice().dir_name(dir)));
    for (line, step) in told.lines().zip(steps.chain(["arrived".into()])) {
        assert!(line.ends_with(&format!(": {step}")), "{line}");
    }
}

/// Runs a script of yosys in a folder.
pub(crate) fn yosys(yosys: &Path, folder: &Path, script: &str) -> String {
    run(command(yosys, folder).args(["-q", "-p", script]))
}
