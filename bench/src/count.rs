//! Instruction counts of fixed small workloads, by `valgrind --tool=callgrind`: a guard of the hot loops that
//! does not depend on how busy the machine is.

use crate::measure::{Fields, Paths};
use crate::{maps, ours};
use activecell::{Cell, Map, Rng};
use anyhow::{Context, Result, bail, ensure};
use std::collections::BTreeMap;
use std::hint::black_box;
use std::path::Path;
use std::process::Command;

/// How much more than the kept figure is an error.
const TOLERANCE: f64 = 1.05;
const MAPS: [&str; 4] = ["rooms", "random20", "random40", "maze1"];
const METHODS: [&str; 4] = ["paths", "wave", "compact", "reachable"];

fn names() -> impl Iterator<Item = String> {
    METHODS.into_iter().flat_map(|method| MAPS.map(|map| format!("{method} {map}")))
}

/// Counts every workload and compares with the figures in `file`, or writes them there.
pub fn compare(file: &Path, update: bool) -> Result<()> {
    if Command::new("valgrind").arg("--version").output().is_err() {
        eprintln!("!! NOT RUN: instruction counts need valgrind, which is not installed here.");
        return Ok(());
    }
    let kept: BTreeMap<String, u64> = match std::fs::read_to_string(file) {
        Ok(text) => serde_json::from_str(&text).with_context(|| file.display().to_string())?,
        Err(_) => BTreeMap::new(),
    };
    let mut counted = BTreeMap::new();
    let mut worse = Vec::new();
    println!("{:<20} {:>15} {:>15}  ratio", "workload", "kept", "now");
    for name in names() {
        let now = count(&name)?;
        match kept.get(&name) {
            Some(&kept) => {
                let ratio = now as f64 / kept as f64;
                println!("{name:<20} {kept:>15} {now:>15}  {ratio:.4}");
                if ratio > TOLERANCE {
                    worse.push(name.clone());
                }
            }
            None => println!("{name:<20} {:>15} {now:>15}  new", "-"),
        }
        counted.insert(name, now);
    }
    if update {
        let text = serde_json::to_string_pretty(&counted)? + "\n";
        std::fs::write(file, text).with_context(|| file.display().to_string())?;
        println!("written to {}", file.display());
        return Ok(());
    }
    ensure!(
        worse.is_empty(),
        "more than 5 % above the kept counts: {}; make them cheaper, or say why not and run `make count UPDATE=1`",
        worse.join(", ")
    );
    Ok(())
}

/// The instructions inside [`counted`] when this program runs the workload `name`.
fn count(name: &str) -> Result<u64> {
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null", "--collect-atstart=no"])
        .arg("--toggle-collect=*counted_part*")
        .arg(std::env::current_exe()?)
        .args(["count-one", name])
        .output()?;
    let text = String::from_utf8_lossy(&output.stderr);
    ensure!(output.status.success(), "valgrind failed on {name}:\n{text}");
    let line = text.lines().find_map(|line| line.split("Collected :").nth(1));
    let number = line.and_then(|rest| rest.split_whitespace().next()).context("valgrind printed no count")?;
    let number = number.parse().with_context(|| format!("valgrind counted {number:?}"))?;
    ensure!(number > 0, "valgrind did not find the counted part of {name}");
    Ok(number)
}

/// Only what runs inside is counted.
#[inline(never)]
fn counted_part(work: &mut dyn FnMut()) {
    work();
    black_box(());
}

/// Runs a workload once.
pub fn workload(name: &str) -> Result<()> {
    let (method, map) = name.split_once(' ').context("a workload is a method and a map")?;
    let map = match map {
        "rooms" => maps::rooms(512, 64, 4)?,
        "random20" => maps::random(256, 0.2)?,
        "random40" => maps::random(256, 0.4)?,
        "maze1" => maps::maze(256)?,
        _ => bail!("no map {map}"),
    };
    let cells = far_cells(&map, 17)?;
    match method {
        "paths" => {
            let mut search = ours::Search::new(&map);
            counted_part(&mut || {
                for pair in cells.windows(2) {
                    black_box(search.find(pair[0], pair[1]).is_ok());
                }
            });
        }
        "wave" => field(ours::Wave(map), cells[0]),
        "compact" => field(ours::Compact(map), cells[0]),
        "reachable" => field(ours::Reachable(map), cells[0]),
        _ => bail!("no method {method}"),
    }
    Ok(())
}

fn field<M: Fields>(mut method: M, target: Cell) {
    counted_part(&mut || {
        black_box(method.field(target));
    });
}

/// Cells of the part of the floor in which the middle of the free cells lies.
fn far_cells(map: &Map, count: usize) -> Result<Vec<Cell>> {
    let free: Vec<Cell> = map.free().collect();
    let field = map.wave(free[free.len() / 2])?;
    let part: Vec<Cell> = free.into_iter().filter(|&cell| field.steps(cell).is_some()).collect();
    ensure!(part.len() > 1000, "the part is too small");
    let mut rng = Rng::new(3);
    Ok((0..count).map(|_| part[rng.below(part.len() as u32) as usize]).collect())
}
