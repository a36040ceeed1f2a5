//! Where things go: how many pixels a cell has, where the map lies on the page, how long the scale bar is.

use crate::font;
use crate::outline::Loop;
use crate::sample::Sampled;
use crate::scene::Point;
use activecell::{Cell, Lattice, Map, PointM};

/// The measures of one kind of picture, in pixels.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Style {
    /// The room for the map: across, down.
    pub(crate) room: [f64; 2],
    /// Maps that would become a thin strip may be so long, to have a short side of [`THIN`].
    pub(crate) longest: f64,
    /// Whether the map may grow a little beyond its room to have whole pixels for cells.
    pub(crate) may_exceed: bool,
    pub(crate) margin: f64,
    pub(crate) title_size: f64,
    /// Room between the title and the map.
    pub(crate) band: f64,
    pub(crate) text_size: f64,
    /// The least width of the map's column, for the title and the legend.
    pub(crate) least_width: f64,
    /// The title may widen the picture to this.
    pub(crate) title_width: f64,
    /// The least radius of the marks for start and target.
    pub(crate) least_mark: f64,
}

/// A still picture.
pub(crate) const STILL: Style = Style {
    room: [1100.0, 1100.0],
    longest: 2200.0,
    may_exceed: true,
    margin: 24.0,
    title_size: 17.0,
    band: 0.0,
    text_size: 14.0,
    least_width: 460.0,
    title_width: 760.0,
    least_mark: 9.0,
};

/// An animation, which stays below 720 pixels with its title and legend.
pub(crate) const MOVING: Style = Style {
    room: [688.0, 600.0],
    longest: 688.0,
    may_exceed: false,
    margin: 16.0,
    title_size: 14.0,
    band: 0.0,
    text_size: 12.0,
    least_width: 420.0,
    title_width: 560.0,
    least_mark: 8.0,
};

/// The largest cell, and the short side below which a map is a thin strip.
const LARGEST_CELL: f64 = 56.0;
const THIN: f64 = 120.0;
/// Hexagons smaller than this look like bricks, and are drawn as such: with fewer corners.
const LEAST_HEX: f64 = 3.0;

/// The map's place on the page.
#[derive(Debug, Clone)]
pub(crate) struct Layout {
    pub(crate) style: Style,
    /// Font size of the title.
    pub(crate) title_size: f64,
    pub(crate) lattice: Lattice,
    /// A cell from side to side.
    pub(crate) cell: f64,
    /// The lattice's units.
    unit: Point,
    /// Size of the mosaic's bounding box.
    pub(crate) map_size: Point,
    /// The map's top left corner.
    pub(crate) origin: Point,
    /// Width of the whole picture.
    pub(crate) width: f64,
}

impl Layout {
    pub(crate) fn new(map: &Map, title: &str, style: Style) -> Self {
        // The map's size in cells from side to side.
        let [across, down] = map.size_m().map(|metres| metres / map.frame().cell_m);
        let cell = cell_px(map.lattice(), [across, down], &style);
        let unit = map.lattice().unit_m();
        let map_size = [across * cell, down * cell];
        let full_width = font::width(title, style.title_size, true);
        let title_width = full_width.min(style.title_width);
        let column = map_size[0].max(style.least_width).max(title_width).ceil();
        // A title that is a little too long is set smaller; the rest is cut off.
        let title_size = style.title_size * (column / full_width.max(1.0)).clamp(0.8, 1.0);
        let left = style.margin + ((column - map_size[0]) / 2.0).floor();
        let top = style.margin + (style.title_size * 1.9).round() + style.band;
        Self {
            style,
            title_size,
            lattice: map.lattice(),
            cell,
            unit: [unit.0 * cell, unit.1 * cell],
            map_size,
            origin: [left, top],
            width: column + 2.0 * style.margin,
        }
    }

    /// The point of whole units of the lattice.
    pub(crate) fn point(&self, (x, y): (i64, i64)) -> Point {
        [self.origin[0] + x as f64 * self.unit[0], self.origin[1] + y as f64 * self.unit[1]]
    }

    /// The point of the floor, in metres.
    pub(crate) fn floor_point(&self, map: &Map, point_m: PointM) -> Point {
        let [x, y] = map.frame().to_mosaic(point_m);
        let px = self.cell / map.frame().cell_m;
        [self.origin[0] + x * px, self.origin[1] + (map.size_m()[1] - y) * px]
    }

    /// The point of the floor, in metres, at a point of the page.
    pub(crate) fn point_m(&self, map: &Map, [x, y]: Point) -> PointM {
        let metre = map.frame().cell_m / self.cell;
        map.frame().to_floor([(x - self.origin[0]) * metre, map.size_m()[1] - (y - self.origin[1]) * metre])
    }

    /// The middle of a cell.
    pub(crate) fn centre(&self, cell: Cell) -> Point {
        self.point(self.lattice.centre(cell))
    }

    /// The corners of a cell.
    pub(crate) fn corners(&self, cell: Cell) -> Vec<Point> {
        let (x, y) = self.lattice.centre(cell);
        self.lattice.corners().iter().map(|&(dx, dy)| self.point((x + dx, y + dy))).collect()
    }

