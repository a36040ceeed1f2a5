//! The runner: lets each robot into its next cell by what robots report, and nothing else.

use super::spacing::NEAR;
use super::{NONE, Schedule, Spacing};
use crate::error::Error;
use crate::map::Map;
use crate::program::Robot;

/// Runs a schedule: robots report how far they have come, and are told how far they may go.
///
/// What a robot reports is the revolutions that its wheels have rolled in the runs of its program since the start, those
/// backwards included, those of turns on the spot not. It may drive to its [`permit`](Self::permit):
///
/// - to the centre of its next cell, if the robot that the schedule has there before it is clear of it by its report
///   ([`Spacing::clear`]), or nobody was there, and on to the one after by the same rule;
/// - else, if the plan has the two move in the same step and the other has reported to be at that cell's centre or
///   beyond, part of the way: as far as the other plus [`Spacing::play`];
/// - else no further than the centre of its cell.
///
/// So a robot between two cells occupies both, and a cell is never shared by two but a robot that leaves it and the one
/// that follows in step. A permit is never taken back, and reports only ever widen permits: a report that comes
/// late or never delays those who wait for it, nothing else. No clock is asked.
///
/// ```
/// use activecell::schedule::Runner;
/// use activecell::{Cell, Lattice, Map, Plan, Robot, Schedule};
/// let map = Map::parse(Lattice::Square, "...")?;
/// let [a, b, c] = [0, 1, 2].map(|x| Cell::new(x, 0));
/// let schedule = Schedule::new(&map, &Plan::new(2, vec![a, b, a, c, b, c])?)?;
/// // Cells of 1 m are 5 revolutions; a body of radius 0.3 m is clear after 0.8 m.
/// let robot = Robot { wheel_perimeter_m: 0.2, radius_m: 0.3, ..Robot::default() };
/// let mut runner = Runner::new(&map, &schedule, &robot)?;
/// assert_eq!((runner.permit(0), runner.permit(1)), (0.0, 5.0));
/// runner.report(1, 3.9);
/// assert_eq!(runner.permit(0), 0.0);
/// runner.report(1, 4.1);
/// assert_eq!(runner.permit(0), 5.0);
/// runner.report(0, 5.0);
/// runner.report(1, 5.0);
/// assert!(runner.is_done());
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Runner<'a> {
    schedule: &'a Schedule,
    spacing: Spacing,
    /// Of each visit: the revolutions of its robot at the centre.
    centres: Vec<f64>,
    robots: Vec<Progress>,
    arrived: usize,
}

#[derive(Debug, Clone, Copy)]
struct Progress {
    reported: f64,
    /// The last visit whose centre it reported to have reached.
    at: u32,
    /// The last visit that it may come to.
    granted: u32,
    /// Whose leaving the next visit waits for.
    behind: u32,
}

impl<'a> Runner<'a> {
    /// A runner for robots with these wheels and this radius, all at their starts.
    ///
    /// # Errors
    /// [`Error::BadValue`] if the robots are too large for the cells ([`Spacing::new`]), or for the corners of a ring of
    /// the plan.
    ///
    /// # Panics
    /// If the map is not the schedule's.
    pub fn new(map: &Map, schedule: &'a Schedule, robot: &Robot) -> Result<Self, Error> {
        let spacing = Spacing::new(map.lattice(), robot.radius_m / map.frame().cell_m)?;
        let bends = schedule.rings.iter().flatten().map(|&visit| schedule.bend_deg(visit));
        if bends.max().is_some_and(|sharpest| spacing.play(sharpest).is_none()) {
            return Err(too_large_for_a_ring(map, spacing.radius()));
        }
        let mut centres = Vec::with_capacity(schedule.cells.len());
        let mut robots = Vec::with_capacity(schedule.robots());
        for number in 0..schedule.robots() {
            let [first, last] = [schedule.first[number], schedule.last(number)];
            let mut way = 0.0;
            centres.push(way);
            for visit in first..last {
                way += robot.revolutions(map.ground_m(&[schedule.cell(visit), schedule.cell(visit + 1)]));
                centres.push(way);
            }
            let behind = behind(schedule, number, first);
            robots.push(Progress { reported: 0.0, at: first, granted: first, behind });
        }
        let arrived = (0..robots.len()).filter(|&robot| robots[robot].at == schedule.last(robot)).count();
        Ok(Self { schedule, spacing, centres, robots, arrived })
    }

