//! `activecell calibrate`: wheels and noise from logs, and how well they hold on others.

use super::load;
use crate::args::{CalibrateArgs, WrongArgument};
use crate::terminal::Terminal;
use activecell::{Calibration, DriveLog, EndError, PointM, Robot, TruthNoise, calibrate};
use activecell_formats::calibration::{CalibrationReport, HeldOutRow, diff_drive_yaml, median};
use activecell_formats::{files, robot};
use activecell_picture::{DrivePanel, drives_png, drives_svg};
use std::path::{Path, PathBuf};

/// More unevenness of a floor than this is doubted: a real one has a tenth of it.
const DOUBTFUL_M_PER_SQRT_M: f64 = 0.03;

/// Logs that were driven together.
struct Session {
    folder: PathBuf,
    names: Vec<String>,
    logs: Vec<DriveLog>,
}

impl Session {
    fn name(&self) -> String {
        self.folder.file_name().unwrap_or_default().to_string_lossy().into_owned()
    }

    /// A log of this session that one of the others holds too.
    fn seen_in(&self, others: &[Self]) -> Option<&str> {
        let same = others.iter().find(|other| other.folder == self.folder)?;
        self.names.iter().find(|name| same.names.contains(name)).map(String::as_str)
    }
}

/// A log and the robot of a fit that did not see it.
struct Judged<'a> {
    log: &'a DriveLog,
    robot: Robot,
    row: HeldOutRow,
}

pub(crate) fn run(args: &CalibrateArgs, terminal: &Terminal) -> anyhow::Result<()> {
    let draw = args.picture.as_deref().map(picture_kind).transpose()?;
    if let Some(twice) = args.output.as_ref().filter(|output| Some(*output) == args.picture.as_ref()) {
        return Err(WrongArgument(format!("{} is to be written twice", twice.display())).into());
    }
    let mut metadata = None;
    let sessions = read(&args.logs, &mut metadata, terminal)?;
    let others = read(&args.hold_out, &mut metadata, terminal)?;
    if let Some(seen) = others.iter().find_map(|other| other.seen_in(&sessions)) {
        return Err(
            WrongArgument(format!("the fit sees {seen}, so it cannot be held out; name it once")).into()
        );
    }
    let written = args.output.iter().chain(&args.picture);
    if let Some(path) =
        written.into_iter().find(|path| args.logs.iter().chain(&args.hold_out).any(|log| log == *path))
    {
        return Err(
            WrongArgument(format!("{} is a log; give another name to write to", path.display())).into()
        );
    }
    let given = args.robot.as_deref().map(load::robot_and_text).transpose()?;
    let Some(nominal) = given.as_ref().map(|given| given.0).or(metadata) else {
        return Err(WrongArgument(format!(
            "{} does not say which robot drove; give --robot FILE.toml with its ticks_per_rev and, roughly, wheel_perimeter_m and track_m",
            args.logs[0].display()
        ))
        .into());
    };
    let fitted: Vec<&[DriveLog]> = sessions.iter().map(|session| session.logs.as_slice()).collect();
    let found = calibrate(&fitted, &nominal)?;
    if found.robot.errors.unevenness_m_per_sqrt_m > DOUBTFUL_M_PER_SQRT_M {
        terminal.note(&format!(
            "note: after one metre dead reckoning is off by {:.2} m whatever the wheels: are the wheels' columns swapped, a sign, ticks_per_rev or the bearing wrong?",
            found.robot.errors.unevenness_m_per_sqrt_m
        ));
    }
    let (held_out, judged) = hold_out(args, &sessions, &others, &nominal, &found, terminal)?;

    if let Some(path) = &args.output {
        let text = given.map(|given| given.1).unwrap_or_default();
        files::write_atomically(path, robot::update(&text, &found.robot)?.as_bytes())?;
    }
    if let (Some(path), Some(draw)) = (&args.picture, draw) {
        files::write_atomically(path, &draw_all(&judged, &nominal, draw)?)?;
    }
    let count = sessions.iter().map(|session| session.logs.len()).sum();
    let logs = fitted.iter().copied().flatten();
    let way_m = logs.map(|log| log.end_error(&nominal, found.truth).way_m).sum();
    let rows = judged.into_iter().map(|judged| judged.row).collect();
    let report = CalibrationReport::new(&found, [sessions.len(), count], way_m, held_out, rows);
    if args.json {
        return Terminal::result(&format!("{}\n", serde_json::to_string(&report)?));
    }
    Terminal::result(&text(&report, &found, &nominal))
}

