//! What the lattice decides in the C text: offsets, sectors, orders, all read from the core.

use super::circuit::{function, number};
use crate::circuits;
use crate::logic::{Circuit, Expr};
use activecell::rule::Sector;
use activecell::{Cell, Dir, Lattice};

/// Each input of [`circuits::sector`] as a comparison in C.
const COMPARISONS: [(&str, [&str; 2]); 8] = [
    ("is_left", ["target.x < from.x", "there < here"]),
    ("is_right", ["target.x > from.x", "there > here"]),
    ("is_above", ["target.y < from.y"; 2]),
    ("is_below", ["target.y > from.y"; 2]),
    ("is_wide", ["", "across > down"]),
    ("is_level", ["", "across == down"]),
    ("is_flat", ["", "across > (3U * down)"]),
    ("is_even", ["", "across == (3U * down)"]),
];

/// The rows of the window, from two above the cell on.
const ROWS: [&str; 5] = ["far_above", "above", "level", "below", "far_below"];

/// How many planes of bits hold a direction.
pub(super) const fn planes(lattice: Lattice) -> u32 {
    match lattice {
        Lattice::Square => 2,
        Lattice::Hex => 3,
    }
}

/// Distances and sectors.
pub(super) fn geometry(lattice: Lattice) -> String {
    let template = match lattice {
        Lattice::Square => include_str!("templates/square.c"),
        Lattice::Hex => include_str!("templates/hex.c"),
    };
    let inputs = circuits::sector(lattice).inputs;
    let comparisons = inputs.iter().map(|input| {
        let (_, text) = COMPARISONS.iter().find(|(name, _)| *name == input.name).expect("a known comparison");
        format!("\n        ({}) ? 1U : 0U", text[lattice as usize])
    });
    template.replace("@COMPARISONS@", &comparisons.collect::<Vec<_>>().join(","))
}

/// Columns to the right of a cell, in an even and an odd row, and rows down.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Offset {
    columns: [i32; 2],
    rows: i32,
}

impl Offset {
    fn of(place: impl Fn(Cell) -> Cell) -> Self {
        let [even, odd] = [Cell::new(10, 10), Cell::new(10, 11)];
        let columns = [place(even).x - even.x, place(odd).x - odd.x];
        Self { columns, rows: place(even).y - even.y }
    }

    fn of_dir(lattice: Lattice, dir: Dir) -> Self {
        Self::of(|cell| lattice.neighbour(cell, dir))
    }
}

/// The tables of [`Lattice::neighbour`]: columns to the right and rows down, each and one more.
pub(super) fn neighbours(lattice: Lattice) -> [String; 2] {
    let offsets: Vec<Offset> = lattice.dirs().map(|dir| Offset::of_dir(lattice, dir)).collect();
    let row = |parity: usize| list(offsets.iter().map(|offset| offset.columns[parity] + 1));
    let right = match lattice {
        Lattice::Square => format!("{{ {} }}", row(0)),
        Lattice::Hex => format!("{{ {}, {} }}", row(0), row(1)),
    };
    [right, list(offsets.iter().map(|offset| offset.rows + 1))]
}

pub(super) fn list(numbers: impl Iterator<Item = i32>) -> String {
    format!("{{ {} }}", numbers.map(|number| format!("{number}U")).collect::<Vec<_>>().join(", "))
}

/// Where the five rows of the window are read. In odd rows of hexagons the rows beside lie a column farther right.
pub(super) fn slices(lattice: Lattice) -> String {
    let rows = ROWS.iter().enumerate().map(|(place, name)| {
        let row = match place {
            0 => "row".into(),
            1 => "&row[words]".into(),
            _ => format!("&row[{place}U * words]"),
        };
        let bit = if lattice == Lattice::Hex && place % 2 == 1 { "cell.x + (cell.y & 1U)" } else { "cell.x" };
        format!("    const uint32_t {name} = slice({row}, {bit});\n")
    });
    rows.collect()
}

