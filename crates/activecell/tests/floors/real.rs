//! Real floors of a million cells: repaired fields against fresh floods. Skipped where the maps are missing.

use activecell::{BitPlane, Cell, Lattice, LiveField, Map, Rng, Terrain};
use std::path::{Path, PathBuf};

/// The folder of the MovingAI maps: in `ACTIVECELL_DATA`, else in `../shared/data` beside the project.
fn folder() -> PathBuf {
    let given = std::env::var_os("ACTIVECELL_DATA").map(PathBuf::from);
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    given.unwrap_or_else(beside).join("movingai")
}

/// A MovingAI map, read without any of the checks that a stranger's file needs.
fn load(lattice: Lattice, name: &str) -> Option<Map> {
    let text = std::fs::read_to_string(folder().join(name)).ok()?;
    let rows: Vec<&str> = text.lines().skip(4).collect();
    let mut plane = BitPlane::new(rows[0].len() as u64, rows.len() as u64).unwrap();
    for (y, row) in rows.iter().enumerate() {
        for (x, character) in row.chars().enumerate() {
            plane.set(x as u32, y as u32, !matches!(character, '.' | 'G' | 'S'));
        }
    }
    Some(Map::new(lattice, plane))
}

#[test]
fn repair_equals_a_fresh_flood_on_real_maps() {
    let (mut maps, mut changes, mut changed) = (0, 0, 0);
    for name in ["Berlin_0_1024.map", "ost100d.map", "Aurora.map", "maze512-4-0.map", "random512-40-0.map"] {
        for lattice in Lattice::ALL {
            let Some(map) = load(lattice, name) else { continue };
            let mut rng = Rng::new(7);
            let free: Vec<Cell> = map.free().collect();
            let mut any = || free[rng.below(free.len() as u32) as usize];
            let target = any();
            let mut field = LiveField::new(&map, target).unwrap();
            for round in 0..4 {
                for _ in 0..250 {
                    let cell = any();
                    changed += field.set(cell, field.map().is_free(cell) && cell != target);
                    changes += 1;
                }
                // A box put down or taken away.
                let corner = any();
                let cells = (0..100).map(|i| Cell::new(corner.x + i % 10, corner.y + i / 10));
                let cells = cells.filter(|&cell| map.is_free(cell) && cell != target);
                changed += field.set_all(&cells.map(|cell| (cell, round % 2 == 0)).collect::<Vec<_>>());
                let fresh = field.map().wave(target).unwrap();
                assert!(free.iter().all(|&cell| field.steps(cell) == fresh.steps(cell)), "{name} {lattice}");
            }
            let (terrain, fresh) = (Terrain::new(&map).wave(target).unwrap(), map.wave(target).unwrap());
            assert!(free.iter().all(|&cell| terrain.cost(cell) == fresh.steps(cell)), "{name} {lattice}");
            maps += 1;
        }
    }
    match maps {
        0 => println!("skipped: no maps in {}", folder().display()),
        _ => println!("{maps} maps, {changes} changes, {changed} distances changed"),
    }
}
