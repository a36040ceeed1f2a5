//! Colours: the colour-blind safe set of Okabe and Ito, and the calm greys around it.

/// An opaque colour: red, green, blue.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Rgb(pub(crate) u8, pub(crate) u8, pub(crate) u8);

pub(crate) const PAGE: Rgb = Rgb(0xff, 0xff, 0xff);
pub(crate) const FLOOR: Rgb = Rgb(0xf8, 0xf8, 0xf5);
pub(crate) const GRID: Rgb = Rgb(0xdf, 0xe1, 0xe0);
pub(crate) const EDGE: Rgb = Rgb(0xa9, 0xb0, 0xb6);
pub(crate) const OBSTACLE: Rgb = Rgb(0x3d, 0x48, 0x52);
/// Cells without an obstacle's mark of their own in which the robot does not fit.
pub(crate) const CLOSED: Rgb = Rgb(0xcb, 0xd0, 0xd4);
pub(crate) const TEXT: Rgb = Rgb(0x22, 0x29, 0x2f);
/// The route.
pub(crate) const BLUE: Rgb = Rgb(0x00, 0x72, 0xb2);
pub(crate) const BLUE_TINT: Rgb = Rgb(0xc2, 0xdf, 0xf3);
/// Turns.
pub(crate) const ORANGE: Rgb = Rgb(0xe6, 0x9f, 0x00);
pub(crate) const ORANGE_RIM: Rgb = Rgb(0x4a, 0x33, 0x00);
/// The start.
pub(crate) const GREEN: Rgb = Rgb(0x00, 0x9e, 0x73);
pub(crate) const GREEN_TINT: Rgb = Rgb(0xbf, 0xe6, 0xd8);
/// The target.
pub(crate) const VERMILLION: Rgb = Rgb(0xd5, 0x5e, 0x00);
/// The cells in which a robot circles for ever.
pub(crate) const PURPLE: Rgb = Rgb(0xcc, 0x79, 0xa7);
pub(crate) const PURPLE_TINT: Rgb = Rgb(0xf6, 0xe1, 0xed);
/// The active cell.
pub(crate) const YELLOW: Rgb = Rgb(0xf0, 0xe4, 0x42);

/// The wave near the target, half way, and far from it: ever darker, from yellow to blue.
const WAVE: [Rgb; 3] = [Rgb(0xff, 0xf3, 0xbf), Rgb(0xd8, 0xec, 0xdc), Rgb(0xc6, 0xcc, 0xea)];

/// Low, middle and high ground: light, so that routes stand out on it.
const HEIGHTS: [Rgb; 3] = [Rgb(0xd3, 0xe3, 0xcb), Rgb(0xf3, 0xea, 0xcd), Rgb(0xe6, 0xd0, 0xbb)];

impl Rgb {
    /// The colour `share` (0 to 1) of the way to another.
    pub(crate) fn mix(self, other: Self, share: f64) -> Self {
        let channel = |a: u8, b: u8| (f64::from(a) + (f64::from(b) - f64::from(a)) * share).round() as u8;
        Self(channel(self.0, other.0), channel(self.1, other.1), channel(self.2, other.2))
    }

    /// The colour as SVG writes it, in the short form where there is one.
    pub(crate) fn hex(self) -> String {
        let Self(r, g, b) = self;
        if [r, g, b].iter().all(|channel| channel >> 4 == channel & 15) {
            return format!("#{:x}{:x}{:x}", r & 15, g & 15, b & 15);
        }
        format!("#{r:02x}{g:02x}{b:02x}")
    }
}

/// The tint of ground that is `share` (0 to 1) of the way from the lowest to the highest.
pub(crate) fn height(share: f64) -> Rgb {
    between(HEIGHTS, share)
}

/// The tint of a cell that the wave reached after `share` (0 to 1) of its run.
pub(crate) fn wave(share: f64) -> Rgb {
    between(WAVE, share)
}

/// How busy a cell is: from yellow over red to dark violet, ever darker.
pub(crate) mod traffic {
    use super::Rgb;

    /// How many tints there are.
    pub(crate) const TINTS: u8 = 12;
    const COLOURS: [Rgb; 5] = [
        Rgb(0xff, 0xf1, 0xb5),
        Rgb(0xfd, 0xc6, 0x6b),
        Rgb(0xf4, 0x7d, 0x4b),
        Rgb(0xc9, 0x2d, 0x60),
        Rgb(0x5c, 0x0f, 0x63),
    ];

    /// The tint, from 1, for so many visits; `most` and more have the last.
    pub(crate) fn tint(visits: u32, most: u32) -> u8 {
        let share = u64::from(visits.saturating_sub(1)) * u64::from(TINTS) / u64::from(most.max(1));
        share.min(u64::from(TINTS) - 1) as u8 + 1
    }

    /// The colour of a tint, counted from 1.
    pub(crate) fn colour(tint: u8) -> Rgb {
        let at = f64::from(tint.clamp(1, TINTS) - 1) / f64::from(TINTS - 1) * (COLOURS.len() - 1) as f64;
        let below = (at as usize).min(COLOURS.len() - 2);
        COLOURS[below].mix(COLOURS[below + 1], at - below as f64)
    }
}

/// The colour `share` (0 to 1) of the way through three.
fn between([low, middle, high]: [Rgb; 3], share: f64) -> Rgb {
    let share = 2.0 * share.clamp(0.0, 1.0);
    if share < 1.0 { low.mix(middle, share) } else { middle.mix(high, share - 1.0) }
}
