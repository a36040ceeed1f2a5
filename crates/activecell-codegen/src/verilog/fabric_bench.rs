//! The bench of the fabric: its clocks, and what the model shows at each.

use crate::SourceFile;
use crate::images::bits_below;
use crate::model::fabric::{Fabric, Inputs};
use crate::template::fill;
use activecell::{Cell, Map, Rng};

/// Tasks between free cells on a map.
const TASKS: usize = 20;

/// The bench and its clocks.
pub(super) fn bench(map: &Map, loadable: bool) -> [SourceFile; 2] {
    let (trace, clocks) = trace(map, loadable);
    let loading = "        .load_map(line[78]),\n        .scan_in(line[77]),\n        .scan_out(),\n";
    let [columns, rows] = [map.width(), map.height()].map(bits_below);
    let values = [
        ("CLOCKS", clocks.to_string()),
        ("COLUMN_BITS", columns.to_string()),
        ("COLUMN_TOP", (columns - 1).to_string()),
        ("ROW_BITS", rows.to_string()),
        ("ROW_TOP", (rows - 1).to_string()),
        ("LOADING", if loadable { loading.into() } else { String::new() }),
    ];
    [SourceFile::new("tb/fabric_tb.v", fill(include_str!("templates/fabric_tb.v"), &values)), trace]
}

/// What the benches of both languages read, and its clocks: tasks between free cells, one that cannot be, one cut short; a loadable fabric
/// begins without a map, and does the same on an empty map after that, which it loads while it is at a task.
pub(crate) fn trace(map: &Map, loadable: bool) -> (SourceFile, usize) {
    let fabric = if loadable { Fabric::unloaded(map) } else { Fabric::new(map) };
    let mut clocks = Clocks { fabric, lines: String::new(), count: 0 };
    for _ in 0..2 {
        clocks.clock(Inputs { reset: true, ..Inputs::default() });
    }
    let free: Vec<Cell> = map.free().collect();
    if loadable {
        let cell = free.first().copied().unwrap_or_default();
        clocks.begin(cell, cell);
        clocks.wait();
        clocks.load(|x, y| map.obstacles().get(x, y), map);
    }
    clocks.tasks(&free, map);
    if loadable {
        clocks.load(|_, _| false, map);
        clocks.tasks(&free, map);
    }
    (SourceFile::new("tb/fabric.hex", clocks.lines), clocks.count)
}

struct Clocks {
    fabric: Fabric,
    lines: String,
    count: usize,
}

impl Clocks {
    /// A line as the bench reads it; gives whether the task goes on.
    fn clock(&mut self, inputs: Inputs) -> bool {
        let shown = self.fabric.clock(inputs);
        let digit = |bits: [bool; 4]| bits.iter().fold(0, |sum, &bit| sum << 1 | u8::from(bit));
        let (from, to) = inputs.begin.unwrap_or_default();
        self.lines += &format!(
            "{:x}_{:03x}_{:03x}_{:03x}_{:03x}_{:x}_{:03x}_{:03x}\n",
            digit([inputs.reset, inputs.load.is_some(), inputs.load == Some(true), inputs.begin.is_some()]),
            from.x,
            from.y,
            to.x,
            to.y,
            digit([shown.busy, shown.moving, shown.arrived, shown.unreachable]),
            shown.at.x,
            shown.at.y,
        );
        self.count += 1;
        shown.busy
    }

    /// Waits for the end of the task, if one is being done.
    fn wait(&mut self) {
        while self.clock(Inputs::default()) {}
    }

    fn load(&mut self, is_obstacle: impl Fn(u32, u32) -> bool, map: &Map) {
        for (x, y) in (0..map.height()).flat_map(|y| (0..map.width()).map(move |x| (x, y))) {
            self.clock(Inputs { load: Some(is_obstacle(x, y)), ..Inputs::default() });
        }
    }

    fn begin(&mut self, from: Cell, to: Cell) -> bool {
        self.clock(Inputs { begin: Some((from, to)), ..Inputs::default() })
    }

    fn tasks(&mut self, free: &[Cell], map: &Map) {
        let mut rng = Rng::new(1);
        let mut any = || Cell::new(rng.below(map.width()) as i32, rng.below(map.height()) as i32);
        let mut ends = vec![(any(), any())];
        let mut end = || free.get(rng.below(free.len().max(1) as u32) as usize).copied().unwrap_or_default();
        ends.extend((0..TASKS).map(|_| (end(), end())));
        for (from, to) in ends {
            self.begin(from, to);
            self.wait();
        }
        // A task that another cuts short, when its wave has begun and when the robot is on its way.
        for clocks in [1, map.width() + map.height()] {
            self.begin(end(), end());
            (0..clocks).for_each(|_| _ = self.clock(Inputs::default()));
            self.begin(end(), end());
            self.wait();
        }
        // One that a reset cuts short, which also wins against the beginning of another.
        self.begin(end(), end());
        (0..8).for_each(|_| _ = self.clock(Inputs::default()));
        self.clock(Inputs { reset: true, begin: Some((end(), end())), ..Inputs::default() });
        // One that is not done when loading begins.
        self.begin(end(), end());
        (0..8).for_each(|_| _ = self.clock(Inputs::default()));
    }
}
