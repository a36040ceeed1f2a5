//! Lifelong tasks: the files of the League of Robot Runners, and lists as CSV.
//!
//! A problem is a JSON file that names a map, a file of starts and a file of tasks. Cells are single numbers there, row ×
//! columns + column. The output that a run is written to is shown by `PlanViz`.
//!
//! Source: S.-H. Chan et al., *The League of Robot Runners Competition*, 2024; its start kit defines the files. The CSV lists
//! are those of the EPIBT repository (E. Yukhnevich and A. Andreychuk, 2025).

mod output;

pub use output::{Output, TaskEvent, write_output};

use crate::error::{Error, quoted, quoted_bytes};
use crate::files;
use crate::lines::Lines;
use activecell::{Cell, Map};
use serde::Deserialize;
use std::path::Path;

/// The longest list of starts or tasks, and the longest problem file, that is read, in bytes.
pub const MAX_LIST_BYTES: u64 = 256 << 20;

/// A problem: everything that its JSON file names.
#[derive(Debug, Clone, PartialEq)]
pub struct Problem {
    /// The map, of squares.
    pub map: Map,
    /// Where each robot starts.
    pub starts: Vec<Cell>,
    /// The tasks in the order in which they appear: the cells to visit, in this order.
    pub tasks: Vec<Vec<Cell>>,
    /// So many tasks a robot are known at any time.
    pub tasks_revealed: f64,
}

/// The keys that mean something here; the others (delays, sizes) are passed over.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct ProblemFile {
    map_file: String,
    agent_file: String,
    task_file: String,
    team_size: usize,
    #[serde(default = "one")]
    num_tasks_reveal: f64,
}

fn one() -> f64 {
    1.0
}

/// Reads a problem with the map, the starts and the tasks that it names, looked for in its folder. Of the starts, the first
/// `teamSize` count.
///
/// # Errors
/// All errors of [`files::read_map`], [`read_agents`] and [`read_tasks`], with the file; [`Error::BadFormat`] if the file is no problem,
/// or asks for more robots than there are starts.
pub fn read_problem(path: &Path) -> Result<Problem, Error> {
    let bytes = files::read_bytes(path, MAX_LIST_BYTES)?;
    let file = problem_file(&bytes).map_err(|error| error.in_file(path))?;
    let beside = |name: &str| path.parent().unwrap_or(Path::new("")).join(name);
    let (map, _) = files::read_map(&beside(&file.map_file), &files::ReadOptions::default())?;
    let agents = beside(&file.agent_file);
    let starts = read_agents(&files::read_bytes(&agents, MAX_LIST_BYTES)?, &map);
    let mut starts = starts.map_err(|error| error.in_file(&agents))?;
    if starts.len() < file.team_size {
        let (asked, given) = (file.team_size, starts.len());
        let reason = format!(
            "teamSize is {asked}, but {} has {given} starts; make them agree",
            quoted(&file.agent_file)
        );
        return Err(Error::file(reason).in_file(path));
    }
    starts.truncate(file.team_size);
    let tasks = beside(&file.task_file);
    let list = read_tasks(&files::read_bytes(&tasks, MAX_LIST_BYTES)?, &map);
    let list = list.map_err(|error| error.in_file(&tasks))?;
    Ok(Problem { map, starts, tasks: list, tasks_revealed: file.num_tasks_reveal })
}

fn problem_file(bytes: &[u8]) -> Result<ProblemFile, Error> {
    let file: ProblemFile = serde_json::from_slice(bytes).map_err(|error| {
        let text = error.to_string();
        let reason = text.split(" at line ").next().unwrap_or_default().replace(char::is_control, " ");
        let reason = format!("not a problem of the League of Robot Runners: {}", reason.trim());
        if error.line() == 0 { Error::file(reason) } else { Error::at(error.line(), error.column(), reason) }
    })?;
    if file.num_tasks_reveal.is_finite() && file.num_tasks_reveal > 0.0 {
        return Ok(file);
    }
    let found = file.num_tasks_reveal;
    Err(Error::file(format!("numTasksReveal is {found}; give a number of tasks a robot above 0")))
}

/// Reads where robots start: a list with its length in front, a cell a line, or CSV with the header `agent id,row,col`.
///
/// Whether robots can stand there is for [`Team::new`](activecell::Team::new) and the like to say, except that the cells must lie on the
/// map.
///
/// # Errors
/// [`Error::BadFormat`] with line and column.
///
/// ```
/// use activecell::{Cell, Lattice, Map};
/// use activecell_formats::lorr::read_agents;
/// let map = Map::parse(Lattice::Square, "...\n...")?;
/// let cells = vec![Cell::new(1, 0), Cell::new(2, 1)];
/// assert_eq!(read_agents(b"# version for LoRR 2026\n2\n1\n5\n", &map)?, cells);
/// assert_eq!(read_agents(b"agent id,row,col\n0,0,1\n1,1,2\n", &map)?, cells);
/// # Ok::<(), activecell_formats::Error>(())
/// ```
pub fn read_agents(bytes: &[u8], map: &Map) -> Result<Vec<Cell>, Error> {
    let mut list = List::new(bytes);
    if list.header(b"agent id,row,col") {
        let mut cells = Vec::new();
        while let Some(line) = list.next() {
            let [robot, row, column] = line.numbers()?[..] else {
                return Err(line.error("expected three numbers: agent id, row, column"));
            };
            if robot != cells.len() as u64 {
                return Err(line.error(format!(
                    "agent {robot} where {} is due; give every agent in order",
                    cells.len()
                )));
            }
            cells.push(line.cell(map, column, row)?);
        }
        return Ok(cells);
    }
    list.counted("starts", |line| match line.numbers()?[..] {
        [number] => line.numbered(map, number),
        _ => Err(line.error("expected one cell: row × columns + column")),
    })
}

