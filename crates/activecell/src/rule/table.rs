//! The published rule as data: elementary rules, sectors, and the order in which candidates are looked at.

use crate::lattice::{Cell, Dir, Lattice};
use std::fmt;

/// An elementary cellular automaton rule by its Wolfram number: bit `4·X4 + 2·X1 + X2` of the number is the next
/// state (Stephen Wolfram, *Statistical Mechanics of Cellular Automata*, 1983).
///
/// Here the inputs are the *ahead triple* of a candidate cell, the states of the cells to its left (X4), straight
/// ahead (X1) and to its right (X2) as the robot would enter it, and the output 1 means *closed*.
///
/// ```
/// use activecell::rule::Wolfram;
/// assert!(Wolfram::RIGHT.next([false, true, true]));   // 136: X1 ∧ X2
/// assert!(Wolfram::LEFT.next([true, true, false]));    // 192: X4 ∧ X1
/// assert!(!Wolfram::ALL.next([true, true, false]));    // 128: X4 ∧ X1 ∧ X2
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Wolfram(pub u8);

impl Wolfram {
    /// Rule 136: closed if the cells ahead and to the right are obstacles (the sector's common cell is right).
    pub const RIGHT: Self = Self(136);
    /// Rule 192: closed if the cells to the left and ahead are obstacles (the common cell is left). The paper
    /// prints 172, but the bits of its Table 1 are those of 192.
    pub const LEFT: Self = Self(192);
    /// Rule 128: closed if all three are obstacles (straight sectors, remaining groups, hexagons).
    pub const ALL: Self = Self(128);
    /// Rule 0: never closed (the target itself).
    pub const NEVER: Self = Self(0);

    /// The next state for the triple (X4, X1, X2).
    pub const fn next(self, [x4, x1, x2]: [bool; 3]) -> bool {
        self.0 >> ((x4 as u8) << 2 | (x1 as u8) << 1 | x2 as u8) & 1 == 1
    }
}

impl fmt::Display for Wolfram {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.0)
    }
}

/// A neighbour that may become active, and the rule that closes it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Candidate {
    /// Which neighbour.
    pub dir: Dir,
    /// The elementary rule over its ahead triple; output 1 closes it.
    pub closed_by: Wolfram,
}

/// Where the target lies, as the rule sees it: 8 sectors on the square lattice, 12 on the hexagonal.
///
/// ```text
/// square, clockwise from North:                       hexagonal, two a direction:
///   0 N  1 NE  2 E  3 SE  4 S  5 SW  6 W  7 NW          2j:     nearest axis j, then j + 1
///   even: straight (Xd = 0 or Yd = 0), odd: diagonal    2j + 1: nearest axis j, then j − 1
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Sector(u8);

impl Sector {
    /// The sector of `to` as seen from `from`; `None` if they are the same cell (Xd = Yd = 0: arrived).
    ///
    /// On hexagons the axis nearest to the straight line between the centres, in exact integer arithmetic; of
    /// two equally near axes the first clockwise from the top, of two equally near seconds the clockwise one.
    pub fn towards(lattice: Lattice, from: Cell, to: Cell) -> Option<Self> {
        if from == to {
            return None;
        }
        let (a, b) = (lattice.centre(from), lattice.centre(to));
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        Some(match lattice {
            Lattice::Square => Self(match (dx.signum(), dy.signum()) {
                (0, -1) => 0,
                (1, -1) => 1,
                (1, 0) => 2,
                (1, 1) => 3,
                (0, 1) => 4,
                (-1, 1) => 5,
                (-1, 0) => 6,
                _ => 7,
            }),
            Lattice::Hex => {
                // Scalar products with the six axes; down-units are 1/√3 of across-units.
                let origin = lattice.centre(Cell::default());
                let along = |dir: Dir| {
                    let axis = lattice.centre(lattice.neighbour(Cell::default(), dir));
                    3 * dx * (axis.0 - origin.0) + dy * (axis.1 - origin.1)
                };
                let first = lattice.dirs().rev().max_by_key(|&dir| along(dir)).unwrap_or(Dir(0));
                let (right, left) = (lattice.turned(first, 1), lattice.turned(first, -1));
                Self(2 * first.0 + u8::from(along(left) > along(right)))
            }
        })
    }

    /// All sectors of a lattice, in the order of their numbers.
    pub fn all(lattice: Lattice) -> impl ExactSizeIterator<Item = Self> {
        (0..2 * lattice.degree()).map(Self)
    }

    /// The sector's number.
    pub const fn number(self) -> u8 {
        self.0
    }

