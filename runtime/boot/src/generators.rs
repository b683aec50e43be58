//! The eight step generators as the FPGA has them (`dsp-board.md` 7.3).
//!
//! A position is a real number of steps, integrated over the cycles since the rate was last written.

/// Generators.
pub(super) const GENERATORS: usize = 8;
/// Steps a cycle of one unit of the rate: a clock of 200 MHz / 12, 23 bits.
const RATE_UNIT: f64 = 1.0 / 12.0 / (1 << 23) as f64;
/// Parts of a step in the position register.
const FRACTIONS: f64 = 128.0;
/// Fields of the byte that commits a rate.
const NUMBER: u8 = 7;
const ENABLE: u8 = 0x80;

#[derive(Clone, Copy, Debug, Default)]
struct Stepper {
    position: f64,
    /// Steps a cycle.
    rate: f64,
    since: u64,
    /// High byte of the position when the low one was read.
    high: u16,
}

impl Stepper {
    fn advance(&mut self, now: u64) {
        self.position += self.rate * (now - self.since) as f64;
        self.since = now;
    }
}

/// All generators.
#[derive(Clone, Debug, Default)]
pub(super) struct Generators {
    generators: [Stepper; GENERATORS],
    /// The three low bytes of the rate that is being written.
    staged: [u8; 3],
}

impl Generators {
    /// One of the bytes before the last.
    pub(super) fn stage(&mut self, byte: usize, value: u8) {
        if let Some(staged) = self.staged.get_mut(byte) {
            *staged = value;
        }
    }

    /// The last byte: the rate holds from here on.
    pub(super) fn commit(&mut self, value: u8, now: u64) {
        let generator = &mut self.generators[usize::from(value & NUMBER)];
        generator.advance(now);
        let [low, middle, high] = self.staged.map(u32::from);
        // 23 bits with a sign: bit 23 is always 0.
        let bits = low | middle << 8 | high << 16;
        let rate = (bits << 9).cast_signed() >> 9;
        generator.rate = if value & ENABLE == 0 { 0.0 } else { f64::from(rate) * RATE_UNIT };
    }

    /// A byte of the position; the low one keeps the high one.
    pub(super) fn read(&mut self, offset: usize, now: u64) -> u16 {
        let Some(generator) = self.generators.get_mut(offset / 2) else { return 0 };
        if offset % 2 == 1 {
            return generator.high;
        }
        generator.advance(now);
        let position = libm::floor(generator.position * FRACTIONS) as i64;
        generator.high = (position >> 8 & 0xFF) as u16;
        (position & 0xFF) as u16
    }

    /// Steps made, and steps a cycle.
    pub(super) fn position(&mut self, number: usize, now: u64) -> (f64, f64) {
        let Some(generator) = self.generators.get_mut(number) else { return (0.0, 0.0) };
        generator.advance(now);
        (generator.position, generator.rate)
    }
}
