//! A repaired field against a fresh flood, after every change.

use crate::twins::{any_cell, cells, floor, free_cell, steps};
use activecell::{Cell, LiveField, Map, Outcome, Rng, check_route};

/// Holds the field against plain search on its own map; says how many distances differ from `before`.
fn check(field: &LiveField, before: &mut Vec<Option<u32>>) -> usize {
    let map = field.map();
    let expected = steps(map, field.target());
    for (cell, &wanted) in cells(map).zip(&expected) {
        assert_eq!(field.steps(cell), wanted, "{cell} of {:?}\n{}", field.target(), map.to_text());
        for dir in map.lattice().dirs() {
            let near = map.lattice().neighbour(cell, dir);
            let nearer = wanted.is_some_and(|steps| {
                map.is_free(near) && expected[map.index(near).unwrap()].is_some_and(|near| near + 1 == steps)
            });
            assert_eq!(field.nearer(cell).any(|found| found == dir), nearer);
        }
    }
    let changed = before.iter().zip(&expected).filter(|(before, now)| before != now).count();
    *before = expected;
    changed
}

/// A route on the field is the one that a fresh flood gives, or as good.
fn check_route_of(field: &LiveField, rng: &mut Rng) {
    let Some(from) = free_cell(field.map(), rng).filter(|_| field.map().is_free(field.target())) else {
        return;
    };
    let route = field.route(from);
    let fresh = field.map().wave(field.target()).unwrap().route(from);
    assert_eq!(route.outcome(), fresh.outcome());
    assert_eq!((route.steps(), route.turns().len()), (fresh.steps(), fresh.turns().len()));
    if route.outcome() == Outcome::Arrived {
        assert_eq!(check_route(field.map(), route.cells(), from, field.target()), Ok(()));
    }
}

#[test]
fn repair_equals_a_fresh_flood() {
    let (mut maps, mut changes, mut changed) = (0, 0, 0);
    for seed in 0..700 {
        let map = floor(seed);
        let mut rng = Rng::new(!seed);
        let Some(target) = free_cell(&map, &mut rng) else { continue };
        let mut field = LiveField::new(&map, target).unwrap();
        let mut now = steps(&map, target);
        assert_eq!(check(&field, &mut now), 0);
        maps += 1;
        for _ in 0..40 {
            let cell = any_cell(&map, &mut rng);
            // Mostly a real change; sometimes none.
            let blocked = field.map().is_free(cell) ^ rng.chance(0.05);
            let outside = !map.contains(cell);
            let told = field.set(cell, blocked);
            assert_eq!(field.map().is_free(cell), !blocked && !outside);
            assert_eq!(told, check(&field, &mut now), "{}", field.map().to_text());
            (changes, changed) = (changes + 1, changed + told);
            check_route_of(&field, &mut rng);
        }
        assert_eq!(map, floor(seed), "the map that was given stays as it is");
    }
    println!("{maps} maps, {changes} changes, {changed} distances changed");
    assert!(changes > 15_000 && changed > 20_000);
}

#[test]
fn many_changes_at_once_equal_a_fresh_flood() {
    let (mut batches, mut changed) = (0, 0);
    for seed in 0..1200 {
        let map = floor(seed);
        let mut rng = Rng::new(seed ^ 0xabcd);
        let Some(target) = free_cell(&map, &mut rng) else { continue };
        let mut field = LiveField::new(&map, target).unwrap();
        let mut now = steps(&map, target);
        for _ in 0..6 {
            let most = [3, 12, 2 * map.cells() as u32][rng.below(3) as usize];
            let density = [0.1, 0.5, 0.9][rng.below(3) as usize];
            let mut wanted = field.map().obstacles().clone();
            let mut batch = Vec::new();
            for _ in 0..rng.below(most) {
                let (cell, blocked) = (any_cell(&map, &mut rng), rng.chance(density));
                batch.push((cell, blocked));
                if map.contains(cell) {
                    wanted.set(cell.x as u32, cell.y as u32, blocked);
                }
            }
            let told = field.set_all(&batch);
            assert_eq!(field.map(), &Map::new(map.lattice(), wanted));
            assert_eq!(told, check(&field, &mut now));
            (batches, changed) = (batches + 1, changed + told);
        }
    }
    println!("{batches} batches, {changed} distances changed");
    assert!(batches > 5000 && changed > 50_000);
}

#[test]
fn a_blocked_target_is_reached_by_none_until_it_is_free() {
    for seed in 0..40 {
        let map = floor(seed);
        let Some(target) = free_cell(&map, &mut Rng::new(seed)) else { continue };
        let mut field = LiveField::new(&map, target).unwrap();
        let reached = steps(&map, target).iter().flatten().count();
        assert_eq!(field.set(target, true), reached);
        assert!(cells(&map).all(|cell| field.steps(cell).is_none()));
        assert_eq!(field.set(target, false), reached);
        check(&field, &mut Vec::new());
    }
}

#[test]
fn bad_targets_are_refused_like_a_floods() {
    let map = Map::parse(activecell::Lattice::Hex, ".#").unwrap();
    for target in [Cell::new(1, 0), Cell::new(2, 0), Cell::new(0, -1)] {
        assert_eq!(LiveField::new(&map, target).unwrap_err(), map.wave(target).unwrap_err());
    }
    let mut field = LiveField::new(&map, Cell::new(0, 0)).unwrap();
    assert_eq!(field.set(Cell::new(-1, 0), true), 0);
    assert_eq!(field.set_all(&[(Cell::new(i32::MAX, i32::MIN), false)]), 0);
}
