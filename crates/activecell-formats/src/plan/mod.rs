//! Plan files: where every robot of a group is at every step, and what is said about it.
//!
//! | ending | format | lattices | targets |
//! |---|---|---|---|
//! | `.txt` | the text that MAPF tools share: LaCAM, pibt2, mapf-visualizer | both | yes |
//! | `.json` | ours: runs of moves, with the map if wanted, with sizes, distance and closed cells | both | yes |
//! | `.paths` | a path for each robot: MAPF-LNS2, EECBS, RHCR | not said | no |
//!
//! A reader takes what the bytes say, robots that jump included: [`check_plan`](activecell::check_plan) judges plans.

mod json;
mod moves;
mod paths;
mod scan;
mod text;

pub(crate) use json::Closed;
pub use json::VERSION;

use crate::error::{Error, shown};
use activecell::{Bodies, Cell, KeepOut, Lattice, Map, Plan};
use std::path::Path;

/// The longest plan file that is read, in bytes.
pub const MAX_PLAN_BYTES: u64 = 1 << 30;

/// The most cells that a plan may have when it is read, robots × (steps + 1): 1 GiB in memory.
pub const MAX_PLAN_CELLS: usize = 1 << 27;

/// What a plan file says.
///
/// Everything but the plan may be missing, and may be wrong: another tool wrote it.
///
/// ```
/// use activecell::{Cell, Plan};
/// use activecell_formats::plan::{PlanFile, PlanFormat, read_plan};
/// let (west, east) = (Cell::new(0, 0), Cell::new(1, 0));
/// let mut file = PlanFile::new(Plan::new(1, vec![west, east])?);
/// file.targets = Some(vec![east]);
/// for format in PlanFormat::ALL {
///     let read = read_plan(file.write(format)?.as_bytes())?;
///     assert_eq!((read.plan, read.targets.unwrap_or(vec![east])), (file.plan.clone(), vec![east]));
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct PlanFile {
    /// Where every robot is at every step.
    pub plan: Plan,
    /// The lattice that its steps are taken on.
    pub lattice: Option<Lattice>,
    /// The map itself; only `.json` can hold it.
    pub map: Option<Map>,
    /// Where each robot should start; [`starts`](Self::starts) also where the file does not say.
    pub starts: Option<Vec<Cell>>,
    /// Where each robot should end.
    pub targets: Option<Vec<Cell>>,
    /// The robots' sizes, and the distance that they keep; only `.json` can hold them.
    pub bodies: Bodies,
    /// The cells that the plan keeps out of; only `.json` can hold them.
    pub keep_outs: Vec<KeepOut>,
    /// What the file states besides.
    pub stated: Stated,
}

/// What a plan file states about its plan.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Stated {
    /// The name of the map's file.
    pub map_file: Option<String>,
    /// What made the plan.
    pub solver: Option<String>,
    /// Its seed.
    pub seed: Option<u64>,
    /// The sum of costs.
    pub sum_of_costs: Option<u64>,
    /// No plan has a lower sum of costs: the sum of the distances.
    pub lower_bound: Option<u64>,
    /// The steps until the last robot rests.
    pub makespan: Option<u64>,
    /// No plan has a lower makespan: the longest distance.
    pub makespan_lower_bound: Option<u64>,
    /// How long it took to find, in milliseconds.
    pub comp_time_ms: Option<f64>,
}

impl PlanFile {
    /// A file that says nothing but the plan.
    pub fn new(plan: Plan) -> Self {
        Self {
            plan,
            lattice: None,
            map: None,
            starts: None,
            targets: None,
            bodies: Bodies::default(),
            keep_outs: Vec::new(),
            stated: Stated::default(),
        }
    }

    /// Where each robot should start; where the file does not say, where it does.
    pub fn starts(&self) -> &[Cell] {
        self.starts.as_deref().unwrap_or_else(|| self.plan.row(0))
    }

    /// Where each robot should end; where the file does not say, where it does.
    pub fn targets(&self) -> &[Cell] {
        self.targets.as_deref().unwrap_or_else(|| self.plan.row(self.plan.steps()))
    }

    /// The file in this format. What the format cannot hold is left out.
    ///
    /// # Errors
    /// None that a value of these types can cause; the signature is that of the JSON library.
    pub fn write(&self, format: PlanFormat) -> Result<String, Error> {
        match format {
            PlanFormat::Text => Ok(text::write(self)),
            PlanFormat::Json => json::write(self),
            PlanFormat::Paths => Ok(paths::write(&self.plan)),
        }
    }
}

/// The formats of plan files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PlanFormat {
    /// The text that MAPF tools share: `.txt`.
    Text,
    /// Ours: `.json`.
    Json,
    /// A path for each robot: `.paths`.
    Paths,
}

