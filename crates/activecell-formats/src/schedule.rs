//! Schedules: what each robot of a group needs to execute a plan, as JSON, and what executing it came to.

use crate::error::Error;
use crate::run::WaypointReport;
use crate::trace::Distribution;
use activecell::schedule::{Runner, Visit};
use activecell::{Map, Robot};
use serde::Serialize;
use std::collections::BTreeMap;

/// The version of the schedule files that are written.
pub const VERSION: u32 = 1;

/// What `simulate PLAN --json` prints. Keys are added, never changed. Times are in steps: the time for a cell at full
/// speed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ExecutionReport {
    /// `plan`.
    pub mode: &'static str,
    /// How often the plan was executed.
    pub trials: u32,
    /// Chance.
    pub seed: u64,
    /// `square` or `hex`.
    pub lattice: &'static str,
    /// Robots of the plan.
    pub robots: usize,
    /// Their moves.
    pub moves: usize,
    /// How often robots follow each other around a ring.
    pub rings: usize,
    /// The radius of the robots, in cells.
    pub radius_cells: f64,
    /// The makespan of the plan.
    pub planned_makespan: usize,
    /// Executions in which all robots arrived: all, or the command fails.
    pub arrived: u32,
    /// When the last robot came to rest, over all executions.
    pub makespan: Distribution,
    /// How much later than planned each robot came to rest, over all robots and executions.
    pub late: Distribution,
    /// How long each robot was held up by delays, stops, turns and a lack of speed.
    pub held_up: Distribution,
    /// How long each robot waited for others.
    pub waited: Distribution,
}

#[derive(Serialize)]
struct Document<'a> {
    activecell: &'static str,
    version: u32,
    lattice: &'static str,
    cell_m: f64,
    /// A robot has left a cell when it is so far beyond its centre, as a share of the way to the next.
    clear: f64,
    robots: Vec<RobotEntry>,
    passing: &'a [CellEntry],
}

#[derive(Serialize)]
struct RobotEntry {
    start: [i32; 2],
    heading: Option<&'static str>,
    program: Vec<WaypointReport>,
    visits: Vec<VisitEntry>,
}

#[derive(Serialize)]
struct VisitEntry {
    cell: [i32; 2],
    /// Of the robot at the centre, since its start.
    revolutions: f64,
    /// Robot and visit that must be clear of the cell before.
    after: Option<(usize, usize)>,
    /// How far the robot may be ahead of that one while both move, as a share of the way; null if it must wait.
    play: Option<f64>,
}

#[derive(Serialize)]
struct CellEntry {
    cell: [i32; 2],
    /// Robots and the numbers of their visits, in order.
    order: Vec<(usize, usize)>,
}

/// The schedule that a runner runs, for robots like this one, as a file: of each robot its program and its visits with
/// what each waits for, and of each cell who passes it in which order.
///
/// # Errors
/// None that a value of these types can cause; the signature is that of the JSON library.
///
/// ```
/// use activecell::{Cell, Lattice, Map, Plan, Robot, Schedule, schedule::Runner};
/// let map = Map::parse(Lattice::Square, "...")?;
/// let [a, b, c] = [0, 1, 2].map(|x| Cell::new(x, 0));
/// let schedule = Schedule::new(&map, &Plan::new(2, vec![a, b, a, c, b, c])?)?;
/// let robot = Robot { radius_m: 0.3, ..Robot::default() };
/// let file = activecell_formats::schedule::write(&map, &robot, &Runner::new(&map, &schedule, &robot)?)?;
/// assert!(file.contains(r#""after":[1,0]"#) && file.contains(r#"{"cell":[1,0],"order":[[1,0],[0,1]]}"#));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write(map: &Map, robot: &Robot, runner: &Runner<'_>) -> Result<String, Error> {
    let (schedule, spacing) = (runner.schedule(), runner.spacing());
    let mut passing = BTreeMap::<_, Vec<_>>::new();
    for number in 0..schedule.robots() {
        for (visit, Visit { cell, step, .. }) in schedule.visits(number).enumerate() {
            passing.entry((cell.y, cell.x)).or_default().push((step, number, visit));
        }
    }
    let cells = passing.into_iter().map(|((y, x), mut order)| {
        order.sort_unstable();
        CellEntry { cell: [x, y], order: order.into_iter().map(|(_, robot, visit)| (robot, visit)).collect() }
    });
    let passing: Vec<CellEntry> = cells.collect();
    let visit = |number: usize, (place, visit): (usize, Visit)| VisitEntry {
        cell: [visit.cell.x, visit.cell.y],
        revolutions: runner.revolutions(number, place),
        // A robot that comes back waits for nobody.
        after: visit.after.filter(|&(other, _)| other != number),
        play: visit.bend_deg.and_then(|bend_deg| spacing.play(bend_deg)),
    };
    let robots = (0..schedule.robots()).map(|number| {
        let program = schedule.program(map, number, robot);
        RobotEntry {
            start: [program.start.x, program.start.y],
            heading: program.heading.map(|dir| map.lattice().dir_name(dir)),
            program: WaypointReport::all(&program, robot, map),
            visits: schedule.visits(number).enumerate().map(|one| visit(number, one)).collect(),
        }
    });
    let document = Document {
        activecell: "schedule",
        version: VERSION,
        lattice: map.lattice().name(),
        cell_m: map.frame().cell_m,
        clear: spacing.clear(),
        robots: robots.collect(),
        passing: &passing,
    };
    Ok(serde_json::to_string(&document).map_err(|error| Error::file(error.to_string()))? + "\n")
}
