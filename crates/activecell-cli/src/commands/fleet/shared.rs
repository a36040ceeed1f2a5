//! What plans with an end and runs without share: what is written, and what is said of it.

use crate::args::{FleetArgs, SizesArg, WrongArgument};
use crate::commands::outputs::{self, Kind};
use crate::terminal::Terminal;
use activecell_formats::files;
use activecell_formats::plan::{PlanFormat, Stated};
use activecell_picture::{FilmLimits, FleetPicture, fleet_gif, fleet_png, fleet_svg};
use std::path::Path;
use std::thread::available_parallelism;

pub(super) fn threads(args: &FleetArgs) -> usize {
    args.threads.map_or_else(|| available_parallelism().map_or(1, usize::from), usize::from)
}

/// The formats to save in; refuses what cannot be written before anything is planned.
pub(super) fn formats(args: &FleetArgs) -> Result<Vec<PlanFormat>, WrongArgument> {
    let written = || args.save.iter().chain(&args.picture);
    outputs::once_each(written())?;
    let mut sources = files::sources(&args.map.path);
    sources.extend(args.scen.iter().chain(&args.group.strangers).cloned());
    if let Some(SizesArg::File(path)) = &args.group.sizes {
        sources.push(path.clone());
    }
    sources.extend(args.lifelong.tasks.iter().chain(&args.lifelong.agents).cloned());
    let sources: Vec<_> = sources.iter().filter_map(|path| path.canonicalize().ok()).collect();
    if let Some(path) = written().find(|path| path.canonicalize().is_ok_and(|it| sources.contains(&it))) {
        let path = path.display();
        return Err(WrongArgument(format!("{path}: the task is read from this file; write to another name")));
    }
    let format =
        |path: &std::path::PathBuf| PlanFormat::of(path).map_err(|error| WrongArgument(error.to_string()));
    args.save.iter().map(format).collect()
}

/// Draws the plan into every picture that was asked for.
pub(super) fn draw(
    pictures: &[(&Path, Kind)],
    picture: &FleetPicture<'_>,
    terminal: &Terminal,
) -> anyhow::Result<()> {
    for &(path, kind) in pictures {
        let _working = terminal.working(format!("drawing {}", path.display()));
        let bytes = match kind {
            Kind::Svg => fleet_svg(picture).into_bytes(),
            Kind::Png => fleet_png(picture)?,
            Kind::Gif => fleet_gif(picture, &FilmLimits::default())?.gif,
        };
        files::write_atomically(path, &bytes)?;
        terminal.detail(&format!("wrote {}", path.display()));
    }
    Ok(())
}

/// What every plan of this command states.
pub(super) fn stated(args: &FleetArgs) -> Stated {
    Stated {
        map_file: args.map.path.file_name().map(|name| name.to_string_lossy().into_owned()),
        solver: Some(concat!("activecell ", env!("CARGO_PKG_VERSION")).to_owned()),
        seed: Some(args.seed),
        ..Stated::default()
    }
}

/// The most memory that this process has had, where the system tells.
pub(super) fn peak_bytes() -> Option<u64> {
    let status = std::fs::read_to_string(Path::new("/proc/self/status")).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()? * 1024)
}

pub(super) fn duration(ms: f64) -> String {
    if ms < 1e3 { format!("{ms:.1} ms") } else { format!("{:.1} s", ms / 1e3) }
}