    /// A robot says how many revolutions it has driven since the start. Less than it said before counts for nothing.
    pub fn report(&mut self, robot: usize, revolutions: f64) {
        let last = self.schedule.last(robot);
        let progress = &mut self.robots[robot];
        let further = revolutions > progress.reported;
        if !further || progress.at == last {
            return;
        }
        progress.reported = revolutions;
        while progress.at < last {
            let at = progress.at as usize;
            let [from, to] = [self.centres[at], self.centres[at + 1]];
            if revolutions < to - NEAR * (to - from) {
                return;
            }
            progress.at += 1;
        }
        self.arrived += 1;
    }

    /// The revolutions since the start up to which a robot may drive now.
    pub fn permit(&mut self, robot: usize) -> f64 {
        let last = self.schedule.last(robot);
        loop {
            let Progress { granted, behind, .. } = self.robots[robot];
            let here = self.centres[granted as usize];
            if granted == last {
                return here;
            }
            let next = granted + 1;
            let before = self.schedule.before[next as usize];
            // Behind nobody, or only behind itself.
            if behind != NONE && !self.is_clear(behind, before) {
                let length = self.centres[next as usize] - here;
                return self.in_step(behind, next).map_or(here, |share| here + share * length);
            }
            self.robots[robot].granted = next;
            self.robots[robot].behind = self::behind(self.schedule, robot, next);
        }
    }

    /// Whether every robot has reported that it is where it rests.
    pub const fn is_done(&self) -> bool {
        self.arrived == self.robots.len()
    }

    /// The revolutions since the start with which a robot is at the centre of one of its visits, counted from 0.
    ///
    /// # Panics
    /// If there is no such robot; what a visit that it does not have gives is not said.
    pub fn revolutions(&self, robot: usize, visit: usize) -> f64 {
        self.centres[self.schedule.first[robot] as usize + visit]
    }

    /// The room that robots leave each other.
    pub const fn spacing(&self) -> Spacing {
        self.spacing
    }

    /// The schedule.
    pub const fn schedule(&self) -> &'a Schedule {
        self.schedule
    }

    /// The revolutions of its robot at the centre of a visit.
    pub(super) fn centre(&self, visit: u32) -> f64 {
        self.centres[visit as usize]
    }

    /// The revolutions of its robot at the centre of a visit, and of the next.
    pub(super) fn way(&self, visit: u32) -> [f64; 2] {
        [self.centre(visit), self.centre(visit + 1)]
    }

    /// How far along its way from a visit to the next a robot is, as a share of it.
    fn share(&self, robot: u32, visit: u32) -> f64 {
        let [from, to] = self.way(visit);
        ((self.robots[robot as usize].reported - from) / (to - from)).max(0.0)
    }

    fn is_clear(&self, robot: u32, visit: u32) -> bool {
        let at = self.robots[robot as usize].at;
        at > visit || at == visit && self.share(robot, visit) >= self.spacing.clear()
    }

    /// How far a robot may be on its way to a visit, as a share of it, while the one before is still leaving.
    fn in_step(&self, ahead: u32, visit: u32) -> Option<f64> {
        let before = self.schedule.before[visit as usize];
        if self.robots[ahead as usize].at != before || !self.schedule.is_in_step(visit) {
            return None;
        }
        let play = self.spacing.play(self.schedule.bend_deg(visit))?;
        Some(self.share(ahead, before) + play)
    }
}

/// The robot whose leaving the visit after this one waits for.
fn behind(schedule: &Schedule, robot: usize, visit: u32) -> u32 {
    if visit == schedule.last(robot) || schedule.before[visit as usize + 1] == NONE {
        return NONE;
    }
    let owner = schedule.owner(schedule.before[visit as usize + 1]);
    if owner == robot { NONE } else { owner as u32 }
}

fn too_large_for_a_ring(map: &Map, radius: f64) -> Error {
    let allowed = match map.lattice() {
        crate::lattice::Lattice::Square => {
            "at most 0.34 cells: in this plan robots follow each other around a ring"
        }
        crate::lattice::Lattice::Hex => {
            "at most 0.24 cells: in this plan robots follow each other around a ring with sharp corners"
        }
    };
    Error::BadValue { name: "the robots' radius in cells", value: radius, allowed }
}
