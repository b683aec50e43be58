//! The status record. Source: host-protocol.md section 5.

use kmotiondef::{AxisId, ThreadId};

/// Words of the record.
const WORDS: usize = 116;
/// Lines of the reply.
pub(super) const LINES: usize = 8;
/// Version 308 and the number of words.
const HEAD: u32 = 0x0134_0074;

/// The state of the board at an instant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Status {
    words: Vec<u32>,
}

impl Status {
    /// Reads the lines of a reply.
    pub(super) fn read(lines: &[String]) -> Option<Self> {
        let words = lines.iter().flat_map(|line| line.split_ascii_whitespace());
        let words: Vec<u32> = words.map(|word| u32::from_str_radix(word, 16).ok()).collect::<Option<_>>()?;
        (words.len() == WORDS && words.first() == Some(&HEAD)).then_some(Self { words })
    }

    /// A word of the record.
    #[must_use]
    pub fn word(&self, index: usize) -> u32 {
        self.words.get(index).copied().unwrap_or(0)
    }

    fn double(&self, index: usize) -> f64 {
        f64::from_bits(u64::from(self.word(index)) | u64::from(self.word(index + 1)) << 32)
    }

    /// The measured position of an axis, in counts.
    #[must_use]
    pub fn position(&self, axis: AxisId) -> f64 {
        self.double(50 + 2 * usize::from(axis.get()))
    }

    /// The commanded position of an axis, in counts.
    #[must_use]
    pub fn dest(&self, axis: AxisId) -> f64 {
        self.double(66 + 2 * usize::from(axis.get()))
    }

    /// Returns whether an axis is enabled.
    #[must_use]
    pub fn is_enabled(&self, axis: AxisId) -> bool {
        self.word(88) >> axis.get() & 1 == 1
    }

    /// Returns whether the motion of an axis is complete.
    #[must_use]
    pub fn is_done(&self, axis: AxisId) -> bool {
        self.word(89) >> axis.get() & 1 == 1
    }

    /// The input mode of an axis.
    #[must_use]
    pub fn input_mode(&self, axis: AxisId) -> u8 {
        (self.word(84) >> (4 * u32::from(axis.get())) & 0xF) as u8
    }

    /// The output mode of an axis.
    #[must_use]
    pub fn output_mode(&self, axis: AxisId) -> u8 {
        (self.word(86) >> (4 * u32::from(axis.get())) & 0xF) as u8
    }

    /// The level of a bit, if the record has it: bits 0 to 63.
    #[must_use]
    pub fn bit(&self, bit: u16) -> Option<bool> {
        let word = self.word(92 + usize::from(bit / 32));
        (bit < 64).then_some(word >> (bit % 32) & 1 == 1)
    }

    /// An analog input, from 0 to 23.
    #[must_use]
    pub fn adc(&self, channel: usize) -> i32 {
        if channel < 24 { self.word(1 + channel).cast_signed() } else { 0 }
    }

    /// Returns whether a thread is active.
    #[must_use]
    pub fn is_active(&self, thread: ThreadId) -> bool {
        self.word(101) >> thread.get() & 1 == 1
    }

    /// Seconds since the board was switched on.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.double(104)
    }

    /// The state of a feedhold: 0 when none.
    #[must_use]
    pub fn stop_state(&self) -> u32 {
        self.word(102)
    }

    /// `persist.UserData[100 + index]`, for an index from 0 to 7.
    #[must_use]
    pub fn request(&self, index: usize) -> u32 {
        if index < 8 { self.word(106 + index) } else { 0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_where_the_record_has_them() {
        let mut words = vec![0_u32; WORDS];
        words[0] = HEAD;
        let [low, high] = [1.5_f64.to_bits() as u32, (1.5_f64.to_bits() >> 32) as u32];
        (words[52], words[53], words[104], words[105]) = (low, high, low, high);
        (words[88], words[93], words[101]) = (0b10, 1 << 14, 0b101);
        let text =
            |words: &[u32]| words.iter().map(|word| format!("{word:08X}")).collect::<Vec<_>>().join(" ");
        let lines: Vec<_> = words.chunks(16).map(text).collect();
        let status = Status::read(&lines).expect("the lines are good");
        let axis = |number| AxisId::new(number).expect("there are 8");
        let thread = |number| ThreadId::new(number).expect("there are 7");
        assert_eq!((status.position(axis(1)), status.time()), (1.5, 1.5));
        assert_eq!((status.is_enabled(axis(1)), status.is_enabled(axis(0))), (true, false));
        assert_eq!((status.bit(46), status.bit(45), status.bit(64)), (Some(true), Some(false), None));
        assert_eq!((status.is_active(thread(2)), status.is_active(thread(1))), (true, false));
        assert_eq!(Status::read(&lines[..7]), None);
    }
}
