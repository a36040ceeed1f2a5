//! Schedules against an adversary, who decides at every moment which robot drives how far within its permit, and which report
//! comes through. Bodies are watched by [`Discs`], cells by the rule that the chapter states; both look at where the
//! robots are, not at what they report.

use super::{random, wander};
use activecell::schedule::{Discs, Runner, Visit};
use activecell::{Cell, Lattice, Map, Plan, Rng, Robot, Schedule};
use std::collections::BTreeSet;

/// Robots that stop this share of a cell before a centre count as there.
const NEAR: f64 = 0.01;
/// The exhaustive adversary stops robots at every such share of a cell, and wherever their permit ends.
const STOPS: [f64; 11] = [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.991];

/// What does not change while robots drive.
struct Floor<'a> {
    map: &'a Map,
    radius: f64,
    visits: Vec<Vec<Visit>>,
    /// Revolutions for a cell.
    cell: f64,
}

/// Robots under way: how many cells each has come.
#[derive(Clone)]
struct Trial<'a> {
    runner: Runner<'a>,
    come: Vec<f64>,
}

impl<'a> Floor<'a> {
    /// `None` if robots of this radius cannot keep the schedule.
    fn new(map: &'a Map, schedule: &'a Schedule, radius: f64) -> Option<(Self, Trial<'a>)> {
        let robot = Robot { radius_m: radius * map.frame().cell_m, ..Robot::default() };
        let runner = Runner::new(map, schedule, &robot).ok()?;
        let visits = (0..schedule.robots()).map(|robot| schedule.visits(robot).collect()).collect();
        let cell = robot.revolutions(map.frame().cell_m);
        let come = vec![0.0; schedule.robots()];
        Some((Self { map, radius, visits, cell }, Trial { runner, come }))
    }

    fn last(&self, robot: usize) -> usize {
        self.visits[robot].len() - 1
    }

    fn is_done(&self, trial: &Trial<'_>) -> bool {
        (0..self.visits.len()).all(|robot| trial.come[robot] >= self.last(robot) as f64 - 1e-9)
    }

    /// How far a robot may come, in cells.
    fn permit(&self, trial: &mut Trial<'_>, robot: usize) -> f64 {
        trial.runner.permit(robot) / self.cell
    }

    fn report(&self, trial: &mut Trial<'_>, robot: usize) {
        trial.runner.report(robot, trial.come[robot] * self.cell);
    }

