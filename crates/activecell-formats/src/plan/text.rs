//! The text that MAPF tools share, as LaCAM and pibt2 write it and mapf-visualizer shows it (K. Okumura).

use super::scan::Scan;
use super::{PlanFile, Stated, push};
use crate::error::{Error, quoted_bytes};
use crate::lines::Lines;
use activecell::{Cell, Lattice, Plan};
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::str::FromStr;

/// What stands before the solution.
#[derive(Default)]
struct Header {
    stated: Stated,
    agents: Option<u64>,
    lattice: Option<Lattice>,
    starts: Option<Vec<Cell>>,
    targets: Option<Vec<Cell>>,
    unsolved: bool,
}

pub(super) fn read(bytes: &[u8]) -> Result<PlanFile, Error> {
    let mut lines = Lines::new(bytes);
    let mut header = Header::default();
    let mut seen = BTreeSet::new();
    let mut last_line = 1;
    let rest = loop {
        let Some((line, text)) = lines.next() else {
            let reason = if header.unsolved {
                "`solved=0`: the file says that no plan was found; give one with a plan"
            } else {
                "the file ends before `solution=`; it is not a plan, or it was cut"
            };
            return Err(Error::line(last_line, reason));
        };
        last_line = line;
        let Some(equals) = text.iter().position(|&b| b == b'=') else { continue };
        let (key, value) = (text[..equals].trim_ascii(), text[equals + 1..].trim_ascii());
        if key == b"solution" {
            break Scan::new(line, text, equals + 1);
        }
        let is_known = header.read(line, text, key, value, equals + 1)?;
        if is_known && !seen.insert(key) {
            let key = show(key);
            return Err(Error::line(line, format!("`{key}=` is stated twice; remove one of the lines")));
        }
    };
    let plan = read_steps(rest, lines, &header)?;
    let counts = [
        (header.agents, "agents=", "robots"),
        (header.starts.as_ref().map(|cells| cells.len() as u64), "starts=", "cells"),
        (header.targets.as_ref().map(|cells| cells.len() as u64), "goals=", "cells"),
    ];
    for (count, key, what) in counts {
        if let Some(count) = count.filter(|&count| count != plan.robots() as u64) {
            let robots = plan.robots();
            let reason = format!("`{key}` has {count} {what}, the solution {robots}; make them agree");
            return Err(Error::file(reason));
        }
    }
    let Header { stated, lattice, starts, targets, .. } = header;
    Ok(PlanFile { lattice, starts, targets, stated, ..PlanFile::new(plan) })
}

impl Header {
    /// Takes in a line `key=value`, and tells whether the key is known; the value begins at the byte `at`.
    fn read(&mut self, line: usize, text: &[u8], key: &[u8], value: &[u8], at: usize) -> Result<bool, Error> {
        let name = || Some(String::from_utf8_lossy(value).into_owned()).filter(|name| !name.is_empty());
        let wrong = |wanted: &str| {
            Error::at(line, at + 1, format!("{} is {}; give {wanted}", show(key), quoted_bytes(value)))
        };
        let stated = &mut self.stated;
        match key {
            b"agents" => self.agents = whole(value, wrong)?,
            b"map_file" => stated.map_file = name(),
            b"solver" => stated.solver = name(),
            b"seed" => stated.seed = whole(value, wrong)?,
            b"soc" => stated.sum_of_costs = whole(value, wrong)?,
            b"soc_lb" | b"lb_soc" => stated.lower_bound = whole(value, wrong)?,
            b"makespan" => stated.makespan = whole(value, wrong)?,
            b"makespan_lb" | b"lb_makespan" => stated.makespan_lower_bound = whole(value, wrong)?,
            b"comp_time" => {
                let time: Option<f64> = parse(value, || wrong("milliseconds"))?;
                stated.comp_time_ms = time.filter(|ms| ms.is_finite());
            }
            b"solved" => self.unsolved = value == b"0",
            b"lattice" => {
                let named = Lattice::ALL.into_iter().find(|lattice| lattice.name().as_bytes() == value);
                self.lattice = Some(named.ok_or_else(|| wrong("`square` or `hex`"))?);
            }
            b"starts" => self.starts = cells(line, text, at)?,
            b"goals" => self.targets = cells(line, text, at)?,
            _ => return Ok(false),
        }
        Ok(true)
    }
}

fn show(key: &[u8]) -> String {
    String::from_utf8_lossy(key).into_owned()
}

/// A value; nothing after `=` says nothing.
fn parse<T: FromStr>(value: &[u8], wrong: impl Fn() -> Error) -> Result<Option<T>, Error> {
    if value.is_empty() {
        return Ok(None);
    }
    let text = std::str::from_utf8(value).map_err(|_| wrong())?;
    text.parse().map(Some).map_err(|_| wrong())
}

