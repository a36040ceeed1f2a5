//! Weighted fields against plain relaxation, their routes against a checker that knows no planner.

use crate::twins::{any_cell, cells, floor, free_cell};
use activecell::{Cell, Dir, Error, Frame, Lattice, Map, Outcome, Rng, Terrain, check_terrain_route};
use std::collections::{BTreeMap, VecDeque};

/// Random costs, lanes, closed areas, and steps with costs of their own on a floor.
fn terrain(map: &Map, rng: &mut Rng) -> Terrain {
    let mut terrain = Terrain::new(map);
    let most = [1, 3, 20, 255][rng.below(4) as usize];
    let (lanes, closed) = ([0.0, 0.1, 0.6][rng.below(3) as usize], [0.0, 0.1][rng.below(2) as usize]);
    let own = [0, 0, 1, 90, 3000][rng.below(5) as usize];
    for cell in cells(map) {
        terrain.set_cost([cell], 1 + rng.below(most) as u8).unwrap();
        if rng.chance(lanes) {
            let mask = rng.below(1 << map.lattice().degree());
            let dirs: Vec<Dir> = map.lattice().dirs().filter(|dir| mask >> dir.0 & 1 == 1).collect();
            terrain.set_one_way([cell], &dirs).unwrap();
        }
        if rng.chance(closed) {
            terrain.keep_out([cell]).unwrap();
        }
        for dir in map.lattice().dirs().filter(|_| own > 0) {
            let cost = (!rng.chance(0.1)).then(|| 1 + rng.below(own) as u16);
            terrain.set_step(cell, dir, cost).unwrap();
        }
    }
    terrain
}

/// The steps that a robot may make and what they cost, told anew from the rules: free cells, left as they may be,
/// never head-on, never closed.
fn steps(terrain: &Terrain, cell: Cell) -> Vec<(Dir, Cell, u32)> {
    let lattice = terrain.map().lattice();
    let may_make = |&(dir, next): &(Dir, Cell)| {
        let exits: Vec<Dir> = lattice.dirs().filter(|&dir| terrain.may_leave(next, dir)).collect();
        let head_on = exits.contains(&lattice.opposite(dir)) && !exits.contains(&dir);
        terrain.map().is_free(next) && terrain.may_leave(cell, dir) && !head_on
    };
    let all = lattice.dirs().map(|dir| (dir, lattice.neighbour(cell, dir)));
    let priced = |(dir, next): (Dir, Cell)| {
        let cost = u64::from(terrain.own_cost(cell, dir)?) * u64::from(terrain.cost(next));
        Some((dir, next, cost.min(65535) as u32))
    };
    if terrain.map().is_free(cell) { all.filter(may_make).filter_map(priced).collect() } else { Vec::new() }
}

/// Costs to the target, relaxed cell by cell until nothing changes (Bellman and Ford).
fn costs(terrain: &Terrain, target: Cell) -> BTreeMap<Cell, u32> {
    let mut best = BTreeMap::from([(target, 0)]);
    let mut changed = true;
    while changed {
        changed = false;
        for cell in cells(terrain.map()) {
            let ways = steps(terrain, cell)
                .into_iter()
                .filter_map(|(_, next, step)| best.get(&next).map(|cost| cost + step));
            if let Some(cost) = ways.min().filter(|cost| best.get(&cell).is_none_or(|old| cost < old)) {
                best.insert(cell, cost);
                changed = true;
            }
        }
    }
    best
}

/// The least (cost, turns) from `from` to `to`, by relaxing every (cell, direction) until nothing changes.
fn least_cost_and_turns(terrain: &Terrain, from: Cell, to: Cell) -> Option<(u32, u32)> {
    let lattice = terrain.map().lattice();
    let mut best: BTreeMap<(Cell, Dir), (u32, u32)> =
        lattice.dirs().map(|dir| ((from, dir), (0, 0))).collect();
    let mut queue: VecDeque<(Cell, Dir)> = best.keys().copied().collect();
    while let Some((cell, facing)) = queue.pop_front() {
        let (cost, turns) = best[&(cell, facing)];
        for (dir, next, step) in steps(terrain, cell) {
            let cost = (cost + step, turns + u32::from(dir != facing));
            if best.get(&(next, dir)).is_none_or(|&old| cost < old) {
                best.insert((next, dir), cost);
                queue.push_back((next, dir));
            }
        }
    }
    lattice.dirs().filter_map(|dir| best.get(&(to, dir)).copied()).min()
}

