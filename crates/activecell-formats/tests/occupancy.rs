//! The rules of the map servers, against a twin that computes binary floating point with whole numbers alone.
#![allow(clippy::unwrap_used)] // A test may panic.

use activecell::{Frame, Lattice, Map};
use activecell_formats::raster::{Channels, Image};
use activecell_formats::ros::{MapYaml, Mode, Reading, Rules, from_map, occupancy, to_map};
use std::cmp::Ordering;

/// A number ≥ 0, mantissa · 2^exponent, rounded to `BITS` bits as IEEE 754 does (half to even).
#[derive(Clone, Copy, Debug)]
struct Soft<const BITS: u32> {
    mantissa: u128,
    exponent: i32,
}

impl<const BITS: u32> Soft<BITS> {
    /// `more` tells that a little was cut off below the last bit.
    fn rounded(mut mantissa: u128, mut exponent: i32, more: bool) -> Self {
        let length = 128 - mantissa.leading_zeros();
        if length > BITS {
            let drop = length - BITS;
            let (half, rest) = (1 << (drop - 1), mantissa & ((1 << drop) - 1));
            mantissa >>= drop;
            exponent += drop as i32;
            if rest > half || rest == half && (more || mantissa % 2 == 1) {
                mantissa += 1;
            }
        }
        Self { mantissa, exponent }
    }

    fn whole(value: u64) -> Self {
        Self::rounded(value.into(), 0, false)
    }

    fn of_other<const OTHER: u32>(other: Soft<OTHER>) -> Self {
        Self::rounded(other.mantissa, other.exponent, false)
    }

    fn over(self, other: Self) -> Self {
        if self.mantissa == 0 {
            return self;
        }
        let shift = self.mantissa.leading_zeros();
        let dividend = self.mantissa << shift;
        let exponent = self.exponent - shift as i32 - other.exponent;
        Self::rounded(dividend / other.mantissa, exponent, !dividend.is_multiple_of(other.mantissa))
    }

    fn times(self, other: Self) -> Self {
        Self::rounded(self.mantissa * other.mantissa, self.exponent + other.exponent, false)
    }

    /// Both with the smaller exponent.
    fn aligned(self, other: Self) -> (u128, u128, i32) {
        let exponent = self.exponent.min(other.exponent);
        let shifted = |number: Self| {
            if number.mantissa == 0 {
                return 0;
            }
            let shift = (number.exponent - exponent) as u32;
            assert!(shift < number.mantissa.leading_zeros(), "the twin's range");
            number.mantissa << shift
        };
        (shifted(self), shifted(other), exponent)
    }

    /// Never below 0 here.
    fn minus(self, other: Self) -> Self {
        let (a, b, exponent) = self.aligned(other);
        Self::rounded(a - b, exponent, false)
    }

    fn cmp(self, other: Self) -> Ordering {
        let (a, b, _) = self.aligned(other);
        a.cmp(&b)
    }

    /// To the nearest whole number; a half to the even one, or up.
    fn nearest(self, half_to_even: bool) -> i8 {
        if self.exponent >= 0 || self.mantissa == 0 {
            return (self.mantissa << self.exponent.max(0)) as i8;
        }
        let (whole, rest, half) = match self.exponent.unsigned_abs() {
            shift @ 0..=127 => (self.mantissa >> shift, self.mantissa & ((1 << shift) - 1), 1 << (shift - 1)),
            _ => (0, 0, 1),
        };
        let up = rest > half || rest == half && (!half_to_even || whole % 2 == 1);
        whole as i8 + i8::from(up)
    }
}

/// Thresholds in thousandths.
#[derive(Clone, Copy, Debug)]
struct Case {
    mode: Mode,
    negate: bool,
    occupied: u64,
    free: u64,
}

fn twin_f64(gray: u64, case: Case) -> i8 {
    type F = Soft<53>;
    // The mean of three equal values is the value.
    let shade = F::whole(gray).over(F::whole(255));
    let value = if case.negate { shade } else { F::whole(1).minus(shade) };
    let threshold = |thousandths| F::whole(thousandths).over(F::whole(1000));
    let (occupied, free) = (threshold(case.occupied), threshold(case.free));
    match case.mode {
        Mode::Raw => {
            if gray <= 100 {
                gray as i8
            } else {
                -1
            }
        }
        _ if value.cmp(occupied) == Ordering::Greater => 100,
        _ if value.cmp(free) == Ordering::Less => 0,
        Mode::Trinary => -1,
        Mode::Scale => value.minus(free).over(occupied.minus(free)).times(F::whole(100)).nearest(true),
    }
}

