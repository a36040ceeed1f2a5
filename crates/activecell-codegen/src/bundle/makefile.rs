//! The Makefile beside the sources.

use super::{Design, Language, size};
use crate::SourceFile;
use crate::template::fill;

/// `make sim`, and `make synth` or `make size`.
pub(super) fn makefile(language: Language, designs: &[Design]) -> SourceFile {
    let template = match language {
        Language::C => include_str!("templates/c.mk"),
        Language::Verilog => include_str!("templates/verilog.mk"),
        Language::Vhdl => include_str!("templates/vhdl.mk"),
    };
    let values = [
        ("DESIGNS", &*lists(designs)),
        ("TARGETS", include_str!("templates/targets.mk")),
        ("PLACE", include_str!("templates/place.mk")),
    ];
    SourceFile::new("Makefile", fill(template, &values))
}

/// The designs, those that fit, and the module on top and the sources of each.
fn lists(designs: &[Design]) -> String {
    let names = |fit: bool| {
        let some = designs.iter().filter(|design| !fit || size::fits_hx8k(&design.sizes));
        some.map(|design| design.name).collect::<Vec<_>>().join(" ")
    };
    let mut text = format!("DESIGNS  := {}\nFITTING  := {}\n", names(false), names(true));
    for Design { name, top, files, .. } in designs {
        text += &format!("\n{name}_TOP := {top}\n{name}_RTL :=");
        for file in files.iter().filter(|file| file.path.starts_with("rtl/") && !file.path.ends_with("hex")) {
            text += &format!(" \\\n    {}", file.path);
        }
        text.push('\n');
    }
    text
}
