//! A seeded random generator whose numbers stay the same for ever, on every machine.

/// `SplitMix64` (Steele, Lea, Flood: *Fast Splittable Pseudorandom Number Generators*, OOPSLA 2014).
///
/// ```
/// let mut rng = activecell::Rng::new(7);
/// assert_eq!(rng.next_u64(), 0x63cb_e1e4_5932_0dd7);
/// assert!(rng.below(10) < 10);
/// ```
#[derive(Debug, Clone)]
pub struct Rng(u64);

impl Rng {
    /// A generator; the same seed gives the same numbers.
    pub const fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next 64 random bits.
    pub const fn next_u64(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number below `bound`, each equally likely to within 2⁻³².
    ///
    /// # Panics
    /// If `bound` is 0.
    pub const fn below(&mut self, bound: u32) -> u32 {
        assert!(bound > 0, "no number is below 0");
        // Lemire's multiplication, without his rejection step: the bias is far below what any caller can see.
        (((self.next_u64() >> 32) * bound as u64) >> 32) as u32
    }

    /// Puts items into an order by chance, every order equally likely (R. Durstenfeld, *Algorithm 235: Random
    /// Permutation*, 1964).
    ///
    /// ```
    /// let mut order = [0, 1, 2, 3];
    /// activecell::Rng::new(1).shuffle(&mut order);
    /// assert_eq!(order, [0, 1, 3, 2]);
    /// ```
    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for last in (1..items.len()).rev() {
            items.swap(last, self.below(last as u32 + 1) as usize);
        }
    }

    /// True with this probability.
    pub fn chance(&mut self, probability: f64) -> bool {
        ((self.next_u64() >> 11) as f64) < probability * (1u64 << 53) as f64
    }

    /// A number of the normal distribution with mean 0 and standard deviation 1 (Marsaglia and Bray, *A Convenient
    /// Method for Generating Normal Variables*, 1964; of its pair the first).
    ///
    /// ```
    /// let mut rng = activecell::Rng::new(1);
    /// let mean = (0..10_000).map(|_| rng.normal()).sum::<f64>() / 10_000.0;
    /// assert!(mean.abs() < 0.05);
    /// ```
    pub fn normal(&mut self) -> f64 {
        loop {
            let (u, v) = (2.0 * self.unit() - 1.0, 2.0 * self.unit() - 1.0);
            let square = u * u + v * v;
            if square > 0.0 && square < 1.0 {
                return u * (-2.0 * square.ln() / square).sqrt();
            }
        }
    }

    /// A number from 0 to 1, 1 excluded.
    pub fn unit(&mut self) -> f64 {
        (self.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }
}
