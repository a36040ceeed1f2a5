//! What Verilog and VHDL share of the navigator whose map lies in block RAM.

use crate::circuits::sector;
use crate::images::bits_below;
use crate::model::{Shown, Status, Windowed, WindowedInputs};
use crate::{Banks, SourceFile};
use activecell::{Cell, Error, Lattice, Map, Outcome, Rng, Route, Rule};

/// Tasks that the test bench runs, at most; and clocks of each, and of all.
const TASKS: usize = 64;
const CLOCKS_PER_TASK: usize = 1024;
const CLOCKS: usize = 16_384;

/// Steps of the example, at most.
const EXAMPLE_STEPS: usize = 24;

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
        let [column_bits, row_bits] = [map.width(), map.height()].map(bits_below);
        let digits = [column_bits, row_bits].map(|bits| bits.div_ceil(4) as usize);
        let tasks = clocks.iter().filter(|(inputs, _)| inputs.begin.is_some()).count();
        let (start, target) = example(map);
        let lattice = map.lattice();
        let cells = match lattice {
            Lattice::Square => "squares",
            Lattice::Hex => "hexagons, odd rows shifted right",
        };
        let sector = sector(lattice);
        let names: Vec<&str> = sector.inputs.iter().map(|port| port.name.as_str()).collect();
        let sector_bits: u32 = sector.outputs().map(|wire| wire.port.width).sum();
        let directions = lattice.dirs().map(|dir| format!("{} {}", dir.0, lattice.dir_name(dir)));
        let range = |bits: u32| format!("{:<6}", format!("[{}:0]", bits - 1));
        let degree = u32::from(lattice.degree());
        let values = vec![
            ("LATTICE", lattice.to_string()),
            ("CELLS", cells.into()),
            ("WIDTH", map.width().to_string()),
            ("HEIGHT", map.height().to_string()),
            ("X_BITS", banks.x_bits.to_string()),
            ("Y_BITS", banks.y_bits.to_string()),
            ("COLUMN_BITS", column_bits.to_string()),
            ("ROW_BITS", row_bits.to_string()),
            ("COLUMN_TOP", (column_bits - 1).to_string()),
            ("ROW_TOP", (row_bits - 1).to_string()),
            ("COLUMN_RANGE", range(column_bits)),
            ("ROW_RANGE", range(row_bits)),
            ("DIRECTION_RANGE", range(degree)),
            ("DIRECTIONS", format!("bit {}", directions.collect::<Vec<_>>().join(", "))),
            ("START_X", start.x.to_string()),
            ("START_Y", start.y.to_string()),
            ("TARGET_X", target.x.to_string()),
            ("TARGET_Y", target.y.to_string()),
            ("X_DIGITS", digits[0].to_string()),
            ("Y_DIGITS", digits[1].to_string()),
            ("LANES", degree.to_string()),
            ("TOP", (degree - 1).to_string()),
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

/// The directions as bits of the output, and their names, for the printers' cases.
pub(crate) fn direction_names(
    lattice: Lattice,
    line: impl Fn(&str, &str) -> String,
) -> (&'static str, String) {
    let digits = usize::from(lattice.degree());
    let lines = lattice.dirs().map(|dir| line(&format!("{:0digits$b}", 1 << dir.0), lattice.dir_name(dir)));
    ("NAMES", lines.collect::<Vec<_>>().join("\n"))
}

/// What is given with a clock's edge, and what is shown before it.
type Clock = (WindowedInputs, Shown);

fn line((inputs, shown): &Clock, [x_digits, y_digits]: [usize; 2]) -> String {
    let cell = |cell: Cell| format!("{:0x_digits$x}_{:0y_digits$x}", cell.x, cell.y);
    let &WindowedInputs { reset, enable, begin } = inputs;
    let control = u8::from(reset) << 2 | u8::from(enable) << 1 | u8::from(begin.is_some());
    let (start, target) = begin.unwrap_or_default();
    let [start, target, at] = [start, target, shown.cell].map(cell);
    let direction = shown.direction.map_or(0, |dir| 1 << dir.0);
    format!("{control}_{start}_{target}_{at}_{direction:02x}_{:x}\n", shown.status.outputs())
}

/// Random tasks as the model runs them, clock by clock: steps one a clock and at times, tasks that are cut off by the next
/// and by resets, and targets on obstacles or outside the map.
fn clocks(map: &Map) -> Vec<Clock> {
    let free: Vec<Cell> = map.free().collect();
    let mut rng = Rng::new(map.cells() as u64);
    let mut navigator = Windowed::new(map);
    let mut clocks = Vec::new();
    let mut clock = |inputs| {
        clocks.push((inputs, navigator.shown()));
        navigator.clock(inputs);
        clocks.len() < CLOCKS && navigator.shown().status == Status::Busy
    };
    let step = WindowedInputs { enable: true, ..WindowedInputs::default() };
    clock(step);
    for task in 0..if free.is_empty() { 0 } else { TASKS } {
        let [start, target] = [(); 2].map(|()| free[rng.below(free.len() as u32) as usize]);
        let [x, y] = [map.width(), map.height()].map(|size| rng.below(1 << bits_below(size)) as i32);
        let target = if task % 5 == 4 { Cell::new(x, y) } else { target };
        // A step each clock, or one in three.
        let pause = [1, 3][task % 2];
        let mut enable = || rng.below(pause) == 0;
        clock(WindowedInputs { enable: enable(), begin: Some((start, target)), reset: task % 16 == 13 });
        let longest = if task % 8 == 3 { 5 } else { CLOCKS_PER_TASK };
        for _ in 0..longest {
            if !clock(WindowedInputs { enable: enable(), ..step }) {
                break;
            }
        }
        if task % 16 == 3 {
            clock(WindowedInputs { reset: true, ..step });
        }
    }
    // What is reached stays.
    clock(step);
    clock(step);
    clocks
}

/// The end of the longest of some random ways that arrive.
fn example(map: &Map) -> (Cell, Cell) {
    let free: Vec<Cell> = map.free().collect();
    let mut rng = Rng::new(1);
    let mut cell = || free.get(rng.below(free.len().max(1) as u32) as usize).copied().unwrap_or_default();
    let ways = (0..TASKS).filter_map(|_| map.route(Rule::Published, cell(), cell(), 0).ok());
    let longest = ways.filter(|way| way.outcome() == Outcome::Arrived).max_by_key(Route::steps);
    longest.map_or_else(Default::default, |way| {
        let cells = way.cells();
        // The rule has no memory: from any cell of the way it goes on as from the first.
        (cells[way.steps().saturating_sub(EXAMPLE_STEPS)], cells[way.steps()])
    })
}