fn twin_f32(gray: u64, case: Case) -> i8 {
    type F = Soft<24>;
    let shade = F::whole(gray).over(F::whole(255));
    let value = if case.negate { shade } else { F::whole(1).minus(shade) };
    // The file's number is double, then cut to single.
    let threshold = |thousandths| F::of_other(Soft::<53>::whole(thousandths).over(Soft::whole(1000)));
    let (occupied, free) = (threshold(case.occupied), threshold(case.free));
    match case.mode {
        Mode::Raw => {
            if gray <= 100 {
                gray as i8
            } else {
                -1
            }
        }
        _ if value.cmp(occupied) != Ordering::Less => 100,
        _ if value.cmp(free) != Ordering::Greater => 0,
        Mode::Trinary => -1,
        Mode::Scale => value.minus(free).over(occupied.minus(free)).times(F::whole(100)).nearest(false),
    }
}

fn gray_image() -> Image {
    Image::new(256, 1, Channels::Gray, (0..=255).collect()).unwrap()
}

fn yaml(case: Case) -> MapYaml {
    MapYaml {
        mode: case.mode,
        negate: case.negate,
        occupied_thresh: case.occupied as f64 / 1000.0,
        free_thresh: case.free as f64 / 1000.0,
        ..MapYaml::default()
    }
}

#[test]
fn every_gray_equals_the_twin() {
    let image = gray_image();
    // 200 and 400, 600, 800 are themselves levels of gray: the comparisons at equality count there.
    let thresholds = [
        (650, 196),
        (650, 250),
        (650, 200),
        (800, 200),
        (600, 400),
        (900, 0),
        (1000, 100),
        (501, 500),
        (1000, 999),
        (1, 0),
    ];
    let mut compared = 0;
    for mode in [Mode::Trinary, Mode::Scale, Mode::Raw] {
        for negate in [false, true] {
            for (occupied, free) in thresholds {
                let case = Case { mode, negate, occupied, free };
                let (humble, jazzy) = (
                    occupancy(&image, &yaml(case), Rules::Humble),
                    occupancy(&image, &yaml(case), Rules::Jazzy),
                );
                for gray in 0..256 {
                    assert_eq!(humble[gray], twin_f64(gray as u64, case), "Humble {gray} {case:?}");
                    assert_eq!(jazzy[gray], twin_f32(gray as u64, case), "Jazzy {gray} {case:?}");
                    compared += 2;
                }
            }
        }
    }
    assert_eq!(compared, 3 * 2 * 10 * 256 * 2);
}

#[test]
fn gray_205_is_unknown_or_free_by_the_threshold() {
    let image = Image::new(1, 1, Channels::Gray, vec![205]).unwrap();
    for rules in [Rules::Humble, Rules::Jazzy] {
        for (free, expected) in [(196, -1), (250, 0)] {
            let case = Case { mode: Mode::Trinary, negate: false, occupied: 650, free };
            assert_eq!(occupancy(&image, &yaml(case), rules), [expected], "{rules:?} {free}");
        }
    }
}

#[test]
fn the_rules_part_where_a_gray_lies_on_a_threshold() {
    // Level 204 is 0.2 exactly in the free direction, level 51 is 0.8.
    let image = Image::new(2, 1, Channels::Gray, vec![204, 51]).unwrap();
    let case = Case { mode: Mode::Trinary, negate: true, occupied: 800, free: 200 };
    assert_eq!(occupancy(&image, &yaml(case), Rules::Humble), [-1, -1]);
    assert_eq!(occupancy(&image, &yaml(case), Rules::Jazzy), [100, 0]);
}

/// The thresholds that Nav2 takes where it saves a map.
fn nav2() -> MapYaml {
    MapYaml { free_thresh: 0.25, ..MapYaml::default() }
}

#[test]
fn colours() {
    // (red, green, blue) → Humble and Jazzy, thresholds 0.65 and 0.25.
    let table = [
        ([255, 0, 0], 100, 100),
        ([0, 255, 0], 100, -1),
        ([255, 255, 0], -1, 0),
        ([255, 255, 255], 0, 0),
        ([128, 128, 128], -1, -1),
        ([0, 255, 255], -1, -1),
    ];
    for (colour, humble, jazzy) in table {
        let image = Image::new(1, 1, Channels::Rgb, colour.to_vec()).unwrap();
        assert_eq!(occupancy(&image, &nav2(), Rules::Humble), [humble], "{colour:?}");
        assert_eq!(occupancy(&image, &nav2(), Rules::Jazzy), [jazzy], "{colour:?}");
    }
}

