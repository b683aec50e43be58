//! Registers of the FPGA.
//!
//! An eight-bit register r is the byte at base + 4·r + 2; a 16-bit register is the half word there. The registers below
//! have effects; all others only store the written value.

mod pwm;

use kmotiondef::map::FPGA;
use kmotiondef::{AccessSize, Bit, Cycles, GuestAddr};

use crate::encoder::Encoders;
use crate::kanalog::Kanalog;
use crate::kstep::AnalogOutput;
use crate::pins::{PINS, Pins};
use crate::stepgen::StepGenerators;
use crate::uart::Uart;

/// The number of registers.
pub const REGISTER_COUNT: u32 = FPGA.size / STRIDE;
/// The distance of two registers in bytes.
const STRIDE: u32 = 4;
/// The offset of a register within its four bytes.
const LANE: u32 = 2;
/// The number of groups of eight pins.
const GROUPS: u32 = PINS as u32 / 8;

/// A range of registers, with the effects of reading and writing one of them.
struct Registers {
    first: u32,
    last: u32,
    reads: fn(&mut Fpga, &mut RegisterChips<'_>, RegisterAccess) -> u32,
    /// Returns a notice if the write is futile.
    writes: fn(&mut Fpga, &mut RegisterChips<'_>, RegisterAccess, u32) -> Option<Notice>,
}

/// An access to a register.
#[derive(Clone, Copy, Debug)]
struct RegisterAccess {
    address: GuestAddr,
    size: AccessSize,
    /// The register's number in its range.
    index: u32,
}

macro_rules! registers {
    ($($(#[doc = $doc:literal])+ $first:tt $(+ $more:expr)?, $count:expr => $reads:ident, $writes:ident;)*) => {
        /// The registers that programs know. Source: io.md section 5.
        const REGISTERS: &[Registers] = &[$(Registers {
            first: $first $(+ $more)?,
            last: $first $(+ $more)? + $count - 1,
            reads: Fpga::$reads,
            writes: Fpga::$writes,
        },)*];
    };
}

// First number, count, read function, write function; `stored` and `store` only use the stored value.
registers! {
    /// Filter and pins of the encoder inputs.
    ENCODER_FILTER, 1 => read_stored, set_encoder_filter;
    /// Length, polarity and pins of the step pulses.
    0x06, 1 => read_stored, set_step_pulse;
    /// Errors of the encoder inputs; writing clears them.
    0x08, 1 => encoder_errors, clear_encoder_errors;
    /// Known to programs; here they only store.
    0x09, 5 => read_stored, store;
    /// Known to programs; here it only stores.
    0x10, 1 => read_stored, store;
    /// Counters of the encoder inputs, eight bits each.
    0x20, 8 => encoder_counter, ignore;
    /// Known to programs; here it only stores.
    0x28, 1 => read_stored, store;
    /// The prescaler of the PWM generators.
    PRESCALE, 1 => read_stored, set_pwm;
    /// The rate of a step generator, in four bytes; the last one makes it act.
    STEP_RATE, 4 => read_stored, set_step_rate;
    /// Positions of the step generators, low and high byte of each.
    0x40, 16 => step_position, store;
    /// Known to programs; here they only store.
    0x80, 8 => read_stored, store;
    /// Outputs of Kanalog: opto outputs and drivers, general outputs.
    0x88, 2 => kanalog_outputs, set_kanalog_outputs;
    /// Conversions of Kanalog's analog inputs.
    0x90, 8 => kanalog_conversion, ignore;
    /// Inputs of Kanalog: general inputs and opto inputs.
    0x98, 1 => kanalog_inputs, ignore;
    /// Selects the function of the port's pins.
    PORT_SELECT, 1 => read_stored, set_pwm;
    /// Characters of the UART.
    0xc0, 1 => uart_data, send_to_uart;
    /// The UART's status when read, its divisor when written.
    0xc1, 1 => uart_status, set_uart_divisor;
    /// Values and switches of the PWM generators, one after another.
    PWM, 2 * PWMS => read_stored, set_pwm;
    /// Ones set latches.
    0x100, GROUPS => read_stored, set_bits;
    /// Zeros clear latches.
    0x110, GROUPS => read_stored, clear_bits;
    /// Directions.
    0x120, GROUPS => directions, set_directions;
    /// Levels.
    0x130, GROUPS => read_levels, store;
}

/// Values at power-up: step pulses of 32 clocks, encoder filter 7.
const START: [(u32, u8); 2] = [(0x06, 32), (ENCODER_FILTER, 7)];

/// Registers whose stored values are used elsewhere.
const ENCODER_FILTER: u32 = 0x05;
const STEP_RATE: u32 = 0x3c;

/// The register that connects the port for the Kanalog and the UART to their pins, and its bits.
const PORT_SELECT: u32 = 0xa0;
const PORT_BYTE: usize = (PORT_SELECT * STRIDE + LANE) as usize;
const KANALOG_ON: u8 = 1;
const UART_ON: u8 = 2;
/// The bit that connects PWM 0 to a separate pin, for the analog output of a KStep.
const PWM_MOVED: u8 = 4;

/// The first register of the PWM generators, their number, and their prescaler.
const PWM: u32 = 0xd0;
const PWMS: u32 = 8;
const PRESCALE: u32 = 0x2f;

/// The first output bits and the first input bits of Kanalog.
const KANALOG_OUTPUTS: i32 = 144;
const KANALOG_INPUTS: i32 = 128;

/// The number of pins of JP7 occupied by the interface to Kanalog.
const JP7_PINS: u16 = 16;

/// The chips on which the registers act, and the time of an access.
#[derive(Debug)]
pub struct RegisterChips<'a> {
    /// Pins and option outputs.
    pub pins: &'a mut Pins,
    /// The serial port.
    pub uart: &'a mut Uart,
    /// Analog inputs.
    pub kanalog: &'a Kanalog,
    /// Encoder inputs.
    pub encoders: &'a mut Encoders,
    /// Step generators.
    pub stepgens: &'a mut StepGenerators,
    /// The time of the access.
    pub now: Cycles,
}

/// A futile action of a program on a register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Notice {
    /// A pin of the Kanalog's interface is made an output while a Kanalog is connected.
    KanalogPin(Bit),
    /// The serial port sends while it is not connected to its pins.
    UartUnconnected,
    /// The register with this number is unknown and only stores.
    UnknownRegister(u32),
}

/// The registers' stored values.
#[derive(Clone, Debug)]
pub struct Fpga {
    bytes: Box<[u8]>,
    /// The time until which the edges of watched PWM pins are reported.
    told: Cycles,
    kstep: AnalogOutput,
}

impl Default for Fpga {
    fn default() -> Self {
        let mut bytes = vec![0; FPGA.size as usize].into_boxed_slice();
        for (register, value) in START {
            bytes[(register * STRIDE + LANE) as usize] = value;
        }
        Self { bytes, told: Cycles::default(), kstep: AnalogOutput::default() }
    }
}

/// The address of a register.
#[must_use]
pub const fn register_address(number: u32) -> GuestAddr {
    FPGA.base.offset(number * STRIDE + LANE)
}

/// The register whose byte or half word is at an offset from the first register; `None` for the other bytes.
#[must_use]
pub const fn register_at(offset: u32) -> Option<u32> {
    if offset % STRIDE == LANE { Some(offset / STRIDE) } else { None }
}

/// A number of bits, beginning with a given one.
fn bits(first: i32, count: i32) -> impl Iterator<Item = Bit> {
    (first..first + count).filter_map(Bit::new)
}

/// The outputs of Kanalog that a register access affects: 8 opto outputs and 8 drivers, or the 8 general ones.
fn reached_outputs(index: u32, size: AccessSize) -> impl Iterator<Item = Bit> {
    let count = if index == 0 && size != AccessSize::Byte { 16 } else { 8 };
    bits(KANALOG_OUTPUTS + 16 * index as i32, count)
}

/// Levels as a word, the first level in the lowest bit.
fn word(levels: impl Iterator<Item = bool>) -> u32 {
    (0..).zip(levels).fold(0, |word, (index, level)| word | u32::from(level) << index)
}

/// The part of a word that fits the access size.
fn truncate_to_size(word: u32, size: AccessSize) -> u32 {
    if size == AccessSize::Byte { word & 0xff } else { word }
}

/// The register at an address, with its range and its index there.
fn register(address: GuestAddr) -> (u32, Option<(&'static Registers, u32)>) {
    let offset = address.get().wrapping_sub(FPGA.base.get());
    let number = offset / STRIDE;
    let range = REGISTERS.iter().find(|range| (range.first..=range.last).contains(&number));
    (number, range.filter(|_| offset % STRIDE == LANE).map(|range| (range, number - range.first)))
}

/// A notice if a pin belongs to JP7, for use while a Kanalog is connected.
#[must_use]
pub fn kanalog_pin(bit: Bit) -> Option<Notice> {
    (bit.get() < JP7_PINS).then_some(Notice::KanalogPin(bit))
}

impl Fpga {
    /// The registers before a firmware has started: all 0.
    #[must_use]
    pub fn at_power_up() -> Self {
        let bytes = vec![0; FPGA.size as usize].into_boxed_slice();
        Self { bytes, ..Self::default() }
    }

    /// Reads a register.
    pub fn read(&mut self, mut chips: RegisterChips<'_>, address: GuestAddr, size: AccessSize) -> u32 {
        match register(address).1 {
            Some((range, index)) => (range.reads)(self, &mut chips, RegisterAccess { address, size, index }),
            None => self.at(address, size),
        }
    }

    /// Writes a register; returns a notice if that is futile.
    pub fn write(
        &mut self,
        mut chips: RegisterChips<'_>,
        address: GuestAddr,
        size: AccessSize,
        value: u32,
    ) -> Option<Notice> {
        match register(address) {
            (_, Some((range, index))) => {
                (range.writes)(self, &mut chips, RegisterAccess { address, size, index }, value)
            }
            (number, None) => {
                self.write_stored(address, size, value);
                Some(Notice::UnknownRegister(number))
            }
        }
    }

    fn read_stored(&mut self, _: &mut RegisterChips<'_>, access: RegisterAccess) -> u32 {
        self.at(access.address, access.size)
    }

    fn store(&mut self, _: &mut RegisterChips<'_>, access: RegisterAccess, value: u32) -> Option<Notice> {
        self.write_stored(access.address, access.size, value);
        None
    }

    fn ignore(&mut self, _: &mut RegisterChips<'_>, _: RegisterAccess, _: u32) -> Option<Notice> {
        None
    }

    fn read_levels(&mut self, chips: &mut RegisterChips<'_>, access: RegisterAccess) -> u32 {
        chips.pins.level_group(access.index).into()
    }

    fn set_bits(
        &mut self,
        chips: &mut RegisterChips<'_>,
        access: RegisterAccess,
        value: u32,
    ) -> Option<Notice> {
        chips.pins.set_group(access.index, value as u8, chips.now);
        None
    }

    fn clear_bits(
        &mut self,
        chips: &mut RegisterChips<'_>,
        access: RegisterAccess,
        value: u32,
    ) -> Option<Notice> {
        chips.pins.clear_group(access.index, value as u8, chips.now);
        None
    }

    fn directions(&mut self, chips: &mut RegisterChips<'_>, access: RegisterAccess) -> u32 {
        chips.pins.direction_group(access.index).into()
    }

    fn set_directions(
        &mut self,
        chips: &mut RegisterChips<'_>,
        access: RegisterAccess,
        value: u32,
    ) -> Option<Notice> {
        let group = access.index;
        let new = value as u8 & !chips.pins.direction_group(group);
        chips.pins.set_direction_group(group, value as u8, chips.now);
        let first = Bit::new((8 * group + new.trailing_zeros()) as i32).filter(|_| new != 0);
        first.filter(|_| self.serves_kanalog()).and_then(kanalog_pin)
    }

    fn uart_data(&mut self, chips: &mut RegisterChips<'_>, _: RegisterAccess) -> u32 {
        chips.uart.read(chips.now).into()
    }

    fn send_to_uart(
        &mut self,
        chips: &mut RegisterChips<'_>,
        _: RegisterAccess,
        value: u32,
    ) -> Option<Notice> {
        chips.uart.send(value as u8, chips.now);
        (!self.has_uart_pins()).then_some(Notice::UartUnconnected)
    }

    fn uart_status(&mut self, chips: &mut RegisterChips<'_>, _: RegisterAccess) -> u32 {
        chips.uart.status(chips.now).into()
    }

    fn set_uart_divisor(
        &mut self,
        chips: &mut RegisterChips<'_>,
        _: RegisterAccess,
        value: u32,
    ) -> Option<Notice> {
        chips.uart.set_divisor(value as u8);
        None
    }

    fn encoder_counter(&mut self, chips: &mut RegisterChips<'_>, access: RegisterAccess) -> u32 {
        chips.encoders.counter(access.index as usize).into()
    }

    fn encoder_errors(&mut self, chips: &mut RegisterChips<'_>, _: RegisterAccess) -> u32 {
        chips.encoders.errors().into()
    }

    fn clear_encoder_errors(
        &mut self,
        chips: &mut RegisterChips<'_>,
        _: RegisterAccess,
        _: u32,
    ) -> Option<Notice> {
        chips.encoders.clear_errors();
        None
    }

    fn set_encoder_filter(
        &mut self,
        chips: &mut RegisterChips<'_>,
        access: RegisterAccess,
        value: u32,
    ) -> Option<Notice> {
        self.write_stored(access.address, access.size, value);
        let filter = [ENCODER_FILTER * STRIDE + LANE, ENCODER_FILTER * STRIDE + LANE + 1];
        let filter = filter.map(|at| self.bytes.get(at as usize).copied().unwrap_or_default());
        chips.encoders.set_filter(u16::from_le_bytes(filter), chips.pins, chips.now);
        None
    }

    fn set_step_pulse(
        &mut self,
        chips: &mut RegisterChips<'_>,
        access: RegisterAccess,
        value: u32,
    ) -> Option<Notice> {
        self.write_stored(access.address, access.size, value);
        chips.stepgens.set_up(value as u8, chips.pins, chips.now);
        None
    }

    fn set_step_rate(
        &mut self,
        chips: &mut RegisterChips<'_>,
        access: RegisterAccess,
        value: u32,
    ) -> Option<Notice> {
        self.write_stored(access.address, access.size, value);
        if access.index == 3 {
            let word: [u8; 4] = std::array::from_fn(|index| self.byte(STEP_RATE + index as u32));
            chips.stepgens.command(u32::from_le_bytes(word), chips.pins, chips.now);
        }
        None
    }

    fn step_position(&mut self, chips: &mut RegisterChips<'_>, access: RegisterAccess) -> u32 {
        let generator = (access.index / 2) as usize;
        if access.index % 2 == 1 {
            return chips.stepgens.position_high_byte(generator).into();
        }
        truncate_to_size(chips.stepgens.read(generator, chips.now).into(), access.size)
    }

    fn set_pwm(
        &mut self,
        chips: &mut RegisterChips<'_>,
        access: RegisterAccess,
        value: u32,
    ) -> Option<Notice> {
        self.tell_pwm(chips.pins, chips.now);
        self.write_stored(access.address, access.size, value);
        self.drive_pwm_pins(chips.pins, chips.now);
        self.tell_pwm(chips.pins, chips.now);
        self.kstep.drive(self.moved_pwm(), chips.now);
        None
    }

    fn kanalog_outputs(&mut self, chips: &mut RegisterChips<'_>, access: RegisterAccess) -> u32 {
        let outputs = reached_outputs(access.index, AccessSize::Half);
        truncate_to_size(word(outputs.map(|bit| chips.pins.written(bit))), access.size)
    }

    fn set_kanalog_outputs(
        &mut self,
        chips: &mut RegisterChips<'_>,
        access: RegisterAccess,
        value: u32,
    ) -> Option<Notice> {
        for (at, bit) in reached_outputs(access.index, access.size).enumerate() {
            chips.pins.write(bit, value >> at & 1 != 0, chips.now);
        }
        None
    }

    fn kanalog_inputs(&mut self, chips: &mut RegisterChips<'_>, access: RegisterAccess) -> u32 {
        truncate_to_size(word(bits(KANALOG_INPUTS, 16).map(|bit| chips.pins.input(bit))), access.size)
    }

    fn kanalog_conversion(&mut self, chips: &mut RegisterChips<'_>, access: RegisterAccess) -> u32 {
        truncate_to_size(chips.kanalog.conversion(access.index as usize), access.size)
    }

    /// Connects the UART to its pins.
    pub fn enable_uart_pins(&mut self) {
        self.bytes[PORT_BYTE] |= UART_ON;
    }

    /// Returns whether the port exchanges data with Kanalog.
    pub fn serves_kanalog(&self) -> bool {
        self.bytes[PORT_BYTE] & KANALOG_ON != 0
    }

    /// The value last written to a register.
    #[must_use]
    pub fn cell(&self, register: u32) -> u16 {
        self.at(register_address(register), AccessSize::Half) as u16
    }

    /// An eight-bit register as stored.
    fn byte(&self, register: u32) -> u8 {
        self.bytes.get((register * STRIDE + LANE) as usize).copied().unwrap_or_default()
    }

    /// Returns whether the UART is connected to pins.
    fn has_uart_pins(&self) -> bool {
        self.bytes[PORT_BYTE] & (UART_ON | KANALOG_ON) != 0
    }

    /// Returns the stored value at an address.
    fn at(&self, address: GuestAddr, size: AccessSize) -> u32 {
        let start = address.get().wrapping_sub(FPGA.base.get()) as usize;
        let bytes = self.bytes.get(start..start + size.bytes() as usize).unwrap_or_default();
        bytes.iter().rev().fold(0, |value, &byte| value << 8 | u32::from(byte))
    }

    /// Stores at an address.
    fn write_stored(&mut self, address: GuestAddr, size: AccessSize, value: u32) {
        let start = address.get().wrapping_sub(FPGA.base.get()) as usize;
        if let Some(bytes) = self.bytes.get_mut(start..start + size.bytes() as usize) {
            bytes.copy_from_slice(&value.to_le_bytes()[..size.bytes() as usize]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Registers and the chips on which they act.
    #[derive(Default)]
    pub(super) struct Bench {
        pub(super) fpga: Fpga,
        pub(super) pins: Pins,
        uart: Uart,
        kanalog: Kanalog,
        encoders: Encoders,
        stepgens: StepGenerators,
        pub(super) now: Cycles,
    }

    impl Bench {
        fn parts(&mut self) -> (&mut Fpga, RegisterChips<'_>) {
            let chips = RegisterChips {
                pins: &mut self.pins,
                uart: &mut self.uart,
                kanalog: &self.kanalog,
                encoders: &mut self.encoders,
                stepgens: &mut self.stepgens,
                now: self.now,
            };
            (&mut self.fpga, chips)
        }

        pub(super) fn read(&mut self, register: u32, size: AccessSize) -> u32 {
            let (fpga, chips) = self.parts();
            fpga.read(chips, register_address(register), size)
        }

        pub(super) fn write(&mut self, register: u32, size: AccessSize, value: u32) -> Option<Notice> {
            let (fpga, chips) = self.parts();
            fpga.write(chips, register_address(register), size, value)
        }
    }

    #[test]
    fn bit_registers_reach_the_pins() {
        let mut bench = Bench::default();
        let bit = Bit::new(46).expect("a bit");
        assert!(bench.pins.level(bit));
        bench.write(0x115, AccessSize::Byte, 0x3f);
        assert!(!bench.pins.level(bit));
        bench.write(0x105, AccessSize::Byte, 0xc0);
        assert!(bench.pins.level(bit));
        assert_eq!(bench.read(0x135, AccessSize::Byte), 0xc0);
    }

    #[test]
    fn kanalog_bits_and_conversions_are_in_registers() {
        let mut bench = Bench::default();
        let bit = |number| Bit::new(number).expect("a bit");
        bench.write(0x88, AccessSize::Half, 0x8101);
        bench.write(0x89, AccessSize::Byte, 0x02);
        let levels = [144, 152, 159, 160, 161].map(|number| bench.pins.written(bit(number)));
        assert_eq!(levels, [true, true, true, false, true]);
        bench.write(0x88, AccessSize::Byte, 0x02);
        assert_eq!((bench.read(0x88, AccessSize::Half), bench.read(0x89, AccessSize::Byte)), (0x8102, 2));
        for number in [128, 143] {
            bench.pins.drive(bit(number), true, Cycles::default());
        }
        assert_eq!((bench.read(0x98, AccessSize::Half), bench.read(0x98, AccessSize::Byte)), (0x8001, 1));
        bench.kanalog.drive(3, 4000);
        assert_eq!((bench.read(0x93, AccessSize::Half), bench.read(0x92, AccessSize::Half)), (4000, 2048));
    }

    #[test]
    fn making_a_kanalog_pin_an_output_is_reported() {
        let mut bench = Bench::default();
        bench.write(0xa0, AccessSize::Byte, 1);
        assert_eq!(bench.write(0x123, AccessSize::Byte, 0xff), None);
        let told = bench.write(0x121, AccessSize::Byte, 0x0c);
        assert_eq!(told, Bit::new(10).map(Notice::KanalogPin));
    }

    #[test]
    fn encoder_errors_are_cleared_by_writing() {
        let mut bench = Bench::default();
        bench.encoders.fail(2);
        assert_eq!(bench.read(0x08, AccessSize::Byte), 0x40);
        bench.write(0x08, AccessSize::Byte, 0);
        assert_eq!(bench.read(0x08, AccessSize::Byte), 0);
    }

    #[test]
    fn a_step_generator_has_a_four_byte_rate_and_two_byte_position() {
        let mut bench = Bench::default();
        // Generator 1, 0x800 units of 1.987 steps per second.
        for (register, value) in [(0x3c, 0), (0x3d, 8), (0x3e, 0), (0x3f, 0x89)] {
            bench.write(register, AccessSize::Byte, value);
        }
        bench.stepgens.run(0.01, &mut bench.pins, Cycles::PER_TICK);
        let word = bench.read(0x42, AccessSize::Half);
        assert_eq!(word, (0.01_f64 * 50e6 / 3.0 / 4096.0 * 128.0) as u32);
        assert_eq!(bench.read(0x42, AccessSize::Byte), word & 0xff);
        assert_eq!(bench.read(0x43, AccessSize::Byte), word >> 8);
    }

    #[test]
    fn other_registers_store_and_unknown_ones_are_reported() {
        let mut bench = Bench::default();
        assert_eq!(bench.write(0x06, AccessSize::Byte, 0x12), None);
        assert_eq!(bench.read(0x06, AccessSize::Byte), 0x12);
        assert_eq!(bench.write(0x200, AccessSize::Half, 0x1234), Some(Notice::UnknownRegister(0x200)));
        bench.write(0x200, AccessSize::Half, 0x5678);
        assert_eq!(bench.read(0x200, AccessSize::Half), 0x5678);
    }

    #[test]
    fn the_uart_works_and_reports_when_it_has_no_pins() {
        let mut bench = Bench::default();
        assert_eq!(bench.write(0xc0, AccessSize::Byte, 65), Some(Notice::UartUnconnected));
        assert_eq!(bench.read(0xc1, AccessSize::Byte), 0);
        bench.write(0xc0, AccessSize::Byte, 65);
        assert_eq!(bench.read(0xc1, AccessSize::Byte), 2);
        let mut bench = Bench::default();
        bench.fpga.enable_uart_pins();
        assert_eq!(bench.write(0xc0, AccessSize::Byte, 65), None);
    }
}