#[test]
fn the_cheapest_ways_are_found() {
    let (mut maps, mut reached, mut routes, mut turns) = (0, 0, 0, 0);
    for seed in 0..2500 {
        let mut rng = Rng::new(seed);
        let terrain = terrain(&floor(seed), &mut rng);
        let Some(target) = free_cell(terrain.map(), &mut rng) else { continue };
        let field = terrain.wave(target).unwrap();
        let expected = costs(&terrain, target);
        maps += 1;
        for cell in cells(terrain.map()) {
            let cost = expected.get(&cell).copied();
            assert_eq!(field.cost(cell), cost, "{cell} of {target}\n{terrain:?}");
            reached += usize::from(cost.is_some());
            let nearer: Vec<Dir> = steps(&terrain, cell)
                .into_iter()
                .filter(|(_, next, step)| {
                    let through = expected.get(next).map(|cost| cost + step);
                    cost.is_some() && through == cost
                })
                .map(|(dir, ..)| dir)
                .collect();
            assert_eq!(field.nearer(cell).collect::<Vec<_>>(), nearer);
            for dir in terrain.map().lattice().dirs() {
                let step = steps(&terrain, cell).into_iter().find(|step| step.0 == dir);
                assert_eq!(terrain.may_step(cell, dir), step.is_some());
                assert_eq!(terrain.step_cost(cell, dir), step.map(|step| step.2));
            }
        }
        let Some(from) = free_cell(terrain.map(), &mut rng) else { continue };
        let route = field.route(from);
        let Some((cost, fewest)) = least_cost_and_turns(&terrain, from, target) else {
            assert_eq!((route.outcome(), route.cells()), (Outcome::Unreachable, &[from][..]));
            continue;
        };
        assert_eq!(route.outcome(), Outcome::Arrived);
        assert_eq!(check_terrain_route(&terrain, route.cells(), from, target), Ok(cost.into()));
        assert_eq!(route.turns().len() as u32, fewest, "{from} to {target}\n{terrain:?}");
        (routes, turns) = (routes + 1, turns + fewest);
    }
    println!("{maps} terrains, {reached} costs, {routes} routes with {turns} turns");
    assert!(maps > 1800 && routes > 800 && turns > 1000);
}

#[test]
fn plain_ground_gives_the_plain_wave() {
    let mut reached = 0;
    for seed in 0..1500 {
        let map = floor(seed);
        let mut rng = Rng::new(seed);
        let Some(target) = free_cell(&map, &mut rng) else { continue };
        let field = Terrain::new(&map).wave(target).unwrap();
        let wave = map.wave(target).unwrap();
        for cell in cells(&map) {
            assert_eq!(field.cost(cell), wave.steps(cell));
            reached += usize::from(wave.steps(cell).is_some());
        }
        let from = free_cell(&map, &mut rng).unwrap();
        let (route, plain) = (field.route(from), wave.route(from));
        assert_eq!((route.steps(), route.turns().len()), (plain.steps(), plain.turns().len()));
    }
    assert!(reached > 30_000);
}

#[test]
fn terrain_refuses_what_makes_no_sense() {
    let map = Map::parse(Lattice::Square, "..#").unwrap();
    let mut terrain = Terrain::new(&map);
    let plain = terrain.clone();
    let outside = Cell::new(3, 0);
    let error = Error::OutsideMap { cell: outside, width: 3, height: 1 };
    assert_eq!(terrain.set_cost([Cell::new(0, 0), outside], 2), Err(error.clone()));
    assert_eq!(terrain.set_one_way([outside], &[Dir::E]), Err(error.clone()));
    assert_eq!(terrain.keep_out([Cell::new(0, 0), outside]), Err(error.clone()));
    assert!(matches!(terrain.set_cost([Cell::new(0, 0)], 0), Err(Error::BadValue { .. })));
    assert!(matches!(terrain.set_one_way([Cell::new(0, 0)], &[Dir(4)]), Err(Error::BadValue { .. })));
    assert_eq!(terrain.set_step(outside, Dir::E, None), Err(error.clone()));
    assert!(matches!(terrain.set_step(Cell::new(0, 0), Dir(4), None), Err(Error::BadValue { .. })));
    assert!(matches!(terrain.set_step(Cell::new(0, 0), Dir::E, Some(0)), Err(Error::BadValue { .. })));
    assert_eq!((terrain.wave(outside).unwrap_err(), terrain.map()), (error, plain.map()));
    terrain.keep_out([Cell::new(1, 0)]).unwrap();
    assert!(matches!(terrain.wave(Cell::new(1, 0)), Err(Error::TargetOccupied { .. })));
    assert!(map.is_free(Cell::new(1, 0)), "the map itself does not change");
    assert_eq!((plain.cost(outside), plain.may_leave(outside, Dir::N)), (1, true));
}

