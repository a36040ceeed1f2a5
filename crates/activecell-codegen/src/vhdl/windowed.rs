//! The navigator whose map lies in block RAM.

use super::{bench_lines, entity, lanes};
use crate::circuits::{decision, sector};
use crate::template::fill;
use crate::{Banks, SourceFile, verilog};
use activecell::{Cell, Dir, Error, Lattice, Map};

/// The navigator of [`crate::verilog::windowed`], with the same ports and generics, and its test bench, which reads the
/// same file. The map is a package here, which every tool takes.
///
/// The files are in the order in which they can be analysed.
///
/// # Errors
/// As [`Banks::of`].
///
/// ```
/// use activecell::{Lattice, Map};
/// let files = activecell_codegen::vhdl::windowed(&Map::random(Lattice::Hex, 40, 20, 0.2, 1)?)?;
/// assert!(files.iter().any(|file| file.path == "rtl/windowed_hex.vhd"));
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn windowed(map: &Map) -> Result<Vec<SourceFile>, Error> {
    let lattice = map.lattice();
    let banks = Banks::of(map)?;
    let values = values(map, &banks);
    let values: Vec<(&str, &str)> = values.iter().map(|(name, value)| (*name, value.as_str())).collect();
    let rtl = |name: &str, text: String| SourceFile::new(format!("rtl/{name}.vhd"), text);
    let bearing = match lattice {
        Lattice::Square => include_str!("templates/bearing_square.vhd"),
        Lattice::Hex => include_str!("templates/bearing_hex.vhd"),
    };
    let mut files = vec![
        lanes(),
        rtl("map_image", fill(&image(&banks), &values)),
        rtl("map_bank", include_str!("templates/map_bank.vhd").into()),
        rtl("map_window", fill(include_str!("templates/map_window.vhd"), &values)),
        rtl(&format!("bearing_{lattice}"), bearing.into()),
        rtl(&format!("sector_{lattice}"), entity(&sector(lattice))),
        rtl(&format!("decide_{lattice}"), entity(&decision(lattice))),
        rtl(&format!("windowed_{lattice}"), fill(include_str!("templates/windowed.vhd"), &values)),
        bench_lines(),
        SourceFile::new("tb/windowed_tb.vhd", fill(include_str!("templates/windowed_tb.vhd"), &values)),
    ];
    let [_, trace] = verilog::windowed_bench(map, &banks);
    files.push(trace);
    Ok(files)
}

fn values(map: &Map, banks: &Banks) -> Vec<(&'static str, String)> {
    let lattice = map.lattice();
    let cells = match lattice {
        Lattice::Square => "squares",
        Lattice::Hex => "hexagons, odd rows shifted right",
    };
    let sector = sector(lattice);
    let inputs: Vec<&str> = sector.inputs.iter().map(|port| port.name.as_str()).collect();
    let bearing = [&inputs[..], &["is_near"]].concat();
    let connected = |names: &[&str]| {
        let lines = names.chunks(4).map(|names| {
            let ports: Vec<String> = names.iter().map(|name| format!("{name} => {name}")).collect();
            ports.join(", ")
        });
        lines.collect::<Vec<_>>().join(",\n            ")
    };
    let digits = |bits: u32| bits.div_ceil(4).to_string();
    vec![
        ("X_BITS", banks.x_bits.to_string()),
        ("Y_BITS", banks.y_bits.to_string()),
        ("WIDTH", map.width().to_string()),
        ("HEIGHT", map.height().to_string()),
        ("X_DIGITS", digits(banks.x_bits)),
        ("Y_DIGITS", digits(banks.y_bits)),
        ("LATTICE", lattice.to_string()),
        ("CELLS", cells.into()),
        ("TOP", (lattice.degree() - 1).to_string()),
        ("SECTOR_TOP", (sector.outputs().map(|wire| wire.port.width).sum::<u32>() - 1).to_string()),
        ("BEARING_NAMES", bearing.join(", ")),
        ("BEARING_PORTS", connected(&bearing)),
        ("SECTOR_PORTS", connected(&inputs)),
        ("NEIGHBOURHOOD", neighbourhood(lattice)),
        ("MOVES", moves(lattice)),
    ]
}

/// The package of the map, with its banks filled in.
fn image(banks: &Banks) -> String {
    let text = |(bank, tiles): (usize, &Vec<u8>)| {
        let lines = tiles.chunks(64).map(|tiles| {
            let digits: Vec<String> = tiles.iter().map(|tile| format!("{tile:x}")).collect();
            format!("        \"{}\"", digits.concat())
        });
        format!("    constant BANK_{bank} : string :=\n{};\n", lines.collect::<Vec<_>>().join(" &\n"))
    };
    let texts: String = banks.images.iter().enumerate().map(text).collect();
    let last = banks.images.len() - 1;
    let choice = |bank: usize| {
        let choice = if bank == last { "others".into() } else { bank.to_string() };
        format!("            when {choice} => return read(BANK_{bank});\n")
    };
    let choices: String = (0..=last).map(choice).collect();
    fill(include_str!("templates/map_image.vhd"), &[("BANKS", &texts), ("CHOICES", &choices)])
}

/// The text for even and for odd rows, chosen by the row where they differ.
fn by_row(lattice: Lattice, of: impl Fn(Cell) -> String) -> String {
    let [even, odd] = [Cell::new(0, 0), Cell::new(0, 1)].map(of);
    match lattice {
        Lattice::Square => even,
        Lattice::Hex if even == odd => even,
        Lattice::Hex => format!("{odd} when at_y(0) = '1' else\n        {even}"),
    }
}

/// The lanes of the neighbourhood, from the cells of the window.
fn neighbourhood(lattice: Lattice) -> String {
    let lanes = |name: &str, place: &dyn Fn(Cell, u8) -> Cell| {
        let joined = by_row(lattice, |from| {
            let bits = (0..lattice.degree()).rev().map(|lane| {
                let cell = place(from, lane);
                format!("window({})", 5 * (cell.y - from.y + 2) + cell.x - from.x + 2)
            });
            bits.collect::<Vec<_>>().join(" & ")
        });
        format!("    {name} <=\n        {joined};\n")
    };
    [
        lanes("ring1", &|from, lane| lattice.neighbour(from, Dir(lane))),
        lanes("ahead", &|from, lane| lattice.ring2(from, 2 * lane)),
        lanes("between", &|from, lane| lattice.ring2(from, 2 * lane + 1)),
    ]
    .concat()
}

/// Which lanes lead a column or a row on.
fn moves(lattice: Lattice) -> String {
    let line = |name: &str, leads: fn(Cell, Cell) -> bool| {
        let lanes = by_row(lattice, |from| {
            let lanes = lattice.dirs().filter(|&dir| leads(from, lattice.neighbour(from, dir)));
            lanes.map(|dir| format!("step({})", dir.0)).collect::<Vec<_>>().join(" or ")
        });
        format!("    {name} <= {lanes};\n")
    };
    [
        line("to_right", |from, to| to.x > from.x),
        line("to_left", |from, to| to.x < from.x),
        line("to_below", |from, to| to.y > from.y),
        line("to_above", |from, to| to.y < from.y),
    ]
    .concat()
}
