//! Growth, clearance and routes that keep off walls, against plain counting.

use crate::twins::{cells, floor, free_cell, steps};
use activecell::{Cell, Error, Frame, Lattice, Map, Outcome, Rng, Rule, check_route};
use std::collections::VecDeque;

/// Four times the square of the distance between two centres.
fn quarters(lattice: Lattice, a: Cell, b: Cell) -> i64 {
    let ((ax, ay), (bx, by)) = (lattice.centre(a), lattice.centre(b));
    let down = (ay - by) * (ay - by);
    (ax - bx) * (ax - bx) + if lattice == Lattice::Hex { down / 3 } else { down }
}

/// For every cell the square of the distance to the nearest obstacle or cell outside, in quarters.
fn rooms(map: &Map) -> Vec<i64> {
    let (width, height) = (map.width() as i32, map.height() as i32);
    // Beyond a border of one cell nothing is nearer.
    let around = (-1..=height).flat_map(|y| (-1..=width).map(move |x| Cell::new(x, y)));
    let obstacles: Vec<Cell> = around.filter(|&cell| !map.is_free(cell)).collect();
    let nearest = |cell| obstacles.iter().map(|&other| quarters(map.lattice(), cell, other)).min();
    cells(map).map(|cell| nearest(cell).unwrap()).collect()
}

#[test]
fn growth_equals_plain_counting() {
    let (mut maps, mut blocked) = (0, 0u64);
    for seed in 0..900 {
        let map = floor(seed);
        let rooms = rooms(&map);
        for radius in [0.0, 0.4, 0.9, 1.0, 3f64.sqrt(), 2.0, 2.5, 7f64.sqrt(), 5.0, 6.0, 8.0, 40.0, 1e9] {
            let grown = map.grown(radius).unwrap();
            for (cell, &room) in cells(&map).zip(&rooms) {
                let expected = room as f64 > 4.0 * radius * radius * (1.0 + 1e-12);
                assert_eq!(grown.is_free(cell), expected, "{cell}, radius {radius}\n{}", map.to_text());
            }
            // The bits behind the last column stay 0.
            assert_eq!(grown.obstacles().count_ones(), (map.cells() - grown.free_cells()) as u64);
            assert_eq!(grown.free().count(), grown.free_cells());
            (maps, blocked) = (maps + 1, blocked + grown.obstacles().count_ones());
        }
    }
    println!("{maps} growths, {blocked} cells blocked");
}

#[test]
fn wide_growth_crosses_words() {
    for lattice in Lattice::ALL {
        for seed in 0..4 {
            let map = Map::random(lattice, 300, 230, 0.000_05, seed).unwrap();
            let rooms = rooms(&map);
            for radius in [31.0, 33.5, 64.0, 66.0, 100.0] {
                let grown = map.grown(radius).unwrap();
                for (cell, &room) in cells(&map).zip(&rooms) {
                    assert_eq!(grown.is_free(cell), room as f64 > 4.0 * radius * radius, "{cell} {radius}");
                }
            }
        }
    }
}

#[test]
fn clearance_is_the_wave_from_all_walls() {
    let mut most = 0;
    for seed in 0..2000 {
        let map = floor(seed);
        let clearance = map.clearance();
        // The wave: obstacles and a border around the map first, then their neighbours, and so on.
        let mut expected = vec![0; map.cells()];
        let (width, height) = (map.width() as i32, map.height() as i32);
        let around = (-1..=height).flat_map(|y| (-1..=width).map(move |x| Cell::new(x, y)));
        let mut queue: VecDeque<(Cell, u32)> =
            around.filter(|&cell| !map.is_free(cell)).map(|cell| (cell, 0)).collect();
        while let Some((cell, steps)) = queue.pop_front() {
            for dir in map.lattice().dirs() {
                let next = map.lattice().neighbour(cell, dir);
                if map.is_free(next) && expected[map.index(next).unwrap()] == 0 {
                    expected[map.index(next).unwrap()] = steps + 1;
                    queue.push_back((next, steps + 1));
                }
            }
        }
        for (cell, &steps) in cells(&map).zip(&expected) {
            assert_eq!(clearance.steps(cell), steps, "{cell}\n{}", map.to_text());
        }
        assert_eq!(clearance.most(), expected.into_iter().max().unwrap());
        assert_eq!(clearance.steps(Cell::new(-1, 0)), 0);
        most = most.max(clearance.most());
    }
    assert!(most >= 5, "{most}");
    let long = Map::random(Lattice::Hex, 100_000, 3, 0.0, 1).unwrap().clearance();
    assert_eq!((long.most(), long.steps(Cell::new(99_998, 1))), (2, 2));
}

