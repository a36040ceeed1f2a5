//! Closures and the wave in space-time against plain twins, on random floors with random objects.

#![expect(clippy::unwrap_used, reason = "a test may stop at the first surprise")]

use activecell::predict::{Bounds, Closures, Plan, Slots, Step, Track};
use activecell::{Cell, Dir, Field, Frame, Lattice, Map, Rng};
use std::collections::BTreeSet;

struct World {
    map: Map,
    cell: Cell,
    field: Field,
    slots: Slots,
    tracks: Vec<Track>,
    now_s: f64,
}

fn worlds(count: u64) -> impl Iterator<Item = World> {
    (0..count).filter_map(|seed| {
        let mut rng = Rng::new(seed);
        let lattice = Lattice::ALL[seed as usize % 2];
        let (width, height) = (3 + rng.below(14), 3 + rng.below(10));
        let frame = Frame { cell_m: 0.5 + rng.unit(), origin_m: [-3.0, 2.0], yaw_rad: 0.3 * rng.normal() };
        let density = 0.3 * rng.unit();
        let map = Map::random(lattice, width, height, density, seed).unwrap().in_frame(frame).unwrap();
        let free: Vec<Cell> = map.free().collect();
        let mut pick = || free.get(rng.below(free.len().max(1) as u32) as usize).copied();
        let (cell, target) = (pick()?, pick()?);
        let certain = 1 + rng.below(6) as u8;
        let slots = Slots {
            slot_s: 0.5 + rng.unit(),
            robot_radius_m: 0.3 * frame.cell_m * rng.unit(),
            certain,
            likely: rng.below(8) as u8,
            ..Slots::default()
        };
        let tracks = (0..=rng.below(3)).map(|_| {
            let bounds = Bounds {
                radius_m: 0.5 * rng.unit(),
                max_speed_mps: 1.5 * rng.unit(),
                max_accel_mps2: 0.3 * rng.unit(),
                seen_within_m: 0.02,
            };
            let mut track = Track::new(bounds).unwrap();
            let mut at = map.centre_m(free[rng.below(free.len() as u32) as usize]);
            let velocity: [f64; 2] = std::array::from_fn(|_| (rng.unit() - 0.5) * bounds.max_speed_mps);
            for i in 0..rng.below(12) {
                track.observe(0.25 * f64::from(i), at).unwrap();
                at = std::array::from_fn(|k| at[k] + 0.25 * velocity[k]);
            }
            track
        });
        let tracks = tracks.collect();
        Some(World { field: map.wave(target).unwrap(), map, cell, slots, tracks, now_s: 3.0 })
    })
}

fn ways(map: &Map) -> impl Iterator<Item = Option<Dir>> {
    std::iter::once(None).chain(map.lattice().dirs().map(Some))
}

/// Cell by cell and slot by slot: where it can be reached, and from where the end; and how many slots are safe.
fn fronts(map: &Map, closures: &Closures, cell: Cell, certain: usize) -> (Vec<BTreeSet<Cell>>, usize) {
    let next = |slot: usize, from: Cell, sure: usize| -> Vec<Cell> {
        let closed = |way| {
            if slot < sure {
                closures.is_closed(slot, from, way)
            } else {
                closures.is_likely_closed(slot, from, way)
            }
        };
        ways(map)
            .filter(|&way| !closed(way))
            .map(|way| way.map_or(from, |dir| map.lattice().neighbour(from, dir)))
            .filter(|&to| map.is_free(to))
            .collect()
    };
    let mut fronts = vec![BTreeSet::from([cell])];
    let mut sure = certain;
    for slot in 0..closures.slots() {
        let front = |sure| -> BTreeSet<Cell> {
            fronts[slot].iter().flat_map(|&from| next(slot, from, sure)).collect()
        };
        let mut found = front(sure);
        if found.is_empty() && slot < sure {
            sure = slot;
            found = front(sure);
        }
        if found.is_empty() {
            break;
        }
        fronts.push(found);
    }
    for slot in (0..fronts.len() - 1).rev() {
        let after = fronts[slot + 1].clone();
        fronts[slot].retain(|&from| next(slot, from, sure).iter().any(|to| after.contains(to)));
    }
    (fronts, sure)
}

