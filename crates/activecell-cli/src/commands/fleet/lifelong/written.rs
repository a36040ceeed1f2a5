//! The files of a run without end.

use super::Setting;
use crate::args::{FleetArgs, WrongArgument};
use crate::commands::fleet::shared;
use crate::commands::outputs::Kind;
use crate::terminal::Terminal;
use activecell::{Cell, Dir, Journal, Lattice, News, Plan, Team};
use activecell_formats::files;
use activecell_formats::lorr::{Output, TaskEvent, write_output};
use activecell_formats::plan::{PlanFile, PlanFormat};
use activecell_picture::{FleetPicture, FleetView};
use anyhow::Context;
use std::path::Path;

/// Refuses what no format can hold.
pub(super) fn refuse(args: &FleetArgs, formats: &[PlanFormat]) -> Result<(), WrongArgument> {
    let squares_only = args.save.iter().zip(formats).find(|(_, format)| **format == PlanFormat::Json);
    match (squares_only, args.map.lattice.into()) {
        (Some((path, _)), Lattice::Hex) => {
            let path = path.display();
            let message = format!(
                "--save {path}: .json holds runs as the League of Robot Runners does, on squares only; save the cells as .txt or .paths"
            );
            Err(WrongArgument(message))
        }
        _ => Ok(()),
    }
}

/// Writes the run into every file that was asked for: `.json` as the League does, others as a plan of the cells.
pub(super) fn save(
    args: &FleetArgs,
    formats: &[PlanFormat],
    setting: &Setting,
    journal: &Journal,
    planned_us: &[u64],
) -> anyhow::Result<()> {
    for (path, &format) in args.save.iter().zip(formats) {
        let text = match format {
            PlanFormat::Json => output(setting, journal, planned_us),
            PlanFormat::Text | PlanFormat::Paths => cells(args, setting, journal)?.write(format),
        };
        files::write_atomically(path, text.map_err(|error| error.in_file(path))?.as_bytes())?;
    }
    Ok(())
}

/// The run as the League of Robot Runners writes it.
fn output(
    setting: &Setting,
    journal: &Journal,
    planned_us: &[u64],
) -> Result<String, activecell_formats::Error> {
    let steps = 0..=journal.steps();
    let rows: Vec<&[Cell]> = steps.clone().map(|step| journal.cells(step)).collect();
    let headings: Vec<&[Dir]> =
        steps.map(|step| journal.headings(step)).filter(|headings| !headings.is_empty()).collect();
    let tasks: Vec<Vec<Cell>> = setting.tasks.iter().map(|task| task.errands.clone()).collect();
    let event = |event: &activecell::Event| {
        let done = match event.news {
            News::Assigned => 0,
            News::Done(errand) => errand + 1,
        };
        TaskEvent { step: event.step, robot: event.robot, task: event.task, done }
    };
    let events: Vec<TaskEvent> = journal.events().iter().map(event).collect();
    let planning_s: Vec<f64> = planned_us.iter().map(|&us| us as f64 / 1e6).collect();
    write_output(&Output {
        cells: &rows,
        headings: &headings,
        tasks: &tasks,
        events: &events,
        planning_s: &planning_s,
    })
}

/// The cells of the run, as a plan that ends where the robots are at its end.
fn cells(args: &FleetArgs, setting: &Setting, journal: &Journal) -> anyhow::Result<PlanFile> {
    let (lattice, stated) = (Some(setting.map.lattice()), shared::stated(args));
    Ok(PlanFile { lattice, stated, ..PlanFile::new(plan(journal)?) })
}

fn plan(journal: &Journal) -> anyhow::Result<Plan> {
    journal.plan().context("a run of no robots has no plan")
}

/// Draws the run into every picture that was asked for.
pub(super) fn draw(
    args: &FleetArgs,
    pictures: &[(&Path, Kind)],
    setting: &Setting,
    journal: &Journal,
    terminal: &Terminal,
) -> anyhow::Result<()> {
    if pictures.is_empty() {
        return Ok(());
    }
    let plan = plan(journal)?;
    let ends = plan.row(plan.steps()).to_vec();
    let team = Team::new(&setting.map, setting.starts.clone(), ends)?;
    let name = args.map.path.file_stem().unwrap_or_default().to_string_lossy();
    let title = format!("{name} · {} tasks done", journal.finished(&setting.tasks));
    let (map, view) = (&setting.map, FleetView::default());
    let picture =
        FleetPicture { map, title: &title, team: &team, plan: &plan, lower_bound: None, endless: true, view };
    shared::draw(pictures, &picture, terminal)
}
