//! Refines the first plan of the first N rows of a scenario and says what it costs with time:
//! `refine MAP SCEN N SECONDS [THREADS [SEED]]`. Time is that of the processor, shared by the threads.

use activecell::{Cell, Team, check_plan};
use activecell_fleet::{Advance, Arbiter, Fields, Floor, Refiner, Search};
use activecell_formats::movingai::{read_map, read_scen};
use std::time::Instant;

type Failure = Box<dyn std::error::Error>;

/// The times at which the cost is told, in seconds.
const MARKS: [f64; 6] = [0.1, 0.3, 1.0, 3.0, 10.0, 30.0];

fn main() -> Result<(), Failure> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [map, scen, robots, seconds, rest @ ..] = args.as_slice() else {
        return Err("refine MAP SCEN N SECONDS [THREADS [SEED]]".into());
    };
    let number = |i: usize, default: u64| rest.get(i).map_or(Ok(default), |text| text.parse::<u64>());
    let (threads, seed) = (number(0, 2)? as usize, number(1, 0)?);
    let rows = read_scen(&std::fs::read(scen)?)?;
    let map = read_map(&std::fs::read(map)?)?;
    let rows = &rows[..robots.parse::<usize>()?.min(rows.len())];
    let cells = |row: fn(&_) -> Cell| rows.iter().map(row).collect();
    let team = Team::new(&map, cells(|row| row.from), cells(|row| row.to))?;
    let clock = Instant::now();
    let floor = Floor::new(&map);
    let (starts, targets) = (floor.numbers_of(team.starts()), floor.numbers_of(team.targets()));
    let mut fields = Fields::new(&floor);
    let goals = fields.goals(&floor, &targets, threads)?;
    let mut search = Search::new(Arbiter::new(&floor, &fields, goals.clone(), seed), &starts, seed);
    while search.loss().is_none() && search.advance() != Advance::Exhausted {}
    let first = search.plan().ok_or("no plan")?;
    let bound = search.lower_bound();
    drop(search);
    print!(
        "{} robots, bound {bound}: {} at {:.0} ms",
        team.robots(),
        first.sum_of_costs(),
        clock.elapsed().as_secs_f64() * 1e3
    );
    let before = processor_seconds()?;
    let mut refiner = Refiner::new(&floor, &fields, &goals, &first, seed);
    let mut marks = MARKS.into_iter().peekable();
    loop {
        let now = before + (processor_seconds()? - before) / threads as f64;
        while let Some(mark) = marks.next_if(|&mark| mark <= now) {
            print!(", {} at {mark} s", refiner.sum_of_costs());
        }
        if now >= seconds.parse()? {
            break;
        }
        refiner.round(threads, &|| false);
    }
    let plan = refiner.plan();
    check_plan(&map, &team, &plan)?;
    let ratio = refiner.sum_of_costs() as f64 / bound as f64;
    println!(", {} ({ratio:.3}) in the end; {:.1} MB", plan.sum_of_costs(), refiner.bytes() as f64 / 1e6);
    Ok(())
}

/// The time that the processor has given to this process so far.
fn processor_seconds() -> Result<f64, Failure> {
    let stat = std::fs::read_to_string("/proc/self/stat")?;
    let fields: Vec<&str> = stat.rsplit(')').next().unwrap_or("").split_whitespace().collect();
    let ticks = |i: usize| fields.get(i).ok_or("no times")?.parse::<f64>().map_err(Failure::from);
    Ok((ticks(11)? + ticks(12)?) / 100.0)
}