fn check(world: &World, closures: &Closures, plan: &Plan) {
    let World { map, cell, field, slots, .. } = world;
    let (fronts, sure) = fronts(map, closures, *cell, slots.certain.into());
    let last = fronts.len() - 1;
    assert_eq!(plan.cells().len(), fronts.len());
    assert_eq!(plan.safe_slots(), sure);
    assert_eq!(plan.is_safe(), sure == usize::from(slots.certain));
    let early = fronts.iter().position(|front| front.iter().any(|&cell| field.steps(cell) == Some(0)));
    let late = fronts[last].iter().filter_map(|&cell| field.steps(cell)).min();
    let arrival = early.map_or(late.map(|rest| rest + last as u32), |slot| Some(slot as u32));
    assert_eq!(plan.arrival_slots(), arrival);
    assert_eq!(plan.cells()[0], *cell);
    for (slot, pair) in plan.cells().windows(2).enumerate() {
        let way = map.lattice().dir_between(pair[0], pair[1]);
        assert!(way.is_some() || pair[0] == pair[1], "{pair:?}");
        assert!(map.is_free(pair[1]) && !closures.is_likely_closed(slot, pair[0], way));
        assert!(slot >= sure || !closures.is_closed(slot, pair[0], way));
    }
    if let (Some(slot), true) = (early, last > 0) {
        assert_eq!(field.steps(plan.cells()[slot]), Some(0));
    } else if let Some(rest) = late {
        assert_eq!(field.steps(plan.cells()[last]), Some(rest));
    }
    assert_eq!(plan.step() == Step::NoSafeStep, sure == 0);
}

#[test]
fn the_wave_finds_what_a_plain_search_finds() {
    let (mut plans, mut unsafe_ones, mut detours, mut unreachable) = (0, 0, 0, 0);
    for world in worlds(6000) {
        let World { map, cell, field, slots, tracks, now_s } = &world;
        let closures = Closures::new(map, *cell, *slots, *now_s, tracks).unwrap();
        let plan = closures.plan(*cell, |cell| field.steps(cell));
        check(&world, &closures, &plan);
        plans += 1;
        unsafe_ones += usize::from(!plan.is_safe());
        detours += usize::from(plan.arrival_slots() > field.steps(*cell));
        unreachable += usize::from(plan.arrival_slots().is_none());
    }
    println!(
        "{plans} plans, {unsafe_ones} not safe to the end, {detours} later than alone, {unreachable} without a way"
    );
    assert!(plans > 5500 && unsafe_ones > 300 && detours > 300 && unreachable > 100);
}

/// Objects drawn at random among all that the bounds allow: wherever one touches the robot, it is closed.
#[test]
fn what_an_object_may_touch_is_closed() {
    let (mut touched, mut closed) = (0, 0);
    for (seed, world) in worlds(1200).enumerate() {
        let World { map, cell, slots, tracks, now_s, .. } = &world;
        let track = &tracks[0];
        if track.seen_s().is_none() {
            continue;
        }
        let closures =
            Closures::new(map, *cell, Slots { likely: 0, ..*slots }, *now_s, &tracks[..1]).unwrap();
        let mut rng = Rng::new(seed as u64);
        // In its last slot the robot leaves a cell that is one step less away.
        let reach = u32::from(slots.certain) - 1;
        let near: Vec<Cell> =
            map.free().filter(|&other| map.lattice().distance(*cell, other) <= reach).collect();
        for _ in 0..200 {
            let (slot, part) = (rng.below(u32::from(slots.certain)), rng.unit());
            let from = near[rng.below(near.len() as u32) as usize];
            let way = ways(map).nth(rng.below(u32::from(map.lattice().degree()) + 1) as usize).unwrap();
            let to = way.map_or(from, |dir| map.lattice().neighbour(from, dir));
            if !map.is_free(to) {
                continue;
            }
            let (a, b) = (map.centre_m(from), map.centre_m(to));
            let robot: [f64; 2] = std::array::from_fn(|k| a[k] + (b[k] - a[k]) * rng.unit());
            let time_s = now_s + slots.slot_s * (f64::from(slot) + part);
            // A place of the object that would touch the robot.
            let (far, angle) =
                ((slots.robot_radius_m + track.bounds().radius_m) * rng.unit(), 6.3 * rng.unit());
            let object = [robot[0] + far * angle.cos(), robot[1] + far * angle.sin()];
            let is_closed = closures.is_closed(slot as usize, from, way);
            closed += usize::from(is_closed);
            if track.may_be_at(time_s, object) {
                touched += 1;
                assert!(is_closed, "{slot} {from} {way:?}: {time_s} {object:?}");
            }
        }
    }
    println!("{touched} touches, all closed; {closed} closed in all");
    assert!(touched > 10_000 && closed < 3 * touched);
}