#[test]
fn routes_keep_the_most_clearance_up_to_what_was_asked() {
    let (mut full, mut less, mut none) = (0, 0, 0);
    for seed in 0..1500 {
        let mut rng = Rng::new(seed);
        let frame = Frame { cell_m: 0.25, ..Frame::default() };
        let density = [0.0, 0.02, 0.2, 0.5][rng.below(4) as usize];
        let map = if rng.chance(0.2) {
            floor(seed)
        } else {
            Map::random(Lattice::ALL[seed as usize % 2], 24, 19, density, seed).unwrap()
        };
        let map = map.in_frame(frame).unwrap();
        let (Some(from), Some(to)) = (free_cell(&map, &mut rng), free_cell(&map, &mut rng)) else { continue };
        let asked = f64::from(rng.below(8)) * 0.25;
        let clear = map.kept_clear(from, to, asked).unwrap();
        let route = clear.route(Rule::Wave, from, to, 0).unwrap();
        let rooms = rooms(&map);
        let way_with = |room: i64| {
            let mut plane = map.obstacles().clone();
            for (cell, &here) in cells(&map).zip(&rooms) {
                plane.set(cell.x as u32, cell.y as u32, here < room);
            }
            steps(&Map::new(map.lattice(), plane), to)[map.index(from).unwrap()].is_some()
        };
        if route.outcome() != Outcome::Arrived {
            assert!(!way_with(1));
            assert_eq!(clear, map);
            none += 1;
            continue;
        }
        assert_eq!(check_route(&map, route.cells(), from, to), Ok(()));
        let kept = map.clearance_m(route.cells()).unwrap();
        let worst = route.cells().iter().map(|&cell| rooms[map.index(cell).unwrap()]).min().unwrap();
        assert!((kept - (worst as f64).sqrt() / 2.0 * 0.25).abs() < 1e-12);
        if kept >= asked - 1e-12 {
            full += 1;
        } else {
            // One quarter more would leave no way.
            assert!(!way_with(worst + 1), "{from} to {to}, asked {asked}, kept {kept}\n{}", map.to_text());
            less += 1;
        }
        let terrain = map.terrain_kept_clear(from, to, asked).unwrap();
        assert_eq!(terrain.map(), &clear);
        for (cell, &room) in cells(&map).zip(&rooms).filter(|(cell, _)| clear.is_free(*cell)) {
            let missing =
                (1..=4).filter(|&band| (room as f64).sqrt() / 8.0 < asked * f64::from(band) / 4.0 - 1e-9);
            assert_eq!(u32::from(terrain.cost(cell)), 1 + 4 * missing.count() as u32, "{cell}");
        }
        let preferred = terrain.wave(to).unwrap().route(from);
        // As wide where it is narrowest.
        assert!(map.clearance_m(preferred.cells()).unwrap() >= kept.min(asked) - 1e-12);
        if asked <= 0.25 {
            assert_eq!(clear, map, "every route has a cell's size");
        }
    }
    println!("{full} kept what was asked, {less} less, {none} had no way");
    assert!(full > 300 && less > 300 && none > 20);
}

#[test]
fn bad_numbers_are_refused() {
    let map = Map::parse(Lattice::Hex, "..\n.#").unwrap();
    let (free, blocked) = (Cell::new(0, 0), Cell::new(1, 1));
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(map.grown(bad), Err(Error::BadValue { .. })));
        assert!(matches!(map.kept_clear(free, free, bad), Err(Error::BadValue { .. })));
    }
    assert!(matches!(map.kept_clear(blocked, free, 1.0), Err(Error::StartOccupied { .. })));
    assert_eq!((map.clearance_m(&[]), map.clearance_m(&[free, blocked])), (None, Some(0.0)));
    assert!(map.kept_clear(free, free, 1e300).is_ok());
}