fn whole(value: &[u8], wrong: impl Fn(&str) -> Error) -> Result<Option<u64>, Error> {
    parse(value, || wrong("a whole number from 0"))
}

/// `(x,y),(x,y),` from the byte `at` on; nothing at all says nothing.
fn cells(line: usize, text: &[u8], at: usize) -> Result<Option<Vec<Cell>>, Error> {
    let mut scan = Scan::new(line, text, at);
    let mut cells = Vec::new();
    while !scan.is_done() {
        cells.push(scan.cell()?);
        if !scan.is_done() {
            scan.expect(b',')?;
        }
    }
    Ok((!cells.is_empty()).then_some(cells))
}

/// The rows after `solution=`; the first may stand in its line.
fn read_steps(first: Scan<'_>, lines: Lines<'_>, header: &Header) -> Result<Plan, Error> {
    let mut cells: Vec<Cell> = Vec::new();
    let (mut robots, mut steps) = (None, 0);
    let rest = lines.map(|(line, text)| Scan::new(line, text, 0));
    for mut scan in std::iter::once(first).chain(rest) {
        if scan.is_done() {
            continue;
        }
        let step = scan.number()?;
        if step != steps {
            return Err(
                scan.error(format!("step {step} where step {steps} is due; give every step in order"))
            );
        }
        scan.expect(b':')?;
        let before = cells.len();
        while !scan.is_done() {
            let cell = scan.cell()?;
            push(&mut cells, cell).map_err(|reason| scan.error(reason))?;
            pass_task(&mut scan)?;
            if !scan.is_done() {
                scan.expect(b',')?;
            }
        }
        let count = cells.len() - before;
        let robots = *robots.get_or_insert(count);
        if count != robots {
            let reason =
                format!("step {step} has {count} cells, step 0 has {robots}; give each robot a cell");
            return Err(scan.error(reason));
        }
        steps += 1;
    }
    match robots {
        // Without robots there is nothing to count steps by.
        Some(robots) => Ok(Plan::new(robots, cells)?),
        None if header.unsolved => {
            Err(Error::file("`solved=0`: the file says that no plan was found; give one with a plan"))
        }
        None if header.agents == Some(0) => Ok(Plan::new(0, cells)?),
        None => Err(Error::file("there is no step after `solution=`; the file was cut")),
    }
}

/// What pibt2 writes after a cell where targets keep coming: `->(x,y):task`.
fn pass_task(scan: &mut Scan<'_>) -> Result<(), Error> {
    if scan.take_arrow() {
        scan.pair()?;
        scan.expect(b':')?;
        scan.number()?;
    }
    Ok(())
}

pub(super) fn write(file: &PlanFile) -> String {
    let (plan, stated) = (&file.plan, &file.stated);
    // A row is `t:(x,y),(x,y),`.
    let mut text = String::with_capacity(256 + 8 * plan.robots() * (plan.steps() + 3));
    let mut line = |key: &str, value: &dyn std::fmt::Display| {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{key}={value}");
    };
    line("agents", &plan.robots());
    for (key, name) in [("map_file", &stated.map_file), ("solver", &stated.solver)] {
        if let Some(name) = name {
            line(key, &name.replace(char::is_control, " "));
        }
    }
    line("solved", &1);
    line("soc", &plan.sum_of_costs());
    let bound = stated.lower_bound;
    bound.inspect(|bound| line("soc_lb", bound));
    line("makespan", &plan.makespan());
    stated.makespan_lower_bound.inspect(|bound| line("makespan_lb", bound));
    line("sum_of_loss", &loss(plan, file.targets()));
    bound.inspect(|bound| line("sum_of_loss_lb", bound));
    stated.comp_time_ms.inspect(|ms| line("comp_time", ms));
    stated.seed.inspect(|seed| line("seed", seed));
    file.lattice.inspect(|lattice| line("lattice", lattice));
    for (key, cells) in [("starts", file.starts()), ("goals", file.targets())] {
        text += key;
        text.push('=');
        push_cells(&mut text, cells);
    }
    text += "solution=\n";
    for (step, row) in plan.rows().enumerate() {
        let _ = write!(text, "{step}:");
        push_cells(&mut text, row);
    }
    text
}

fn push_cells(text: &mut String, cells: &[Cell]) {
    for cell in cells {
        let _ = write!(text, "({},{}),", cell.x, cell.y);
    }
    text.push('\n');
}

/// The steps in which robots do not rest at their targets.
fn loss(plan: &Plan, targets: &[Cell]) -> u64 {
    let steps = (1..=plan.steps()).map(|step| {
        let ends = plan.row(step - 1).iter().zip(plan.row(step)).zip(targets);
        ends.filter(|((before, now), target)| before != target || now != target).count() as u64
    });
    steps.sum()
}
