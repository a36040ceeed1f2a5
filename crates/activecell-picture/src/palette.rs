//! The palette of animations: 256 colours made of the pictures' own colours and their blends.

use crate::colour::{
    BLUE, BLUE_TINT, CLOSED, EDGE, FLOOR, GREEN, GRID, OBSTACLE, ORANGE, ORANGE_RIM, PAGE, PURPLE,
    PURPLE_TINT, Rgb, TEXT, VERMILLION, YELLOW, height, wave,
};
use tiny_skia::Pixmap;

/// The tints of the wave in an animation.
pub(crate) const WAVE_TINTS: u32 = 20;

/// Number of the colour that means “as before”.
pub(crate) const SAME: u8 = 0;

/// The tint of a wave's level.
pub(crate) fn wave_tint(level: u32, longest: u32) -> Rgb {
    let tint = u64::from(level) * u64::from(WAVE_TINTS) / (u64::from(longest) + 1);
    wave(tint as f64 / f64::from(WAVE_TINTS - 1))
}

/// A table of at most 256 colours in which the nearest to any colour is found quickly.
pub(crate) struct Palette {
    colours: Vec<Rgb>,
    /// For each colour, cut to 6 bits a channel: its nearest, plus one; 0 if not looked up yet.
    known: Vec<u16>,
}

impl Palette {
    /// For a map on `uneven` ground also its tints and the wave's in light and shadow.
    pub(crate) fn new(uneven: bool) -> Self {
        let mut colours = Vec::new();
        let mut add = |colour: Rgb| colours.push(colour);
        for colour in [
            PAGE,
            FLOOR,
            GRID,
            EDGE,
            OBSTACLE,
            CLOSED,
            TEXT,
            BLUE,
            BLUE_TINT,
            ORANGE,
            ORANGE_RIM,
            GREEN,
            VERMILLION,
            PURPLE,
            PURPLE_TINT,
            YELLOW,
        ] {
            add(colour);
        }
        let tints: Vec<Rgb> = (0..WAVE_TINTS).map(|tint| wave_tint(tint, WAVE_TINTS - 1)).collect();
        for &tint in &tints {
            add(tint);
            add(tint.mix(GRID, 0.5));
            add(tint.mix(OBSTACLE, 0.5));
        }
        for i in (0..=6).filter(|_| uneven) {
            for tint in [height(f64::from(i) / 6.0), wave(f64::from(i) / 6.0)] {
                add(tint);
                for share in [0.07, 0.14, 0.22, 0.31, 0.42] {
                    add(tint.mix(Rgb(0, 0, 0), share));
                }
                add(tint.mix(PAGE, 0.3));
            }
        }
        // What the edges of shapes blend into; the last number says how finely.
        let blends = [
            (FLOOR, OBSTACLE, 16),
            (PAGE, TEXT, 14),
            (PAGE, BLUE, 10),
            (BLUE_TINT, BLUE, 6),
            (PAGE, GREEN, 7),
            (PAGE, VERMILLION, 7),
            (PAGE, PURPLE, 6),
            (YELLOW, ORANGE_RIM, 7),
            (ORANGE, ORANGE_RIM, 7),
            (PAGE, ORANGE_RIM, 6),
            (BLUE, ORANGE_RIM, 4),
            (BLUE_TINT, OBSTACLE, 4),
            (OBSTACLE, GREEN, 4),
            (OBSTACLE, VERMILLION, 4),
            (tints[0], OBSTACLE, 4),
            (tints[tints.len() / 2], OBSTACLE, 6),
            (tints[tints.len() - 1], OBSTACLE, 4),
            (tints[tints.len() / 2], BLUE, 4),
        ];
        for (a, b, steps) in blends {
            for i in 1..steps {
                add(a.mix(b, f64::from(i) / f64::from(steps)));
            }
        }
        Self::of(colours)
    }

    /// The first 255 different colours of these.
    pub(crate) fn of(wanted: impl IntoIterator<Item = Rgb>) -> Self {
        // The first place is taken by “as before”.
        let mut colours = vec![PAGE];
        for colour in wanted {
            if colours.len() < 256 && !colours[1..].contains(&colour) {
                colours.push(colour);
            }
        }
        Self { colours, known: vec![0; 1 << 18] }
    }

    /// The colours as a GIF wants them.
    pub(crate) fn bytes(&self) -> Vec<u8> {
        self.colours.iter().flat_map(|&Rgb(r, g, b)| [r, g, b]).collect()
    }

    /// The numbers of a picture's pixels, row by row.
    pub(crate) fn numbers(&mut self, picture: &Pixmap) -> Vec<u8> {
        picture.data().chunks_exact(4).map(|pixel| self.nearest(Rgb(pixel[0], pixel[1], pixel[2]))).collect()
    }

    /// The number of the colour nearest to this one, never [`SAME`].
    pub(crate) fn nearest(&mut self, colour: Rgb) -> u8 {
        let Rgb(r, g, b) = colour;
        let key = usize::from(r >> 2) << 12 | usize::from(g >> 2) << 6 | usize::from(b >> 2);
        if self.known[key] == 0 {
            let distance = |other: Rgb| {
                let square = |a: u8, b: u8| (i32::from(a) - i32::from(b)).pow(2);
                // Green weighs most in what the eye calls light.
                3 * square(r, other.0) + 6 * square(g, other.1) + 2 * square(b, other.2)
            };
            let found = (1..self.colours.len()).min_by_key(|&i| distance(self.colours[i])).unwrap_or(1);
            self.known[key] = found as u16 + 1;
        }
        (self.known[key] - 1) as u8
    }
}
