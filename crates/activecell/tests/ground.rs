//! Uneven ground: lengths, slopes and routes over it, against plain probing and plain search.

#![expect(clippy::unwrap_used, reason = "a test may stop at the first surprise")]

use activecell::{
    Cell, Certificate, Elevation, Error, Frame, Ground, Lattice, Map, Outcome, PointM, Posts, ProgramFault,
    Rng, Robot, RouteFault, Rule, Slopes, Terrain, check_program, check_slopes, check_terrain_route,
};
use std::collections::BTreeMap;

const GROUNDS: [Ground; 2] = [Ground::Segments, Ground::Surface];

/// A slope that rises by `deg` towards `towards_rad`, under any map of up to 60 m.
fn ramp(deg: f64, towards_rad: f64) -> Elevation {
    let (posts, tan) = (90u32, deg.to_radians().tan());
    let heights = (0..posts * posts).map(|i| {
        let (x, y) = (f64::from(i % posts), f64::from(posts - 1 - i / posts));
        (tan * (x * towards_rad.cos() + y * towards_rad.sin())) as f32
    });
    let corner_m = [-14.5, -13.0];
    Elevation::new(posts, posts, heights.collect(), Posts { corner_m, ..Posts::default() }).unwrap()
}

#[test]
fn on_a_ramp_the_program_counts_the_grounds_length() {
    for (deg, saved_mm) in [(3.0, 5.5), (6.0, 21.9), (10.0, 60.8)] {
        for lattice in Lattice::ALL {
            for ground in GROUNDS {
                let frame = Frame { cell_m: 0.5, ..Frame::default() };
                let map = Map::random(lattice, 40, 5, 0.0, 1).unwrap().in_frame(frame).unwrap();
                let map = map.elevated(ramp(deg, 0.0), ground);
                let route = map.route(Rule::Wave, Cell::new(3, 2), Cell::new(23, 2), 1000).unwrap();
                let robot = Robot { wheel_perimeter_m: 1.0, ..Robot::default() };
                let program = route.program(&robot, &map, None);
                let expected = 10.0 / deg.to_radians().cos();
                assert!(
                    (program.revolutions() - expected).abs() < 1e-5,
                    "{} {expected}",
                    program.revolutions()
                );
                assert!((program.waypoints[0].climb_m - 10.0 * deg.to_radians().tan()).abs() < 1e-5);
                assert_eq!(check_program(&map, &robot, &program, route.cells()), Ok(()));
                // A program that takes the floor for flat stops short; the replay says where.
                let mut flat = program.clone();
                flat.waypoints[0].revolutions = 10.0;
                let fault = check_program(&map, &robot, &flat, route.cells()).unwrap_err();
                assert!(matches!(fault, ProgramFault::OffRoute { step: 20, .. }), "{fault}");
                // A physics engine's robot that took 4 m on such a ramp for flat was so far off on the map.
                let lost_mm = 4000.0 * (1.0 - deg.to_radians().cos());
                assert!((lost_mm - saved_mm).abs() < 0.2, "{lost_mm}");
            }
        }
    }
}

#[test]
fn a_certificate_on_a_ramp_speaks_of_the_map() {
    let flat = Map::random(Lattice::Square, 12, 3, 0.0, 1).unwrap();
    let map = flat.clone().elevated(ramp(10.0, 0.0), Ground::Surface);
    let robot = Robot::default();
    let (from, to) = (Cell::new(0, 1), Cell::new(10, 1));
    let route = map.terrain_for(&robot).unwrap().wave(to).unwrap().route(from);
    let program = route.program(&robot, &map, None);
    assert!(program.revolutions() * robot.wheel_perimeter_m > 10.1);
    let (uneven, level) = (Certificate::new(&map, &robot, &program), {
        let program = route.program(&robot, &flat, None);
        Certificate::new(&flat, &robot, &program)
    });
    assert_eq!(uneven.waypoints(), level.waypoints());
}

#[test]
fn across_a_ramp_nothing_changes_and_turns_keep_both_lengths() {
    for lattice in Lattice::ALL {
        let map = Map::random(lattice, 20, 20, 0.0, 1).unwrap().elevated(ramp(8.0, 1.1), Ground::Surface);
        let route = map.route(Rule::Wave, Cell::new(0, 19), Cell::new(12, 3), 1000).unwrap();
        let robot = Robot::default();
        let program = route.program(&robot, &map, None);
        assert_eq!(check_program(&map, &robot, &program, route.cells()), Ok(()));
        let tan = 8f64.to_radians().tan();
        let expected: f64 =
            route.dirs().map(|dir| (tan * (map.bearing_rad(dir) - 1.1).cos()).hypot(1.0)).sum();
        assert!((map.ground_m(route.cells()) - expected).abs() < 1e-4);
    }
}

