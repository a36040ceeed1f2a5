//! The C firmware against the core: for every input, on maps, on emulated boards.

#![expect(clippy::unwrap_used, reason = "a test whose files or tools fail should stop")]

mod board;
#[path = "../common/mod.rs"]
mod common;
mod host;
mod misra;

use activecell::{BitPlane, Error, Lattice, Map, Robot};
use activecell_codegen::model::player::{self, Motion, Segment};
use activecell_codegen::{SourceFile, c, long_way};
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

/// The firmware of a map, for a way through it, in a folder of its own.
fn written(test: &str, map: &Map, segments: Option<&[Segment]>) -> PathBuf {
    let folder = common::folder(test);
    common::write(&folder, &firmware(map, segments).unwrap());
    folder
}

/// Cells and turns of it are no whole numbers of ticks.
fn robot() -> Robot {
    Robot { ticks_per_rev: 37.3, ..Robot::default() }
}

/// For the longest way; the program of that robot if no other is given.
fn firmware(map: &Map, segments: Option<&[Segment]>) -> Result<Vec<SourceFile>, Error> {
    let (from, to) = long_way(map)?;
    let route = map.wave(to)?.route(from);
    let robot = robot();
    let usual = player::segments(&route.program(&robot, map, None), &robot, map.lattice())?;
    c::firmware(map, &c::Program { route: &route, segments: segments.unwrap_or(&usual), robot: &robot })
}

/// The sources of the firmware in a folder, for a command.
fn sources(folder: &Path) -> Vec<String> {
    let files = std::fs::read_dir(folder.join("src")).unwrap().map(|file| file.unwrap().path());
    let files = files.filter(|file| file.extension().is_some_and(|ending| ending == "c"));
    let name = |file: PathBuf| format!("src/{}", file.file_name().unwrap().to_string_lossy());
    let mut names: Vec<String> = files.map(name).collect();
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

#[test]
fn what_cannot_be_firmware_is_refused_and_lines_are_short() {
    let map = warehouse(Lattice::Square);
    let run = |ticks| Segment { motion: Motion::Forward, ticks };
    let wide = Map::new(Lattice::Square, BitPlane::new(65_536, 1).unwrap());
    for (map, program, expected) in [
        (&wide, None, "the longer side of the map in cells is 65536"),
        (&map, Some(&[run(3), run(0)][..]), "ticks of a segment of the program is 0"),
    ] {
        let error = firmware(map, program).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
    for lattice in Lattice::ALL {
        for file in firmware(&warehouse(lattice), Some(&[run(3)])).unwrap() {
            for line in file.text.lines() {
                assert!(line.len() <= 110 && line.trim_end() == line, "{}: {line}", file.path);
            }
            assert!(!file.text.contains('@'), "{}: a place was not filled in", file.path);
            assert!(file.text.ends_with('\n') && !file.text.ends_with("\n\n"), "{}", file.path);
        }
    }
}
