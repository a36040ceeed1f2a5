//! The fabric: a small automaton for every cell of the map.

use super::fabric_bench::bench;
use super::module;
use crate::colours::{Colours, goes, leads};
use crate::images::bits_below;
use crate::template::fill;
use crate::{SourceFile, circuits};
use activecell::{Cell, Dir, Error, Lattice, Map};

/// The most cells that a fabric may have; larger maps do not fit into the FPGAs that this is for.
pub const MAX_FABRIC_CELLS: u64 = 4096;

/// The fabric of a map's lattice and size: the cell's rule, the cell, all of them with their control, and a test bench.
///
/// Loadable, its map comes through a chain of registers; else it is the map given, and obstacles take no hardware.
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
    let mut files = vec![
        SourceFile::new(format!("rtl/{}.v", step.name), module(&step)),
        SourceFile::new(
            format!("rtl/fabric_cell_{lattice}.v"),
            for_lattice(lattice, include_str!("templates/fabric_cell.v")),
        ),
        SourceFile::new("rtl/fabric.v", top(map, loadable)),
    ];
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

/// What depends on the lattice alone.
fn for_lattice(lattice: Lattice, template: &str) -> String {
    let degree = lattice.degree();
    let names: Vec<&str> = lattice.dirs().map(|dir| lattice.dir_name(dir)).collect();
    let (degree, top) = (degree.to_string(), (degree - 1).to_string());
    let values =
        [("LATTICE", lattice.name()), ("DEGREE", &degree), ("TOP", &top), ("NAMES", &names.join(", "))];
    fill(template, &values)
}

fn top(map: &Map, loadable: bool) -> String {
    let lattice = map.lattice();
    let (ports, storage) = if loadable {
        (
            include_str!("templates/fabric_map_ports.v"),
            include_str!("templates/fabric_map_loaded.v").to_owned(),
        )
    } else {
        ("", include_str!("templates/fabric_map_fixed.v").replace("@ROWS@\n", &rows(map)))
    };
    let odd = match lattice {
        Lattice::Square => "",
        Lattice::Hex => {
            "                    localparam ODD = ROW % 2; // odd rows are half a cell further right\n"
        }
    };
    let reached = lanes(lattice, |place, _| format!("{place}.reached"));
    let entering = lanes(lattice, |place, dir| format!("{place}.leaving[{}]", lattice.opposite(dir).0));
    let colours = Colours::of_moves(lattice);
    for_lattice(lattice, include_str!("templates/fabric.v"))
        .replace("@COLOURS@", &colours.count.to_string())
        .replace("@COLOUR@", &colours.formula("COLUMN", "ROW", "%"))
        .replace("@WATCHED@", &Colours::of_neighbours(lattice).formula("COLUMN", "ROW", "%"))
        .replace("@MOVES@\n", &moves(lattice))
        .replace("@MAP_PORTS@", ports)
        .replace("@MAP@\n", &storage)
        .replace("@ODD@", odd)
        .replace("@REACHED@\n", &reached)
        .replace("@ENTERING@\n", &entering)
        .replace("@WIDTH@", &map.width().to_string())
        .replace("@HEIGHT@", &map.height().to_string())
        .replace("@COLUMN_BITS@", &bits_below(map.width()).to_string())
        .replace("@ROW_BITS@", &bits_below(map.height()).to_string())
}

/// The map as rows of bits that read as it lies.
fn rows(map: &Map) -> String {
    let bit = |x, y| if map.obstacles().get(x, y) { '1' } else { '0' };
    let row = |y| (0..map.width()).map(|x| bit(x, y)).collect::<String>();
    let rows: Vec<String> =
        (0..map.height()).map(|y| format!("        {}'b{}", map.width(), row(y))).collect();
    rows.join(",\n") + "\n"
}

/// A wire from each neighbour, the last lane first.
fn lanes(lattice: Lattice, wire: impl Fn(&str, Dir) -> String) -> String {
    let lanes: Vec<String> = lattice
        .dirs()
        .rev()
        .map(|dir| {
            let comma = if dir.0 == 0 { "" } else { "," };
            let [x, y] = neighbour(lattice, dir);
            let wire = wire(&format!("row[{y}].column[{x}]"), dir) + comma;
            format!("                        {wire:<42} // {}\n", lattice.dir_name(dir))
        })
        .collect();
    lanes.concat()
}

/// The column and row of a neighbour of (x, y), from the core's offsets in even and odd rows.
pub(crate) fn neighbour(lattice: Lattice, dir: Dir) -> [String; 2] {
    let [even, odd] = [0, 1].map(|y| lattice.neighbour(Cell::new(0, y), dir));
    let shift = if odd.x == even.x { "" } else { " + ODD" };
    let offset = |step: i32| match step {
        0 => String::new(),
        step if step < 0 => format!(" - {}", -step),
        step => format!(" + {step}"),
    };
    [format!("x{}{shift}", offset(even.x)), format!("y{}", offset(even.y))]
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
    goes.chain(leads).collect()
}
