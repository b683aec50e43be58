//! Numbered inputs and outputs, wherever they are: pins, option boards, words of guest memory. Source: io.md.

use kmotiondef::bits::{BitKind, range_of};
use kmotiondef::variables::{
    BIT_DIR_SHADOW, BIT_DIR_SHADOW_SNAP0, BIT_DIR_SHADOW_SNAP1, KSTEP_PRESENT, VIRTUAL_BITS, VIRTUAL_BITS_EX,
};
use kmotiondef::{Bit, Cycles, Place};
use vm::memory::GuestMemory;

use super::{Io, changes, kanalog};
use crate::out::{Message, Out};
use crate::views::Typed;

/// The first virtual bit.
const VIRTUAL: u16 = 48;
/// The first extended virtual bit.
const VIRTUAL_EX: u16 = 1024;
/// The first pin of SnapAmp 0 and of SnapAmp 1.
const SNAP: [u16; 2] = [64, 96];

/// The word and mask that hold a bit kept in memory.
fn memory_bit(bit: Bit, kind: BitKind) -> Option<(Place<i32>, i32)> {
    match kind {
        BitKind::Virtual => Some((VIRTUAL_BITS, 1 << (bit.get() - VIRTUAL))),
        BitKind::VirtualEx => {
            let number = bit.get() - VIRTUAL_EX;
            Some((VIRTUAL_BITS_EX.element(usize::from(number / 32)), 1 << (number % 32)))
        }
        _ => None,
    }
}

/// The word and mask that hold the direction of a SnapAmp's pin.
fn snap_direction(bit: Bit) -> (Place<i32>, i32) {
    if bit.get() < SNAP[1] {
        (BIT_DIR_SHADOW_SNAP0, 1 << (bit.get() - SNAP[0]))
    } else {
        (BIT_DIR_SHADOW_SNAP1, 1 << (bit.get() - SNAP[1]))
    }
}

/// Sets or clears `mask` in a word.
fn change(memory: &mut GuestMemory, word: Place<i32>, mask: i32, set: bool) {
    let value = memory.get(word);
    memory.set(word, if set { value | mask } else { value & !mask });
}

/// Makes a pin an output or an input; other bits are what they are.
pub(crate) fn set_direction(io: &mut Io, memory: &mut GuestMemory, bit: Bit, is_output: bool, now: Cycles) {
    match range_of(bit).map(|range| range.kind) {
        Some(BitKind::Pin) => {
            io.pins.set_output(bit, is_output, now);
            let word = BIT_DIR_SHADOW.element(bit.index() / 32);
            change(memory, word, 1 << (bit.get() % 32), is_output);
        }
        Some(BitKind::SnapGpio) => {
            let (word, mask) = snap_direction(bit);
            change(memory, word, mask, is_output);
        }
        _ => {}
    }
}

/// Whether a bit is an output. Outputs of option boards count as inputs, as the board has it.
pub(crate) fn is_output(io: &Io, bit: Bit) -> bool {
    match range_of(bit).map(|range| range.kind) {
        Some(BitKind::Pin | BitKind::Led) => io.pins.is_output(bit),
        Some(BitKind::Virtual) => true,
        _ => false,
    }
}

/// Writes a bit; inputs and numbers that nothing answers ignore it. Devices on the bit have not seen it yet.
pub(crate) fn write_bit(
    io: &mut Io,
    out: &mut Out,
    memory: &mut GuestMemory,
    bit: Bit,
    level: bool,
    now: Cycles,
) {
    let Some(kind) = range_of(bit).map(|range| range.kind) else { return };
    match kind {
        BitKind::Pin | BitKind::Led => io.pins.set_latch(bit, level, now),
        BitKind::KanalogOptoOutput | BitKind::KanalogFet | BitKind::KanalogOutput => {
            if !kanalog::is_served(&io.fpga, memory) {
                out.remark(now, Message::KanalogOff { bit });
            }
            io.pins.write(bit, level, now);
        }
        BitKind::SnapGpio => io.pins.write(bit, level, now),
        _ => {
            if let Some((word, mask)) = memory_bit(bit, kind) {
                change(memory, word, mask, level);
                changes::sweep(&mut io.pins.changes, memory, now);
            }
        }
    }
}

/// The state of a bit and whether it is an input from outside.
pub(crate) fn bit_state(io: &Io, memory: &GuestMemory, bit: Bit) -> (bool, bool) {
    let pins = &io.pins;
    let Some(kind) = range_of(bit).map(|range| range.kind) else { return (false, false) };
    match kind {
        BitKind::Pin | BitKind::Led => (pins.level(bit), !pins.is_output(bit)),
        BitKind::KanalogOptoOutput | BitKind::KanalogFet | BitKind::KanalogOutput => {
            (pins.written(bit), false)
        }
        BitKind::SnapGpio => {
            let (word, mask) = snap_direction(bit);
            if memory.get(word) & mask != 0 { (pins.written(bit), false) } else { (pins.input(bit), true) }
        }
        // Nobody switches the banks of KStep's inputs through before it is announced.
        BitKind::KstepInput if memory.get(KSTEP_PRESENT) == 0 => (false, false),
        _ => match memory_bit(bit, kind) {
            Some((word, mask)) => (memory.get(word) & mask != 0, false),
            None => (pins.input(bit), true),
        },
    }
}
