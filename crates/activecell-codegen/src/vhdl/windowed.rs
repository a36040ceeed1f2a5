//! The navigator whose map lies in block RAM.

use super::{bench_lines, entity, lanes};
use crate::circuits::{decision, sector};
use crate::navigator::{Navigator, comparison_ports, direction_names};
use crate::template::fill;
use crate::window::{self, Gathered};
use crate::{Banks, SourceFile};
use activecell::{Error, Lattice, Map};

/// The navigator of [`crate::verilog::windowed`], with the same ports, its test bench, which reads the same file, and
/// its example. The map is a package here, which every tool takes, so no file's path is a generic.
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
    let Navigator { banks, mut values, trace } = Navigator::of(map)?;
    values.extend([
        comparison_ports(lattice, "            ", |name| format!("{name} => {name}")),
        ("NEIGHBOURHOOD", neighbourhood(lattice)),
        ("MOVES", moves(lattice)),
        direction_names(lattice, |bits, name| format!("            when \"{bits}\" => return \"{name}\";")),
    ]);
    let rtl = |name: &str, text: String| SourceFile::new(format!("rtl/{name}.vhd"), text);
    let bench = |name: &str, template| SourceFile::new(format!("tb/{name}.vhd"), fill(template, &values));
    let bearing = match lattice {
        Lattice::Square => include_str!("templates/bearing_square.vhd"),
        Lattice::Hex => include_str!("templates/bearing_hex.vhd"),
    };
    Ok(vec![
        lanes(),
        rtl("map_image", fill(&image(&banks), &values)),
        rtl("map_bank", include_str!("templates/map_bank.vhd").into()),
        rtl("map_window", fill(include_str!("templates/map_window.vhd"), &values)),
        rtl(&format!("bearing_{lattice}"), bearing.into()),
        rtl(&format!("sector_{lattice}"), entity(&sector(lattice))),
        rtl(&format!("decide_{lattice}"), entity(&decision(lattice))),
        rtl(&format!("windowed_{lattice}"), fill(include_str!("templates/windowed.vhd"), &values)),
        bench_lines(),
        bench("windowed_tb", include_str!("templates/windowed_tb.vhd")),
        bench("windowed_example_tb", include_str!("templates/windowed_example_tb.vhd")),
        trace,
    ])
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

/// The lanes of the neighbourhood, from the cells of the window.
fn neighbourhood(lattice: Lattice) -> String {
    let lines = window::neighbourhood(lattice).map(|lanes| {
        let cells = by_row(&lanes, |cells| joined("window", cells, " & "));
        format!("    {} <=\n        {cells};\n", lanes.name)
    });
    lines.concat()
}

/// Which lanes lead a column or a row on.
fn moves(lattice: Lattice) -> String {
    let lines = window::moves(lattice).map(|way| {
        let lanes = by_row(&way, |lanes| joined("step", lanes, " or "));
        format!("    {} <= {lanes};\n", way.name)
    });
    lines.concat()
}

/// The text for even and for odd rows, chosen by the row where they differ.
fn by_row(gathered: &Gathered, text: impl Fn(&[i32]) -> String) -> String {
    gathered.by_row(text, |even, odd| format!("{odd} when cell_y(0) = '1' else\n        {even}"))
}

fn joined(vector: &str, bits: &[i32], separator: &str) -> String {
    bits.iter().map(|bit| format!("{vector}({bit})")).collect::<Vec<_>>().join(separator)
}
