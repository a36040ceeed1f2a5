//! The offline mode: the program alone, driven many times.

use super::super::Done;
use super::super::counted;
use super::stage::Stage;
use super::{percent, picture};
use crate::args::SimulateArgs;
use crate::terminal::Terminal;
use activecell::sim::{Offline, Trial, trial_rng, trials};
use activecell::{Certificate, PointM, Pose, Trust};
use activecell_formats::files;
use activecell_formats::trace::{Distribution, OfflineReport};
use activecell_picture::{Moment, SimulationPicture};
use std::sync::atomic::{AtomicU64, Ordering};

/// If the user does not say how many.
const TRIALS: u32 = 1000;
/// What is kept of a trial.
struct End {
    off_m: PointM,
    inside_cell: bool,
    contacts: Vec<PointM>,
}

pub(crate) fn run(args: &SimulateArgs, stage: &Stage, terminal: &Terminal) -> anyhow::Result<Done> {
    let run = &stage.run;
    anyhow::ensure!(
        !run.program.waypoints.is_empty(),
        "{}: the run holds no program, as its route did not arrive; use --mode task, or save another run",
        args.run.display()
    );
    let offline = Offline::new(&stage.world, &run.program, &run.robot);
    let count = args.trials.unwrap_or(TRIALS);
    let certificate = {
        let _working = terminal.working("reckoning the certificate");
        Certificate::new(&run.map, &run.robot, &run.program)
    };
    let regions = certificate.waypoints();
    let inside: Vec<AtomicU64> = regions.iter().map(|_| AtomicU64::new(0)).collect();
    let bar = terminal.counting(u64::from(count), "driving");
    let step = || bar.step();
    let ends: Vec<End> = trials(count.into(), stage.threads, args.seed, &step, &|rng| {
        let trial = offline.trial(rng);
        count_inside(regions, &trial, &inside);
        let inside_cell = offline.ended_inside(&trial);
        End { off_m: trial.off_m, inside_cell, contacts: trial.contacts }
    });
    drop(bar);
    let share = |count: usize| count as f64 / ends.len() as f64;
    let report = OfflineReport {
        mode: "offline",
        trials: count,
        seed: args.seed,
        drive_s: run.program.effort(&run.robot).time_s,
        end_error_m: Distribution::of(ends.iter().map(|end| end.off_m[0].hypot(end.off_m[1]))),
        inside_cell: share(ends.iter().filter(|end| end.inside_cell).count()),
        certified_inside_cell: regions.last().map_or(1.0, |end| end.inside),
        inside_region: inside.iter().map(|count| share(count.load(Ordering::Relaxed) as usize)).collect(),
        touched: share(ends.iter().filter(|end| !end.contacts.is_empty()).count()),
        contacts: ends.iter().map(|end| end.contacts.len() as u64).sum(),
    };
    let centre_m = stage.run.map.centre_m(stage.run.to);
    let ends_m: Vec<PointM> =
        ends.iter().map(|end| [centre_m[0] + end.off_m[0], centre_m[1] + end.off_m[1]]).collect();
    let way = first_way(args, &offline);
    if let Some(path) = &args.save {
        files::write_atomically(path, stage.file().offline(&report, &way, &ends_m)?.as_bytes())?;
    }
    if !args.picture.is_empty() {
        let title = title(stage, &report);
        let moments: Vec<Moment<'_>> = way
            .iter()
            .map(|&pose| Moment { pose, readings_m: &[], changes: &[], movers: &[], forecasts: &[] })
            .collect();
        let still = SimulationPicture {
            way: &way,
            ends_m: &ends_m,
            region: regions.last().map(Trust::region),
            contacts_m: ends.first().map_or(&[], |end| &end.contacts),
            ..picture::base(stage, &title)
        };
        picture::write(args, stage, &still, &moments, terminal)?;
    }
    if args.json {
        Terminal::result(&format!("{}\n", serde_json::to_string(&report)?))?;
    } else {
        Terminal::result(&text(&report))?;
    }
    Ok(Done::Reached)
}

/// Counts at which waypoints the trial was inside its region: the certificate is held against what happens.
fn count_inside(regions: &[Trust], trial: &Trial, inside: &[AtomicU64]) {
    for ((region, &at_m), inside) in regions.iter().zip(&trial.waypoints_m).zip(inside) {
        inside.fetch_add(u64::from(region.region_holds(at_m)), Ordering::Relaxed);
    }
}

fn title(stage: &Stage, report: &OfflineReport) -> String {
    let (median, p95) = (report.end_error_m.median, report.end_error_m.p95);
    let drives = counted(report.trials.into(), "drive");
    format!("{} · offline · {drives}: end error {median:.2} m, 95 % below {p95:.2} m", stage.name)
}

/// The way of the first trial.
fn first_way(args: &SimulateArgs, offline: &Offline<'_>) -> Vec<Pose> {
    let mut way = Vec::new();
    offline.drive(&mut trial_rng(args.seed, 0), &mut |pose| way.push(pose));
    way
}

/// The result for people.
fn text(report: &OfflineReport) -> String {
    let Distribution { mean, median, p95, most } = report.end_error_m;
    let worst = report.inside_region.iter().copied().fold(1.0, f64::min);
    let last = report.inside_region.last().copied().unwrap_or(1.0);
    let mut lines = vec![
        format!(
            "offline: {} of {:.0} s, no sensor asked",
            counted(report.trials.into(), "drive"),
            report.drive_s
        ),
        format!(
            "end error      mean {mean:.3} m, median {median:.3} m, 95 % below {p95:.3} m, worst {most:.3} m"
        ),
        format!(
            "ended inside   the target's cell {}; the certificate says {}",
            percent(report.inside_cell),
            percent(report.certified_inside_cell)
        ),
        format!(
            "95 % region    holds {} of the ends, {} at the worst waypoint",
            percent(last),
            percent(worst)
        ),
    ];
    lines.push(if report.contacts == 0 {
        "contacts       none".to_owned()
    } else {
        format!("contacts       {} in {} of the drives", report.contacts, percent(report.touched))
    });
    lines.join("\n") + "\n"
}
