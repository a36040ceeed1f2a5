//! `activecell table success`: how many reachable targets each rule reaches on random maps.

use crate::args::TableFormat;
use crate::terminal::Terminal;
use activecell::{Cell, Error, Lattice, Map, Outcome, Rng, Rule};
use serde_json::json;

const DENSITIES_PERCENT: [u32; 5] = [5, 10, 20, 30, 40];
/// Far above what learning needs on the largest map that may be asked for.
const MAX_STEPS: usize = 1_000_000_000;

/// Random maps of `size` × `size` cells, `pairs` for each density, one reachable task on each.
pub(crate) struct Experiment {
    pub(crate) size: u32,
    pub(crate) pairs: u32,
    pub(crate) seed: u64,
}

/// What one rule did at one density.
#[derive(Clone, Copy, Default)]
struct Tally {
    arrived: u32,
    steps: u64,
}

/// All rules on one lattice at one density.
struct Row {
    lattice: Lattice,
    density_percent: u32,
    tallies: [Tally; 3],
}

pub(crate) fn run(experiment: &Experiment, format: TableFormat, terminal: &Terminal) -> anyhow::Result<()> {
    let tasks = u64::from(experiment.pairs) * 2 * DENSITIES_PERCENT.len() as u64;
    let bar = terminal.counting(tasks, "routing");
    let mut rows = Vec::new();
    for lattice in Lattice::ALL {
        for density_percent in DENSITIES_PERCENT {
            let mut row = Row { lattice, density_percent, tallies: [Tally::default(); 3] };
            let mut seeds = Rng::new(experiment.seed ^ u64::from(density_percent) << 32);
            for _ in 0..experiment.pairs {
                let (map, from, to) = task(lattice, experiment.size, density_percent, &mut seeds)?;
                for (rule, tally) in Rule::ALL.into_iter().zip(&mut row.tallies) {
                    let route = map.route(rule, from, to, MAX_STEPS)?;
                    tally.arrived += u32::from(route.outcome() == Outcome::Arrived);
                    tally.steps += route.steps() as u64;
                }
                bar.step();
            }
            rows.push(row);
        }
    }
    drop(bar);
    Terminal::result(&print(experiment, &rows, format)?)
}

/// A random map with a start and another cell that can be reached from it.
fn task(
    lattice: Lattice,
    size: u32,
    density_percent: u32,
    seeds: &mut Rng,
) -> Result<(Map, Cell, Cell), Error> {
    loop {
        let map = Map::random(lattice, size, size, f64::from(density_percent) / 100.0, seeds.next_u64())?;
        let mut pick = || Cell::new(seeds.below(size) as i32, seeds.below(size) as i32);
        let (from, to) = (pick(), pick());
        if from != to && map.is_free(from) && map.is_free(to) && map.wave(to)?.steps(from).is_some() {
            return Ok((map, from, to));
        }
    }
}

fn print(experiment: &Experiment, rows: &[Row], format: TableFormat) -> anyhow::Result<String> {
    let Experiment { size, pairs, seed } = experiment;
    let percent = |tally: Tally| 100.0 * f64::from(tally.arrived) / f64::from(*pairs);
    // Wave is the last rule, and shortest.
    let detour = |row: &Row| row.tallies[1].steps as f64 / row.tallies[2].steps.max(1) as f64;
    Ok(match format {
        TableFormat::Markdown => {
            let mut text = format!(
                "Reachable targets that are reached, on random maps of {size} × {size} cells, {pairs} tasks each:\n\n| obstacles |"
            );
            for density in DENSITIES_PERCENT {
                text += &format!(" {density} % |");
            }
            text += &format!("\n|---|{}", "---|".repeat(DENSITIES_PERCENT.len()));
            for lattice in Lattice::ALL {
                let rows: Vec<&Row> = rows.iter().filter(|row| row.lattice == lattice).collect();
                for (i, rule) in Rule::ALL.into_iter().enumerate() {
                    text += &format!("\n| {lattice}, {rule} |");
                    for row in &rows {
                        text += &format!(" {:.0} % |", percent(row.tallies[i]));
                    }
                }
                text += &format!("\n| {lattice}, learning: steps ÷ shortest |");
                for row in &rows {
                    text += &format!(" {:.1} |", detour(row));
                }
            }
            text + "\n"
        }
        TableFormat::Csv => {
            let mut text = String::from("lattice,obstacles_percent,rule,tasks,arrived,steps\n");
            for row in rows {
                for (rule, tally) in Rule::ALL.into_iter().zip(row.tallies) {
                    let (lattice, density) = (row.lattice, row.density_percent);
                    text +=
                        &format!("{lattice},{density},{rule},{pairs},{},{}\n", tally.arrived, tally.steps);
                }
            }
            text
        }
        TableFormat::Json => {
            let rows = rows.iter().flat_map(|row| {
                Rule::ALL.into_iter().zip(row.tallies).map(|(rule, tally)| {
                    json!({"lattice": row.lattice.name(), "obstacles_percent": row.density_percent,
                           "rule": rule.name(), "arrived": tally.arrived, "steps": tally.steps})
                })
            });
            let rows: Vec<_> = rows.collect();
            serde_json::to_string(&json!({"size": size, "tasks": pairs, "seed": seed, "rows": rows}))? + "\n"
        }
    })
}
