//! Registers of the two SnapAmp boards, which are not there: what is written is kept, measurements are fixed.
//!
//! Source: devices.md section 5. The general pins are bits 80 and 112 and on, and belong to the digital outputs.

/// Registers of a board.
const REGISTERS: usize = 32;
/// Addresses from the first register of board 0 to the last of board 1.
const BASE: usize = 0x40;
const BOARDS: usize = 2;

/// Readings of 48 V, 77 °F and 0 A.
const VOLTAGE: u16 = 30_916;
const TEMPERATURE: u16 = 616;
const CURRENT: u16 = 8192;

/// The general pins' registers.
pub(crate) const PINS: usize = 17;
pub(crate) const CLEAR: usize = 18;
pub(crate) const DIRECTION: usize = 19;

/// Reading it resets the board.
const RESET: usize = 31;

/// A register: the board and the number in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Register {
    pub(crate) board: usize,
    pub(crate) number: usize,
}

impl Register {
    /// The register at an address of `WriteSnapAmp` and `ReadSnapAmp`.
    pub(crate) fn new(address: i32) -> Option<Self> {
        let offset = usize::try_from(address).ok()?.checked_sub(BASE)?;
        let (board, number) = (offset / REGISTERS, offset % REGISTERS);
        (board < BOARDS).then_some(Self { board, number })
    }
}

/// What was written.
#[derive(Clone, Debug, Default)]
pub(crate) struct SnapAmps([[u16; REGISTERS]; BOARDS]);

impl SnapAmps {
    /// Stores a word.
    pub(crate) fn write(&mut self, register: Register, value: u16) {
        self.0[register.board][register.number] = value;
    }

    /// A reading: of what stands still and cool at 48 V, else what was written.
    pub(crate) fn read(&mut self, register: Register) -> u16 {
        match register.number {
            8..=11 | 16 | 30 => 0,
            12..=15 => CURRENT,
            22 | 23 => VOLTAGE,
            24 | 25 => TEMPERATURE,
            RESET => {
                self.0[register.board] = Default::default();
                0
            }
            number => self.0[register.board][number],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_name_board_and_register() {
        for (address, expect) in [
            (0x40, Some((0, 0))),
            (0x5f, Some((0, 31))),
            (0x60, Some((1, 0))),
            (0x7f, Some((1, 31))),
            (0x3f, None),
            (0x80, None),
            (-1, None),
        ] {
            let register = Register::new(address).map(|register| (register.board, register.number));
            assert_eq!(register, expect, "{address:#x}");
        }
    }

    #[test]
    fn pulse_widths_are_kept_until_a_reset() {
        let mut boards = SnapAmps::default();
        let register = |number| Register { board: 1, number };
        boards.write(register(2), 77);
        assert_eq!(boards.read(register(2)), 77);
        boards.read(register(RESET));
        assert_eq!(boards.read(register(2)), 0);
    }
}
