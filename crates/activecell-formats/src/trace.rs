//! Traces: what simulated robots did, as JSON, and the reports that `simulate` prints.

use crate::error::Error;
use crate::run::{MapRows, VERSION};
use activecell::sim::{Sighting, Trace, World};
use activecell::{Cell, Map, PointM, Pose};
use serde::Serialize;

/// Some number over all trials: mean, median, 95 % quantile and largest.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Distribution {
    /// The mean.
    pub mean: f64,
    /// Half of the trials lie at or below.
    pub median: f64,
    /// 95 % of the trials lie at or below.
    pub p95: f64,
    /// The largest.
    pub most: f64,
}

impl Distribution {
    /// Of these values.
    ///
    /// ```
    /// use activecell_formats::trace::Distribution;
    /// let distribution = Distribution::of((1..=100).map(f64::from));
    /// assert_eq!((distribution.mean, distribution.median, distribution.p95, distribution.most), (50.5, 50.0, 95.0, 100.0));
    /// ```
    pub fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let mut values: Vec<f64> = values.into_iter().collect();
        values.sort_unstable_by(f64::total_cmp);
        let Some(&most) = values.last() else { return Self::default() };
        let at = |share: f64| values[((values.len() as f64 * share).ceil() as usize).saturating_sub(1)];
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        Self { mean, median: at(0.5), p95: at(0.95), most }
    }
}

/// What `simulate --mode offline --json` prints. Keys are added, never changed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OfflineReport {
    /// `offline`.
    pub mode: &'static str,
    /// How often the program was driven.
    pub trials: u32,
    /// Chance.
    pub seed: u64,
    /// How long a drive takes, in seconds.
    pub drive_s: f64,
    /// From the real centre of the target's cell to where the robot ended.
    pub end_error_m: Distribution,
    /// The share of trials that ended inside the target's cell.
    pub inside_cell: f64,
    /// What the certificate says of that share.
    pub certified_inside_cell: f64,
    /// The share of trials inside the certificate's 95 % region, waypoint by waypoint; the last is the end.
    pub inside_region: Vec<f64>,
    /// The share of trials that touched an obstacle.
    pub touched: f64,
    /// How often an obstacle was touched, in all trials.
    pub contacts: u64,
}

/// What `simulate --mode task --json` prints. Keys are added, never changed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TaskReport {
    /// `task`.
    pub mode: &'static str,
    /// How often the task was set.
    pub trials: u32,
    /// Chance.
    pub seed: u64,
    /// Trials that ended in the target's cell.
    pub arrived: u32,
    /// Trials in which the robot held the target to be unreachable.
    pub unreachable: u32,
    /// Trials that were given up.
    pub gave_up: u32,
    /// Whether a way leads to the target in the world without what comes and goes.
    pub reachable: bool,
    /// How long they took, in seconds.
    pub drive_s: Distribution,
    /// The ways driven.
    pub length_m: Distribution,
    /// From the target's centre to where those that arrived ended.
    pub end_error_m: Distribution,
    /// The largest distance in each trial between where the robot was and where it believed to be.
    pub estimate_error_m: Distribution,
    /// The share of trials that touched something.
    pub touched: f64,
    /// How often something was touched, in all trials.
    pub contacts: u64,
    /// What moving objects did; left out without `--movers`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub movers: Option<MoversReport>,
    /// Obstacles found in the first trial that the map does not have, as [x, y].
    pub found: Vec<[i32; 2]>,
}

/// What moving objects did to the robot, in all trials.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct MoversReport {
    /// The time for which it waited for them, trial by trial.
    pub waited_s: Distribution,
    /// Slots with a plan past them.
    pub slots: u64,
    /// Slots in which whatever it did one could have touched it.
    pub slots_without_a_safe_step: u64,
    /// Objects first seen when they could already reach it within a slot.
    pub seen_too_late: u64,
    /// Times that the driving robot touched one.
    pub contacts_driving: u64,
    /// Times that one ran into the standing robot.
    pub contacts_standing: u64,
}

#[derive(Serialize)]
struct File<'a, Report, Body> {
    activecell: &'static str,
    version: u32,
    #[serde(flatten)]
    report: &'a Report,
    /// What the robot knows, and what is there.
    map: MapRows,
    world: MapRows,
    from: [i32; 2],
    to: [i32; 2],
    #[serde(flatten)]
    body: Body,
}

#[derive(Serialize)]
struct OfflineBody<'a> {
    /// Of the first trial: x, y, bearing.
    way: Vec<[f64; 3]>,
    /// Of every trial.
    ends_m: &'a [PointM],
}

#[derive(Serialize)]
struct TaskBody {
    ending: &'static str,
    ticks: Vec<TickFile>,
    contacts: Vec<ContactFile>,
}

