//! The files that a command is asked to write.

use crate::args::WrongArgument;
use std::path::{Path, PathBuf};

/// What a picture is written as.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Svg,
    Png,
    Gif,
}

/// The pictures that are asked for, each with its kind.
pub(super) fn pictures(paths: &[PathBuf]) -> Result<Vec<(&Path, Kind)>, WrongArgument> {
    let kind = |path: &Path| match path.extension().unwrap_or_default().to_ascii_lowercase().to_str() {
        Some("svg") => Ok(Kind::Svg),
        Some("png") => Ok(Kind::Png),
        Some("gif") => Ok(Kind::Gif),
        _ => {
            let path = path.display();
            Err(WrongArgument(format!("--picture {path}: the name must end in .svg, .png or .gif")))
        }
    };
    paths.iter().map(|path| Ok((path.as_path(), kind(path)?))).collect()
}

/// Refuses a file that is to be written twice.
pub(super) fn once_each<'a>(paths: impl IntoIterator<Item = &'a PathBuf>) -> Result<(), WrongArgument> {
    let mut paths: Vec<&PathBuf> = paths.into_iter().collect();
    paths.sort_unstable();
    match paths.windows(2).find(|pair| pair[0] == pair[1]) {
        None => Ok(()),
        Some(twice) => {
            let path = twice[0].display();
            Err(WrongArgument(format!("{path} is to be written twice; give each its own name")))
        }
    }
}
