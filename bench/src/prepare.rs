//! Makes the cases: maps, tasks, and the plain queue's answers to them.

use crate::cases::{self, Case, Digest, Task};
use crate::maps;
use crate::queue::Queue;
use activecell::{Cell, Map, Rng};
use activecell_formats::files::{ReadOptions, read_bytes, read_map};
use activecell_formats::movingai::read_scen;
use anyhow::{Context, Result};
use std::path::{Path, PathBuf};

/// The real maps of a quick run.
const QUICK: [&str; 5] = ["arena2", "64room_000", "maze512-4-0", "random512-40-0", "willow-2010-02-18-0.10"];
const SIZES: [u32; 6] = [256, 512, 1024, 2048, 4096, 8192];

pub fn prepare(folder: &Path, data: Option<&Path>, quick: bool) -> Result<()> {
    std::fs::create_dir_all(folder)?;
    let mut cases = Vec::new();
    let pairs = if quick { 100 } else { 500 };
    let most = if quick { 100 } else { usize::MAX };
    for (file, source) in data.map(real_maps).transpose()?.unwrap_or_default() {
        let name = file.file_stem().context("a map has a name")?.to_string_lossy().into_owned();
        if quick && !QUICK.contains(&name.as_str()) {
            continue;
        }
        let (map, _) =
            read_map(&file, &ReadOptions::default()).with_context(|| file.display().to_string())?;
        let scen = PathBuf::from(format!("{}.scen", file.display()));
        let tasks = if scen.exists() {
            let tasks = read_scen(&read_bytes(&scen, 1 << 28)?)?;
            let pairs: Vec<_> = tasks.iter().map(|task| (task.from, task.to)).collect();
            even_sample(&pairs, most)
        } else {
            random_pairs(&map, pairs)
        };
        cases.push(case("map", source, &name, &map, &tasks, folder)?);
    }
    for (name, map) in maps::synthetic(512)? {
        cases.push(case("map", "synthetic", &name, &map, &random_pairs(&map, pairs), folder)?);
    }
    for size in SIZES {
        if quick && !matches!(size, 256 | 1024 | 4096) {
            continue;
        }
        for (name, map) in [("rooms", maps::rooms(size, 64, 4)?), ("random20", maps::random(size, 0.2)?)] {
            let tasks = random_pairs(&map, 5);
            cases.push(case("grow", "synthetic", &format!("grow-{name}-{size}"), &map, &tasks, folder)?);
        }
    }
    cases::save(&cases, "map", folder)?;
    cases::save(&cases, "grow", folder)
}

/// The real maps in the folder: all of `movingai/`, and those of `ros/` that say what their colours mean.
fn real_maps(data: &Path) -> Result<Vec<(PathBuf, &'static str)>> {
    let mut found = Vec::new();
    for (folder, ending, source) in [("movingai", "map", "MovingAI"), ("ros", "yaml", "ROS")] {
        let Ok(entries) = std::fs::read_dir(data.join(folder)) else { continue };
        for entry in entries {
            let path = entry?.path();
            if path.extension().is_some_and(|found| found == ending) {
                found.push((path, source));
            }
        }
    }
    found.sort();
    Ok(found)
}

/// The tasks in an order whose every beginning is an even sample: steps of the golden ratio around the list.
fn even_sample<T: Copy>(tasks: &[T], most: usize) -> Vec<T> {
    let n = tasks.len();
    let gcd = |mut a: usize, mut b: usize| {
        while b > 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    let near = (n as f64 * 0.618_034) as usize;
    let stride = (near.max(1)..n.max(2)).find(|&stride| gcd(stride, n) == 1).unwrap_or(1);
    (0..n.min(most)).map(|i| tasks[(n / 2 + i * stride) % n]).collect()
}

/// Random pairs of cells of the largest part of the floor.
fn random_pairs(map: &Map, pairs: usize) -> Vec<(Cell, Cell)> {
    let mut rng = Rng::new(pairs as u64);
    let free: Vec<Cell> = map.free().collect();
    let queue = Queue::new(map);
    // The largest part holds most cells of every map here, so a few tries find it.
    let mut part: Vec<Cell> = Vec::new();
    for _ in 0..5 {
        let origin = free[rng.below(free.len() as u32) as usize];
        let field = queue.field(origin);
        let all =
            (0..map.height() as i32).flat_map(|y| (0..map.width() as i32).map(move |x| Cell::new(x, y)));
        let reached: Vec<Cell> =
            all.zip(queue.field_steps(&field)).filter_map(|(cell, steps)| steps.map(|_| cell)).collect();
        if reached.len() > part.len() {
            part = reached;
        }
        if part.len() * 2 > free.len() {
            break;
        }
    }
    let mut pick = || part[rng.below(part.len() as u32) as usize];
    (0..pairs).map(|_| (pick(), pick())).collect()
}

fn case(
    group: &str,
    source: &str,
    name: &str,
    map: &Map,
    pairs: &[(Cell, Cell)],
    folder: &Path,
) -> Result<Case> {
    let mut queue = Queue::new(map);
    let mut tasks: Vec<Task> = Vec::new();
    for &(from, to) in pairs {
        match queue.distance(from, to) {
            None | Some(0) => {}
            Some(steps) => tasks.push([from.x as u32, from.y as u32, to.x as u32, to.y as u32, steps]),
        }
    }
    let middle = tasks.first().with_context(|| format!("{name} has no task"))?;
    let target = [middle[2], middle[3]];
    let field = queue.field(Cell::new(target[0] as i32, target[1] as i32));
    cases::save_map(map, name, folder)?;
    eprintln!("  {name}: {} x {}, {} tasks", map.width(), map.height(), tasks.len());
    Ok(Case {
        name: name.into(),
        group: group.into(),
        source: source.into(),
        width: map.width(),
        height: map.height(),
        free: map.free_cells(),
        left_out: pairs.len() - tasks.len(),
        tasks,
        target,
        field: Digest::of(queue.field_steps(&field)),
    })
}