    fn point(&self, robot: usize, come: f64) -> [f64; 2] {
        let visit = (come + 1e-9).floor() as usize;
        let [from, to] = [visit, (visit + 1).min(self.last(robot))]
            .map(|visit| Discs::centre(self.map, self.visits[robot][visit].cell));
        let share = (come - visit as f64).max(0.0);
        [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]))
    }

    /// What is wrong now.
    fn fault(&self, discs: &mut Discs, come: &[f64]) -> Option<String> {
        let points: Vec<_> = come.iter().enumerate().map(|(robot, &come)| self.point(robot, come)).collect();
        if let Some(robots) = discs.overlap(&points) {
            return Some(format!("{robots:?} overlap"));
        }
        (0..come.len()).find_map(|robot| self.shared(robot, come))
    }

    /// A cell is never shared but by a robot that leaves it and the one that follows in step; and nobody is at a centre
    /// while any of the body before is still in the cell.
    fn shared(&self, robot: usize, come: &[f64]) -> Option<String> {
        let here = (come[robot] + 1e-9).floor() as usize;
        for number in here..=(here + 1).min(self.last(robot)) {
            let visit = self.visits[robot][number];
            let Some((before, left)) = visit.after.filter(|after| after.0 != robot) else { continue };
            // How far the one before is beyond the centre.
            let beyond = come[before] - left as f64;
            let is_out = beyond >= 0.5 + self.radius - 1e-9;
            let is_leaving = visit.bend_deg.is_some() && beyond >= -NEAR - 1e-9;
            let comes = come[robot] > number as f64 - 1.0 + 1e-9;
            let is_there = come[robot] >= number as f64 - 0.5 * NEAR;
            if is_there && !is_out || comes && !is_out && !is_leaving {
                let at = visit.cell;
                return Some(format!("{robot} comes to {at}, and {before} is {beyond:.3} beyond its centre"));
            }
        }
        None
    }

    /// Every way of the robots, each from stop to stop, in any order.
    fn exhaust(&self, trial: Trial<'a>) -> Result<usize, String> {
        let mut discs = Discs::new(self.map, self.radius);
        let mut seen = BTreeSet::new();
        let mut open = vec![trial];
        while let Some(mut now) = open.pop() {
            let state =
                |come: &[f64]| come.iter().map(|come| (come * 1e6).round() as u64).collect::<Vec<_>>();
            let mut stuck = true;
            for robot in 0..now.come.len() {
                let (come, permit) = (now.come[robot], self.permit(&mut now, robot));
                if permit < come + 1e-9 {
                    continue;
                }
                stuck = false;
                let stops = STOPS.iter().chain(&[1.0]).map(|stop| come.floor() + stop);
                let to = stops.chain([permit]).filter(|&stop| stop > come + 1e-9).fold(permit, f64::min);
                let mut next = now.clone();
                next.come[robot] = to;
                if seen.insert(state(&next.come)) {
                    if let Some(fault) = self.fault(&mut discs, &next.come) {
                        return Err(format!("{fault} at {:?}", next.come));
                    }
                    self.report(&mut next, robot);
                    open.push(next);
                }
            }
            if stuck && !self.is_done(&now) {
                return Err(format!("nobody may go on at {:?}", now.come));
            }
        }
        Ok(seen.len())
    }

    /// Robots that go and stop by chance: some seldom, some as far as they may, some for a long time not at all; and reports
    /// that come late.
    fn tease(&self, mut trial: Trial<'a>, rng: &mut Rng) -> Result<(), String> {
        let robots = trial.come.len();
        let mut discs = Discs::new(self.map, self.radius);
        let eagerness: Vec<f64> = (0..robots).map(|_| [1.0, 0.5, 0.05][rng.below(3) as usize]).collect();
        let heard = [1.0, 0.3][rng.below(2) as usize];
        let mut rests = vec![0; robots];
        // With the end far behind what the slowest need: all rests together, and a tick for each 20th of a step.
        for _ in 0..200_000 {
            for robot in 0..robots {
                let permit = self.permit(&mut trial, robot);
                if rests[robot] > 0 || !rng.chance(eagerness[robot]) {
                    rests[robot] -= i32::from(rests[robot] > 0);
                    continue;
                }
                rests[robot] = if rng.chance(0.05) { rng.below(200) as i32 } else { 0 };
                let step = if rng.chance(0.5) { 0.12 } else { 0.12 * rng.unit() };
                trial.come[robot] = trial.come[robot].max((trial.come[robot] + step).min(permit));
                if let Some(fault) = self.fault(&mut discs, &trial.come) {
                    return Err(format!("{fault} at {:?}", trial.come));
                }
            }
            for robot in 0..robots {
                if rng.chance(heard) {
                    self.report(&mut trial, robot);
                }
            }
            if self.is_done(&trial) {
                return Ok(());
            }
        }
        Err(format!("nobody arrives at {:?}", trial.come))
    }
}

/// The cells, x and y, that each robot passes.
type Paths<'a> = &'a [&'a [(i32, i32)]];

/// A plan of paths, each a cell a step; who has arrived rests.
fn plan(paths: Paths<'_>) -> Plan {
    let steps = paths.iter().map(|path| path.len()).max().unwrap();
    let cell = |step: usize, path: &&[(i32, i32)]| {
        let (x, y) = path[step.min(path.len() - 1)];
        Cell::new(x, y)
    };
    let cells = (0..steps).flat_map(|step| paths.iter().map(move |path| cell(step, path)));
    Plan::new(paths.len(), cells.collect()).unwrap()
}

/// Radii in cells, most of them where a bound of the rule is met: where one may just go in step round corners of 60°, 90° and 120°, where
/// `clear` changes its reason, and the largest.
fn radii(lattice: Lattice) -> &'static [f64] {
    match lattice {
        Lattice::Square => &[0.05, 0.2, 0.27, 0.3, 0.34, 0.4, 0.47, 0.49],
        Lattice::Hex => &[0.05, 0.16, 0.2, 0.24, 0.3, 0.37, 0.38, 0.4, 0.42],
    }
}

