//! The pictures of a simulation.

use super::stage::Stage;
use crate::args::{SimulateArgs, WrongArgument};
use crate::terminal::Terminal;
use activecell_formats::files;
use activecell_picture::{
    Moment, MovingPicture, SimulationPicture, simulation_gif, simulation_png, simulation_svg,
};

/// Refuses pictures that cannot be drawn before anything is driven.
pub(crate) fn check(args: &SimulateArgs) -> Result<(), WrongArgument> {
    for path in &args.picture {
        let ending = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        if !["svg", "png", "gif"].contains(&ending.as_str()) {
            let path = path.display();
            return Err(WrongArgument(format!("--picture {path}: the name must end in .svg, .png or .gif")));
        }
    }
    Ok(())
}

/// Draws what is asked for; a moving picture shows the moments.
pub(crate) fn write(
    args: &SimulateArgs,
    stage: &Stage,
    still: &SimulationPicture<'_>,
    moments: &[Moment<'_>],
    terminal: &Terminal,
) -> anyhow::Result<()> {
    for path in &args.picture {
        let _working = terminal.working(format!("drawing {}", path.display()));
        let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
        let bytes = match ending.to_str() {
            Some("svg") => simulation_svg(still).into_bytes(),
            Some("png") => simulation_png(still)?,
            _ => {
                let robot = &stage.run.robot;
                let still = SimulationPicture { way: &[], believed: &[], ..*still };
                let (radius_m, sensors) = (robot.radius_m, &robot.sensors);
                simulation_gif(&MovingPicture { still, moments, radius_m, sensors })?
            }
        };
        files::write_atomically(path, &bytes)?;
    }
    Ok(())
}

/// What all pictures of a stage show.
pub(crate) fn base<'a>(stage: &'a Stage, title: &'a str) -> SimulationPicture<'a> {
    SimulationPicture {
        world: stage.world.map(),
        title,
        from: stage.run.from,
        to: stage.run.to,
        planned: &stage.run.cells,
        way: &[],
        believed: &[],
        ends_m: &[],
        region: None,
        contacts_m: &[],
        found: &[],
    }
}