    /// Loops of a sampled map's blocks, on the page.
    pub(crate) fn loops(&self, sampled: &Sampled<'_>, loops: &[Loop]) -> Vec<Vec<Point>> {
        let block = i64::from(sampled.block);
        // Two units are a row of squares, three a row of hexagons.
        let row = if self.lattice == Lattice::Hex { 1.5 } else { 1.0 };
        let bricks = self.lattice == Lattice::Hex && self.cell < LEAST_HEX;
        let place = |&(x, y): &(i64, i64)| {
            if block == 1 {
                // Both corners where two rows meet move to the middle between them.
                let down = if bricks { (y.div_euclid(3) * 3) as f64 + 0.5 } else { y as f64 };
                return [self.point((x, y))[0], self.origin[1] + down * self.unit[1]];
            }
            let across = ((x * block) as f64 * self.unit[0]).min(self.map_size[0]);
            let down = ((y * block) as f64 * self.unit[1] * row).min(self.map_size[1]);
            [self.origin[0] + across, self.origin[1] + down]
        };
        let run = |corners: &Loop| {
            let mut run: Vec<Point> = Vec::with_capacity(corners.len());
            for (i, corner) in corners.iter().enumerate() {
                let point = place(corner);
                let next = place(&corners[(i + 1) % corners.len()]);
                // A point between two of its own height is none.
                let level = |a: Point, b: Point| (a[1] - b[1]).abs() < 1e-9;
                let before = run.last().copied().or_else(|| corners.last().map(place));
                if !(bricks && before.is_some_and(|before| level(before, point)) && level(point, next)) {
                    run.push(point);
                }
            }
            run
        };
        loops.iter().map(run).collect()
    }

    /// The cell in which a pixel's middle lies, if any.
    pub(crate) fn cell_at(&self, x: u32, y: u32) -> Cell {
        let px = (f64::from(x) + 0.5 - self.origin[0]) / self.unit[0];
        let py = (f64::from(y) + 0.5 - self.origin[1]) / self.unit[1];
        match self.lattice {
            Lattice::Square => Cell::new((px / 2.0).floor() as i32, (py / 2.0).floor() as i32),
            Lattice::Hex => {
                let row = (py / 3.0).floor() as i32;
                let near = |row: i32| {
                    let column = ((px - f64::from(row & 1)) / 2.0).floor() as i32;
                    let cell = Cell::new(column, row);
                    let (cx, cy) = self.lattice.centre(cell);
                    let (dx, dy) = ((cx as f64 - px) * self.unit[0], (cy as f64 - py) * self.unit[1]);
                    (dx * dx + dy * dy, cell)
                };
                let (above, below) = (near(row - 1), near(row));
                if above.0 < below.0 { above.1 } else { below.1 }
            }
        }
    }
}

/// Pixels for a cell of a map of `across` × `down` cells.
fn cell_px(lattice: Lattice, [across, down]: Point, style: &Style) -> f64 {
    let (long, short) = (across.max(down), across.min(down));
    let mut cell = (style.room[0] / across).min(style.room[1] / down);
    if short * cell < THIN {
        cell = cell.max((THIN / short).min(style.longest / long));
    }
    // Whole pixels keep the edges of squares sharp, where they do not cost too much of the room.
    let whole = if style.may_exceed { cell.round() } else { cell.floor() };
    if lattice == Lattice::Square && cell >= 1.0 && whole > 0.8 * cell {
        cell = whole;
    }
    cell.min(LARGEST_CELL)
}

/// A round length (1, 2 or 5 times a power of ten) in metres near `metres`, and its label.
pub(crate) fn round_length(metres: f64) -> (f64, String) {
    let power = metres.log10().floor() as i32;
    let candidates = [power - 1, power, power + 1].into_iter().flat_map(|p| [(1, p), (2, p), (5, p)]);
    let ratio = |&(digit, p): &(i32, i32)| (f64::from(digit) * 10f64.powi(p) / metres).ln().abs();
    let (digit, power) = candidates.min_by(|a, b| ratio(a).total_cmp(&ratio(b))).unwrap_or((1, 0));
    // Powers of ten are built as text: no rounding shows.
    let (unit, shift) = match power {
        3.. => ("km", -3),
        0..3 => ("m", 0),
        -2..0 => ("cm", 2),
        -3 => ("mm", 3),
        _ => ("µm", 6),
    };
    let label = match power + shift {
        zeros @ 0.. => format!("{digit}{}", "0".repeat(zeros as usize)),
        tenths => format!("0.{}{digit}", "0".repeat((-tenths - 1) as usize)),
    };
    (f64::from(digit) * 10f64.powi(power), format!("{label} {unit}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_round() {
        let label = |metres| round_length(metres).1;
        assert_eq!(label(1.9), "2 m");
        assert_eq!(label(0.6), "50 cm");
        assert_eq!(label(0.011), "1 cm");
        assert_eq!(label(0.004), "5 mm");
        assert_eq!(label(180.0), "200 m");
        assert_eq!(label(4800.0), "5 km");
        assert_eq!(label(2e-5), "20 µm");
        assert!((round_length(0.6).0 - 0.5).abs() < 1e-12);
    }

    #[test]
    fn pixels_find_their_cell() {
        for lattice in Lattice::ALL {
            let map = Map::random(lattice, 9, 7, 0.0, 1).unwrap();
            let layout = Layout::new(&map, "", STILL);
            for cell in map.free() {
                let [x, y] = layout.centre(cell);
                for (dx, dy) in [(0.0, 0.0), (20.0, 0.0), (-12.0, 12.0), (0.0, -24.0)] {
                    assert_eq!(layout.cell_at((x + dx) as u32, (y + dy) as u32), cell, "{lattice}");
                }
            }
        }
    }
}