#[derive(Serialize)]
struct TickFile {
    time_s: f64,
    /// x, y, bearing.
    truth: [f64; 3],
    estimate: [f64; 3],
    /// Truth less estimate.
    deviation: [f64; 3],
    spread_m: f64,
    readings_m: Vec<f64>,
    /// g7 to g0.
    inputs: String,
    state: &'static str,
    cell: [i32; 2],
    aim: [i32; 2],
    closed: Vec<[i32; 2]>,
    opened: Vec<[i32; 2]>,
    objects: Vec<ObjectFile>,
    /// Where a slot was planned past them.
    #[serde(skip_serializing_if = "Option::is_none")]
    foreseen: Option<ForeseenFile>,
}

#[derive(Serialize)]
struct ObjectFile {
    number: u32,
    seen_s: f64,
    at_m: PointM,
    /// Where it is likely to be a slot later: the mean, and one standard deviation along each axis.
    then_m: PointM,
    then_std_m: f64,
}

#[derive(Serialize)]
struct ForeseenFile {
    safe_slots: usize,
    waits: bool,
    closed: Vec<[i32; 2]>,
}

#[derive(Serialize)]
struct ContactFile {
    time_s: f64,
    at_m: PointM,
    mover: Option<usize>,
    driving: bool,
    promised: bool,
}

fn object(seen: &Sighting) -> ObjectFile {
    let Sighting { number, at_m, seen_s, then } = *seen;
    ObjectFile { number, seen_s, at_m, then_m: then.at_m, then_std_m: then.std_m }
}

fn pair(cell: Cell) -> [i32; 2] {
    [cell.x, cell.y]
}

fn triple(pose: Pose) -> [f64; 3] {
    [pose.at_m[0], pose.at_m[1], pose.bearing_rad]
}

/// A simulation's stage: the robot's map, the world, start and target.
#[derive(Debug, Clone, Copy)]
pub struct Stage<'a> {
    /// What the robot knows.
    pub map: &'a Map,
    /// What is there.
    pub world: &'a World,
    /// The start.
    pub from: Cell,
    /// The target.
    pub to: Cell,
}

impl Stage<'_> {
    fn file<Report: Serialize, Body: Serialize>(&self, report: &Report, body: Body) -> Result<String, Error> {
        let file = File {
            activecell: "trace",
            version: VERSION,
            report,
            map: MapRows::of(self.map),
            world: MapRows::of(self.world.map()),
            from: pair(self.from),
            to: pair(self.to),
            body,
        };
        let mut text = serde_json::to_string(&file).map_err(|error| Error::file(error.to_string()))?;
        text.push('\n');
        Ok(text)
    }

    /// The trace of trials in the offline mode: the way of the first, and where all ended.
    ///
    /// # Errors
    /// None that a value of these types can cause; the signature is that of the JSON library.
    pub fn offline(&self, report: &OfflineReport, way: &[Pose], ends_m: &[PointM]) -> Result<String, Error> {
        self.file(report, OfflineBody { way: way.iter().copied().map(triple).collect(), ends_m })
    }

    /// The trace of a run in the task mode.
    ///
    /// # Errors
    /// As [`Stage::offline`].
    pub fn task(&self, report: &TaskReport, trace: &Trace) -> Result<String, Error> {
        let ticks = trace.ticks.iter().map(|tick| {
            let (truth, estimate) = (triple(tick.truth), triple(tick.estimate));
            let turned_rad = activecell::sense::wrapped(truth[2] - estimate[2]);
            let cells = |closed: bool| {
                let changes = tick.changes.iter().filter(move |change| change.1 == closed);
                changes.map(|change| pair(change.0)).collect()
            };
            TickFile {
                time_s: tick.time_s,
                truth,
                estimate,
                deviation: [truth[0] - estimate[0], truth[1] - estimate[1], turned_rad],
                spread_m: tick.spread_m,
                readings_m: tick.readings_m.clone(),
                inputs: format!("{:08b}", tick.inputs.0),
                state: tick.state.name(),
                cell: pair(tick.cell),
                aim: pair(tick.aim),
                closed: cells(true),
                opened: cells(false),
                objects: tick.objects.iter().map(object).collect(),
                foreseen: tick.foreseen.as_ref().map(|foreseen| ForeseenFile {
                    safe_slots: foreseen.safe_slots,
                    waits: foreseen.waits,
                    closed: foreseen.closed.iter().copied().map(pair).collect(),
                }),
            }
        });
        let contacts = trace.contacts.iter();
        let contacts = contacts.map(|c| ContactFile {
            time_s: c.time_s,
            at_m: c.at_m,
            mover: c.mover,
            driving: c.driving,
            promised: c.promised,
        });
        let body =
            TaskBody { ending: trace.ending.name(), ticks: ticks.collect(), contacts: contacts.collect() };
        self.file(report, body)
    }
}
