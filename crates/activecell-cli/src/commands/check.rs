//! `activecell check`: whether a plan keeps the rules, whoever made it.

use super::group::{self, Group};
use super::{counted, load, scen, team};
use crate::args::{CheckArgs, LatticeArg, MapArgs, WrongArgument};
use crate::terminal::Terminal;
use activecell::{KeepOuts, Lattice, Map, Plan, PlanFault, Team, check_bodies, check_keep_outs, check_plan};
use activecell_formats::files;
use activecell_formats::fleet::{CheckReport, Disagreement};
use activecell_formats::plan::{MAX_PLAN_BYTES, read_plan};
use anyhow::Context;

pub(crate) fn run(args: CheckArgs, terminal: &Terminal) -> anyhow::Result<()> {
    let CheckArgs { map: map_args, plan: path, scen, group: group_args, json } = args;
    let bytes = files::read_bytes(&path, MAX_PLAN_BYTES)?;
    let file = read_plan(&bytes).map_err(|error| error.in_file(&path))?;
    drop(bytes);
    let map_path = map_args.path.clone();
    let map = load::map(&on_lattice(map_args, file.lattice)?, None, terminal)?.map;
    if file.map.as_ref().is_some_and(|made_on| made_on.obstacles() != map.obstacles()) {
        terminal.note("note: the plan was made on another map");
    }
    let (robots, group) = (file.plan.robots(), Group::read(&group_args)?);
    let bodies = group.bodies(robots, &file.bodies)?;
    let stated = || KeepOuts::new(&map, file.keep_outs.clone());
    let keep_outs = match group::keep_outs(&group_args, &map, &bodies)? {
        Some(given) => given,
        None => stated().with_context(|| path.display().to_string())?,
    };
    let team = match &scen {
        Some(scen) => {
            let map = (&map, map_path.as_path());
            Ok(team::of_scenario(map, scen, Some(robots), &group, &file.bodies, terminal)?)
        }
        None => Team::new(&map, file.starts().to_vec(), file.targets().to_vec())
            .and_then(|team| team.with_bodies(&map, bodies.clone())),
    };
    let fault = match &team {
        Ok(team) => first_fault(&map, team, &keep_outs, &file.plan),
        // What a robot does wrong says more than a team that cannot be.
        Err(_) => check_bodies(&map, &bodies, &file.plan).err(),
    };
    if let (None, Err(error)) = (fault, team) {
        return Err(anyhow::Error::new(error).context(path.display().to_string()));
    }
    let stated = [file.stated.sum_of_costs, file.stated.makespan];
    let report = CheckReport {
        targets_known: scen.is_some() || file.targets.is_some(),
        largest_size: bodies.largest(),
        distance: bodies.distance(),
        keep_outs: keep_outs.all().len(),
        ..CheckReport::new(&file.plan, map.lattice(), fault, stated)
    };
    if json {
        Terminal::result(&(serde_json::to_string(&report)? + "\n"))?;
    } else if fault.is_none() {
        Terminal::result(&text(&report))?;
        let rows = scen.map_or(Ok(robots), |path| scen::read(&path).map(|tasks| tasks.len()))?;
        if rows > robots {
            terminal.note(&format!("note: the scenario has {rows} rows, the plan is for the first {robots}"));
        }
    }
    match fault {
        Some(fault) => Err(anyhow::Error::new(fault).context(path.display().to_string())),
        None => Ok(()),
    }
}

/// What is wrong first; at the same step, what the plan itself does wrong.
fn first_fault(map: &Map, team: &Team, keep_outs: &KeepOuts, plan: &Plan) -> Option<PlanFault> {
    let faults = [check_plan(map, team, plan).err(), check_keep_outs(map, team, keep_outs, plan).err()];
    // Who does not arrive is told last.
    faults.into_iter().flatten().min_by_key(|fault| fault.step().unwrap_or(usize::MAX))
}

/// The arguments with the plan's lattice, where it is said.
fn on_lattice(mut args: MapArgs, said: Option<Lattice>) -> Result<MapArgs, WrongArgument> {
    let asked = Lattice::from(args.lattice);
    match said {
        Some(Lattice::Square) if asked == Lattice::Hex => {
            Err(WrongArgument("--lattice hex: the plan says that it is for squares".to_owned()))
        }
        Some(Lattice::Hex) => {
            args.lattice = LatticeArg::Hex;
            Ok(args)
        }
        _ => Ok(args),
    }
}

fn text(report: &CheckReport) -> String {
    let CheckReport { sum_of_costs, makespan, .. } = report;
    let (robots, steps) = (counted(report.robots as u64, "robot"), counted(report.steps as u64, "step"));
    let on = if report.lattice == Lattice::Hex.name() { " on hexagons" } else { "" };
    let arrive = if report.targets_known { ", all arrive" } else { "; nothing says where they should end" };
    let mut text = format!(
        "sound: {robots}{on}, {steps}{arrive}\nsum of costs   {sum_of_costs}\nmakespan       {makespan}\n"
    );
    let CheckReport { largest_size, distance, keep_outs, .. } = *report;
    if largest_size > 0 || distance > 1 {
        text += &format!(
            "bodies         of radius {largest_size} at the most, at least {} apart\n",
            counted(distance.into(), "cell")
        );
    }
    if keep_outs > 0 {
        text += &format!("closed         {}, nobody in any\n", counted(keep_outs as u64, "cell"));
    }
    for Disagreement { what, stated, found } in &report.disagreements {
        let what = what.replace('_', " ");
        text += &format!("the file states a {what} of {stated}, but it is {found}\n");
    }
    text
}
