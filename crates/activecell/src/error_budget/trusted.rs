//! Trusted routes: of many good routes the one on which the robot is most likely where it should be.

use super::Certificate;
use crate::lattice::{Cell, Dir};
use crate::map::Map;
use crate::program::Robot;
use crate::rng::Rng;
use crate::route::{Route, STEP};
use crate::wave::Field;

/// What a turn may cost, in steps: from less than all turns of a usual route together, which leaves the shortest
/// routes, to a long way round.
const PRICES: [f64; 6] = [1e-3, 0.5, 2.0, 8.0, 32.0, 128.0];
/// How many routes are drawn by chance, always the same, among the shortest.
const DRAWN: u64 = 16;
/// How many of the candidates are certified, those that formulas say are best.
const CERTIFIED: usize = 4;
/// A gain of worst probability that is worth another route.
const LEAST_GAIN: f64 = 1e-3;

/// A route that was chosen for trust.
#[derive(Debug, Clone, PartialEq)]
pub struct TrustedRoute {
    /// The route.
    pub route: Route,
    /// The certificate of its program.
    pub certificate: Certificate,
    /// Among how many different routes it was chosen.
    pub candidates: usize,
}

impl Field {
    /// Of up to 30 candidates the route whose worst waypoint the robot reaches with the highest probability; of
    /// routes that are alike to 0.001 the shortest. `heading` is where the robot faces at first; `None`: along its
    /// first run.
    ///
    /// Candidates are the route of [`Field::route`], of which the result is never worse; that of
    /// [`Field::shortest_route`]; the cheapest routes if a turn costs as much as 0.001, 0.5, 2, 8, 32, 128 steps, either
    /// everywhere or, because a turn's error grows with the way that follows, in proportion to the squared distance
    /// from the target; and 16 shortest routes by turns whose price each cell draws. On very large maps there are
    /// fewer. It is not the best of *all* routes: the probability of a route is no sum over its steps, which a search
    /// could add up.
    ///
    /// ```
    /// use activecell::{Cell, Lattice, Map, Robot};
    /// let map = Map::parse(Lattice::Square, "S...\n.##.\n...F")?;
    /// let (robot, from) = (Robot::default(), map.mark('S').unwrap());
    /// let field = map.wave(map.mark('F').unwrap())?;
    /// let trusted = field.trusted_route(&map, &robot, from, None);
    /// assert_eq!(trusted.route.steps(), 5);
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn trusted_route(&self, map: &Map, robot: &Robot, from: Cell, heading: Option<Dir>) -> TrustedRoute {
        let facing: Vec<Dir> = match heading {
            None => self.lattice().dirs().collect(),
            Some(ahead) if robot.can_reverse => vec![ahead, self.lattice().opposite(ahead)],
            Some(ahead) => vec![ahead],
        };
        let few_turns = self.route_facing(from, &facing);
        let end = few_turns.cells().last().map_or([0.0; 2], |&cell| map.centre_m(cell));
        let squared_m2 = |cell: Cell| {
            let [x, y] = map.centre_m(cell);
            (x - end[0]).powi(2) + (y - end[1]).powi(2)
        };
        let whole_m2 = squared_m2(from).max(map.frame().cell_m.powi(2));
        let alike = PRICES.into_iter().map(|steps| Price::Alike(steps * STEP as f64));
        let late = PRICES.into_iter().map(|steps| Price::Late(steps * STEP as f64));
        let priced = alike.chain(late).chain((0..DRAWN).map(Price::Drawn)).map_while(|price| {
            self.route_with_priced_turns(from, &facing, |cell| match price {
                Price::Alike(price) => price as u64,
                // On the mean over a straight way as much as the others.
                Price::Late(price) => (3.0 * price * squared_m2(cell) / whole_m2) as u64,
                // Less than a thousandth of a step.
                Price::Drawn(seed) => {
                    let place = map.index(cell).unwrap_or_default() as u64;
                    Rng::new(seed << 32 ^ place).next_u64() >> 54
                }
            })
        });
        let mut others: Vec<Route> = Vec::new();
        for route in std::iter::once(self.shortest_route(from)).chain(priced) {
            if route != few_turns && !others.contains(&route) {
                others.push(route);
            }
        }
        let candidates = 1 + others.len();
        let program = |route: &Route| route.program(robot, map, heading);
        // By formulas alone, which order routes well even where they do not hold; what is chosen is certified.
        let estimate = |route: &Route| Certificate::by_formulas(map, robot, &program(route)).worst_inside();
        let mut estimated: Vec<(f64, Route)> =
            others.into_iter().map(|route| (estimate(&route), route)).collect();
        estimated.sort_by(|a, b| b.0.total_cmp(&a.0));
        estimated.truncate(CERTIFIED);
        estimated.sort_by_key(|(_, route)| route.steps());
        let certified = |route: Route| {
            let certificate = Certificate::new(map, robot, &program(&route));
            TrustedRoute { route, certificate, candidates }
        };
        estimated.into_iter().map(|(_, route)| certified(route)).fold(certified(few_turns), |best, other| {
            let gain = other.certificate.worst_inside() - best.certificate.worst_inside();
            if gain > LEAST_GAIN { other } else { best }
        })
    }
}

/// What turns cost, in the unit of [`STEP`].
enum Price {
    /// Everywhere the same.
    Alike(f64),
    /// The more the farther from the target.
    Late(f64),
    /// What each cell draws with this seed.
    Drawn(u64),
}