impl PlanFormat {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Text, Self::Json, Self::Paths];

    /// The format that the path's ending names, in upper or lower case: to write in. What is read says itself what it is.
    ///
    /// # Errors
    /// [`Error::BadFormat`].
    ///
    /// ```
    /// use activecell_formats::plan::PlanFormat;
    /// assert_eq!(PlanFormat::of("plans/Monday.TXT".as_ref())?, PlanFormat::Text);
    /// # Ok::<(), activecell_formats::Error>(())
    /// ```
    pub fn of(path: &Path) -> Result<Self, Error> {
        let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
        match ending.to_str() {
            Some("txt") => Ok(Self::Text),
            Some("json") => Ok(Self::Json),
            Some("paths") => Ok(Self::Paths),
            _ => Err(Error::file(format!(
                "{}: the ending names no plan; use .txt (as MAPF tools share), .json or .paths",
                shown(path)
            ))),
        }
    }
}

/// Reads a plan file in any of the formats; the bytes tell which.
///
/// Text: keys in any order before `solution=`, unknown ones are passed over, all others may be missing, lines end in LF or CRLF, commas
/// at the end may be missing, directions of robots (`(x,y,X_PLUS)`) and the tasks that pibt2 writes after a cell are read and
/// dropped. JSON: keys that are not known are passed over. Paths: shorter ones rest at their ends.
///
/// # Errors
/// [`Error::BadFormat`] with line and column, or with the key of a JSON file; for more than [`MAX_PLAN_CELLS`] before memory is taken for
/// them; for JSON of a later version; for a file that says that no plan was found; for an empty one.
///
/// ```
/// use activecell_formats::plan::read_plan;
/// let error = read_plan(b"agents=1\nsolution=\n0:(1,0),\n1:(1;1),\n").unwrap_err();
/// assert_eq!(error.to_string(), "line 4, column 5: expected `,`, found `;`");
/// # Ok::<(), activecell_formats::Error>(())
/// ```
pub fn read_plan(bytes: &[u8]) -> Result<PlanFile, Error> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let begin = bytes.trim_ascii_start();
    if begin.is_empty() {
        // As `.paths` has it if there are no robots, but nothing tells it from a file that was cut.
        Err(Error::file("the file is empty; give one with a plan, of no robots in .txt or .json"))
    } else if begin.starts_with(b"{") {
        json::read(bytes)
    } else if begin.starts_with(b"Agent ") {
        paths::read(bytes)
    } else {
        text::read(bytes)
    }
}

/// Whether bytes are meant as a plan file in one of the formats, sound or not.
///
/// ```
/// use activecell_formats::plan::is_plan;
/// assert!(is_plan(b"agents=1\nsolution=\n0:(1,0),") && is_plan(b"{\"activecell\": \"plan\", \"version\": 1}"));
/// assert!(!is_plan(b"{\"activecell\": \"run\", \"version\": 1}") && !is_plan(b"..#\n..."));
/// ```
pub fn is_plan(bytes: &[u8]) -> bool {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
    if bytes.starts_with(b"{") {
        return json::is_plan(bytes);
    }
    let solution = b"solution=";
    bytes.starts_with(b"Agent ") || bytes.windows(solution.len()).any(|window| window == solution)
}

/// Adds a cell to those of a plan; refused if they are too many, or the memory is not there.
fn push(cells: &mut Vec<Cell>, cell: Cell) -> Result<(), String> {
    if cells.len() == MAX_PLAN_CELLS {
        return Err(format!("more than the {MAX_PLAN_CELLS} cells that a plan may have; split the plan"));
    }
    if cells.try_reserve(1).is_err() {
        return Err("no memory is left for more cells; split the plan".to_owned());
    }
    cells.push(cell);
    Ok(())
}

/// Memory for all cells of a plan, none if there are no robots; refused if they are too many, before it is taken.
fn room(robots: usize, steps: usize) -> Result<Vec<Cell>, Error> {
    if robots == 0 {
        return Ok(Vec::new());
    }
    let cells = steps.checked_add(1).and_then(|rows| rows.checked_mul(robots));
    let Some(cells) = cells.filter(|&cells| cells <= MAX_PLAN_CELLS) else {
        return Err(Error::file(format!(
            "{robots} robots with {steps} steps are more than the {MAX_PLAN_CELLS} cells that a plan may have; split the plan"
        )));
    };
    let mut room = Vec::new();
    match room.try_reserve_exact(cells) {
        Ok(()) => Ok(room),
        Err(_) => Err(Error::file(format!(
            "{robots} robots with {steps} steps need {} bytes, which are not there; split the plan",
            cells * size_of::<Cell>()
        ))),
    }
}
