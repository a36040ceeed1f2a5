//! Steps of the arbiter keep the rules whatever it is told, and it always finds one if it is told nothing.

use activecell::{Cell, Lattice, Map, Plan, Rng, Team, check_plan};
use activecell_fleet::{Arbiter, Fields, Floor, NONE};

fn draw(cells: &[u32], count: usize, rng: &mut Rng) -> Vec<u32> {
    let mut cells = cells.to_vec();
    rng.shuffle(&mut cells);
    cells.truncate(count);
    cells
}

/// Whether a step from `now` to `next` keeps the rules, by the checker of plans.
fn is_allowed(map: &Map, floor: &Floor, now: &[u32], next: &[u32]) -> bool {
    let cells = |numbers: &[u32]| numbers.iter().map(|&number| floor.cell(number)).collect::<Vec<Cell>>();
    let (now, next) = (cells(now), cells(next));
    let team = Team::new(map, now.clone(), next.clone());
    let plan = Plan::new(now.len(), [now, next].concat());
    team.is_ok_and(|team| plan.is_ok_and(|plan| check_plan(map, &team, &plan).is_ok()))
}

#[test]
fn every_step_keeps_the_rules() {
    let (mut steps, mut refused) = (0, 0);
    for seed in 0..600 {
        let mut rng = Rng::new(seed);
        let lattice = Lattice::ALL[seed as usize % 2];
        let map = Map::random(lattice, 2 + rng.below(18), 2 + rng.below(18), 0.2, seed).unwrap();
        let floor = Floor::new(&map);
        let free: Vec<u32> = map.free().map(|cell| floor.number(cell)).collect();
        // All in one part of the floor: fields say nothing of others.
        let Some(&origin) = free.first() else { continue };
        let part: Vec<u32> = free.into_iter().filter(|&cell| floor.connected(cell, origin)).collect();
        let robots = 1 + rng.below(part.len() as u32) as usize;
        let (mut now, targets) = (draw(&part, robots, &mut rng), draw(&part, robots, &mut rng));
        let mut fields = Fields::new(&floor);
        let goals = fields.goals(&floor, &targets, 1).unwrap();
        let mut arbiter = Arbiter::new(&floor, &fields, goals, seed);
        arbiter.shy = rng.chance(0.5);
        let mut next = vec![NONE; robots];
        for _ in 0..20 {
            let order = draw(&(0..robots as u32).collect::<Vec<_>>(), robots, &mut rng);
            let told = rng.below(4).min(robots as u32) as usize * usize::from(rng.chance(0.5));
            let fixed: Vec<(u32, u32)> = order[..told]
                .iter()
                .map(|&robot| {
                    let here = now[robot as usize];
                    let links = floor.links(here);
                    (robot, links.get(rng.below(5) as usize).copied().unwrap_or(here))
                })
                .collect();
            // Wishes may be any cell, also one that does not touch the robot's.
            arbiter.wishes = if rng.chance(0.5) { draw(&part, robots, &mut rng) } else { Vec::new() };
            let settled = arbiter.step(&now, &mut next, &order, &fixed);
            assert!(settled || told > 0, "{lattice} {seed}: no step, though nobody was told where to go");
            if settled {
                assert!(is_allowed(&map, &floor, &now, &next), "{lattice} {seed}");
                assert!(fixed.iter().all(|&(robot, cell)| next[robot as usize] == cell));
                std::mem::swap(&mut now, &mut next);
            }
            (steps, refused) = (steps + 1, refused + usize::from(!settled));
        }
    }
    println!("{steps} steps, {refused} of them impossible as told");
    assert!(steps > 10_000 && refused > 100);
}

/// On a floor without dead ends or walls near, the first in order comes nearer whatever stands in its way.
#[test]
fn the_first_in_order_comes_nearer() {
    for seed in 0..200 {
        let mut rng = Rng::new(seed);
        let map = Map::random(Lattice::ALL[seed as usize % 2], 9, 8, 0.0, seed).unwrap();
        let floor = Floor::new(&map);
        let cells: Vec<u32> = map.free().map(|cell| floor.number(cell)).collect();
        let robots = 1 + rng.below(cells.len() as u32) as usize;
        let (now, targets) = (draw(&cells, robots, &mut rng), draw(&cells, robots, &mut rng));
        let mut fields = Fields::new(&floor);
        let goals = fields.goals(&floor, &targets, 2).unwrap();
        let mut arbiter = Arbiter::new(&floor, &fields, goals.clone(), seed);
        let (mut next, order) = (vec![NONE; robots], (0..robots as u32).collect::<Vec<_>>());
        assert!(arbiter.step(&now, &mut next, &order, &[]));
        let distance = |cell: u32| fields.steps(&floor, goals[0].slot, cell);
        assert_eq!(distance(next[0]), distance(now[0]).saturating_sub(1), "{seed}");
    }
}
