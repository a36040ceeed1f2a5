//! Reads run files again. They may come from anywhere: every number is checked against the map.

use crate::error::{Error, quoted};
use crate::robot::from_json;
use crate::run::{ElevationRows, MapRows, VERSION};
use activecell::{Cell, Elevation, Frame, Ground, Lattice, Map, Posts, Program, Robot, Rule, Waypoint};
use serde::Deserialize;

/// The longest run file that is read, in bytes.
pub const MAX_RUN_BYTES: u64 = 1 << 29;

/// What a run file holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// The map that the route was found on.
    pub map: Map,
    /// The robot that it was found for.
    pub robot: Robot,
    /// Where the robot starts.
    pub from: Cell,
    /// Where it is to go.
    pub to: Cell,
    /// The rule that found the route.
    pub rule: Rule,
    /// The cells of the route, the start first.
    pub cells: Vec<Cell>,
    /// The program M; without waypoints unless the route arrived.
    pub program: Program,
}

#[derive(Deserialize)]
struct RunFile {
    activecell: String,
    version: u32,
    map: MapRows,
    robot: serde_json::Value,
    from: [i32; 2],
    to: [i32; 2],
    route: RouteFile,
}

#[derive(Deserialize)]
struct RouteFile {
    rule: String,
    cells: Vec<[i32; 2]>,
    heading: Option<String>,
    program: Vec<WaypointFile>,
}

#[derive(Deserialize)]
struct WaypointFile {
    x: i32,
    y: i32,
    turn_deg: i32,
    revolutions: f64,
    turn_revolutions: f64,
    #[serde(default)]
    climb_m: f64,
}

/// Reads a run file. Keys that it does not know are left alone.
///
/// # Errors
/// [`Error::BadFormat`]: not JSON, no run file, of a later version, or numbers that do not fit its map; errors of the
/// map and the robot.
///
/// ```
/// use activecell::{Cell, Lattice, Map, Robot, Rule};
/// use activecell_formats::run::{self, RouteReport, Seconds};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let map = Map::parse(Lattice::Hex, "S..\n.#.\n..F")?;
/// let (from, to, robot) = (Cell::new(0, 0), Cell::new(2, 2), Robot::default());
/// let route = map.route(Rule::Wave, from, to, 100)?;
/// let program = route.program(&robot, &map, None);
/// let report = RouteReport::new(Rule::Wave, &route, &program, &robot, &map, Seconds::default());
/// let text = run::write(&map, &robot, from, to, &report)?;
/// let run = run::read(text.as_bytes())?;
/// assert_eq!((run.map, run.robot, run.program, run.cells.as_slice()), (map, robot, program, route.cells()));
/// # Ok(())
/// # }
/// ```
pub fn read(bytes: &[u8]) -> Result<Run, Error> {
    let file: RunFile = serde_json::from_slice(bytes).map_err(|error| not_json(&error))?;
    if file.activecell != "run" {
        let kind = quoted(&file.activecell);
        return Err(Error::file(format!("activecell is {kind}, not `run`; give a file of `route --save`")));
    }
    if file.version != VERSION {
        let version = file.version;
        return Err(Error::file(format!(
            "version {version} is not known here, only {VERSION}; update activecell"
        )));
    }
    let map = file.map.map()?;
    let robot = from_json(&file.robot)?;
    let on_map = |what: &str, [x, y]: [i32; 2]| {
        let cell = Cell::new(x, y);
        if map.contains(cell) {
            return Ok(cell);
        }
        Err(Error::file(format!("{what}: the cell {cell} lies outside the map; save the run again")))
    };
    let (from, to) = (on_map("from", file.from)?, on_map("to", file.to)?);
    let route = file.route;
    let rule = Rule::ALL.into_iter().find(|rule| rule.name() == route.rule).ok_or_else(|| {
        Error::file(format!("route.rule is {}; it must be published, learning or wave", quoted(&route.rule)))
    })?;
    let cells = route.cells.into_iter().map(|cell| on_map("route.cells", cell));
    let cells = cells.collect::<Result<Vec<Cell>, Error>>()?;
    let heading = route.heading.map(|name| {
        map.lattice().dir_named(&name).ok_or_else(|| {
            Error::file(format!("route.heading is {}, no direction of this lattice", quoted(&name)))
        })
    });
    let heading = heading.transpose()?;
    let mut last = from;
    let mut waypoints = Vec::with_capacity(route.program.len());
    for (number, waypoint) in route.program.into_iter().enumerate() {
        let what = format!("route.program[{number}]");
        let cell = on_map(&what, [waypoint.x, waypoint.y])?;
        // On the steepest ground the way is six times as long as on the map.
        let most_m = 10.0 * f64::from(map.lattice().distance(last, cell)) * map.frame().cell_m + 1e-9;
        let length_m = waypoint.revolutions.abs() * robot.wheel_perimeter_m;
        if !(length_m <= most_m && waypoint.turn_deg.abs() <= 180 && waypoint.turn_revolutions.abs() < 1e9) {
            let reason = format!("{what} does not lead from {last} to {cell} and a turn; save the run again");
            return Err(Error::file(reason));
        }
        let WaypointFile { turn_deg, revolutions, turn_revolutions, climb_m, .. } = waypoint;
        waypoints.push(Waypoint { cell, revolutions, turn_deg, turn_revolutions, climb_m });
        last = cell;
    }
    Ok(Run { map, robot, from, to, rule, cells, program: Program { start: from, heading, waypoints } })
}

