//! The fabric, clock by clock.
//!
//! Every cell does what the circuit [`fabric_cell`] says; the control around them is written here once more: this is what
//! the generated hardware is compared with.

use crate::circuits::fabric_cell;
use crate::colours::Colours;
use activecell::{Cell, Dir, Lattice, Map};

/// What the fabric is given at a clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Inputs {
    /// Any task ends.
    pub reset: bool,
    /// The map moves on by a cell, this obstacle or free cell last.
    pub load: Option<bool>,
    /// A task begins: start and target.
    pub begin: Option<(Cell, Cell)>,
}

/// What the fabric shows after a clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[expect(clippy::struct_excessive_bools, reason = "they are wires")]
pub struct Outputs {
    /// A task is being done.
    pub busy: bool,
    /// The robot was in the cell `at`, three clocks ago.
    pub moving: bool,
    /// Where it was then; before it moves the start, after it has moved the target.
    pub at: Cell,
    /// The task is done: the robot is at the target.
    pub arrived: bool,
    /// The task is done: the wave stopped before it came to the start.
    pub unreachable: bool,
}

/// The registers of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct State {
    reached: bool,
    was_reached: bool,
    active: bool,
    /// A bit a direction, at most one.
    pointer: u8,
}

impl State {
    const fn is_front(self) -> bool {
        self.reached && !self.was_reached
    }
}

/// The fabric of a map.
///
/// ```
/// use activecell::{Cell, Lattice, Map};
/// use activecell_codegen::model::fabric::Fabric;
/// let mut fabric = Fabric::new(&Map::parse(Lattice::Square, "...\n.#.\n...")?);
/// let way = fabric.run(Cell::new(0, 0), Cell::new(2, 2)).unwrap();
/// assert_eq!(way.len(), 5);
/// assert_eq!(way[1], Cell::new(1, 0), "the wave came from East and South at once; East is first");
/// # Ok::<(), activecell::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Fabric {
    lattice: Lattice,
    width: u32,
    /// The numbers of each cell's neighbours, that of no cell outside the map.
    neighbours: Vec<[usize; 6]>,
    /// What [`fabric_cell`] says, for all its inputs.
    rule: Vec<State>,
    free: Vec<bool>,
    /// One more than there are cells: nothing, for what lies outside.
    cells: Vec<State>,
    task: Option<(Cell, Cell)>,
    warm_up: u8,
    /// The cell that was active a clock ago, and two.
    active: [Option<Cell>; 2],
    /// Whether the wave was seen in a watched cell a clock ago, two and three.
    front: [bool; 3],
    outputs: Outputs,
}

/// Clocks from the beginning of a task until its wave is seen by the control.
const WARM_UP: u8 = 4;

impl Fabric {
    /// The fabric with this map loaded, and nothing to do.
    pub fn new(map: &Map) -> Self {
        let lattice = map.lattice();
        let (width, height) = (map.width() as i32, map.height() as i32);
        let cells: Vec<Cell> = (0..height).flat_map(|y| (0..width).map(move |x| Cell::new(x, y))).collect();
        let around = |&cell: &Cell| {
            let number = |dir: u8| map.index(lattice.neighbour(cell, Dir(dir))).unwrap_or(cells.len());
            std::array::from_fn(
                |dir| if dir < lattice.degree().into() { number(dir as u8) } else { cells.len() },
            )
        };
        Self {
            lattice,
            width: map.width(),
            neighbours: cells.iter().map(around).collect(),
            rule: rule(lattice),
            free: cells.iter().map(|&cell| map.is_free(cell)).collect(),
            cells: vec![State::default(); cells.len() + 1],
            task: None,
            warm_up: 0,
            active: [None; 2],
            front: [false; 3],
            outputs: Outputs::default(),
        }
    }

    /// The fabric for maps of this lattice and size as it powers up, with none loaded: no cell is free.
    pub fn unloaded(map: &Map) -> Self {
        let fabric = Self::new(map);
        Self { free: vec![false; fabric.free.len()], ..fabric }
    }

    /// A clock: what is shown after it.
    pub fn clock(&mut self, inputs: Inputs) -> Outputs {
        let stop = inputs.reset || inputs.load.is_some();
        let clear = stop || inputs.begin.is_some();
        self.clock_control(inputs.begin, stop);
        self.clock_cells(clear);
        if let Some(obstacle) = inputs.load {
            self.free.rotate_left(1);
            if let Some(last) = self.free.last_mut() {
                *last = !obstacle;
            }
        }
        self.task = if stop { None } else { inputs.begin.or(self.task) };
        self.outputs
    }

