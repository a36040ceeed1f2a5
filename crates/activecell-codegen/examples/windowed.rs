//! Writes a windowed navigator of a random map: `windowed square|hex WIDTH HEIGHT FOLDER`.

use activecell::{Lattice, Map};
use activecell_codegen::verilog;
use std::error::Error;
use std::fs;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [lattice, width, height, folder] = &arguments[..] else {
        return Err("usage: windowed square|hex WIDTH HEIGHT FOLDER".into());
    };
    let lattice = if lattice == "hex" { Lattice::Hex } else { Lattice::Square };
    let map = Map::random(lattice, width.parse()?, height.parse()?, 0.15, 1)?;
    for file in verilog::windowed(&map)? {
        let path = Path::new(folder).join(file.path);
        fs::create_dir_all(path.parent().unwrap_or(Path::new(".")))?;
        fs::write(path, file.text)?;
    }
    Ok(())
}
