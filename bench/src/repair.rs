//! Repair against recompute: cells become blocked and free again, and the field follows.

use crate::cases::{Case, Digest};
use crate::ours::Live;
use crate::queue::Queue;
use activecell::{BitPlane, Cell, Lattice, Map, Rng};
use anyhow::{Result, ensure};
use cpu_time::ThreadTime;
use serde_json::{Value, json};
use std::time::Instant;

const CHANGES: usize = 500;
/// After every so many changes the whole field is compared with a fresh one.
const CHECK_EVERY: usize = 50;

/// Times of single changes in microseconds, and of a fresh flood by each method for comparison.
pub fn run(map: &Map, case: &Case) -> Result<(f64, Value)> {
    let target = case.target();
    let start = Instant::now();
    let mut live = Live::new(map, target);
    let setup_ms = start.elapsed().as_secs_f64() * 1e3;
    let mut rng = Rng::new(1);
    let free: Vec<Cell> = map.free().filter(|&cell| cell != target).collect();
    let mut obstacles: BitPlane = map.obstacles().clone();
    let mut us = Vec::with_capacity(2 * CHANGES);
    for change in 0..CHANGES {
        let cell = free[rng.below(free.len() as u32) as usize];
        for blocked in [true, false] {
            obstacles.set(cell.x as u32, cell.y as u32, blocked);
            let clock = ThreadTime::now();
            live.set(cell, blocked);
            us.push(clock.elapsed().as_secs_f64() * 1e6);
            if change % CHECK_EVERY == 0 {
                check(&live, &Map::new(Lattice::Square, obstacles.clone()), target)?;
            }
        }
    }
    let clock = ThreadTime::now();
    std::hint::black_box(map.wave(target)?);
    let wave_ms = clock.elapsed().as_secs_f64() * 1e3;
    let queue = Queue::new(map);
    let clock = ThreadTime::now();
    std::hint::black_box(queue.field(target));
    let queue_ms = clock.elapsed().as_secs_f64() * 1e3;
    Ok((setup_ms, json!({ "us": us, "wave_ms": wave_ms, "queue_ms": queue_ms })))
}

fn check(live: &Live, map: &Map, target: Cell) -> Result<()> {
    let queue = Queue::new(map);
    let field = queue.field(target);
    let (width, height) = (map.width() as i32, map.height() as i32);
    let cells = (0..height).flat_map(|y| (0..width).map(move |x| Cell::new(x, y)));
    let found = Digest::of(cells.map(|cell| live.steps(cell)));
    let wanted = Digest::of(queue.field_steps(&field));
    ensure!(found == wanted, "the repaired field is {found:?}, a fresh one {wanted:?}");
    Ok(())
}
