//! `activecell route`: one robot, from here to there.

use super::Done;
use super::load::{self, Loaded};
use crate::args::{DrawArg, RouteArgs, heading};
use crate::terminal::Terminal;
use activecell::{
    Cell, Field, Map, Outcome, Program, Robot, Route, Rule, Terrain, WeightedField, check_program,
    check_route,
};
use activecell_formats::run::{RouteReport, Seconds};
use activecell_formats::{files, run as run_file};
use activecell_picture::{RoutePicture, gif, png, svg, terminal as drawing};
use std::path::Path;
use std::time::Instant;

/// How many entries of M are printed for people.
const PRINTED_WAYPOINTS: usize = 40;

/// What there is to show of a task.
struct Solved {
    map: Map,
    floor: Option<Map>,
    robot: Robot,
    from: Cell,
    to: Cell,
    field: Option<Flooded>,
    route: Route,
    program: Program,
    report: RouteReport,
}

/// The field that the rule `wave` follows.
enum Flooded {
    Plain(Field),
    /// Where walls are kept off.
    Weighted(WeightedField),
}

impl Flooded {
    fn route(&self, from: Cell) -> Route {
        match self {
            Self::Plain(field) => field.route(from),
            Self::Weighted(field) => field.route(from),
        }
    }

    /// When the wave reached the cell.
    fn time(&self, cell: Cell) -> Option<u32> {
        match self {
            Self::Plain(field) => field.steps(cell),
            Self::Weighted(field) => field.cost(cell),
        }
    }
}

pub(crate) fn run(args: &RouteArgs, terminal: &Terminal) -> anyhow::Result<Done> {
    for path in &args.picture {
        picture_kind(path)?;
    }
    let solved = solve(args, terminal)?;
    if let Some(path) = &args.save {
        let text = run_file::write(&solved.map, &solved.robot, solved.from, solved.to, &solved.report)?;
        files::write_atomically(path, text.as_bytes())?;
    }
    for path in &args.picture {
        let _working = terminal.working(format!("drawing {}", path.display()));
        draw(path, &solved, &title(args, &solved))?;
        terminal.detail(&format!("wrote {}", path.display()));
    }
    if args.json {
        Terminal::result(&format!("{}\n", serde_json::to_string(&solved.report)?))?;
    } else {
        Terminal::result(&(small_map(args, &solved) + &text(&solved)))?;
    }
    Ok(if solved.route.outcome() == Outcome::Arrived { Done::Reached } else { Done::NotReached })
}

fn solve(args: &RouteArgs, terminal: &Terminal) -> anyhow::Result<Solved> {
    let given = args.robot.as_deref().map(load::robot).transpose()?;
    let Loaded { map, floor, .. } = load::map(&args.map, given.as_ref(), terminal)?;
    let robot = given.unwrap_or_default();
    let facing = args.heading.as_deref().map(|name| heading(map.lattice(), name)).transpose()?;
    let (from, to) = (args.from.on(&map)?, args.to.on(&map)?);
    let _working = terminal.working("finding the route");

    let started = Instant::now();
    let rule = Rule::from(args.rule);
    let wanted = args.clearance.map(|wanted_m| map.terrain_kept_clear(from, to, wanted_m)).transpose()?;
    let field = match (rule, &wanted) {
        (Rule::Wave, Some(terrain)) => Some(Flooded::Weighted(terrain.wave(to)?)),
        (Rule::Wave, None) => Some(Flooded::Plain(map.wave_to(to, from)?)),
        _ => None,
    };
    let flooded = started.elapsed();
    let route = match &field {
        Some(field) => field.route(from),
        None => wanted.as_ref().map_or(&map, Terrain::map).route(rule, from, to, args.max_steps)?,
    };
    let all = started.elapsed();
    let field_seconds = if field.is_some() { flooded.as_secs_f64() } else { 0.0 };
    let seconds = Seconds { field: field_seconds, route: all.as_secs_f64() - field_seconds };

    let cell_m = map.frame().cell_m;
    let program = route.program(&robot, cell_m, facing);
    let end = if route.outcome() == Outcome::Arrived { to } else { *route.cells().last().unwrap_or(&from) };
    check_route(&map, route.cells(), from, end)?;
    check_program(&map, &robot, &program, route.cells())?;
    let mut report = RouteReport::new(rule, &route, &program, &robot, cell_m, seconds);
    report.clearance_m = args.clearance.and_then(|_| map.clearance_m(route.cells()));
    Ok(Solved { map, floor, robot, from, to, field, route, program, report })
}

