//! Real files: every map, scenario and image of the folder `ACTIVECELL_DATA` (default `../shared/data`, seen from
//! the workspace). Where the folder is missing the tests say so and pass.
#![allow(clippy::unwrap_used)] // A test may panic.

use activecell::Map;
use activecell_formats::files::{MAX_MAP_BYTES, MapFormat, ReadOptions, read_bytes, read_map, write_map};
use activecell_formats::movingai::{Task, read_scen, write_scen};
use activecell_formats::ros::{Reading, Rules};
use std::fs;
use std::path::{Path, PathBuf};

fn data() -> Option<PathBuf> {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folder =
        workspace.join(std::env::var_os("ACTIVECELL_DATA").unwrap_or_else(|| "../shared/data".into()));
    if folder.is_dir() {
        return Some(folder);
    }
    println!("SKIPPED: {} not found; set ACTIVECELL_DATA to the folder of real maps", folder.display());
    None
}

/// All files below a folder with one of these endings, in order.
fn files(folder: &Path, endings: &[&str]) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        let Ok(entries) = fs::read_dir(&folder) else { continue };
        for path in entries.map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                folders.push(path);
            } else if endings.iter().any(|ending| path.extension().is_some_and(|found| found == *ending)) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

fn read(path: &Path) -> (Map, MapFormat) {
    read_map(path, &ReadOptions::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn assert_plausible(map: &Map, path: &Path) {
    let (cells, free) = (map.cells(), map.free_cells());
    assert!((3..=4096).contains(&map.width()) && (3..=4096).contains(&map.height()), "{}", path.display());
    assert!(free * 50 > cells, "{}: {free} of {cells} cells are free", path.display());
}

#[test]
fn benchmark_maps() {
    let Some(data) = data() else { return };
    let mut count = 0;
    for part in ["movingai", "mapf", "lifelong"] {
        for path in files(&data.join(part), &["map", "txt"]) {
            let (map, format) = read(&path);
            assert_eq!(format, MapFormat::MovingAi, "{}", path.display());
            assert_plausible(&map, &path);
            let again = activecell_formats::movingai::write_map(&map);
            assert_eq!(activecell_formats::movingai::read_map(again.as_bytes()).unwrap(), map);
            count += 1;
        }
    }
    println!("read {count} benchmark maps");
    assert!(count > 0);
}

/// The scenario's map: of the same name beside it, or in a folder above.
fn map_of(scen: &Path, task: &Task) -> PathBuf {
    let name = task.map.rsplit('/').next().unwrap();
    let folders = scen.ancestors().skip(1);
    let found = folders.map(|folder| folder.join(name)).find(|path| path.is_file());
    found.unwrap_or_else(|| panic!("{} names {}", scen.display(), task.map))
}

#[test]
fn scenarios() {
    let Some(data) = data() else { return };
    let (mut count, mut tasks_read, mut published) = (0, 0, 0);
    for path in [files(&data.join("movingai"), &["scen"]), files(&data.join("mapf"), &["scen"])].concat() {
        let tasks = read_scen(&read_bytes(&path, MAX_MAP_BYTES).unwrap())
            .unwrap_or_else(|error| panic!("{}", error.in_file(&path)));
        assert!(!tasks.is_empty(), "{}", path.display());
        let (map, _) = read(&map_of(&path, &tasks[0]));
        for task in &tasks {
            if (task.width, task.height) != (0, 0) {
                assert_eq!((task.width, task.height), (map.width(), map.height()), "{}", path.display());
            }
            map.check_task(task.from, task.to)
                .unwrap_or_else(|error| panic!("{} line {}: {error}", path.display(), task.line));
            // Eight directions: never shorter than the larger difference of coordinates.
            let (dx, dy) = (task.from.x.abs_diff(task.to.x), task.from.y.abs_diff(task.to.y));
            if task.expected > 0.0 {
                assert!(
                    task.expected + 0.01 >= f64::from(dx.max(dy)),
                    "{} line {}",
                    path.display(),
                    task.line
                );
                published += 1;
            }
        }
        let again = read_scen(write_scen(&tasks).as_bytes()).unwrap();
        assert_eq!(again.len(), tasks.len());
        assert!(again.iter().zip(&tasks).all(|(a, b)| *a == Task { line: a.line, ..b.clone() }));
        count += 1;
        tasks_read += tasks.len();
    }
    println!("read {count} scenarios: {tasks_read} tasks, {published} with a published length");
    assert!(count > 0);
}

#[test]
fn floors_of_real_robots() {
    let Some(data) = data() else { return };
    let folder = tempfile::tempdir().unwrap();
    let mut count = 0;
    for path in files(&data.join("ros"), &["yaml", "png", "pgm"]) {
        let (map, _) = read(&path);
        // Of SLAM maps a large part is unknown, and unknown is not free.
        assert_plausible(&map, &path);
        assert!((0.01..=0.5).contains(&map.frame().cell_m), "{}", path.display());
        for rules in [Rules::Humble, Rules::Jazzy] {
            let reading = Reading { rules, unknown_is_free: true, ..Reading::default() };
            let (open, _) = read_map(&path, &ReadOptions { reading, ..ReadOptions::default() }).unwrap();
            assert!(open.free_cells() >= map.free_cells() || rules == Rules::Humble, "{}", path.display());
        }
        let copy = folder.path().join("copy.yaml");
        write_map(&copy, &map).unwrap();
        assert_eq!(read(&copy).0, map, "{}", path.display());
        println!("{}: {} × {}, {} free", path.display(), map.width(), map.height(), map.free_cells());
        count += 1;
    }
    println!("read {count} floors");
    assert!(count > 0);
}
