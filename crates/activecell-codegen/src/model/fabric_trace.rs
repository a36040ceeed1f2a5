//! What a fabric does with tasks at random, for test benches that check themselves.

use super::fabric::{Fabric, Inputs, Outputs};
use activecell::{Cell, Map, Rng};

/// A trace has no more clocks than these, so that a simulation ends in good time.
const CLOCKS_MAX: usize = 1 << 13;
/// Nor more tasks.
const TASKS: u32 = 48;

/// For each clock what the fabric of that map is told, and what it shows after it: after a reset, and after the map was
/// loaded if it is to be, tasks between any cells, of which some are broken off by another, by a reset, or by cells that
/// move the map on.
///
/// ```
/// use activecell::{Lattice, Map};
/// use activecell_codegen::model::fabric_trace::trace;
/// let trace = trace(&Map::parse(Lattice::Square, "...")?, false, 1);
/// assert!(trace.iter().any(|(_, outputs)| outputs.arrived));
/// # Ok::<(), activecell::Error>(())
/// ```
pub fn trace(map: &Map, loadable: bool, seed: u64) -> Vec<(Inputs, Outputs)> {
    let mut rng = Rng::new(seed);
    let mut fabric = Fabric::new(map);
    let mut clocks = Vec::new();
    let mut clock = |inputs: Inputs| {
        let outputs = fabric.clock(inputs);
        clocks.push((inputs, outputs));
        outputs.busy && clocks.len() < CLOCKS_MAX
    };
    let reset = Inputs { reset: true, ..Inputs::default() };
    let load = |obstacle: bool| Inputs { load: Some(obstacle), ..Inputs::default() };
    let cells = (0..map.height()).flat_map(|y| (0..map.width()).map(move |x| Cell::new(x as i32, y as i32)));
    clock(reset);
    for cell in cells.filter(|_| loadable) {
        clock(load(!map.is_free(cell)));
    }
    for task in 0..TASKS {
        let [from, to] =
            [(); 2].map(|()| Cell::new(rng.below(map.width()) as i32, rng.below(map.height()) as i32));
        let mut is_busy = clock(Inputs { begin: Some((from, to)), ..Inputs::default() });
        let mut left = if task % 8 == 7 { rng.below(12) } else { u32::MAX };
        while is_busy && left > 0 {
            is_busy = clock(Inputs::default());
            left -= 1;
        }
        match task % 24 {
            7 => _ = clock(reset),
            15 if loadable => (0..3).for_each(|_| _ = clock(load(rng.below(4) == 0))),
            // What is shown stays.
            _ => _ = clock(Inputs::default()),
        }
    }
    clocks
}
