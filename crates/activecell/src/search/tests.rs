//! Every method on every kind of map, against a plain breadth-first search.

use super::{Engine, Method, OutOfRoom, Search, jump::Jumps, ways::Ways};
use crate::error::Error;
use crate::lattice::{Cell, Lattice};
use crate::map::{BitPlane, Map};
use crate::rng::Rng;
use std::collections::{BTreeMap, VecDeque};

/// The methods of squares; hexagons know one.
const METHODS: [Method; 3] = [Method::Jump, Method::Detour, Method::Ways];

/// The naive twin: distances from `from` by a plain queue.
fn breadth_first(map: &Map, from: Cell) -> BTreeMap<Cell, u32> {
    let mut steps = BTreeMap::from([(from, 0)]);
    let mut queue = VecDeque::from([from]);
    while let Some(cell) = queue.pop_front() {
        for dir in map.lattice().dirs() {
            let next = map.lattice().neighbour(cell, dir);
            if map.is_free(next) && !steps.contains_key(&next) {
                steps.insert(next, steps[&cell] + 1);
                queue.push_back(next);
            }
        }
    }
    steps
}

/// That the cells lead from neighbour to neighbour through free cells.
fn check(map: &Map, path: &[Cell], from: Cell, to: Cell) {
    assert_eq!((path.first(), path.last()), (Some(&from), Some(&to)));
    assert!(path.iter().all(|&cell| map.is_free(cell)));
    assert!(path.windows(2).all(|pair| map.lattice().dir_between(pair[0], pair[1]).is_some()));
}

/// Asks every method for ways between random cells of the map, many of one search.
fn compare(map: &Map, sources: usize, targets: usize, seed: u64) {
    let free: Vec<Cell> = map.free().collect();
    if free.is_empty() {
        return;
    }
    let mut rng = Rng::new(seed);
    let mut searches = METHODS.map(|method| Search::by(map, method));
    for _ in 0..sources {
        let from = free[rng.below(free.len() as u32) as usize];
        let truth = breadth_first(map, from);
        for _ in 0..targets {
            let to = free[rng.below(free.len() as u32) as usize];
            let expected = truth.get(&to).copied();
            for search in &mut searches {
                let name = format!("{:?} {from} {to}\n{}", search.method, map.to_text());
                let path = search.path(from, to).unwrap();
                assert_eq!(path.as_ref().map(|path| path.len() as u32 - 1), expected, "{name}");
                assert_eq!(search.steps(from, to), Ok(expected), "{name}");
                if let Some(path) = path {
                    check(map, &path, from, to);
                    // The same question gives the same answer.
                    assert_eq!(search.path(from, to), Ok(Some(path)), "{name}");
                }
            }
        }
    }
}

/// Corridors one cell wide, by depth-first carving.
fn maze(lattice: Lattice, width: u32, height: u32, seed: u64) -> Map {
    let mut plane = BitPlane::new(width.into(), height.into()).unwrap();
    for y in 0..height {
        for x in 0..width {
            plane.set(x, y, true);
        }
    }
    let mut rng = Rng::new(seed);
    let mut stack = vec![(0i32, 0i32)];
    plane.set(0, 0, false);
    while let Some(&(x, y)) = stack.last() {
        let steps = [(2, 0), (-2, 0), (0, 2), (0, -2)];
        let open: Vec<(i32, i32)> = steps
            .into_iter()
            .filter(|(dx, dy)| {
                let (x, y) = ((x + dx) as u32, (y + dy) as u32);
                x < width && y < height && plane.get(x, y)
            })
            .collect();
        if open.is_empty() {
            stack.pop();
            continue;
        }
        let (dx, dy) = open[rng.below(open.len() as u32) as usize];
        plane.set((x + dx / 2) as u32, (y + dy / 2) as u32, false);
        plane.set((x + dx) as u32, (y + dy) as u32, false);
        stack.push((x + dx, y + dy));
    }
    Map::new(lattice, plane)
}

#[test]
fn small_random_maps_equal_a_plain_search() {
    let mut rng = Rng::new(1);
    for seed in 0..1500 {
        for lattice in Lattice::ALL {
            let (w, h) = (1 + rng.below(20), 1 + rng.below(20));
            let density = f64::from(rng.below(60)) / 100.0;
            compare(&Map::random(lattice, w, h, density, seed).unwrap(), 2, 3, seed);
        }
    }
}

#[test]
fn every_size_about_a_word_equals_a_plain_search() {
    let sizes = [1, 2, 7, 8, 9, 15, 16, 17, 31, 33, 63, 64, 65, 66, 127, 128, 129, 130];
    for (i, w) in sizes.into_iter().enumerate() {
        for h in [sizes[(i * 7 + 3) % sizes.len()], sizes[(i * 5 + 1) % sizes.len()], 1, 64] {
            for lattice in Lattice::ALL {
                for density in [0.0, 0.03, 0.2, 0.4] {
                    compare(&Map::random(lattice, w, h, density, u64::from(w * h)).unwrap(), 1, 4, 5);
                    compare(&Map::random(lattice, h, w, density, u64::from(w * h)).unwrap(), 1, 4, 6);
                }
            }
        }
    }
}

