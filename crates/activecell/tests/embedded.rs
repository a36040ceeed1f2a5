//! Embedded maps against the plain wave, and against hostile bytes.

#![expect(clippy::unwrap_used, reason = "a test that cannot make its map should stop")]

use activecell::{Cell, DirectionPlanes, EmbeddedMap, Error, Lattice, Map, MoveTable, Rng};
use std::sync::atomic::{AtomicUsize, Ordering};

fn cells(map: &Map) -> impl Iterator<Item = Cell> + use<> {
    let (width, height) = (map.width() as i32, map.height() as i32);
    (-1..=height).flat_map(move |y| (-1..=width).map(move |x| Cell::new(x, y)))
}

/// Random small maps of both lattices.
fn maps(count: u64, side: u32) -> impl Iterator<Item = Map> {
    (0..count).map(move |seed| {
        let mut rng = Rng::new(seed);
        let (width, height) = (1 + rng.below(side), 1 + rng.below(side));
        let density = [0.0, 0.1, 0.3, 0.45, 0.7, 1.0][rng.below(6) as usize];
        Map::random(Lattice::ALL[seed as usize % 2], width, height, density, seed).unwrap()
    })
}

fn table_of(map: &Map, threads: usize) -> Vec<u8> {
    map.move_table(map.cells(), threads, &|| ()).unwrap()
}

#[test]
fn every_move_is_one_step_nearer() {
    let mut pairs = 0;
    for map in maps(1500, 12) {
        let file = table_of(&map, 1);
        let table = MoveTable::from_bytes(&file).unwrap();
        assert!(table.header().is_of(&map));
        for to in map.free() {
            let field = map.wave(to).unwrap();
            for from in cells(&map) {
                match table.next(from, to) {
                    Some(dir) => {
                        assert!(field.nearer(from).any(|nearer| nearer == dir), "{from} {to} {map:?}");
                    }
                    None => assert!(field.steps(from).is_none_or(|steps| steps == 0), "{from} {to} {map:?}"),
                }
                pairs += 1;
            }
        }
        assert_eq!(table.next(Cell::new(0, 0), Cell::new(-1, 0)), None);
    }
    println!("{pairs} pairs of cells looked up");
    assert!(pairs > 1_000_000);
}

#[test]
fn a_path_is_a_shortest_way() {
    for map in maps(300, 20) {
        let file = table_of(&map, 2);
        let table = MoveTable::from_bytes(&file).unwrap();
        let Some(to) = map.free().last() else { continue };
        let planes = map.direction_planes(&[to]).unwrap();
        let planes = DirectionPlanes::from_bytes(&planes).unwrap();
        let field = map.wave(to).unwrap();
        for from in cells(&map) {
            let paths = [table.path(from, to), planes.path(0, from)];
            for path in paths {
                assert_eq!(path.as_ref().map(|path| path.len() as u32 - 1), field.steps(from));
                if let Some(path) = path {
                    assert_eq!(activecell::check_route(&map, &path, from, to), Ok(()));
                }
            }
        }
    }
}

#[test]
fn planes_hold_the_first_nearer_direction() {
    for map in maps(1500, 20) {
        let free: Vec<Cell> = map.free().collect();
        let Some(&last) = free.last() else { continue };
        let targets = [free[0], last, free[free.len() / 2], last];
        let file = map.direction_planes(&targets).unwrap();
        let planes = DirectionPlanes::from_bytes(&file).unwrap();
        assert!(planes.header().is_of(&map));
        for (number, &target) in targets.iter().enumerate() {
            assert_eq!(planes.target(number), Some(target));
            let field = map.wave(target).unwrap();
            for cell in cells(&map) {
                assert_eq!(planes.next(number, cell), field.nearer(cell).next(), "{cell} {target} {map:?}");
                assert_eq!(planes.is_reached(number, cell), field.steps(cell).is_some());
            }
        }
        assert_eq!((planes.target(4), planes.next(4, last)), (None, None));
    }
}

#[test]
fn the_bytes_do_not_depend_on_the_threads() {
    for map in maps(40, 60) {
        let rows = AtomicUsize::new(0);
        let count = || {
            rows.fetch_add(1, Ordering::Relaxed);
        };
        let file = map.move_table(map.cells(), 5, &count).unwrap();
        assert_eq!(rows.into_inner(), map.free_cells());
        assert_eq!(file, table_of(&map, 1));
        assert_eq!(file, table_of(&map, 2));
    }
}

#[test]
fn runs_are_few_where_the_floor_is_open() {
    let map = Map::random(Lattice::Square, 40, 40, 0.0, 1).unwrap();
    let file = table_of(&map, 2);
    let table = MoveTable::from_bytes(&file).unwrap();
    assert!(table.runs() < 1600 * 90, "{}", table.runs());
    assert_eq!(table.bytes(), file.len());
}

#[test]
fn too_large_maps_are_refused_before_any_work() {
    let map = Map::random(Lattice::Square, 1 << 12, 1 << 12, 0.0, 1).unwrap();
    let never = || unreachable!("no row is built");
    let error = map.move_table(1_000_000, 1, &never).unwrap_err();
    assert!(matches!(error, Error::BadValue { name: "the number of free cells", .. }));
    assert!(Map::parse(Lattice::Hex, "..").unwrap().move_table(9, 0, &|| ()).is_err());
    assert!(map.direction_planes(&[]).is_err());
}

/// Asks everything that can be asked of the file; must not panic.
fn ask(bytes: &[u8], map: &Map) -> bool {
    let Ok(embedded) = EmbeddedMap::from_bytes(bytes) else { return false };
    embedded.header().is_of(map);
    let ends: Vec<Cell> = cells(map).step_by(7).collect();
    for &from in &ends {
        match &embedded {
            EmbeddedMap::Directions(planes) => {
                for number in 0..planes.targets().min(5) {
                    planes.path(number, from);
                    planes.is_reached(number, from);
                }
            }
            EmbeddedMap::Moves(table) => {
                for &to in &ends {
                    table.path(from, to);
                }
            }
        }
    }
    true
}

#[test]
fn hostile_bytes_are_refused_or_harmless() {
    let (mut refused, mut harmless) = (0, 0);
    for (seed, map) in (0..).zip(maps(60, 12)) {
        let Some(target) = map.free().next() else { continue };
        for file in [table_of(&map, 1), map.direction_planes(&[target, target]).unwrap()] {
            assert!(ask(&file, &map));
            for end in (0..file.len()).step_by(3) {
                assert!(!ask(&file[..end], &map), "cut at {end}");
            }
            let mut rng = Rng::new(seed);
            for round in 0..400 {
                let mut bytes = file.clone();
                // The header is hit more often than its size would tell.
                let range = if round % 2 == 0 { 64 } else { bytes.len() as u32 };
                for _ in 0..=rng.below(3) {
                    bytes[rng.below(range) as usize] =
                        [0, 1, 2, 0x7f, 0x80, 0xff, rng.next_u64() as u8][rng.below(7) as usize];
                }
                if ask(&bytes, &map) { harmless += 1 } else { refused += 1 }
            }
            let mut longer = file.clone();
            longer.extend([0; 8]);
            assert!(!ask(&longer, &map));
            let length = longer.len() as u64;
            longer[32..40].copy_from_slice(&length.to_le_bytes());
            assert!(!ask(&longer, &map));
        }
    }
    println!("{refused} hostile files refused, {harmless} harmless");
    assert!(refused > 1000 && harmless > 1000);
}
