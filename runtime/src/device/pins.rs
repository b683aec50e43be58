//! Levels of the digital inputs and outputs, on board and on option boards.
//!
//! A pin of the board has an output latch and a direction; what drives it from outside is a separate level, so that
//! a latch written while the pin is an input appears when it becomes an output.

use kmotiondef::Bit;

/// Pins of the FPGA, the two diodes included.
pub(crate) const PINS: u16 = 48;
/// The two diodes, outputs that are lit at power-up.
const LEDS: u64 = 0b11 << 46;
/// Words of a set of all bits.
const WORDS: usize = (Bit::MAX as usize + 1) / 64;

/// A set of bit numbers.
#[derive(Clone, Debug, Default)]
struct BitSet([u64; WORDS]);

impl BitSet {
    fn contains(&self, bit: Bit) -> bool {
        self.0[bit.index() / 64] >> (bit.index() % 64) & 1 != 0
    }

    fn set(&mut self, bit: Bit, member: bool) {
        let mask = 1 << (bit.index() % 64);
        let word = &mut self.0[bit.index() / 64];
        *word = if member { *word | mask } else { *word & !mask };
    }
}

/// All levels.
#[derive(Clone, Debug)]
pub(crate) struct Pins {
    latch: u64,
    direction: u64,
    /// Outputs of option boards, as last written.
    written: BitSet,
    /// Levels from outside.
    inputs: BitSet,
    /// Inputs that something drives.
    driven: BitSet,
}

impl Default for Pins {
    fn default() -> Self {
        Self {
            latch: LEDS,
            direction: LEDS,
            written: BitSet::default(),
            inputs: BitSet::default(),
            driven: BitSet::default(),
        }
    }
}

impl Pins {
    /// Whether a pin of the board is an output.
    pub(crate) fn is_output(&self, bit: Bit) -> bool {
        bit.get() < PINS && self.direction >> bit.get() & 1 != 0
    }

    /// Makes a pin of the board an output or an input.
    pub(crate) fn set_output(&mut self, bit: Bit, output: bool) {
        let mask = 1 << bit.get();
        self.direction = if output { self.direction | mask } else { self.direction & !mask };
    }

    /// Sets the output latch of a pin of the board.
    pub(crate) fn set_latch(&mut self, bit: Bit, level: bool) {
        let mask = 1 << bit.get();
        self.latch = if level { self.latch | mask } else { self.latch & !mask };
    }

    /// The level of a pin of the board: an output's latch, an input's level from outside.
    pub(crate) fn level(&self, bit: Bit) -> bool {
        if self.is_output(bit) { self.latch >> bit.get() & 1 != 0 } else { self.input(bit) }
    }

    /// The level of an input from outside.
    pub(crate) fn input(&self, bit: Bit) -> bool {
        self.inputs.contains(bit)
    }

    /// Drives an input from outside.
    pub(crate) fn drive(&mut self, bit: Bit, level: bool) {
        self.inputs.set(bit, level);
        self.driven.set(bit, true);
    }

    /// Whether anything drives an input.
    pub(crate) fn is_driven(&self, bit: Bit) -> bool {
        self.driven.contains(bit)
    }

    /// An output of an option board, as last written.
    pub(crate) fn written(&self, bit: Bit) -> bool {
        self.written.contains(bit)
    }

    /// Writes an output of an option board.
    pub(crate) fn write(&mut self, bit: Bit, level: bool) {
        self.written.set(bit, level);
    }

    /// Eight directions as a register has them.
    pub(crate) fn direction_group(&self, group: u32) -> u8 {
        (self.direction >> (8 * group)) as u8
    }

    /// Stores eight directions.
    pub(crate) fn set_direction_group(&mut self, group: u32, value: u8) {
        self.direction = self.direction & !(0xff << (8 * group)) | u64::from(value) << (8 * group);
    }

    /// Sets the latches where `mask` has ones.
    pub(crate) fn set_group(&mut self, group: u32, mask: u8) {
        self.latch |= u64::from(mask) << (8 * group);
    }

    /// Clears the latches where `mask` has zeros.
    pub(crate) fn clear_group(&mut self, group: u32, mask: u8) {
        self.latch &= !(u64::from(!mask) << (8 * group));
    }

    /// Eight levels as a register has them.
    pub(crate) fn level_group(&self, group: u32) -> u8 {
        let outputs = self.latch & self.direction | self.inputs.0[0] & !self.direction;
        (outputs >> (8 * group)) as u8
    }
}
