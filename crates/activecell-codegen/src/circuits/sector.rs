//! The sector of the target as a circuit: from the signs of the differences to the sector's number.

use super::decision::sector_bits;
use super::sum;
use crate::logic::{Circuit, Expr, sum_of_products};
use activecell::rule::Sector;
use activecell::{Cell, Lattice};

/// Where the target lies as seen from a cell: what comparisons say, which is all that the sector depends on.
///
/// Across and down are the differences (target less cell) between the cells' centres: across in half cells, down in rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bearing {
    /// Half cells to the right; twice the columns on squares.
    pub across: i64,
    /// Rows down.
    pub down: i64,
}

impl Bearing {
    /// From one cell to another.
    pub const fn between(lattice: Lattice, from: Cell, to: Cell) -> Self {
        let (a, b) = (lattice.centre(from), lattice.centre(to));
        Self { across: b.0 - a.0, down: to.y as i64 - from.y as i64 }
    }

    /// The inputs of [`sector`], in its order: left, right, up, down; on hexagons also whether it is farther across than
    /// down, as far, and the same with three times down.
    pub fn inputs(self, lattice: Lattice) -> Vec<u32> {
        let (across, down) = (self.across.abs(), self.down.abs());
        let signs = [self.across < 0, self.across > 0, self.down < 0, self.down > 0];
        let slants = [across > down, across == down, across > 3 * down, across == 3 * down];
        let inputs = match lattice {
            Lattice::Square => &signs[..],
            Lattice::Hex => &[signs, slants].concat(),
        };
        inputs.iter().map(|&input| input.into()).collect()
    }
}

const NAMES: [(&str, &str); 8] = [
    ("is_left", "the target lies to the left"),
    ("is_right", "the target lies to the right"),
    ("is_above", "the target lies above"),
    ("is_below", "the target lies below"),
    ("is_wide", "farther across, in half cells, than down, in rows"),
    ("is_level", "as far across, in half cells, as down, in rows"),
    ("is_flat", "farther across, in half cells, than three times the rows down"),
    ("is_even", "as far across, in half cells, as three times the rows down"),
];

/// The sector of the target, as [`Sector::towards`] says it, from comparisons alone.
///
/// Its truth table is filled from the core at all bearings of a small floor, which has every answer that the comparisons
/// can give; answers that cannot be do not matter.
///
/// # Panics
/// If the comparisons did not tell two sectors of the core apart.
pub fn sector(lattice: Lattice) -> Circuit {
    let inputs = if lattice == Lattice::Square { 4 } else { 8 };
    let mut table = vec![None; 1 << inputs];
    for (bearing, sector) in bearings(lattice, 9) {
        let place = bearing.inputs(lattice).iter().rev().fold(0, |place, bit| place << 1 | bit);
        let known = table[place as usize].replace(sector);
        assert!(known.is_none_or(|known| known == sector), "the comparisons do not tell these sectors apart");
    }
    let mut circuit = Circuit::new(
        &format!("sector_{lattice}"),
        "The number of the sector in which the target lies. Without meaning at the target itself.",
    );
    let bits: Vec<Expr> =
        NAMES[..inputs].iter().map(|(name, about)| Expr::Signal(circuit.input(name, 1, about))).collect();
    let mut wires = Vec::new();
    for bit in 0..sector_bits(lattice) {
        let cubes = sum_of_products(
            inputs as u32,
            |place| table[place as usize].is_some_and(|sector| sector >> bit & 1 == 1),
            |place| table[place as usize].is_none(),
        );
        wires.push(circuit.wire(&format!("bit{bit}"), sum(&cubes, &bits), "a bit of the number"));
    }
    circuit.output("sector", Expr::Join(wires), "where the target lies");
    circuit
}

/// All bearings up to some columns and rows away, from even and odd rows, with their sectors.
fn bearings(lattice: Lattice, far: i32) -> impl Iterator<Item = (Bearing, u8)> {
    let from = (0..2).map(move |row| Cell::new(far, far + row));
    let to = (0..2 * far + 2).flat_map(move |y| (0..2 * far + 2).map(move |x| Cell::new(x, y)));
    from.flat_map(move |from| {
        to.clone().filter_map(move |to| {
            let sector = Sector::towards(lattice, from, to)?;
            Some((Bearing::between(lattice, from, to), sector.number()))
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn far_bearings_have_the_sectors_of_the_core() {
        for lattice in Lattice::ALL {
            let circuit = sector(lattice);
            circuit.check().unwrap();
            for (bearing, expected) in bearings(lattice, 150) {
                let sector = circuit.evaluate(&bearing.inputs(lattice));
                assert_eq!(sector, [u32::from(expected)], "{lattice} {bearing:?}");
            }
        }
    }
}
