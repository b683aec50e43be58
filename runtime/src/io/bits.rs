//! Numbered inputs and outputs of all kinds: pins, option boards, words of guest memory. Source: io.md.

use chips::pins::PINS;
use kmotiondef::bits::{BitKind, BitRange, kogna_range_of};
use kmotiondef::variables::{
    BIT_DIR_SHADOW, BIT_DIR_SHADOW_SNAP0, BIT_DIR_SHADOW_SNAP1, KSTEP_PRESENT, VIRTUAL_BITS, VIRTUAL_BITS_EX,
};
use kmotiondef::{Bit, Cycles, Place};
use vm::memory::GuestMemory;

use super::{Io, changes, kanalog};
use crate::out::{Message, Out};
use crate::views::TypedAccess;

/// The first virtual bit.
const VIRTUAL: u16 = 48;
/// The first extended virtual bit.
const VIRTUAL_EX: u16 = 1024;
/// The first pin of SnapAmp 0 and of SnapAmp 1.
const SNAP: [u16; 2] = [64, 96];

/// The range of a bit, if this board has one.
pub(crate) fn range_of(io: &Io, bit: Bit) -> Option<&'static BitRange> {
    let of_kogna = || io.kogna.as_ref().and_then(|_| kogna_range_of(bit));
    kmotiondef::bits::range_of(bit).or_else(of_kogna)
}

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

/// The location of the direction of a bit from 64 on.
struct SnapDirection {
    word: Place<i32>,
    /// The number of bits by which a mask is shifted there; from 32 on it is shifted out.
    shift: u32,
}

impl SnapDirection {
    /// Board quirk: there are words for 64 bits, but the processor uses six bits of a shift count, so directions of
    /// later bits are stored over these, or nowhere.
    fn of(bit: Bit) -> Self {
        if bit.get() < SNAP[1] {
            Self { word: BIT_DIR_SHADOW_SNAP0, shift: u32::from(bit.get() - SNAP[0]) }
        } else {
            Self { word: BIT_DIR_SHADOW_SNAP1, shift: u32::from(bit.get() - SNAP[1]) % 64 }
        }
    }
}

/// Sets or clears `mask` in a word.
fn change(memory: &mut GuestMemory, word: Place<i32>, mask: i32, set: bool) {
    let value = memory.get(word);
    memory.set(word, if set { value | mask } else { value & !mask });
}

/// Makes a pin an output or an input; virtual bits are unchanged. The direction of other bits is noted, even without a
/// SnapAmp.
pub(crate) fn set_direction(io: &mut Io, memory: &mut GuestMemory, bit: Bit, is_output: bool, now: Cycles) {
    if let Some(kogna) = &mut io.kogna
        && kogna_range_of(bit).is_some()
    {
        kogna.set_output(memory, bit, is_output);
    } else if bit.get() < PINS {
        io.pins.set_output(bit, is_output, now);
        let word = BIT_DIR_SHADOW.element(bit.index() / 32);
        change(memory, word, 1 << (bit.get() % 32), is_output);
    } else if bit.get() >= SNAP[0] {
        let SnapDirection { word, shift } = SnapDirection::of(bit);
        change(memory, word, 1_i32.checked_shl(shift).unwrap_or(0), is_output);
    }
}

/// Returns whether a bit is an output. Outputs of option boards count as inputs until a program sets their direction,
/// as on the board.
pub(crate) fn is_output(io: &Io, memory: &GuestMemory, bit: Bit) -> bool {
    if let Some(kogna) = &io.kogna
        && kogna_range_of(bit).is_some()
    {
        kogna.is_output(bit)
    } else if bit.get() < PINS {
        io.pins.is_output(bit)
    } else if bit.get() < SNAP[0] {
        true
    } else {
        let SnapDirection { word, shift } = SnapDirection::of(bit);
        memory.get(word) >> shift.min(31) & 1 != 0
    }
}

/// Writes a bit; inputs and unused numbers ignore it. Devices on the bit are not notified yet.
pub(crate) fn write_bit(
    io: &mut Io,
    out: &mut Out,
    memory: &mut GuestMemory,
    bit: Bit,
    level: bool,
    now: Cycles,
) {
    let Some(kind) = range_of(io, bit).map(|range| range.kind) else { return };
    match kind {
        BitKind::Pin | BitKind::Led => io.pins.set_latch(bit, level, now),
        BitKind::KanalogOptoOutput | BitKind::KanalogFet | BitKind::KanalogOutput => {
            if !kanalog::is_served(&io.fpga, memory) {
                out.remark(now, Message::KanalogOff { bit });
            }
            if let Some(group) = io.outputs.group_with(bit, level) {
                io.outputs.store(group);
                group.put_out(&mut io.pins, now);
            }
        }
        BitKind::SnapGpio | BitKind::KognaPin | BitKind::KognaOutput => io.pins.write(bit, level, now),
        _ => {
            if let Some((word, mask)) = memory_bit(bit, kind) {
                change(memory, word, mask, level);
                changes::scan_virtual_bits(&mut io.pins.changes, memory, now);
            }
        }
    }
}

/// The level of a bit, and whether it is an input from outside.
pub(crate) fn bit_state(io: &Io, memory: &GuestMemory, bit: Bit) -> (bool, bool) {
    let pins = &io.pins;
    let Some(kind) = range_of(io, bit).map(|range| range.kind) else { return (false, false) };
    match kind {
        BitKind::Pin | BitKind::Led => (pins.level(bit), !pins.is_output(bit)),
        BitKind::KanalogOptoOutput | BitKind::KanalogFet | BitKind::KanalogOutput => {
            (pins.written(bit), false)
        }
        BitKind::SnapGpio => {
            let SnapDirection { word, shift } = SnapDirection::of(bit);
            let mask = 1 << shift;
            if memory.get(word) & mask != 0 { (pins.written(bit), false) } else { (pins.input(bit), true) }
        }
        BitKind::KognaPin | BitKind::KognaOutput => match &io.kogna {
            Some(kogna) if kogna.is_output(bit) => (pins.written(bit), false),
            _ => (pins.input(bit), true),
        },
        // The banks of KStep's inputs are only switched through once a program announces the KStep.
        BitKind::KstepInput if memory.get(KSTEP_PRESENT) == 0 => (false, false),
        _ => match memory_bit(bit, kind) {
            Some((word, mask)) => (memory.get(word) & mask != 0, false),
            None => (pins.input(bit), true),
        },
    }
}
