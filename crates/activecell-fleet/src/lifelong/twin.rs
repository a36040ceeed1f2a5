//! The wave through the window against its naive twin: all places at all steps, one by one.

use super::distances::{Distances, View};
use super::ground::{Ground, Place};
use super::reach::{Goal, Look, Reach};
use super::window::Window;
use crate::floor::Floor;
use activecell::{Lattice, Map, Moves, Rng};
use std::collections::BTreeSet;

/// Where a robot can be a step later, others aside.
fn ways(ground: &Ground, place: Place) -> Vec<Place> {
    let (spot, heading) = (place.spot(), place.heading());
    let ahead = |dir: u32| Place::new(ground.ahead(spot, dir), if ground.headings() > 1 { dir } else { 0 });
    let mut ways = vec![place];
    if ground.headings() == 1 {
        ways.extend(Ground::directions(ground.open(spot)).map(ahead));
    } else {
        ways.extend([-1, 1].map(|by| Place::new(spot, ground.turned(heading, by))));
        ways.extend(Ground::directions(ground.open(spot) & 1 << heading).map(ahead));
    }
    ways
}

fn meets(others: &[Vec<Place>], step: usize, from: Place, to: Place) -> bool {
    others.iter().any(|other| {
        let (now, then) = (other[step].spot(), other[step + 1].spot());
        then == to.spot() || from.spot() != to.spot() && now == to.spot() && then == from.spot()
    })
}

/// All places at the end of the steps, from these places.
fn spread(ground: &Ground, others: &[Vec<Place>], from: &BTreeSet<Place>, step: usize) -> BTreeSet<Place> {
    let next = from.iter().flat_map(|&place| ways(ground, place).into_iter().map(move |way| (place, way)));
    next.filter(|&(place, way)| !meets(others, step, place, way)).map(|(_, way)| way).collect()
}

/// The cost as the wave counts it.
fn cost(ground: &Ground, others: &[Vec<Place>], start: Place, goal: &Goal<'_>, steps: usize) -> Option<u32> {
    let nearest = |places: &BTreeSet<Place>, view: View<'_>| {
        places.iter().map(|place| u32::from(view.at(ground, place.spot(), place.heading()))).min()
    };
    let mut places = BTreeSet::from([start]);
    for step in 0..steps {
        places = spread(ground, others, &places, step);
        let mut there: BTreeSet<Place> =
            places.iter().copied().filter(|place| place.spot() == goal.target).collect();
        for later in step + 1..steps {
            there = spread(ground, others, &there, later);
        }
        if !there.is_empty() {
            let after = |(view, leg): (View<'_>, u32)| {
                (steps as u32 + nearest(&there, view).expect("a place")).saturating_sub(leg)
            };
            return Some(goal.next.map_or(step as u32 + 1, after));
        }
    }
    Some(steps as u32 + nearest(&places, goal.view)?)
}

#[test]
fn the_wave_through_the_window_finds_what_a_naive_search_finds() {
    let mut rng = Rng::new(11);
    let (mut found, mut arrived) = (0, 0);
    for case in 0..2000 {
        let lattice = Lattice::ALL[case % 2];
        let moves = [Moves::Omni, Moves::Turning][case / 2 % 2];
        let width = 1 + rng.below(if case % 10 == 0 { 150 } else { 9 });
        let map = Map::random(lattice, width, 1 + rng.below(8), 0.2, rng.next_u64()).expect("a map");
        let ground = Ground::new(&map, moves);
        let cells: Vec<_> = map.free().collect();
        if cells.is_empty() {
            continue;
        }
        let steps = 1 + rng.below(12) as usize;
        let any = |rng: &mut Rng| {
            let cell = cells[rng.below(cells.len() as u32) as usize];
            Place::new(ground.spot(cell), rng.below(ground.headings()))
        };
        let mut window = Window::new(&ground, steps);
        let mut others: Vec<Vec<Place>> = Vec::new();
        for robot in 0..rng.below(1 + cells.len() as u32 / 2) {
            let mut path = vec![any(&mut rng)];
            for step in 0..steps {
                let ways = ways(&ground, path[step]);
                path.push(ways[rng.below(ways.len() as u32) as usize]);
            }
            let clash = |step: usize| meets(&others, step, path[step], path[step + 1]);
            let on_start = others.iter().any(|other| other[0].spot() == path[0].spot());
            if !on_start && !(0..steps).any(clash) {
                window.reserve(&ground, &path, robot);
                others.push(path);
            }
        }
        let [start, target, after] = [0; 3].map(|_| any(&mut rng));
        if others.iter().any(|other| other[0].spot() == start.spot()) || start.spot() == target.spot() {
            continue;
        }
        let mut distances = Distances::new(&ground, Floor::new(&map), 1, steps);
        let slots = [target, after].map(|place| distances.request(&ground, 0, place.spot()));
        let [view, next] = slots.map(|slot| distances.view(&ground, slot));
        let leg = u32::from(next.at(&ground, target.spot(), 0)).min(5);
        let goal = Goal { target: target.spot(), view, next: (case % 3 == 0).then_some((next, leg)) };
        let mut path = vec![Place::default(); steps + 1];
        let look = Look { ground: &ground, window: &window, chance: rng.next_u64() };
        let got = Reach::new(&ground, steps).find(look, start, Some(&goal), &mut path);
        assert_eq!(got, cost(&ground, &others, start, &goal, steps), "case {case}");
        if got.is_some() {
            found += 1;
            arrived += usize::from(path.iter().any(|place| place.spot() == target.spot()));
            assert_eq!(path[0], start);
            for step in 0..steps {
                assert!(ways(&ground, path[step]).contains(&path[step + 1]));
                assert!(!meets(&others, step, path[step], path[step + 1]));
            }
        }
    }
    println!("{found} paths, {arrived} of them to the target: each costs what a naive search says");
    assert!(found > 800 && arrived > 200);
}
