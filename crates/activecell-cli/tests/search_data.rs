//! Single paths on real maps: every scenario row against a plain breadth-first search.
//!
//! The folder is that of `ACTIVECELL_DATA`, else `shared/data` beside the project; where it is missing the test
//! says so and passes.

use activecell::{Cell, Map, Search, check_route};
use activecell_formats::files::{ReadOptions, read_map};
use activecell_formats::movingai::read_scen;
use std::path::{Path, PathBuf};

fn folder() -> Option<PathBuf> {
    let project = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let root = std::env::var_os("ACTIVECELL_DATA").map_or(project.join("../shared/data"), PathBuf::from);
    let folder = root.join("movingai");
    if folder.is_dir() {
        return Some(folder);
    }
    println!("SKIPPED: {} was not found; the test on real data did not run", folder.display());
    None
}

/// Steps from `from` to `to` by a plain queue over a padded array.
fn plain(blocked: &[bool], width: usize, from: Cell, to: Cell) -> Option<usize> {
    let index = |cell: Cell| (cell.y as usize + 1) * width + cell.x as usize + 1;
    let (from, to) = (index(from), index(to));
    let mut seen = blocked.to_vec();
    seen[from] = true;
    let mut queue = vec![(from, 0)];
    let mut head = 0;
    while let Some(&(cell, steps)) = queue.get(head) {
        if cell == to {
            return Some(steps);
        }
        head += 1;
        for other in [cell - width, cell + width, cell - 1, cell + 1] {
            if !std::mem::replace(&mut seen[other], true) {
                queue.push((other, steps + 1));
            }
        }
    }
    None
}

fn padded(map: &Map) -> (Vec<bool>, usize) {
    let width = map.width() as usize + 2;
    let mut blocked = vec![true; width * (map.height() as usize + 2)];
    for cell in map.free() {
        blocked[(cell.y as usize + 1) * width + cell.x as usize + 1] = false;
    }
    (blocked, width)
}

#[test]
fn every_scenario_row_has_a_path_as_short_as_a_plain_search_says() {
    let Some(folder) = folder() else { return };
    let mut scenarios: Vec<PathBuf> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    scenarios.retain(|path| path.extension().is_some_and(|ending| ending == "scen"));
    scenarios.sort();
    let mut rows = 0;
    for scen in &scenarios {
        let map = read_map(&scen.with_extension(""), &ReadOptions::default()).unwrap().0;
        let (blocked, width) = padded(&map);
        let mut search = Search::new(&map);
        for task in read_scen(&std::fs::read(scen).unwrap()).unwrap() {
            let place = format!("{} line {}", scen.display(), task.line);
            let path = search.path(task.from, task.to).unwrap();
            let truth = plain(&blocked, width, task.from, task.to);
            assert_eq!(path.as_ref().map(|path| path.len() - 1), truth, "{place}");
            if let Some(path) = path {
                assert_eq!(check_route(&map, &path, task.from, task.to), Ok(()), "{place}");
            }
            rows += 1;
        }
    }
    println!(
        "{} maps, {rows} scenario rows: none missing, none longer than a plain search says",
        scenarios.len()
    );
    assert!(rows > 0);
}
