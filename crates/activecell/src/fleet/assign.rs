//! Targets given to whoever is best placed: the least sum of distances, found by waves over the floor.
//!
//! No distance between a robot and a target is ever written down. The robots flow over the floor itself: each link
//! between two cells carries any number of them, at a cost of one a robot. Waves from the robots that have no target
//! yet look for the cheapest way to a target that is still free, where a way may also send robots back that go over a
//! link the other way; potentials keep every step's reduced cost at 0, 1 or 2. All ways of one wave that do not
//! hinder each other are taken at once. Each wave takes time by the cells that it passes, and there are about as many
//! as the longest way has steps.
//!
//! Source: L. R. Ford and D. R. Fulkerson, *A Primal-Dual Algorithm for the Capacitated Hitchcock Problem*, Naval
//! Research Logistics Quarterly 1957; potentials: J. Edmonds and R. M. Karp, *Theoretical Improvements in Algorithmic
//! Efficiency for Network Flow Problems*, JACM 1972; many ways at once: E. A. Dinic, *Algorithm for Solution of a
//! Problem of Maximum Flow in a Network with Power Estimation*, Soviet Mathematics Doklady 1970.

use super::team::{Team, shared};
use crate::error::Error;
use crate::lattice::{Cell, Dir};
use crate::map::Map;
use std::cmp::Reverse;
use std::collections::BTreeMap;

/// No cell, no rank, no distance.
const NONE: u32 = u32::MAX;

impl Team {
    /// A group whose targets belong to nobody yet: every target gets a robot, so that the sum of the distances is the
    /// least that there is. Robots that are left over keep their start as target.
    ///
    /// Among robots that go the same way the one that comes from farthest takes the first target, so that nobody has
    /// to pass a robot that is already at rest.
    ///
    /// Takes 46 bytes a cell of the map on squares, 62 on hexagons, and no table of robots and targets.
    ///
    /// # Errors
    /// [`Error::OfRobot`] or [`Error::SharedStart`] as [`Team::new`]; [`Error::OutsideMap`], [`Error::TargetOccupied`]
    /// or [`Error::SharedTarget`] (the numbers count the targets) for a target; [`Error::TooFewRobots`] if a connected
    /// part of the floor has more targets than robots.
    ///
    /// ```
    /// use activecell::{Cell, Lattice, Map, Team};
    /// let map = Map::parse(Lattice::Square, ".....")?;
    /// let at = |x| Cell::new(x, 0);
    /// let team = Team::assigned(&map, vec![at(0), at(1)], &[at(4), at(2)])?;
    /// assert_eq!(team.targets(), [at(2), at(4)]);
    /// assert_eq!(team.lower_bound(&map)?, Some(5));
    /// let error = Team::assigned(&map, vec![at(0)], &[at(4), at(2)]).unwrap_err();
    /// assert_eq!(
    ///     error.to_string(),
    ///     "the part of the floor around (4,0) has 1 robot for 2 targets; give it a robot for each target"
    /// );
    /// # Ok::<(), activecell::Error>(())
    /// ```
    pub fn assigned(map: &Map, starts: Vec<Cell>, targets: &[Cell]) -> Result<Self, Error> {
        let staying = Self::new(map, starts.clone(), starts)?;
        for &target in targets {
            map.check_target(target)?;
        }
        if let Some((robots, cell)) = shared(targets) {
            return Err(Error::SharedTarget { robots, cell });
        }
        let mut flow = Flow::new(map, staying.starts(), targets);
        while flow.wave() {
            flow.send_all();
        }
        if let Some(&target) = targets.iter().find(|&&target| flow.open[flow.number(target)] == Open::Target)
        {
            return Err(too_few(map, staying.starts(), targets, target)?);
        }
        let targets = flow.targets(staying.starts(), targets);
        Self::new(map, staying.starts().to_vec(), targets)
    }
}

/// What is wrong around a target that no robot can be found for.
fn too_few(map: &Map, starts: &[Cell], targets: &[Cell], cell: Cell) -> Result<Error, Error> {
    let part = map.reachable(&[cell])?;
    let within = |cells: &[Cell]| cells.iter().filter(|cell| part.get(cell.x as u32, cell.y as u32)).count();
    Ok(Error::TooFewRobots { cell, robots: within(starts), targets: within(targets) })
}

