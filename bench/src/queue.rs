//! The plain queue: breadth-first search as anyone would write it with some care. It gives the right answers
//! to all other methods, and is the mark that no clever method may fall behind.

use activecell::{Cell, Map};

const UNKNOWN: u32 = u32::MAX;
/// Obstacles and the border look as if they had been reached.
const OBSTACLE: u32 = u32::MAX - 1;

/// A map with a border one cell wide, so that no step needs a check of bounds.
pub struct Queue {
    stride: usize,
    width: usize,
    blank: Vec<u32>,
    /// Equal to `blank` between queries.
    steps: Vec<u32>,
    reached: Vec<u32>,
}

impl Queue {
    pub fn new(map: &Map) -> Self {
        let (width, height) = (map.width() as usize, map.height() as usize);
        let stride = width + 2;
        let mut blank = vec![OBSTACLE; stride * (height + 2)];
        for cell in map.free() {
            blank[(cell.y as usize + 1) * stride + cell.x as usize + 1] = UNKNOWN;
        }
        Self { stride, width, blank, steps: Vec::new(), reached: Vec::new() }
    }

    fn index(&self, cell: Cell) -> usize {
        (cell.y as usize + 1) * self.stride + cell.x as usize + 1
    }

    fn cell(&self, index: usize) -> Cell {
        Cell::new((index % self.stride) as i32 - 1, (index / self.stride) as i32 - 1)
    }

    /// Spreads from `origin` over `steps` until `until` is reached.
    fn spread(&self, steps: &mut [u32], queue: &mut Vec<u32>, origin: usize, until: usize) {
        queue.clear();
        queue.push(origin as u32);
        steps[origin] = 0;
        let mut head = 0;
        while head < queue.len() {
            let cell = queue[head] as usize;
            head += 1;
            let next = steps[cell] + 1;
            for neighbour in [cell - self.stride, cell + 1, cell + self.stride, cell - 1] {
                if steps[neighbour] == UNKNOWN {
                    steps[neighbour] = next;
                    queue.push(neighbour as u32);
                    if neighbour == until {
                        return;
                    }
                }
            }
        }
    }

    /// The steps of every cell, with the border. Read them with [`Self::field_steps`].
    pub fn field(&self, target: Cell) -> Vec<u32> {
        let mut steps = self.blank.clone();
        self.spread(&mut steps, &mut Vec::new(), self.index(target), 0);
        steps
    }

    /// A field of [`Self::field`] in row order.
    pub fn field_steps<'a>(&'a self, field: &'a [u32]) -> impl Iterator<Item = Option<u32>> + 'a {
        let rows = field.chunks_exact(self.stride).skip(1).take(field.len() / self.stride - 2);
        rows.flat_map(|row| &row[1..=self.width]).map(|&steps| (steps < OBSTACLE).then_some(steps))
    }

    /// A shortest way as cells from `from` to `to`; `None` if there is none. Only what was touched is reset.
    pub fn path(&mut self, from: Cell, to: Cell) -> Option<Vec<Cell>> {
        let mut steps = std::mem::take(&mut self.steps);
        let mut queue = std::mem::take(&mut self.reached);
        if steps.is_empty() {
            steps.clone_from(&self.blank);
        }
        let (from, to) = (self.index(from), self.index(to));
        self.spread(&mut steps, &mut queue, to, from);
        let path = (steps[from] < OBSTACLE).then(|| {
            let mut at = from;
            let mut path = Vec::with_capacity(steps[from] as usize + 1);
            path.push(self.cell(at));
            while steps[at] > 0 {
                let nearer = steps[at] - 1;
                let around = [at - self.stride, at + 1, at + self.stride, at - 1];
                at = around.into_iter().find(|&cell| steps[cell] == nearer).expect("someone reached it");
                path.push(self.cell(at));
            }
            path
        });
        for &cell in &queue {
            steps[cell as usize] = UNKNOWN;
        }
        (self.steps, self.reached) = (steps, queue);
        path
    }

    /// How many steps from `from` to `to`.
    pub fn distance(&mut self, from: Cell, to: Cell) -> Option<u32> {
        self.path(from, to).map(|path| path.len() as u32 - 1)
    }
}
