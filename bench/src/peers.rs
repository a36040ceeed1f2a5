//! The peers in Rust: the crates `pathfinding` and `grid_pathfinding`, called as their documents show.

use crate::cases::Case;
use crate::measure::{Fields, Paths, same_field};
use crate::queue::Queue;
use activecell::{Cell, Map};
use anyhow::Result;
use grid_pathfinding::PathingGrid;
use grid_util::grid::ValueGrid;
use grid_util::point::Point;
use pathfinding::prelude::{astar, bfs_bidirectional, bfs_reach, dijkstra_all};
use std::collections::HashMap;
use std::hash::{Hash, Hasher};

impl Paths for Queue {
    type Answer = Option<Vec<Cell>>;
    fn find(&mut self, from: Cell, to: Cell) -> Self::Answer {
        self.path(from, to)
    }
    fn steps(&self, _: Cell, _: Cell, answer: &Self::Answer) -> Result<Option<u32>> {
        Ok(answer.as_ref().map(|path| path.len() as u32 - 1))
    }
}

impl Fields for Queue {
    type Answer = Vec<u32>;
    fn field(&mut self, target: Cell) -> Vec<u32> {
        Self::field(self, target)
    }
    fn check(&self, case: &Case, answer: &Vec<u32>) -> Result<()> {
        same_field(case, self.field_steps(answer))
    }
}

type Node = (u16, u16);

/// A map in bytes, the node's neighbours without allocation.
pub struct Grid {
    width: u16,
    height: u16,
    free: Vec<bool>,
}

impl Grid {
    pub fn new(map: &Map) -> Self {
        let mut free = vec![false; map.cells()];
        for cell in map.free() {
            free[cell.y as usize * map.width() as usize + cell.x as usize] = true;
        }
        Self { width: map.width() as u16, height: map.height() as u16, free }
    }

    fn around(&self, (x, y): Node) -> impl Iterator<Item = Node> + use<> {
        let node = |inside: bool, x: u16, y: u16| {
            (inside && self.free[usize::from(y) * usize::from(self.width) + usize::from(x)]).then_some((x, y))
        };
        [
            node(y > 0, x, y.wrapping_sub(1)),
            node(x + 1 < self.width, x + 1, y),
            node(y + 1 < self.height, x, y + 1),
            node(x > 0, x.wrapping_sub(1), y),
        ]
        .into_iter()
        .flatten()
    }
}

fn node(cell: Cell) -> Node {
    (cell.x as u16, cell.y as u16)
}

/// `pathfinding::astar` with the Manhattan distance.
pub struct Astar(pub Grid);

impl Paths for Astar {
    type Answer = Option<(Vec<Node>, u32)>;
    fn find(&mut self, from: Cell, to: Cell) -> Self::Answer {
        let to = node(to);
        astar(
            &node(from),
            |&at| self.0.around(at).map(|next| (next, 1)),
            |&(x, y)| u32::from(x.abs_diff(to.0)) + u32::from(y.abs_diff(to.1)),
            |&at| at == to,
        )
    }
    fn steps(&self, _: Cell, _: Cell, answer: &Self::Answer) -> Result<Option<u32>> {
        Ok(answer.as_ref().map(|(path, _)| path.len() as u32 - 1))
    }
}

/// `pathfinding::bfs_bidirectional`.
pub struct Bidirectional(pub Grid);

impl Paths for Bidirectional {
    type Answer = Option<Vec<Node>>;
    fn find(&mut self, from: Cell, to: Cell) -> Self::Answer {
        bfs_bidirectional(&node(from), &node(to), |&at| self.0.around(at), |&at| self.0.around(at))
    }
    fn steps(&self, _: Cell, _: Cell, answer: &Self::Answer) -> Result<Option<u32>> {
        Ok(answer.as_ref().map(|path| path.len() as u32 - 1))
    }
}

/// A node that remembers its distance; breadth-first order makes the first one right.
#[derive(Clone, Copy)]
pub struct Far(Node, u32);

impl PartialEq for Far {
    fn eq(&self, other: &Self) -> bool {
        self.0 == other.0
    }
}
impl Eq for Far {}
impl Hash for Far {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.0.hash(state);
    }
}

/// `pathfinding::bfs_reach`, written into a plane of distances.
pub struct Reach(pub Grid);

impl Fields for Reach {
    type Answer = Vec<u32>;
    fn field(&mut self, target: Cell) -> Vec<u32> {
        let mut steps = vec![u32::MAX; self.0.free.len()];
        let width = usize::from(self.0.width);
        let around = |&Far(at, far): &Far| self.0.around(at).map(move |next| Far(next, far + 1));
        for Far((x, y), far) in bfs_reach(Far(node(target), 0), around) {
            steps[usize::from(y) * width + usize::from(x)] = far;
        }
        steps
    }
    fn check(&self, case: &Case, answer: &Vec<u32>) -> Result<()> {
        same_field(case, answer.iter().map(|&steps| (steps != u32::MAX).then_some(steps)))
    }
}

/// `pathfinding::dijkstra_all`; its answer is a hash map of parents and costs without the target.
pub struct DijkstraAll(pub Grid);

impl Fields for DijkstraAll {
    type Answer = (Node, HashMap<Node, (Node, u32)>);
    fn field(&mut self, target: Cell) -> Self::Answer {
        let target = node(target);
        (target, dijkstra_all(&target, |&at| self.0.around(at).map(|next| (next, 1u32))))
    }
    fn check(&self, case: &Case, (target, costs): &Self::Answer) -> Result<()> {
        let nodes = (0..self.0.height).flat_map(|y| (0..self.0.width).map(move |x| (x, y)));
        let steps = |at: Node| if at == *target { Some(0) } else { costs.get(&at).map(|&(_, cost)| cost) };
        same_field(case, nodes.map(steps))
    }
}

/// `grid_pathfinding`: jump point search with four neighbours.
pub struct Jps(PathingGrid);

impl Jps {
    pub fn new(map: &Map) -> Self {
        let mut grid = PathingGrid::new(map.width() as usize, map.height() as usize, false);
        grid.allow_diagonal_move = false;
        for y in 0..map.height() {
            for x in 0..map.width() {
                if map.obstacles().get(x, y) {
                    grid.set(x as i32, y as i32, true);
                }
            }
        }
        grid.generate_components();
        Self(grid)
    }
}

impl Paths for Jps {
    type Answer = Option<Vec<Point>>;
    fn find(&mut self, from: Cell, to: Cell) -> Self::Answer {
        self.0.get_path_single_goal(Point::new(from.x, from.y), Point::new(to.x, to.y), false)
    }
    fn steps(&self, _: Cell, _: Cell, answer: &Self::Answer) -> Result<Option<u32>> {
        Ok(answer.as_ref().map(|path| path.len() as u32 - 1))
    }
}
