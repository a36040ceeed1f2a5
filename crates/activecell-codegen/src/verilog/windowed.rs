//! The navigator whose map lies in block RAM.

use super::module;
use crate::circuits::{decision, sector};
use crate::model::{Shown, Status, Windowed};
use crate::template::fill;
use crate::{Banks, SourceFile};
use activecell::{Cell, Dir, Error, Lattice, Map, Rng};

const NAVIGATOR: &str = include_str!("templates/windowed.v");
const WINDOW: &str = include_str!("templates/map_window.v");
const BANK: &str = include_str!("templates/map_bank.v");
const BENCH: &str = include_str!("templates/windowed_tb.v");

/// Tasks that the test bench runs, at most; and clocks of each, and of all.
const TASKS: usize = 64;
const CLOCKS_PER_TASK: usize = 1024;
const CLOCKS: usize = 16_384;

/// The navigator that decides a step a clock by the published rule, its map in block RAM, with all modules that it uses,
/// the images of its memories, and a test bench with the trace that [`crate::model::Windowed`] makes of random tasks.
///
/// ```
/// use activecell::{Lattice, Map};
/// let files = activecell_codegen::verilog::windowed(&Map::random(Lattice::Hex, 40, 20, 0.2, 1)?)?;
/// assert!(files.iter().any(|file| file.path == "rtl/windowed_hex.v"));
/// # Ok::<(), activecell::Error>(())
/// ```
///
/// # Errors
/// As [`Banks::of`].
pub fn windowed(map: &Map) -> Result<Vec<SourceFile>, Error> {
    let lattice = map.lattice();
    let banks = Banks::of(map)?;
    let bearing = match lattice {
        Lattice::Square => include_str!("templates/bearing_square.v"),
        Lattice::Hex => include_str!("templates/bearing_hex.v"),
    };
    let rtl = |name: &str, text: String| SourceFile::new(format!("rtl/{name}.v"), text);
    let mut files = vec![
        rtl(&format!("windowed_{lattice}"), navigator(map, &banks)),
        rtl(
            "map_window",
            fill(WINDOW, &sizes(map, &banks).each_ref().map(|(name, value)| (*name, &**value))),
        ),
        rtl("map_bank", BANK.into()),
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
    files.extend(bench(map, &banks));
    Ok(files)
}

fn sizes(map: &Map, banks: &Banks) -> [(&'static str, String); 4] {
    [
        ("X_BITS", banks.x_bits.to_string()),
        ("Y_BITS", banks.y_bits.to_string()),
        ("WIDTH", map.width().to_string()),
        ("HEIGHT", map.height().to_string()),
    ]
}

fn navigator(map: &Map, banks: &Banks) -> String {
    let lattice = map.lattice();
    let degree = lattice.degree();
    let cells = match lattice {
        Lattice::Square => "squares",
        Lattice::Hex => "hexagons, odd rows shifted right",
    };
    let sector = sector(lattice);
    let inputs: Vec<&str> = sector.inputs.iter().map(|port| port.name.as_str()).collect();
    let connected = |names: &[&str]| {
        let lines = names.chunks(4).map(|names| {
            let ports: Vec<String> = names.iter().map(|name| format!(".{name}({name})")).collect();
            ports.join(", ")
        });
        lines.collect::<Vec<_>>().join(",\n        ")
    };
    let [wide, narrow] = [&[&inputs[..], &["is_near"]].concat(), &inputs].map(|names| connected(names));
    let sizes = sizes(map, banks);
    let texts = [
        ("LATTICE", lattice.to_string()),
        ("CELLS", cells.into()),
        ("LANES", degree.to_string()),
        ("TOP", (degree - 1).to_string()),
        ("SECTOR_TOP", (sector.outputs().map(|wire| wire.port.width).sum::<u32>() - 1).to_string()),
        ("BEARING_NAMES", [&inputs[..], &["is_near"]].concat().join(", ")),
        ("BEARING_PORTS", wide),
        ("SECTOR_PORTS", narrow),
        ("NEIGHBOURHOOD", neighbourhood(lattice)),
        ("MOVES", moves(lattice)),
    ];
    let values: Vec<(&str, &str)> =
        sizes.iter().chain(&texts).map(|(name, value)| (*name, value.as_str())).collect();
    fill(NAVIGATOR, &values)
}

/// The text for even and for odd rows, chosen by the row where they differ.
fn by_row(lattice: Lattice, of: impl Fn(Lattice, Cell) -> String) -> String {
    let [even, odd] = [Cell::new(0, 0), Cell::new(0, 1)].map(|cell| of(lattice, cell));
    if even == odd { even } else { format!("y[0]\n        ? {odd}\n        : {even}") }
}

/// The lanes of the neighbourhood, from the cells of the window.
fn neighbourhood(lattice: Lattice) -> String {
    let ring2 = |first: u8| move |lane: u8| 2 * lane + first;
    let lanes = |name: &str, about: &str, place: &dyn Fn(Cell, u8) -> Cell| {
        let joined = by_row(lattice, |lattice, from| {
            let bits = (0..lattice.degree()).rev().map(|lane| {
                let cell = place(from, lane);
                format!("window[{}]", 5 * (cell.y - from.y + 2) + cell.x - from.x + 2)
            });
            format!("{{{}}}", bits.collect::<Vec<_>>().join(", "))
        });
        format!("    wire [{}:0] {name} = {joined}; // {about}\n", lattice.degree() - 1)
    };
    [
        lanes("ring1", "each neighbour", &|from, lane| lattice.neighbour(from, Dir(lane))),
        lanes("ahead", "straight behind it", &|from, lane| lattice.ring2(from, ring2(0)(lane))),
        lanes("between", "behind it and the next", &|from, lane| lattice.ring2(from, ring2(1)(lane))),
    ]
    .concat()
}

/// Whether a step leads that way.
type Leads = fn(Cell, Cell) -> bool;

/// Which lanes lead a column or a row on.
fn moves(lattice: Lattice) -> String {
    let ways: [(&str, Leads); 4] = [
        ("to_right", |from, to| to.x > from.x),
        ("to_left", |from, to| to.x < from.x),
        ("to_below", |from, to| to.y > from.y),
        ("to_above", |from, to| to.y < from.y),
    ];
    let lines = ways.map(|(name, leads)| {
        let lanes = by_row(lattice, |lattice, from| {
            let lanes = lattice.dirs().filter(|&dir| leads(from, lattice.neighbour(from, dir)));
            lanes.map(|dir| format!("go[{}]", dir.0)).collect::<Vec<_>>().join(" | ")
        });
        format!("    wire {name} = {lanes};\n")
    });
    lines.concat().trim_end().to_owned()
}

/// The test bench, and the file that it reads: a line a clock, the inputs and what the navigator must show.
pub(crate) fn bench(map: &Map, banks: &Banks) -> [SourceFile; 2] {
    let [x_digits, y_digits] = [banks.x_bits, banks.y_bits].map(|bits| bits.div_ceil(4) as usize);
    let clocks = trace(map);
    let cell = |cell: Cell| format!("{:0x_digits$x}_{:0y_digits$x}", cell.x, cell.y);
    let lines = clocks.iter().map(|(load, shown)| {
        let (start, target) = load.unwrap_or_default();
        let go = shown.go.map_or(0, |dir| 1 << dir.0);
        format!(
            "{}_{}_{}_{}_{go:02x}_{:x}\n",
            u8::from(load.is_some()),
            cell(start),
            cell(target),
            cell(shown.cell),
            shown.status.outputs()
        )
    });
    let lines: String = lines.collect();
    let tasks = clocks.iter().filter(|(load, _)| load.is_some()).count();
    let text = fill(
        BENCH,
        &[
            ("LATTICE", &map.lattice().to_string()),
            ("X_BITS", &banks.x_bits.to_string()),
            ("Y_BITS", &banks.y_bits.to_string()),
            ("X_DIGITS", &x_digits.to_string()),
            ("Y_DIGITS", &y_digits.to_string()),
            ("TOP", &(map.lattice().degree() - 1).to_string()),
            ("CLOCKS", &clocks.len().to_string()),
            ("TASKS", &tasks.to_string()),
        ],
    );
    [SourceFile::new("tb/windowed_tb.v", text), SourceFile::new("tb/windowed.hex", lines)]
}

/// What is loaded with a clock's edge, from where to where, and what is shown before it.
type Clock = (Option<(Cell, Cell)>, Shown);

/// Random tasks as the model runs them, clock by clock; long ones are cut off by the next.
fn trace(map: &Map) -> Vec<Clock> {
    let free: Vec<Cell> = map.free().collect();
    let mut rng = Rng::new(map.cells() as u64);
    let mut navigator = Windowed::new(map);
    let mut clocks = Vec::new();
    let mut clock = |load| {
        clocks.push((load, navigator.shown()));
        navigator.clock(load);
        clocks.len() < CLOCKS && navigator.shown().status == Status::Busy
    };
    clock(None);
    if !free.is_empty() {
        for _ in 0..TASKS {
            let [start, target] = [(); 2].map(|()| free[rng.below(free.len() as u32) as usize]);
            clock(Some((start, target)));
            for _ in 0..CLOCKS_PER_TASK {
                if !clock(None) {
                    break;
                }
            }
        }
    }
    // What is reached stays.
    clock(None);
    clock(None);
    clocks
}