/// Reads logs into sessions, one for each folder, in the order in which they come.
fn read(
    paths: &[PathBuf],
    metadata: &mut Option<Robot>,
    terminal: &Terminal,
) -> anyhow::Result<Vec<Session>> {
    let lists = paths.iter().map(|path| files::drive_logs(path)).collect::<Result<Vec<_>, _>>()?;
    let paths = lists.concat();
    let bar = terminal.counting(paths.len() as u64, "reading logs");
    let mut sessions: Vec<Session> = Vec::new();
    for path in &paths {
        let (log, robot) = files::read_drive_log(path)?;
        if let Some(robot) = robot
            && *metadata.get_or_insert(robot) != robot
        {
            let reason = "its metadata describe another robot than those before; calibrate each robot alone";
            return Err(anyhow::anyhow!("{}: {reason}", path.display()));
        }
        // However it is written, a folder is one session.
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let folder = folder.canonicalize().unwrap_or(folder.to_owned());
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        // Names of the OptiOdom data set begin with their folder's.
        let name = match folder.file_name().map(|name| name.to_string_lossy()) {
            Some(folder) if !stem.starts_with(&*folder) => format!("{folder}/{stem}"),
            _ => stem,
        };
        match sessions.iter_mut().find(|session| session.folder == folder) {
            Some(session) if session.names.contains(&name) => {
                return Err(WrongArgument(format!("{} is named twice; name it once", path.display())).into());
            }
            Some(session) => {
                session.names.push(name);
                session.logs.push(log);
            }
            None => sessions.push(Session { folder, names: vec![name], logs: vec![log] }),
        }
        bar.step();
    }
    Ok(sessions)
}

/// Judges each log by a fit that did not see it, or its session.
fn hold_out<'a>(
    args: &CalibrateArgs,
    sessions: &'a [Session],
    others: &'a [Session],
    nominal: &Robot,
    found: &Calibration,
    terminal: &Terminal,
) -> anyhow::Result<(&'static str, Vec<Judged<'a>>)> {
    let judge = |session: &'a Session, which: usize, found: &Calibration| {
        let log = &session.logs[which];
        // A fit on other logs cannot know how far off the marker was on these.
        let truth = TruthNoise { position_m: found.truth.position_m.max(args.truth), ..found.truth };
        let ends = [nominal, &found.robot].map(|robot| -> EndError { log.end_error(robot, truth) });
        let row = HeldOutRow::new(&session.name(), &session.names[which], &ends[0], &ends[1]);
        Judged { log, robot: found.robot, row }
    };
    if !others.is_empty() {
        let each = others.iter().flat_map(|session| (0..session.logs.len()).map(move |i| (session, i)));
        return Ok(("hold-out", each.map(|(session, i)| judge(session, i, found)).collect()));
    }
    let all: usize = sessions.iter().map(|session| session.logs.len()).sum();
    let mut judged = Vec::new();
    if let [_, _, ..] = sessions {
        let bar = terminal.counting(sessions.len() as u64, "fitting without each session");
        for (left_out, session) in sessions.iter().enumerate() {
            let rest = sessions.iter().enumerate().filter(|(i, _)| *i != left_out);
            let rest: Vec<&[DriveLog]> = rest.map(|(_, session)| session.logs.as_slice()).collect();
            let found = calibrate(&rest, nominal)?;
            judged.extend((0..session.logs.len()).map(|i| judge(session, i, &found)));
            bar.step();
        }
        return Ok(("session", judged));
    }
    if all < 2 {
        terminal.note(
            "note: one log alone cannot tell how well the fit holds on others; drive at least one more",
        );
        return Ok(("none", judged));
    }
    terminal.note("note: all logs are of one session (folder), so how much sessions differ is not known");
    let session = &sessions[0];
    let bar = terminal.counting(all as u64, "fitting without each log");
    for i in 0..all {
        let (before, after) = (&session.logs[..i], &session.logs[i + 1..]);
        let rest = [before, after].concat();
        judged.push(judge(session, i, &calibrate(&[&rest], nominal)?));
        bar.step();
    }
    Ok(("log", judged))
}

#[derive(Clone, Copy)]
enum Kind {
    Svg,
    Png,
}

fn picture_kind(path: &Path) -> Result<Kind, WrongArgument> {
    match path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase().as_str() {
        "svg" => Ok(Kind::Svg),
        "png" => Ok(Kind::Png),
        _ => Err(WrongArgument(format!("--picture {}: the name must end in .svg or .png", path.display()))),
    }
}

