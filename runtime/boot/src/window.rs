//! The window on the registers of the FPGA: the byte link to the PC, and the chips (`dsp-board.md` 6 and 7).

use chips::Chips;
use chips::fpga::{REGISTER_COUNT, register_address, register_at};
use kmotiondef::{AccessSize, Bit, Cycles};

use super::external::ExternalHardware;
use super::link::Link;

/// Registers of the link: status and data. The transmitter (0x008, bit 0) is always ready.
const LINK_STATUS: u32 = 0x004;
const LINK_DATA: u32 = 0x005;
/// The SnapAmps' bus, which reads 0: no SnapAmp is connected.
const SNAP_BUS: [u32; 3] = [0x003, 0x00C, 0x00D];
/// Registers whose settings affect hardware that is connected later: encoder filter, step pulses, port.
const SETTINGS: [u32; 3] = [0x005, 0x006, 0x0A0];
/// Registers for pins in groups of eight.
const SET: u32 = 0x100;
const KEEP: u32 = 0x110;
const DIRECT: u32 = 0x120;
const READ: u32 = 0x130;
const GROUPS: u32 = 6;

/// The window, and the chips accessible through it.
#[derive(Clone, Debug)]
pub(super) struct Window<A = ()> {
    pub(super) chips: Chips,
    pub(super) link: Link,
    /// The inputs of a KStep, if there is one: a bit is set while current flows.
    pub(super) kstep: Option<u16>,
    /// The connected external hardware, if there is any.
    pub(super) external: Option<A>,
    /// The number of accesses other than to the status of the link.
    touches: u64,
}

impl<A> Default for Window<A> {
    fn default() -> Self {
        Self { chips: Chips::at_power_up(), link: Link::default(), kstep: None, external: None, touches: 0 }
    }
}

/// The time of a cycle since power-up.
pub(super) const fn instant(cycle: u64) -> Cycles {
    Cycles::new(cycle.cast_signed())
}

/// A pin.
pub(super) fn bit(pin: usize) -> Option<Bit> {
    i32::try_from(pin).ok().and_then(Bit::new)
}

const fn size(bytes: u32) -> AccessSize {
    if bytes == 1 { AccessSize::Byte } else { AccessSize::Half }
}

/// The register of an access; word accesses, and bytes outside a register's, have none.
fn register_of(offset: u32, bytes: u32) -> Option<u32> {
    register_at(offset % (REGISTER_COUNT * 4)).filter(|_| bytes <= 2)
}

impl<A: ExternalHardware> Window<A> {
    /// Resets it to the state at power-up, except for the link and connected hardware.
    pub(super) fn reset(&mut self) {
        let old = std::mem::take(self);
        let chips = Chips { encoders: old.chips.encoders, ..Chips::at_power_up() };
        *self = Self { chips, link: old.link, kstep: old.kstep, external: old.external, touches: 0 };
    }

    /// Connects external hardware, which is informed of the present directions and latches.
    pub(super) fn connect<B: ExternalHardware>(self, mut external: Option<B>, now: u64) -> Window<B> {
        let Self { chips, link, kstep, touches, .. } = self;
        if let Some(external) = &mut external {
            let Chips { fpga, pins, .. } = &chips;
            for register in SETTINGS {
                external.write(register as usize, false, fpga.cell(register), now);
            }
            for group in 0..GROUPS {
                let latch = u16::from(pins.latch_group(group));
                external.write((KEEP + group) as usize, true, latch, now);
                external.write((SET + group) as usize, true, latch, now);
                external.write((DIRECT + group) as usize, true, pins.direction_group(group).into(), now);
            }
        }
        Window { chips, link, kstep, external, touches }
    }

    /// The number of steps made by a generator up to a cycle, and its rate in steps per second.
    pub(super) fn steps(&mut self, generator: usize, now: u64) -> (f64, f64) {
        let stepgens = &mut self.chips.stepgens;
        stepgens.count(generator, instant(now));
        (stepgens.position(generator), stepgens.rate(generator))
    }

    /// Returns the number of accesses other than to the status of the link.
    pub(super) const fn touches(&self) -> u64 {
        self.touches
    }

    pub(super) fn read(&mut self, offset: u32, bytes: u32, now: u64) -> u32 {
        let Some(register) = register_of(offset, bytes) else { return 0 };
        if register == LINK_STATUS {
            let status = self.link.status();
            self.touches += u64::from(status != 0);
            return u32::from(status);
        }
        self.touches += 1;
        let is_byte = bytes == 1;
        let answered =
            self.external.as_mut().and_then(|external| external.read(register as usize, is_byte, now));
        let value = answered.unwrap_or_else(|| self.value(register, size(bytes), now));
        let value = if register == READ { self.with_kstep(value) } else { value };
        u32::from(if is_byte { value & 0xFF } else { value })
    }

    fn value(&mut self, register: u32, size: AccessSize, now: u64) -> u16 {
        if register == LINK_DATA {
            return self.link.take_byte();
        }
        if SNAP_BUS.contains(&register) {
            return 0;
        }
        let (fpga, chips) = self.chips.registers(instant(now));
        fpga.read(chips, register_address(register), size) as u16
    }

    /// Pins 0 to 7; a KStep switches four of them among its inputs, selected by latches 2 and 3.
    fn with_kstep(&self, pins: u16) -> u16 {
        let Some(inputs) = self.kstep else { return pins };
        let select = pins >> 2 & 3;
        let nibble = !(inputs >> (4 * select)) & 0xF;
        pins & 0xF | nibble << 4
    }

    pub(super) fn write(&mut self, offset: u32, bytes: u32, value: u32, now: u64) {
        let Some(register) = register_of(offset, bytes) else { return };
        self.touches += 1;
        let value = if bytes == 1 { value & 0xFF } else { value } as u16;
        if register == LINK_STATUS {
            return self.link.record_sent(value as u8, now);
        }
        if let Some(external) = &mut self.external {
            external.write(register as usize, bytes == 1, value, now);
        }
        let (fpga, chips) = self.chips.registers(instant(now));
        // The firmware knows its registers: a notice is only for programs.
        let _ = fpga.write(chips, register_address(register), size(bytes), value.into());
    }
}
