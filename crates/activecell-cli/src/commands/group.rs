//! What a group has to keep besides: the sizes of its robots, their distance, and what strangers close.

use super::counted;
use crate::args::{GroupArgs, SizesArg, WrongArgument};
use activecell::{Bodies, KeepOuts, Map};
use activecell_formats::{files, sizes, strangers};
use anyhow::Context;

/// The options as they were given, with the files read.
pub(super) struct Group {
    sizes: Option<Vec<u32>>,
    distance: Option<u32>,
}

impl Group {
    pub(super) fn read(args: &GroupArgs) -> anyhow::Result<Self> {
        let sizes = match &args.sizes {
            None => None,
            Some(SizesArg::List(list)) => Some(
                sizes::read(list.as_bytes()).map_err(|error| WrongArgument(format!("--sizes: {error}")))?,
            ),
            Some(SizesArg::File(path)) => {
                let bytes = files::read_bytes(path, sizes::MAX_SIZES_BYTES)?;
                Some(sizes::read(&bytes).map_err(|error| error.in_file(path))?)
            }
        };
        Ok(Self { sizes, distance: args.distance })
    }

    /// The bodies of so many robots; what is not given is as stated.
    pub(super) fn bodies(&self, robots: usize, stated: &Bodies) -> anyhow::Result<Bodies> {
        let radii = match self.sizes.as_deref() {
            None => (0..robots).map(|robot| stated.radius(robot)).collect(),
            Some(&[radius]) => vec![radius; robots],
            Some(radii) if radii.len() == robots => radii.to_vec(),
            Some(radii) => {
                let (radii, robots) = (radii.len(), counted(robots as u64, "robot"));
                let message =
                    format!("--sizes: {radii} radii for {robots}; give one for each, or one for all");
                return Err(WrongArgument(message).into());
            }
        };
        Ok(Bodies::new(radii, self.distance.unwrap_or(stated.distance()))?)
    }
}

/// What the file of strangers closes to these bodies, if one is given.
pub(super) fn keep_outs(args: &GroupArgs, map: &Map, bodies: &Bodies) -> anyhow::Result<Option<KeepOuts>> {
    let Some(path) = &args.strangers else { return Ok(None) };
    let bytes = files::read_bytes(path, strangers::MAX_STRANGERS_BYTES)?;
    let strangers = strangers::read(&bytes).map_err(|error| error.in_file(path))?;
    let keep_outs = strangers.keep_outs(map, bodies.largest());
    Ok(Some(keep_outs.with_context(|| path.display().to_string())?))
}
