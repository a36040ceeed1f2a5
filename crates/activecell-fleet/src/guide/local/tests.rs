//! The search of a window against every way there is.

use super::*;
use crate::{Fields, Floor};
use activecell::{Lattice, Map};
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// The least cost of a way through the window, layer by layer, from the others' ways one by one.
fn naive(local: &Local<'_>, robot: u32, start: u32, hurried: bool, lead: &[u32]) -> u32 {
    let Problem { floor, fields, goals, .. } = local.problem;
    let goal = goals[robot as usize];
    let [stay, rest] = [STAY, REST].map(|prices| prices[usize::from(hurried)]);
    let others: Vec<u32> = (0..goals.len() as u32).filter(|&other| other != robot).collect();
    let walks = |other: u32| matches!(local.states[other as usize], State::Calm | State::Restless);
    let mut layer = BTreeMap::from([(start, 0)]);
    for time in local.time..local.time + local.window {
        let mut next = BTreeMap::new();
        for (&here, &cost) in &layer {
            for &there in floor.links(here).iter().chain([&here]) {
                let rise = match fields.field(goal.slot).compare(here, there) {
                    _ if here == there => {
                        if here == goal.target {
                            0
                        } else {
                            stay
                        }
                    }
                    Ordering::Less => 0,
                    Ordering::Equal => 1,
                    Ordering::Greater => 2,
                };
                let pair = lead.windows(2).find(|pair| pair[0] == here).filter(|_| here != there);
                let rise = pair.map_or(rise, |pair| if pair[1] == there { 0 } else { rise.max(1) });
                let at = |other, time| local.table.cell(other, time);
                let collides = others.iter().any(|&other| {
                    walks(other)
                        && (at(other, time + 1) == there
                            || here != there && (at(other, time), at(other, time + 1)) == (there, here))
                });
                let rests = others.iter().any(|&other| {
                    local.states[other as usize] == State::Resting && goals[other as usize].target == there
                });
                let price = u32::from(collides) * COLLISION + u32::from(rests) * rest;
                let least = next.entry(there).or_insert(u32::MAX);
                *least = (*least).min(cost + rise + price);
            }
        }
        layer = next;
    }
    layer.into_values().min().unwrap()
}

/// Any other cell of the floor's largest part for each robot, no two alike.
fn draw(cells: &[u32], count: usize, rng: &mut Rng) -> Vec<u32> {
    let mut cells = cells.to_vec();
    rng.shuffle(&mut cells);
    cells.truncate(count);
    cells
}

#[test]
fn no_way_through_the_window_costs_less() {
    let (mut ways, mut collided) = (0, 0);
    for seed in 0..60 {
        let mut rng = Rng::new(seed);
        let map = Map::random(Lattice::ALL[seed as usize % 2], 12, 9, 0.2, seed).unwrap();
        let floor = Floor::new(&map);
        let free: Vec<u32> = map.free().map(|cell| floor.number(cell)).collect();
        let part: Vec<u32> =
            free.iter().copied().filter(|&cell| floor.connected(cell, free[free.len() / 2])).collect();
        let robots = 1 + rng.below(part.len() as u32 / 2 + 1) as usize;
        let (starts, targets) = (draw(&part, robots, &mut rng), draw(&part, robots, &mut rng));
        let robots = starts.len();
        let mut fields = Fields::new(&floor);
        let goals = fields.goals(&floor, &targets, 1).unwrap();
        let problem = Problem { floor: &floor, fields: &fields, goals: &goals, starts: &starts };
        let mut local = Local::new(problem, 1 + rng.below(8), seed);
        let ahead = problem.distances();
        let mut ways_beforehand = rng.chance(0.5).then(|| Ways::new(problem, &ahead, seed, &|| false));
        let mut now = starts.clone();
        let mut wishes = Vec::new();
        for _ in 0..6 {
            let order = draw(&(0..robots as u32).collect::<Vec<_>>(), robots, &mut rng);
            let hurried: Vec<bool> = (0..robots).map(|_| rng.chance(0.3)).collect();
            if let Some(known) = &mut ways_beforehand {
                known.follow(&now);
            }
            local.advise(&now, &order, &hurried, ways_beforehand.as_ref(), &mut wishes);
            // Each robot once more, among the ways of all others as they are now.
            local.time -= 1;
            for robot in 0..robots as u32 {
                if local.states[robot as usize] == State::Resting {
                    continue;
                }
                local.withdraw(robot, local.time..local.time + local.window + 1);
                local.states[robot as usize] = State::Lost;
                let lead = ways_beforehand.as_ref().map_or(&[][..], |known| known.rest(robot as usize));
                let lead = &lead[..lead.len().min(2 * local.window as usize)];
                let (here, hurried) = (now[robot as usize], hurried[robot as usize]);
                let least = naive(&local, robot, here, hurried, lead);
                assert_eq!(local.search(robot, here, hurried, lead), least, "seed {seed}, robot {robot}");
                (ways, collided) = (ways + 1, collided + usize::from(least > 0));
            }
            local.time += 1;
            // Some go along their ways, as far as nobody stands there, others stay.
            for robot in 0..robots {
                let wish = wishes[robot];
                if wish != NONE
                    && floor.links(now[robot]).contains(&wish)
                    && !now.contains(&wish)
                    && rng.chance(0.8)
                {
                    now[robot] = wish;
                }
            }
        }
    }
    println!("{ways} ways, {collided} of them with a detour, a wait or a collision");
    assert!(ways > 2_000 && collided > 500);
}
