//! Our methods: the one place that calls `activecell`. When the core learns a faster way, switch it here.

use crate::cases::Case;
use crate::measure::{Fields, Paths, same_field};
use activecell::{Cell, Field, Map, check_route};
use anyhow::{Result, anyhow};

/// One start, one target.
pub struct Search {
    search: activecell::Search,
    map: Map,
}

impl Search {
    pub fn new(map: &Map) -> Self {
        Self { search: activecell::Search::new(map), map: map.clone() }
    }
}

impl Paths for Search {
    type Answer = Result<Option<Vec<Cell>>, activecell::Error>;

    fn find(&mut self, from: Cell, to: Cell) -> Self::Answer {
        self.search.path(from, to)
    }

    fn steps(&self, from: Cell, to: Cell, answer: &Self::Answer) -> Result<Option<u32>> {
        let Some(cells) = answer.as_ref().map_err(|error| anyhow!("{error}"))? else { return Ok(None) };
        check_route(&self.map, cells, from, to)?;
        Ok(Some(cells.len() as u32 - 1))
    }
}

/// The full field: the distance of every cell.
pub struct Wave(pub Map);

impl Fields for Wave {
    type Answer = Field;

    fn field(&mut self, target: Cell) -> Field {
        self.0.wave(target).expect("the case's target is free")
    }

    fn check(&self, case: &Case, answer: &Field) -> Result<()> {
        same_field(case, row_order(case).map(|cell| answer.steps(cell)))
    }
}

/// The compact field: which way is nearer, and no more. It is compared by walking: from cells all over the map
/// the way must be as long as the plain queue's.
pub struct Compact(pub Map);

impl Fields for Compact {
    type Answer = activecell::CompactField;

    fn field(&mut self, target: Cell) -> Self::Answer {
        self.0.compact_wave(&[target]).expect("the case's target is free")
    }

    fn check(&self, case: &Case, answer: &Self::Answer) -> Result<()> {
        let queue = crate::queue::Queue::new(&self.0);
        let field = queue.field(case.target());
        let wanted: Vec<Option<u32>> = queue.field_steps(&field).collect();
        for (cell, wanted) in row_order(case).zip(wanted).step_by(case.free.div_ceil(500) | 1) {
            let walked = std::iter::successors(Some(cell), |&at| {
                answer.next(at).map(|dir| self.0.lattice().neighbour(at, dir))
            });
            let found = answer.is_reached(cell).then(|| walked.count() as u32 - 1);
            anyhow::ensure!(
                found == wanted || !self.0.is_free(cell),
                "from {cell}: {found:?}, not {wanted:?}"
            );
        }
        Ok(())
    }
}

/// Which cells the wave reaches, and no more.
pub struct Reachable(pub Map);

impl Fields for Reachable {
    type Answer = activecell::BitPlane;

    fn field(&mut self, target: Cell) -> Self::Answer {
        self.0.reachable(&[target]).expect("the case's target is free")
    }

    fn check(&self, case: &Case, answer: &Self::Answer) -> Result<()> {
        let reached = answer.count_ones();
        anyhow::ensure!(reached == case.field.reached, "{reached} cells, not {}", case.field.reached);
        Ok(())
    }
}

fn row_order(case: &Case) -> impl Iterator<Item = Cell> {
    let (width, height) = (case.width as i32, case.height as i32);
    (0..height).flat_map(move |y| (0..width).map(move |x| Cell::new(x, y)))
}

/// A field that is repaired when cells change.
pub struct Live(activecell::LiveField);

impl Live {
    pub fn new(map: &Map, target: Cell) -> Self {
        Self(activecell::LiveField::new(map, target).expect("the case's target is free"))
    }

    pub fn set(&mut self, cell: Cell, blocked: bool) {
        self.0.set(cell, blocked);
    }

    pub fn steps(&self, cell: Cell) -> Option<u32> {
        self.0.steps(cell)
    }
}
