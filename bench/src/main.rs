//! The Rust side of the benchmarks; `bench/run.sh` runs it. See `docs/benchmarks.md`.
//!
//! ```text
//! activecell-bench prepare WORK [--data FOLDER] [--quick]        make the cases
//! activecell-bench list WORK GROUP                               names of the cases
//! activecell-bench run WORK OUT paths|fields|repair - -          measure all methods on all maps
//! activecell-bench run WORK OUT paths|fields CASE METHOD         one method on one growing map
//! activecell-bench fleet MAP SCEN ROBOTS LATTICE SECONDS OUT     the planner for groups on one instance
//! activecell-bench count FILE [--update]                         instruction counts
//! ```

mod cases;
mod count;
mod fleet;
mod maps;
mod measure;
mod ours;
mod peers;
mod prepare;
mod queue;
mod repair;

use anyhow::{Context, Result, bail};
use cases::Case;
use measure::{Budget, Fields, Paths, fields, paths, record};
use serde_json::Value;
use std::fs::OpenOptions;
use std::path::Path;
use std::time::Instant;

const PATH_METHODS: [&str; 5] =
    ["ours", "queue", "pathfinding astar", "pathfinding bidir", "grid_pathfinding"];
const FIELD_METHODS: [&str; 6] =
    ["ours", "ours compact", "ours reachable", "queue", "pathfinding bfs_reach", "pathfinding dijkstra_all"];

fn main() -> Result<()> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let args: Vec<&str> = args.iter().map(String::as_str).collect();
    match args[..] {
        ["prepare", work, ref rest @ ..] => {
            let data = rest.iter().position(|&arg| arg == "--data").and_then(|at| rest.get(at + 1));
            prepare::prepare(Path::new(work), data.map(Path::new), rest.contains(&"--quick"))
        }
        ["list", work, group] => {
            for case in cases::load(group, Path::new(work))? {
                println!("{} {}", case.name, case.width.max(case.height));
            }
            Ok(())
        }
        ["run", work, out, part, case, method] => run(Path::new(work), out, part, case, method),
        ["fleet", map, scen, robots, lattice, seconds, out] => {
            fleet::run(Path::new(map), Path::new(scen), robots.parse()?, lattice, seconds.parse()?, out)
        }
        ["count", file, ref rest @ ..] => count::compare(Path::new(file), rest.contains(&"--update")),
        ["count-one", name] => count::workload(name),
        _ => bail!("see the first lines of bench/src/main.rs"),
    }
}

fn run(work: &Path, out: &str, part: &str, only_case: &str, only_method: &str) -> Result<()> {
    let budget = Budget::from_environment();
    let mut out = OpenOptions::new().create(true).append(true).open(out).context("the file of results")?;
    let methods: &[&str] = match part {
        "paths" => &PATH_METHODS,
        "fields" => &FIELD_METHODS,
        "repair" => &["ours"],
        _ => bail!("no part {part}"),
    };
    let group = if only_case == "-" { "map" } else { "grow" };
    let chosen = |case: &&Case| only_case == "-" || case.name == only_case;
    for case in cases::load(group, work)?.iter().filter(chosen) {
        for &method in methods.iter().filter(|&&method| only_method == "-" || only_method == method) {
            record(&mut out, case, part, method, || match part {
                "paths" => run_paths(work, case, budget, method),
                "fields" => run_fields(work, case, budget, method),
                _ => run_repair(work, case),
            })?;
        }
        eprintln!("  {part} {}", case.name);
    }
    Ok(())
}

fn run_paths(work: &Path, case: &Case, budget: Budget, method: &str) -> Result<(f64, Value)> {
    /// Set-up ends when the method is there.
    fn go<M: Paths>(start: Instant, case: &Case, budget: Budget, mut method: M) -> Result<(f64, Value)> {
        let setup_ms = start.elapsed().as_secs_f64() * 1e3;
        Ok((setup_ms, paths(case, budget, &mut method)?))
    }
    let map = case.load(work)?;
    let start = Instant::now();
    match method {
        "ours" => go(start, case, budget, ours::Search::new(&map)),
        "queue" => go(start, case, budget, queue::Queue::new(&map)),
        "pathfinding astar" => go(start, case, budget, peers::Astar(peers::Grid::new(&map))),
        "pathfinding bidir" => go(start, case, budget, peers::Bidirectional(peers::Grid::new(&map))),
        "grid_pathfinding" => go(start, case, budget, peers::Jps::new(&map)),
        _ => bail!("no method {method}"),
    }
}

fn run_fields(work: &Path, case: &Case, budget: Budget, method: &str) -> Result<(f64, Value)> {
    /// Set-up ends when the method is there.
    fn go<M: Fields>(start: Instant, case: &Case, budget: Budget, mut method: M) -> Result<(f64, Value)> {
        let setup_ms = start.elapsed().as_secs_f64() * 1e3;
        Ok((setup_ms, fields(case, budget, &mut method)?))
    }
    let map = case.load(work)?;
    let start = Instant::now();
    match method {
        "ours" => go(start, case, budget, ours::Wave(map)),
        "ours compact" => go(start, case, budget, ours::Compact(map)),
        "ours reachable" => go(start, case, budget, ours::Reachable(map)),
        "queue" => go(start, case, budget, queue::Queue::new(&map)),
        "pathfinding bfs_reach" => go(start, case, budget, peers::Reach(peers::Grid::new(&map))),
        "pathfinding dijkstra_all" => go(start, case, budget, peers::DijkstraAll(peers::Grid::new(&map))),
        _ => bail!("no method {method}"),
    }
}

fn run_repair(work: &Path, case: &Case) -> Result<(f64, Value)> {
    repair::run(&case.load(work)?, case)
}
