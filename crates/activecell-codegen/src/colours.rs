//! Colours of cells, such that what stands side by side differs.
//!
//! Where a robot is, few wires tell: if a cell and all its neighbours have different colours, two colours that follow each
//! other are a move. Five colours do on squares, seven on hexagons: the perfect colourings of their lattices.

use activecell::{Cell, Dir, Lattice};

/// A colour for every cell: columns count 1, rows `slope`, modulo `count`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Colours {
    lattice: Lattice,
    slope: u32,
    pub(crate) count: u32,
}

impl Colours {
    /// A cell and its neighbours all differ.
    pub(crate) const fn of_moves(lattice: Lattice) -> Self {
        let (slope, count) = match lattice {
            Lattice::Square => (2, 5),
            Lattice::Hex => (3, 7),
        };
        Self { lattice, slope, count }
    }

    /// Neighbours differ from the cell, in the fewest colours: two cells side by side are never both of colour 0.
    pub(crate) const fn of_neighbours(lattice: Lattice) -> Self {
        let (slope, count) = match lattice {
            Lattice::Square => (1, 2),
            Lattice::Hex => (2, 3),
        };
        Self { lattice, slope, count }
    }

    /// The colour of a cell, whose coordinates are not negative.
    pub(crate) const fn of(self, cell: Cell) -> u32 {
        let (x, y) = (cell.x as u32, cell.y as u32);
        // Rows of hexagons lean half a cell a row; straight axes are columns less half the rows.
        let lean = match self.lattice {
            Lattice::Square => 0,
            Lattice::Hex => y / 2,
        };
        (x + self.slope * y - lean) % self.count
    }

    /// How much a move adds to the colour, modulo their count.
    pub(crate) fn step(self, dir: Dir) -> u32 {
        let cell = Cell::new(2, 2);
        (self.of(self.lattice.neighbour(cell, dir)) + self.count - self.of(cell)) % self.count
    }

    /// The colour of a column and row, as Verilog (`%`) and VHDL (`mod`) write it.
    pub(crate) fn formula(self, column: &str, row: &str, remainder: &str) -> String {
        let rows = if self.slope == 1 { row.to_owned() } else { format!("{} * {row}", self.slope) };
        let lean = match self.lattice {
            Lattice::Square => String::new(),
            Lattice::Hex => format!(" - {row} / 2"),
        };
        format!("({column} + {rows}{lean}) {remainder} {}", self.count)
    }
}

/// The name of the signal for a move.
pub(crate) fn goes(lattice: Lattice, dir: Dir) -> String {
    format!("goes_{}", lattice.dir_name(dir).to_lowercase())
}

/// Which moves lead to the next column or row, from the core's offsets: `right`, `left`, `down`, `up`, each with a formula
/// in the operators of a language for "or" and "and", and its words for even and for odd rows.
pub(crate) fn leads(lattice: Lattice, operators: [&str; 2], rows: [&str; 2]) -> [(&'static str, String); 4] {
    let [or, and] = operators.map(|operator| format!(" {operator} "));
    [("right", (1, 0)), ("left", (-1, 0)), ("down", (0, 1)), ("up", (0, -1))].map(|(name, (dx, dy))| {
        let is_so = |row: i32, dir: Dir| {
            let to = lattice.neighbour(Cell::new(0, row), dir);
            dx * to.x + dy * (to.y - row) == 1
        };
        let any = |is: &dyn Fn(Dir) -> bool| {
            let names: Vec<String> =
                lattice.dirs().filter(|&dir| is(dir)).map(|dir| goes(lattice, dir)).collect();
            names.join(&or)
        };
        let mut terms = vec![any(&|dir| is_so(0, dir) && is_so(1, dir))];
        for row in [0, 1] {
            let some = any(&|dir| is_so(row, dir) && !is_so(1 - row, dir));
            if !some.is_empty() {
                terms.push(format!("({}{and}({some}))", rows[row as usize]));
            }
        }
        (name, terms.join(&or))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn what_stands_side_by_side_differs() {
        for lattice in Lattice::ALL {
            let [moves, sides] = [Colours::of_moves(lattice), Colours::of_neighbours(lattice)];
            assert_eq!(moves.count, u32::from(lattice.degree()) + 1, "perfect: no colour is spare");
            for cell in (1..15).flat_map(|y| (1..15).map(move |x| Cell::new(x, y))) {
                let around: Vec<Cell> = lattice.dirs().map(|dir| lattice.neighbour(cell, dir)).collect();
                let different: BTreeSet<u32> =
                    around.iter().chain([&cell]).map(|&cell| moves.of(cell)).collect();
                assert_eq!(different.len() as u32, moves.count, "{lattice} {cell}");
                assert!(around.iter().all(|&other| sides.of(other) != sides.of(cell)), "{lattice} {cell}");
                for dir in lattice.dirs() {
                    let next = (moves.of(cell) + moves.step(dir)) % moves.count;
                    assert_eq!(moves.of(lattice.neighbour(cell, dir)), next, "{lattice} {cell}");
                }
            }
        }
    }
}