    /// The control sees what the cells were before this clock.
    fn clock_control(&mut self, begin: Option<(Cell, Cell)>, stop: bool) {
        let ([_, seen], now) = (self.active, self.outputs);
        if stop || begin.is_some() {
            let at = begin.map_or(now.at, |(start, _)| start);
            self.outputs = Outputs { busy: !stop, at, ..Outputs::default() };
            (self.warm_up, self.front, self.active) = (0, [false; 3], [None; 2]);
            return;
        }
        let at_target = now.moving && seen.is_none();
        let is_spreading = self.warm_up < WARM_UP || self.front[1] || self.front[2];
        let stopped = !is_spreading && seen.is_none() && !now.moving;
        self.outputs = Outputs {
            busy: now.busy && !at_target && !stopped,
            moving: seen.is_some(),
            at: seen.unwrap_or(now.at),
            arrived: now.arrived || at_target,
            unreachable: now.unreachable || now.busy && stopped && !now.arrived,
        };
        self.warm_up = WARM_UP.min(self.warm_up + 1);
        self.active = [self.active_cell(), self.active[0]];
        self.front = [self.is_front_seen(), self.front[0], self.front[1]];
    }

    /// Whether the wave has come to a watched cell: of two cells side by side, one is.
    fn is_front_seen(&self) -> bool {
        let watched = Colours::of_neighbours(self.lattice);
        let is_front =
            |(number, state): (usize, &State)| state.is_front() && watched.of(self.cell(number)) != 0;
        self.cells[..self.free.len()].iter().enumerate().any(is_front)
    }

    fn clock_cells(&mut self, clear: bool) {
        let [start, target] = [self.task.map(|task| task.0), self.task.map(|task| task.1)];
        let next = (0..self.free.len()).map(|number| {
            let here = self.cells[number];
            let cell = Some(self.cell(number));
            let (mut around, mut entering) = (0, 0);
            for dir in self.lattice.dirs() {
                let neighbour = self.cells[self.neighbours[number][dir.index()]];
                let points_here = neighbour.pointer >> self.lattice.opposite(dir).0 & 1 == 1;
                around |= usize::from(neighbour.reached) << dir.0;
                entering |= usize::from(neighbour.active && points_here) << dir.0;
            }
            let flags = [self.free[number], cell == target, cell == start, here.is_front()];
            let flags = flags.iter().rev().fold(0, |sum, &flag| sum << 1 | usize::from(flag));
            let next = self.rule[flags | around << 4 | entering << (4 + self.lattice.degree())];
            let pointer = if here.reached { here.pointer } else { next.pointer };
            if clear {
                State { pointer, ..State::default() }
            } else {
                State { was_reached: here.reached, pointer, ..next }
            }
        });
        let mut next: Vec<State> = next.collect();
        next.push(State::default());
        self.cells = next;
    }

    /// Runs a task to its end: the cells in which the robot was, or `None` if it cannot come to its target.
    pub fn run(&mut self, from: Cell, to: Cell) -> Option<Vec<Cell>> {
        let mut way = Vec::new();
        let mut outputs = self.clock(Inputs { begin: Some((from, to)), ..Inputs::default() });
        while outputs.busy {
            outputs = self.clock(Inputs::default());
            way.extend(outputs.moving.then_some(outputs.at));
        }
        outputs.arrived.then_some(way)
    }

    /// The active cell.
    pub fn active_cell(&self) -> Option<Cell> {
        self.cells.iter().position(|cell| cell.active).map(|number| self.cell(number))
    }

    /// Whether the wave has come to each cell, in row order.
    pub fn reached(&self) -> impl Iterator<Item = bool> + '_ {
        self.cells[..self.free.len()].iter().map(|cell| cell.reached)
    }

    /// Whether each cell is active, in row order.
    pub fn active(&self) -> impl Iterator<Item = bool> + '_ {
        self.cells[..self.free.len()].iter().map(|cell| cell.active)
    }

    /// Where each cell points, a bit a direction, in row order. Without meaning where the wave has not come.
    pub fn pointers(&self) -> impl Iterator<Item = u8> + '_ {
        self.cells[..self.free.len()].iter().map(|cell| cell.pointer)
    }

    const fn cell(&self, number: usize) -> Cell {
        Cell::new((number as u32 % self.width) as i32, (number as u32 / self.width) as i32)
    }
}

