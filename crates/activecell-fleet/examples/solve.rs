//! Solves the first N rows of a scenario and says how long it took: `solve MAP SCEN N [SECONDS [SEED [LATTICE]]]`. With 0
//! seconds it stops at the first plan. SCEN `random` draws starts and targets.

use activecell::{Lattice, Map, Team, check_plan};
use activecell_fleet::{Limits, Options, solve};
use activecell_formats::movingai::{read_map, read_scen};
use std::time::{Duration, Instant};

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [map, scen, robots, rest @ ..] = args.as_slice() else {
        return Err("solve MAP SCEN N [SECONDS [SEED [LATTICE]]]".into());
    };
    let number = |i: usize| rest.get(i).map_or(Ok(0.0), |text: &String| text.parse::<f64>());
    let (seconds, seed) = (number(0)?, number(1)? as u64);
    let lattice = if rest.get(2).is_some_and(|name| name == "hex") { Lattice::Hex } else { Lattice::Square };
    let map = read_map(&std::fs::read(map)?)?.on(lattice);
    let team = team(&map, scen, robots.parse()?)?;
    let limits = Limits {
        time: Some(Duration::from_secs_f64(if seconds > 0.0 { seconds } else { 60.0 })),
        first: seconds == 0.0,
        ..Limits::default()
    };
    let outcome = solve(&map, &team, &Options { seed, threads: 2, limits }, |_| {})?;
    let bound = outcome.lower_bound;
    if let (Some(plan), Some(first)) = (&outcome.plan, outcome.history.first()) {
        let clock = Instant::now();
        check_plan(&map, &team, plan)?;
        println!(
            "{} robots: first plan after {:.1} ms, cost {} ({:.3}); now {} ({:.3}), makespan {}; bound {bound}; \
             {:?}; {} steps; {:.1} MB counted, {:.1} MB peak; checked in {:.0} ms",
            team.robots(),
            first.ms,
            first.sum_of_costs,
            first.sum_of_costs as f64 / bound as f64,
            plan.sum_of_costs(),
            plan.sum_of_costs() as f64 / bound as f64,
            plan.makespan(),
            outcome.ending,
            outcome.steps,
            outcome.bytes as f64 / 1e6,
            peak_mb()?,
            clock.elapsed().as_secs_f64() * 1e3,
        );
    } else {
        println!("{} robots: no plan, {:?}; {} steps", team.robots(), outcome.ending, outcome.steps);
    }
    Ok(())
}

fn team(map: &Map, scen: &str, robots: usize) -> Result<Team, Failure> {
    if scen == "random" {
        return Ok(Team::random(map, robots, 1)?);
    }
    let rows = read_scen(&std::fs::read(scen)?)?;
    let rows = &rows[..robots.min(rows.len())];
    Ok(Team::new(map, rows.iter().map(|row| row.from).collect(), rows.iter().map(|row| row.to).collect())?)
}

/// The most memory that the process has had.
fn peak_mb() -> Result<f64, Failure> {
    let status = std::fs::read_to_string("/proc/self/status")?;
    let line = status.lines().find(|line| line.starts_with("VmHWM")).ok_or("no VmHWM")?;
    Ok(line.split_whitespace().nth(1).ok_or("no number")?.parse::<f64>()? / 1e3)
}
