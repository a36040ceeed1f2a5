//! The fabric: a small automaton for every cell of the map.

use super::{bench_lines, entity, lanes};
use crate::colours::{Colours, goes, leads};
use crate::template::fill;
use crate::verilog::{checked, neighbour, rows_of_bits, shared_values};
use crate::{SourceFile, circuits, verilog};
use activecell::{Dir, Error, Lattice, Map};

/// The fabric of [`crate::verilog::fabric`], with the same ports and generics, and its test bench, which reads the same
/// file.
///
/// The files are in the order in which they can be analysed.
///
/// # Errors
/// [`Error::MapTooLarge`] above [`crate::verilog::MAX_FABRIC_CELLS`].
///
/// ```
/// use activecell::{Lattice, Map};
/// let files = activecell_codegen::vhdl::fabric(&Map::random(Lattice::Hex, 8, 6, 0.2, 1)?, true)?;
/// assert!(files.iter().any(|file| file.path == "rtl/fabric_cell_hex.vhd"));
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
        lanes(),
        SourceFile::new(format!("rtl/{}.vhd", step.name), entity(&step)),
        filled(format!("rtl/fabric_cell_{lattice}.vhd"), include_str!("templates/fabric_cell.vhd")),
        filled("rtl/fabric.vhd".into(), include_str!("templates/fabric.vhd")),
    ];
    if loadable {
        files.push(filled("rtl/fabric_top.vhd".into(), include_str!("templates/fabric_top.vhd")));
    }
    files.extend([
        filled("tb/fabric_example_tb.vhd".into(), include_str!("templates/fabric_example_tb.vhd")),
        bench_lines(),
        filled("tb/fabric_tb.vhd".into(), include_str!("templates/fabric_tb.vhd")),
    ]);
    files.push(verilog::fabric_trace(map, loadable).0);
    Ok(files)
}

fn values(map: &Map, loadable: bool) -> Vec<(&'static str, String)> {
    let lattice = map.lattice();
    let (width, height) = (map.width(), map.height());
    let odd = match lattice {
        Lattice::Square => "",
        Lattice::Hex => {
            "            constant ODD  : natural := y mod 2; -- odd rows are shifted right by half a cell\n"
        }
    };
    let around = [
        around("reached_around", lattice, |neighbour, _| format!("reached({neighbour})")),
        around("entering", lattice, |neighbour, dir| {
            format!("leaving({}*{neighbour} + {})", lattice.degree(), lattice.opposite(dir).0)
        }),
    ];
    let [move_signals, moves] = moves(lattice);
    let choose = |yes: &str, no: &str| String::from(if loadable { yes } else { no });
    let generics = format!(
        "        WIDTH       : positive := {width}; -- columns\n        HEIGHT      : positive := {height}; -- rows\n"
    );
    let constants = format!(
        "    constant WIDTH   : positive := {width};\n    constant HEIGHT  : positive := {height};\n"
    );
    let own = vec![
        ("SIZE_GENERICS", choose(&generics, "")),
        ("SIZE_CONSTANTS", choose("", &constants)),
        ("MAP_PORTS", choose(include_str!("templates/fabric_map_ports.vhd"), "")),
        ("MAP_CONNECTIONS", choose("load_map => told(2), scan_in => told(1), scan_out => open, ", "")),
        ("LOADING", choose(include_str!("templates/fabric_loading.vhd"), "")),
        ("LOADING_PORT", choose("loading => loading, ", "")),
        ("STOP", choose("reset or load_map", "reset")),
        ("MAP", choose(LOADED, FIXED)),
        ("ROWS", rows(map)),
        ("ODD", odd.into()),
        ("AROUND", around.concat()),
        ("COLOUR", Colours::of_moves(lattice).formula("x", "y", "mod")),
        ("WATCHED", Colours::of_neighbours(lattice).formula("x", "y", "mod")),
        ("MOVE_SIGNALS", move_signals),
        ("MOVES", moves),
    ];
    [own, shared_values(map, loadable, "--")].concat()
}

const LOADED: &str = "    -- The map: a chain of registers through all cells, 1 for a free cell. All are obstacles after power-up.
    signal free : std_logic_vector(0 to CELLS - 1) := (others => '0');
";

const FIXED: &str = "    -- The map: 1 for an obstacle. Cells that are obstacles need no hardware.
    constant OBSTACLES : std_logic_vector(0 to CELLS - 1) :=
@ROWS@;
    constant FREE : std_logic_vector(0 to CELLS - 1) := not OBSTACLES;
";

/// The map as rows of bits that read as it lies.
fn rows(map: &Map) -> String {
    rows_of_bits(map).map(|row| format!("        \"{row}\"")).collect::<Vec<_>>().join(" &\n")
}

/// A bit from each neighbour, the last lane first.
fn around(name: &str, lattice: Lattice, bit: impl Fn(&str, Dir) -> String) -> String {
    let lanes = lattice.dirs().rev().map(|dir| {
        let end = if dir.0 == 0 { ";" } else { " &" };
        let [x, y] = neighbour(lattice, dir);
        let bit = bit(&format!("at({x}, {y})"), dir) + end;
        format!("                {bit:<42} -- {}\n", lattice.dir_name(dir))
    });
    format!("            {name} <=\n{}", lanes.collect::<Vec<_>>().concat())
}

/// Which moves the robot's colours tell, and where these lead: the signals and what drives them.
fn moves(lattice: Lattice) -> [String; 2] {
    let step = |dir| format!("goes(last_colour, colour, {})", Colours::of_moves(lattice).step(dir));
    let goes = lattice.dirs().map(|dir| (goes(lattice, dir), step(dir)));
    let leads =
        leads(lattice, ["or", "and"], ["not row(0)", "row(0)"]).map(|(name, when)| (name.to_owned(), when));
    let signals: Vec<(String, String)> = goes.chain(leads).collect();
    let lines = |line: fn(&(String, String)) -> String| signals.iter().map(line).collect::<Vec<_>>().concat();
    [
        lines(|(name, _)| format!("    signal {name:<7} : std_logic;\n")),
        lines(|(name, when)| format!("    {name:<7} <= {when};\n")),
    ]
}
