//! Runs: a map, a robot, a task and its route in one JSON file, and the route's report that commands print.

pub use crate::read_run::{MAX_RUN_BYTES, Run, read};

use crate::certificate::CertificateReport;
use crate::error::Error;
use crate::robot::to_json;
use activecell::{Cell, Dir, Effort, Elevation, Map, Outcome, Program, Robot, Route, Rule};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// The version of the run files that are written.
pub const VERSION: u32 = 1;

/// The object that `route --json` prints and that a run file holds.
///
/// The names are a contract: keys are added, never changed.
#[derive(Debug, Clone, Serialize)]
pub struct RouteReport {
    /// `arrived`, `trapped`, `unreachable` or `enclosed`.
    pub outcome: &'static str,
    /// `square` or `hex`.
    pub lattice: &'static str,
    /// `published`, `learning` or `wave`.
    pub rule: &'static str,
    /// Steps from cell to cell.
    pub steps: usize,
    /// Turns that the robot makes.
    pub turns: usize,
    /// The way driven, in metres.
    pub length_m: f64,
    /// What counts as the length of a step on uneven ground, `surface` or `segments`; left out on a flat map, as are
    /// the next four.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ground: Option<&'static str>,
    /// The way on the ground, in metres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ground_m: Option<f64>,
    /// All climbs together, in metres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub climb_m: Option<f64>,
    /// The steepest place along the way, up or down, in degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steepest_deg: Option<f64>,
    /// The steepest slope across it, in degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steepest_across_deg: Option<f64>,
    /// The wheel revolutions of that way, without the turns.
    pub revolutions: f64,
    /// The revolutions that each wheel makes in turns; 0 if the wheels are steered.
    pub turn_revolutions: f64,
    /// How long driving the program takes, in seconds; 0 unless the robot arrived.
    pub drive_s: f64,
    /// The energy that driving it takes, in joules; 0 unless the robot arrived.
    pub energy_j: f64,
    /// The active cells, the start first, as [x, y].
    pub cells: Vec<[i32; 2]>,
    /// The cells in which a trapped robot circles; else empty.
    pub cycle: Vec<[i32; 2]>,
    /// Where the robot faces at the start; null for a route without a step.
    pub heading: Option<&'static str>,
    /// The program M; empty unless the robot arrived.
    pub program: Vec<WaypointReport>,
    /// How far the route stays from obstacles, in metres between centres; left out unless it was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance_m: Option<f64>,
    /// How far the robot can be trusted; null unless a robot was given and it arrives.
    pub certificate: Option<CertificateReport>,
    /// How long it took to find.
    pub seconds: Seconds,
}

/// One entry of M.
#[derive(Debug, Clone, Serialize)]
pub struct WaypointReport {
    /// Column of the cell in which the run ends.
    pub x: i32,
    /// Its row.
    pub y: i32,
    /// The turn made there, degrees, right positive.
    pub turn_deg: i32,
    /// The run to this cell in wheel revolutions, negative backwards.
    pub revolutions: f64,
    /// All climbs of the run together, in metres; left out on a flat map.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub climb_m: Option<f64>,
    /// The revolutions that each wheel makes in the turn.
    pub turn_revolutions: f64,
    /// The encoder ticks of the run, left and right wheel.
    pub run_ticks: [i64; 2],
    /// The encoder ticks of the turn, left and right wheel.
    pub turn_ticks: [i64; 2],
}

impl WaypointReport {
    /// Of all entries of a program.
    pub(crate) fn all(program: &Program, robot: &Robot, map: &Map) -> Vec<Self> {
        let ticks = program.ticks(robot);
        let reports = program.waypoints.iter().zip(ticks).map(|(waypoint, ticks)| Self {
            x: waypoint.cell.x,
            y: waypoint.cell.y,
            turn_deg: waypoint.turn_deg,
            revolutions: waypoint.revolutions,
            climb_m: map.elevation().map(|_| waypoint.climb_m),
            turn_revolutions: waypoint.turn_revolutions,
            run_ticks: ticks.run,
            turn_ticks: ticks.turn,
        });
        reports.collect()
    }
}

/// Computing times.
#[derive(Debug, Clone, Copy, Default, Serialize)]
pub struct Seconds {
    /// For the field (rule `wave`).
    pub field: f64,
    /// For the route.
    pub route: f64,
}

