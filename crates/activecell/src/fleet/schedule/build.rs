//! From a plan to its schedule.

use super::{NONE, Schedule};
use crate::error::Error;
use crate::fleet::{Plan, check_moves};
use crate::map::Map;

impl Schedule {
    /// The schedule of a plan that keeps the rules on this map.
    ///
    /// Takes time for robots × steps and, while it runs, 8 bytes for each cell of the map.
    ///
    /// # Errors
    /// [`Error::BadPlan`] with what [`check_moves`] finds, or if robots and moves are more than 2³² − 2.
    pub fn new(map: &Map, plan: &Plan) -> Result<Self, Error> {
        check_moves(map, plan).map_err(|fault| Error::BadPlan { reason: fault.to_string() })?;
        let first = first_visits(plan)?;
        let visits = first[plan.robots()] as usize;
        let mut schedule = Self {
            lattice: map.lattice(),
            width: map.width(),
            cells: vec![0; visits],
            steps: vec![0; visits],
            before: vec![NONE; visits],
            rings: Vec::new(),
            first,
        };
        schedule.fill(map, plan);
        Ok(schedule)
    }

    fn fill(&mut self, map: &Map, plan: &Plan) {
        let robots = plan.robots();
        // Of each cell: the last visit so far, and whose it was.
        let mut last = vec![(NONE, NONE); map.cells()];
        let mut here = self.first[..robots].to_vec();
        let mut rings = Rings { ahead: vec![NONE; robots], walked: vec![0; robots], walks: 0 };
        for step in 0..=plan.steps() {
            let (from, to) = (plan.row(step.saturating_sub(1)), plan.row(step));
            let movers = || (0..robots).filter(|&robot| from[robot] != to[robot] || step == 0);
            for robot in movers() {
                let visit = &mut here[robot];
                *visit += u32::from(step > 0);
                let cell = map.index(to[robot]).expect("the plan was checked");
                let (before, who) = std::mem::replace(&mut last[cell], (*visit, robot as u32));
                self.cells[*visit as usize] = cell as u32;
                self.steps[*visit as usize] = step as u32;
                self.before[*visit as usize] = before;
                let leaves_now = |who: u32| from[who as usize] == to[robot] && to[who as usize] != to[robot];
                rings.ahead[robot] = if who != NONE && leaves_now(who) { who } else { NONE };
            }
            for ring in rings.closed(movers()) {
                self.rings.push(ring.into_iter().map(|robot| here[robot as usize]).collect());
            }
        }
    }
}

/// The number of each robot's first visit, and of all.
fn first_visits(plan: &Plan) -> Result<Vec<u32>, Error> {
    let mut visits = vec![1u64; plan.robots()];
    for step in 1..=plan.steps() {
        let moved = plan.row(step - 1).iter().zip(plan.row(step)).map(|(from, to)| from != to);
        visits.iter_mut().zip(moved).for_each(|(count, moved)| *count += u64::from(moved));
    }
    let mut sum = 0;
    let mut first = vec![0];
    for count in visits {
        sum += count;
        let number = u32::try_from(sum).ok().filter(|&number| number < NONE);
        first.push(number.ok_or_else(|| Error::BadPlan { reason: "more than 4,294,967,294 moves".into() })?);
    }
    Ok(first)
}

/// Finds the rings of a step: following who is followed leads back to the beginning.
struct Rings {
    /// Whom each robot that moves in this step follows.
    ahead: Vec<u32>,
    /// The walk in which each robot was met last; they are counted from 1 over all steps.
    walked: Vec<u32>,
    walks: u32,
}

impl Rings {
    /// Walks from each of these robots to whom it follows, and on. The rings, each once.
    fn closed(&mut self, movers: impl Iterator<Item = usize>) -> Vec<Vec<u32>> {
        let known = self.walks;
        let mut rings = Vec::new();
        for robot in movers {
            self.walks += 1;
            let mut at = robot as u32;
            while at != NONE && self.walked[at as usize] <= known {
                self.walked[at as usize] = self.walks;
                at = self.ahead[at as usize];
            }
            if at != NONE && self.walked[at as usize] == self.walks {
                let begin = at;
                let ring = std::iter::successors(Some(begin), |&robot| {
                    Some(self.ahead[robot as usize]).filter(|&next| next != begin)
                });
                rings.push(ring.collect());
            }
        }
        rings
    }
}