/// Hills by chance: posts of some distance, some of them without a height.
fn hills(rng: &mut Rng, size_m: PointM) -> Elevation {
    let mut number = |from: f64, to: f64| from + (to - from) * f64::from(rng.below(10_000)) / 10_000.0;
    let apart_m = [number(0.3, 3.0), number(0.3, 3.0)];
    let corner_m = [-number(0.0, 1.0), -number(0.0, 1.0)];
    let steep = number(0.0, 0.3);
    let posts = Posts { apart_m, corner_m, yaw_rad: 0.0 };
    let [columns, rows] = [0, 1].map(|i| ((size_m[i] + 1.0) / apart_m[i]).ceil() as u32);
    let missing = if rng.chance(0.3) { 0.02 } else { 0.0 };
    let heights = (0..columns * rows).map(|_| {
        let height = (steep * f64::from(rng.below(1000)) / 1000.0) as f32;
        if rng.chance(missing) { f32::NAN } else { height }
    });
    Elevation::new(columns, rows, heights.collect(), posts).unwrap()
}

fn hilly_map(seed: u64) -> (Map, Robot) {
    let mut rng = Rng::new(seed);
    let lattice = Lattice::ALL[seed as usize % 2];
    let map = Map::random(lattice, 3 + rng.below(9), 3 + rng.below(9), 0.1, seed).unwrap();
    let elevation = hills(&mut rng, map.size_m());
    let slopes = Slopes {
        up_max_deg: f64::from(rng.below(20)),
        down_max_deg: f64::from(rng.below(20)),
        across_max_deg: f64::from(3 + rng.below(30)),
        climb_cost_m_per_m: [0.0, 2.0, 50.0][rng.below(3) as usize],
    };
    let robot = Robot { slopes, ..Robot::default() };
    (map.elevated(elevation, GROUNDS[rng.below(2) as usize]), robot)
}

/// Length, climb, steepest up and down of a way, by many chords.
fn chords(elevation: &Elevation, from: PointM, to: PointM) -> Option<[f64; 4]> {
    let (count, length_m) = (4000, (to[0] - from[0]).hypot(to[1] - from[1]));
    let at =
        |i: i32| [0, 1].map(|axis| from[axis] + f64::from(i) / f64::from(count) * (to[axis] - from[axis]));
    let mut sums = [0.0f64; 4];
    for i in 0..count {
        let rise = elevation.height_m(at(i + 1))? - elevation.height_m(at(i))?;
        let piece_m = length_m / f64::from(count);
        sums[0] += rise.hypot(piece_m);
        sums[1] += rise.max(0.0);
        sums[2] = sums[2].max(rise / piece_m);
        sums[3] = sums[3].max(-rise / piece_m);
    }
    Some(sums)
}

#[test]
fn profiles_are_what_many_chords_measure() {
    let (mut known, mut unknown) = (0, 0);
    for seed in 0..400 {
        let mut rng = Rng::new(seed);
        let elevation = hills(&mut rng, [9.0, 9.0]);
        let yaw_rad = f64::from(rng.below(600)) / 100.0 - 3.0;
        let elevation = elevation.clone().standing(Posts { yaw_rad, ..*elevation.posts() }).unwrap();
        let mut point = || {
            let [u, v] = [0, 1].map(|_| 0.2 + f64::from(rng.below(800)) / 100.0);
            let (sin, cos) = yaw_rad.sin_cos();
            let corner_m = elevation.posts().corner_m;
            [corner_m[0] + cos * u - sin * v, corner_m[1] + sin * u + cos * v]
        };
        let (from, to) = (point(), point());
        let profile = elevation.profile(from, to);
        let Some([length_m, climb_m, up, down]) = chords(&elevation, from, to) else {
            assert_eq!(profile, None);
            unknown += 1;
            continue;
        };
        // A way that only touches a patch without heights at its corner is known to the chords alone.
        let Some(profile) = profile else { continue };
        assert!((profile.surface_m - length_m).abs() < 1e-4 * length_m, "{profile:?} {length_m}");
        assert!((profile.climb_m - climb_m).abs() < 3e-3, "{profile:?} {climb_m}");
        assert!(
            (profile.up - up).abs() < 0.01 && (profile.down - down).abs() < 0.01,
            "{profile:?} {up} {down}"
        );
        let back = elevation.profile(to, from).unwrap();
        let mirrored = profile.back();
        for (a, b) in [
            (back.surface_m, mirrored.surface_m),
            (back.climb_m, mirrored.climb_m),
            (back.rise_m, mirrored.rise_m),
            (back.up, mirrored.up),
            (back.down, mirrored.down),
            (back.across, mirrored.across),
        ] {
            assert!((a - b).abs() < 1e-6, "{back:?} {mirrored:?}");
        }
        known += 1;
    }
    println!("{known} ways, {unknown} over unknown ground");
    assert!(known > 250 && unknown > 20);
}