#[test]
fn brightness_equals_whole_numbers() {
    let step = 5;
    let samples: Vec<u8> = (0..=255 / step)
        .flat_map(|r| {
            (0..=255 / step)
                .flat_map(move |g| (0..=255 / step).flat_map(move |b| [r, g, b].map(|v| v * step)))
        })
        .collect();
    let pixels = samples.len() / 3;
    let image = Image::new(pixels as u32, 1, Channels::Rgb, samples).unwrap();
    for (pixel, gray) in image.pixels().zip(image.grays()) {
        let [r, g, b] = [0, 1, 2].map(|i| u64::from(pixel[i]));
        let expected = (257 * (299 * r + 587 * g + 114 * b) + 500) / 1000 / 257;
        assert_eq!(u64::from(gray), expected, "{pixel:?}");
    }
}

#[test]
fn opacity() {
    use Channels::{GrayAlpha, Rgba};
    use Mode::{Raw, Scale, Trinary};
    use Rules::{Humble, Jazzy};
    let of = |channels, pixel: &[u8], mode, rules| {
        let image = Image::new(1, 1, channels, pixel.to_vec()).unwrap();
        occupancy(&image, &MapYaml { mode, ..nav2() }, rules)[0]
    };
    for (channels, pixel, mode, humble, jazzy) in [
        // The mean of four: black and opaque is 0.75 occupied, black and transparent 1.
        (Rgba, &[0, 0, 0, 255][..], Trinary, 100, 100),
        (Rgba, &[0, 0, 0, 0], Trinary, 100, -1),
        (Rgba, &[255, 255, 255, 255], Trinary, 0, 0),
        (Rgba, &[255, 255, 255, 0], Trinary, -1, -1),
        (Rgba, &[100, 100, 100, 255], Trinary, -1, -1),
        (Rgba, &[60, 60, 60, 255], Trinary, -1, 100),
        (Rgba, &[255, 255, 255, 254], Scale, -1, -1),
        (Rgba, &[255, 255, 255, 255], Scale, 0, 0),
        (Rgba, &[50, 50, 50, 0], Raw, 50, 50),
        // Beside gray alone, opacity is seen by Jazzy only.
        (GrayAlpha, &[0, 0], Trinary, 100, -1),
        (GrayAlpha, &[255, 254], Scale, 0, -1),
        (GrayAlpha, &[255, 255], Trinary, 0, 0),
        (GrayAlpha, &[101, 0], Raw, -1, -1),
    ] {
        assert_eq!(of(channels, pixel, mode, Humble), humble, "Humble {pixel:?} {mode:?}");
        assert_eq!(of(channels, pixel, mode, Jazzy), jazzy, "Jazzy {pixel:?} {mode:?}");
    }
}

#[test]
fn reading_decides_what_is_an_obstacle() {
    // Raw: 0, 64, 65, 100, and unknown.
    let image = Image::new(5, 1, Channels::Gray, vec![0, 64, 65, 100, 255]).unwrap();
    let yaml = MapYaml { mode: Mode::Raw, ..MapYaml::default() };
    for (unknown_is_free, occupied_from, expected) in [
        (false, 65, "..###\n"),
        (true, 65, "..##.\n"),
        (true, 1, ".###.\n"),
        (false, 100, "...##\n"),
        (true, 101, ".....\n"),
    ] {
        let reading = Reading { unknown_is_free, occupied_from, ..Reading::default() };
        assert_eq!(to_map(&image, &yaml, &reading).unwrap().to_text(), expected);
    }
}

#[test]
fn maps_round_trip_under_all_rules() {
    for seed in 0..20 {
        let frame = Frame { cell_m: 0.1 / 3.0, origin_m: [-1.234_567_8, 1e-9], yaw_rad: 0.1 };
        let map = Map::random(Lattice::Square, 70, 9, 0.4, seed).unwrap().in_frame(frame).unwrap();
        let (yaml, image) = from_map(&map).unwrap();
        for rules in [Rules::Humble, Rules::Jazzy] {
            for unknown_is_free in [false, true] {
                let reading = Reading { rules, unknown_is_free, ..Reading::default() };
                assert_eq!(to_map(&image, &yaml, &reading).unwrap(), map);
            }
        }
    }
    let hexagons = Map::parse(Lattice::Hex, "..").unwrap();
    assert_eq!(
        from_map(&hexagons).unwrap_err().to_string(),
        "a ROS map has square cells, this map has hexagons; write it as .txt or .map, or re-tile it"
    );
}

#[test]
fn a_frame_without_sense_is_refused() {
    let yaml = MapYaml { resolution_m: f64::NAN, ..MapYaml::default() };
    let error = to_map(&gray_image(), &yaml, &Reading::default()).unwrap_err().to_string();
    assert_eq!(error, "the cell size in metres is NaN; it must be between 0.000001 and 1000000");
}
