//! `activecell convert`: a map in another format.

use super::load;
use crate::args::ConvertArgs;
use crate::terminal::Terminal;
use activecell_formats::files::{self, MapFormat};
use activecell_picture::map_svg;

pub(crate) fn run(args: &ConvertArgs, terminal: &Terminal) -> anyhow::Result<()> {
    let is_picture = args.out.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("svg"));
    if !is_picture {
        MapFormat::of(&args.out)?;
    }
    let map = load::map(&args.map, None, terminal)?.map;
    if is_picture {
        let title = args.map.path.file_name().unwrap_or_default().to_string_lossy();
        files::write_atomically(&args.out, map_svg(&map, &title).as_bytes())?;
    } else {
        files::write_map(&args.out, &map)?;
    }
    terminal.note(&format!("wrote {} ({} x {} cells)", args.out.display(), map.width(), map.height()));
    Ok(())
}
