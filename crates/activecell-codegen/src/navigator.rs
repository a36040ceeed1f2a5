//! What Verilog and VHDL share of the navigator whose map lies in block RAM.

use crate::circuits::sector;
use crate::model::{Shown, Status, Windowed};
use crate::{Banks, SourceFile};
use activecell::{Cell, Error, Lattice, Map, Rng};

/// Tasks that the test bench runs, at most; and clocks of each, and of all.
const TASKS: usize = 64;
const CLOCKS_PER_TASK: usize = 1024;
const CLOCKS: usize = 16_384;

/// What the navigator of a map is printed from.
pub(crate) struct Navigator {
    pub(crate) banks: Banks,
    /// What the templates are filled in with, but for what each language writes in its own way.
    pub(crate) values: Vec<(&'static str, String)>,
    /// The file that the test bench reads: a line a clock, the inputs and what the navigator must show.
    pub(crate) trace: SourceFile,
}

impl Navigator {
    /// # Errors
    /// As [`Banks::of`].
    pub(crate) fn of(map: &Map) -> Result<Self, Error> {
        let banks = Banks::of(map)?;
        let clocks = clocks(map);
        let digits = [banks.x_bits, banks.y_bits].map(|bits| bits.div_ceil(4) as usize);
        let tasks = clocks.iter().filter(|(load, _)| load.is_some()).count();
        let lattice = map.lattice();
        let cells = match lattice {
            Lattice::Square => "squares",
            Lattice::Hex => "hexagons, odd rows shifted right",
        };
        let sector = sector(lattice);
        let names: Vec<&str> = sector.inputs.iter().map(|port| port.name.as_str()).collect();
        let sector_bits: u32 = sector.outputs().map(|wire| wire.port.width).sum();
        let values = vec![
            ("LATTICE", lattice.to_string()),
            ("CELLS", cells.into()),
            ("WIDTH", map.width().to_string()),
            ("HEIGHT", map.height().to_string()),
            ("X_BITS", banks.x_bits.to_string()),
            ("Y_BITS", banks.y_bits.to_string()),
            ("X_DIGITS", digits[0].to_string()),
            ("Y_DIGITS", digits[1].to_string()),
            ("LANES", lattice.degree().to_string()),
            ("TOP", (lattice.degree() - 1).to_string()),
            ("SECTOR_TOP", (sector_bits - 1).to_string()),
            ("COMPARISONS", names.join(", ")),
            ("CLOCKS", clocks.len().to_string()),
            ("TASKS", tasks.to_string()),
        ];
        let lines: String = clocks.iter().map(|clock| line(clock, digits)).collect();
        Ok(Self { banks, values, trace: SourceFile::new("tb/windowed.hex", lines) })
    }
}

/// The ports of the comparisons, which the bearing gives and the sector takes, each connected to the wire of its name.
pub(crate) fn comparison_ports(
    lattice: Lattice,
    indent: &str,
    connected: impl Fn(&str) -> String,
) -> (&'static str, String) {
    let ports: Vec<String> = sector(lattice).inputs.iter().map(|port| connected(&port.name)).collect();
    let lines: Vec<String> = ports.chunks(4).map(|ports| ports.join(", ")).collect();
    ("COMPARISON_PORTS", lines.join(&format!(",\n{indent}")))
}

/// What is loaded with a clock's edge, from where to where, and what is shown before it.
type Clock = (Option<(Cell, Cell)>, Shown);

fn line((load, shown): &Clock, [x_digits, y_digits]: [usize; 2]) -> String {
    let cell = |cell: Cell| format!("{:0x_digits$x}_{:0y_digits$x}", cell.x, cell.y);
    let (start, target) = load.unwrap_or_default();
    let [start, target, at] = [start, target, shown.cell].map(cell);
    let go = shown.go.map_or(0, |dir| 1 << dir.0);
    let (load, status) = (u8::from(load.is_some()), shown.status.outputs());
    format!("{load}_{start}_{target}_{at}_{go:02x}_{status:x}\n")
}

/// Random tasks as the model runs them, clock by clock; long ones are cut off by the next.
fn clocks(map: &Map) -> Vec<Clock> {
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