/// Reads tasks: a list with its length in front, the cells of a task in a line, separated by commas; or CSV with the header
/// `targets`, a cell a line.
///
/// # Errors
/// [`Error::BadFormat`] with line and column, also for a cell that is not free.
///
/// ```
/// use activecell::{Cell, Lattice, Map};
/// use activecell_formats::lorr::read_tasks;
/// let map = Map::parse(Lattice::Square, "...\n.#.")?;
/// let [a, b] = [Cell::new(1, 0), Cell::new(2, 1)];
/// assert_eq!(read_tasks(b"2\n1,5\n5\n", &map)?, [vec![a, b], vec![b]]);
/// assert_eq!(read_tasks(b"targets\n1\n5\n", &map)?, [[a], [b]]);
/// let error = read_tasks(b"targets\n4\n", &map).unwrap_err();
/// assert_eq!(error.to_string(), "line 2: the target (1,1) lies in an obstacle; the nearest free cell is (1,0)");
/// # Ok::<(), activecell_formats::Error>(())
/// ```
pub fn read_tasks(bytes: &[u8], map: &Map) -> Result<Vec<Vec<Cell>>, Error> {
    let task = |line: &Line<'_>| {
        let cells = line.numbers()?.into_iter().map(|number| {
            let cell = line.numbered(map, number)?;
            map.check_target(cell).map(|()| cell).map_err(|error| line.error(error.to_string()))
        });
        cells.collect::<Result<Vec<Cell>, Error>>()
    };
    let mut list = List::new(bytes);
    if list.header(b"targets") {
        let mut tasks = Vec::new();
        while let Some(line) = list.next() {
            tasks.push(task(&line)?);
        }
        return Ok(tasks);
    }
    list.counted("tasks", task)
}

/// The lines of a list that are neither empty nor a remark.
struct List<'a> {
    lines: std::iter::Peekable<Lines<'a>>,
}

impl<'a> List<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        Self { lines: Lines::new(bytes).peekable() }
    }

    /// Whether the first line is this header; then it is passed.
    fn header(&mut self, header: &[u8]) -> bool {
        self.lines.next_if(|(_, text)| text.trim_ascii().eq_ignore_ascii_case(header)).is_some()
    }

    fn next(&mut self) -> Option<Line<'a>> {
        let mut lines = self.lines.by_ref().map(|(number, text)| Line { number, text });
        lines.find(|line| !line.text.trim_ascii().is_empty() && !line.text.starts_with(b"#"))
    }

    /// A list whose first number is the count of what follows. Memory is taken for lines that are there.
    fn counted<T>(
        mut self,
        what: &str,
        mut read: impl FnMut(&Line<'_>) -> Result<T, Error>,
    ) -> Result<Vec<T>, Error> {
        let Some(first) = self.next() else {
            return Err(Error::file(format!("the list is empty; begin it with the number of {what}")));
        };
        let [count] = first.numbers()?[..] else {
            return Err(first.error(format!("expected the number of {what}")));
        };
        let mut items = Vec::new();
        while let Some(line) = self.next() {
            items.push(read(&line)?);
        }
        if items.len() as u64 == count {
            return Ok(items);
        }
        Err(first.error(format!("the list says {count} {what}, and has {}; make them agree", items.len())))
    }
}

/// A line with its number.
struct Line<'a> {
    number: usize,
    text: &'a [u8],
}

impl Line<'_> {
    fn error(&self, reason: impl Into<String>) -> Error {
        Error::line(self.number, reason)
    }

    /// The line's numbers, separated by commas.
    fn numbers(&self) -> Result<Vec<u64>, Error> {
        let mut column = 1;
        let numbers = self.text.split(|&b| b == b',').map(|field| {
            let at = column;
            column += String::from_utf8_lossy(field).chars().count() + 1;
            let number = std::str::from_utf8(field.trim_ascii()).ok().and_then(|text| text.parse().ok());
            number.ok_or_else(|| {
                Error::at(
                    self.number,
                    at,
                    format!("expected a whole number from 0, found {}", quoted_bytes(field)),
                )
            })
        });
        numbers.collect()
    }

    /// The cell in this column and row.
    fn cell(&self, map: &Map, column: u64, row: u64) -> Result<Cell, Error> {
        if column < u64::from(map.width()) && row < u64::from(map.height()) {
            return Ok(Cell::new(column as i32, row as i32));
        }
        let (columns, rows) = (map.width(), map.height());
        Err(self.error(format!(
            "row {row}, column {column} is outside the map of {rows} rows and {columns} columns; is it the right map?"
        )))
    }

    /// The cell of this number.
    fn numbered(&self, map: &Map, number: u64) -> Result<Cell, Error> {
        let columns = u64::from(map.width());
        if number < columns * u64::from(map.height()) {
            return self.cell(map, number % columns, number / columns);
        }
        let cells = map.cells();
        Err(self.error(format!("cell {number} is outside the map of {cells} cells; is it the right map?")))
    }
}
