//! The whole firmware: header, sources, map, program, examples.

use super::circuit::function;
use super::units::{Units, state_table};
use super::{Program, examples, lattice};
use crate::model::player::Motion;
use crate::template::fill;
use crate::{SourceFile, circuits};
use activecell::control::{Inputs, State};
use activecell::rule::Sector;
use activecell::{Cell, Error, Lattice, Map};

/// Coordinates are kept in 16 bits where they are packed.
const SIDE_MAX: u32 = 65_535;

/// The memory that the firmware of a map needs, in bytes. Everything else is on the stack.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Footprint {
    /// The map, in read-only memory.
    pub map_bytes: u64,
    /// The caller's memory for a wave.
    pub wave_bytes: u64,
    /// The caller's table for learning, so large that it always suffices. A smaller one often does.
    pub levels_bytes: u64,
}

/// What the firmware of a map needs.
pub fn footprint(map: &Map) -> Footprint {
    let shape = Shape::of(map);
    Footprint {
        map_bytes: 4 * shape.length(),
        wave_bytes: 4 * shape.wave_words(),
        levels_bytes: 8 * shape.levels(),
    }
}

/// The C99 firmware of a map and of a program for it.
///
/// A header and a source for each part, freestanding, without warnings at the strictest settings; examples for a plain
/// `main`, which checks itself, and for a board with a Cortex-M that has memory enough. The lattice is that of the map.
///
/// # Errors
/// [`Error::BadValue`] for maps with a side of more than 65,535 cells, segments without a tick, and cells or turns of more
/// than 2,097,151 ticks.
///
/// ```
/// use activecell::{Cell, Lattice, Map, Robot};
/// use activecell_codegen::c;
/// use activecell_codegen::model::player::segments;
/// let map = Map::parse(Lattice::Square, "..#\n...")?;
/// let route = map.wave(Cell::new(2, 1))?.route(Cell::new(0, 0));
/// let robot = Robot::default();
/// let segments = segments(&route.program(&robot, &map, None), &robot, Lattice::Square)?;
/// let files = c::firmware(&map, &c::Program { route: &route, segments: &segments, robot: &robot })?;
/// assert!(files.iter().any(|file| file.path == "include/activecell.h"));
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn firmware(map: &Map, program: &Program<'_>) -> Result<Vec<SourceFile>, Error> {
    let side = map.width().max(map.height());
    if side > SIDE_MAX {
        return Err(Error::BadValue {
            name: "the longer side of the map in cells",
            value: side.into(),
            allowed: "at most 65535 for firmware; use larger cells or a part of the map",
        });
    }
    program.check()?;
    let units = Units::of(program.robot, map)?;
    let mut files = vec![
        SourceFile::new("include/activecell.h", header(map, program, &units)),
        SourceFile::new("src/ac_bit.h", include_str!("templates/ac_bit.h")),
        SourceFile::new("src/ac_rule.c", rule(map.lattice())),
        SourceFile::new("src/ac_learning.c", learning(map.lattice())),
        SourceFile::new("src/ac_wave.c", wave(map.lattice())),
        SourceFile::new("src/ac_drive.c", drive()),
        SourceFile::new("src/ac_map.c", floor(map)),
        SourceFile::new("src/ac_program.c", program.listing(&units)),
    ];
    files.extend(examples::examples(footprint(map), program.bytes()));
    Ok(files)
}

/// How the rows of a map lie in words.
struct Shape {
    width: u64,
    height: u64,
    words: u64,
    planes: u64,
    free: u64,
}

impl Shape {
    fn of(map: &Map) -> Self {
        Self {
            width: map.width().into(),
            height: map.height().into(),
            words: u64::from(map.width() + 4).div_ceil(32),
            planes: lattice::planes(map.lattice()).into(),
            free: map.free_cells() as u64,
        }
    }

    const fn length(&self) -> u64 {
        (self.height + 4) * self.words + 1
    }

    const fn wave_words(&self) -> u64 {
        self.words * (self.height + 4 + self.planes * self.height)
    }

    /// At most three quarters are ever taken: in a fuller table entries are searched for long.
    const fn levels(&self) -> u64 {
        (4 * self.free / 3 + 2).next_power_of_two()
    }
}

pub(super) fn define(name: &str, value: u64, about: &str) -> String {
    format!(
        "#define {name} {value}U{}\n",
        if about.is_empty() { String::new() } else { format!(" /**< {about} */") }
    )
}

