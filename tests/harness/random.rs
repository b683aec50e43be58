//! Random numbers for tests: the same sequence on every host.

/// A random number generator (Marsaglia's xorshift).
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// Creates a generator with a state, which must not be 0.
    #[must_use]
    pub const fn new(state: u64) -> Self {
        Self(state)
    }

    /// Creates a generator with a seed; adjacent seeds have different sequences.
    #[must_use]
    pub const fn of_seed(seed: u64) -> Self {
        Self((seed + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15))
    }

    /// Returns the next number of 64 bits.
    pub const fn draw(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    /// Returns a number below `end`, taken from the upper half of the bits, which is more random.
    pub const fn below(&mut self, end: usize) -> usize {
        (self.draw() >> 33) as usize % end
    }

    /// Returns one of several texts.
    pub const fn pick<'a>(&mut self, from: &[&'a str]) -> &'a str {
        from[self.below(from.len())]
    }
}
