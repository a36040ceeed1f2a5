//! Real maps: every scenario row against a plain breadth-first search, every floor re-tiled and driven across.
//!
//! The folder is that of `ACTIVECELL_DATA`, else `shared/data` beside the project; where it is missing the tests
//! say so and pass. The project's own floor is always driven across.

#![expect(clippy::unwrap_used, reason = "a test that cannot read its maps should stop")]

use activecell::{Cell, Lattice, Map, Outcome, Rng, Rule, Search, Tiling, check_route};
use activecell_formats::files::{ReadOptions, read_map};
use activecell_formats::movingai::read_scen;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

fn project() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn data(folder: &str) -> Option<PathBuf> {
    let root = std::env::var_os("ACTIVECELL_DATA").map_or(project().join("../shared/data"), PathBuf::from);
    let folder = root.join(folder);
    if folder.is_dir() {
        return Some(folder);
    }
    println!("SKIPPED: {} was not found; the tests on real data did not run", folder.display());
    None
}

fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<PathBuf> = entries.filter(|path| path.to_string_lossy().ends_with(ending)).collect();
    files.sort();
    files
}

fn read(path: &Path) -> Map {
    read_map(path, &ReadOptions::default()).unwrap().0
}

/// Steps from `from` to `to` over a padded array of bytes: nothing of the core is used but the obstacles.
fn plain_breadth_first(blocked: &[bool], width: usize, from: Cell, to: Cell) -> Option<usize> {
    let index = |cell: Cell| (cell.y as usize + 1) * width + cell.x as usize + 1;
    let (from, to) = (index(from), index(to));
    let mut seen = blocked.to_vec();
    let mut rim = vec![from];
    seen[from] = true;
    for steps in 0.. {
        if rim.is_empty() {
            return None;
        }
        if rim.contains(&to) {
            return Some(steps);
        }
        let mut next = Vec::new();
        for cell in rim {
            for other in [cell - width, cell + width, cell - 1, cell + 1] {
                if !std::mem::replace(&mut seen[other], true) {
                    next.push(other);
                }
            }
        }
        rim = next;
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
fn every_scenario_row_is_routed_as_short_as_a_plain_search_says() {
    let Some(folder) = data("movingai") else { return };
    let scenarios = Mutex::new(files(&folder, ".scen"));
    let total = Mutex::new((0, 0));
    let work = || {
        while let Some(scen) = { scenarios.lock().unwrap().pop() } {
            let map = read(&scen.with_extension(""));
            let (blocked, width) = padded(&map);
            let mut search = Search::new(&map);
            let tasks = read_scen(&std::fs::read(&scen).unwrap()).unwrap();
            for task in &tasks {
                let route = map.route(Rule::Wave, task.from, task.to, 0).unwrap();
                let place = format!("{} line {}", scen.display(), task.line);
                let path = search.path(task.from, task.to).unwrap();
                let truth = plain_breadth_first(&blocked, width, task.from, task.to);
                match truth {
                    Some(steps) => {
                        assert_eq!((route.outcome(), route.steps()), (Outcome::Arrived, steps), "{place}");
                        assert_eq!(route.check(&map, task.from, task.to), Ok(()), "{place}");
                    }
                    None => assert_eq!(route.outcome(), Outcome::Unreachable, "{place}"),
                }
                assert_eq!(path.as_ref().map(|path| path.len() - 1), truth, "{place}");
                if let Some(path) = path {
                    assert_eq!(check_route(&map, &path, task.from, task.to), Ok(()), "{place}");
                }
            }
            let mut total = total.lock().unwrap();
            *total = (total.0 + 1, total.1 + tasks.len());
        }
    };
    std::thread::scope(|scope| {
        scope.spawn(work);
        scope.spawn(work);
    });
    let (maps, rows) = total.into_inner().unwrap();
    println!(
        "{maps} maps, {rows} scenario rows, by wave and by search: none missing, none longer than a plain search says"
    );
    assert!(rows > 0);
}

/// Steps to `target` from every cell, by a plain queue over neighbours: the naive twin on both lattices.
fn plain_field(map: &Map, target: Cell) -> Vec<Option<u32>> {
    let mut steps = vec![None; map.cells()];
    let mut queue = vec![target];
    steps[map.index(target).unwrap()] = Some(0);
    let mut head = 0;
    while let Some(&cell) = queue.get(head) {
        head += 1;
        let next = steps[map.index(cell).unwrap()].map(|steps| steps + 1);
        for dir in map.lattice().dirs() {
            let other = map.lattice().neighbour(cell, dir);
            if map.is_free(other) && steps[map.index(other).unwrap()].is_none() {
                steps[map.index(other).unwrap()] = next;
                queue.push(other);
            }
        }
    }
    steps
}

#[test]
fn fields_of_every_real_map_are_those_of_a_plain_queue() {
    let mut paths = vec![project().join("maps/office.yaml")];
    for (folder, endings) in [("movingai", [".map", ".none"]), ("ros", [".yaml", ".png"])] {
        let Some(folder) = data(folder) else { continue };
        paths.extend(endings.iter().flat_map(|ending| files(&folder, ending)));
    }
    let mut fields = 0;
    for path in &paths {
        let image = read(path);
        for lattice in Lattice::ALL {
            let map = image.clone().on(lattice);
            let free: Vec<Cell> = map.free().collect();
            let mut rng = Rng::new(free.len() as u64);
            for _ in 0..2 {
                let target = free[rng.below(free.len() as u32) as usize];
                let truth = plain_field(&map, target);
                let (field, compact) = (map.wave(target).unwrap(), map.compact_wave(&[target]).unwrap());
                let reached = map.reachable(&[target]).unwrap();
                for &cell in &free {
                    let place = format!("{} {lattice} {cell} to {target}", path.display());
                    let steps = truth[map.index(cell).unwrap()];
                    assert_eq!(field.steps(cell), steps, "{place}");
                    assert_eq!(reached.get(cell.x as u32, cell.y as u32), steps.is_some(), "{place}");
                    assert!(compact.nearer(cell).eq(field.nearer(cell)), "{place}");
                }
                fields += 1;
            }
        }
    }
    println!("{} real maps, {fields} fields on both lattices: as a plain queue has them", paths.len());
}

/// How near the robot's centre comes to something occupied on its way from `a` to `b`, looking no farther than
/// `reach_m`: points along the way, against the squares of the pixels, in the floor's metres.
fn nearest_m(image: &Map, a: [f64; 2], b: [f64; 2], reach_m: f64) -> f64 {
    let pixel_m = image.frame().cell_m;
    let mut nearest = f64::INFINITY;
    let points = 8;
    for i in 0..=points {
        let along = f64::from(i) / f64::from(points);
        let (x, y) = (a[0] + (b[0] - a[0]) * along, a[1] + (b[1] - a[1]) * along);
        let under = image.cell_at_m([x, y]);
        let span = (reach_m / pixel_m).ceil() as i32 + 1;
        for dy in -span..=span {
            for dx in -span..=span {
                let pixel = Cell::new(under.x + dx, under.y + dy);
                if !image.is_free(pixel) {
                    let [cx, cy] = image.centre_m(pixel);
                    let gap = |distance: f64| (distance.abs() - pixel_m / 2.0).max(0.0);
                    nearest = nearest.min(gap(x - cx).hypot(gap(y - cy)));
                }
            }
        }
    }
    nearest
}

/// Re-tiles a floor at two cell sizes on both lattices and drives a disc along random routes.
fn drive_across(path: &Path) -> usize {
    let image = read(path);
    let pixel_m = image.frame().cell_m;
    let mut driven = 0;
    for (cell_m, radius_m) in [(5.0 * pixel_m, 2.3 * pixel_m), (9.4 * pixel_m, 4.7 * pixel_m)] {
        for lattice in Lattice::ALL {
            let tiling = Tiling { lattice, cell_m, radius_m, tolerance: 1.0 };
            let tiled = image.retile(&tiling).unwrap();
            let free: Vec<Cell> = tiled.free().collect();
            if free.is_empty() {
                continue;
            }
            let mut rng = Rng::new(free.len() as u64);
            for _ in 0..6 {
                let mut pick = || free[rng.below(free.len() as u32) as usize];
                let route = tiled.route(Rule::Wave, pick(), pick(), 0).unwrap();
                for pair in route.cells().windows(2) {
                    let (a, b) = (tiled.centre_m(pair[0]), tiled.centre_m(pair[1]));
                    let nearest = nearest_m(&image, a, b, radius_m);
                    assert!(
                        nearest >= radius_m - 1e-6 * pixel_m - 1e-9,
                        "{} {tiling:?}: from {} to {} the robot touches a wall ({nearest} m)",
                        path.display(),
                        pair[0],
                        pair[1]
                    );
                    driven += 1;
                }
            }
        }
    }
    driven
}

#[test]
fn a_disc_driven_along_routes_touches_nothing() {
    let mut floors = vec![project().join("maps/office.yaml")];
    if let Some(folder) = data("ros") {
        floors.extend(files(&folder, ".yaml"));
        floors.extend(files(&folder, ".png").into_iter().filter(|png| !png.with_extension("yaml").exists()));
    }
    let mut driven = 0;
    for floor in &floors {
        let steps = drive_across(floor);
        assert!(steps > 0, "{}: no route", floor.display());
        driven += steps;
    }
    println!("{} floors, {driven} steps of a disc: nothing touched", floors.len());
}
