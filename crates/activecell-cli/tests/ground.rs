//! Uneven ground as a user meets it: small grounds made here, and the real ones of `ACTIVECELL_DATA`.

#![expect(clippy::unwrap_used, reason = "a test that cannot start the command should stop")]

mod common;

use activecell::{Lattice, Map, Robot, Slopes, check_slopes, check_terrain_route};
use activecell_formats::elevation::HeightOptions;
use activecell_formats::files;
use common::run;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

fn json(folder: &Path, arguments: &str) -> Value {
    common::json(folder, arguments, &[0])
}

/// A grid of text whose heights are those of a formula.
fn grid(folder: &Path, name: &str, size: [u32; 2], cell: f64, height: impl Fn(u32, u32) -> f64) {
    let mut text =
        format!("ncols {}\nnrows {}\nxllcorner 0\nyllcorner 0\ncellsize {cell}\n", size[0], size[1]);
    for row in 0..size[1] {
        let heights: Vec<String> = (0..size[0]).map(|column| height(column, row).to_string()).collect();
        text += &(heights.join(" ") + "\n");
    }
    fs::write(folder.join(name), text).unwrap();
}

#[test]
fn ten_metres_on_a_ramp_of_ten_degrees() {
    let folder = tempfile::tempdir().unwrap();
    let tan = 10f64.to_radians().tan();
    grid(folder.path(), "ramp.asc", [12, 3], 1.0, |column, _| f64::from(column) * tan);
    fs::write(folder.path().join("flat.txt"), "............\n............\n............\n").unwrap();
    fs::write(folder.path().join("robot.toml"), "wheel_perimeter_m = 1\n").unwrap();
    for lattice in ["square", "hex"] {
        for ground in ["segments", "surface"] {
            let task = format!("flat.txt --lattice {lattice} --from 0,1 --to 10,1 --robot robot.toml --json");
            let flat = json(folder.path(), &format!("route {task}"));
            assert_eq!(flat["revolutions"], 10.0);
            assert!(flat["ground_m"].is_null());
            let report = json(folder.path(), &format!("route {task} --elevation ramp.asc --ground {ground}"));
            let number = |key: &str| report[key].as_f64().unwrap();
            assert!((number("revolutions") - 10.0 / 10f64.to_radians().cos()).abs() < 1e-5);
            assert!((number("climb_m") - 10.0 * tan).abs() < 1e-5);
            assert!((number("steepest_deg") - 10.0).abs() < 1e-4);
            assert_eq!((report["length_m"].as_f64(), report["ground"].as_str()), (Some(10.0), Some(ground)));
            assert!(number("energy_j") > flat["energy_j"].as_f64().unwrap() + 3.0 * 9.8 * 10.0 * tan / 0.6);
        }
    }
}

#[test]
fn walls_are_gone_round_and_only_steep_ones_are_walls() {
    let folder = tempfile::tempdir().unwrap();
    let wall = |height: f64| move |column: u32, row: u32| if column == 10 && row < 15 { height } else { 0.0 };
    grid(folder.path(), "wall.asc", [21, 21], 0.5, wall(0.5));
    grid(folder.path(), "sill.asc", [21, 21], 0.5, wall(0.05));
    for (lattice, cell) in [("square", ""), ("hex", ""), ("square", "--cell 1 "), ("hex", "--cell 1.3 ")] {
        let task = format!("--lattice {lattice} {cell}--from 1m,9m --to 9m,9m --json");
        let steps =
            |name: &str| json(folder.path(), &format!("route {name} {task}"))["length_m"].as_f64().unwrap();
        assert!(steps("wall.asc") > steps("sill.asc") + 7.0, "{task}");
        assert!(steps("sill.asc") < 10.0, "{task}");
    }
    // A picture of each kind, and a run file that keeps the ground.
    let pictures = "--picture a.svg --picture a.png --picture a.gif --save run.json";
    json(folder.path(), &format!("route wall.asc --from 0,0 --to 20,0 --json {pictures}"));
    assert!(fs::read_to_string(folder.path().join("a.svg")).unwrap().contains("ground 0.0 to 0.5 m"));
    let saved: Value = serde_json::from_slice(&fs::read(folder.path().join("run.json")).unwrap()).unwrap();
    assert_eq!(saved["map"]["elevation"]["heights_m"].as_array().unwrap().len(), 441);
}

