//! One dive: a plan made step by step, never going back.

use super::local::Local;
use super::spread::Ways;
use super::{Guide, Problem};
use crate::arbitrate::Arbiter;
use crate::floor::NONE;
use crate::priorities::Priorities;
use activecell::Plan;
use std::cmp::{Ordering, Reverse};

/// A robot is in a hurry if it has come no nearer to its target for so many steps.
const PATIENCE: u32 = 5;
/// If all together have come no nearer for so many steps, nobody looks ahead or is shy until they do.
const DEADLOCK: u32 = 10;

/// A plan that a dive found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Dive {
    /// Its sum of costs.
    pub sum_of_costs: u64,
    /// The cells of all robots at step 0, at step 1 and so on, by their numbers.
    pub rows: Vec<u32>,
}

impl Dive {
    /// The plan, for robots on this floor.
    pub fn plan(&self, problem: Problem<'_>) -> Option<Plan> {
        let cells = self.rows.iter().map(|&number| problem.floor.cell(number)).collect();
        Plan::new(problem.starts.len(), cells).ok()
    }
}

/// Makes a plan step by step: the robots look ahead as `guide` says, arbitration settles what they wish for. The same
/// problem, guide and seed give the same plan. There is none if the robots do not arrive within 500 steps and eight
/// times the longest way, or if `stop` says so, which is asked before every step with a lower bound of the sum of costs
/// that the dive will come to.
///
/// # Panics
/// If there are not as many starts as goals.
///
/// ```
/// use activecell::{Lattice, Map};
/// use activecell_fleet::{Fields, Floor, Guide, Problem, dive};
/// let map = Map::parse(Lattice::Square, "A.B\n...")?;
/// let floor = Floor::new(&map);
/// let [west, east] = ['A', 'B'].map(|name| floor.number(map.mark(name).unwrap()));
/// let mut fields = Fields::new(&floor);
/// let goals = fields.goals(&floor, &[east, west], 1)?;
/// let problem = Problem { floor: &floor, fields: &fields, goals: &goals, starts: &[west, east] };
/// let found = dive(problem, Guide::Local(10), 0, &|_| false).unwrap();
/// assert_eq!(found.sum_of_costs, 6); // one of them goes round by the row below
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn dive(problem: Problem<'_>, guide: Guide, seed: u64, stop: &impl Fn(u64) -> bool) -> Option<Dive> {
    dive_from(problem, &problem.distances(), guide, seed, stop)
}

/// The same for robots that are known to have so many steps to go.
pub(super) fn dive_from(
    problem: Problem<'_>,
    distances: &[u32],
    guide: Guide,
    seed: u64,
    stop: &impl Fn(u64) -> bool,
) -> Option<Dive> {
    let Problem { floor, fields, goals, starts } = problem;
    assert_eq!(starts.len(), goals.len(), "one start and one goal a robot");
    let mut arbiter = Arbiter::new(floor, fields, goals.to_vec(), seed);
    let shy = 2 * starts.len() < floor.map().free_cells();
    let mut team = Team::new(distances.to_vec());
    let bound = team.bound(0);
    let (window, mut ways) = match guide {
        Guide::Plain => (None, None),
        Guide::Local(window) => (Some(window), None),
        Guide::Spread(window) => (Some(window), Some(Ways::new(problem, &team.ahead, seed, &|| stop(bound)))),
    };
    let mut local = window.map(|window| Local::new(problem, window, seed));
    let longest = team.ahead.iter().copied().max().unwrap_or(0);
    let mut rows = starts.to_vec();
    let mut next = vec![NONE; starts.len()];
    for time in 0..500 + 8 * longest {
        let sum_of_costs = team.bound(time);
        if team.sum == 0 {
            return Some(Dive { sum_of_costs, rows });
        }
        if stop(sum_of_costs) {
            return None;
        }
        let now = &rows[rows.len() - starts.len()..];
        team.order();
        let order = team.priorities.order();
        if let Some(local) = &mut local {
            if let Some(ways) = &mut ways {
                ways.follow(now);
            }
            local.advise(now, order, &team.hurried, ways.as_ref(), &mut arbiter.wishes);
        }
        let stuck = time - team.progress > DEADLOCK;
        arbiter.shy = shy && !stuck;
        if stuck {
            arbiter.wishes.clear();
        }
        arbiter.step(now, &mut next, order, &[]);
        team.step(problem, now, &next, time + 1);
        rows.extend_from_slice(&next);
    }
    None
}

/// How far the robots have come.
struct Team {
    /// Steps from each robot to its target.
    ahead: Vec<u32>,
    /// Their sum.
    sum: u64,
    /// The least that the sum has been, and when it came to that.
    least: u64,
    progress: u32,
    /// When each robot that is at its target arrived there.
    arrived: Vec<u32>,
    /// Who has come no nearer for a while, how near each robot has come on its way, and when.
    hurried: Vec<bool>,
    nearest: Vec<u32>,
    since: Vec<u32>,
    /// Steps since each robot was at its target.
    waits: Vec<u16>,
    /// Robots, the one farthest from its target first.
    ranks: Vec<u32>,
    priorities: Priorities,
}

impl Team {
    /// Robots that have so many steps to go.
    fn new(ahead: Vec<u32>) -> Self {
        let sum = ahead.iter().map(|&steps| u64::from(steps)).sum();
        let robots = ahead.len();
        let mut ranks: Vec<u32> = (0..robots as u32).collect();
        ranks.sort_by_key(|&robot| Reverse(ahead[robot as usize]));
        Self {
            nearest: ahead.clone(),
            ahead,
            sum,
            least: sum,
            progress: 0,
            arrived: vec![0; robots],
            hurried: vec![false; robots],
            since: vec![0; robots],
            waits: vec![0; robots],
            ranks,
            priorities: Priorities::default(),
        }
    }

    /// Decides who goes first.
    fn order(&mut self) {
        self.priorities.fill(&self.waits, &self.ranks);
    }

    /// The sum of costs if from this time on nobody were in anybody's way.
    fn bound(&self, time: u32) -> u64 {
        let costs = self.ahead.iter().zip(&self.arrived);
        costs.map(|(&ahead, &arrived)| u64::from(if ahead == 0 { arrived } else { time + ahead })).sum()
    }

    /// Takes a step into account, which ends at this time.
    fn step(&mut self, problem: Problem<'_>, now: &[u32], next: &[u32], time: u32) {
        for (robot, (&here, &there)) in now.iter().zip(next).enumerate() {
            let ahead = &mut self.ahead[robot];
            if here != there {
                let field = problem.fields.field(problem.goals[robot].slot);
                match field.compare(here, there) {
                    Ordering::Less => *ahead -= 1,
                    Ordering::Equal => {}
                    Ordering::Greater => *ahead += 1,
                }
                if *ahead == 0 {
                    self.arrived[robot] = time;
                }
            }
            let home = *ahead == 0;
            self.waits[robot] = if home { 0 } else { self.waits[robot].saturating_add(1) };
            if home || *ahead < self.nearest[robot] {
                // Who is driven from its target is on a new way.
                self.nearest[robot] = if home { NONE } else { *ahead };
                self.since[robot] = time;
            }
            self.hurried[robot] = time - self.since[robot] > PATIENCE;
        }
        self.sum = self.ahead.iter().map(|&steps| u64::from(steps)).sum();
        if self.sum < self.least {
            (self.least, self.progress) = (self.sum, time);
        }
    }
}