/// The least cost from every cell to the target, relaxed until nothing changes, over directed steps with these costs.
fn relaxed(map: &Map, target: Cell, cost: impl Fn(Cell, Cell) -> Option<u64>) -> BTreeMap<Cell, u64> {
    let mut best = BTreeMap::from([(target, 0)]);
    loop {
        let mut changed = false;
        for cell in map.free() {
            for dir in map.lattice().dirs() {
                let next = map.lattice().neighbour(cell, dir);
                let Some(rest) = best.get(&next).copied().filter(|_| map.is_free(next)) else { continue };
                let Some(step) = cost(cell, next) else { continue };
                if best.get(&cell).is_none_or(|&old| rest + step < old) {
                    best.insert(cell, rest + step);
                    changed = true;
                }
            }
        }
        if !changed {
            return best;
        }
    }
}

#[test]
fn routes_are_cheapest_on_the_ground_within_the_limits() {
    let (mut routes, mut longer, mut unreachable, mut one_way) = (0, 0, 0, 0);
    for seed in 0..1500 {
        let (map, robot) = hilly_map(seed);
        let terrain = map.terrain_for(&robot).unwrap();
        let mut rng = Rng::new(seed);
        let free: Vec<Cell> = terrain.map().free().collect();
        if free.is_empty() {
            continue;
        }
        let [from, to] = [0, 1].map(|_| free[rng.below(free.len() as u32) as usize]);
        let Slopes { up_max_deg, down_max_deg, across_max_deg, climb_cost_m_per_m } = robot.slopes;
        let least = |cell: Cell, next: Cell| {
            // Measured one way and mirrored, as the robot's own map has it.
            let dir = map.lattice().dir_between(cell, next)?;
            let onward = dir.0 < map.lattice().degree() / 2;
            let profile = if onward { map.profile(cell, next)? } else { map.profile(next, cell)?.back() };
            let within = |slope: f64, deg: f64| slope.atan().to_degrees() <= deg * 1.000_001 + 1e-7;
            let gentle = within(profile.up, up_max_deg)
                && within(profile.down, down_max_deg)
                && within(profile.across, across_max_deg);
            let way_m = profile.ground_m(map.ground()) + climb_cost_m_per_m * profile.climb_m;
            gentle.then(|| (way_m * 64.0).round() as u64)
        };
        let best = relaxed(&map, to, least);
        let route = terrain.wave(to).unwrap().route(from);
        let Some(&cost) = best.get(&from) else {
            assert_eq!(route.outcome(), Outcome::Unreachable, "{seed}");
            unreachable += 1;
            one_way += usize::from(relaxed(&map, from, least).contains_key(&to));
            continue;
        };
        assert_eq!(check_terrain_route(&terrain, route.cells(), from, to), Ok(cost), "{seed}");
        assert_eq!(check_slopes(&map, &robot, route.cells()), Ok(()), "{seed}");
        let program = route.program(&robot, &map, None);
        assert_eq!(check_program(&map, &robot, &program, route.cells()), Ok(()), "{seed}");
        routes += 1;
        longer += usize::from(map.wave(to).unwrap().steps(from) != Some(route.steps() as u32));
    }
    println!(
        "{routes} routes, {longer} with detours; {unreachable} without a way, {one_way} of them one-way"
    );
    assert!(routes > 600 && longer > 30 && unreachable > 100 && one_way > 10);
}

