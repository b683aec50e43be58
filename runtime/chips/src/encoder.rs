//! Encoder inputs: eight-bit counters, the phases on their pins, and errors caused by noise.
//!
//! The loads turn the counters; this module has what programs can observe besides `Position`. An encoder that no axis
//! reads drives no pins, so they are free for other inputs. Sources: io.md sections 5 and 7, devices.md section 5.

use kmotiondef::Cycles;

use crate::pins::Pins;

/// The number of channels: eight of the board, four of each SnapAmp.
pub const CHANNELS: usize = 16;
/// The number of channels on the board, and in a group whose pins move together.
const ON_BOARD: usize = 8;
const GROUP: usize = 4;

/// The first pins of channels 0 and 4: at power-up, and after a bit of the filter register has moved them.
const PINS: [[u16; 2]; 2] = [[0, 16], [36, 26]];
/// The bits that move them: from JP7 to JP4, from JP5 to JP6.
const MOVED: [u16; 2] = [1 << 9, 1 << 8];

/// The bit for encoder 0 in the error register.
const FIRST_ERROR: u32 = 4;
/// The error bit in a SnapAmp's word.
const SNAP_ERROR: u16 = 1 << 15;

/// All encoder inputs.
#[derive(Clone, Debug)]
pub struct Encoders {
    counts: [i8; CHANNELS],
    /// The first pin of each channel on the board.
    pins: [u16; ON_BOARD],
    /// The channels that an axis reads, channel 0 lowest.
    used: u16,
    errors: u16,
    /// The register for the filter and the selection of pins.
    filter: u16,
}

/// The levels A and B for a count, A in the lower bit: one edge per step.
fn phases(count: i8) -> u64 {
    let step = (count & 3) as u64;
    step ^ step >> 1
}

/// The first pin of each channel on the board.
fn pins(filter: u16) -> [u16; ON_BOARD] {
    std::array::from_fn(|channel| {
        let group = channel / GROUP;
        let place = usize::from(filter & MOVED[group] != 0);
        PINS[group][place] + 2 * (channel % GROUP) as u16
    })
}

impl Default for Encoders {
    fn default() -> Self {
        Self { counts: [0; CHANNELS], pins: pins(0), used: 0, errors: 0, filter: 0 }
    }
}

impl Encoders {
    /// Sets the value of a counter.
    #[inline]
    pub fn count(&mut self, channel: usize, count: i8, pins: &mut Pins, now: Cycles) {
        if let Some(held) = self.counts.get_mut(channel) {
            *held = count;
            self.used |= 1 << channel;
            self.drive_pins(channel, phases(count), pins, now);
        }
    }

    /// Sets the value of a counter without changing its pins.
    pub fn set(&mut self, channel: usize, count: u8) {
        if let Some(held) = self.counts.get_mut(channel) {
            *held = count.cast_signed();
        }
    }

    /// The counter of a channel.
    #[must_use]
    pub fn counter(&self, channel: usize) -> u8 {
        self.counts.get(channel).copied().unwrap_or_default().cast_unsigned()
    }

    /// Sets the levels of a channel's pins; channels of SnapAmps have none.
    #[inline]
    fn drive_pins(&self, channel: usize, levels: u64, pins: &mut Pins, now: Cycles) {
        if let Some(&first) = self.pins.get(channel) {
            pins.show_phases(first, levels, now);
        }
    }

    /// Sets the filter register; its upper bits move the inputs to other pins. The filter itself is not modelled.
    pub fn set_filter(&mut self, filter: u16, pins: &mut Pins, now: Cycles) {
        if filter == self.filter {
            return;
        }
        let channels = (0..ON_BOARD).filter(|channel| self.used >> channel & 1 != 0).collect::<Vec<_>>();
        for &channel in &channels {
            self.drive_pins(channel, 0, pins, now);
        }
        self.filter = filter;
        self.pins = self::pins(filter);
        for &channel in &channels {
            self.drive_pins(channel, phases(self.counts[channel]), pins, now);
        }
    }