#[test]
fn mazes_equal_a_plain_search() {
    for lattice in Lattice::ALL {
        for (seed, (w, h)) in [(5, 5), (33, 17), (64, 64), (65, 129), (151, 151)].into_iter().enumerate() {
            let map = maze(lattice, w, h, seed as u64);
            compare(&map, 3, 8, 7);
            // With loops, few and many: some dead ends are left, and a few parts without any.
            for loops in [0.01, 0.1] {
                let (mut plane, mut rng) = (map.obstacles().clone(), Rng::new(seed as u64));
                for (x, y) in (0..h).flat_map(|y| (0..w).map(move |x| (x, y))) {
                    if rng.chance(loops) {
                        plane.set(x, y, !plane.get(x, y));
                    }
                }
                compare(&Map::new(lattice, plane), 3, 8, 7);
            }
        }
    }
}

#[test]
fn rooms_with_doors_equal_a_plain_search() {
    for seed in 0..60 {
        let mut rng = Rng::new(seed);
        let (w, h, room) = (40 + rng.below(100), 40 + rng.below(100), 5 + rng.below(20));
        let mut plane = BitPlane::new(w.into(), h.into()).unwrap();
        for y in 0..h {
            for x in 0..w {
                let wall = x % room == 0 || y % room == 0;
                plane.set(x, y, wall && !rng.chance(0.15));
            }
        }
        for lattice in Lattice::ALL {
            compare(&Map::new(lattice, plane.clone()), 2, 5, seed);
        }
    }
}

#[test]
fn what_cannot_be_asked_is_refused() {
    for lattice in Lattice::ALL {
        let map = Map::parse(lattice, "..#\n.#.").unwrap();
        for method in METHODS {
            let mut search = Search::by(&map, method);
            for (from, to) in [
                ((0, 0), (2, 0)),
                ((2, 0), (0, 0)),
                ((0, 0), (3, 0)),
                ((0, -1), (0, 0)),
                ((i32::MIN, 0), (0, i32::MAX)),
            ] {
                let (from, to) = (Cell::new(from.0, from.1), Cell::new(to.0, to.1));
                let refused = map.check_task(from, to).unwrap_err();
                assert_eq!(search.path(from, to), Err(refused.clone()));
                assert_eq!(search.steps(from, to), Err::<Option<u32>, Error>(refused));
            }
            assert_eq!(search.path(Cell::new(0, 0), Cell::new(0, 0)), Ok(Some(vec![Cell::new(0, 0)])));
            assert_eq!(search.path(Cell::new(0, 0), Cell::new(2, 1)), Ok(None));
        }
    }
}

#[test]
fn a_rim_without_room_gives_the_query_up_and_nothing_else() {
    let map = Map::random(Lattice::Square, 150, 130, 0.25, 3).unwrap();
    let free: Vec<Cell> = map.free().collect();
    let (mut small, mut large) = (Jumps::new(&map, 0, 0), Jumps::new(&map, 1 << 22, 0));
    let mut ways = Ways::new(&map, 200);
    let mut rng = Rng::new(4);
    let mut given_up = [0, 0];
    for _ in 0..500 {
        let mut pick = || free[rng.below(free.len() as u32) as usize];
        let (from, to) = (pick(), pick());
        if from != to {
            for (answer, given_up) in [small.run(from, to), ways.run(from, to)].into_iter().zip(&mut given_up)
            {
                match answer {
                    Ok(steps) => assert_eq!(Ok(steps), large.run(from, to)),
                    Err(OutOfRoom) => *given_up += 1,
                }
            }
        }
    }
    assert!(given_up.iter().all(|given_up| (50..450).contains(given_up)), "{given_up:?}");
}

#[test]
fn a_query_without_room_is_answered_in_the_same_memory() {
    let map = Map::random(Lattice::Square, 200, 200, 0.2, 2).unwrap();
    let (from, to) = (map.free().next().unwrap(), map.free().last().unwrap());
    let mut search = Search::by(&map, Method::Jump);
    search.engine = Engine::Jump(Box::new(Jumps::new(&map, 0, 0)));
    let mut twin = Search::by(&map, Method::Ways);
    let near = map.nearest_free(Cell::new(5, 5)).unwrap();
    for (asked, (from, to)) in [(from, to), (from, near), (to, from)].into_iter().enumerate() {
        let path = search.path(from, to).unwrap();
        assert_eq!(path.map(|path| path.len() as u32 - 1), twin.steps(from, to).unwrap());
        // The first query outgrew its room; the next finds the method of the map again.
        assert_eq!(matches!(search.engine, Engine::Jump(_)), asked > 0);
    }
}

#[test]
fn memory_stays_below_a_byte_a_cell() {
    for lattice in Lattice::ALL {
        for (w, h) in [(1, 1), (1, 3000), (3000, 1), (65, 65), (512, 512), (1000, 300)] {
            for density in [0.05, 0.3] {
                let map = Map::random(lattice, w, h, density, 9).unwrap();
                let free: Vec<Cell> = map.free().collect();
                let cells = w.next_multiple_of(64) as usize * h.next_multiple_of(64) as usize;
                let small = 64 * (2 * (w as usize + h as usize) / 8 + 4) + (1 << 16);
                let allowed = cells + if map.cells() < 512 * 512 { small } else { 0 };
                for method in METHODS {
                    let mut search = Search::by(&map, method);
                    for to in free.iter().rev().step_by(free.len() / 5 + 1) {
                        search.steps(free[0], *to).unwrap();
                        assert!(
                            search.bytes() <= allowed,
                            "{lattice} {w}x{h} {method:?}: {} {allowed}",
                            search.bytes()
                        );
                    }
                }
            }
        }
    }
}
