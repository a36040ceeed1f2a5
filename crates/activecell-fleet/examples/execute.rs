//! Plans groups by chance and executes each plan with delays: `execute MAP|random ROBOTS PLANS TRIALS [LATTICE]`. Stops at the
//! first collision or deadlock; says how much later than the plan the robots come.

use activecell::schedule::{Delays, Execution, Stop};
use activecell::{Lattice, Map, Rng, Robot, Schedule, Team, check_schedule};
use activecell_fleet::{Limits, Options, solve};
use activecell_formats::movingai::read_map;
use std::time::Instant;

type Failure = Box<dyn std::error::Error>;

/// What is measured, in steps.
#[derive(Default)]
struct Figures {
    plan: f64,
    undisturbed: f64,
    makespan: f64,
    /// Of all robots together: how much later than planned, how long held up, how long waiting.
    late: Vec<f64>,
    delayed: f64,
    waited: f64,
}

fn main() -> Result<(), Failure> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [name, robots, plans, trials, rest @ ..] = args.as_slice() else {
        return Err("execute MAP|random ROBOTS PLANS TRIALS [LATTICE]".into());
    };
    let lattice = if rest.first().is_some_and(|name| name == "hex") { Lattice::Hex } else { Lattice::Square };
    let (robots, plans, trials): (usize, u64, u64) = (robots.parse()?, plans.parse()?, trials.parse()?);
    let mut figures = Figures::default();
    let (mut rings, mut moves, mut building_ms) = (0, 0, 0.0);
    for seed in 0..plans {
        let map = match name.as_str() {
            "random" => Map::random(lattice, 24, 24, 0.1, seed)?,
            path => read_map(&std::fs::read(path)?)?.on(lattice),
        };
        let team = Team::random(&map, robots, seed)?;
        let limits = Limits { time: None, first: true, ..Limits::default() };
        let outcome = solve(&map, &team, &Options { seed, threads: 2, limits }, |_| {})?;
        let plan = outcome.plan.ok_or("no plan")?;
        let clock = Instant::now();
        let schedule = Schedule::new(&map, &plan)?;
        building_ms += clock.elapsed().as_secs_f64() * 1e3;
        check_schedule(&map, &plan, &schedule)?;
        rings += schedule.rings().len();
        moves += schedule.moves();
        figures.plan += plan.makespan() as f64;
        measure(&map, &schedule, trials, seed, &mut figures)?;
    }
    let runs = (plans * trials).max(1) as f64;
    let Figures { plan, undisturbed, makespan, late, delayed, waited } = &mut figures;
    late.sort_by(f64::total_cmp);
    let all = late.len().max(1) as f64;
    let at = |share: f64| late.get((all * share) as usize).copied().unwrap_or(0.0);
    println!(
        "{name}, {lattice}, {robots} robots: {plans} plans × {trials} runs, no collision, no deadlock, all arrive; {:.1} rings, \
         {:.0} moves, {:.1} ms to build a plan's schedule; makespan: plan {:.1}, undisturbed {:.1}, delayed {:.1}; a robot later than \
         planned: mean {:.1}, median {:.1}, 95 % {:.1}; held up {:.1}, waiting {:.1}",
        rings as f64 / plans as f64,
        moves as f64 / plans as f64,
        building_ms / plans as f64,
        *plan / plans as f64,
        *undisturbed / plans as f64,
        *makespan / runs,
        late.iter().sum::<f64>() / all,
        at(0.5),
        at(0.95),
        *delayed / all,
        *waited / all,
    );
    Ok(())
}

/// Executes a schedule once undisturbed, and so often with delays.
fn measure(
    map: &Map,
    schedule: &Schedule,
    trials: u64,
    seed: u64,
    figures: &mut Figures,
) -> Result<(), Failure> {
    let radius_m = if map.lattice() == Lattice::Square { 0.3 } else { 0.2 };
    let robot = Robot { radius_m, ..Robot::default() };
    let undisturbed = Execution::new(map, schedule, &robot, Delays::default())?;
    figures.undisturbed += undisturbed.trial(&mut Rng::new(seed))?.makespan();
    for trial in 0..trials {
        let mut rng = Rng::new(seed * 1_000_003 + trial);
        let stop = Stop { robot: rng.below(schedule.robots() as u32) as usize, from: 10.0, steps: 50.0 };
        let delays = Delays {
            chance: 0.05,
            most_steps: 20,
            slow_share: 0.05,
            slow_speed: 0.5,
            stops: vec![stop],
            ..Delays::default()
        };
        let done = Execution::new(map, schedule, &robot, delays)?.trial(&mut rng)?;
        figures.makespan += done.makespan();
        let costs = (0..schedule.robots()).map(|robot| schedule.cost(robot) as f64);
        figures.late.extend(done.arrivals.iter().zip(costs).map(|(arrival, cost)| arrival - cost));
        figures.delayed += done.delayed.iter().sum::<f64>();
        figures.waited += done.waited.iter().sum::<f64>();
    }
    Ok(())
}