    /// Records an error: both phases of an input changed at once.
    pub fn fail(&mut self, channel: usize) {
        if channel < CHANNELS {
            self.errors |= 1 << channel;
        }
    }

    /// The error register.
    pub fn errors(&self) -> u8 {
        (self.errors << FIRST_ERROR) as u8
    }

    /// Clears the error register.
    pub fn clear_errors(&mut self) {
        self.errors &= !0xf;
    }

    /// The first channel of a SnapAmp.
    fn of_snapamp(board: usize) -> usize {
        ON_BOARD + GROUP * board
    }

    /// The word for an encoder of a SnapAmp: count and error.
    pub fn snap_word(&self, board: usize, encoder: usize) -> u16 {
        let channel = Self::of_snapamp(board) + encoder;
        u16::from(self.counter(channel)) | if self.errors >> channel & 1 != 0 { SNAP_ERROR } else { 0 }
    }

    /// The levels of a SnapAmp's encoder inputs, A of the first one lowest.
    pub fn snap_levels(&self, board: usize) -> u8 {
        let first = Self::of_snapamp(board);
        let levels = (first..first + GROUP)
            .map(|channel| phases(self.counts.get(channel).copied().unwrap_or_default()));
        (0..).zip(levels).fold(0, |byte, (index, levels)| byte | (levels as u8) << (2 * index))
    }

    /// Clears the errors of a SnapAmp.
    pub fn clear_snap_errors(&mut self, board: usize) {
        self.errors &= !(0xf << Self::of_snapamp(board));
    }
}

#[cfg(test)]
mod tests {
    use kmotiondef::Bit;

    use super::*;

    fn levels(pins: &Pins, first: i32) -> [bool; 2] {
        [first, first + 1].map(|number| pins.level(Bit::new(number).expect("a bit")))
    }

    #[test]
    fn counts_appear_as_phases_on_pins_chosen_by_the_filters_upper_bits() {
        let (mut encoders, mut pins) = (Encoders::default(), Pins::default());
        for (count, expect) in [
            (0, [false, false]),
            (1, [true, false]),
            (2, [true, true]),
            (3, [false, true]),
            (-1, [false, true]),
        ] {
            encoders.count(1, count, &mut pins, Cycles::default());
            assert_eq!(levels(&pins, 2), expect, "{count}");
        }
        encoders.set_filter(7 | 1 << 9, &mut pins, Cycles::default());
        assert_eq!((levels(&pins, 2), levels(&pins, 18)), ([false; 2], [false, true]));
        encoders.count(5, 2, &mut pins, Cycles::default());
        assert_eq!(levels(&pins, 38), [true, true]);
        encoders.set_filter(7 | 1 << 8, &mut pins, Cycles::default());
        assert_eq!((levels(&pins, 2), levels(&pins, 28)), ([false, true], [true, true]));
    }

    #[test]
    fn a_driven_input_shows_no_phase() {
        let (mut encoders, mut pins) = (Encoders::default(), Pins::default());
        pins.drive(Bit::new(0).expect("a bit"), false, Cycles::default());
        encoders.count(0, 2, &mut pins, Cycles::default());
        assert_eq!(levels(&pins, 0), [false, true]);
    }

    #[test]
    fn errors_last_until_they_are_cleared() {
        let mut encoders = Encoders::default();
        for channel in [0, 3, 9, 15, 16] {
            encoders.fail(channel);
        }
        assert_eq!(
            (encoders.errors(), encoders.snap_word(0, 1), encoders.snap_word(1, 3)),
            (0x90, 0x8000, 0x8000)
        );
        encoders.clear_errors();
        encoders.clear_snap_errors(1);
        assert_eq!((encoders.errors(), encoders.snap_word(0, 1), encoders.snap_word(1, 3)), (0, 0x8000, 0));
    }
}
