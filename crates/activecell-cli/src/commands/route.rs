//! `activecell route`: one robot, from here to there.

use super::Done;
use super::certificate::{COLUMN_HEADS, Certified};
use super::load::{self, Loaded};
use super::outputs::{self, Kind};
use crate::args::{DrawArg, PreferArg, RouteArgs, WrongArgument, heading};
use crate::terminal::Terminal;
use activecell::{
    Cell, Dir, Field, Map, Outcome, Program, Region, Robot, Route, Rule, Terrain, WeightedField,
    check_program, check_slopes,
};
use activecell_formats::run::{RouteReport, Seconds};
use activecell_formats::{files, run as run_file};
use activecell_picture::{RoutePicture, Wave, gif, png, svg, terminal as drawing};
use std::time::Instant;

/// How many entries of M are printed for people.
const PRINTED_WAYPOINTS: usize = 40;

/// What there is to show of a task.
struct Solved {
    map: Map,
    floor: Option<Map>,
    robot: Robot,
    /// Of the user's own robot, if it arrives.
    certified: Option<Certified>,
    /// The robot is the user's own, not the default one.
    own_robot: bool,
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
    /// Where walls are kept off, or the ground is uneven.
    Weighted(Box<WeightedField>),
}

impl Flooded {
    /// The route for a robot that faces somewhere, or anywhere.
    fn route(&self, from: Cell, robot: &Robot, facing: Option<Dir>) -> Route {
        let Some(ahead) = facing else {
            return match self {
                Self::Plain(field) => field.route(from),
                Self::Weighted(field) => field.route(from),
            };
        };
        let lattice = match self {
            Self::Plain(field) => field.lattice(),
            Self::Weighted(field) => field.terrain().map().lattice(),
        };
        let back = robot.can_reverse.then_some(lattice.opposite(ahead));
        let facing: Vec<Dir> = std::iter::once(ahead).chain(back).collect();
        match self {
            Self::Plain(field) => field.route_facing(from, &facing),
            Self::Weighted(field) => field.route_facing(from, &facing),
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
    let pictures = outputs::pictures(&args.picture)?;
    outputs::once_each(args.picture.iter().chain(&args.save))?;
    check_preference(args)?;
    let solved = solve(args, terminal)?;
    if let Some(path) = &args.save {
        let text = run_file::write(&solved.map, &solved.robot, solved.from, solved.to, &solved.report)?;
        files::write_atomically(path, text.as_bytes())?;
    }
    let (title, turns) = (title(args, &solved), solved.turns());
    let time = |cell: Cell| solved.field.as_ref().and_then(|field| field.time(cell));
    let wave: Option<Wave<'_>> = if solved.field.is_some() { Some(&time) } else { None };
    let regions = solved.certified.as_ref().map(Certified::regions).unwrap_or_default();
    let picture = solved.picture(&title, &turns, &regions, wave);
    for (path, kind) in pictures {
        let _working = terminal.working(format!("drawing {}", path.display()));
        let bytes = match kind {
            Kind::Svg => svg(&picture).into_bytes(),
            Kind::Png => png(&picture)?,
            Kind::Gif => gif(&picture)?,
        };
        files::write_atomically(path, &bytes)?;
        terminal.detail(&format!("wrote {}", path.display()));
    }
    if args.json {
        Terminal::result(&format!("{}\n", serde_json::to_string(&solved.report)?))?;
    } else {
        Terminal::result(&(small_map(args, &picture) + &text(&solved)))?;
    }
    Ok(if solved.route.outcome() == Outcome::Arrived { Done::Reached } else { Done::NotReached })
}

fn solve(args: &RouteArgs, terminal: &Terminal) -> anyhow::Result<Solved> {
    let given = args.robot.as_deref().map(load::robot).transpose()?;
    let Loaded { map, floor, .. } = load::on_ground(&args.map, Some(&args.ground), given.as_ref(), terminal)?;
    let (own_robot, robot) = (given.is_some(), given.unwrap_or_default());
    let facing = args.heading.as_deref().map(|name| heading(map.lattice(), name)).transpose()?;
    let (from, wanted_to) = (args.from.on(&map)?, args.to.on(&map)?);
    let uneven = map.elevation().is_some();
    if uneven {
        check_uneven(args)?;
    }
    let to = if args.nearest { map.nearest_reachable(from, wanted_to)? } else { wanted_to };
    if to != wanted_to {
        terminal.note(&format!("note: there is no way to {wanted_to}; the nearest cell with one is {to}"));
    }
    let _working = terminal.working("finding the route");

    let started = Instant::now();
    let rule = Rule::from(args.rule);
    map.check_task(from, to)?;
    let wanted = match args.clearance {
        Some(wanted_m) => Some(map.terrain_kept_clear(from, to, wanted_m)?),
        // Who is there already needs no step.
        None if uneven && from != to => {
            let terrain = map.terrain_for(&robot)?;
            terrain.map().check_task(from, to)?;
            Some(terrain)
        }
        None => None,
    };
    let field = match (rule, &wanted) {
        (Rule::Wave, Some(terrain)) => Some(Flooded::Weighted(Box::new(terrain.wave(to)?))),
        (Rule::Wave, None) => Some(Flooded::Plain(map.wave(to)?)),
        _ => None,
    };
    let flooded = started.elapsed();
    let route = match &field {
        Some(Flooded::Plain(field)) if args.prefer == PreferArg::Short => field.shortest_route(from),
        Some(Flooded::Plain(field)) if args.prefer == PreferArg::Trusted => {
            let trusted = field.trusted_route(&map, &robot, from, facing);
            terminal.detail(&format!("chosen among {}", plural(trusted.candidates, "route")));
            trusted.route
        }
        Some(field) => field.route(from, &robot, facing),
        None => wanted.as_ref().map_or(&map, Terrain::map).route(rule, from, to, args.max_steps)?,
    };
    let all = started.elapsed();
    let field_seconds = if field.is_some() { flooded.as_secs_f64() } else { 0.0 };
    let seconds = Seconds { field: field_seconds, route: all.as_secs_f64() - field_seconds };

    let program = route.program(&robot, &map, facing);
    route.check(&map, from, to)?;
    check_program(&map, &robot, &program, route.cells())?;
    check_slopes(&map, &robot, route.cells())?;
    let mut report = RouteReport::new(rule, &route, &program, &robot, &map, seconds);
    report.clearance_m = args.clearance.and_then(|_| map.clearance_m(route.cells()));
    let certified = (own_robot && route.outcome() == Outcome::Arrived)
        .then(|| Certified::new(&map, &robot, &program, args.trust));
    report.certificate = certified.as_ref().map(Certified::report);
    Ok(Solved { map, floor, robot, certified, own_robot, from, to, field, route, program, report })
}

/// Only the wave leaves a choice, and keeping off walls makes it.
fn check_preference(args: &RouteArgs) -> Result<(), WrongArgument> {
    let wrong = |what: &str| Err(WrongArgument(format!("--prefer short and trusted need {what}")));
    match args.prefer {
        PreferArg::FewTurns => Ok(()),
        _ if Rule::from(args.rule) != Rule::Wave => wrong("the rule wave; leave out --rule"),
        _ if args.clearance.is_some() => wrong("a free choice of the way; leave out --clearance"),
        _ => Ok(()),
    }
}

/// Refuses what does not look at slopes.
fn check_uneven(args: &RouteArgs) -> Result<(), WrongArgument> {
    let refuse = |what: &str| {
        Err(WrongArgument(format!(
            "{what} does not look at slopes; leave it out, or leave the elevation out"
        )))
    };
    match Rule::from(args.rule) {
        Rule::Wave if args.clearance.is_some() => refuse("--clearance"),
        Rule::Wave if args.nearest => refuse("--nearest"),
        Rule::Wave if args.prefer != PreferArg::FewTurns => refuse("--prefer short or trusted"),
        Rule::Wave => Ok(()),
        other => refuse(&format!("--rule {}", other.name())),
    }
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
    if program.waypoints.len() == 1 && route.steps() == 0 {
        return text + "the robot is there already\n";
    }
    if let (Some(ground_m), Some(climb_m), Some(deg)) = (report.ground_m, report.climb_m, report.steepest_deg)
    {
        text += &format!(
            "on the ground: {ground_m:.2} m, climbing {climb_m:.2} m; steepest slope on the way {deg:.1}°\n"
        );
    }
    if let Some(clearance_m) = report.clearance_m {
        text += &format!("clearance: {clearance_m:.2} m\n");
    }
    if solved.own_robot {
        text += &format!("driving takes about {:.0} s and {:.0} J\n", report.drive_s, report.energy_j);
    }
    if let Some(certified) = &solved.certified {
        text += &certified.text();
    }
    if let Some(heading) = report.heading {
        let more = if solved.certified.is_some() { COLUMN_HEADS } else { "" };
        text += &format!("\nstart at {}, facing {heading}\n", solved.from);
        text += &format!("  drive to        revolutions   then turn{more}\n");
    }
    for (i, waypoint) in program.waypoints.iter().enumerate().take(PRINTED_WAYPOINTS) {
        let turn = match waypoint.turn_deg {
            0 => String::new(),
            turn if turn > 0 => format!("{turn}° right"),
            turn => format!("{}° left", -turn),
        };
        let cell = waypoint.cell.to_string();
        let trust = solved.certified.as_ref().map_or_else(String::new, |certified| certified.columns(i));
        let line = format!("  {cell:<14}  {:>11.3}   {turn:<9}{trust}", waypoint.revolutions);
        text += &format!("{}\n", line.trim_end());
    }
    if let Some(more) = program.waypoints.len().checked_sub(PRINTED_WAYPOINTS).filter(|&more| more > 0) {
        text += &format!("  … and {more} more; --json and --save give all\n");
    }
    text
}

fn plural(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

fn summary(report: &RouteReport) -> String {
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
    let (steps, turns) = (plural(*steps, "step"), plural(*turns, "turn"));
    format!("{name} · {lattice} of {cell_m} m · {rule}: {outcome}, {steps}, {turns}, {length_m:.1} m")
}

impl Solved {
    /// Where the robot turns: changing to reverse is no turn.
    fn turns(&self) -> Vec<Cell> {
        let waypoints = self.program.waypoints.iter();
        waypoints.filter(|waypoint| waypoint.turn_deg != 0).map(|waypoint| waypoint.cell).collect()
    }

    fn picture<'a>(
        &'a self,
        title: &'a str,
        turns: &'a [Cell],
        regions: &'a [Region],
        wave: Option<Wave<'a>>,
    ) -> RoutePicture<'a> {
        RoutePicture {
            map: &self.map,
            floor: self.floor.as_ref(),
            title,
            from: self.from,
            to: self.to,
            cells: self.route.cells(),
            turns,
            cycle: self.route.cycle(),
            regions,
            wave,
        }
    }
}

/// The map for the terminal, if one is wanted there.
fn small_map(args: &RouteArgs, picture: &RoutePicture<'_>) -> String {
    let (columns, rows) = match (args.draw, Terminal::size()) {
        (DrawArg::Never, _) | (DrawArg::Auto, None) => return String::new(),
        (_, Some((columns, rows))) => (columns, rows.saturating_sub(6).clamp(5, 40)),
        (DrawArg::Always, None) => (Terminal::columns_wanted().unwrap_or(100), 40),
    };
    let drawn = drawing(picture, columns, rows, Terminal::colour());
    format!("{}\n\n", drawn.trim_end_matches('\n'))
}
