//! A slave on a synchronous serial bus, most significant bit first.
//!
//! While it is selected (low) it drives the next bit of its word on `out` after each falling edge of the clock and
//! samples `in` at each rising edge; the first bit appears when it is selected. That is mode 0, which is used by
//! thermocouple converters, shift registers and port expanders. Each selection sends the next word of the list; the
//! last one is repeated.

use kmotiondef::Bit;

use crate::machine::attached::{AttachedDevice, DeviceContext};
use crate::world::attached::Settings;
use chips::changes::BitChange;

/// Bits of a word that does not say it.
const BITS: f64 = 16.0;

/// A slave.
#[derive(Clone, Debug)]
pub(crate) struct Spi {
    select: Bit,
    clock: Bit,
    /// Its data output, an input of the board.
    out: Bit,
    /// Its data input, an output of the board.
    input: Option<Bit>,
    bits: u32,
    words: Vec<u32>,
    /// Sends the word received during the previous selection, as a shift register does.
    is_looped: bool,
    /// The number of times it was selected.
    turns: usize,
    is_selected: bool,
    input_level: bool,
    shift: u32,
    received: u32,
}

impl Spi {
    /// `select`, `clock`, `out`, `in`, `bits`, `word`, `loop`.
    pub(crate) fn new(settings: &mut Settings<'_>) -> Result<Self, String> {
        let select = settings.bit("select")?;
        let clock = settings.bit("clock")?;
        let out = settings.bit("out")?;
        let input = settings.optional_bit("in")?;
        let bits = settings.optional("bits", "a number from 1 to 32", |text| {
            text.parse().ok().filter(|bits| (1..=32).contains(bits))
        })?;
        let words = settings.optional("word", "a number, or several with commas between them", |text| {
            text.split(',').map(number).collect::<Option<Vec<u32>>>()
        })?;
        Ok(Self {
            select,
            clock,
            out,
            input,
            bits: bits.unwrap_or(BITS as u32),
            words: words.unwrap_or_default(),
            is_looped: settings.flag("loop")?,
            turns: 0,
            is_selected: false,
            input_level: false,
            shift: 0,
            received: 0,
        })
    }

    fn select(&mut self) {
        self.is_selected = true;
        let index = self.turns.min(self.words.len().saturating_sub(1));
        self.turns += 1;
        let word = self.words.get(index).copied().unwrap_or(0);
        let word = if self.is_looped { self.received } else { word };
        // The bit that shows next is always the topmost one.
        self.shift = word << (u32::BITS - self.bits);
        self.received = 0;
    }

    fn show(&self, change: BitChange, outside: &mut DeviceContext<'_>) {
        outside.pins.drive(self.out, self.shift >> (u32::BITS - 1) != 0, change.at);
    }
}

/// A decimal or hexadecimal number.
fn number(text: &str) -> Option<u32> {
    match text.strip_prefix("0x") {
        Some(digits) => u32::from_str_radix(digits, 16).ok(),
        None => text.parse().ok(),
    }
}

impl AttachedDevice for Spi {
    fn drives(&self) -> Option<Bit> {
        Some(self.out)
    }

    fn edge(&mut self, change: BitChange, outside: &mut DeviceContext<'_>) {
        if Some(change.bit) == self.input {
            self.input_level = change.level;
        }
        if change.bit == self.select {
            if change.level {
                self.is_selected = false;
            } else {
                self.select();
                self.show(change, outside);
            }
        }
        if change.bit != self.clock || !self.is_selected {
            return;
        }
        if change.level {
            self.received = self.received << 1 | u32::from(self.input_level);
        } else {
            self.shift <<= 1;
            self.show(change, outside);
        }
    }

    fn watches(&self, bit: Bit) -> bool {
        bit == self.select || bit == self.clock || Some(bit) == self.input
    }
}

#[cfg(test)]
mod tests {
    use crate::world::outside::testing::Bench;

    /// Selects the device once, sends bits and returns the bits read.
    fn exchange(bench: &mut Bench, send: u32, bits: u32) -> u32 {
        let mut word = 0;
        bench.output(16, false, 0);
        for bit in (0..bits).rev() {
            bench.output(19, send >> bit & 1 != 0, 0);
            bench.output(17, true, 0);
            word = word << 1 | u32::from(bench.level(18));
            bench.output(17, false, 0);
        }
        bench.output(16, true, 0);
        word
    }

    #[test]
    fn each_selection_sends_a_word() {
        let mut bench = Bench::new("spi select=16 clock=17 out=18 word=0x1234,0xabcd");
        bench.output(16, true, 0);
        for expect in [0x1234, 0xabcd, 0xabcd] {
            assert_eq!(exchange(&mut bench, 0, 16), expect);
        }
    }

    #[test]
    fn a_shift_register_sends_what_it_received() {
        let mut bench = Bench::new("spi select=16 clock=17 out=18 in=19 bits=8 loop=1");
        bench.output(16, true, 0);
        assert_eq!(exchange(&mut bench, 0xa5, 8), 0);
        assert_eq!(exchange(&mut bench, 0, 8), 0xa5);
    }
}
