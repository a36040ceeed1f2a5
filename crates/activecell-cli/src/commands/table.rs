//! `activecell table rule`: the published rule as tables, printed from the data that the product runs.

use crate::args::TableFormat;
use activecell::Lattice;
use activecell::rule::{Candidate, Sector, Wolfram};
use serde_json::json;

/// The elementary rules that the published rule is made of, and where each applies.
const RULES: [(Wolfram, &str); 3] = [
    (Wolfram::RIGHT, "the sector's common cell is on the right"),
    (Wolfram::LEFT, "the sector's common cell is on the left (printed as 172)"),
    (Wolfram::ALL, "straight sectors, remaining groups, hexagons"),
];

/// The inputs (X4, X1, X2) in the order of the paper's Table 1.
fn triples() -> impl Iterator<Item = [bool; 3]> {
    (0..8u8).map(|bits| [bits & 4 != 0, bits & 2 != 0, bits & 1 != 0])
}

pub(crate) fn rule(lattice: Lattice, format: TableFormat) -> anyhow::Result<String> {
    Ok(match format {
        TableFormat::Markdown => markdown(lattice),
        TableFormat::Csv => csv(lattice),
        TableFormat::Json => {
            let rules = RULES.map(|(rule, when)| {
                let next: Vec<u8> = triples().map(|triple| u8::from(rule.next(triple))).collect();
                json!({"rule": rule.0, "next": next, "applies": when})
            });
            let sectors = Sector::all(lattice).map(|sector| {
                let order = sector.candidates(lattice, false);
                let order = order.map(|c| json!({"direction": lattice.dir_name(c.dir), "closed_by": c.closed_by.0}));
                json!({"sector": sector.number(), "name": name(lattice, sector), "order": order.collect::<Vec<_>>()})
            });
            let object =
                json!({"lattice": lattice.name(), "rules": rules, "sectors": sectors.collect::<Vec<_>>()});
            serde_json::to_string(&object)? + "\n"
        }
    })
}

/// The sector's name: the direction of the target, on hexagons the nearest two.
fn name(lattice: Lattice, sector: Sector) -> String {
    let order: Vec<Candidate> = sector.candidates(lattice, false).take(2).collect();
    let names = [lattice.dir_name(order[0].dir), lattice.dir_name(order[1].dir)];
    match lattice {
        Lattice::Square if sector.number().is_multiple_of(2) => names[0].to_owned(),
        Lattice::Square => names.concat(),
        Lattice::Hex => names.join(", then "),
    }
}

fn markdown(lattice: Lattice) -> String {
    let mut text = String::from("A free candidate is closed where its rule gives 1 for (X4, X1, X2):\n");
    text += "the cells left of it, straight ahead, and right of it, 1 for an obstacle.\n\n| X4 X1 X2 |";
    for [x4, x1, x2] in triples() {
        text += &format!(" {} {} {} |", u8::from(x4), u8::from(x1), u8::from(x2));
    }
    text += " applies to |\n|---|";
    text += &"---|".repeat(9);
    for (rule, when) in RULES {
        text += &format!("\n| rule {rule} |");
        for triple in triples() {
            text += &format!(" {} |", u8::from(rule.next(triple)));
        }
        text += &format!(" {when} |");
    }
    text += &format!("\n\nThe first open candidate becomes active ({lattice}):\n\n| sector | target |");
    let degree = usize::from(lattice.degree());
    for rank in 1..=degree {
        text += &format!(" {rank} |");
    }
    text += &format!("\n|---|---|{}", "---|".repeat(degree));
    for sector in Sector::all(lattice) {
        text += &format!("\n| {} | {} |", sector.number(), name(lattice, sector));
        for candidate in sector.candidates(lattice, false) {
            text += &format!(" {} by {} |", lattice.dir_name(candidate.dir), candidate.closed_by);
        }
    }
    text += "\n\nThe target itself is never closed. If no candidate is open, the first free neighbour clockwise\n";
    text += "from candidate 1; if none is free, the robot is enclosed.\n";
    text
}

fn csv(lattice: Lattice) -> String {
    let mut text = String::from("sector,target,rank,direction,closed_by\n");
    for sector in Sector::all(lattice) {
        for (rank, candidate) in sector.candidates(lattice, false).enumerate() {
            let dir = lattice.dir_name(candidate.dir);
            let target = name(lattice, sector).replace(", ", " ");
            text += &format!("{},{target},{},{dir},{}\n", sector.number(), rank + 1, candidate.closed_by);
        }
    }
    text
}
