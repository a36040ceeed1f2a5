//! The published rule as a circuit: from the cells around the robot to the neighbour that becomes active.

use super::{any, not, select, sum};
use crate::logic::{Circuit, Expr, Signal, mask, sum_of_products};
use activecell::rule::{Candidate, Sector, Wolfram};
use activecell::{Dir, Lattice};
use std::collections::{BTreeMap, BTreeSet};

/// The navigation cell: one decision of the published rule, as [`activecell::rule::decide`] makes it.
///
/// Every signal has a lane for each neighbour, clockwise from the top. The second ring comes as two signals: what lies
/// straight `ahead` of each neighbour, and what lies `between` it and the next one clockwise.
///
/// Each sector asks the neighbours clockwise from its first, but that the one before the first, anticlockwise, may come
/// earlier. So rotations, which cost most in gates, are not needed.
///
/// # Panics
/// If a table of the core had another order.
pub fn decision(lattice: Lattice) -> Circuit {
    let lanes = u32::from(lattice.degree());
    let table = Sectors::of(lattice);
    let mut circuit = Circuit::new(&format!("decide_{lattice}"), &about(lattice));
    let ring1 = circuit.input("ring1", lanes, "obstacles among the neighbours");
    let ahead = circuit.input("ahead", lanes, "obstacles straight ahead of each neighbour");
    let between =
        circuit.input("between", lanes, "obstacles between each neighbour and the next one clockwise");
    let sector = circuit.input("sector", sector_bits(lattice), "where the target lies");
    let near = circuit.input("is_near", 1, "the target is a neighbour, the first of the sector");

    let lookup = |table: Vec<u32>| Expr::Lookup { table, width: lanes, index: sector };
    let is_first = circuit.wire("is_first", lookup(table.first()), "the neighbour that is asked first");
    let onward =
        circuit.wire("onward", lookup(table.onward()), "the first and those behind it, up to the last lane");
    let back = circuit.wire(
        "back",
        lookup(table.back()),
        "the neighbour before the first, where it does not come last",
    );
    let before = circuit.wire("asked_before", lookup(table.before()), "those that are asked before that one");

    let vacant = circuit.wire("vacant", not(Expr::Signal(ring1)), "neighbours without an obstacle");
    let left = circuit.wire("left_of", Expr::FromLeft(between), "obstacles to the left of each neighbour");
    let closed = closed(&mut circuit, &table, [left, ahead, between], sector);
    let target = Expr::And(vec![
        Expr::Signal(is_first),
        Expr::Select(
            Box::new(Expr::Signal(near)),
            Box::new(Expr::Const { width: lanes, value: mask(lanes) }),
            Box::new(Expr::Const { width: lanes, value: 0 }),
        ),
    ]);
    let target = circuit.wire("is_target", target, "the target itself is never closed");
    let permitted = Expr::And(vec![
        Expr::Signal(vacant),
        Expr::Or(vec![not(Expr::Signal(closed)), Expr::Signal(target)]),
    ]);
    let permitted = circuit.wire("permitted", permitted, "neighbours that would take the value 0");
    let some = circuit.wire(
        "some_permitted",
        any(Expr::Signal(permitted)),
        "else the robot retreats to any vacant one",
    );

    let meets = |a: Signal, b: Signal| Expr::And(vec![Expr::Signal(a), Expr::Signal(b)]);
    let earlier = Expr::And(vec![any(meets(permitted, back)), not(any(meets(permitted, before)))]);
    let turn_back =
        circuit.wire("turn_back", earlier, "the one before the first is the first that is permitted");
    let wanted = select(some, Expr::Signal(permitted), Expr::Signal(vacant));
    let wanted = circuit.wire("wanted", wanted, "those to choose from");
    let later = circuit.wire("later", meets(wanted, onward), "of these, those from the first on");
    let from = select_any(later, wanted);
    let clockwise =
        circuit.wire("clockwise", from, "the next of these in lane order is the next one clockwise");
    let go = select(turn_back, Expr::Signal(back), Expr::Lowest(clockwise));
    circuit.output("go", go, "the neighbour that becomes active, at most one");
    circuit.output(
        "enclosed",
        not(any(Expr::Signal(vacant))),
        "all neighbours are obstacles: the robot stays",
    );
    circuit
}

/// The neighbourhood as the core has it ([`activecell::rule::neighbourhood`]), from the lanes that [`decision`] is given:
/// the neighbours, what lies ahead of each, and what between it and the next one. Bits above the lanes do not count.
///
/// ```
/// use activecell::{Cell, Lattice, Map, rule};
/// use activecell_codegen::circuits;
/// // From the middle: an obstacle in the north, one ahead of the east, one between south and west.
/// let map = Map::parse(Lattice::Square, ".....\n..#..\n....#\n.#...\n.....")?;
/// let bits = circuits::neighbourhood(Lattice::Square, [0b0001, 0b0010, 0b0100]);
/// assert_eq!(bits, rule::neighbourhood(&map, Cell::new(2, 2)));
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn neighbourhood(lattice: Lattice, [ring1, ahead, between]: [u32; 3]) -> u32 {
    let lanes = u32::from(lattice.degree());
    let every_second = |bits: u32| (0..lanes).map(|lane| (bits >> lane & 1) << (2 * lane)).sum::<u32>();
    ring1 & mask(lanes) | (every_second(ahead) | every_second(between) << 1) << lanes
}

/// What the lanes and the numbers of the sectors mean.
fn about(lattice: Lattice) -> String {
    let lanes: Vec<String> =
        lattice.dirs().map(|dir| format!("{} {}", dir.0, lattice.dir_name(dir))).collect();
    let sectors = match lattice {
        Lattice::Square => "Sectors: 0 N, 1 NE, 2 E, 3 SE, 4 S, 5 SW, 6 W, 7 NW.",
        Lattice::Hex => {
            "Sectors: 2j and 2j + 1 where direction j is nearest, and then the one clockwise, or anticlockwise, of it."
        }
    };
    format!("One decision of the published rule. A lane a neighbour: {}.\n{sectors}", lanes.join(", "))
}