fn draw_all(judged: &[Judged<'_>], nominal: &Robot, kind: Kind) -> anyhow::Result<Vec<u8>> {
    let reckoned = |log: &DriveLog, robot: &Robot| -> Vec<PointM> {
        log.dead_reckoning(robot).map(|state| state.pose().at_m).collect()
    };
    let drawn: Vec<(&HeldOutRow, String, [Vec<PointM>; 3])> = judged
        .iter()
        .map(|judged| {
            let truth = judged.log.rows().iter().filter_map(|row| Some(row.truth?.at_m)).collect();
            let (row, log) = (&judged.row, judged.log);
            let note = format!(
                "end {:.0} → {:.0} mm on {:.1} m",
                row.nominal_m * 1e3,
                row.calibrated_m * 1e3,
                row.way_m
            );
            (row, note, [truth, reckoned(log, nominal), reckoned(log, &judged.robot)])
        })
        .collect();
    let panels: Vec<DrivePanel<'_>> = drawn
        .iter()
        .map(|(row, note, [truth, nominal, calibrated])| DrivePanel {
            title: &row.log,
            note,
            truth,
            nominal,
            calibrated,
        })
        .collect();
    Ok(match kind {
        Kind::Svg => drives_svg(&panels).into_bytes(),
        Kind::Png => drives_png(&panels)?,
    })
}

fn plural(count: usize, one: &str) -> String {
    format!("{count} {one}{}", if count == 1 { "" } else { "s" })
}

/// The report for people.
fn text(report: &CalibrationReport, found: &Calibration, nominal: &Robot) -> String {
    let (logs, sessions) = (plural(report.logs, "log"), plural(report.sessions, "session"));
    let mut text = format!(
        "calibrated on {logs} of {sessions}, {:.1} m, {} measured poses ({} left out)\n\n",
        report.way_m, report.poses, report.left_out
    );
    text += "| | nominal | calibrated | fit ± | sessions ± |\n|---|---|---|---|---|\n";
    let robot = &found.robot;
    let size = [robot.wheel_perimeter_m, 1.0, robot.track_m];
    for (i, (key, before, after)) in [
        ("wheel_perimeter_m", nominal.wheel_perimeter_m, robot.wheel_perimeter_m),
        ("wheel_difference_rel", nominal.wheel_difference_rel, robot.wheel_difference_rel),
        ("track_m", nominal.track_m, robot.track_m),
    ]
    .into_iter()
    .enumerate()
    {
        let [fit, between] = [found.fit_rel[i], found.between_sessions_rel[i]].map(|share| share * size[i]);
        text += &format!("| {key} | {before:.6} | {after:.6} | {fit:.6} | {between:.6} |\n");
    }
    text += &format!(
        "\nuneven floor {:.5} m/√m; noise of the truth {:.1} mm, {:.2}°\n",
        robot.errors.unevenness_m_per_sqrt_m,
        report.truth_m * 1e3,
        report.truth_rad.to_degrees()
    );
    text += &held_out_text(report);
    text + "\nROS 2, diff_drive_controller:\n" + &indented(&diff_drive_yaml(robot))
}

fn indented(text: &str) -> String {
    text.lines().flat_map(|line| ["  ", line, "\n"]).collect()
}

/// How well it holds on logs that the fit did not see.
fn held_out_text(report: &CalibrationReport) -> String {
    let how = match report.held_out {
        "session" => "each by a fit on the other sessions",
        "log" => "each by a fit on the other logs",
        "hold-out" => "not part of the fit",
        _ => return String::new(),
    };
    let mut text = format!("\nLogs that the fit did not see ({how}):\n\n");
    text += "| log | way | end error | | heading error | | inside 95 % |\n";
    text += "|---|---|---|---|---|---|---|\n| | | nominal | calibrated | nominal | calibrated | |\n";
    for row in &report.rows {
        text += &format!(
            "| {} | {:.1} m | {:.1} mm | {:.1} mm | {:.2}° | {:.2}° | {} |\n",
            row.log,
            row.way_m,
            row.nominal_m * 1e3,
            row.calibrated_m * 1e3,
            row.nominal_rad.to_degrees(),
            row.calibrated_rad.to_degrees(),
            if row.inside { "yes" } else { "no" }
        );
    }
    let middle = |number: fn(&HeldOutRow) -> f64| median(report.rows.iter().map(number)).unwrap_or(0.0);
    let falls = |falls: Option<f64>| falls.unwrap_or(0.0);
    text += &format!(
        "\nmedian end error {:.1} → {:.1} mm: falls {:.1} times\n",
        middle(|row| row.nominal_m) * 1e3,
        middle(|row| row.calibrated_m) * 1e3,
        falls(report.median_end_error_falls),
    );
    text += &format!(
        "in the median log it falls {:.1} times; the worst one of a session falls {:.1} times in the median session\n",
        falls(report.end_error_falls),
        falls(report.worst_end_error_falls)
    );
    text += &format!(
        "median heading error {:.2}° → {:.2}°\n",
        middle(|row| row.nominal_rad.abs()).to_degrees(),
        middle(|row| row.calibrated_rad.abs()).to_degrees(),
    );
    text + &format!("{} of {} ends inside their 95 % region\n", report.inside, report.rows.len())
}
