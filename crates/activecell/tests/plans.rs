//! The checker of plans: accepts walks that keep the rules, and finds every kind of tampering where it is.

#![expect(clippy::unwrap_used, reason = "a test that cannot make its map should stop")]

use activecell::{Cell, Error, Lattice, Map, Plan, PlanFault, Rng, Team, check_plan};
use std::collections::BTreeSet;

/// Robots that walk at random by the rules, and the team whose plan that is.
fn walk(lattice: Lattice, seed: u64) -> Option<(Map, Team, Plan)> {
    let mut rng = Rng::new(seed);
    let map = Map::random(lattice, 2 + rng.below(6), 2 + rng.below(6), 0.2, seed).unwrap();
    let mut free: Vec<Cell> = map.free().collect();
    let robots = (1 + rng.below(6) as usize).min(free.len());
    if robots == 0 {
        return None;
    }
    rng.shuffle(&mut free);
    let mut cells = free[..robots].to_vec();
    for step in 0..rng.below(12) as usize {
        let now = cells[step * robots..].to_vec();
        let mut next: Vec<Cell> = Vec::new();
        for robot in 0..robots {
            let dirs: Vec<_> = lattice.dirs().collect();
            let to = lattice.neighbour(now[robot], dirs[rng.below(dirs.len() as u32) as usize]);
            let stands = now.iter().position(|&cell| cell == to);
            // Into free cells, or after a robot that has moved on elsewhere.
            let left =
                stands.is_none_or(|other| other < robot && next[other] != to && next[other] != now[robot]);
            let wanted = now[robot + 1..].contains(&to) || next.contains(&to);
            next.push(if map.is_free(to) && left && !wanted { to } else { now[robot] });
        }
        // A robot that stayed may have been followed into: then all stay.
        let distinct: BTreeSet<_> = next.iter().collect();
        cells.extend(if distinct.len() == robots { &next } else { &now });
    }
    let (starts, ends) = (cells[..robots].to_vec(), cells[cells.len() - robots..].to_vec());
    Some((map.clone(), Team::new(&map, starts, ends).unwrap(), Plan::new(robots, cells).unwrap()))
}

fn tampered(plan: &Plan, step: usize, robot: usize, cell: Cell) -> Plan {
    let mut cells: Vec<Cell> = plan.rows().flatten().copied().collect();
    cells[step * plan.robots() + robot] = cell;
    Plan::new(plan.robots(), cells).unwrap()
}

#[test]
fn every_tampering_with_one_cell_is_found_where_it_is() {
    let (mut accepted, mut outside, mut blocked, mut jumps, mut collisions) = (0, 0, 0, 0, 0);
    for seed in 0..2000 {
        let Some((map, team, plan)) = walk(Lattice::ALL[seed as usize % 2], seed) else { continue };
        assert_eq!(check_plan(&map, &team, &plan), Ok(()), "{seed}");
        accepted += 1;
        let mut rng = Rng::new(!seed);
        if plan.steps() < 2 {
            continue;
        }
        let step = 1 + rng.below(plan.steps() as u32 - 1) as usize;
        let robot = rng.below(plan.robots() as u32) as usize;
        let from = plan.at(step - 1, robot);

        let off = Cell::new(-1, rng.below(9) as i32);
        let fault = check_plan(&map, &team, &tampered(&plan, step, robot, off)).unwrap_err();
        assert_eq!(fault, PlanFault::Outside { step, robot, cell: off });
        outside += 1;

        let wall = (0..map.width() as i32)
            .flat_map(|x| (0..map.height() as i32).map(move |y| Cell::new(x, y)))
            .find(|&cell| !map.is_free(cell));
        if let Some(cell) = wall {
            let fault = check_plan(&map, &team, &tampered(&plan, step, robot, cell)).unwrap_err();
            assert_eq!(fault, PlanFault::Blocked { step, robot, cell });
            blocked += 1;
        }
        let far = map.free().find(|&cell| map.lattice().distance(from, cell) > 1);
        if let Some(to) = far {
            let fault = check_plan(&map, &team, &tampered(&plan, step, robot, to)).unwrap_err();
            assert_eq!(fault, PlanFault::Jump { step, robot, from, to });
            jumps += 1;
        }
        let near =
            |other: &usize| *other != robot && map.lattice().distance(from, plan.at(step, *other)) <= 1;
        if let Some(other) = (0..plan.robots()).find(near) {
            let cell = plan.at(step, other);
            let fault = check_plan(&map, &team, &tampered(&plan, step, robot, cell)).unwrap_err();
            let pair = [robot.min(other), robot.max(other)];
            match fault {
                PlanFault::Collision { step: at, robots, cell: where_ } => {
                    assert_eq!((at, robots, where_), (step, pair, cell));
                }
                // Who is led into a cell may also swap with the one that comes from there; both are true.
                PlanFault::Swap { step: at, robots, .. } => {
                    assert!(at == step && robots.contains(&robot), "{fault}");
                }
                _ => panic!("{fault}"),
            }
            collisions += 1;
        }
    }
    println!(
        "{accepted} accepted; found: {outside} outside, {blocked} in walls, {jumps} jumps, {collisions} meetings"
    );
    assert!(accepted > 1900 && [outside, blocked, jumps, collisions].iter().all(|&count| count > 300));
}

