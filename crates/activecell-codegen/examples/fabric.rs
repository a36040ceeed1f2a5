//! Writes the fabric of a random map into a folder: `fabric FOLDER square|hex WIDTH HEIGHT loadable|fixed`.

use activecell::{Lattice, Map};
use activecell_codegen::verilog;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [folder, lattice, width, height, kind] = args.as_slice() else { return Err("five arguments".into()) };
    let lattice = if lattice == "hex" { Lattice::Hex } else { Lattice::Square };
    let map = Map::random(lattice, width.parse()?, height.parse()?, 0.25, 1)?;
    for file in verilog::fabric(&map, kind == "loadable")? {
        let path = std::path::Path::new(folder).join(&file.path);
        std::fs::create_dir_all(path.parent().expect("it is in a folder"))?;
        std::fs::write(path, file.text)?;
    }
    Ok(())
}
