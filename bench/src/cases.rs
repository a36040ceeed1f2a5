//! Cases: a map, its tasks and the right answers, kept in files that all runners read.
//!
//! `map.json` and `grow.json` list them by group, so that a process which measures its memory reads a short list.
//! Each map is a file of bytes, row by row, 0 free and 1 an obstacle.

use activecell::{BitPlane, Cell, Lattice, Map};
use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::io::{BufReader, BufWriter, Read, Write};
use std::path::Path;

/// A task: from x, y, to x, y, and the steps of a shortest route.
pub type Task = [u32; 5];

/// What all methods are asked, and what they must answer.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Case {
    pub name: String,
    /// `map` or `grow` (the same kind of map in growing sizes).
    pub group: String,
    /// Where the map is from: `MovingAI`, `ROS` or `synthetic`.
    pub source: String,
    pub width: u32,
    pub height: u32,
    pub free: usize,
    /// In an order in which the first n are an even sample, whatever n.
    pub tasks: Vec<Task>,
    /// Tasks left out: no way, or no step to make.
    pub left_out: usize,
    /// Where the field's wave starts.
    pub target: [u32; 2],
    pub field: Digest,
}

/// A whole field of distances in three numbers, the same for the same field.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Digest {
    pub reached: u64,
    pub furthest: u32,
    /// Sum over the reached cells of (steps + 1) · (cell number + 1) · an odd constant, modulo 2⁶⁴; as text,
    /// since not every language has such numbers.
    pub sum: String,
}

impl Digest {
    /// Of the steps of each cell in row order, `None` where the wave did not come.
    pub fn of(steps: impl Iterator<Item = Option<u32>>) -> Self {
        let (mut reached, mut furthest, mut sum) = (0, 0, 0u64);
        for (index, steps) in steps.enumerate() {
            if let Some(steps) = steps {
                reached += 1;
                furthest = furthest.max(steps);
                let place = (index as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
                sum = sum.wrapping_add((u64::from(steps) + 1).wrapping_mul(place));
            }
        }
        Self { reached, furthest, sum: sum.to_string() }
    }
}

impl Case {
    pub fn from_to(task: &Task) -> (Cell, Cell) {
        let cell = |x: u32, y: u32| Cell::new(x as i32, y as i32);
        (cell(task[0], task[1]), cell(task[2], task[3]))
    }

    pub fn target(&self) -> Cell {
        Cell::new(self.target[0] as i32, self.target[1] as i32)
    }

    /// Reads the map a row at a time, so that the memory of the process is the map's and the method's alone.
    pub fn load(&self, folder: &Path) -> Result<Map> {
        let path = folder.join(format!("{}.bin", self.name));
        let mut file = BufReader::new(File::open(&path).with_context(|| path.display().to_string())?);
        let mut plane = BitPlane::new(self.width.into(), self.height.into())?;
        let mut row = vec![0; self.width as usize];
        for y in 0..self.height {
            file.read_exact(&mut row)?;
            for (x, &byte) in row.iter().enumerate() {
                if byte != 0 {
                    plane.set(x as u32, y, true);
                }
            }
        }
        Ok(Map::new(Lattice::Square, plane))
    }
}

pub fn save_map(map: &Map, name: &str, folder: &Path) -> Result<()> {
    let mut file = BufWriter::new(File::create(folder.join(format!("{name}.bin")))?);
    for y in 0..map.height() {
        let row: Vec<u8> = (0..map.width()).map(|x| u8::from(map.obstacles().get(x, y))).collect();
        file.write_all(&row)?;
    }
    Ok(file.flush()?)
}

/// The list of a group's cases.
pub fn save(cases: &[Case], group: &str, folder: &Path) -> Result<()> {
    let cases: Vec<&Case> = cases.iter().filter(|case| case.group == group).collect();
    Ok(std::fs::write(folder.join(format!("{group}.json")), serde_json::to_string(&cases)?)?)
}

/// Reads the list of a group's cases.
pub fn load(group: &str, folder: &Path) -> Result<Vec<Case>> {
    let path = folder.join(format!("{group}.json"));
    let text = std::fs::read_to_string(&path).with_context(|| path.display().to_string())?;
    Ok(serde_json::from_str(&text)?)
}
