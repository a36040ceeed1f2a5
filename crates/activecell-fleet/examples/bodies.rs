//! Bodies on a real map: `bodies MAP N DISTANCE LARGE [STRANGERS [SEED [LATTICE]]]` draws N robots, LARGE of which cover a
//! block of radius 1, that keep DISTANCE, past STRANGERS that cross the floor; looks for the first plan, and checks it.

use activecell::{Bodies, Cell, KeepOut, KeepOuts, Lattice, Map, Rng, Team, check_keep_outs, check_plan};
use activecell_fleet::{Limits, Options, solve_past};
use activecell_formats::movingai::read_map;
use std::time::Duration;

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [map, rest @ ..] = args.as_slice() else {
        return Err("bodies MAP N DISTANCE LARGE [STRANGERS [SEED [LATTICE]]]".into());
    };
    let number = |i: usize| rest.get(i).map_or(Ok(0), |text: &String| text.parse::<u32>());
    let (robots, distance, large, strangers, seed) =
        (number(0)? as usize, number(1)?, number(2)? as usize, number(3)?, u64::from(number(4)?));
    let lattice = if rest.get(5).is_some_and(|name| name == "hex") { Lattice::Hex } else { Lattice::Square };
    let map = read_map(&std::fs::read(map)?)?.on(lattice);
    let radii: Vec<u32> = (0..robots).map(|robot| u32::from(robot < large)).collect();
    let bodies = Bodies::new(radii, distance)?;
    let mut rng = Rng::new(seed + 1);
    let [starts, targets] = [0, 1].map(|_| ends(&map, &bodies, robots, &mut rng));
    let team = Team::new(&map, starts?, targets?)?.with_bodies(&map, bodies)?;
    let keep_outs = crossing(&map, strangers, &mut rng)?;
    let limits = Limits { time: Some(Duration::from_secs(60)), first: true, ..Limits::default() };
    let options = Options { seed, threads: 2, limits };
    let outcome = solve_past(&map, &team, &keep_outs, &options, |_| {})?;
    let (Some(plan), Some(first)) = (&outcome.plan, outcome.history.first()) else {
        println!("{robots} robots: no plan, {:?}; {} steps", outcome.ending, outcome.steps);
        return Ok(());
    };
    check_plan(&map, &team, plan)?;
    check_keep_outs(&map, &team, &keep_outs, plan)?;
    println!(
        "{robots} robots, {large} large, distance {distance}, {strangers} strangers: {:.1} ms, cost {} ({:.3}), makespan {}, {} steps, {:.1} MB",
        first.ms,
        first.sum_of_costs,
        first.sum_of_costs as f64 / outcome.lower_bound as f64,
        plan.makespan(),
        outcome.steps,
        outcome.bytes as f64 / 1e6,
    );
    Ok(())
}

/// Cells in the largest part of the floor of each size, where bodies keep their distances; large ones first.
fn ends(map: &Map, bodies: &Bodies, robots: usize, rng: &mut Rng) -> Result<Vec<Cell>, Failure> {
    let mut cells: Vec<Cell> = Vec::new();
    let mut floors: Vec<(u32, Vec<Cell>)> = Vec::new();
    for robot in 0..robots {
        let radius = bodies.radius(robot);
        if floors.iter().all(|floor| floor.0 != radius) {
            let own = map.for_body(radius);
            let middle = own.free().nth(own.free_cells() / 2).ok_or("no room")?;
            let part = own.wave(middle)?;
            floors.push((radius, own.free().filter(|&cell| part.steps(cell).is_some()).collect()));
        }
        let floor = &floors.iter().find(|floor| floor.0 == radius).ok_or("no floor")?.1;
        let fits = |cell: &Cell| {
            let apart = |(other, &at): (usize, &Cell)| {
                map.lattice().block_distance(*cell, at) >= bodies.apart(robot, other)
            };
            cells.iter().enumerate().all(apart)
        };
        let drawn = (0..100_000).map(|_| floor[rng.below(floor.len() as u32) as usize]).find(fits);
        cells.push(drawn.ok_or("no room for so many robots")?);
    }
    Ok(cells)
}

/// Strangers that cross the floor on shortest ways, a cell in two steps, from step 10 on: closed is the block around each
/// while it is there, two steps before and two after.
fn crossing(map: &Map, strangers: u32, rng: &mut Rng) -> Result<KeepOuts, Failure> {
    let free: Vec<Cell> = map.free().collect();
    let mut all = Vec::new();
    for _ in 0..strangers {
        let mut draw = || free[rng.below(free.len() as u32) as usize];
        let (mut at, field) = (draw(), map.wave(draw())?);
        for step in (10..).step_by(2) {
            for cell in map.lattice().block(at, 1).filter(|&cell| map.is_free(cell)) {
                all.push(KeepOut { cell, from_step: step - 2, to_step: step + 2 });
            }
            let mut around = map.lattice().dirs().map(|dir| map.lattice().neighbour(at, dir));
            let nearer = |next: &Cell| field.steps(*next).is_some_and(|steps| Some(steps) < field.steps(at));
            let Some(next) = around.find(nearer) else { break };
            at = next;
        }
    }
    Ok(KeepOuts::new(map, all)?)
}
