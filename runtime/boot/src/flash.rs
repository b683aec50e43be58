//! The flash chip: two megabytes, and the commands that change them (`dsp-board.md` 7.9).
//!
//! The bytes are in guest memory; here is what the chip makes of writes.

use kmotiondef::GuestAddr;
use kmotiondef::map::FLASH;
use vm::memory::GuestMemory;

/// Offsets of the command addresses.
const FIRST: u32 = 0xAAAA;
const SECOND: u32 = 0x5554;
/// The chip's identity, and where it is read.
const IDENTITY: u32 = 0x234B;
const IDENTITY_AT: u32 = 2;
/// Bytes of a block.
const BLOCK: u32 = 0x1_0000;
/// Cycles that the chip takes to erase a block and to program a half word: 18 ms and 7 µs.
const ERASING: u64 = 3_600_000;
const PROGRAMMING: u64 = 1_400;
/// Bits of a busy chip: one turns from read to read, one is inverted.
const TOGGLE: u32 = 0x40;
const INVERTED: u32 = 0x80;

/// How far a command has come.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Heard {
    /// Nothing was written.
    #[default]
    Idle,
    /// AA was written.
    First,
    /// AA 55.
    Second,
    /// AA 55 80: something should be erased.
    Erase,
    /// AA 55 80 AA.
    EraseFirst,
    /// AA 55 80 AA 55.
    EraseSecond,
    /// AA 55 A0: the next write is programmed.
    Program,
}

/// The chip.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Chip {
    step: Heard,
    identifies: bool,
    /// The cycle in which it is ready again.
    busy_until: u64,
    toggle: u32,
}

impl Chip {
    /// The half word at an offset as the chip shows it.
    pub(super) fn read(&mut self, offset: u32, memory: &GuestMemory, now: u64) -> u32 {
        let stored = u32::from(memory.peek::<u16>(at(offset)));
        if now < self.busy_until {
            self.toggle ^= TOGGLE;
            return (stored ^ INVERTED) & !TOGGLE | self.toggle;
        }
        if self.identifies && offset == IDENTITY_AT { IDENTITY } else { stored }
    }

    /// The firmware writes a half word.
    pub(super) fn write(&mut self, offset: u32, value: u32, memory: &mut GuestMemory, now: u64) {
        let command = value & 0xFF;
        self.step = match (self.step, offset, command) {
            (Heard::Program, ..) => {
                let old = memory.peek::<u16>(at(offset));
                memory.poke(at(offset), old & value as u16);
                self.busy_until = now + PROGRAMMING;
                Heard::Idle
            }
            (Heard::EraseSecond, _, 0x50 | 0x30) => {
                let block = at(offset & !(BLOCK - 1));
                let erased = memory.poke_bytes(block, &[0xFF; BLOCK as usize]);
                debug_assert!(erased.is_ok(), "a block is inside the flash");
                self.busy_until = now + ERASING;
                Heard::Idle
            }
            (Heard::Idle, FIRST, 0xAA) => Heard::First,
            (Heard::First, SECOND, 0x55) => Heard::Second,
            (Heard::Second, FIRST, 0x90) => self.identify(true),
            (Heard::Second, FIRST, 0xF0) => self.identify(false),
            (Heard::Second, FIRST, 0x80) => Heard::Erase,
            (Heard::Second, FIRST, 0xA0) => Heard::Program,
            (Heard::Erase, FIRST, 0xAA) => Heard::EraseFirst,
            (Heard::EraseFirst, SECOND, 0x55) => Heard::EraseSecond,
            _ => Heard::Idle,
        };
    }

    const fn identify(&mut self, whether: bool) -> Heard {
        self.identifies = whether;
        Heard::Idle
    }
}

/// A place in the flash.
const fn at(offset: u32) -> GuestAddr {
    FLASH.base.offset(offset & (FLASH.size - 1))
}
