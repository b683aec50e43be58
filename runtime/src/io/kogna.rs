//! Pins, fast PWM channels and converters that only a Kogna has. Source: its header; the function of their registers
//! was never compared with a board.

use std::collections::BTreeMap;

use kmotiondef::bits::{BitKind, kogna_range_of};
use kmotiondef::boards::TargetBoard;
use kmotiondef::{AccessSize, Bit, GuestAddr};
use vm::memory::GuestMemory;

/// The first of its bits, and the first of the pins of the fast PWM channels and of the SPI port.
const FIRST_BIT: u16 = 200;
const HRPWM_PIN: u16 = 280;
const SPI_PIN: u16 = 284;
/// The number of pins whose directions are in the variable `BitDirShadowAUX2_EXIO`: one bit each, AUX2 first.
const SHADOWED: u16 = 24;

/// Registers of the fast PWM channels: time base, periods, widths. The low parts of their addresses.
const HRPWM_REGISTERS: [u32; 8] = [0x2000, 0x200A, 0x2012, 0x2014, 0x7010, 0x7014, 0x8010, 0x8014];

/// Analog inputs and outputs on the board itself, in addition to those of a Kanalog.
pub(crate) const INPUTS: usize = 4;
pub(crate) const OUTPUTS: usize = 8;

/// The devices.
#[derive(Clone, Debug, Default)]
pub(crate) struct Kogna {
    /// Half words of the registers of the fast PWM channels, by address.
    hrpwm: BTreeMap<u32, u16>,
    /// Pins that are outputs, bit 200 lowest.
    outputs: u128,
    /// The modes of the pins of the fast PWM channels and of SPI: 0 the device's.
    hrpwm_modes: [i32; 4],
    spi_modes: [i32; 6],
    /// The variables of directions, analog inputs and analog outputs.
    directions: GuestAddr,
    adc: GuestAddr,
    dac: GuestAddr,
}

/// A device that shares its pins with general inputs and outputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PinGroup {
    /// The fast PWM channels.
    Hrpwm,
    /// The SPI port.
    Spi,
}

impl PinGroup {
    /// The bit of a pin; `None` for an invalid number.
    pub(crate) fn bit(self, pin: i32) -> Option<Bit> {
        let (first, count) = match self {
            Self::Hrpwm => (HRPWM_PIN, 4),
            Self::Spi => (SPI_PIN, 6),
        };
        Bit::new(i32::from(first) + pin).filter(|_| (0..count).contains(&pin))
    }
}

impl Kogna {
    /// The devices of a board at power-up.
    pub(crate) fn of(board: &TargetBoard) -> Self {
        let variable = |name| board.variable(name).unwrap_or_default();
        Self {
            directions: variable("BitDirShadowAUX2_EXIO"),
            adc: variable("Kogna_ADC_Buffer"),
            dac: variable("Kogna_DAC_Buffer"),
            ..Self::default()
        }
    }

    /// Makes a pin an output or an input; other bits are unchanged.
    pub(crate) fn set_output(&mut self, memory: &mut GuestMemory, bit: Bit, is_output: bool) {
        if kogna_range_of(bit).is_none_or(|range| range.kind != BitKind::KognaPin) {
            return;
        }
        let number = bit.get() - FIRST_BIT;
        let mask = 1 << number;
        self.outputs = if is_output { self.outputs | mask } else { self.outputs & !mask };
        if number < SHADOWED {
            let shadow: u32 = memory.peek(self.directions);
            let mask = 1 << number;
            memory.poke(self.directions, if is_output { shadow | mask } else { shadow & !mask });
        }
    }

    /// Returns whether a bit is an output.
    pub(crate) fn is_output(&self, bit: Bit) -> bool {
        match kogna_range_of(bit).map(|range| range.kind) {
            Some(BitKind::KognaPin) => self.outputs >> (bit.get() - FIRST_BIT) & 1 != 0,
            Some(kind) => kind == BitKind::KognaOutput,
            None => false,
        }
    }