    /// Every neighbour once, in the order in which the rule looks at them, each with the elementary rule that
    /// closes it: first the sector's own groups, then the remaining ones clockwise from the first.
    ///
    /// `near`: the target is a neighbour; it comes first and is never closed.
    ///
    /// ```
    /// use activecell::{Cell, Lattice, rule::Sector};
    /// let sector = Sector::towards(Lattice::Square, Cell::new(3, 3), Cell::new(0, 0)).unwrap();
    /// let order: Vec<String> = sector.candidates(Lattice::Square, false)
    ///     .map(|c| format!("{} {}", Lattice::Square.dir_name(c.dir), c.closed_by)).collect();
    /// assert_eq!(order, ["N 192", "W 136", "E 128", "S 128"]);
    /// ```
    pub fn candidates(self, lattice: Lattice, near: bool) -> impl Iterator<Item = Candidate> {
        let mut groups = self.groups(lattice);
        if let (true, Some(target)) = (near, &mut groups[0]) {
            target.closed_by = Wolfram::NEVER;
        }
        let remaining = self
            .clockwise(lattice)
            .filter(move |&dir| groups.iter().flatten().all(|group| group.dir != dir))
            .map(|dir| Candidate { dir, closed_by: Wolfram::ALL });
        groups.into_iter().flatten().chain(remaining)
    }

    /// All directions, clockwise from the one that is looked at first.
    pub fn clockwise(self, lattice: Lattice) -> impl Iterator<Item = Dir> {
        let first = self.groups(lattice)[0].map_or(Dir(0), |group| group.dir);
        lattice.dirs().map(move |dir| lattice.turned(first, dir.0.into()))
    }

    /// The groups that lie in the sector: one if it is straight, two if diagonal, three on hexagons.
    fn groups(self, lattice: Lattice) -> [Option<Candidate>; 3] {
        let group = |dir, closed_by| Some(Candidate { dir, closed_by });
        let half = Dir(self.0 / 2);
        match lattice {
            Lattice::Square if self.0.is_multiple_of(2) => [group(half, Wolfram::ALL), None, None],
            Lattice::Square => {
                // Vertical first. The common cell lies between the two: right of the one, left of the other.
                let left = group(half, Wolfram::RIGHT);
                let right = group(lattice.turned(half, 1), Wolfram::LEFT);
                if half.0.is_multiple_of(2) { [left, right, None] } else { [right, left, None] }
            }
            Lattice::Hex => {
                let side = if self.0.is_multiple_of(2) { 1 } else { -1 };
                [0, side, -side].map(|turn| group(lattice.turned(half, turn), Wolfram::ALL))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn table_1_of_the_paper() {
        let triples = (0..8u8).map(|bits| [bits & 4 > 0, bits & 2 > 0, bits & 1 > 0]);
        let column =
            |rule: Wolfram| triples.clone().map(|t| char::from(b'0' + u8::from(rule.next(t)))).collect();
        let [right, left]: [String; 2] = [column(Wolfram::RIGHT), column(Wolfram::LEFT)];
        assert_eq!(right, "00010001");
        assert_eq!(left, "00000011");
        assert_eq!(
            column(Wolfram(172)) as String,
            "00110101",
            "the printed number does not fit the printed bits"
        );
    }

    #[test]
    fn formulas_3_and_4() {
        // North-East: b1 is closed by b1¹ ∧ b12, b2 by b12 ∧ b2².
        let sector = Sector::towards(Lattice::Square, Cell::new(0, 5), Cell::new(4, 0)).unwrap();
        let order: Vec<Candidate> = sector.candidates(Lattice::Square, false).collect();
        assert_eq!((order[0].dir, order[0].closed_by), (Dir::N, Wolfram::RIGHT));
        assert_eq!((order[1].dir, order[1].closed_by), (Dir::E, Wolfram::LEFT));
    }

    #[test]
    fn candidates_name_every_neighbour_once() {
        for lattice in Lattice::ALL {
            for sector in Sector::all(lattice) {
                for near in [false, true] {
                    let mut dirs: Vec<Dir> = sector.candidates(lattice, near).map(|c| c.dir).collect();
                    dirs.sort_unstable();
                    assert!(dirs.into_iter().eq(lattice.dirs()));
                }
            }
        }
    }

    #[test]
    fn hexagonal_sectors_follow_the_angle() {
        let here = Cell::new(10, 10);
        for y in 0..21 {
            for x in 0..21 {
                let to = Cell::new(x, y);
                let Some(sector) = Sector::towards(Lattice::Hex, here, to) else { continue };
                let (ux, uy) = Lattice::Hex.unit_m();
                let (a, b) = (Lattice::Hex.centre(here), Lattice::Hex.centre(to));
                let angle = |dx: i64, dy: i64| (dx as f64 * ux).atan2(-dy as f64 * uy).to_degrees();
                let to_target = angle(b.0 - a.0, b.1 - a.1);
                let off = |dir: Dir| {
                    let axis = 30.0 + 60.0 * f64::from(dir.0);
                    let off = (to_target - axis).rem_euclid(360.0);
                    off.min(360.0 - off)
                };
                let order: Vec<Candidate> = sector.candidates(Lattice::Hex, false).collect();
                assert!(off(order[0].dir) <= off(order[1].dir) + 1e-9 && off(order[0].dir) <= 30.0 + 1e-9);
                assert!(off(order[1].dir) <= off(order[2].dir) + 1e-9);
                if Lattice::Hex.distance(here, to) == 1 {
                    assert_eq!(
                        Lattice::Hex.neighbour(here, order[0].dir),
                        to,
                        "the target itself comes first"
                    );
                }
            }
        }
    }
}
