//! Every multi-robot map and scenario of the data folder: a plan for all its robots, which the checker accepts.
//!
//! The folder is that of `crates/activecell-cli/tests/real_data.rs`; without it the tests are skipped.

use activecell::{Cell, Map, Team, check_plan};
use activecell_fleet::{Limits, Options, Outcome, solve};
use activecell_formats::movingai::{read_map, read_scen};
use std::path::{Path, PathBuf};

fn folder() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let data = std::env::var_os("ACTIVECELL_DATA").map_or(beside, PathBuf::from);
    let folder = data.join("mapf");
    if !folder.is_dir() {
        println!("SKIPPED: {} was not found; the tests on real data did not run", folder.display());
    }
    folder.is_dir().then_some(folder)
}

fn read(folder: &Path, map: &str, scen: &str) -> (Map, Vec<(Cell, Cell)>) {
    let bytes = |name: &str| std::fs::read(folder.join(name)).expect(name);
    let map = read_map(&bytes(map)).expect(map);
    let rows = read_scen(&bytes(scen)).expect(scen);
    (map, rows.into_iter().map(|row| (row.from, row.to)).collect())
}

/// The first plan for the first robots of a scenario, checked.
fn solved(map: &Map, tasks: &[(Cell, Cell)], what: &str) -> Outcome {
    let (starts, targets) = tasks.iter().copied().unzip();
    let team = Team::new(map, starts, targets).expect(what);
    let limits = Limits { time: None, steps: Some(200_000), first: true, ..Limits::default() };
    let outcome = solve(map, &team, &Options { seed: 0, threads: 2, limits }, |_| {}).expect(what);
    let plan = outcome.plan.as_ref().unwrap_or_else(|| panic!("{what}: {:?}", outcome.ending));
    assert_eq!(check_plan(map, &team, plan), Ok(()), "{what}");
    outcome
}

#[test]
fn every_scenario_is_solved_with_all_its_robots() {
    let Some(folder) = folder() else { return };
    let mut plans = 0;
    for folder in [folder.clone(), folder.join("puzzles")] {
        let mut names: Vec<String> = std::fs::read_dir(&folder)
            .expect("a folder")
            .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
            .filter(|name| Path::new(name).extension().is_some_and(|end| end == "scen"))
            .collect();
        names.sort();
        for scen in names.iter().filter(|name| !name.contains("10000agents")) {
            let map = scen.trim_end_matches("-random-1.scen").trim_end_matches("-even-1.scen");
            let (map, tasks) = read(&folder, &format!("{}.map", map.trim_end_matches(".scen")), scen);
            let outcome = solved(&map, &tasks, scen);
            println!("{scen}: {} robots, {} steps of search", tasks.len(), outcome.steps);
            plans += 1;
        }
    }
    println!("{plans} plans accepted");
    assert!(plans > 20);
}

/// 800 robots on 819 free cells.
#[test]
fn a_floor_with_hardly_a_free_cell_is_solved() {
    let Some(folder) = folder() else { return };
    let (map, tasks) = read(&folder, "random-32-32-20.map", "dense/random-32-32-20-random-1.scen");
    for robots in [500, 600, 700, 800] {
        let outcome = solved(&map, &tasks[..robots], "dense");
        println!("{robots} robots on {} cells: {} steps of search", map.free_cells(), outcome.steps);
    }
}

#[test]
fn ten_thousand_robots_fit_a_laptop() {
    let Some(folder) = folder() else { return };
    let scen = "warehouse-20-40-10-2-2-10000agents-1.scen";
    let (map, tasks) = read(&folder, "warehouse-20-40-10-2-2.map", scen);
    let outcome = solved(&map, &tasks, scen);
    assert_eq!((tasks.len(), outcome.lower_bound), (10_000, 1_788_251));
    assert!(outcome.bytes < 300_000_000, "{}", outcome.bytes);
}