/// The place and the first line of what is wrong.
fn not_json(error: &serde_json::Error) -> Error {
    let text = error.to_string();
    let reason = text.split(" at line ").next().unwrap_or_default().replace('\n', " ");
    let reason = format!("not a run file: {}; give a file of `route --save`", reason.trim());
    if error.line() == 0 { Error::file(reason) } else { Error::at(error.line(), error.column(), reason) }
}

impl MapRows {
    /// The map that the rows show.
    pub(crate) fn map(self) -> Result<Map, Error> {
        let lattice = Lattice::ALL.into_iter().find(|lattice| lattice.name() == self.lattice);
        let lattice = lattice.ok_or_else(|| {
            Error::file(format!("map.lattice is {}; it must be square or hex", quoted(&self.lattice)))
        })?;
        // A row that holds a line's end would be two.
        if let Some(row) = self.rows.iter().position(|row| row.contains(['\n', '\r']) || row.is_empty()) {
            return Err(Error::file(format!("map.rows[{row}] is no row of a text map; save the run again")));
        }
        let map = Map::parse(lattice, &self.rows.join("\n")).map_err(|error| match error {
            activecell::Error::BadFormat { line, column, reason } => {
                Error::file(format!("map.rows[{}], column {column}: {reason}", line - 1))
            }
            other => other.into(),
        })?;
        let frame = Frame { cell_m: self.cell_m, origin_m: self.origin_m, yaw_rad: self.yaw_rad };
        let map = map.in_frame(frame)?;
        match self.elevation {
            Some(rows) => rows.under(map),
            None => Ok(map),
        }
    }
}

impl ElevationRows {
    /// The map with these heights under it.
    fn under(self, map: Map) -> Result<Map, Error> {
        let ground =
            Ground::ALL.into_iter().find(|ground| ground.name() == self.ground).ok_or_else(|| {
                Error::file(format!(
                    "map.elevation.ground is {}; it must be surface or segments",
                    quoted(&self.ground)
                ))
            })?;
        let posts = Posts { apart_m: self.apart_m, corner_m: self.corner_m, yaw_rad: self.yaw_rad };
        let heights = self.heights_m.into_iter().map(|height| height.unwrap_or(f32::NAN)).collect();
        Ok(map.elevated(Elevation::new(self.columns, self.rows, heights, posts)?, ground))
    }
}
