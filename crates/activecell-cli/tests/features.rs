//! The options and commands beyond the plain route, run as a user runs them.

#![expect(clippy::unwrap_used, reason = "a test that cannot start the command should stop")]

mod common;

use common::run;
use serde_json::Value;
use std::fs;
use std::path::Path;

fn json(folder: &Path, arguments: &str) -> Value {
    common::json(folder, arguments, &[0])
}

#[test]
fn nearest_goes_as_near_as_it_can() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("wall.txt"), "S.#.F\n..#..\n..#..\n").unwrap();
    let (code, _, _) = run(folder.path(), "route wall.txt --from S --to F");
    assert_eq!(code, 3);
    let route = json(folder.path(), "route wall.txt --from S --to F --nearest --json");
    assert_eq!(route["cells"], serde_json::json!([[0, 0], [1, 0]]));
    let (_, _, stderr) = run(folder.path(), "route wall.txt --from S --to F --nearest");
    assert_eq!(stderr, "activecell: note: there is no way to (4,0); the nearest cell with one is (1,0)\n");
    let (code, _, stderr) = run(folder.path(), "route wall.txt --from S --to 2,0 --nearest -q");
    assert_eq!((code, stderr.as_str()), (0, ""), "a target in an obstacle has a nearest cell too");
}

#[test]
fn clearance_keeps_off_walls() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(
        folder.path().join("hall.txt"),
        ".........\n.........\n.........\n....#....\nS...#...F\n.........\n",
    )
    .unwrap();
    let near = json(folder.path(), "route hall.txt --from S --to F --json");
    let clear = json(folder.path(), "route hall.txt --from S --to F --clearance 1.5 --json");
    assert!(near["clearance_m"].is_null());
    assert_eq!(near["steps"], 10);
    assert_eq!(clear["outcome"], "arrived");
    assert!(clear["clearance_m"].as_f64().unwrap() >= 1.0, "{clear}");
    assert!(clear["steps"].as_u64().unwrap() > 10);
    let (code, _, stderr) = run(folder.path(), "route hall.txt --from S --to F --clearance -1");
    assert_eq!((code, stderr.lines().count()), (1, 1), "{stderr}");
}

#[test]
fn embedded_maps_are_built_described_and_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::write(path.join("floor.txt"), "S..#.\n.#...\n...#F\n").unwrap();
    for lattice in ["square", "hex"] {
        let planes =
            json(path, &format!("embed floor.txt --lattice {lattice} -o d.acm --to S --to F --json -q"));
        assert_eq!((&planes["kind"], &planes["free_cells"]), (&"directions".into(), &12.into()));
        let table = json(path, &format!("embed floor.txt --lattice {lattice} -o m.acm --json -q"));
        assert_eq!(table["kind"], "moves");
        for file in ["d.acm", "m.acm"] {
            let size = fs::metadata(path.join(file)).unwrap().len();
            let info = json(path, &format!("info {file} --json"));
            assert_eq!((&info["lattice"], &info["bytes_on_disk"]), (&lattice.into(), &size.into()));
        }
        let one = fs::read(path.join("m.acm")).unwrap();
        json(path, &format!("embed floor.txt --lattice {lattice} -o m.acm --threads 3 --json -q"));
        assert_eq!(one, fs::read(path.join("m.acm")).unwrap(), "the same bytes on any number of threads");
    }
    let whole = fs::read(path.join("m.acm")).unwrap();
    fs::write(path.join("cut.acm"), &whole[..whole.len() / 2]).unwrap();
    fs::write(path.join("foreign.acm"), b"GIF89a and more, long enough for a header of any kind, surely so")
        .unwrap();
    for arguments in [
        "info cut.acm",
        "info foreign.acm",
        "embed floor.txt -o small.acm --limit 3",
        "embed floor.txt -o out.acm --to 9,9",
    ] {
        let (code, stdout, stderr) = run(path, arguments);
        assert_eq!((code, stdout.as_str(), stderr.lines().count()), (1, "", 1), "{arguments}: {stderr}");
    }
}
