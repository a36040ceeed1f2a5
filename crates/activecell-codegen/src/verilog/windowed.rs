//! The navigator whose map lies in block RAM.

use super::module;
use crate::SourceFile;
use crate::circuits::{decision, sector};
use crate::navigator::{Navigator, comparison_ports, direction_names};
use crate::template::fill;
use crate::window::{self, Gathered};
use activecell::{Error, Lattice, Map};

/// The navigator that decides a step a clock by the published rule, its map in block RAM, with all modules that it uses,
/// the images of its memories, a test bench with the trace that [`crate::model::Windowed`] makes of random tasks, and a bench
/// that shows how it is used.
///
/// ```
/// use activecell::{Lattice, Map};
/// let files = activecell_codegen::verilog::windowed(&Map::random(Lattice::Hex, 40, 20, 0.2, 1)?)?;
/// assert!(files.iter().any(|file| file.path == "rtl/windowed_hex.v"));
/// # Ok::<(), activecell::Error>(())
/// ```
///
/// # Errors
/// As [`crate::Banks::of`].
pub fn windowed(map: &Map) -> Result<Vec<SourceFile>, Error> {
    let lattice = map.lattice();
    let Navigator { banks, mut values, trace } = Navigator::of(map)?;
    values.extend([
        comparison_ports(lattice, "        ", |name| format!(".{name}({name})")),
        ("NEIGHBOURHOOD", neighbourhood(lattice)),
        ("MOVES", moves(lattice)),
        direction_names(lattice, |bits, name| {
            format!("            {}'b{bits}: name = \"{name}\";", lattice.degree())
        }),
    ]);
    let bearing = match lattice {
        Lattice::Square => include_str!("templates/bearing_square.v"),
        Lattice::Hex => include_str!("templates/bearing_hex.v"),
    };
    let rtl = |name: &str, text: String| SourceFile::new(format!("rtl/{name}.v"), text);
    let mut files = vec![
        rtl(&format!("windowed_{lattice}"), fill(include_str!("templates/windowed.v"), &values)),
        rtl("map_window", fill(include_str!("templates/map_window.v"), &values)),
        rtl("map_bank", include_str!("templates/map_bank.v").into()),
        rtl(&format!("bearing_{lattice}"), bearing.into()),
        rtl(&format!("sector_{lattice}"), module(&sector(lattice))),
        rtl(&format!("decide_{lattice}"), module(&decision(lattice))),
    ];
    files.extend(banks.images.iter().enumerate().map(|(bank, tiles)| {
        let lines = tiles.chunks(64).map(|tiles| {
            let digits: Vec<String> = tiles.iter().map(|tile| format!("{tile:x}")).collect();
            digits.join(" ") + "\n"
        });
        SourceFile::new(format!("rtl/map_{}{}.hex", bank / 4, bank % 4), lines.collect::<String>())
    }));
    let bench = |name: &str, template| SourceFile::new(format!("tb/{name}.v"), fill(template, &values));
    files.extend([
        bench("windowed_tb", include_str!("templates/windowed_tb.v")),
        bench("windowed_example_tb", include_str!("templates/windowed_example_tb.v")),
        trace,
    ]);
    Ok(files)
}

/// The lanes of the neighbourhood, from the cells of the window.
fn neighbourhood(lattice: Lattice) -> String {
    let about = ["each neighbour", "straight behind", "behind it and the next"];
    let lines = window::neighbourhood(lattice).into_iter().zip(about).map(|(lanes, about)| {
        let cells = by_row(&lanes, |cells| format!("{{{}}}", joined("window", cells, ", ")));
        format!("    wire [{}:0] {} = {cells}; // {about}\n", lattice.degree() - 1, lanes.name)
    });
    lines.collect()
}

/// Which lanes lead a column or a row on.
fn moves(lattice: Lattice) -> String {
    let lines = window::moves(lattice).map(|way| {
        let lanes = by_row(&way, |lanes| joined("direction", lanes, " | "));
        format!("    wire {} = {lanes};", way.name)
    });
    lines.join("\n")
}

/// The text for even and for odd rows, chosen by the row where they differ.
fn by_row(gathered: &Gathered, text: impl Fn(&[i32]) -> String) -> String {
    gathered.by_row(text, |even, odd| format!("at_y[0]\n        ? {odd}\n        : {even}"))
}

fn joined(vector: &str, bits: &[i32], separator: &str) -> String {
    bits.iter().map(|bit| format!("{vector}[{bit}]")).collect::<Vec<_>>().join(separator)
}
