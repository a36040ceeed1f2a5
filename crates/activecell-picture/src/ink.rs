//! The robots' colours: a wheel of hues, and how much of each a pixel has.
//!
//! The hues lie on a circle in Björn Ottosson's `OKLab` (*A perceptual color space for image processing*, 2020), yellow
//! lighter than blue, as eyes see them: so they differ in lightness too.

use crate::colour::{FLOOR, Rgb};
use crate::palette::Palette;
use activecell::{Cell, Map};

/// Hues around the wheel.
pub(crate) const HUES: usize = 20;
/// From no ink to all of it in so many levels.
pub(crate) const LEVELS: usize = 6;

/// A hue of the wheel.
pub(crate) fn hue(number: u8) -> Rgb {
    let turn = f64::from(number) / HUES as f64 * std::f64::consts::TAU;
    // Yellow lies at 110°.
    let light = 0.66 + 0.1 * (turn - 1.92).cos();
    oklch(light, 0.165, turn)
}

/// A hue of which a pixel has so much, 1 to [`LEVELS`].
pub(crate) fn tint(number: u8, level: usize) -> Rgb {
    FLOOR.mix(hue(number), level as f64 / LEVELS as f64)
}

/// The hue of each target, by the direction in which it lies from the middle of them all: each hue is used as often as
/// any other, and at the end the map is a wheel of colours.
pub(crate) fn hues(map: &Map, targets: &[Cell]) -> Vec<u8> {
    let points: Vec<_> = targets.iter().map(|&cell| map.centre_m(cell)).collect();
    let mean = |axis: usize, value: &dyn Fn(f64) -> f64| {
        points.iter().map(|point| value(point[axis])).sum::<f64>() / points.len().max(1) as f64
    };
    let middle = [0, 1].map(|axis| mean(axis, &|at| at));
    // Long maps are looked at as if they were as wide as high.
    let spread = [0, 1].map(|axis| mean(axis, &|at| (at - middle[axis]).abs()).max(1e-9));
    let angle = |robot: usize| {
        let [x, y] = [0, 1].map(|axis| (points[robot][axis] - middle[axis]) / spread[axis]);
        y.atan2(x)
    };
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| angle(a).total_cmp(&angle(b)).then(a.cmp(&b)));
    let mut hues = vec![0; points.len()];
    for (rank, robot) in order.into_iter().enumerate() {
        hues[robot] = (rank * HUES / points.len()) as u8;
    }
    hues
}

/// The numbers that all inks have in a palette.
pub(crate) struct Inks {
    numbers: [[u8; LEVELS]; HUES],
    /// How much ink each number means; 0 for what is no ink.
    levels: [u8; 256],
}

impl Inks {
    /// Every tint, for a palette.
    pub(crate) fn colours() -> impl Iterator<Item = Rgb> {
        (0..HUES as u8).flat_map(|hue| (1..=LEVELS).map(move |level| tint(hue, level)))
    }

    pub(crate) fn new(palette: &mut Palette) -> Self {
        let mut inks = Self { numbers: [[0; LEVELS]; HUES], levels: [0; 256] };
        for hue in 0..HUES {
            for level in 1..=LEVELS {
                let number = palette.nearest(tint(hue as u8, level));
                inks.numbers[hue][level - 1] = number;
                inks.levels[usize::from(number)] = level as u8;
            }
        }
        inks
    }

    /// Puts so much of an ink, 0 to 1, on a pixel, unless more is there already.
    pub(crate) fn put(&self, pixel: &mut u8, hue: u8, share: f64) {
        let level = (share * LEVELS as f64).round() as u8;
        if level > 0 && level >= self.levels[usize::from(*pixel)] {
            *pixel = self.numbers[usize::from(hue)][usize::from(level) - 1];
        }
    }
}

/// A colour of this lightness, strength and hue, cut off where a screen cannot show it.
fn oklch(light: f64, chroma: f64, hue_rad: f64) -> Rgb {
    let (a, b) = (chroma * hue_rad.cos(), chroma * hue_rad.sin());
    let l = (light + 0.396_337_777_4 * a + 0.215_803_757_3 * b).powi(3);
    let m = (light - 0.105_561_345_8 * a - 0.063_854_172_8 * b).powi(3);
    let s = (light - 0.089_484_177_5 * a - 1.291_485_548 * b).powi(3);
    let channel = |linear: f64| {
        let linear = linear.clamp(0.0, 1.0);
        let value =
            if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
        (255.0 * value).round() as u8
    };
    Rgb(
        channel(4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s),
        channel(-1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s),
        channel(-0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701 * s),
    )
}
