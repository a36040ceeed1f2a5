//! Writes the firmware of a text map into a folder: `firmware square|hex MAP FOLDER`.

use activecell::{Lattice, Map};
use activecell_codegen::c;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let lattice = if arguments[1] == "hex" { Lattice::Hex } else { Lattice::Square };
    let map = Map::parse(lattice, &std::fs::read_to_string(&arguments[2])?)?;
    for file in c::firmware(&map, None)? {
        let path = std::path::Path::new(&arguments[3]).join(file.path);
        std::fs::create_dir_all(path.parent().unwrap())?;
        std::fs::write(path, file.text)?;
    }
    Ok(())
}
