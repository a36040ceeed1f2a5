//! Where the cells lie that a robot looks at, from the core: columns and rows away, and places in the window of 5 × 5
//! cells, for the printers of all languages.

use activecell::{Cell, Dir, Lattice};

/// Columns to the right of a cell, in an even and an odd row, and rows down.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Offset {
    pub(crate) columns: [i32; 2],
    pub(crate) rows: i32,
}

impl Offset {
    fn of(place: impl Fn(Cell) -> Cell) -> Self {
        let [even, odd] = [Cell::new(10, 10), Cell::new(10, 11)];
        let columns = [even, odd].map(|cell| place(cell).x - cell.x);
        Self { columns, rows: place(even).y - even.y }
    }

    /// To a neighbour.
    pub(crate) fn of_dir(lattice: Lattice, dir: Dir) -> Self {
        Self::of(|cell| lattice.neighbour(cell, dir))
    }

    /// The bits of the window, for a cell in an even and in an odd row: those of its rows in turn, the cell in the middle.
    fn bits(self) -> [i32; 2] {
        self.columns.map(|column| 5 * (self.rows + 2) + column + 2)
    }
}

/// The inputs of a decision that are lanes, by the names of [`decision`](crate::circuits::decision): where each lane's
/// cell lies.
pub(crate) fn lanes(lattice: Lattice) -> [(&'static str, Vec<Offset>); 3] {
    let lanes = |place: &dyn Fn(Cell, Dir) -> Cell| {
        lattice.dirs().map(|dir| Offset::of(|cell| place(cell, dir))).collect()
    };
    [
        ("ring1", lanes(&|cell, dir| lattice.neighbour(cell, dir))),
        ("ahead", lanes(&|cell, dir| lattice.ring2(cell, 2 * dir.0))),
        ("between", lanes(&|cell, dir| lattice.ring2(cell, 2 * dir.0 + 1))),
    ]
}

/// A signal made of bits of another one: of these if the robot's cell is in an even row, of those if in an odd one.
pub(crate) struct Gathered {
    pub(crate) name: &'static str,
    rows: [Vec<i32>; 2],
}

impl Gathered {
    /// The text of these bits, and where they differ the choice between that for even and that for odd rows.
    pub(crate) fn by_row(
        &self,
        text: impl Fn(&[i32]) -> String,
        choice: impl Fn(&str, &str) -> String,
    ) -> String {
        let [even, odd] = self.rows.each_ref().map(|row| text(row));
        if even == odd { even } else { choice(&even, &odd) }
    }
}

/// The [`lanes`] from the window, the last first.
pub(crate) fn neighbourhood(lattice: Lattice) -> [Gathered; 3] {
    lanes(lattice).map(|(name, offsets)| {
        let rows = [0, 1].map(|row| offsets.iter().rev().map(|offset| offset.bits()[row]).collect());
        Gathered { name, rows }
    })
}

/// Which directions lead a column or a row on.
pub(crate) fn moves(lattice: Lattice) -> [Gathered; 4] {
    let ways = [("to_right", [1, 0]), ("to_left", [-1, 0]), ("to_below", [0, 1]), ("to_above", [0, -1])];
    ways.map(|(name, [right, down])| {
        let leads = |dir: Dir, row: usize| {
            let Offset { columns, rows } = Offset::of_dir(lattice, dir);
            columns[row] * right + rows * down > 0
        };
        let dirs = |row| lattice.dirs().filter(|&dir| leads(dir, row)).map(|dir| dir.0.into()).collect();
        Gathered { name, rows: [0, 1].map(dirs) }
    })
}