fn header(map: &Map, program: &Program<'_>, units: &Units) -> String {
    let lattice = map.lattice();
    let shape = Shape::of(map);
    let degree = lattice.degree();
    let directions: String = lattice
        .dirs()
        .map(|dir| define(&format!("AC_{}", lattice.dir_name(dir)), dir.0.into(), ""))
        .collect();
    let states = State::ALL.map(|state| define(&format!("AC_{}", upper(state.name())), state as u64, ""));
    let motions = Motion::ALL.iter().enumerate();
    let motions: String =
        motions.map(|(number, motion)| define(&motion_name(*motion), number as u64, "")).collect();
    let sizes = [
        define("AC_FLOOR_WIDTH", shape.width, "Columns of the map."),
        define("AC_FLOOR_HEIGHT", shape.height, "Rows of the map."),
        define("AC_FLOOR_MAP_WORDS", shape.length(), "Words of the map itself."),
        define("AC_FLOOR_WAVE_WORDS", shape.wave_words(), "Memory of a wave on it."),
        define("AC_FLOOR_LEVELS", shape.levels(), "A table of that capacity always suffices on it."),
    ];
    fill(
        include_str!("templates/activecell.h"),
        &[
            ("VERSION", env!("CARGO_PKG_VERSION")),
            ("LATTICE", cells_of(lattice)),
            ("STACK", "1024"),
            ("SIDE_MAX", &SIDE_MAX.to_string()),
            ("DEGREE", &degree.to_string()),
            ("DIRECTIONS", &directions),
            ("SECTORS", &Sector::all(lattice).len().to_string()),
            ("SECTOR_BITS", &(Sector::all(lattice).len().next_power_of_two() - 1).to_string()),
            ("LAST", &(degree - 1).to_string()),
            ("LAST_AHEAD", &(degree + 7).to_string()),
            ("LAST_BETWEEN", &(degree + 15).to_string()),
            ("PLANES", &shape.planes.to_string()),
            ("STATES", &states.concat()),
            ("INPUTS", &inputs()),
            ("MOTIONS", &motions),
            ("MAP_SIZES", &sizes.concat()),
            ("CHECKSUM", &format!("0x{:08X}U", examples::checksum(lattice))),
            ("STEP_DEG", &(360 / u32::from(degree)).to_string()),
            ("SECTOR_ORDER", &sector_order(lattice)),
            ("STATE_TABLE", &state_table()),
            ("UNITS", &units.defines()),
            ("PROGRAM", &program.declaration()),
        ],
    )
}

/// How the sectors are counted: what the circuit of the decision says of it.
fn sector_order(lattice: Lattice) -> String {
    let about = circuits::decision(lattice).about;
    let line = about.lines().find(|line| line.starts_with("Sectors: ")).unwrap_or_default();
    line.replace(" nearest, and ", " nearest, and\n * ")
}

const fn cells_of(lattice: Lattice) -> &'static str {
    match lattice {
        Lattice::Square => "square cells",
        Lattice::Hex => "hexagonal cells, odd rows shifted right by half a cell",
    }
}

fn upper(name: &str) -> String {
    name.to_uppercase()
}

pub(super) fn motion_name(motion: Motion) -> String {
    format!("AC_RUN_{}", upper(motion.name()))
}

fn inputs() -> String {
    let line = |(name, input, about): (&str, Inputs, &str)| {
        let [first, rest] = [&about[..1], &about[1..]];
        define(&format!("AC_IN_{name}"), input.0.into(), &format!("{}{rest}.", first.to_uppercase()))
    };
    circuits::INPUTS.map(line).concat()
}

fn rule(lattice: Lattice) -> String {
    let [right, down] = lattice::neighbours(lattice);
    let (parities, parity) =
        if lattice == Lattice::Hex { ("2", "(uint32_t)cell.y & 1U") } else { ("1", "0") };
    fill::<&str>(
        include_str!("templates/ac_rule.c"),
        &[
            ("DECIDE_FUNCTION", &function(&circuits::decision(lattice))),
            ("LANE_FUNCTION", &function(&lattice::lane_number(lattice))),
            ("GEOMETRY", &lattice::geometry(lattice)),
            ("PARITIES", parities),
            ("PARITY", parity),
            ("RIGHT", &right),
            ("DOWN", &down),
            ("SLICES", &lattice::slices(lattice)),
            ("WINDOW", &lattice::window(lattice)),
            ("NAME", lattice.name()),
            ("ONES", &super::circuit::number((1 << lattice.degree()) - 1)),
        ],
    )
}

fn learning(lattice: Lattice) -> String {
    let sectors = Sector::all(lattice).len().to_string();
    fill(
        include_str!("templates/ac_learning.c"),
        &[("SECTORS", &sectors), ("ORDER", &lattice::orders(lattice))],
    )
}

fn wave(lattice: Lattice) -> String {
    let parity = match lattice {
        Lattice::Square => "",
        // Rows are counted from 1 there.
        Lattice::Hex => "        const bool is_odd = (row & 1U) == 0U;\n",
    };
    fill::<&str>(
        include_str!("templates/ac_wave.c"),
        &[
            ("PLANES", &lattice::planes(lattice).to_string()),
            ("PARITY_OF_ROW", parity),
            ("DIRECTIONS_OF_WAVE", &lattice::wave(lattice)),
        ],
    )
}

fn drive() -> String {
    fill(
        include_str!("templates/ac_drive.c"),
        &[
            ("CONTROL_FUNCTION", &function(&circuits::control())),
            ("PLAYER_FUNCTION", &function(&circuits::player())),
        ],
    )
}

/// The map in the words that `ac_map` in the header describes.
pub fn rows(map: &Map) -> Vec<u32> {
    let shape = Shape::of(map);
    let mut rows = vec![u32::MAX; shape.length() as usize];
    for Cell { x, y } in map.free() {
        let bit = x as usize + 2;
        rows[(y as usize + 2) * shape.words as usize + bit / 32] &= !(1 << (bit % 32));
    }
    rows
}

fn floor(map: &Map) -> String {
    let shape = Shape::of(map);
    let mut text = String::new();
    for row in rows(map).chunks(shape.words as usize) {
        for line in row.chunks(8) {
            let words: Vec<String> = line.iter().map(|word| format!("0x{word:08X}U,")).collect();
            text += &format!("    {}\n", words.join(" "));
        }
    }
    fill::<&str>(
        include_str!("templates/ac_map.c"),
        &[
            ("WIDTH", &shape.width.to_string()),
            ("HEIGHT", &shape.height.to_string()),
            ("LATTICE", cells_of(map.lattice())),
            ("FREE", &shape.free.to_string()),
            ("LENGTH", &shape.length().to_string()),
            ("ROWS", &text),
            ("WORDS", &shape.words.to_string()),
        ],
    )
}
