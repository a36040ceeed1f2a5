//! Runs a lifelong data set (`map.txt`, `agents_*.csv`, `tasks_one.csv`) and says how many tasks a step were done and how
//! long a step took: `lifelong FOLDER AGENTS ROBOTS [key=value …]`, for instance
//! `lifelong ../shared/data/lifelong/random agents_4 400 motion=turning ms=50 steps=1000 seed=1 window=20 threads=2`.
//! `paths=N` limits the work of a step instead of the time, `lattice=hex` reads the map as hexagons, `nearest=1.5` gives
//! the nearest of that many open tasks a robot. The run is checked.

use activecell::{Cell, Lattice, Map, Moves, Task, check_journal};
use activecell_fleet::{Assignment, Lifelong, LifelongOptions};
use std::collections::BTreeMap;
use std::time::Duration;

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [folder, agents, robots, rest @ ..] = args.as_slice() else {
        return Err("lifelong FOLDER AGENTS ROBOTS [key=value ...]".into());
    };
    let values: BTreeMap<&str, &str> = rest.iter().filter_map(|arg| arg.split_once('=')).collect();
    let number = |key: &str| values.get(key).map(|text| text.parse::<f64>()).transpose();
    let lattice = if values.get("lattice") == Some(&"hex") { Lattice::Hex } else { Lattice::Square };
    let text = |name: &str| std::fs::read_to_string(format!("{folder}/{name}"));
    let map = read_map(&text("map.txt")?, lattice)?;
    let starts = read_starts(&text(&format!("{agents}.csv"))?, robots.parse()?)?;
    let tasks = read_tasks(&text("tasks_one.csv")?, map.width())?;
    let options = LifelongOptions {
        moves: if values.get("motion") == Some(&"turning") { Moves::Turning } else { Moves::Omni },
        seed: number("seed")?.unwrap_or(0.0) as u64,
        threads: number("threads")?.unwrap_or(2.0) as usize,
        step_time: number("ms")?.map(|ms| Duration::from_secs_f64(ms / 1e3)),
        step_paths: number("paths")?.map(|paths| paths as u64),
        window: number("window")?.unwrap_or(20.0) as usize,
        assignment: number("nearest")?.map_or(Assignment::InOrder, |shown| Assignment::Nearest { shown }),
        ..LifelongOptions::default()
    };
    let mut run = Lifelong::new(&map, &starts, &[], tasks.clone(), options)?;
    let (mut times, mut paths, mut each) = (Vec::new(), 0, Vec::new());
    let steps = number("steps")?.unwrap_or(1000.0) as usize;
    let journal = run.run(steps, |step| {
        times.push(step.planned_us);
        paths += step.paths;
        each.push(step.finished);
    })?;
    check_journal(&map, &tasks, &journal)?;
    times.sort_unstable();
    let tenth = each.chunks(steps.div_ceil(10)).map(|part| part.iter().sum::<usize>().to_string());
    println!(
        "{:.3} tasks a step; ms a step: median {:.1}, 99 % {:.1}, most {:.1}; {} paths a step; {:.1} MB; \
         tasks in each tenth: {}; checked",
        journal.finished(&tasks) as f64 / steps as f64,
        times[times.len() / 2] as f64 / 1e3,
        times[times.len() * 99 / 100] as f64 / 1e3,
        times[times.len() - 1] as f64 / 1e3,
        paths / times.len() as u64,
        run.bytes() as f64 / 1e6,
        tenth.collect::<Vec<_>>().join(" "),
    );
    Ok(())
}

fn read_map(text: &str, lattice: Lattice) -> Result<Map, Failure> {
    let cell = |letter: char| if "@OTW".contains(letter) { '#' } else { '.' };
    let rows = text.lines().skip(4).map(|row| row.chars().map(cell).collect::<String>());
    Ok(Map::parse(lattice, &rows.collect::<Vec<_>>().join("\n"))?)
}

/// Rows of `agent id,row,col`.
fn read_starts(text: &str, robots: usize) -> Result<Vec<Cell>, Failure> {
    let start = |line: &str| {
        let numbers: Result<Vec<i32>, _> = line.split(',').map(|number| number.trim().parse()).collect();
        match numbers?.as_slice() {
            &[_, y, x] => Ok(Cell::new(x, y)),
            _ => Err("a start has a number, a row and a column".into()),
        }
    };
    text.lines().skip(1).take(robots).map(start).collect()
}

/// A cell a line, row after row.
fn read_tasks(text: &str, width: u32) -> Result<Vec<Task>, Failure> {
    let task = |line: &str| {
        let cell: u32 = line.trim().parse()?;
        Ok(Task::visit(Cell::new((cell % width) as i32, (cell / width) as i32)))
    };
    text.lines().skip(1).map(task).collect()
}
