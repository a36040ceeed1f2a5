//! Where bodies of several cells fit.

use super::{BitPlane, Map};
use crate::lattice::Cell;

impl Map {
    /// The map as a body of this radius sees it: its centre may be where the whole [block](crate::Lattice::block) is free. A
    /// robot of one cell moves on it as the body does on the map.
    ///
    /// Two sweeps, each with the half of the neighbours that lie before a cell (Rosenfeld and Pfaltz, *Sequential
    /// Operations in Digital Picture Processing*, 1966).
    ///
    /// ```
    /// use activecell::{Lattice, Map};
    /// let map = Map::parse(Lattice::Square, ".......\n.......\n.......\n....#..")?;
    /// assert_eq!(map.for_body(1).to_text(), "#######\n#.....#\n#..####\n#######\n");
    /// # Ok::<(), activecell::Error>(())
    /// ```
    #[must_use]
    pub fn for_body(&self, radius: u32) -> Self {
        if radius == 0 {
            return self.clone();
        }
        let (width, height) = (self.width() as usize, self.height() as usize);
        let mut room = vec![0u32; width * height];
        let around = |cell: Cell, back: bool| {
            let near = self.lattice().block(cell, 1);
            near.filter(move |other| *other != cell && back == ((other.y, other.x) < (cell.y, cell.x)))
        };
        let sweep = |room: &[u32], at: usize, back: bool| {
            let cell = Cell::new((at % width) as i32, (at / width) as i32);
            let known = |other: Cell| self.index(other).map_or(0, |other| room[other]);
            around(cell, back).map(known).min().unwrap_or(0).saturating_add(1)
        };
        for cell in self.free() {
            let at = cell.y as usize * width + cell.x as usize;
            room[at] = sweep(&room, at, true);
        }
        for at in (0..room.len()).rev() {
            room[at] = room[at].min(sweep(&room, at, false));
        }
        self.overlaid(|obstacles: &mut BitPlane| {
            for (at, _) in room.iter().enumerate().filter(|(_, room)| **room <= radius) {
                obstacles.set((at % width) as u32, (at / width) as u32, true);
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lattice::Lattice;

    #[test]
    fn a_body_fits_where_all_its_cells_are_free() {
        for seed in 0..200 {
            let lattice = Lattice::ALL[seed as usize % 2];
            let (width, height) = (1 + seed as u32 % 17, 1 + seed as u32 % 13);
            let map = Map::random(lattice, width, height, 0.06, seed).unwrap();
            for radius in 0..4 {
                let grown = map.for_body(radius);
                for cell in (0..height as i32).flat_map(|y| (0..width as i32).map(move |x| Cell::new(x, y))) {
                    let fits = lattice.block(cell, radius).all(|cell| map.is_free(cell));
                    assert_eq!(grown.is_free(cell), fits, "{lattice} {seed} {radius} {cell}");
                }
            }
        }
    }
}
