//! Writes the program player of a small route into a folder, in Verilog and in VHDL: `player FOLDER`.

use activecell::{Cell, Lattice, Map, Robot, Rule};
use activecell_codegen::{model::player::segments, verilog, vhdl};
use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).ok_or("usage: player FOLDER")?);
    let map = Map::parse(Lattice::Square, "S..#....\n..#...#.\n.#..##..\n....#...\n.##...#F")?;
    let robot = Robot { ticks_per_rev: 100.0, ..Robot::default() };
    let route = map.route(Rule::Wave, Cell::new(0, 0), Cell::new(7, 4), 1000)?;
    let segments = segments(&route.program(&robot, &map, None), &robot, Lattice::Square)?;
    for file in [verilog::player(&segments)?, vhdl::player(&segments)?].concat() {
        let path = folder.join(file.path);
        path.parent().map_or(Ok(()), std::fs::create_dir_all)?;
        std::fs::write(path, file.text)?;
    }
    Ok(())
}
