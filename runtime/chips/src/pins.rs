//! Levels of the digital inputs and outputs, on board and on option boards.
//!
//! A pin of the board has an output latch and a direction; its level from outside is stored separately, so that a latch
//! written while the pin is an input appears when it becomes an output.
//!
//! Some pins carry signals that are much faster than a program's polling: pulse widths, steps, the phases of encoders.
//! A program reads one level of them per tick; their edges are generated only for watched pins.

use kmotiondef::{Bit, Cycles};

use crate::changes::Changes;

/// The number of pins of the FPGA, including the two LEDs.
pub const PINS: u16 = 48;
/// The two LEDs, outputs that are lit at power-up.
const LEDS: u64 = 0b11 << 46;
/// The number of words in a set of all bits.
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
pub struct Pins {
    latch: u64,
    direction: u64,
    /// Pins that a generator drives instead of their latches, and their levels.
    generated: u64,
    generated_level: u64,
    /// Outputs of option boards, as last written.
    written: BitSet,
    /// The levels of inputs, set from outside.
    inputs: BitSet,
    /// Inputs that are driven.
    driven: BitSet,
    /// Inputs with a defined level while nothing drives them.
    idle: BitSet,
    /// Inputs that carry the phases of an encoder.
    phases: u64,
    /// Pins whose fast signals are reported edge by edge, and their last reported levels.
    watched: u64,
    shown: u64,
    /// The changes of levels, recorded on request.
    pub changes: Changes,
}

impl Default for Pins {
    fn default() -> Self {
        Self {
            latch: LEDS,
            direction: LEDS,
            generated: 0,
            generated_level: 0,
            written: BitSet::default(),
            inputs: BitSet::default(),
            driven: BitSet::default(),
            idle: BitSet::default(),
            phases: 0,
            watched: 0,
            shown: 0,
            changes: Changes::default(),
        }
    }
}

impl Pins {
    /// The pins before a firmware has started: all are inputs, all latches are low.
    #[must_use]
    pub fn at_power_up() -> Self {
        Self { latch: 0, direction: 0, ..Self::default() }
    }

    /// Returns whether a pin of the board is an output.
    pub fn is_output(&self, bit: Bit) -> bool {
        bit.get() < PINS && (self.direction | self.generated) >> bit.get() & 1 != 0
    }

    /// Makes a pin of the board an output or an input.
    pub fn set_output(&mut self, bit: Bit, output: bool, now: Cycles) {
        let mask = 1 << bit.get();
        self.change(now, |pins| pins.direction = with_bits(pins.direction, mask, output));
    }

    /// Sets the output latch of a pin of the board.
    pub fn set_latch(&mut self, bit: Bit, level: bool, now: Cycles) {
        let mask = 1 << bit.get();
        self.change(now, |pins| pins.latch = with_bits(pins.latch, mask, level));
    }

    /// Makes a generator drive a pin of the board with this level, or returns the pin to its latch.
    pub fn generate(&mut self, bit: Bit, level: Option<bool>, now: Cycles) {
        let mask = 1 << bit.get();
        self.change(now, |pins| {
            pins.generated = with_bits(pins.generated, mask, level.is_some());
            pins.generated_level = with_bits(pins.generated_level, mask, level == Some(true));
        });
    }

    /// Changes the inputs to the levels of the board's pins, and records the levels that differ.
    fn change(&mut self, now: Cycles, edit: impl FnOnce(&mut Self)) {
        let (before, fast) = (self.levels(), self.generated);
        edit(self);
        let after = self.levels();
        if before != after || self.watched != 0 {
            let plain = !self.watched & !(fast | self.generated) & (before ^ after);
            let left = self.watched & !self.generated & (self.shown ^ after);
            self.shown = self.shown & !left | after & left;
            self.changes.note_mask(plain | left, after, now);
        }
    }

    /// Reports the fast signals of a pin edge by edge from now on.
    pub fn watch(&mut self, bit: Bit) {
        if bit.get() < PINS {
            let mask = 1 << bit.get();
            self.shown = with_bits(self.shown, mask, self.level(bit));
            self.watched |= mask;
        }
    }

    /// Returns whether the fast signals of any pin are reported edge by edge.
    pub fn watches_any(&self) -> bool {
        self.watched != 0
    }

    /// Returns whether the fast signals of a pin are reported edge by edge.
    pub fn is_watched(&self, bit: Bit) -> bool {
        bit.get() < PINS && self.watched >> bit.get() & 1 != 0
    }

    /// Returns whether a generator drives a pin.
    pub fn is_generated(&self, bit: Bit) -> bool {
        bit.get() < PINS && self.generated >> bit.get() & 1 != 0
    }

    /// Reports the level of a watched pin at a given time.
    pub fn report_level(&mut self, bit: Bit, level: bool, at: Cycles) {
        let mask = 1 << bit.get();
        if self.watched & mask != 0 && (self.shown & mask != 0) != level {
            self.shown = with_bits(self.shown, mask, level);
            self.changes.record(bit, level, at);
        }
    }

    /// Makes an encoder drive its two inputs from `first` on with the levels in two bits, unless something else drives
    /// them.
    #[inline]
    pub fn show_phases(&mut self, first: u16, levels: u64, at: Cycles) {
        let mask = 0b11 << first & !self.driven.0[0];
        self.phases |= mask;
        self.inputs.0[0] = self.inputs.0[0] & !mask | levels << first & mask;
        if self.watched & mask != 0 {
            let shown = mask & !(self.direction | self.generated);
            for pin in [first, first + 1].into_iter().filter(|pin| shown >> pin & 1 != 0) {
                if let Some(bit) = Bit::new(pin.into()) {
                    self.report_level(bit, self.inputs.contains(bit), at);
                }
            }
        }
    }

