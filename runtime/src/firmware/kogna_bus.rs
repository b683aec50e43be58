//! Registers of a Kogna on the bus, at its addresses.
//!
//! Register r of the FPGA is the half word at base + 2·r; a word has two of them. The registers that a KFLOP has too are
//! served by its model, the others are not simulated. Source: its header.

use kmotiondef::map::{FPGA, MemoryMap};
use kmotiondef::{AccessSize, Cycles, GuestAddr};

use super::parts::Parts;
use crate::io::timer;
use crate::out::Message;

/// The register of a KFLOP with the same function as a register of a Kogna, if there is one.
const fn register_of_kflop(number: u32) -> Option<u32> {
    match number {
        // The prescaler of the PWM generators has moved.
        0x3F => Some(0x2F),
        // Rates of the generators; positions of generators 8 to 15; RS485 and differential step pulses.
        0x2F | 0x3C..=0x3E | 0x50..=0x5F | 0xA1..=0xA3 => None,
        // Bits from 200 on, which are accessed by functions.
        0x106..=0x10F | 0x116..=0x11F | 0x126..=0x12F | 0x136..=0x13F => None,
        0x140.. => None,
        number => Some(number),
    }
}

/// The place of a register in the model of a KFLOP.
const fn place(number: u32) -> GuestAddr {
    FPGA.base.offset(4 * number + 2)
}

/// The number of the register at an address, which the upper byte of a half word does not have.
fn number(map: &MemoryMap, address: GuestAddr) -> Option<u32> {
    let offset = address.get() - map.fpga.base.get();
    offset.is_multiple_of(2).then_some(offset / 2)
}

/// Sizes of the accesses that one of a size is, and the bits of each.
const fn halves(size: AccessSize) -> (AccessSize, u32) {
    match size {
        AccessSize::Byte => (AccessSize::Byte, 1),
        AccessSize::Half => (AccessSize::Half, 1),
        AccessSize::Word => (AccessSize::Half, 2),
    }
}

/// Reads a register.
pub(crate) fn read(parts: &mut Parts, address: GuestAddr, size: AccessSize, now: Cycles) -> u32 {
    let map = parts.level.board().map();
    let timer = map.timer0();
    if address == timer {
        return timer::count_of(map, now) as u32;
    }
    if address == timer.offset(4) {
        return (timer::count_of(map, now) >> 32) as u32;
    }
    if !map.fpga.holds(address) {
        return parts.io.kogna.as_ref().and_then(|kogna| kogna.read(address, size)).unwrap_or(0);
    }
    let Some(first) = number(map, address) else { return 0 };
    let (size, count) = halves(size);
    let mut value = 0;
    for index in 0..count {
        let part = match register_of_kflop(first + index) {
            Some(register) => parts.read_register(place(register), size, now),
            None => {
                parts.out.remark(now, Message::RegisterNotSimulated { number: first + index });
                0
            }
        };
        value |= part << (16 * index);
    }
    value
}

/// Writes a register.
pub(crate) fn write(parts: &mut Parts, address: GuestAddr, size: AccessSize, value: u32, now: Cycles) {
    let map = parts.level.board().map();
    if !map.fpga.holds(address) {
        let written = parts.io.kogna.as_mut().and_then(|kogna| kogna.write(address, size, value));
        if written.is_none() {
            parts.out.remark(now, Message::NoEffect { address });
        }
        return;
    }
    let Some(first) = number(map, address) else { return };
    let (size, count) = halves(size);
    for index in 0..count {
        match register_of_kflop(first + index) {
            Some(register) => {
                parts.write_register(place(register), size, value >> (16 * index) & 0xFFFF, now);
            }
            None => parts.out.remark(now, Message::RegisterNotSimulated { number: first + index }),
        }
    }
}
