//! The fabric: a small automaton for every cell of the map.

use super::fabric_bench::bench;
use super::module;
use crate::colours::{Colours, goes, leads};
use crate::images::bits_below;
use crate::template::fill;
use crate::window::Offset;
use crate::{SourceFile, circuits};
use activecell::{Dir, Error, Lattice, Map};

/// The most cells that a fabric may have; larger maps do not fit into the FPGAs that this is for.
pub const MAX_FABRIC_CELLS: u64 = 4096;

/// The fabric of a map's lattice and size: the cell's rule, the cell, all of them with their control, an example of their
/// use, and a test bench.
///
/// Loadable, its map comes through a chain of registers, and `fabric_top` is the fabric that loads the map given; else the
/// map is wired in, and obstacles take no hardware.
///
/// # Errors
/// [`Error::MapTooLarge`] above [`MAX_FABRIC_CELLS`]: such maps are for the windowed navigator.
///
/// ```
/// use activecell::{Lattice, Map};
/// use activecell_codegen::verilog;
/// let files = verilog::fabric(&Map::parse(Lattice::Hex, "..#\n...")?, false)?;
/// let paths: Vec<&str> = files.iter().map(|file| file.path.as_str()).collect();
/// assert_eq!(paths[..3], ["rtl/fabric_step_hex.v", "rtl/fabric_cell_hex.v", "rtl/fabric.v"]);
/// assert!(files[2].text.contains("3'b001,\n"), "the map as it lies");
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn fabric(map: &Map, loadable: bool) -> Result<Vec<SourceFile>, Error> {
    checked(map)?;
    let lattice = map.lattice();
    let step = circuits::fabric_cell(lattice);
    let values = values(map, loadable);
    // Some values have places of their own.
    let filled =
        |path: String, template: &str| SourceFile::new(path, fill(&fill(template, &values), &values));
    let mut files = vec![
        SourceFile::new(format!("rtl/{}.v", step.name), module(&step)),
        filled(format!("rtl/fabric_cell_{lattice}.v"), include_str!("templates/fabric_cell.v")),
        filled("rtl/fabric.v".into(), include_str!("templates/fabric.v")),
    ];
    if loadable {
        files.push(filled("rtl/fabric_top.v".into(), include_str!("templates/fabric_top.v")));
    }
    files.push(filled("tb/fabric_example_tb.v".into(), include_str!("templates/fabric_example_tb.v")));
    files.extend(bench(map, loadable));
    Ok(files)
}

/// Refuses maps that are too large for a fabric.
pub(crate) fn checked(map: &Map) -> Result<(), Error> {
    let (width, height) = (map.width().into(), map.height().into());
    if width * height > MAX_FABRIC_CELLS {
        return Err(Error::MapTooLarge { width, height, limit: MAX_FABRIC_CELLS });
    }
    Ok(())
}

/// The values that both languages share; the header is a comment behind this sign.
pub(crate) fn shared_values(map: &Map, loadable: bool, sign: &str) -> Vec<(&'static str, String)> {
    let lattice = map.lattice();
    let names: Vec<&str> = lattice.dirs().map(|dir| lattice.dir_name(dir)).collect();
    let [columns, rows, cells] = [map.width(), map.height(), map.width() * map.height()].map(bits_below);
    // Where no cell is free, the example says that there is no way.
    let (from, to) = crate::long_way(map).unwrap_or_default();
    let choose = |yes: &str, no: &str| String::from(if loadable { yes } else { no });
    let values = vec![
        ("MAP_ABOUT", choose(include_str!("templates/fabric_map_about.txt"), "\n")),
        ("OR_LOADING", choose(" or loading", "")),
        ("DUT", choose("fabric_top", "fabric")),
        ("LATTICE", lattice.name().into()),
        ("DEGREE", lattice.degree().to_string()),
        ("TOP", (lattice.degree() - 1).to_string()),
        ("NAMES", names.join(", ")),
        ("COLOURS", Colours::of_moves(lattice).count.to_string()),
        ("WIDTH", map.width().to_string()),
        ("HEIGHT", map.height().to_string()),
        ("COLUMN_BITS", columns.to_string()),
        ("COLUMN_TOP", (columns - 1).to_string()),
        ("ROW_BITS", rows.to_string()),
        ("ROW_TOP", (rows - 1).to_string()),
        ("CELL_TOP", (cells - 1).to_string()),
        ("FROM_X", from.x.to_string()),
        ("FROM_Y", from.y.to_string()),
        ("TO_X", to.x.to_string()),
        ("TO_Y", to.y.to_string()),
    ];
    let about = fill(include_str!("templates/fabric_about.txt"), &values);
    let lines: Vec<String> =
        about.lines().map(|line| format!("{sign} {line}").trim_end().to_owned()).collect();
    [values, vec![("ABOUT", lines.join("\n"))]].concat()
}

