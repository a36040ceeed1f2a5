//! The C firmware against the core: for every input, on maps, on emulated boards.

#![expect(clippy::unwrap_used, reason = "a test whose files or tools fail should stop")]

mod board;
#[path = "../common/mod.rs"]
mod common;
mod host;
mod misra;

use activecell::{BitPlane, Lattice, Map};
use activecell_codegen::c;
use activecell_codegen::model::player::Segment;
use std::path::{Path, PathBuf};

/// Warnings are errors, and there are many.
const STRICT: [&str; 16] = [
    "-std=c99",
    "-Wall",
    "-Wextra",
    "-Wpedantic",
    "-Wconversion",
    "-Wsign-conversion",
    "-Wshadow",
    "-Wcast-qual",
    "-Wstrict-prototypes",
    "-Wmissing-prototypes",
    "-Wundef",
    "-Wdouble-promotion",
    "-Wswitch-enum",
    "-Werror",
    "-Iinclude",
    "-Iexamples",
];

/// The firmware of a map in a folder of its own.
fn written(test: &str, map: &Map, program: Option<&[Segment]>) -> PathBuf {
    let folder = common::folder(test);
    for file in c::firmware(map, program).unwrap() {
        let path = folder.join(&file.path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, &file.text).unwrap();
    }
    folder
}

/// The sources of the firmware in a folder, for a command.
fn sources(folder: &Path) -> Vec<String> {
    let files = std::fs::read_dir(folder.join("src")).unwrap().map(|file| file.unwrap().file_name());
    let names = files.map(|name| format!("src/{}", name.to_string_lossy()));
    let mut names: Vec<String> = names.filter(|name| name.ends_with(".c")).collect();
    names.sort();
    names
}

/// A MovingAI map of the folder `ACTIVECELL_DATA`, else of `shared/data` beside the project; its lattice as given.
fn real_map(test: &str, lattice: Lattice, name: &str) -> Option<Map> {
    let data = std::env::var_os("ACTIVECELL_DATA");
    let data = data.map_or_else(|| common::root().join("../shared/data"), PathBuf::from);
    let file = data.join("movingai").join(name);
    let Ok(text) = std::fs::read_to_string(&file) else {
        eprintln!("SKIPPED: {test}: {} was not found", file.display());
        return None;
    };
    Some(movingai(lattice, &text))
}

/// Read without the checks that a stranger's file needs.
fn movingai(lattice: Lattice, text: &str) -> Map {
    let rows: Vec<&str> = text.lines().skip(4).collect();
    let mut plane = BitPlane::new(rows[0].len() as u64, rows.len() as u64).unwrap();
    for (y, row) in rows.iter().enumerate() {
        for (x, character) in row.chars().enumerate() {
            plane.set(x as u32, y as u32, !matches!(character, '.' | 'G' | 'S'));
        }
    }
    Map::new(lattice, plane)
}

/// The project's own floor.
fn warehouse(lattice: Lattice) -> Map {
    movingai(lattice, &std::fs::read_to_string(common::root().join("maps/warehouse.map")).unwrap())
}
