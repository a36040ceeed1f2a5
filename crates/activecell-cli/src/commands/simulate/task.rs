//! The task mode: the run's errand, corrected by the control unit and the sensors.

use super::super::Done;
use super::super::counted;
use super::stage::Stage;
use super::{percent, picture};
use crate::args::SimulateArgs;
use crate::terminal::Terminal;
use activecell::sim::{Ending, Sighting, Tally, Task, Tick, Trace, trial_rng, trials};
use activecell::{Dir, PointM, Pose};
use activecell_formats::files;
use activecell_formats::trace::{Distribution, MoversReport, TaskReport};
use activecell_picture::{Moment, SimulationPicture};

/// What is kept of a trial.
struct Kept {
    ending: Ending,
    time_s: f64,
    length_m: f64,
    end_error_m: f64,
    estimate_error_m: f64,
    contacts: usize,
    /// With something that moves: while driving, while standing.
    run_into: [usize; 2],
    tally: Tally,
}

pub(crate) fn run(args: &SimulateArgs, stage: &Stage, terminal: &Terminal) -> anyhow::Result<Done> {
    let run = &stage.run;
    let heading = run.program.heading.unwrap_or(Dir(0));
    let task =
        Task { heading, rule: run.rule, bounds: stage.bounds, ..Task::new(&run.map, run.from, run.to) };
    // The first trial alone tells whether the task can be set at all, and its trace is kept.
    let first = task.run(&stage.world, &run.robot, &mut trial_rng(args.seed, 0))?;
    let count = args.trials.unwrap_or(1);
    let bar = terminal.counting(count.into(), "driving");
    let step = || bar.step();
    let kept = trials(count.into(), stage.threads, args.seed, &step, &|rng| {
        Ok(keep(stage, &task.run(&stage.world, &run.robot, rng)?))
    });
    drop(bar);
    let kept = kept.into_iter().collect::<Result<Vec<Kept>, activecell::Error>>()?;
    let report = report(args, stage, &first, &kept);
    if let Some(path) = &args.save {
        files::write_atomically(path, stage.file().task(&report, &first)?.as_bytes())?;
    }
    if !args.picture.is_empty() {
        draw(args, stage, &report, &first, terminal)?;
    }
    if args.json {
        Terminal::result(&format!("{}\n", serde_json::to_string(&report)?))?;
    } else {
        Terminal::result(&text(&report))?;
    }
    Ok(if report.arrived == report.trials { Done::Reached } else { Done::NotReached })
}

fn draw(
    args: &SimulateArgs,
    stage: &Stage,
    report: &TaskReport,
    trace: &Trace,
    terminal: &Terminal,
) -> anyhow::Result<()> {
    let way: Vec<Pose> = trace.ticks.iter().map(|tick| tick.truth).collect();
    let believed: Vec<Pose> = trace.ticks.iter().map(|tick| tick.estimate).collect();
    let contacts_m: Vec<PointM> = trace.contacts.iter().map(|contact| contact.at_m).collect();
    let instants = instants(stage, trace);
    let moments: Vec<Moment<'_>> = instants.iter().map(Instant::moment).collect();
    let (ending, found) = (trace.ending.name(), counted(trace.found.len() as u64, "obstacle"));
    let length_m = trace.length_m;
    let contacts = counted(trace.contacts.len() as u64, "contact");
    let rule = stage.run.rule;
    let title = format!(
        "{} · task, {rule}: {ending} after {length_m:.1} m, {found} found, {contacts}, seed {}",
        stage.name, report.seed
    );
    let still = SimulationPicture {
        way: &way,
        believed: &believed,
        contacts_m: &contacts_m,
        found: &trace.found,
        ..picture::base(stage, &title)
    };
    picture::write(args, stage, &still, &moments, terminal)
}

/// A moment of the drive, between two ticks perhaps.
struct Instant<'a> {
    pose: Pose,
    tick: &'a Tick,
    /// The first moment of its tick.
    first: bool,
    movers: Vec<(PointM, f64)>,
    forecasts: Vec<(PointM, f64)>,
}

/// Among movers so much time passes between two moments.
const MOMENT_S: f64 = 0.5;

/// The ticks; among movers also moments between them, as the next tick may be a slot later.
fn instants<'a>(stage: &Stage, trace: &'a Trace) -> Vec<Instant<'a>> {
    let movers = stage.world.movers();
    let mut instants = Vec::new();
    for (number, tick) in trace.ticks.iter().enumerate() {
        let next = trace.ticks.get(number + 1).unwrap_or(tick);
        let pieces = if movers.is_empty() {
            1
        } else {
            ((next.time_s - tick.time_s) / MOMENT_S).ceil().max(1.0) as u32
        };
        let forecasts: Vec<(PointM, f64)> =
            fresh(tick).map(|seen| (seen.then.at_m, seen.then.radius_m(0.9).max(0.1))).collect();
        for piece in 0..pieces {
            let share = f64::from(piece) / f64::from(pieces);
            let between = |a: f64, b: f64| a + share * (b - a);
            let (from, to) = (tick.truth, next.truth);
            let turned_rad = activecell::sense::wrapped(to.bearing_rad - from.bearing_rad);
            let pose = Pose {
                at_m: [0, 1].map(|k| between(from.at_m[k], to.at_m[k])),
                bearing_rad: from.bearing_rad + share * turned_rad,
            };
            let time_s = between(tick.time_s, next.time_s);
            let movers = movers.iter().map(|mover| (mover.at_m(time_s), mover.radius_m)).collect();
            instants.push(Instant { pose, tick, first: piece == 0, movers, forecasts: forecasts.clone() });
        }
    }
    instants
}

