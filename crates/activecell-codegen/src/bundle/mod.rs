//! Everything for one robot on one map, in one language: sources, test benches, README, Makefile, and what it takes.

mod check;
mod makefile;
mod readme;
mod robot;
mod size;

pub use check::GenerateError;
pub use size::Size;

use crate::logic::Circuit;
use crate::model::player::{Segment, segments};
use crate::{SourceFile, c, circuits, verilog, vhdl};
use activecell::{Cell, Error, Lattice, Map, Robot, Route};

/// What the navigator is written in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Language {
    /// C99.
    C,
    /// Verilog-2005.
    Verilog,
    /// VHDL-93.
    Vhdl,
}

impl Language {
    /// The language's name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::C => "c",
            Self::Verilog => "verilog",
            Self::Vhdl => "vhdl",
        }
    }
}

/// What the navigator is for.
#[derive(Debug, Clone, Copy)]
pub struct Order<'a> {
    /// The floor.
    pub map: &'a Map,
    /// Where the program begins.
    pub from: Cell,
    /// Where it ends.
    pub to: Cell,
    /// The robot that drives it.
    pub robot: &'a Robot,
    /// The fabric's map is wired in instead of loaded.
    pub fixed_map: bool,
    /// The command that makes it again, for the README; may be empty.
    pub command: &'a str,
}

/// What a generator gives.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Bundle {
    /// All files, README and Makefile included.
    pub files: Vec<SourceFile>,
    /// What the parts take.
    pub sizes: Vec<Size>,
    /// What the user should know: parts that were left out, and why.
    pub notes: Vec<String>,
}

/// Writes the navigator for a map, or, without one, the rule and the control unit alone, for both lattices.
///
/// # Errors
/// [`GenerateError::Order`] for what the map, the task or the robot does not allow: [`Error::StartOccupied`] and the like
/// for the ends of the program, [`Error::Unreachable`] if no way leads from one to the other, [`Error::MapTooLarge`] for
/// what the language cannot hold. [`GenerateError::Circuit`] before a circuit is printed that not every language takes.
///
/// ```
/// use activecell::{Lattice, Map, Robot};
/// use activecell_codegen::{Language, Order, generate, long_way};
/// let map = Map::parse(Lattice::Square, "...\n.#.\n...")?;
/// let (from, to) = long_way(&map)?;
/// let order = Order { map: &map, from, to, robot: &Robot::default(), fixed_map: false, command: "" };
/// let bundle = generate(Language::C, Some(&order))?;
/// assert!(bundle.files.iter().any(|file| file.path == "README.md"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn generate(language: Language, order: Option<&Order<'_>>) -> Result<Bundle, GenerateError> {
    let lattices = order.map_or(Lattice::ALL.to_vec(), |order| vec![order.map.lattice()]);
    check::check(&check::all_circuits(&lattices))?;
    let Some(order) = order else {
        return Ok(Parts { files: rules(language), ..Parts::default() }.bundled(language, None));
    };
    let mut notes = Vec::new();
    let (route, program) = program(order, &mut notes)?;
    let facing = route.dirs().next().map(|dir| order.map.lattice().dir_name(dir));
    let parts = if language == Language::C {
        let program = c::Program { route: &route, segments: &program, robot: order.robot };
        let files = c::firmware(order.map, &program)?;
        Parts { files, sizes: size::firmware(order.map, &program), notes, facing, ..Parts::default() }
    } else {
        let designs = designs(language, order, &program, &mut notes)?;
        let mut files: Vec<SourceFile> =
            designs.iter().flat_map(|design| design.files.iter().cloned()).collect();
        // Some modules serve several designs.
        files.sort_by(|a, b| a.path.cmp(&b.path));
        files.dedup();
        let sizes = designs.iter().flat_map(|design| design.sizes.iter().copied()).collect();
        Parts { files, sizes, notes, designs, facing }
    };
    Ok(parts.bundled(language, Some(order)))
}

/// All but README and Makefile.
#[derive(Default)]
struct Parts {
    files: Vec<SourceFile>,
    sizes: Vec<Size>,
    notes: Vec<String>,
    designs: Vec<Design>,
    /// Where the robot faces at the start of the program.
    facing: Option<&'static str>,
}

impl Parts {
    /// With the Makefile and the README.
    fn bundled(self, language: Language, order: Option<&Order<'_>>) -> Bundle {
        let readme = readme::readme(language, order, &self);
        let makefile = order.map(|_| makefile::makefile(language, &self.designs));
        let files = self.files.into_iter().chain(makefile).map(licensed).chain([readme]).collect();
        Bundle { files, sizes: self.sizes, notes: self.notes }
    }
}

/// A source with its licence above it; memory images stay as they are.
fn licensed(file: SourceFile) -> SourceFile {
    let ending = file.path.rsplit(['.', '/']).next().unwrap_or_default();
    let [open, close] = match ending {
        "c" | "h" | "ld" => ["/* ", " */"],
        "v" => ["// ", ""],
        "vhd" => ["-- ", ""],
        "Makefile" | "mk" => ["# ", ""],
        _ => return file,
    };
    let text = format!("{open}SPDX-License-Identifier: {}{close}\n{}", env!("CARGO_PKG_LICENSE"), file.text);
    SourceFile { text, ..file }
}

