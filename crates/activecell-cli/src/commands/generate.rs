//! `activecell generate`: the navigator as firmware or hardware.

use super::earlier::{self, Earlier};
use super::{counted, load};
use crate::args::{GenerateArgs, WrongArgument};
use crate::terminal::Terminal;
use activecell_codegen::{Bundle, Language, Order, Size, generate, long_way};
use activecell_formats::files;
use serde::Serialize;

#[derive(Serialize)]
struct Report<'a> {
    language: &'a str,
    folder: String,
    files: Vec<&'a str>,
    sizes: Vec<SizeReport>,
    notes: Vec<&'a str>,
}

#[derive(Serialize)]
struct SizeReport {
    part: &'static str,
    what: &'static str,
    value: u64,
    estimated: bool,
}

pub(crate) fn run(args: &GenerateArgs, terminal: &Terminal) -> anyhow::Result<()> {
    let output = &args.output;
    anyhow::ensure!(!output.exists() || output.is_dir(), "{}: is a file; name a folder", output.display());
    let mut bundle = made(args, terminal)?;
    let earlier = Earlier::read(output);
    let list = earlier::list(&bundle.files);
    let texts = bundle.files.iter().map(|file| (file.path.as_str(), file.text.as_bytes()));
    files::write_folder(output, &texts.chain([(earlier::LIST, list.as_bytes())]).collect::<Vec<_>>())?;
    let notes = earlier.remove_all_but(&bundle.files);
    bundle.notes.extend(notes);
    for note in &bundle.notes {
        terminal.note(&format!("note: {note}"));
    }
    if args.json {
        let report = report(args, &bundle);
        return Terminal::result(&(serde_json::to_string(&report)? + "\n"));
    }
    Terminal::result(&text(args, &bundle))
}

fn made(args: &GenerateArgs, terminal: &Terminal) -> anyhow::Result<Bundle> {
    let language = args.language.into();
    if args.fixed_map && language == Language::C {
        return Err(WrongArgument("--fixed-map is for verilog and vhdl; C has no fabric".into()).into());
    }
    let Some(map_args) = &args.map else { return Ok(generate(language, None)?) };
    let robot = args.robot.as_deref().map(load::robot).transpose()?;
    let map = load::map(map_args, robot.as_ref(), terminal)?.map;
    let _working = terminal.working("generating");
    let (from, to) = match (&args.from, &args.to) {
        (Some(from), Some(to)) => (from.on(&map)?, to.on(&map)?),
        _ => long_way(&map)?,
    };
    let robot = robot.unwrap_or_default();
    let command = command();
    let order = Order { map: &map, from, to, robot: &robot, fixed_map: args.fixed_map, command: &command };
    Ok(generate(language, Some(&order))?)
}

fn report<'a>(args: &GenerateArgs, bundle: &'a Bundle) -> Report<'a> {
    let size = |size: &Size| SizeReport {
        part: size.part,
        what: size.what,
        value: size.value,
        estimated: size.estimated,
    };
    Report {
        language: Language::from(args.language).name(),
        folder: args.output.display().to_string(),
        files: bundle.files.iter().map(|file| file.path.as_str()).collect(),
        sizes: bundle.sizes.iter().map(size).collect(),
        notes: bundle.notes.iter().map(String::as_str).collect(),
    }
}

/// The result for people.
fn text(args: &GenerateArgs, bundle: &Bundle) -> String {
    let files = counted(bundle.files.len() as u64, "file");
    let folder = args.output.display();
    let mut text = format!("{}: {files} in {folder}\n", Language::from(args.language).name());
    let mut before = "";
    for size in &bundle.sizes {
        let part = if size.part == before { "" } else { size.part };
        let about = if size.estimated { "about " } else { "" };
        text += &format!("  {part:20}{about}{} {}\n", size.value, size.what);
        before = size.part;
    }
    if bundle.files.iter().any(|file| file.path == "Makefile") {
        let word = folder_word(&folder.to_string());
        text += &format!("next: make -C {word} sim; {folder}/README.md tells the rest\n");
    }
    text
}

/// The command as it was typed, into any folder, without what changes no file.
fn command() -> String {
    let is_silent = |word: &str| matches!(word, "-q" | "--quiet" | "-v" | "--verbose" | "--json");
    let mut text = "activecell".to_owned();
    let mut words = std::env::args().skip(1);
    while let Some(given) = words.next() {
        if given == "-o" || given == "--output" {
            words.next();
        } else if !given.starts_with("-o") && !given.starts_with("--output=") && !is_silent(&given) {
            text += " ";
            text += &word(&given);
        }
    }
    text + " -o DIR"
}

/// A folder as one word of a shell, which is no option.
fn folder_word(text: &str) -> String {
    if text.starts_with('-') { word(&format!("./{text}")) } else { word(text) }
}

/// As one word of a shell.
fn word(text: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "/._-+=:,@%".contains(c);
    if text.chars().all(is_plain) { text.into() } else { format!("'{}'", text.replace('\'', "'\\''")) }
}