/// What a cell still waits for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Open {
    Nothing,
    /// The robot that starts here has no target yet.
    Robot,
    /// The target here has no robot yet.
    Target,
}

/// Robots flowing over a floor. Cells are numbered as in the map, row by row; link `degree * cell + dir` leads from a
/// cell in a direction.
struct Flow<'a> {
    map: &'a Map,
    degree: usize,
    /// The cell that each link leads to, [`NONE`] into an obstacle.
    links: Vec<u32>,
    /// The robots that go over each link, less those that come the other way.
    flow: Vec<i32>,
    /// One up for every step of a robot that flows; at most one up over every other link.
    potential: Vec<i32>,
    open: Vec<Open>,
    /// The cells of robots without a target.
    waiting: Vec<u32>,
    /// The cells that the last wave passed, in this order.
    passed: Vec<u32>,
    /// Where in `passed` each cell stands.
    rank: Vec<u32>,
    /// Reduced cost from a waiting robot, as far as the wave knows.
    distance: Vec<u32>,
    /// How many links of each cell lead nowhere any more in this wave.
    tried: Vec<u8>,
}

impl<'a> Flow<'a> {
    fn new(map: &'a Map, starts: &[Cell], targets: &[Cell]) -> Self {
        let (cells, degree) = (map.cells(), usize::from(map.lattice().degree()));
        let mut links = vec![NONE; cells * degree];
        for cell in map.free() {
            let from = map.index(cell).expect("free cells lie on the map") * degree;
            for dir in map.lattice().dirs() {
                let next = map.lattice().neighbour(cell, dir);
                if map.is_free(next) {
                    links[from + dir.index()] = map.index(next).map_or(NONE, |index| index as u32);
                }
            }
        }
        let mut flow = Self {
            map,
            degree,
            flow: vec![0; links.len()],
            links,
            potential: vec![0; cells],
            open: vec![Open::Nothing; cells],
            waiting: Vec::new(),
            passed: Vec::new(),
            rank: vec![NONE; cells],
            distance: vec![NONE; cells],
            tried: vec![0; cells],
        };
        for &target in targets {
            let number = flow.number(target);
            flow.open[number] = Open::Target;
        }
        for &start in starts {
            let number = flow.number(start);
            // Who stands on a target has found one: by the triangle inequality no other choice is better.
            if flow.open[number] == Open::Target {
                flow.open[number] = Open::Nothing;
            } else {
                flow.open[number] = Open::Robot;
                flow.waiting.push(number as u32);
            }
        }
        flow
    }

    fn number(&self, cell: Cell) -> usize {
        self.map.index(cell).expect("starts and targets were checked")
    }

    /// The reduced cost of one robot more from a cell over one of its links to `next`.
    #[inline]
    fn cost(&self, from: u32, link: usize, next: u32) -> u32 {
        let step = if self.flow[link] < 0 { -1 } else { 1 };
        (step + self.potential[from as usize] - self.potential[next as usize]) as u32
    }

    /// Lets a wave run from all waiting robots to the nearest open targets, and raises the potentials so that all ways
    /// to these cost nothing. False if it reaches none.
    fn wave(&mut self) -> bool {
        for cell in self.passed.drain(..) {
            self.rank[cell as usize] = NONE;
            self.distance[cell as usize] = NONE;
        }
        self.waiting.retain(|&cell| self.open[cell as usize] == Open::Robot);
        // A step costs 0, 1 or 2: three rims are enough.
        let mut rims = [self.waiting.clone(), Vec::new(), Vec::new()];
        for &cell in &self.waiting {
            self.distance[cell as usize] = 0;
        }
        let mut found = false;
        let mut steps = 0;
        while !found && rims.iter().any(|rim| !rim.is_empty()) {
            found = self.spread(&mut rims, steps);
            steps += 1;
        }
        for &cell in rims.iter().flatten().filter(|&&cell| self.rank[cell as usize] == NONE) {
            self.distance[cell as usize] = NONE;
        }
        if found {
            for &cell in &self.passed {
                self.potential[cell as usize] += self.distance[cell as usize] as i32 + 1 - steps as i32;
            }
        }
        found
    }

