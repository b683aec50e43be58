//! The flash chip: two megabytes, and the commands that change them.
//!
//! The bytes are in guest memory, whose owner applies the changes that result from a write to the chip. Source:
//! dsp-board.md section 7.9.

use kmotiondef::Cycles;
use kmotiondef::map::FLASH;

/// The number of bytes erased at once.
pub const BLOCK: u32 = 0x1_0000;
/// The offset of the users' half; the first half belongs to the system.
pub const USER: u32 = 0x10_0000;
/// The value of erased bytes.
pub const ERASED: u8 = 0xFF;
/// The offsets to which commands are written.
pub const COMMANDS: [u32; 2] = [FIRST, SECOND];

const FIRST: u32 = 0xAAAA;
const SECOND: u32 = 0x5554;
/// The chip's identifier, and the offset at which it is read.
const IDENTITY: u16 = 0x234B;
const IDENTITY_AT: u32 = 2;
/// The times for erasing a block and programming a half word: 18 ms and 7 µs.
const ERASING: Cycles = Cycles::new(3_600_000);
const PROGRAMMING: Cycles = Cycles::new(1_400);
/// Status bits of a busy chip: one toggles with each read, one is inverted.
const TOGGLE: u16 = 0x40;
const INVERTED: u16 = 0x80;

/// A change of the chip's bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
pub enum Change {
    /// The half word at an offset is programmed: bits are cleared where `mask` has zeros.
    Program {
        /// The half word.
        offset: u32,
        /// The bits that are kept.
        mask: u16,
    },
    /// The block at an offset is erased.
    Erase {
        /// Its first byte.
        offset: u32,
    },
}

/// The progress of a command sequence.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum CommandState {
    /// Nothing was written.
    #[default]
    Idle,
    /// AA was written.
    First,
    /// AA 55.
    Second,
    /// AA 55 80: an erase command follows.
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
pub struct Chip {
    step: CommandState,
    identifies: bool,
    busy_until: Cycles,
    toggle: u16,
}

impl Chip {
    /// The half word that the chip returns at an offset, where `stored` is the content of its cells.
    pub fn read(&mut self, offset: u32, stored: u16, now: Cycles) -> u16 {
        if now < self.busy_until {
            self.toggle ^= TOGGLE;
            return (stored ^ INVERTED) & !TOGGLE | self.toggle;
        }
        if self.identifies && offset == IDENTITY_AT { IDENTITY } else { stored }
    }

    /// Handles a half word written to an offset; returns the resulting change of the cells, if there is one.
    pub fn write(&mut self, offset: u32, value: u16, now: Cycles) -> Option<Change> {
        let (step, change) = self.step(offset, value);
        self.step = step;
        self.busy_until = match change {
            Some(Change::Program { .. }) => now + PROGRAMMING,
            Some(Change::Erase { .. }) => now + ERASING,
            None => self.busy_until,
        };
        change
    }

    fn step(&mut self, offset: u32, value: u16) -> (CommandState, Option<Change>) {
        let inside = offset & (FLASH.size - 1);
        let step = match (self.step, offset, value & 0xFF) {
            (CommandState::Program, ..) => {
                return (CommandState::Idle, Some(Change::Program { offset: inside, mask: value }));
            }
            (CommandState::EraseSecond, _, 0x50 | 0x30) => {
                return (CommandState::Idle, Some(Change::Erase { offset: inside & !(BLOCK - 1) }));
            }
            (CommandState::Idle, FIRST, 0xAA) => CommandState::First,
            (CommandState::First, SECOND, 0x55) => CommandState::Second,
            (CommandState::Second, FIRST, 0x90) => self.identify(true),
            (CommandState::Second, FIRST, 0xF0) => self.identify(false),
            (CommandState::Second, FIRST, 0x80) => CommandState::Erase,
            (CommandState::Second, FIRST, 0xA0) => CommandState::Program,
            (CommandState::Erase, FIRST, 0xAA) => CommandState::EraseFirst,
            (CommandState::EraseFirst, SECOND, 0x55) => CommandState::EraseSecond,
            _ => CommandState::Idle,
        };
        (step, None)
    }

    const fn identify(&mut self, whether: bool) -> CommandState {
        self.identifies = whether;
        CommandState::Idle
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Writes a command to the chip; returns the change that results from its last write.
    fn command(chip: &mut Chip, writes: &[(u16, u32)], now: Cycles) -> Option<Change> {
        writes.iter().fold(None, |_, (value, offset)| chip.write(*offset, *value, now))
    }

    #[test]
    fn a_block_is_erased_and_a_half_word_programmed_by_their_commands() {
        let (mut chip, now) = (Chip::default(), Cycles::new(1000));
        let erase =
            [(0xAA, FIRST), (0x55, SECOND), (0x80, FIRST), (0xAA, FIRST), (0x55, SECOND), (0x50, USER + 6)];
        assert_eq!(command(&mut chip, &erase, now), Some(Change::Erase { offset: USER }));
        let busy = [chip.read(USER, 0xFFFF, now), chip.read(USER, 0xFFFF, now)];
        assert_eq!((busy[0] ^ busy[1], busy[0] & INVERTED), (TOGGLE, 0), "bit 6 turns, bit 7 is inverted");
        assert_eq!(chip.read(USER, 0xFFFF, now + ERASING), 0xFFFF);
        let program = [(0xAA, FIRST), (0x55, SECOND), (0xA0, FIRST), (0x1234, USER + 2)];
        let change = command(&mut chip, &program, now + ERASING);
        assert_eq!(change, Some(Change::Program { offset: USER + 2, mask: 0x1234 }));
        assert_eq!(command(&mut chip, &[(0x1234, USER + 2)], now), None, "only after its command");
    }

    #[test]
    fn the_identity_is_shown_between_its_two_commands() {
        let (mut chip, now) = (Chip::default(), Cycles::default());
        for (last, shown) in [(0x90, IDENTITY), (0xF0, 7)] {
            assert_eq!(command(&mut chip, &[(0xAA, FIRST), (0x55, SECOND), (last, FIRST)], now), None);
            assert_eq!(chip.read(IDENTITY_AT, 7, now), shown);
        }
    }
}
