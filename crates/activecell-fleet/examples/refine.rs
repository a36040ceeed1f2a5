//! Refines the first plan: `refine MAP SCEN N SECONDS [THREADS [SEED]]`.
use activecell::{Map, Team, check_plan};
use activecell_fleet::{Advance, Arbiter, Fields, Floor, Goal, Refiner, Search};
use activecell_formats::movingai::{read_map, read_scen};
use std::time::Instant;

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let map: Map = read_map(&std::fs::read(&args[0])?)?;
    let robots: usize = args[2].parse()?;
    let seconds: f64 = args[3].parse()?;
    let threads: usize = args.get(4).map_or(Ok(2), |t| t.parse())?;
    let seed: u64 = args.get(5).map_or(Ok(0), |t| t.parse())?;
    let rows = read_scen(&std::fs::read(&args[1])?)?;
    let rows = &rows[..robots.min(rows.len())];
    let team =
        Team::new(&map, rows.iter().map(|row| row.from).collect(), rows.iter().map(|row| row.to).collect())?;
    let clock = Instant::now();
    let floor = Floor::new(&map);
    let numbers =
        |cells: &[activecell::Cell]| cells.iter().map(|&cell| floor.number(cell)).collect::<Vec<_>>();
    let (starts, targets) = (numbers(team.starts()), numbers(team.targets()));
    let mut fields = Fields::new(&floor);
    let slots = fields.request(&floor, &targets, threads)?;
    let goals: Vec<Goal> =
        targets.into_iter().zip(slots).map(|(target, slot)| Goal { target, slot }).collect();
    let arbiter = Arbiter::new(&floor, &fields, goals.clone(), seed);
    let mut search = Search::new(arbiter, &starts, seed);
    while search.plan().is_none() && search.advance() == Advance::Searching {}
    let plan = search.plan().ok_or("no plan")?;
    let bound = search.lower_bound();
    drop(search);
    let first = clock.elapsed().as_secs_f64() * 1e3;
    print!(
        "{} {} first {first:.0} ms {} makespan {}",
        args[0].rsplit('/').next().unwrap(),
        robots,
        plan.sum_of_costs(),
        plan.makespan()
    );
    let before = Instant::now();
    let mut refiner = Refiner::new(&floor, &fields, &goals, &plan, seed);
    let mut rounds = 0;
    let marks = [0.1, 0.3, 1.0, 3.0, 10.0, 30.0];
    let mut next = 0;
    print!(" setup {:.0}", before.elapsed().as_secs_f64() * 1e3);
    while clock.elapsed().as_secs_f64() < seconds {
        refiner.round(threads);
        rounds += 1;
        while next < marks.len() && clock.elapsed().as_secs_f64() >= marks[next] {
            print!(" | {}s {}", marks[next], refiner.sum_of_costs());
            next += 1;
        }
    }
    let plan = refiner.plan();
    check_plan(&map, &team, &plan)?;
    assert_eq!(plan.sum_of_costs(), refiner.sum_of_costs());
    println!(
        " | end {} ratio {:.3} rounds {rounds} {:.1} MB",
        plan.sum_of_costs(),
        plan.sum_of_costs() as f64 / bound as f64,
        refiner.bytes() as f64 / 1e6
    );
    Ok(())
}
