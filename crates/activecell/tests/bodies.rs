//! Bodies, distances and closed cells: the checker against the rules written down cell by cell, and foreseen closures
//! against objects that are driven.

use activecell::predict::{Bounds, Slots, Track, first_contact};
use activecell::{
    Bodies, Cell, KeepOut, KeepOuts, Lattice, Map, Plan, PlanFault, Rng, Team, check_keep_outs, check_plan,
};

fn around(lattice: Lattice, cell: Cell) -> Vec<Cell> {
    lattice.dirs().map(|dir| lattice.neighbour(cell, dir)).chain([cell]).collect()
}

/// Two robots whose centres are at least `apart` before and after a step. Neither can go first only if they swap cells, and
/// on their straight ways they are never nearer than half a cell less than `apart`.
#[test]
fn who_keeps_apart_cannot_pass_through_each_other() {
    for lattice in Lattice::ALL {
        for (apart, here) in (1..5).flat_map(|apart| [(apart, Cell::new(0, 0)), (apart, Cell::new(0, 1))]) {
            let far = |a: Cell, b: Cell| lattice.block_distance(a, b) >= apart;
            for there in lattice.block(here, apart + 2).filter(|&there| far(here, there)) {
                for a in around(lattice, here) {
                    for b in around(lattice, there).into_iter().filter(|&b| far(a, b)) {
                        let neither_first = !far(a, there) && !far(here, b);
                        assert_eq!(
                            neither_first,
                            a == there && b == here,
                            "{lattice} {apart} {there} {a} {b}"
                        );
                        assert!(!neither_first || apart == 1);
                        // Half-way: twice the distance of the middles is that of the sums.
                        let middle = midway(lattice, [here, a], [there, b]);
                        assert!(neither_first || middle + 1e-9 >= f64::from(apart) - 0.5, "{middle} {apart}");
                    }
                }
            }
        }
    }
}

/// The block distance of the middles of two moves, in cells: the norm whose unit ball is the block.
fn midway(lattice: Lattice, a: [Cell; 2], b: [Cell; 2]) -> f64 {
    let middle = |[from, to]: [Cell; 2]| {
        let ((ax, ay), (bx, by)) = (lattice.centre(from), lattice.centre(to));
        ((ax + bx) as f64 / 2.0, (ay + by) as f64 / 2.0)
    };
    let ((ax, ay), (bx, by)) = (middle(a), middle(b));
    let (dx, dy) = ((ax - bx).abs(), (ay - by).abs());
    match lattice {
        Lattice::Square => dx.max(dy) / 2.0,
        Lattice::Hex => dy / 3.0 + (dx - dy / 3.0).max(0.0) / 2.0,
    }
}

/// The first step with a fault, by the rules as the documents have them.
fn first_bad_step(map: &Map, team: &Team, keep_outs: &KeepOuts, plan: &Plan) -> Option<usize> {
    let lattice = map.lattice();
    let covers = |robot: usize, cell: Cell| -> Vec<Cell> {
        lattice.block(cell, team.bodies().radius(robot)).collect()
    };
    let clash = |a: usize, at_a: Cell, b: usize, at_b: Cell| {
        let (a, b) = (covers(a, at_a), covers(b, at_b));
        let pairs = a.iter().flat_map(|&a| b.iter().map(move |&b| lattice.block_distance(a, b)));
        pairs.min().is_some_and(|gap| gap < team.bodies().distance())
    };
    (0..=plan.steps().max(keep_outs.last_step() as usize)).find(|&step| {
        let (from, to) = (plan.row(step.saturating_sub(1)), plan.row(step));
        let robots = 0..team.robots();
        let alone = robots.clone().any(|i| {
            let closed = |&cell: &Cell| step > 0 && keep_outs.is_closed(cell, step as u32);
            !covers(i, to[i]).iter().all(|&cell| map.is_free(cell))
                || !around(lattice, from[i]).contains(&to[i])
                || covers(i, to[i]).iter().any(closed)
        });
        alone
            || robots.clone().any(|a| {
                (0..a).any(|b| {
                    let swap = clash(a, to[a], b, from[b]) && clash(a, from[a], b, to[b]);
                    clash(a, to[a], b, to[b]) || step > 0 && swap
                })
            })
    })
}

fn step_of(fault: PlanFault) -> usize {
    match fault {
        PlanFault::Outside { step, .. }
        | PlanFault::Blocked { step, .. }
        | PlanFault::Jump { step, .. }
        | PlanFault::Collision { step, .. }
        | PlanFault::Swap { step, .. }
        | PlanFault::NoRoom { step, .. }
        | PlanFault::Closed { step, .. }
        | PlanFault::TooClose { step, .. } => step,
        _ => panic!("{fault}"),
    }
}

