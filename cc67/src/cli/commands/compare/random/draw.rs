//! Random numbers from a seed: the same on every host.

/// A sequence of random numbers.
#[derive(Clone, Debug)]
pub(super) struct Draw(u64);

impl Draw {
    /// The sequence for a seed; a different one for each name.
    pub(super) fn new(name: &str, seed: u64) -> Self {
        let mix = |state: u64, byte| (state ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01B3);
        let name = name.bytes().fold(0xCBF2_9CE4_8422_2325, mix);
        Self(name ^ seed.wrapping_mul(0x9E37_79B9_7F4A_7C15))
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut mixed = self.0;
        mixed = (mixed ^ mixed >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ mixed >> 31
    }

    /// A number below `limit`, which is not 0.
    pub(super) fn below(&mut self, limit: u32) -> u32 {
        (self.next() % u64::from(limit)) as u32
    }

    /// An integer from `low` to `high`.
    pub(super) fn integer(&mut self, low: i32, high: i32) -> i32 {
        low + self.below((high - low) as u32 + 1) as i32
    }

    /// True with a probability in percent.
    pub(super) fn chance(&mut self, percent: u32) -> bool {
        self.below(100) < percent
    }

    /// Selects one of several values.
    pub(super) fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.below(from.len() as u32) as usize]
    }

    /// A number between `low` and `high`, with six digits.
    pub(super) fn real(&mut self, low: f64, high: f64) -> f64 {
        let part = (self.next() >> 11) as f64 / (1_u64 << 53) as f64;
        six_digits(low + (high - low) * part)
    }

    /// A number of any magnitude between `low` and `high`, which are positive, with six digits.
    pub(super) fn magnitude(&mut self, low: f64, high: f64) -> f64 {
        let exponent = self.real(0.0, 1.0);
        six_digits(low * libm::pow(high / low, exponent))
    }

    /// A number of such a magnitude, with random sign.
    pub(super) fn signed(&mut self, low: f64, high: f64) -> f64 {
        let magnitude = self.magnitude(low, high);
        if self.chance(50) { magnitude } else { -magnitude }
    }
}

/// Rounds a number to six digits, as programs and lines write it.
pub(super) fn six_digits(number: f64) -> f64 {
    format!("{number:.5e}").parse().unwrap_or(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_gives_the_same_numbers_and_another_one_gives_others() {
        let numbers = |name, seed| {
            let mut draw = Draw::new(name, seed);
            [(); 4].map(|()| draw.below(1000))
        };
        assert_eq!(numbers("moves", 1), numbers("moves", 1));
        assert_ne!(numbers("moves", 1), numbers("moves", 2));
        assert_ne!(numbers("moves", 1), numbers("paths", 1));
    }

    #[test]
    fn numbers_are_within_their_limits_and_have_six_digits() {
        let mut draw = Draw::new("limits", 7);
        for _ in 0..1000 {
            assert!((-3..=3).contains(&draw.integer(-3, 3)));
            let magnitude = draw.magnitude(0.01, 1000.0);
            assert!((0.01..=1000.0).contains(&magnitude), "{magnitude}");
            assert!(format!("{:?}", draw.real(0.0, 1.0)).len() <= 8 + 4);
        }
        assert_eq!(six_digits(12.345_678), 12.3457);
    }
}