/// A part of the hardware that stands alone.
struct Design {
    /// Its name, and that of its test bench before `_tb`.
    name: &'static str,
    /// The module on top.
    top: String,
    files: Vec<SourceFile>,
    sizes: Vec<Size>,
}

fn designs(
    language: Language,
    order: &Order<'_>,
    program: &[Segment],
    notes: &mut Vec<String>,
) -> Result<Vec<Design>, Error> {
    let &Order { map, fixed_map, robot: &Robot { drive, .. }, .. } = order;
    let is_vhdl = language == Language::Vhdl;
    let mut designs = vec![
        Design {
            name: "windowed",
            top: format!("windowed_{}", map.lattice()),
            files: if is_vhdl { vhdl::windowed(map)? } else { verilog::windowed(map)? },
            sizes: size::windowed(map)?,
        },
        Design {
            name: "player",
            top: "player_top".into(),
            files: if is_vhdl { vhdl::player(program, drive)? } else { verilog::player(program, drive)? },
            sizes: size::player(program)?,
        },
    ];
    let (cells, most) = (map.cells() as u64, verilog::MAX_FABRIC_CELLS);
    if cells <= most {
        designs.push(Design {
            name: "fabric",
            top: if fixed_map { "fabric" } else { "fabric_top" }.into(),
            files: if is_vhdl { vhdl::fabric(map, !fixed_map)? } else { verilog::fabric(map, !fixed_map)? },
            sizes: size::fabric(map, fixed_map),
        });
    } else {
        notes.push(format!(
            "the fabric is left out: it has a small automaton a cell, at most {most} of them, and the map has {cells} \
             cells; larger cells (--cell) make fewer"
        ));
    }
    let too_large: Vec<&str> =
        designs.iter().filter(|design| !size::fits_hx8k(&design.sizes)).map(|design| design.name).collect();
    if !too_large.is_empty() {
        notes.push(format!(
            "larger than an iCE40 HX8K, for which `make synth` places: {}",
            too_large.join(", ")
        ));
    }
    Ok(designs)
}

/// Two cells of the map's largest region that are far from each other: the farthest cell from its first one, and the
/// farthest from that.
///
/// # Errors
/// [`Error::BadValue`] if no cell is free.
pub fn long_way(map: &Map) -> Result<(Cell, Cell), Error> {
    let region = map.largest_region();
    let farthest = |from: Cell| {
        let field = map.wave(from)?;
        // Of equally far cells the first.
        let cells = region.iter().rev().copied();
        Ok(cells.max_by_key(|&cell| field.steps(cell)).unwrap_or(from))
    };
    let first = region.first().copied().ok_or(Error::BadValue {
        name: "the number of free cells",
        value: 0.0,
        allowed: "at least 1: the map has obstacles only",
    })?;
    let from = farthest(first)?;
    Ok((from, farthest(from)?))
}

/// The way of the order, which the robot begins facing along it, and the program M for it, in ticks.
fn program(order: &Order<'_>, notes: &mut Vec<String>) -> Result<(Route, Vec<Segment>), Error> {
    let &Order { map, from, to, robot, .. } = order;
    map.check_task(from, to)?;
    let field = map.wave(to)?;
    if field.steps(from).is_none() {
        return Err(Error::Unreachable { from, to });
    }
    let route = field.route(from);
    let program = route.program(robot, map, None);
    let segments = segments(&program, robot, map.lattice())?;
    let waypoints = program.waypoints.iter();
    let all: usize =
        waypoints.map(|w| usize::from(w.revolutions != 0.0) + usize::from(w.turn_deg != 0)).sum();
    if segments.len() < all {
        notes.push(format!(
            "left out of the program, because shorter than an encoder tick: {} of {all} runs and turns; the next ones make \
             them good; more ticks a revolution (--robot) or larger cells (--cell) keep them",
            all - segments.len()
        ));
    }
    Ok((route, segments))
}

/// The rule and the control unit alone.
fn rules(language: Language) -> Vec<SourceFile> {
    let both =
        Lattice::ALL.iter().flat_map(|&lattice| [circuits::sector(lattice), circuits::decision(lattice)]);
    let circuits: Vec<Circuit> = both.chain([circuits::control()]).collect();
    let files = |ending: &str, print: fn(&Circuit) -> String| {
        let path = |circuit: &Circuit| format!("rtl/{}.{ending}", circuit.name);
        circuits.iter().map(|circuit| SourceFile::new(path(circuit), print(circuit))).collect::<Vec<_>>()
    };
    match language {
        Language::C => c::headers(&circuits),
        Language::Verilog => files("v", verilog::module),
        // What the entities use is analysed first.
        Language::Vhdl => [vec![vhdl::lanes()], files("vhd", vhdl::entity)].concat(),
    }
}
