//! The README and the Makefile beside the sources.

use super::{Language, Order, Size};
use crate::SourceFile;
use crate::template::fill;

/// The parts that stand alone: the module on top, and its test bench if it has one.
fn designs(files: &[SourceFile]) -> Vec<String> {
    let benches = files.iter().filter_map(|file| {
        let name = file.path.strip_prefix("tb/")?;
        name.strip_suffix("_tb.v").or_else(|| name.strip_suffix("_tb.vhd"))
    });
    benches.map(str::to_owned).collect()
}

/// The Makefile: `make sim`, `make synth`; for C `make sim`, `make size`.
pub(super) fn makefile(language: Language, order: &Order<'_>, files: &[SourceFile]) -> SourceFile {
    let lattice = order.map.lattice().name();
    let template = match language {
        Language::C => include_str!("templates/c.mk"),
        Language::Verilog => include_str!("templates/verilog.mk"),
        Language::Vhdl => include_str!("templates/vhdl.mk"),
    };
    SourceFile::new(
        "Makefile",
        fill(template, &[("DESIGNS", &designs(files).join(" ")), ("LATTICE", lattice)]),
    )
}

/// The README: what is here, what it takes, what to do with it.
pub(super) fn readme(
    language: Language,
    order: Option<&Order<'_>>,
    files: &[SourceFile],
    sizes: &[Size],
) -> SourceFile {
    let template = match (language, order) {
        (Language::C, Some(_)) => include_str!("templates/c.md"),
        (Language::Verilog | Language::Vhdl, Some(_)) => include_str!("templates/hardware.md"),
        (_, None) => include_str!("templates/rules.md"),
    };
    let values = [
        (
            "LANGUAGE",
            match language {
                Language::C => "C99",
                Language::Verilog => "Verilog-2005",
                Language::Vhdl => "VHDL-93",
            }
            .to_owned(),
        ),
        ("FILES", table(files)),
        ("SIZES", sizes.iter().map(size).collect::<Vec<_>>().concat()),
        ("TASK", order.map_or_else(String::new, |order| format!("{} to {}", order.from, order.to))),
        (
            "MAP",
            order.map_or_else(String::new, |order| {
                format!("{} x {} {}", order.map.width(), order.map.height(), cells(order))
            }),
        ),
    ];
    let values = values.each_ref().map(|(name, value)| (*name, value.as_str()));
    SourceFile::new("README.md", fill(template, &values))
}

fn cells(order: &Order<'_>) -> &'static str {
    match order.map.lattice() {
        activecell::Lattice::Square => "squares",
        activecell::Lattice::Hex => "hexagons",
    }
}

fn size(size: &Size) -> String {
    let about = if size.estimated { "about " } else { "" };
    format!("| {} | {about}{} | {} |\n", size.part, size.value, size.what)
}

/// The files with what their first comments say.
fn table(files: &[SourceFile]) -> String {
    let row = |file: &SourceFile| format!("| `{}` | {} |\n", file.path, about(file));
    files.iter().filter(|file| !file.path.ends_with("hex")).map(row).collect::<Vec<_>>().concat()
}

/// The first sentence of the first comment.
fn about(file: &SourceFile) -> String {
    let line = file
        .text
        .lines()
        .map(|line| line.trim_start_matches(['/', '*', '-', '#', ' ']))
        .find(|line| !line.is_empty());
    let line = line.unwrap_or_default();
    line.split_once(". ").map_or(line, |(sentence, _)| sentence).trim_end_matches('.').to_owned()
}