#[test]
fn what_cannot_be_is_told_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    grid(folder.path(), "far.asc", [4, 4], 1.0, |_, _| 0.0);
    let text =
        fs::read_to_string(folder.path().join("far.asc")).unwrap().replace("xllcorner 0", "xllcorner 500");
    fs::write(folder.path().join("far.asc"), text).unwrap();
    grid(folder.path(), "cliff.asc", [6, 1], 1.0, |column, _| if column < 3 { 0.0 } else { 5.0 });
    fs::write(folder.path().join("floor.txt"), "......\n").unwrap();
    fs::write(folder.path().join("x.dem"), "......\n").unwrap();
    let task = "--from 0,0 --to 5,0";
    for (arguments, code, expected) in [
        (format!("route cliff.asc {task}"), 3, ""),
        (format!("route cliff.asc {task} --rule learning"), 2, "--rule learning does not look at slopes"),
        (format!("route cliff.asc {task} --clearance 1"), 2, "--clearance does not look at slopes"),
        (format!("route cliff.asc {task} --nearest"), 2, "--nearest does not look at slopes"),
        (format!("route cliff.asc {task} --elevation cliff.asc"), 2, "cliff.asc holds heights already"),
        (format!("route cliff.asc {task} --resolution 3"), 1, "states the distance of its posts itself"),
        (format!("route floor.txt {task} --elevation far.asc"), 1, "no free cell lies on this ground"),
        (format!("route floor.txt {task} --elevation x.dem"), 1, "the ending names no elevation"),
        (format!("route floor.txt {task} --elevation none.asc"), 1, "there is no such file"),
        (format!("route floor.txt {task} --height-scale x"), 2, "give a number"),
        ("convert cliff.asc out.asc".to_owned(), 1, "the ending names no map format"),
    ] {
        let (found, _, stderr) = run(folder.path(), &arguments);
        assert_eq!(found, code, "{arguments}: {stderr}");
        assert!(stderr.contains(expected), "{arguments}: {stderr}");
    }
}

fn data() -> Option<PathBuf> {
    let project = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let root = std::env::var_os("ACTIVECELL_DATA").map_or(project.join("../shared/data"), PathBuf::from);
    let folder = root.join("elevation");
    if folder.is_dir() {
        return Some(folder);
    }
    println!("SKIPPED: {} was not found; the tests on real ground did not run", folder.display());
    None
}

#[test]
fn real_ground_is_crossed_within_the_limits() {
    let Some(folder) = data() else { return };
    for (name, size, range, slope_deg, cell_m) in [
        ("landlab_SRTMGL3_colorado.asc", [240, 144], [1943.0, 3286.0], 25.0, 71.0),
        ("pysheds_dem.tif", [367, 359], [147.0, 298.0], 5.0, 78.1),
        ("jacksboro_fault_dem.npz", [403, 344], [236.0, 1076.0], 30.0, 27.0),
    ] {
        let options =
            HeightOptions { apart_m: name.ends_with("npz").then_some(27.0), ..HeightOptions::default() };
        let elevation = files::read_elevation(&folder.join(name), &options).unwrap().elevation;
        assert_eq!([elevation.columns(), elevation.rows()], size);
        assert_eq!(elevation.range_m(), Some(range));
        let slopes = Slopes {
            up_max_deg: slope_deg,
            down_max_deg: slope_deg,
            across_max_deg: slope_deg,
            climb_cost_m_per_m: 3.0,
        };
        let robot = Robot { slopes, ..Robot::default() };
        for lattice in Lattice::ALL {
            let map = Map::over(elevation.clone(), lattice, cell_m, activecell::Ground::Surface).unwrap();
            let terrain = map.terrain_for(&robot).unwrap();
            let to = map.nearest_free(map.cell_at_m([9000.0, 2000.0])).unwrap();
            let field = terrain.wave(terrain.map().nearest_free(to).unwrap()).unwrap();
            let mut arrived = 0;
            for from in terrain.map().free().step_by(997) {
                let Some(cost) = field.cost(from) else { continue };
                let route = field.route(from);
                assert_eq!(
                    check_terrain_route(&terrain, route.cells(), from, field.target()),
                    Ok(cost.into())
                );
                assert_eq!(check_slopes(&map, &robot, route.cells()), Ok(()));
                let program = route.program(&robot, &map, None);
                assert_eq!(activecell::check_program(&map, &robot, &program, route.cells()), Ok(()));
                arrived += 1;
            }
            println!("{name}, {lattice}: {arrived} routes");
            assert!(arrived > 20, "{name} {lattice} {arrived}");
        }
    }
}