fn values(map: &Map, loadable: bool) -> Vec<(&'static str, String)> {
    let lattice = map.lattice();
    let (width, height) = (map.width(), map.height());
    let choose = |yes: &str, no: &str| String::from(if loadable { yes } else { no });
    let odd = match lattice {
        Lattice::Square => "",
        Lattice::Hex => {
            "                    localparam ODD = ROW % 2; // odd rows are half a cell further right\n"
        }
    };
    let parameters =
        format!("    parameter WIDTH = {width}, // columns\n    parameter HEIGHT = {height}, // rows\n");
    let constants = format!("    localparam WIDTH = {width};\n    localparam HEIGHT = {height};\n");
    let own = vec![
        ("SIZE_PARAMETERS", choose(&parameters, "")),
        ("SIZE_CONSTANTS", choose("", &constants)),
        ("MAP_PORTS", choose(include_str!("templates/fabric_map_ports.v"), "")),
        (
            "MAP",
            choose(
                include_str!("templates/fabric_map_loaded.v"),
                include_str!("templates/fabric_map_fixed.v"),
            ),
        ),
        ("IS_FREE", choose(include_str!("templates/fabric_cell_loaded.v"), FIXED)),
        ("ROWS", rows(map)),
        ("LOADING", choose("        .loading(loading),\n", "")),
        ("NO_LOADING", choose("", "    assign loading = 1'b0; // the map is wired in\n")),
        ("COLOUR", Colours::of_moves(lattice).formula("COLUMN", "ROW", "%")),
        ("WATCHED", Colours::of_neighbours(lattice).formula("COLUMN", "ROW", "%")),
        ("MOVES", moves(lattice)),
        ("ODD", odd.into()),
        ("REACHED", lanes(lattice, |place, _| format!("reached{place}"))),
        ("ENTERING", lanes(lattice, |place, dir| format!("leaving{place}[{}]", lattice.opposite(dir).0))),
    ];
    [own, shared_values(map, loadable, "//")].concat()
}

/// Whether a cell is free where the map is wired in.
const FIXED: &str = "                    wire is_free = ~OBSTACLES[HERE];
";

/// The map as rows of bits that read as it lies.
fn rows(map: &Map) -> String {
    let row = |row| format!("        {}'b{row}", map.width());
    rows_of_bits(map).map(row).collect::<Vec<_>>().join(",\n")
}

/// The map as it lies, 1 for an obstacle.
pub(crate) fn rows_of_bits(map: &Map) -> impl Iterator<Item = String> + '_ {
    let bit = |x, y| if map.obstacles().get(x, y) { '1' } else { '0' };
    (0..map.height()).map(move |y| (0..map.width()).map(|x| bit(x, y)).collect())
}

/// A wire from each neighbour, the last lane first.
fn lanes(lattice: Lattice, wire: impl Fn(&str, Dir) -> String) -> String {
    let lanes: Vec<String> = lattice
        .dirs()
        .rev()
        .map(|dir| {
            let comma = if dir.0 == 0 { "" } else { "," };
            let [x, y] = neighbour(lattice, dir);
            let wire = wire(&format!("[{y}][{x}]"), dir) + comma;
            format!("                        {wire:<32} // {}", lattice.dir_name(dir))
        })
        .collect();
    lanes.join("\n")
}

/// The column and row of a neighbour of (x, y), from the core's offsets in even and odd rows.
pub(crate) fn neighbour(lattice: Lattice, dir: Dir) -> [String; 2] {
    let Offset { columns: [even, odd], rows } = Offset::of_dir(lattice, dir);
    let shift = if odd == even { "" } else { " + ODD" };
    let offset = |step: i32| match step {
        0 => String::new(),
        step if step < 0 => format!(" - {}", -step),
        step => format!(" + {step}"),
    };
    [format!("x{}{shift}", offset(even)), format!("y{}", offset(rows))]
}

/// Which moves the robot's colours tell, and where these lead.
fn moves(lattice: Lattice) -> String {
    let colours = Colours::of_moves(lattice);
    let goes = lattice.dirs().map(|dir| {
        let (name, step) = (goes(lattice, dir), colours.step(dir));
        let stepped = format!("(last_colour << {step} | last_colour >> {})", colours.count - step);
        format!("    wire {name:<7} = |(colour & {stepped});\n")
    });
    let leads = leads(lattice, ["|", "&"], ["~at_y[0]", "at_y[0]"])
        .map(|(name, when)| format!("    wire {name:<7} = {when};\n"));
    goes.chain(leads).collect::<String>().trim_end().to_owned()
}
