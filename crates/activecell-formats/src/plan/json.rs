//! Our own plan files: JSON with a line for each robot, and for each row of the map.

use super::scan::MAX_COORDINATE;
use super::{PlanFile, Stated, moves, room};
use crate::error::{Error, quoted};
use crate::run::MapRows;
use activecell::{Bodies, Cell, KeepOut, Lattice, Plan};
use serde::{Deserialize, Serialize};
use serde_json::ser::Formatter;
use std::io;

/// The version of the plan files that are written.
pub const VERSION: u32 = 1;

/// What kind of file it is.
#[derive(Deserialize)]
struct Kind {
    activecell: String,
    version: u32,
}

#[derive(Serialize, Deserialize)]
struct Document {
    activecell: String,
    version: u32,
    lattice: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    map_file: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    solver: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    seed: Option<u64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    sum_of_costs: Option<u64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    lower_bound: Option<u64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    makespan: Option<u64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    makespan_lower_bound: Option<u64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    comp_time_ms: Option<f64>,
    /// The radius of each robot in cells; all 0 if there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    sizes: Vec<u32>,
    /// The least distance between robots in cells; 1 if it is not said.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    distance: Option<u32>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    keep_outs: Vec<Closed>,
    steps: usize,
    robots: Vec<Robot>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    map: Option<MapRows>,
}

/// A cell that is closed from one step to another, both included.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Closed {
    cell: [i32; 2],
    from: u32,
    to: u32,
}

impl Closed {
    pub(crate) const fn keep_out(&self) -> KeepOut {
        let [x, y] = self.cell;
        KeepOut { cell: Cell::new(x, y), from_step: self.from, to_step: self.to }
    }

    const fn of(keep_out: &KeepOut) -> Self {
        let Cell { x, y } = keep_out.cell;
        Self { cell: [x, y], from: keep_out.from_step, to: keep_out.to_step }
    }
}

#[derive(Serialize, Deserialize)]
struct Robot {
    start: [i32; 2],
    #[serde(default, skip_serializing_if = "Option::is_none")]
    target: Option<[i32; 2]>,
    moves: String,
}

pub(super) fn is_plan(bytes: &[u8]) -> bool {
    serde_json::from_slice(bytes).is_ok_and(|kind: Kind| kind.activecell == "plan")
}

pub(super) fn read(bytes: &[u8]) -> Result<PlanFile, Error> {
    let kind: Kind = serde_json::from_slice(bytes).map_err(|error| not_json(&error))?;
    if kind.activecell != "plan" {
        let kind = quoted(&kind.activecell);
        return Err(Error::file(format!("activecell is {kind}, not `plan`; give a file of `fleet --save`")));
    }
    if kind.version != VERSION {
        let version = kind.version;
        return Err(Error::file(format!(
            "version {version} is not known here, only {VERSION}; update activecell"
        )));
    }
    let file: Document = serde_json::from_slice(bytes).map_err(|error| not_json(&error))?;
    let lattice = lattice(&file.lattice)?;
    let plan = plan(&file, lattice)?;
    let targets = targets(&file.robots)?;
    let bodies = bodies(&file)?;
    let keep_outs = file.keep_outs.iter().map(Closed::keep_out).collect();
    let map = file.map.map(MapRows::map).transpose()?;
    if let Some(map) = map.as_ref().filter(|map| map.lattice() != lattice) {
        let other = map.lattice();
        return Err(Error::file(format!("lattice is {lattice}, map.lattice {other}; make them agree")));
    }
    let stated = Stated {
        map_file: file.map_file,
        solver: file.solver,
        seed: file.seed,
        sum_of_costs: file.sum_of_costs,
        lower_bound: file.lower_bound,
        makespan: file.makespan,
        makespan_lower_bound: file.makespan_lower_bound,
        comp_time_ms: file.comp_time_ms,
    };
    Ok(PlanFile { plan, lattice: Some(lattice), map, starts: None, targets, bodies, keep_outs, stated })
}

fn bodies(file: &Document) -> Result<Bodies, Error> {
    let (sizes, robots) = (file.sizes.len(), file.robots.len());
    if sizes > 0 && sizes != robots {
        let reason = format!("`sizes` has {sizes} radii for {robots} robots; give one for each, or none");
        return Err(Error::file(reason));
    }
    Ok(Bodies::new(file.sizes.clone(), file.distance.unwrap_or(1))?)
}

fn lattice(name: &str) -> Result<Lattice, Error> {
    let found = Lattice::ALL.into_iter().find(|lattice| lattice.name() == name);
    found.ok_or_else(|| Error::file(format!("lattice is {}; it must be square or hex", quoted(name))))
}