#[test]
fn starts_targets_and_numbers_are_checked() {
    for seed in 0..300 {
        let Some((map, team, plan)) = walk(Lattice::ALL[seed as usize % 2], seed) else { continue };
        let Some(spare) =
            map.free().find(|cell| !team.starts().contains(cell) && !team.targets().contains(cell))
        else {
            continue;
        };
        let robot = seed as usize % team.robots();
        let mut other = team.starts().to_vec();
        let cell = std::mem::replace(&mut other[robot], spare);
        let wrong = Team::new(&map, other, team.targets().to_vec()).unwrap();
        let fault = PlanFault::WrongStart { robot, cell, start: spare };
        assert_eq!(check_plan(&map, &wrong, &plan), Err(fault));

        let mut other = team.targets().to_vec();
        let cell = std::mem::replace(&mut other[robot], spare);
        let wrong = Team::new(&map, team.starts().to_vec(), other).unwrap();
        assert_eq!(
            check_plan(&map, &wrong, &plan),
            Err(PlanFault::NotArrived { robot, cell, target: spare })
        );

        let fewer = Team::new(&map, team.starts()[1..].to_vec(), team.targets()[1..].to_vec()).unwrap();
        let fault = PlanFault::Robots { plan: team.robots(), team: team.robots() - 1 };
        assert_eq!(check_plan(&map, &fewer, &plan), Err(fault));
    }
}

#[test]
fn a_swap_is_refused_and_a_ring_may_turn() {
    let map = Map::parse(Lattice::Square, "..\n..").unwrap();
    let ring = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(x, y)| Cell::new(x, y));
    let turned = [ring[1], ring[2], ring[3], ring[0]];
    let team = Team::new(&map, ring.to_vec(), turned.to_vec()).unwrap();
    let plan = Plan::new(4, [ring, turned].concat()).unwrap();
    assert_eq!(check_plan(&map, &team, &plan), Ok(()));
    assert_eq!((plan.sum_of_costs(), plan.makespan()), (4, 1));

    let pair = Team::new(&map, ring[..2].to_vec(), vec![ring[1], ring[0]]).unwrap();
    let plan = Plan::new(2, vec![ring[0], ring[1], ring[0], ring[1], ring[1], ring[0]]).unwrap();
    let fault = PlanFault::Swap { step: 2, robots: [0, 1], cells: [ring[1], ring[0]] };
    assert_eq!(check_plan(&map, &pair, &plan), Err(fault));
}

#[test]
fn teams_that_cannot_be_are_refused_with_the_robot() {
    let map = Map::parse(Lattice::Hex, "..#\n...").unwrap();
    let [a, b, wall, off] = [(0, 0), (1, 0), (2, 0), (7, 0)].map(|(x, y)| Cell::new(x, y));
    let team =
        |starts: &[Cell], targets: &[Cell]| Team::new(&map, starts.to_vec(), targets.to_vec()).unwrap_err();
    assert_eq!(team(&[a], &[]), Error::TeamSize { starts: 1, targets: 0, free: 5 });
    assert_eq!(team(&[a, b], &[b, b]), Error::SharedTarget { robots: [0, 1], cell: b });
    assert_eq!(team(&[b, b], &[a, b]), Error::SharedStart { robots: [0, 1], cell: b });
    assert!(
        team(&[a, wall], &[b, a]).to_string().starts_with("robot 1: the start (2,0) lies in an obstacle")
    );
    assert!(matches!(team(&[a], &[off]), Error::OfRobot { robot: 0, .. }));
    assert!(matches!(Plan::new(3, vec![a; 4]), Err(Error::PlanSize { robots: 3, cells: 4 })));
    assert!(Plan::new(3, Vec::new()).is_err() && Plan::new(0, Vec::new()).is_ok());
    let nobody = Team::new(&map, Vec::new(), Vec::new()).unwrap();
    assert_eq!(check_plan(&map, &nobody, &Plan::new(0, Vec::new()).unwrap()), Ok(()));
}