    /// The levels of all pins of the board.
    fn levels(&self) -> u64 {
        let outputs = self.latch & !self.generated | self.generated_level;
        let direction = self.direction | self.generated;
        outputs & direction | self.inputs.0[0] & !direction & ((1 << PINS) - 1)
    }

    /// The level of a pin of the board: an output's latch, an input's level from outside.
    pub fn level(&self, bit: Bit) -> bool {
        self.levels() >> bit.get() & 1 != 0
    }

    /// The level of an input from outside.
    pub fn input(&self, bit: Bit) -> bool {
        self.inputs.contains(bit)
    }

    /// Drives an input from outside.
    pub fn drive(&mut self, bit: Bit, level: bool, now: Cycles) {
        self.driven.set(bit, true);
        if bit.get() < PINS {
            return self.change(now, |pins| pins.inputs.set(bit, level));
        }
        if self.inputs.contains(bit) != level {
            self.inputs.set(bit, level);
            self.changes.record(bit, level, now);
        }
    }

    /// Notes that an input will be driven: reading it is not an error.
    pub fn declare(&mut self, bit: Bit) {
        self.driven.set(bit, true);
    }

    /// Makes an input read 1 while nothing drives it.
    pub fn idle_high(&mut self, bit: Bit) {
        self.idle.set(bit, true);
        if !self.is_driven(bit) {
            self.inputs.set(bit, true);
        }
    }

    /// Returns whether something outside the board drives a bit or will drive it.
    pub fn is_declared(&self, bit: Bit) -> bool {
        self.driven.contains(bit)
    }

    /// Returns whether an input has a defined level while nothing drives it.
    pub fn is_described(&self, bit: Bit) -> bool {
        self.idle.contains(bit)
    }

    /// Returns whether anything drives an input.
    pub fn is_driven(&self, bit: Bit) -> bool {
        self.driven.contains(bit) || bit.get() < PINS && self.phases >> bit.get() & 1 != 0
    }

    /// An output of an option board, as last written.
    pub fn written(&self, bit: Bit) -> bool {
        self.written.contains(bit)
    }

    /// Writes an output of an option board.
    pub fn write(&mut self, bit: Bit, level: bool, now: Cycles) {
        if self.written.contains(bit) != level {
            self.written.set(bit, level);
            self.changes.record(bit, level, now);
        }
    }

    /// Eight directions in the format of a register.
    pub fn direction_group(&self, group: u32) -> u8 {
        (self.direction >> (8 * group)) as u8
    }

    /// Stores eight directions.
    pub fn set_direction_group(&mut self, group: u32, value: u8, now: Cycles) {
        let (mask, bits) = (0xff << (8 * group), u64::from(value) << (8 * group));
        self.change(now, |pins| pins.direction = pins.direction & !mask | bits);
    }

    /// Sets the latches where `mask` has ones.
    pub fn set_group(&mut self, group: u32, mask: u8, now: Cycles) {
        self.change(now, |pins| pins.latch |= u64::from(mask) << (8 * group));
    }

    /// Clears the latches where `mask` has zeros.
    pub fn clear_group(&mut self, group: u32, mask: u8, now: Cycles) {
        self.change(now, |pins| pins.latch &= !(u64::from(!mask) << (8 * group)));
    }

    /// Eight latches.
    #[must_use]
    pub fn latch_group(&self, group: u32) -> u8 {
        (self.latch >> (8 * group)) as u8
    }

    /// Eight levels in the format of a register.
    pub fn level_group(&self, group: u32) -> u8 {
        (self.levels() >> (8 * group)) as u8
    }
}

/// A word with the bits of `mask` set or cleared.
fn with_bits(word: u64, mask: u64, set: bool) -> u64 {
    if set { word | mask } else { word & !mask }
}

#[cfg(test)]
mod tests {

    use super::*;

    #[test]
    fn only_changes_of_level_are_recorded() {
        let mut pins = Pins::default();
        pins.changes.switch_on(Vec::new());
        let (bit, at) = (Bit::new(26).expect("a bit"), Cycles::new(7));
        pins.set_latch(bit, true, at);
        pins.drive(bit, true, at);
        pins.set_output(bit, true, at);
        // Signals of generators are not reported unless the pin is watched.
        pins.generate(bit, Some(false), at);
        pins.generate(bit, None, at);
        pins.set_latch(bit, false, at);
        let levels: Vec<bool> = pins.changes.take().iter().map(|change| change.level).collect();
        assert_eq!(levels, [true, false]);
    }

    #[test]
    fn edges_of_fast_signals_are_reported_only_for_watched_pins() {
        let mut pins = Pins::default();
        pins.changes.switch_on(Vec::new());
        let bits = [26, 27].map(|number| Bit::new(number).expect("a bit"));
        pins.watch(bits[0]);
        for bit in bits {
            pins.generate(bit, Some(false), Cycles::new(0));
            for (at, level) in [(10, true), (20, true), (30, false), (40, true)] {
                pins.report_level(bit, level, Cycles::new(at));
            }
            assert!(!pins.level(bit), "what a program reads");
            pins.generate(bit, None, Cycles::new(50));
        }
        let told: Vec<_> =
            pins.changes.take().iter().map(|change| (change.bit.get(), change.at.get())).collect();
        assert_eq!(told, [(26, 10), (26, 30), (26, 40), (26, 50)]);
    }
}
