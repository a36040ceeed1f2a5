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
    let mut paths: Vec<(PathBuf, &PathBuf)> = paths.into_iter().map(|path| (place(path), path)).collect();
    paths.sort_unstable();
    match paths.windows(2).find(|pair| pair[0].0 == pair[1].0) {
        None => Ok(()),
        Some(twice) => {
            let path = twice[1].1.display();
            Err(WrongArgument(format!("{path} is to be written twice; give each its own name")))
        }
    }
}

/// Where a file is or will be, however its path is written.
fn place(path: &Path) -> PathBuf {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    path.canonicalize().ok().unwrap_or_else(|| match (folder.canonicalize(), path.file_name()) {
        (Ok(folder), Some(name)) => folder.join(name),
        _ => path.to_owned(),
    })
}