#[test]
fn a_wall_too_steep_to_climb_is_gone_round_however_thin() {
    for lattice in Lattice::ALL {
        for thick in [0.02, 0.2, 1.0] {
            // Posts finer than the wall, cells coarser than it: nobody may jump over it inside a cell.
            let (apart_m, size) = (0.1, 240u32);
            let heights = (0..size * size).map(|i| {
                let (x, y) = (f64::from(i % size) * apart_m, f64::from(i / size) * apart_m);
                let wall = (x - 12.0).abs() <= f64::max(thick / 2.0, 0.05) && y < 20.0;
                if wall { 0.5 } else { 0.0 }
            });
            let posts = Posts { apart_m: [apart_m; 2], ..Posts::default() };
            let elevation = Elevation::new(size, size, heights.collect(), posts).unwrap();
            let map = Map::over(elevation, lattice, 1.0, Ground::Surface).unwrap();
            let [from, to] = [[4.0, 20.0], [20.0, 20.0]].map(|point| map.cell_at_m(point));
            let terrain = map.terrain_for(&Robot::default()).unwrap();
            let route = terrain.wave(to).unwrap().route(from);
            assert_eq!(route.outcome(), Outcome::Arrived);
            let straight = map.wave(to).unwrap().route(from);
            assert!(route.steps() > straight.steps() + 10, "{lattice} {thick}");
            assert_eq!(check_slopes(&map, &Robot::default(), route.cells()), Ok(()));
            let fault = check_slopes(&map, &Robot::default(), straight.cells());
            assert!(matches!(fault, Err(RouteFault::Closed(..))));
            let fault = check_terrain_route(&terrain, straight.cells(), from, to);
            assert!(matches!(fault, Err(RouteFault::Closed(..) | RouteFault::Blocked(..))));
            // A robot that climbs anything goes straight over it.
            let slopes = Slopes {
                up_max_deg: 80.0,
                down_max_deg: 80.0,
                across_max_deg: 80.0,
                climb_cost_m_per_m: 0.0,
            };
            let climber = Robot { slopes, ..Robot::default() };
            let over = map.terrain_for(&climber).unwrap().wave(to).unwrap().route(from);
            assert_eq!(over.steps(), straight.steps());
        }
    }
}

#[test]
fn climbing_costs_energy_and_nothing_comes_back() {
    let map = Map::parse(Lattice::Square, "..........").unwrap();
    let sloped = map.clone().elevated(ramp(5.0, 0.0), Ground::Surface);
    let robot = Robot::default();
    let energy_j = |map: &Map, from: i32, to: i32| {
        let route = map.route(Rule::Wave, Cell::new(from, 0), Cell::new(to, 0), 100).unwrap();
        route.program(&robot, map, None).effort(&robot).energy_j
    };
    let climb_j = 3.0 * 9.806_65 * 9.0 * 5f64.to_radians().tan() / robot.power.drive_efficiency;
    assert!((energy_j(&sloped, 0, 9) - energy_j(&sloped, 9, 0) - climb_j).abs() < 1e-3);
    assert!(energy_j(&sloped, 9, 0) > energy_j(&map, 9, 0));
}

#[test]
fn flat_ground_is_plain_and_bad_ground_is_refused() {
    let flat = Elevation::new(1, 1, vec![7.0], Posts { apart_m: [9.0, 9.0], ..Posts::default() }).unwrap();
    for lattice in Lattice::ALL {
        let plain = Map::random(lattice, 7, 7, 0.2, 3).unwrap();
        let map = plain.clone().elevated(flat.clone().laid_over(&plain).unwrap(), Ground::Surface);
        assert_eq!(map.to_text(), plain.to_text());
        let (to, robot) = (plain.free().next().unwrap(), Robot::default());
        let field = map.terrain_for(&robot).unwrap().wave(to).unwrap();
        for cell in plain.free() {
            let steps = plain.wave(to).unwrap().steps(cell);
            assert_eq!(field.cost(cell), steps.map(|steps| steps * u32::from(Terrain::CELL_COST)));
        }
    }
    for (columns, rows, heights) in [(0, 1, vec![]), (2, 2, vec![0.0; 3]), (1, 1, vec![f32::INFINITY])] {
        let refused = Elevation::new(columns, rows, heights, Posts::default());
        assert!(matches!(refused, Err(Error::BadValue { .. })));
    }
    let huge = Elevation::new(u32::MAX, u32::MAX, Vec::new(), Posts::default());
    assert!(matches!(huge, Err(Error::BadValue { .. })));
    for posts in [
        Posts { apart_m: [0.0, 1.0], ..Posts::default() },
        Posts { corner_m: [f64::NAN, 0.0], ..Posts::default() },
        Posts { yaw_rad: f64::INFINITY, ..Posts::default() },
    ] {
        assert!(matches!(Elevation::new(1, 1, vec![0.0], posts), Err(Error::BadValue { .. })));
    }
}