#[test]
fn the_checker_finds_the_first_fault_of_bodies() {
    let (mut good, mut bad) = (0, 0);
    for seed in 0..4000 {
        let mut rng = Rng::new(seed);
        let map = Map::random(Lattice::ALL[seed as usize % 2], 7, 7, 0.02, seed).unwrap();
        let free: Vec<Cell> = map.free().collect();
        let robots = 1 + rng.below(4) as usize;
        let radii: Vec<u32> = (0..robots).map(|_| rng.below(3) / 2).collect();
        let bodies = Bodies::new(radii, 1 + rng.below(3)).unwrap();
        // Random walks that mostly keep the rules for some steps.
        let mut rows =
            vec![(0..robots).map(|_| free[rng.below(free.len() as u32) as usize]).collect::<Vec<_>>()];
        for _ in 0..5 {
            let last = rows.last().unwrap().clone();
            rows.push(
                last.iter()
                    .map(|&cell| {
                        let around = around(map.lattice(), cell);
                        if rng.chance(0.8) { around[rng.below(around.len() as u32) as usize] } else { cell }
                    })
                    .collect(),
            );
        }
        let team = Team::new(&map, rows[0].clone(), rows[5].clone());
        let Ok(team) = team.and_then(|team| team.with_bodies(&map, bodies)) else { continue };
        let cell = free[rng.below(free.len() as u32) as usize];
        let keep_out = KeepOut { cell, from_step: rng.below(4), to_step: 4 + rng.below(4) };
        let keep_outs = KeepOuts::new(&map, vec![keep_out]).unwrap();
        let plan = Plan::new(robots, rows.concat()).unwrap();
        let faults = [check_plan(&map, &team, &plan), check_keep_outs(&map, &team, &keep_outs, &plan)];
        let found = faults.iter().filter_map(|fault| fault.err().map(step_of)).min();
        assert_eq!(found, first_bad_step(&map, &team, &keep_outs, &plan), "{seed} {faults:?}");
        (good, bad) = (good + u32::from(found.is_none()), bad + u32::from(found.is_some()));
    }
    println!("{good} good, {bad} bad");
    assert!(good > 200 && bad > 200, "{good} {bad}");
}

#[test]
fn who_keeps_out_of_foreseen_cells_is_not_touched() {
    let (mut moves, mut closed) = (0, 0);
    for seed in 0..300 {
        let mut rng = Rng::new(seed);
        let map = Map::random(Lattice::ALL[seed as usize % 2], 12, 12, 0.0, seed).unwrap();
        let bounds = Bounds { radius_m: 0.3, max_speed_mps: 1.5, max_accel_mps2: 1.0, seen_within_m: 0.0 };
        let slots = Slots { certain: 4, likely: 0, robot_radius_m: 0.3, ..Slots::default() };
        // An object that keeps to its bounds, in small steps; seen for a second.
        let (mut at, mut velocity) = ([2.0 + 8.0 * rng.unit(), 2.0 + 8.0 * rng.unit()], [0.7, -0.4]);
        let mut way = Vec::new();
        for step in 0..=100 {
            way.push((f64::from(step) * 0.05, at));
            let push: [f64; 2] = [rng.unit() - 0.5, rng.unit() - 0.5];
            velocity = [0, 1].map(|k| velocity[k] + 0.05 * push[k]);
            let speed = f64::hypot(velocity[0], velocity[1]);
            velocity = velocity.map(|v| if speed > 1.4 { v * 1.4 / speed } else { v });
            at = [0, 1].map(|k| at[k] + 0.05 * velocity[k]);
        }
        let mut track = Track::new(bounds).unwrap();
        for &(time_s, at_m) in way.iter().take(21).step_by(5) {
            track.observe(time_s, at_m).unwrap();
        }
        let keep_outs = KeepOuts::foreseen(&map, slots, 1.0, &[track]).unwrap();
        closed += keep_outs.all().len();
        for cell in map.free() {
            for next in around(map.lattice(), cell).into_iter().filter(|&next| map.is_free(next)) {
                for slot in 0..4 {
                    if keep_outs.is_closed(cell, slot) || keep_outs.is_closed(next, slot + 1) {
                        continue;
                    }
                    let from_s = 1.0 + f64::from(slot);
                    let robot = [(from_s, map.centre_m(cell)), (from_s + 1.0, map.centre_m(next))];
                    assert_eq!(first_contact(&robot, &way, 0.6), None, "{seed} {cell} {next} {slot}");
                    moves += 1;
                }
            }
        }
    }
    println!("{moves} moves past {closed} closed cells");
    assert!(moves > 100_000 && closed > 1000);
}