/// The lanes of the window, gathered from those rows: the neighbours, what lies ahead of them, what between them.
pub(super) fn window(lattice: Lattice) -> String {
    let mut terms: Vec<(usize, i32, u32)> = Vec::new();
    for group in 0..3 {
        for dir in lattice.dirs() {
            let offset = match group {
                0 => Offset::of_dir(lattice, dir),
                1 => Offset::of(|cell| lattice.ring2(cell, 2 * dir.0)),
                _ => Offset::of(|cell| lattice.ring2(cell, 2 * dir.0 + 1)),
            };
            let aside = i32::from(lattice == Lattice::Hex) * (offset.rows & 1);
            assert_eq!(offset.columns[1] - offset.columns[0], aside, "rows of the window shift as a whole");
            let lane = 8 * group + i32::from(dir.0);
            let (row, shift) = ((offset.rows + 2) as usize, offset.columns[0] + 2 - lane);
            match terms.iter_mut().find(|term| (term.0, term.1) == (row, shift)) {
                Some(term) => term.2 |= 1 << lane,
                None => terms.push((row, shift, 1 << lane)),
            }
        }
    }
    let terms = terms.into_iter().map(|(row, shift, lanes)| {
        let row = ROWS[row];
        let shifted = match shift {
            0 => row.into(),
            1.. => format!("({row} >> {shift}U)"),
            _ => format!("({row} << {}U)", -shift),
        };
        format!("({shifted} & {})", number(lanes))
    });
    terms.collect::<Vec<_>>().join(" |\n        ")
}

/// From a signal with one lane set to the number of the lane.
pub(super) fn lane_number(lattice: Lattice) -> String {
    let lanes = u32::from(lattice.degree());
    let mut circuit = Circuit::new("lane_number", "The number of the one lane that is 1.");
    let signal = circuit.input("lanes", lanes, "one of them is 1");
    let bits = (0..planes(lattice)).map(|bit| {
        let value = (0..lanes).filter(|lane| lane >> bit & 1 == 1).map(|lane| 1 << lane).sum();
        let these = Expr::And(vec![Expr::Signal(signal), Expr::Const { width: lanes, value }]);
        (format!("bit{bit}"), Expr::Any(Box::new(these)))
    });
    let bits: Vec<(String, Expr)> = bits.collect();
    let bits = bits.into_iter().map(|(name, expr)| circuit.wire(&name, expr, "of the number")).collect();
    circuit.output("number", Expr::Join(bits), "from 0");
    function(&circuit)
}

/// The order in which each sector asks the neighbours.
pub(super) fn orders(lattice: Lattice) -> String {
    let orders = Sector::all(lattice)
        .map(|sector| list(sector.candidates(lattice, false).map(|candidate| candidate.dir.0.into())));
    orders.map(|order| format!("        {order},\n")).collect()
}

/// How the wave comes to a word of cells from each direction.
pub(super) fn wave(lattice: Lattice) -> String {
    let mut text = String::new();
    for dir in lattice.dirs() {
        let Offset { columns, rows } = Offset::of_dir(lattice, dir);
        let row = ROWS[(rows + 2) as usize];
        let from = |columns: i32| match columns {
            0 => format!("reached[{row}]"),
            1.. => format!("from_right(reached, {row})"),
            _ => format!("from_left(reached, {row})"),
        };
        let [even, odd] = columns.map(from);
        let from = if even == odd { even } else { format!("(is_odd ? {odd} : {even})") };
        text += &format!(
            "\n        taken = left & {from}; /* {} */\n        left ^= taken;\n",
            lattice.dir_name(dir)
        );
        for plane in (0..planes(lattice)).filter(|plane| dir.0 >> plane & 1 == 1) {
            let place = match plane {
                0 => "0U".into(),
                1 => "words".into(),
                _ => format!("{plane}U * words"),
            };
            text += &format!("        planes[{place}] |= taken;\n");
        }
    }
    text
}