impl RouteReport {
    /// The report of a route over the floor of `map` and of the program that drives it.
    pub fn new(
        rule: Rule,
        route: &Route,
        program: &Program,
        robot: &Robot,
        map: &Map,
        seconds: Seconds,
    ) -> Self {
        let lattice = route.lattice();
        let pair = |cell: &Cell| [cell.x, cell.y];
        let length_m = route.steps() as f64 * map.frame().cell_m;
        let arrived = route.outcome() == Outcome::Arrived;
        let effort = if arrived { program.effort(robot) } else { Effort::default() };
        let waypoints = WaypointReport::all(program, robot, map);
        let uneven = map.elevation().is_some();
        let ground_m = map.ground_m(route.cells());
        let steps = route.cells().windows(2).map(|pair| map.profile_or_flat(pair[0], pair[1]));
        let (along, across) = steps.fold((0.0f64, 0.0f64), |(along, across), step| {
            (along.max(step.up).max(step.down), across.max(step.across))
        });
        let degrees = |slope: f64| uneven.then(|| slope.atan().to_degrees());
        Self {
            outcome: route.outcome().name(),
            lattice: lattice.name(),
            rule: rule.name(),
            steps: route.steps(),
            turns: program.turns(),
            length_m,
            ground: uneven.then(|| map.ground().name()),
            ground_m: uneven.then_some(ground_m),
            climb_m: uneven.then(|| map.climb_m(route.cells())),
            steepest_deg: degrees(along),
            steepest_across_deg: degrees(across),
            revolutions: robot.revolutions(ground_m),
            turn_revolutions: waypoints.iter().map(|waypoint| waypoint.turn_revolutions).sum(),
            drive_s: effort.time_s,
            energy_j: effort.energy_j,
            cells: route.cells().iter().map(pair).collect(),
            cycle: route.cycle().iter().map(pair).collect(),
            heading: program.heading.map(|dir: Dir| lattice.dir_name(dir)),
            program: if arrived { waypoints } else { Vec::new() },
            clearance_m: None,
            certificate: None,
            seconds,
        }
    }
}

#[derive(Serialize)]
struct Written<'a> {
    activecell: &'static str,
    version: u32,
    map: MapRows,
    robot: serde_json::Value,
    from: [i32; 2],
    to: [i32; 2],
    route: &'a RouteReport,
}

/// A map in a JSON file.
#[derive(Serialize, Deserialize)]
pub(crate) struct MapRows {
    pub(crate) lattice: Cow<'static, str>,
    pub(crate) cell_m: f64,
    pub(crate) origin_m: [f64; 2],
    pub(crate) yaw_rad: f64,
    pub(crate) rows: Vec<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) elevation: Option<ElevationRows>,
}

/// The heights under a map; null where there is none.
#[derive(Serialize, Deserialize)]
pub(crate) struct ElevationRows {
    pub(crate) ground: Cow<'static, str>,
    pub(crate) columns: u32,
    pub(crate) rows: u32,
    pub(crate) apart_m: [f64; 2],
    pub(crate) corner_m: [f64; 2],
    pub(crate) yaw_rad: f64,
    pub(crate) heights_m: Vec<Option<f32>>,
}

impl ElevationRows {
    fn of(map: &Map, elevation: &Elevation) -> Self {
        let posts = elevation.posts();
        let heights = elevation.heights_m().iter();
        Self {
            ground: map.ground().name().into(),
            columns: elevation.columns(),
            rows: elevation.rows(),
            apart_m: posts.apart_m,
            corner_m: posts.corner_m,
            yaw_rad: posts.yaw_rad,
            heights_m: heights.map(|&height| (!height.is_nan()).then_some(height)).collect(),
        }
    }
}

impl MapRows {
    /// The map as text, with its lattice, frame and heights.
    pub(crate) fn of(map: &Map) -> Self {
        let frame = map.frame();
        Self {
            lattice: map.lattice().name().into(),
            cell_m: frame.cell_m,
            origin_m: frame.origin_m,
            yaw_rad: frame.yaw_rad,
            rows: map.to_text().lines().map(str::to_owned).collect(),
            elevation: map.elevation().map(|elevation| ElevationRows::of(map, elevation)),
        }
    }
}

/// A run as JSON: everything that is needed to drive it again.
///
/// # Errors
/// None that a value of these types can cause; the signature is that of the JSON library.
pub fn write(map: &Map, robot: &Robot, from: Cell, to: Cell, route: &RouteReport) -> Result<String, Error> {
    let run = Written {
        activecell: "run",
        version: VERSION,
        map: MapRows::of(map),
        robot: to_json(robot),
        from: [from.x, from.y],
        to: [to.x, to.y],
        route,
    };
    let mut text = serde_json::to_string(&run).map_err(|error| Error::file(error.to_string()))?;
    text.push('\n');
    Ok(text)
}
