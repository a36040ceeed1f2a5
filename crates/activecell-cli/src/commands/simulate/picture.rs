//! The pictures of a simulation.

use super::stage::Stage;
use crate::args::SimulateArgs;
use crate::commands::outputs::{self, Kind};
use crate::terminal::Terminal;
use activecell_formats::files;
use activecell_picture::{
    Moment, MovingPicture, SimulationPicture, simulation_gif, simulation_png, simulation_svg,
};

/// Draws what is asked for; a moving picture shows the moments.
pub(crate) fn write(
    args: &SimulateArgs,
    stage: &Stage,
    still: &SimulationPicture<'_>,
    moments: &[Moment<'_>],
    terminal: &Terminal,
) -> anyhow::Result<()> {
    for (path, kind) in outputs::pictures(&args.picture)? {
        let _working = terminal.working(format!("drawing {}", path.display()));
        let bytes = match kind {
            Kind::Svg => simulation_svg(still).into_bytes(),
            Kind::Png => simulation_png(still)?,
            Kind::Gif => {
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