    /// Passes all cells at this distance; true if an open target is among them.
    fn spread(&mut self, rims: &mut [Vec<u32>; 3], steps: u32) -> bool {
        let here = steps as usize % 3;
        let mut found = false;
        let mut at = 0;
        while let Some(&cell) = rims[here].get(at) {
            at += 1;
            if self.rank[cell as usize] != NONE {
                continue;
            }
            self.rank[cell as usize] = self.passed.len() as u32;
            self.passed.push(cell);
            self.tried[cell as usize] = 0;
            found |= self.open[cell as usize] == Open::Target;
            for link in self.links_of(cell) {
                let next = self.links[link];
                if next == NONE || self.rank[next as usize] != NONE {
                    continue;
                }
                let there = steps + self.cost(cell, link, next);
                if there < self.distance[next as usize] {
                    self.distance[next as usize] = there;
                    rims[there as usize % 3].push(next);
                }
            }
        }
        rims[here].clear();
        found
    }

    fn links_of(&self, cell: u32) -> std::ops::Range<usize> {
        let first = cell as usize * self.degree;
        first..first + self.degree
    }

    /// Sends every waiting robot that finds a way along the last wave.
    fn send_all(&mut self) {
        let mut path = Vec::new();
        for i in 0..self.waiting.len() {
            self.send(self.waiting[i], &mut path);
        }
    }

    /// Sends a robot along steps that cost nothing and lead on in the order of the wave, which has no cycle.
    fn send(&mut self, from: u32, path: &mut Vec<u32>) {
        path.clear();
        let mut here = from;
        while self.open[here as usize] != Open::Target {
            let tried = self.tried[here as usize] as usize;
            if tried == self.degree {
                let Some(before) = path.pop() else { return };
                here = before;
                self.tried[here as usize] += 1;
                continue;
            }
            let link = here as usize * self.degree + tried;
            let next = self.links[link];
            let open = next != NONE
                && self.rank[next as usize] != NONE
                && self.rank[next as usize] > self.rank[here as usize]
                && self.cost(here, link, next) == 0;
            if open {
                path.push(here);
                here = next;
            } else {
                self.tried[here as usize] += 1;
            }
        }
        self.open[here as usize] = Open::Nothing;
        self.open[from as usize] = Open::Nothing;
        for &cell in path.iter() {
            let dir = self.tried[cell as usize];
            let link = cell as usize * self.degree + usize::from(dir);
            let next = self.links[link] as usize;
            let back = self.map.lattice().opposite(Dir(dir)).index();
            self.flow[link] += 1;
            self.flow[next * self.degree + back] -= 1;
        }
    }

    /// The target of each robot: the robots walk up the potentials with the flow. At each target the one that comes
    /// from farthest stays.
    fn targets(&mut self, starts: &[Cell], targets: &[Cell]) -> Vec<Cell> {
        let mut open: Vec<bool> = vec![false; self.map.cells()];
        for &target in targets {
            open[self.number(target)] = true;
        }
        let mut given = starts.to_vec();
        let width = self.map.width();
        // Robots under way, by potential and cell: nobody comes to the first of them any more.
        let mut under_way: BTreeMap<(i32, u32), Vec<usize>> = BTreeMap::new();
        for (robot, &start) in starts.iter().enumerate() {
            let number = self.number(start);
            if self.open[number] == Open::Nothing {
                under_way.entry((self.potential[number], number as u32)).or_default().push(robot);
            }
        }
        while let Some(((_, cell), mut robots)) = under_way.pop_first() {
            if open[cell as usize] {
                // The farthest last: it stays.
                robots.sort_by_key(|&robot| Reverse((self.potential[self.number(starts[robot])], robot)));
                let staying = robots.pop().expect("nobody is under way in no number");
                given[staying] = Cell::new((cell % width) as i32, (cell / width) as i32);
            }
            for robot in robots {
                let mut links = self.links_of(cell);
                let link =
                    links.find(|&link| self.flow[link] > 0).expect("who comes and does not stay goes on");
                self.flow[link] -= 1;
                let next = self.links[link];
                under_way.entry((self.potential[next as usize], next)).or_default().push(robot);
            }
        }
        given
    }
}
