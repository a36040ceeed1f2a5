//! `activecell check`: whether a plan keeps the rules, whoever made it.

use super::{load, team};
use crate::args::{CheckArgs, LatticeArg, MapArgs, WrongArgument};
use crate::terminal::Terminal;
use activecell::{Lattice, Map, Plan, PlanFault, Team, check_moves, check_plan};
use activecell_formats::files;
use activecell_formats::plan::{FaultReport, MAX_PLAN_BYTES, PlanFile, read_plan};
use serde::Serialize;

#[derive(Serialize)]
struct Report {
    sound: bool,
    lattice: &'static str,
    robots: usize,
    steps: usize,
    sum_of_costs: u64,
    makespan: usize,
    /// Whether anybody said where the robots should end.
    targets_known: bool,
    fault: Option<FaultReport>,
    /// What the file states otherwise.
    disagreements: Vec<Disagreement>,
}

#[derive(Serialize)]
struct Disagreement {
    what: &'static str,
    stated: u64,
    found: u64,
}

pub(crate) fn run(args: CheckArgs, terminal: &Terminal) -> anyhow::Result<()> {
    let CheckArgs { map: map_args, plan: path, scen, json } = args;
    let bytes = files::read_bytes(&path, MAX_PLAN_BYTES)?;
    let file = read_plan(&bytes).map_err(|error| error.in_file(&path))?;
    drop(bytes);
    let map = load::map(&on_lattice(map_args, file.lattice)?, None, terminal)?.map;
    if file.map.as_ref().is_some_and(|made_on| made_on.obstacles() != map.obstacles()) {
        terminal.note("note: the plan was made on another map");
    }
    let robots = file.plan.robots();
    let team = match &scen {
        Some(scen) => Ok(team::of_scenario(&map, scen, Some(robots))?),
        None => Team::new(&map, file.starts().to_vec(), file.targets().to_vec()),
    };
    let fault = match &team {
        Ok(team) => check_plan(&map, team, &file.plan).err(),
        // What a robot does wrong says more than a team that cannot be.
        Err(_) => check_moves(&map, &file.plan).err(),
    };
    if let (None, Err(error)) = (fault, team) {
        return Err(anyhow::Error::new(error).context(path.display().to_string()));
    }
    let report = report(&file, &map, fault, scen.is_some() || file.targets.is_some());
    if json {
        Terminal::result(&(serde_json::to_string(&report)? + "\n"))?;
    } else if fault.is_none() {
        Terminal::result(&text(&report))?;
    }
    match fault {
        Some(fault) => Err(anyhow::Error::new(fault).context(path.display().to_string())),
        None => Ok(()),
    }
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

fn report(file: &PlanFile, map: &Map, fault: Option<PlanFault>, targets_known: bool) -> Report {
    let plan = &file.plan;
    let (sum_of_costs, makespan) = (plan.sum_of_costs(), plan.makespan());
    let mut disagreements = Vec::new();
    let mut compare = |what, stated: Option<u64>, found: u64| {
        if let Some(stated) = stated.filter(|&stated| stated != found) {
            disagreements.push(Disagreement { what, stated, found });
        }
    };
    compare("sum of costs", file.stated.sum_of_costs, sum_of_costs);
    // Some tools count the steps of the plan, in the last of which all may rest.
    let makespans = file.stated.makespan.filter(|&stated| stated != plan.steps() as u64);
    compare("makespan", makespans, makespan as u64);
    Report {
        sound: fault.is_none(),
        lattice: map.lattice().name(),
        robots: plan.robots(),
        steps: plan.steps(),
        sum_of_costs,
        makespan,
        targets_known,
        fault: fault.map(FaultReport::from),
        disagreements,
    }
}

fn text(report: &Report) -> String {
    let Report { robots, steps, sum_of_costs, makespan, .. } = report;
    let arrive = if report.targets_known { ", all arrive" } else { "; nothing says where they should end" };
    let mut text = format!(
        "sound: {robots} robots, {steps} steps{arrive}\nsum of costs   {sum_of_costs}\nmakespan       {makespan}\n"
    );
    for Disagreement { what, stated, found } in &report.disagreements {
        text += &format!("the file states a {what} of {stated}, but it is {found}\n");
    }
    text
}
