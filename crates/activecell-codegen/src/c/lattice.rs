//! What the lattice decides in the C text: offsets, sectors, orders, all read from the core.

use crate::circuits;
use crate::logic::{Circuit, Expr};
use crate::window::{Offset, lanes};
use activecell::Lattice;
use activecell::rule::Sector;

/// The rows of the window, from two above the cell on.
const ROWS: [&str; 5] = ["far_above", "above", "level", "below", "far_below"];

/// How many planes of bits hold a direction.
pub(super) const fn planes(lattice: Lattice) -> u32 {
    match lattice {
        Lattice::Square => 2,
        Lattice::Hex => 3,
    }
}

/// Distances and bearings.
pub(super) fn geometry(lattice: Lattice) -> String {
    let template = match lattice {
        Lattice::Square => include_str!("templates/square.c"),
        Lattice::Hex => include_str!("templates/hex.c"),
    };
    template.replace("@SECTOR_TABLE@", &sectors(lattice))
}

/// The sector for each slant on hexagons (see there), for level, below, above, and for straight, right, left: what the
/// circuit says for the comparisons that these mean.
fn sectors(lattice: Lattice) -> String {
    let circuit = circuits::sector(lattice);
    let slants: &[&[&str]] = match lattice {
        Lattice::Square => &[&[]],
        Lattice::Hex => &[&[], &["is_level"], &["is_wide"], &["is_wide", "is_even"], &["is_wide", "is_flat"]],
    };
    let mut text = String::new();
    for slant in slants {
        let rows = [None, Some("is_below"), Some("is_above")].map(|vertical| {
            let sectors = [None, Some("is_right"), Some("is_left")].map(|horizontal| {
                let holds =
                    |name: &str| slant.contains(&name) || [vertical, horizontal].contains(&Some(name));
                let inputs: Vec<u32> = circuit.inputs.iter().map(|input| holds(&input.name).into()).collect();
                circuit.evaluate(&inputs)[0] as i32
            });
            list(sectors.into_iter())
        });
        text += &match lattice {
            Lattice::Square => rows.map(|row| format!("        {row},\n")).concat(),
            Lattice::Hex => format!("        {{ {} }},\n", rows.join(", ")),
        };
    }
    text
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

/// The five rows of the window, each from the bit two to the left of the cell on. In odd rows of hexagons the rows beside
/// lie a column farther right.
pub(super) fn slices(lattice: Lattice) -> String {
    let place = |name: &str, bit: &str| {
        format!(
            "    const uint32_t *const {name} = &map->rows[((uint32_t)cell.y * words) + ({bit} >> 5U)];\n    \
             const uint32_t {name}_right = {bit} & 31U;\n    \
             const uint32_t {name}_left = 31U - {name}_right;\n"
        )
    };
    let mut text = place("here", "(uint32_t)cell.x");
    if lattice == Lattice::Hex {
        text += "    /* Beside an odd row the rows lie half a cell to the left. */\n";
        text += "    const uint32_t aside = (uint32_t)cell.x + ((uint32_t)cell.y & 1U);\n";
        text += &place("beside", "aside");
    }
    for (row, name) in ROWS.iter().enumerate() {
        let base = if lattice == Lattice::Hex && row % 2 == 1 { "beside" } else { "here" };
        let [word, next] = match row {
            0 => ["0U".to_owned(), "1U".to_owned()],
            1 => ["words".to_owned(), "words + 1U".to_owned()],
            _ => [format!("{row}U * words"), format!("({row}U * words) + 1U")],
        };
        text += &format!(
            "    const uint32_t {name} =\n        \
             ({base}[{word}] >> {base}_right) | (({base}[{next}] << 1U) << {base}_left);\n"
        );
    }
    text
}

/// The lanes of the window, gathered from those rows: the neighbours, what lies ahead of them, what between them.
pub(super) fn window(lattice: Lattice) -> String {
    lanes(lattice).map(|(name, offsets)| gathered(lattice, name, &offsets)).join("\n")
}

/// A group of them, the last lane first.
fn gathered(lattice: Lattice, name: &str, offsets: &[Offset]) -> String {
    let mut text = String::new();
    for offset in offsets.iter().rev() {
        let aside = i32::from(lattice == Lattice::Hex) * (offset.rows & 1);
        assert_eq!(offset.columns[1] - offset.columns[0], aside, "rows of the window shift as a whole");
        let (row, bit) = (ROWS[(offset.rows + 2) as usize], offset.columns[0] + 2);
        text += &if text.is_empty() {
            format!("    uint32_t {name} = at({row}, {bit}U);\n")
        } else {
            format!("    {name} = with({name}, {row}, {bit}U);\n")
        };
    }
    text
}

/// From a signal with one lane set to the number of the lane.
pub(crate) fn lane_number(lattice: Lattice) -> Circuit {
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
    circuit
}

/// The order in which each sector asks the neighbours.
pub(super) fn orders(lattice: Lattice) -> String {
    let mut text = String::new();
    for sector in Sector::all(lattice) {
        let order = sector.candidates(lattice, false).map(|candidate| candidate.dir.0.into());
        text += &format!("        {},\n", list(order));
    }
    text
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