/// Whether the cell and the polygon share more than a border, by probing many points of the cell's inside.
fn probed(map: &Map, cell: Cell, inside: impl Fn([f64; 2]) -> bool) -> bool {
    let [x, y] = map.centre_m(cell);
    let reach = map.frame().cell_m * 0.62;
    (0..=40).flat_map(|i| (0..=40).map(move |j| (i, j))).any(|(i, j)| {
        let point = [x + reach * (f64::from(i) / 20.0 - 1.0), y + reach * (f64::from(j) / 20.0 - 1.0)];
        inside(point) && map.cell_at_m(point) == cell
    })
}

#[test]
fn areas_in_metres_hold_the_cells_that_they_touch() {
    let (mut held, mut near) = (0, 0);
    for seed in 0..120 {
        let mut rng = Rng::new(seed);
        let mut number = |from: f64, to: f64| from + (to - from) * f64::from(rng.below(1000)) / 1000.0;
        let frame = Frame {
            cell_m: number(0.2, 2.0),
            origin_m: [number(-9.0, 9.0), number(-9.0, 9.0)],
            yaw_rad: number(-3.0, 3.0),
        };
        let map =
            Map::random(Lattice::ALL[seed as usize % 2], 9, 8, 0.2, seed).unwrap().in_frame(frame).unwrap();
        let size = map.size_m();
        let mut corner = || map.frame().to_floor([number(-0.5, 1.5) * size[0], number(-0.5, 1.5) * size[1]]);
        let triangle = [corner(), corner(), corner()];
        let inside = |point: [f64; 2]| {
            let side = |a: [f64; 2], b: [f64; 2]| {
                (b[0] - a[0]) * (point[1] - a[1]) - (b[1] - a[1]) * (point[0] - a[0])
            };
            let sides = [0, 1, 2].map(|i| side(triangle[i], triangle[(i + 1) % 3]));
            sides.iter().all(|&side| side > 0.0) || sides.iter().all(|&side| side < 0.0)
        };
        let touched = map.cells_touching_m(&triangle).unwrap();
        assert!(touched.is_sorted_by_key(|cell| (cell.y, cell.x)));
        for cell in cells(&map) {
            let found = touched.contains(&cell);
            // Probes miss slivers, and never find what is not there.
            if probed(&map, cell, inside) {
                assert!(found, "{cell} {triangle:?}");
                held += 1;
            } else {
                near += usize::from(found);
            }
        }
    }
    println!("{held} cells held, {near} more barely touched");
    assert!(held > 1500 && near * 20 < held);
}

#[test]
fn areas_may_be_odd() {
    for lattice in Lattice::ALL {
        let map = Map::random(lattice, 70, 3, 0.5, 1).unwrap();
        let whole = [[-1e9, -1e9], [1e9, -1e9], [1e9, 1e9], [-1e9, 1e9]];
        assert_eq!(map.cells_touching_m(&whole).unwrap().len(), map.cells());
        let [x, y] = map.centre_m(Cell::new(5, 1));
        let dot = [[x, y], [x + 1e-3, y], [x, y + 1e-3]];
        assert_eq!(map.cells_touching_m(&dot).unwrap(), [Cell::new(5, 1)]);
        assert_eq!(map.cells_touching_m(&[[-5.0, 0.0], [-4.0, 1.0], [-5.0, 2.0]]).unwrap(), []);
        for bad in [&[[0.0, 0.0], [1.0, 1.0]][..], &[[0.0, 0.0], [f64::NAN, 1.0], [0.0, 1.0]]] {
            assert!(matches!(map.cells_touching_m(bad), Err(Error::BadValue { .. })));
        }
        let mut rng = Rng::new(3);
        let cell = any_cell(&map, &mut rng);
        assert!(map.cells_touching_m(&[map.centre_m(cell); 3]).unwrap().len() <= 1);
    }
}