/// The result for people.
fn text(solved: &Solved) -> String {
    let Solved { report, route, program, .. } = solved;
    let mut text = format!("{}\n", summary(report));
    match route.outcome() {
        Outcome::Arrived => {}
        Outcome::Trapped => {
            let cycle: Vec<String> = route.cycle().iter().take(12).map(Cell::to_string).collect();
            let more = if route.cycle().len() > 12 { " …" } else { "" };
            text += &format!("the robot would circle for ever: {}{more}\n", cycle.join(" "));
            text += "the rules `learning` and `wave` always arrive where a way exists\n";
            return text;
        }
        Outcome::Unreachable => {
            text += &format!("no way leads from {} to {}\n", solved.from, solved.to);
            return text;
        }
        Outcome::Enclosed => {
            text += &format!("all neighbours of {} are obstacles\n", solved.from);
            return text;
        }
    }
    if let Some(clearance_m) = report.clearance_m {
        text += &format!("clearance: {clearance_m:.2} m\n");
    }
    if let Some(heading) = report.heading {
        text += &format!("\nstart at {}, facing {heading}\n", solved.from);
        text += "  drive to        revolutions   then turn\n";
    }
    for waypoint in program.waypoints.iter().take(PRINTED_WAYPOINTS) {
        let turn = match waypoint.turn_deg {
            0 => String::new(),
            turn if turn > 0 => format!("{turn}° right"),
            turn => format!("{}° left", -turn),
        };
        let cell = waypoint.cell.to_string();
        let line = format!("  {cell:<14}  {:>11.3}   {turn}", waypoint.revolutions);
        text += &format!("{}\n", line.trim_end());
    }
    if let Some(more) = program.waypoints.len().checked_sub(PRINTED_WAYPOINTS).filter(|&more| more > 0) {
        text += &format!("  … and {more} more; --json and --save give all\n");
    }
    text
}

fn summary(report: &RouteReport) -> String {
    let plural = |count: usize, noun: &str| format!("{count} {noun}{}", if count == 1 { "" } else { "s" });
    format!(
        "{}: {}, {}, {:.2} m, {:.3} wheel revolutions",
        report.outcome,
        plural(report.steps, "step"),
        plural(report.turns, "turn"),
        report.length_m,
        report.revolutions
    )
}

fn title(args: &RouteArgs, solved: &Solved) -> String {
    let name = args.map.path.file_name().unwrap_or_default().to_string_lossy();
    let lattice = match solved.map.lattice() {
        activecell::Lattice::Square => "squares",
        activecell::Lattice::Hex => "hexagons",
    };
    let cell_m = solved.map.frame().cell_m;
    let RouteReport { rule, outcome, steps, turns, length_m, .. } = &solved.report;
    format!(
        "{name} · {lattice} of {cell_m} m · {rule}: {outcome}, {steps} steps, {turns} turns, {length_m:.1} m"
    )
}

/// Calls `with` with the picture of the solved task.
fn with_picture<T>(solved: &Solved, title: &str, with: impl FnOnce(&RoutePicture<'_>) -> T) -> T {
    let width = solved.map.width() as i32;
    let cell = |index: usize| Cell::new(index as i32 % width, index as i32 / width);
    let wave: Option<Vec<Option<u32>>> =
        solved.field.as_ref().map(|field| (0..solved.map.cells()).map(|i| field.time(cell(i))).collect());
    let turns = solved.route.turns();
    with(&RoutePicture {
        map: &solved.map,
        floor: solved.floor.as_ref(),
        title,
        from: solved.from,
        to: solved.to,
        cells: solved.route.cells(),
        turns: &turns,
        cycle: solved.route.cycle(),
        wave: wave.as_deref(),
    })
}

#[derive(Clone, Copy)]
enum Kind {
    Svg,
    Png,
    Gif,
}

fn picture_kind(path: &Path) -> anyhow::Result<Kind> {
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    match ending.as_str() {
        "svg" => Ok(Kind::Svg),
        "png" => Ok(Kind::Png),
        "gif" => Ok(Kind::Gif),
        _ => anyhow::bail!("--picture {}: the name must end in .svg, .png or .gif", path.display()),
    }
}

fn draw(path: &Path, solved: &Solved, title: &str) -> anyhow::Result<()> {
    let kind = picture_kind(path)?;
    let bytes = with_picture(solved, title, |picture| match kind {
        Kind::Svg => Ok(svg(picture).into_bytes()),
        Kind::Png => png(picture),
        Kind::Gif => gif(picture),
    })?;
    Ok(files::write_atomically(path, &bytes)?)
}

/// The map for the terminal, if one is wanted there.
fn small_map(args: &RouteArgs, solved: &Solved) -> String {
    let size = match (args.draw, Terminal::size()) {
        (DrawArg::Never, _) | (DrawArg::Auto, None) => return String::new(),
        (_, Some((columns, rows))) => (columns, rows.saturating_sub(6).clamp(5, 40)),
        (DrawArg::Always, None) => (100, 40),
    };
    let drawn = with_picture(solved, "", |picture| drawing(picture, size.0, size.1, Terminal::colour()));
    format!("{}\n\n", drawn.trim_end_matches('\n'))
}
