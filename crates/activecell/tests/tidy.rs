//! Keeps the house in order: the core's layers, the paths that the documents name, the length of files.

#![expect(clippy::unwrap_used, reason = "a test that cannot read the project should stop")]

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// The core's modules; each may use those before it only.
const LAYERS: [&str; 17] = [
    "rng",
    "lattice",
    "error",
    "map",
    "rule",
    "wave",
    "search",
    "route",
    "embedded",
    "program",
    "control",
    "error_budget",
    "calibrate",
    "sense",
    "predict",
    "sim",
    "fleet",
];
const MAX_LINES: usize = 600;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap()
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Every file of the project with one of these endings.
fn files(endings: &[&str]) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![root()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            if path.is_dir() {
                if !name.starts_with('.') && !["target", "node_modules", "out"].contains(&name.as_str()) {
                    folders.push(path);
                }
            } else if endings.iter().any(|ending| name.ends_with(ending)) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// The code of a source file without its tests and comments.
fn code(text: &str) -> String {
    let text = text.split("#[cfg(test)]").next().unwrap_or_default();
    text.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n")
}

#[test]
fn the_core_keeps_its_layer_order() {
    let source = root().join("crates/activecell/src");
    let declared: BTreeSet<String> = read(&source.join("lib.rs"))
        .lines()
        .filter_map(|line| line.trim_start_matches("pub ").strip_prefix("mod "))
        .map(|name| name.trim_end_matches(';').to_owned())
        .collect();
    assert_eq!(declared, LAYERS.map(str::to_owned).into(), "lib.rs and the list of layers differ");

    let mut uses = 0;
    for file in files(&[".rs"]).iter().filter(|file| file.starts_with(&source)) {
        let inside = file.strip_prefix(&source).unwrap();
        let module = inside.components().next().unwrap().as_os_str().to_string_lossy().into_owned();
        let module = module.trim_end_matches(".rs");
        let Some(own) = LAYERS.iter().position(|layer| *layer == module) else { continue };
        for used in code(&read(file)).split("crate::").skip(1) {
            let used: String = used.chars().take_while(|c| c.is_ascii_alphanumeric() || *c == '_').collect();
            let layer = LAYERS.iter().position(|layer| *layer == used);
            let layer = layer.unwrap_or_else(|| panic!("{}: crate::{used} is no layer", inside.display()));
            assert!(layer <= own, "{}: {module} must not use {used}", inside.display());
            uses += 1;
        }
    }
    assert!(uses > 20, "the test found only {uses} uses: does it still read the code?");
}

#[test]
fn every_path_that_a_document_names_exists() {
    let mut named = 0;
    for document in ["ARCHITECTURE.md", "CONTRIBUTING.md", "README.md"] {
        let text = read(&root().join(document));
        // In backquotes or as the target of a link, with a slash or a known ending.
        let quoted = text.split('`').skip(1).step_by(2);
        let linked = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
        for name in quoted.chain(linked) {
            let top =
                ["crates/", "docs/", "maps/", ".ci/", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md"];
            if top.iter().any(|prefix| name.starts_with(prefix)) && !name.contains([' ', '*', '{']) {
                named += 1;
                let path = name.split('#').next().unwrap_or(name);
                assert!(root().join(path).exists(), "{document} names {name}, which does not exist");
            }
        }
    }
    assert!(named > 20, "only {named} paths found");
}

#[test]
fn files_fit_in_a_sitting() {
    let sources = files(&[".rs", ".py", ".ts", ".c", ".h", ".v", ".vhd"]);
    for file in &sources {
        let lines = read(file).lines().count();
        assert!(lines <= MAX_LINES, "{} has {lines} lines; at most {MAX_LINES}", file.display());
    }
    println!("{} source files, none above {MAX_LINES} lines", sources.len());
}

#[test]
fn the_core_has_no_dependencies_and_does_no_io() {
    let manifest = read(&root().join("crates/activecell/Cargo.toml"));
    let dependencies = manifest.split("[dependencies]").nth(1).unwrap().split('[').next().unwrap();
    assert_eq!(dependencies.trim(), "");
    let source = root().join("crates/activecell/src");
    for file in files(&[".rs"]).iter().filter(|file| file.starts_with(&source)) {
        let code = code(&read(file));
        for banned in ["std::fs", "std::io", "std::net", "std::env", "std::time", "println!", "unsafe "] {
            assert!(!code.contains(banned), "{}: the core must not use {banned}", file.display());
        }
    }
}
