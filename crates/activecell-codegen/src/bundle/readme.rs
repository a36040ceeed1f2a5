//! The README beside the sources.

use super::{Design, Language, Order, Parts, Size};
use crate::SourceFile;
use crate::template::fill;

/// The README: what is here, what it takes, what to do with it.
pub(super) fn readme(language: Language, order: Option<&Order<'_>>, parts: &Parts) -> SourceFile {
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
        ("FILES", table(&parts.files)),
        ("FACING", parts.facing.map_or_else(String::new, |name| format!(" and faces {name}"))),
        ("DESIGNS", parts.designs.iter().map(design).collect::<Vec<_>>().concat()),
        ("SIZES", parts.sizes.iter().map(size).collect::<Vec<_>>().concat()),
        ("TASK", order.map_or_else(String::new, |order| format!("{} to {}", order.from, order.to))),
        (
            "MAP",
            order.map_or_else(String::new, |order| {
                format!("{} x {} {}", order.map.width(), order.map.height(), cells(order))
            }),
        ),
    ];
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

fn design(design: &Design) -> String {
    let (name, top) = (design.name, &design.top);
    let ending = design.files.first().map_or("", |file| file.path.rsplit('.').next().unwrap_or(""));
    format!("| {name} | `{top}` in `rtl/{top}.{ending}` | `tb/{name}_tb.{ending}` |\n")
}

/// The files with what their first comments say; images of memories and traces in one line.
fn table(files: &[SourceFile]) -> String {
    let is_image = |file: &&SourceFile| file.path.ends_with("hex");
    let row = |file: &SourceFile| format!("| `{}` | {} |\n", file.path, about(file));
    let rows: String = files.iter().filter(|file| !is_image(file)).map(row).collect::<Vec<_>>().concat();
    match files.iter().filter(is_image).count() {
        0 => rows,
        images => format!(
            "{rows}| {images} files `*.hex` | what the memories hold, and what the test benches expect |\n"
        ),
    }
}

/// The first sentence of the first comment.
fn about(file: &SourceFile) -> String {
    let lines = file.text.lines().map(|line| line.trim_start_matches(['/', '*', '-', '#', ' ']));
    let comment: Vec<&str> =
        lines.skip_while(|line| line.is_empty()).take_while(|line| !line.is_empty()).take(4).collect();
    let text = comment.join(" ");
    let end = text.find(". ").unwrap_or(text.len());
    text[..end].trim_end_matches('.').replace('|', "\\|")
}