fn plan(file: &Document, lattice: Lattice) -> Result<Plan, Error> {
    let (robots, steps) = (file.robots.len(), file.steps);
    let mut cells = room(robots, steps)?;
    // Without robots there may be any number of steps, and no cell.
    cells.resize(robots.saturating_mul(steps.saturating_add(1)), Cell::default());
    for (number, robot) in file.robots.iter().enumerate() {
        let here = |error: Error| Error::file(format!("robots[{number}].moves: {error}"));
        if moves::steps(&robot.moves).map_err(here)?.is_none_or(|moves| moves > steps) {
            let reason = format!("robots[{number}] makes more steps than `steps`, {steps}; correct it");
            return Err(Error::file(reason));
        }
        let start = cell(robot.start).ok_or_else(|| too_far(number, "start"))?;
        let mut rows = cells.chunks_exact_mut(robots).map(|row| &mut row[number]);
        let stand = |at: Cell| rows.by_ref().take(1).for_each(|place| *place = at);
        let end = moves::walk(lattice, start, &robot.moves, stand).map_err(here)?;
        rows.for_each(|place| *place = end);
    }
    Ok(Plan::new(robots, cells)?)
}

/// Where each robot should end: all of them say, or none.
fn targets(robots: &[Robot]) -> Result<Option<Vec<Cell>>, Error> {
    if robots.iter().all(|robot| robot.target.is_none()) {
        return Ok(None);
    }
    let targets = robots.iter().enumerate().map(|(number, robot)| match robot.target {
        Some(target) => cell(target).ok_or_else(|| too_far(number, "target")),
        None => {
            Err(Error::file(format!("robots[{number}] has no target, others have; give every robot one")))
        }
    });
    targets.collect::<Result<_, _>>().map(Some)
}

fn cell([x, y]: [i32; 2]) -> Option<Cell> {
    (x.unsigned_abs().max(y.unsigned_abs()) <= MAX_COORDINATE).then_some(Cell::new(x, y))
}

fn too_far(number: usize, what: &str) -> Error {
    Error::file(format!("robots[{number}].{what} has a number above {MAX_COORDINATE}; no cell is so far off"))
}

/// The place and the first line of what is wrong.
fn not_json(error: &serde_json::Error) -> Error {
    let text = error.to_string();
    let reason = text.split(" at line ").next().unwrap_or_default().replace('\n', " ");
    let reason = format!("not a plan file: {}; give a file of `fleet --save`", reason.trim());
    if error.line() == 0 { Error::file(reason) } else { Error::at(error.line(), error.column(), reason) }
}

pub(super) fn write(file: &PlanFile) -> Result<String, Error> {
    let PlanFile { plan, stated, bodies, keep_outs, .. } = file;
    let sizes = (0..plan.robots()).map(|robot| bodies.radius(robot));
    let lattice = file.lattice.unwrap_or_default();
    let pair = |cell: Cell| [cell.x, cell.y];
    let robots = (0..plan.robots()).map(|robot| {
        let path: Vec<Cell> = (0..=plan.steps()).map(|step| plan.at(step, robot)).collect();
        Robot {
            start: pair(path[0]),
            target: file.targets.as_ref().and_then(|targets| targets.get(robot)).copied().map(pair),
            moves: moves::write(lattice, &path),
        }
    });
    let written = Document {
        activecell: "plan".to_owned(),
        version: VERSION,
        lattice: lattice.name().to_owned(),
        map_file: stated.map_file.clone(),
        solver: stated.solver.clone(),
        seed: stated.seed,
        sum_of_costs: Some(plan.sum_of_costs()),
        lower_bound: stated.lower_bound,
        makespan: Some(plan.makespan() as u64),
        makespan_lower_bound: stated.makespan_lower_bound,
        comp_time_ms: stated.comp_time_ms,
        sizes: if bodies.largest() == 0 { Vec::new() } else { sizes.collect() },
        distance: Some(bodies.distance()).filter(|&distance| distance != 1),
        keep_outs: keep_outs.iter().map(Closed::of).collect(),
        steps: plan.steps(),
        robots: robots.collect(),
        map: file.map.as_ref().map(MapRows::of),
    };
    let mut bytes = Vec::new();
    let mut serializer = serde_json::Serializer::with_formatter(&mut bytes, LineEach::default());
    written.serialize(&mut serializer).map_err(|error| Error::file(error.to_string()))?;
    bytes.push(b'\n');
    String::from_utf8(bytes).map_err(|error| Error::file(error.to_string()))
}

/// JSON in which objects and strings that stand in a list begin a line.
#[derive(Default)]
struct LineEach {
    /// For each bracket that is open, whether it is a list's.
    lists: Vec<bool>,
}

impl LineEach {
    fn begin(&self, out: &mut (impl io::Write + ?Sized)) -> io::Result<()> {
        if self.lists.last() == Some(&true) { out.write_all(b"\n") } else { Ok(()) }
    }
}

impl Formatter for LineEach {
    fn begin_array<W: ?Sized + io::Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.lists.push(true);
        out.write_all(b"[")
    }

    fn end_array<W: ?Sized + io::Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.lists.pop();
        out.write_all(b"]")
    }

    fn begin_object<W: ?Sized + io::Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.begin(out)?;
        self.lists.push(false);
        out.write_all(b"{")
    }

    fn end_object<W: ?Sized + io::Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.lists.pop();
        out.write_all(b"}")
    }

    fn begin_string<W: ?Sized + io::Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.begin(out)?;
        out.write_all(b"\"")
    }
}