fn select_any(some: Signal, otherwise: Signal) -> Expr {
    Expr::Select(
        Box::new(any(Expr::Signal(some))),
        Box::new(Expr::Signal(some)),
        Box::new(Expr::Signal(otherwise)),
    )
}

/// Where the elementary rule that the sector asks for closes a neighbour. The rules' formulas are over the ahead triple
/// (X4, X1, X2), all lanes at once.
fn closed(circuit: &mut Circuit, table: &Sectors, [x4, x1, x2]: [Signal; 3], sector: Signal) -> Signal {
    let lanes = circuit.port(x1).width;
    let mut parts = Vec::new();
    for (rule, asked) in table.rules() {
        let cubes =
            sum_of_products(3, |bits| rule.next([bits & 4 > 0, bits & 2 > 0, bits & 1 > 0]), |_| false);
        let formula = sum(&cubes, &[x2, x1, x4].map(Expr::Signal));
        let closed =
            circuit.wire(&format!("rule_{rule}"), formula, "neighbours that this elementary rule closes");
        if asked.iter().all(|&lanes_asked| lanes_asked == mask(lanes)) {
            parts.push(Expr::Signal(closed));
            continue;
        }
        let lookup = Expr::Lookup { table: asked, width: lanes, index: sector };
        let asked = circuit.wire(&format!("by_{rule}"), lookup, "neighbours that it is asked for");
        parts.push(Expr::And(vec![Expr::Signal(closed), Expr::Signal(asked)]));
    }
    let expr = if parts.len() == 1 { parts.remove(0) } else { Expr::Or(parts) };
    circuit.wire("closed", expr, "neighbours behind which the way ends")
}

pub(super) const fn sector_bits(lattice: Lattice) -> u32 {
    match lattice {
        Lattice::Square => 3,
        Lattice::Hex => 4,
    }
}

/// The candidates of all sectors, as the core has them.
struct Sectors {
    lattice: Lattice,
    orders: Vec<Vec<Candidate>>,
}

impl Sectors {
    fn of(lattice: Lattice) -> Self {
        let orders = Sector::all(lattice).map(|sector| sector.candidates(lattice, false).collect());
        Self { lattice, orders: orders.collect() }
    }

    fn map(&self, entry: impl Fn(&[Candidate]) -> u32) -> Vec<u32> {
        self.orders.iter().map(|order| entry(order)).collect()
    }

    fn first(&self) -> Vec<u32> {
        self.map(|order| lane(order[0].dir))
    }

    fn onward(&self) -> Vec<u32> {
        self.map(|order| mask(self.lattice.degree().into()) & !(lane(order[0].dir) - 1))
    }

    /// Where the neighbour before the first stands in the order. All others follow clockwise.
    fn place_of_last(&self, order: &[Candidate]) -> usize {
        let last = self.lattice.turned(order[0].dir, -1);
        let others = order.iter().map(|candidate| candidate.dir).filter(|&dir| dir != last);
        let clockwise = self.lattice.dirs().map(|dir| self.lattice.turned(order[0].dir, dir.0.into()));
        assert!(
            others.eq(clockwise.filter(|&dir| dir != last)),
            "a sector that asks in another order needs another circuit"
        );
        order.iter().position(|candidate| candidate.dir == last).expect("every neighbour is asked")
    }

    fn back(&self) -> Vec<u32> {
        self.map(|order| {
            let place = self.place_of_last(order);
            if place + 1 == order.len() { 0 } else { lane(order[place].dir) }
        })
    }

    fn before(&self) -> Vec<u32> {
        self.map(|order| order[..self.place_of_last(order)].iter().map(|candidate| lane(candidate.dir)).sum())
    }

    /// For each elementary rule, the lanes that each sector asks it for.
    fn rules(&self) -> BTreeMap<Wolfram, Vec<u32>> {
        let all = self.orders.iter().flatten().map(|candidate| candidate.closed_by);
        let rules: BTreeSet<Wolfram> = all.collect();
        let asked = |rule: Wolfram| {
            self.map(|order| {
                order
                    .iter()
                    .filter(|candidate| candidate.closed_by == rule)
                    .map(|candidate| lane(candidate.dir))
                    .sum()
            })
        };
        rules.into_iter().map(|rule| (rule, asked(rule))).collect()
    }
}

const fn lane(dir: Dir) -> u32 {
    1 << dir.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use activecell::rule::{Decision, decide};

    /// 4,096 neighbourhoods × 8 sectors, 262,144 × 12, each with and without the target near.
    #[test]
    fn every_input_decides_as_the_core() {
        for lattice in Lattice::ALL {
            let circuit = decision(lattice);
            circuit.check().unwrap();
            let lanes = u32::from(lattice.degree());
            for around in 0..1u32 << (3 * lanes) {
                let [ring1, ahead, between] = [0, 1, 2].map(|group| around >> (group * lanes) & mask(lanes));
                let bits = neighbourhood(lattice, [ring1, ahead, between]);
                for sector in Sector::all(lattice) {
                    for near in [false, true] {
                        let number = sector.number().into();
                        let inputs = [ring1, ahead, between, number, near.into()];
                        let expected = match decide(lattice, sector, near, bits) {
                            Decision::Move(dir) => [lane(dir), 0],
                            Decision::Enclosed => [0, 1],
                        };
                        assert_eq!(circuit.evaluate(&inputs), expected, "{lattice} {inputs:?}");
                    }
                }
            }
        }
    }
}
