//! Maps that the harness makes itself, the same on every machine.

use activecell::{BitPlane, Lattice, Map, Rng};
use anyhow::Result;

const SEED: u64 = 20_260_101;

/// The maps that always run, by name.
pub fn synthetic(size: u32) -> Result<Vec<(String, Map)>> {
    Ok(vec![
        (format!("rooms-{size}"), rooms(size, 64, 4)?),
        (format!("small-rooms-{size}"), rooms(size, 8, 1)?),
        (format!("random10-{size}"), random(size, 0.1)?),
        (format!("random20-{size}"), random(size, 0.2)?),
        (format!("random40-{size}"), random(size, 0.4)?),
        (format!("maze1-{size}"), maze(size)?),
        (format!("hall-{size}"), Map::new(Lattice::Square, plane(size)?)),
        (format!("depot-{size}"), warehouse(size)?),
    ])
}

fn plane(size: u32) -> Result<BitPlane> {
    Ok(BitPlane::new(size.into(), size.into())?)
}

/// Each cell an obstacle with this probability.
pub fn random(size: u32, density: f64) -> Result<Map> {
    Ok(Map::random(Lattice::Square, size, size, density, SEED)?)
}

/// Rooms of `room` × `room` cells, walls included, with a door of `door` cells somewhere in each inner wall.
pub fn rooms(size: u32, room: u32, door: u32) -> Result<Map> {
    let mut rng = Rng::new(SEED);
    let mut plane = plane(size)?;
    for y in 0..size {
        for x in 0..size {
            plane.set(x, y, x % room == 0 || y % room == 0);
        }
    }
    let rooms = size.div_ceil(room);
    for (j, i) in (0..rooms).flat_map(|j| (0..rooms).map(move |i| (j, i))) {
        let (x0, y0) = (i * room, j * room);
        let at = |rng: &mut Rng| 1 + rng.below(room - door);
        let (along_y, along_x) = (at(&mut rng), at(&mut rng));
        for k in 0..door {
            for (x, y, inner) in [(x0, y0 + along_y + k, i > 0), (x0 + along_x + k, y0, j > 0)] {
                if inner && x < size && y < size {
                    plane.set(x, y, false);
                }
            }
        }
    }
    Ok(Map::new(Lattice::Square, plane))
}

/// A maze without loops, corridors and walls one cell wide: a walk that turns back where it is stuck.
pub fn maze(size: u32) -> Result<Map> {
    let mut rng = Rng::new(SEED);
    let mut plane = plane(size)?;
    for y in 0..size {
        for x in 0..size {
            plane.set(x, y, true);
        }
    }
    let mut way = vec![(1u32, 1u32)];
    plane.set(1, 1, false);
    while let Some(&(x, y)) = way.last() {
        let mut open = Vec::with_capacity(4);
        for (dx, dy) in [(0i64, -2i64), (2, 0), (0, 2), (-2, 0)] {
            let (nx, ny) = (i64::from(x) + dx, i64::from(y) + dy);
            let inside = (0..i64::from(size)).contains(&nx) && (0..i64::from(size)).contains(&ny);
            if inside && plane.get(nx as u32, ny as u32) {
                open.push((nx as u32, ny as u32));
            }
        }
        if open.is_empty() {
            way.pop();
            continue;
        }
        let (nx, ny) = open[rng.below(open.len() as u32) as usize];
        plane.set(u32::midpoint(x, nx), u32::midpoint(y, ny), false);
        plane.set(nx, ny, false);
        way.push((nx, ny));
    }
    Ok(Map::new(Lattice::Square, plane))
}

/// Shelves of 10 × 2 cells in rows, aisles two cells wide, a free strip at both ends.
fn warehouse(size: u32) -> Result<Map> {
    let mut plane = plane(size)?;
    for y in 4..size - 4 {
        for x in 12..size - 12 {
            plane.set(x, y, x % 12 < 10 && y % 4 < 2);
        }
    }
    Ok(Map::new(Lattice::Square, plane))
}