/// The objects in sight; what is only remembered would cover half the floor.
fn fresh(tick: &Tick) -> impl Iterator<Item = &Sighting> {
    tick.objects.iter().filter(|seen| tick.time_s - seen.seen_s < MOMENT_S)
}

impl Instant<'_> {
    fn moment(&self) -> Moment<'_> {
        let (readings_m, changes) = (&self.tick.readings_m, &self.tick.changes);
        Moment {
            pose: self.pose,
            readings_m: if self.first { readings_m } else { &[] },
            changes: if self.first { changes } else { &[] },
            movers: &self.movers,
            forecasts: &self.forecasts,
        }
    }
}

fn keep(stage: &Stage, trace: &Trace) -> Kept {
    let apart_m = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
    let target_m = stage.run.map.centre_m(stage.run.to);
    let off = trace.ticks.iter().map(|tick| apart_m(tick.truth.at_m, tick.estimate.at_m));
    Kept {
        ending: trace.ending,
        time_s: trace.ticks.last().map_or(0.0, |tick| tick.time_s),
        length_m: trace.length_m,
        end_error_m: trace.ticks.last().map_or(0.0, |tick| apart_m(tick.truth.at_m, target_m)),
        estimate_error_m: off.fold(0.0, f64::max),
        contacts: trace.contacts.len(),
        run_into: [true, false].map(|driving| {
            trace.contacts.iter().filter(|c| c.mover.is_some() && c.driving == driving).count()
        }),
        tally: trace.tally,
    }
}

fn report(args: &SimulateArgs, stage: &Stage, first: &Trace, kept: &[Kept]) -> TaskReport {
    let count = |ending: Ending| kept.iter().filter(|kept| kept.ending == ending).count() as u32;
    let of = |value: fn(&Kept) -> f64| Distribution::of(kept.iter().map(value));
    let arrived = kept.iter().filter(|kept| kept.ending == Ending::Arrived);
    let touched = kept.iter().filter(|kept| kept.contacts > 0).count();
    let world = stage.world.map();
    TaskReport {
        mode: "task",
        trials: kept.len() as u32,
        seed: args.seed,
        arrived: count(Ending::Arrived),
        unreachable: count(Ending::Unreachable),
        gave_up: count(Ending::GaveUp),
        reachable: world.wave(stage.run.to).is_ok_and(|field| field.steps(stage.run.from).is_some()),
        drive_s: of(|kept| kept.time_s),
        length_m: of(|kept| kept.length_m),
        end_error_m: Distribution::of(arrived.map(|kept| kept.end_error_m)),
        estimate_error_m: of(|kept| kept.estimate_error_m),
        touched: touched as f64 / kept.len().max(1) as f64,
        contacts: kept.iter().map(|kept| kept.contacts as u64).sum(),
        movers: stage.bounds.map(|_| moved(kept)),
        found: first.found.iter().map(|cell| [cell.x, cell.y]).collect(),
    }
}

/// What moving objects did to all trials.
fn moved(kept: &[Kept]) -> MoversReport {
    let sum = |of: fn(&Kept) -> usize| kept.iter().map(of).sum::<usize>() as u64;
    MoversReport {
        waited_s: Distribution::of(kept.iter().map(|kept| kept.tally.waited_s)),
        slots: sum(|kept| kept.tally.slots),
        slots_without_a_safe_step: sum(|kept| kept.tally.helpless),
        seen_too_late: sum(|kept| kept.tally.surprises),
        contacts_driving: sum(|kept| kept.run_into[0]),
        contacts_standing: sum(|kept| kept.run_into[1]),
    }
}

/// The result for people.
fn text(report: &TaskReport) -> String {
    let TaskReport { trials, arrived, unreachable, gave_up, .. } = report;
    let mut endings = vec![format!("{arrived} arrived")];
    endings.extend((*unreachable > 0).then(|| format!("{unreachable} held the target to be unreachable")));
    endings.extend((*gave_up > 0).then(|| format!("{gave_up} gave up")));
    let world = if report.reachable { "a way exists" } else { "no way exists in this world" };
    let mut lines =
        vec![format!("task: {}, {}; {world}", counted((*trials).into(), "drive"), endings.join(", "))];
    let spread = |name: &str, unit: &str, digits: usize, values: &Distribution| {
        let Distribution { mean, median, p95, most } = values;
        if *trials == 1 {
            return format!("{name:<14} {most:.digits$} {unit}");
        }
        format!(
            "{name:<14} mean {mean:.digits$} {unit}, median {median:.digits$} {unit}, 95 % below {p95:.digits$} {unit}, worst {most:.digits$} {unit}"
        )
    };
    lines.push(spread("time", "s", 0, &report.drive_s));
    lines.push(spread("way", "m", 1, &report.length_m));
    if *arrived > 0 {
        lines.push(spread("end error", "m", 3, &report.end_error_m));
    }
    lines.push(spread("pose error", "m", 3, &report.estimate_error_m));
    lines.push(format!(
        "found          {} that the map does not have",
        counted(report.found.len() as u64, "obstacle")
    ));
    if let Some(movers) = &report.movers {
        lines.push(spread("waited", "s", 0, &movers.waited_s));
        let MoversReport { slots, slots_without_a_safe_step, contacts_driving, contacts_standing, .. } =
            movers;
        lines.push(format!(
            "slots          {slots} planned past movers, {slots_without_a_safe_step} without a safe step"
        ));
        lines.push(format!(
            "movers         touched by the driving robot {contacts_driving} times, ran into the standing one {contacts_standing} times"
        ));
    }
    lines.push(if report.contacts == 0 {
        "contacts       none".to_owned()
    } else {
        format!("contacts       {} in {} of the drives", report.contacts, percent(report.touched))
    });
    lines.join("\n") + "\n"
}