#[test]
fn drawn_situations_hold_whatever_anybody_does() {
    use Lattice::{Hex, Square};
    let situations: [(Lattice, Paths<'_>); 11] = [
        // One follows another straight on, and round a corner.
        (Square, &[&[(1, 0), (2, 0), (3, 0)], &[(0, 0), (1, 0), (2, 0)]]),
        (Square, &[&[(1, 1), (1, 0), (0, 0)], &[(0, 1), (1, 1), (1, 0)]]),
        (Hex, &[&[(1, 1), (2, 1), (3, 1)], &[(0, 1), (1, 1), (2, 1)]]),
        (Hex, &[&[(1, 1), (2, 0), (3, 0)], &[(0, 1), (1, 1), (2, 1)]]),
        // A sharp corner: from the cell that the first goes to one could touch the second.
        (Hex, &[&[(1, 1), (1, 0), (2, 0)], &[(0, 1), (1, 1), (2, 1)]]),
        // A cell that three pass, one after the other, from all sides.
        (Square, &[&[(1, 1), (1, 0)], &[(0, 1), (1, 1), (2, 1)], &[(1, 2), (1, 2), (1, 1), (0, 1)]]),
        (Hex, &[&[(1, 1), (2, 1)], &[(0, 1), (1, 1), (1, 0)], &[(1, 2), (1, 2), (1, 1), (0, 1)]]),
        // The second turns off to a cell that a third has just come to.
        (Hex, &[&[(1, 1), (2, 1), (3, 1)], &[(0, 1), (1, 1), (1, 1), (2, 2)], &[(1, 2), (2, 2), (3, 2)]]),
        (Square, &[&[(1, 1), (2, 1), (3, 1)], &[(0, 1), (1, 1), (1, 1), (1, 2)], &[(0, 2), (1, 2), (2, 2)]]),
        // Rings.
        (
            Square,
            &[
                &[(0, 0), (1, 0), (1, 1)],
                &[(1, 0), (1, 1), (0, 1)],
                &[(1, 1), (0, 1), (0, 0)],
                &[(0, 1), (0, 0), (1, 0)],
            ],
        ),
        (
            Hex,
            &[
                &[(0, 0), (1, 0), (0, 1), (0, 0)],
                &[(1, 0), (0, 1), (0, 0), (1, 0)],
                &[(0, 1), (0, 0), (1, 0), (0, 1)],
            ],
        ),
    ];
    let mut looked_at = 0;
    for (number, (lattice, paths)) in situations.into_iter().enumerate() {
        let map = Map::parse(lattice, "....\n....\n....").unwrap();
        let schedule = Schedule::new(&map, &plan(paths)).unwrap();
        for &radius in radii(lattice) {
            let Some((floor, trial)) = Floor::new(&map, &schedule, radius) else {
                assert!(schedule.rings().len() > 0, "{number} {radius}");
                continue;
            };
            looked_at += floor.exhaust(trial).unwrap_or_else(|fault| panic!("{number}, {radius}: {fault}"));
        }
    }
    println!("{looked_at} places of all robots");
    assert!(looked_at > 50_000);
}

#[test]
fn small_random_plans_hold_whatever_anybody_does() {
    let mut looked_at = 0;
    for seed in 0..60 {
        let mut rng = Rng::new(seed);
        let lattice = Lattice::ALL[seed as usize % 2];
        let map = Map::parse(lattice, "...\n...").unwrap();
        let schedule = Schedule::new(&map, &wander(&map, 3, 3, &mut rng)).unwrap();
        let radius = radii(lattice)[rng.below(radii(lattice).len() as u32) as usize];
        let Some((floor, trial)) = Floor::new(&map, &schedule, radius) else { continue };
        looked_at += floor.exhaust(trial).unwrap_or_else(|fault| panic!("{seed}, {radius}: {fault}"));
    }
    println!("{looked_at} places of all robots");
    assert!(looked_at > 50_000);
}

#[test]
fn crowds_hold_against_chance() {
    let mut held = 0;
    for seed in 0..150 {
        let (map, plan) = random(seed, 14, 25);
        let schedule = Schedule::new(&map, &plan).unwrap();
        let mut rng = Rng::new(seed);
        for &radius in radii(map.lattice()) {
            if let Some((floor, trial)) = Floor::new(&map, &schedule, radius) {
                floor.tease(trial, &mut rng).unwrap_or_else(|fault| panic!("{seed}, {radius}: {fault}"));
                held += 1;
            }
        }
    }
    assert!(held > 500, "{held}");
}