/// The circuit of the cell as a table over all its inputs, the first in the lowest bits.
fn rule(lattice: Lattice) -> Vec<State> {
    let circuit = fabric_cell(lattice);
    let bits: u32 = circuit.inputs.iter().map(|port| port.width).sum();
    (0..1u32 << bits)
        .map(|mut place| {
            let mut take = |width: u32| {
                let value = place & ((1 << width) - 1);
                place >>= width;
                value
            };
            let inputs: Vec<u32> = circuit.inputs.iter().map(|port| take(port.width)).collect();
            let outputs = circuit.evaluate(&inputs);
            State {
                reached: outputs[0] == 1,
                was_reached: false,
                active: outputs[2] == 1,
                pointer: outputs[1] as u8,
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use activecell::DirectionPlanes;
    use activecell::Rng;

    #[test]
    fn pointers_and_ways_are_those_of_the_core() {
        let (mut pointers, mut arrivals, mut refusals) = (0, 0, 0);
        for lattice in Lattice::ALL {
            for seed in 0..60 {
                let mut rng = Rng::new(seed);
                let (width, height) = (1 + rng.below(20), 1 + rng.below(20));
                let map =
                    Map::random(lattice, width, height, f64::from(rng.below(50)) / 100.0, seed).unwrap();
                let mut fabric = Fabric::new(&map);
                for target in map.free().filter(|_| rng.chance(0.05)).collect::<Vec<_>>() {
                    let planes = map.direction_planes(&[target]).unwrap();
                    let planes = DirectionPlanes::from_bytes(&planes).unwrap();
                    let field = map.wave(target).unwrap();
                    assert_eq!(fabric.run(target, target), Some(vec![target]));
                    for start in map.free().filter(|_| rng.chance(0.1)).collect::<Vec<_>>() {
                        let way = fabric.run(start, target);
                        assert_eq!(way, planes.path(0, start), "{lattice} {seed} from {start} to {target}");
                        let steps = way.as_ref().map(|way| way.len() as u32 - 1);
                        assert_eq!(steps, field.steps(start));
                        *(if way.is_some() { &mut arrivals } else { &mut refusals }) += 1;
                    }
                    // The wave goes on when the robot has arrived.
                    for _ in 0..map.cells() {
                        fabric.clock(Inputs::default());
                    }
                    for (number, (reached, pointer)) in fabric.reached().zip(fabric.pointers()).enumerate() {
                        let cell = fabric.cell(number);
                        assert_eq!(reached, planes.is_reached(0, cell));
                        let dir = planes.next(0, cell).map_or(0, |dir| 1 << dir.0);
                        assert!(!reached || pointer == dir, "{lattice} {seed} {cell} to {target}");
                        pointers += u32::from(reached);
                    }
                }
            }
        }
        println!("fabric: {pointers} pointers, {arrivals} ways and {refusals} refusals as the core's");
        assert!(arrivals > 2000 && refusals > 200, "{arrivals} {refusals}");
    }

    #[test]
    fn a_way_of_n_steps_takes_2_n_and_7_clocks() {
        let map = Map::parse(Lattice::Square, "....\n###.\n....\n.###\n....").unwrap();
        for target in map.free() {
            let mut fabric = Fabric::new(&map);
            let steps = map.wave(target).unwrap().steps(Cell::new(0, 0)).unwrap();
            let mut outputs =
                fabric.clock(Inputs { begin: Some((Cell::new(0, 0), target)), ..Inputs::default() });
            let mut clocks = 1;
            while outputs.busy {
                outputs = fabric.clock(Inputs::default());
                clocks += 1;
            }
            assert_eq!(clocks, 2 * steps + 7);
        }
    }

    #[test]
    fn tasks_that_cannot_be_end_as_unreachable() {
        for lattice in Lattice::ALL {
            let map = Map::parse(lattice, "..#.\n..#.\n###.").unwrap();
            let mut fabric = Fabric::new(&map);
            for (from, to) in
                [((0, 0), (3, 0)), ((0, 0), (2, 0)), ((2, 0), (0, 0)), ((9, 9), (0, 0)), ((0, 0), (9, 9))]
            {
                assert_eq!(fabric.run(Cell::new(from.0, from.1), Cell::new(to.0, to.1)), None);
            }
            assert_eq!(fabric.run(Cell::new(1, 1), Cell::new(1, 1)), Some(vec![Cell::new(1, 1)]));
        }
    }
}
