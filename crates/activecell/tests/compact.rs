//! Compact fields and reachability against the plain wave, on thousands of random maps.

#![expect(clippy::unwrap_used, reason = "a test that cannot make its map should stop")]

use activecell::{BitPlane, Cell, Dir, Lattice, Map, Rng};
use std::collections::BTreeSet;

/// Sides around the borders of tiles and words.
const SIDES: [u32; 16] = [1, 2, 3, 7, 8, 9, 15, 16, 17, 31, 33, 63, 64, 65, 128, 130];
const DENSITIES: [f64; 8] = [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 0.97];

/// A maze with ways one cell wide, cut by depth-first search.
fn maze(lattice: Lattice, width: u32, height: u32, rng: &mut Rng) -> Map {
    let mut obstacles = BitPlane::new(width.into(), height.into()).unwrap();
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
        obstacles.set(x, y, true);
    }
    let mut way = vec![(0u32, 0u32)];
    obstacles.set(0, 0, false);
    while let Some(&(x, y)) = way.last() {
        let steps = [(2i64, 0i64), (-2, 0), (0, 2), (0, -2)];
        let turn = rng.below(4) as usize;
        let next = (0..4).map(|i| steps[(turn + i) % 4]).find_map(|(dx, dy)| {
            let (nx, ny) = (i64::from(x) + dx, i64::from(y) + dy);
            let inside = (0..i64::from(width)).contains(&nx) && (0..i64::from(height)).contains(&ny);
            (inside && obstacles.get(nx as u32, ny as u32)).then_some((nx as u32, ny as u32))
        });
        if let Some((nx, ny)) = next {
            obstacles.set(x.midpoint(nx), y.midpoint(ny), false);
            obstacles.set(nx, ny, false);
            way.push((nx, ny));
        } else {
            way.pop();
        }
    }
    Map::new(lattice, obstacles)
}

/// Random maps and mazes with some free cells of each.
fn tasks(count: u64) -> impl Iterator<Item = (Map, Vec<Cell>)> {
    (0..count).filter_map(|seed| {
        let mut rng = Rng::new(seed);
        let lattice = Lattice::ALL[seed as usize % 2];
        let mut side = || SIDES[rng.below(SIDES.len() as u32) as usize];
        let (width, height) = (side(), side());
        let map = if rng.below(6) == 0 {
            maze(lattice, width, height, &mut rng)
        } else {
            let density = DENSITIES[rng.below(DENSITIES.len() as u32) as usize];
            Map::random(lattice, width, height, density, seed).unwrap()
        };
        let free: Vec<Cell> = map.free().collect();
        if free.is_empty() {
            return None;
        }
        let count = 1 + rng.below(4) * (seed % 3 / 2) as u32;
        let targets = (0..count).map(|_| free[rng.below(free.len() as u32) as usize]).collect();
        Some((map, targets))
    })
}

fn cells(map: &Map) -> impl Iterator<Item = Cell> {
    let (width, height) = (map.width() as i32, map.height() as i32);
    (-1..=height).flat_map(move |y| (-1..=width).map(move |x| Cell::new(x, y)))
}

#[test]
fn one_target_gives_the_directions_of_the_full_field() {
    let mut maps = 0;
    for (map, targets) in tasks(3000) {
        let (compact, field) = (map.compact_wave(&targets[..1]).unwrap(), map.wave(targets[0]).unwrap());
        for cell in cells(&map) {
            assert_eq!(compact.is_reached(cell), field.steps(cell).is_some(), "{cell} of {map:?}");
            assert!(compact.nearer(cell).eq(field.nearer(cell)), "{cell} of {map:?}");
            assert_eq!(compact.next(cell), field.nearer(cell).next());
        }
        maps += 1;
    }
    println!("{maps} maps: compact fields equal full ones");
    assert!(maps > 2500);
}

#[test]
fn of_several_targets_the_nearest_counts() {
    let mut several = 0;
    for (map, targets) in tasks(2000).filter(|task| task.1.len() > 1) {
        several += 1;
        let compact = map.compact_wave(&targets).unwrap();
        let fields: Vec<_> = targets.iter().map(|&target| map.wave(target).unwrap()).collect();
        let steps = |cell| fields.iter().filter_map(|field| field.steps(cell)).min();
        for cell in cells(&map) {
            let wanted = steps(cell).and_then(|steps| steps.checked_sub(1));
            let nearer = map
                .lattice()
                .dirs()
                .filter(|&dir| wanted.is_some() && steps(map.lattice().neighbour(cell, dir)) == wanted);
            assert!(compact.nearer(cell).eq(nearer), "{cell} of {map:?}");
            assert_eq!(compact.is_reached(cell), steps(cell).is_some());
        }
    }
    assert!(several > 300, "{several}");
}

#[test]
fn reachability_is_what_a_plain_search_finds() {
    for (map, targets) in tasks(2000) {
        let reached = map.reachable(&targets).unwrap();
        let mut found: BTreeSet<Cell> = targets.iter().copied().collect();
        let mut rim = targets.clone();
        while let Some(cell) = rim.pop() {
            let around = map.lattice().dirs().map(|dir| map.lattice().neighbour(cell, dir));
            rim.extend(around.filter(|&next| map.is_free(next) && found.insert(next)));
        }
        assert_eq!(reached.count_ones(), found.len() as u64, "{map:?}");
        assert!(found.iter().all(|cell| reached.get(cell.x as u32, cell.y as u32)), "{map:?}");
    }
}

#[test]
fn a_compact_field_is_small() {
    let map = Map::random(Lattice::Square, 340, 164, 0.0, 1).unwrap();
    let corner = [Cell::new(0, 0)];
    assert_eq!(map.compact_wave(&corner).unwrap().bytes(), 6976); // shares the map
    let pockets =
        Map::parse(Lattice::Square, &(".#".to_owned() + &"#".repeat(338) + "\n").repeat(164)).unwrap();
    assert_eq!(pockets.compact_wave(&corner).unwrap().bytes(), 6976);
    let pocket = Map::random(Lattice::Square, 340, 164, 0.3, 1).unwrap();
    let free = pocket.free().next().unwrap();
    assert_eq!(pocket.compact_wave(&[free]).unwrap().bytes(), 13_952);
    assert_eq!(map.on(Lattice::Hex).compact_wave(&corner).unwrap().bytes(), 13_952);
}

#[test]
fn senseless_targets_are_refused() {
    let map = Map::parse(Lattice::Square, "..#").unwrap();
    for targets in [&[][..], &[Cell::new(2, 0)], &[Cell::new(0, 0), Cell::new(3, 0)], &[Cell::new(-1, 0)]] {
        assert!(map.compact_wave(targets).is_err() && map.reachable(targets).is_err());
    }
    assert_eq!(map.compact_wave(&[Cell::new(0, 0)]).unwrap().next(Cell::new(1, 0)), Some(Dir::W));
}