    /// The directions of 32 pins from a bit on, that bit lowest.
    pub(crate) fn directions_from(&self, first: u16) -> u32 {
        (self.outputs >> (first - FIRST_BIT)) as u32
    }

    /// The modes of the pins of a device.
    pub(crate) fn modes(&mut self, group: PinGroup) -> &mut [i32] {
        match group {
            PinGroup::Hrpwm => &mut self.hrpwm_modes,
            PinGroup::Spi => &mut self.spi_modes,
        }
    }

    /// A reading of an analog input of the board, by its number from 0 to 3.
    pub(crate) fn analog_input(&self, memory: &GuestMemory, index: usize) -> i32 {
        i32::from(memory.peek::<i16>(self.adc.offset(2 * index as u32)))
    }

    /// The word of an analog output of the board, by its number from 0 to 7.
    pub(crate) fn analog_output(&self, memory: &GuestMemory, index: usize) -> i16 {
        memory.peek(self.dac.offset(2 * index as u32))
    }

    /// Sets the word of an analog output of the board.
    pub(crate) fn set_analog_output(&self, memory: &mut GuestMemory, index: usize, word: i16) {
        memory.poke(self.dac.offset(2 * index as u32), word);
    }

    /// Reads a register of a fast PWM channel; `None` for an unknown register.
    pub(crate) fn read(&self, address: GuestAddr, size: AccessSize) -> Option<u32> {
        let register = register_offset(address)?;
        let half = |offset| u32::from(self.hrpwm.get(&(register + offset)).copied().unwrap_or(0));
        Some(match size {
            AccessSize::Word => half(0) | half(2) << 16,
            AccessSize::Half | AccessSize::Byte => half(0),
        })
    }

    /// Writes a register of a fast PWM channel; `None` for an unknown register.
    pub(crate) fn write(&mut self, address: GuestAddr, size: AccessSize, value: u32) -> Option<()> {
        let register = register_offset(address)?;
        self.hrpwm.insert(register, value as u16);
        if size == AccessSize::Word {
            self.hrpwm.insert(register + 2, (value >> 16) as u16);
        }
        Some(())
    }
}

/// The low part of the address of a known register.
fn register_offset(address: GuestAddr) -> Option<u32> {
    let register = address.get() & 0xFFFF;
    HRPWM_REGISTERS.contains(&register).then_some(register)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn registers_of_fast_pwm_keep_16_and_32_bits() {
        let mut kogna = Kogna::default();
        let at = GuestAddr::new;
        assert_eq!(kogna.write(at(0x01F0_2012), AccessSize::Half, 0x1234), Some(()));
        assert_eq!(kogna.write(at(0x01F0_7014), AccessSize::Word, 0x89AB_CDEF), Some(()));
        assert_eq!(kogna.write(at(0x01F0_7018), AccessSize::Word, 1), None);
        assert_eq!(kogna.read(at(0x01F0_2012), AccessSize::Half), Some(0x1234));
        assert_eq!(kogna.read(at(0x01F0_7014), AccessSize::Word), Some(0x89AB_CDEF));
        assert_eq!(kogna.read(at(0x01F0_2016), AccessSize::Half), None);
    }

    #[test]
    fn only_pins_have_a_direction_that_programs_choose() {
        let (mut kogna, mut memory) = (Kogna::default(), GuestMemory::new());
        let bit = |number| Bit::new(number).expect("it is a bit");
        for number in [200, 223, 224, 230, 249, 255, 280, 289] {
            kogna.set_output(&mut memory, bit(number), true);
        }
        let found = [200, 223, 224, 230, 249, 255, 280, 289].map(|number| kogna.is_output(bit(number)));
        assert_eq!(found, [true, true, false, false, false, true, true, true]);
        assert_eq!((kogna.directions_from(280), PinGroup::Spi.bit(5)), (0x201, Some(bit(289))));
        assert_eq!((PinGroup::Hrpwm.bit(4), PinGroup::Spi.bit(-1)), (None, None));
    }
}
