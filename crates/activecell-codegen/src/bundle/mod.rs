//! Everything for one robot on one map, in one language: sources, test benches, README, Makefile, and what it takes.

mod readme;
mod size;

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
/// What the map, the task or the robot does not allow: [`Error::StartOccupied`] and the like for the ends of the program,
/// [`Error::Unreachable`] if no way leads from one to the other, [`Error::MapTooLarge`] for what the language cannot hold.
///
/// ```
/// use activecell::{Lattice, Map, Robot};
/// use activecell_codegen::{Language, Order, generate, long_way};
/// let map = Map::parse(Lattice::Square, "...\n.#.\n...")?;
/// let (from, to) = long_way(&map)?;
/// let order = Order { map: &map, from, to, robot: &Robot::default(), fixed_map: false };
/// let bundle = generate(Language::C, Some(&order))?;
/// assert!(bundle.files.iter().any(|file| file.path == "README.md"));
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn generate(language: Language, order: Option<&Order<'_>>) -> Result<Bundle, Error> {
    let Some(order) = order else {
        return Ok(finished(language, None, rules(language), Vec::new(), Vec::new()));
    };
    let (route, program) = program(order)?;
    let mut notes = Vec::new();
    let fabric = with_fabric(language, order.map, &mut notes);
    let files = parts(language, order, &c::Program { route: &route, segments: &program }, fabric)?;
    let sizes = size::sizes(language, order.map, &program, fabric.then_some(order.fixed_map))?;
    Ok(finished(language, Some(order), files, sizes, notes))
}

/// With the README and the Makefile.
fn finished(
    language: Language,
    order: Option<&Order<'_>>,
    mut files: Vec<SourceFile>,
    sizes: Vec<Size>,
    notes: Vec<String>,
) -> Bundle {
    let readme = readme::readme(language, order, &files, &sizes);
    let makefile = order.map(|order| readme::makefile(language, order, &files));
    files.splice(0..0, std::iter::once(readme).chain(makefile));
    Bundle { files, sizes, notes }
}

/// Whether the fabric is among the parts.
fn with_fabric(language: Language, map: &Map, notes: &mut Vec<String>) -> bool {
    let cells = map.cells() as u64;
    let fits = cells <= verilog::MAX_FABRIC_CELLS;
    if language != Language::C && !fits {
        notes.push(format!(
            "the fabric is left out: it has a small automaton a cell, at most {} of them, and the map has {cells} cells; larger cells (--cell) make fewer",
            verilog::MAX_FABRIC_CELLS
        ));
    }
    language != Language::C && fits
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
        allowed: "at least 1",
    })?;
    let from = farthest(first)?;
    Ok((from, farthest(from)?))
}

/// The way of the order, and the program M for it, in ticks.
fn program(order: &Order<'_>) -> Result<(Route, Vec<Segment>), Error> {
    let &Order { map, from, to, robot, .. } = order;
    map.check_task(from, to)?;
    let field = map.wave(to)?;
    if field.steps(from).is_none() {
        return Err(Error::Unreachable { from, to });
    }
    let route = field.route(from);
    let segments = segments(&route.program(robot, map, None), robot, map.lattice())?;
    Ok((route, segments))
}

fn parts(
    language: Language,
    order: &Order<'_>,
    program: &c::Program<'_>,
    fabric: bool,
) -> Result<Vec<SourceFile>, Error> {
    let &Order { map, fixed_map, .. } = order;
    let mut files = match language {
        Language::C => c::firmware(map, program)?,
        Language::Verilog => [verilog::windowed(map)?, verilog::player(program.segments)?].concat(),
        Language::Vhdl => [vhdl::windowed(map)?, vhdl::player(program.segments)?].concat(),
    };
    if fabric {
        files.extend(match language {
            Language::Vhdl => vhdl::fabric(map, !fixed_map)?,
            _ => verilog::fabric(map, !fixed_map)?,
        });
    }
    // Some modules serve several parts.
    files.sort_by(|a, b| a.path.cmp(&b.path));
    files.dedup();
    Ok(files)
}

/// The rule and the control unit alone.
fn rules(language: Language) -> Vec<SourceFile> {
    let both =
        Lattice::ALL.iter().flat_map(|&lattice| [circuits::sector(lattice), circuits::decision(lattice)]);
    let circuits: Vec<Circuit> = both.chain([circuits::control()]).collect();
    let files = |ending: &str, print: fn(&Circuit) -> String| {
        let path = |circuit: &Circuit| format!("rtl/{}.{ending}", circuit.name);
        circuits.iter().map(|circuit| SourceFile::new(path(circuit), print(circuit))).collect()
    };
    match language {
        Language::C => c::headers(&circuits),
        Language::Verilog => files("v", verilog::module),
        Language::Vhdl => files("vhd", vhdl::entity),
    }
}
