//! From the arguments to a world, a robot and its run.

use super::super::load;
use crate::args::{ModeArg, SimulateArgs, WrongArgument};
use crate::terminal::Terminal;
use activecell::predict::Bounds;
use activecell::sim::{Gait, Mover, Visit, World, trial_rng};
use activecell::{BitPlane, Cell, Drive, Map, Program, Robot};
use activecell_formats::files::{self, ReadOptions};
use activecell_formats::run::{self, MAX_RUN_BYTES, Run};
use activecell_formats::trace;
use std::path::Path;
use std::thread::available_parallelism;

/// Everything that a simulation starts from.
pub(crate) struct Stage {
    /// The run, its robot and program replaced where another robot was named.
    pub(crate) run: Run,
    /// What is really there.
    pub(crate) world: World,
    /// The run's name for titles.
    pub(crate) name: String,
    pub(crate) threads: usize,
    /// What the walkers may do, if there are any.
    pub(crate) bounds: Option<Bounds>,
}

/// The radius of a walker, how fast it changes its speed, and how long it walks.
const WALKER_M: f64 = 0.2;
const WALKER_MPS2: f64 = 0.3;
const WALK_S: f64 = 10_000.0;
/// No walker sets out nearer to the robot.
const APART_M: f64 = 2.0;

impl Stage {
    /// What trace files begin with.
    pub(crate) fn file(&self) -> trace::Stage<'_> {
        let Run { map, from, to, .. } = &self.run;
        trace::Stage { map, world: &self.world, from: *from, to: *to }
    }
}

/// Reads the run and builds the world.
pub(crate) fn set(args: &SimulateArgs, terminal: &Terminal) -> anyhow::Result<Stage> {
    let _working = terminal.working(format!("reading {}", args.run.display()));
    let bytes = files::read_bytes(&args.run, MAX_RUN_BYTES)?;
    let mut run = run::read(&bytes).map_err(|error| error.in_file(&args.run))?;
    if let Some(path) = &args.robot {
        let robot = load::robot(path)?;
        run.program = driven_by(&run.program, &run.robot, &robot)?;
        run.robot = robot;
    }
    run.map.check_task(run.from, run.to)?;
    let map = match (&args.world, args.missing) {
        (Some(path), _) => real(path, &run.map)?,
        (None, Some(share)) => with_missing(&run, share, args.seed)?,
        (None, None) => run.map.clone(),
    };
    anyhow::ensure!(map.is_free(run.from), "the start {} lies in an obstacle of the world", run.from);
    let visits: Vec<Visit> = args.appear.iter().map(|appear| appear.0).collect();
    if let Some(visit) = visits.iter().find(|visit| !map.is_free(visit.cell)) {
        let cell = visit.cell;
        return Err(WrongArgument(format!("--appear {cell}: no free cell of the world; name one")).into());
    }
    if args.movers > 0 && args.mode == ModeArg::Offline {
        return Err(WrongArgument("--movers: no sensor is asked offline; add --mode task".into()).into());
    }
    let bounds = (args.movers > 0).then_some(Bounds {
        radius_m: WALKER_M,
        max_speed_mps: args.mover_speed,
        max_accel_mps2: WALKER_MPS2,
        seen_within_m: 0.0,
    });
    let walkers = walkers(args, &map, run.from)?;
    let name = args.run.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let threads = args.threads.map_or_else(|| available_parallelism().map_or(1, usize::from), usize::from);
    let world = World::new(&map).with_visits(&visits).with_movers(walkers);
    Ok(Stage { run, world, name, threads, bounds })
}

/// Walkers that set out on free cells away from the robot.
fn walkers(args: &SimulateArgs, map: &Map, from: Cell) -> anyhow::Result<Vec<Mover>> {
    let [x, y] = map.centre_m(from);
    let far = |cell: &Cell| {
        let at_m = map.centre_m(*cell);
        (at_m[0] - x).hypot(at_m[1] - y) > APART_M
    };
    let free: Vec<Cell> = map.free().filter(far).collect();
    anyhow::ensure!(
        args.movers == 0 || !free.is_empty(),
        "--movers: no free cell lies more than {APART_M} m from the start; use a larger map"
    );
    // Just below what the robot is told, so that rounding does not break it.
    let gait = Gait {
        radius_m: WALKER_M,
        max_speed_mps: 0.999 * args.mover_speed,
        max_accel_mps2: 0.999 * WALKER_MPS2,
    };
    let mut rng = trial_rng(args.seed, u64::MAX - 1);
    let mut walker = || {
        let cell = free[rng.below(free.len() as u32) as usize];
        Mover::walker(map, cell, gait, WALK_S, &mut rng)
    };
    Ok((0..args.movers).map(|_| walker()).collect())
}

/// The program for another robot: the same runs and turns.
fn driven_by(program: &Program, planned: &Robot, robot: &Robot) -> anyhow::Result<Program> {
    let mut program = program.clone();
    for waypoint in &mut program.waypoints {
        waypoint.revolutions *= planned.wheel_perimeter_m / robot.wheel_perimeter_m;
        waypoint.turn_revolutions = match robot.drive {
            Drive::Steered => 0.0,
            Drive::Differential => robot.turn_revolutions(waypoint.turn_deg),
        };
        anyhow::ensure!(
            robot.can_reverse || waypoint.revolutions >= 0.0,
            "the program drives backwards to {}, which this robot cannot; plan the route with --robot",
            waypoint.cell
        );
    }
    Ok(program)
}

/// A map file in the run's lattice and frame.
fn real(path: &Path, known: &Map) -> anyhow::Result<Map> {
    let (map, _) = files::read_map(path, &ReadOptions::default())?;
    let size = (known.width(), known.height());
    anyhow::ensure!(
        (map.width(), map.height()) == size,
        "{}: the world has {} x {} cells, the run's map {} x {}; give a map of the same cells",
        path.display(),
        map.width(),
        map.height(),
        size.0,
        size.1
    );
    Ok(map.on(known.lattice()).in_frame(*known.frame())?)
}

/// The map with so many more obstacles that this share of all is missing in it; never on start and target.
fn with_missing(run: &Run, share: f64, seed: u64) -> anyhow::Result<Map> {
    let map = &run.map;
    let known = (map.cells() - map.free_cells()) as f64;
    let mut free: Vec<Cell> = map.free().filter(|&cell| cell != run.from && cell != run.to).collect();
    let more = ((known * share / (1.0 - share)).round() as usize).min(free.len());
    let mut obstacles: BitPlane = map.obstacles().clone();
    // The world's chance is not that of any trial.
    let mut rng = trial_rng(seed, u64::MAX);
    for _ in 0..more {
        let cell = free.swap_remove(rng.below(free.len() as u32) as usize);
        obstacles.set(cell.x as u32, cell.y as u32, true);
    }
    Ok(Map::new(map.lattice(), obstacles).in_frame(*map.frame())?)
}
