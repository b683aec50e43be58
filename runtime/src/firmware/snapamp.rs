//! Registers of the SnapAmp option board. Source: devices.md section 5.

use kmotiondef::Bit;
use kmotiondef::firmware::Function;
use kmotiondef::variables::{BIT_DIR_SHADOW_SNAP0, BIT_DIR_SHADOW_SNAP1};
use vm::firmware::Caller;

use super::parts::Parts;
use crate::io::snapamp::{CLEAR, CLEAR_ERRORS, DIRECTION, ENCODERS, LEVELS, PINS, Register};
use crate::out::Message;
use crate::views::TypedAccess;

/// General pins of a board, and the first of each board.
const COUNT: i32 = 14;
const FIRST: [i32; 2] = [80, 112];
/// Differential inputs of a board, and the first of each board.
const DIFFERENTIALS: i32 = 8;
const FIRST_DIFFERENTIAL: [i32; 2] = [64, 96];
/// The position of their directions in the board's word.
const SHADOW_SHIFT: i32 = 16;

/// The general pins of a board, lowest first.
fn pins(board: usize) -> impl Iterator<Item = Bit> {
    (0..COUNT).filter_map(move |pin| Bit::new(FIRST[board] + pin))
}

/// Levels of bits as a word, the first one lowest.
fn level_word(parts: &Parts, caller: &Caller<'_>, bits: impl Iterator<Item = Bit>) -> i32 {
    let levels = bits.map(|bit| parts.level(caller.memory, bit)).enumerate();
    levels.fold(0, |word, (index, level)| word | i32::from(level) << index)
}

/// The register that a program names.
fn checked(parts: &mut Parts, caller: &Caller<'_>, function: Function, address: i32) -> Option<Register> {
    let register = Register::new(address);
    if register.is_none() {
        parts.out.diagnose(caller, Message::NoSuchSnapRegister { function, address });
    }
    register
}

pub(crate) fn write_snap_amp(parts: &mut Parts, caller: &mut Caller<'_>, address: i32, data: i32) {
    let Some(register) = checked(parts, caller, Function::WriteSnapAmp, address) else { return };
    let now = caller.now();
    parts.io.snapamps.write(register, data as u16, now);
    match register.number {
        PINS | CLEAR => {
            for (index, bit) in pins(register.board).enumerate() {
                if data >> index & 1 != 0 {
                    parts.lines(now).write(caller.memory, bit, register.number == PINS);
                }
            }
        }
        CLEAR_ERRORS => parts.io.encoders.clear_snap_errors(register.board),
        DIRECTION => {
            let shadow = [BIT_DIR_SHADOW_SNAP0, BIT_DIR_SHADOW_SNAP1][register.board];
            caller.memory.set(shadow, (data & ((1 << COUNT) - 1)) << SHADOW_SHIFT);
        }
        _ => {}
    }
}

pub(crate) fn read_snap_amp(parts: &mut Parts, caller: &mut Caller<'_>, address: i32) -> i32 {
    let Some(register) = checked(parts, caller, Function::ReadSnapAmp, address) else { return 0 };
    let Register { board, number } = register;
    match number {
        PINS => level_word(parts, caller, pins(board)),
        LEVELS => {
            let first = FIRST_DIFFERENTIAL[board];
            let inputs = (first..first + DIFFERENTIALS).filter_map(Bit::new);
            level_word(parts, caller, inputs) << DIFFERENTIALS
                | i32::from(parts.io.encoders.snap_levels(board))
        }
        number if ENCODERS.contains(&number) => {
            parts.io.encoders.snap_word(board, number - ENCODERS.start()).into()
        }
        _ => parts.io.snapamps.read(register, caller.now()).into(),
    }
}

#[cfg(test)]
mod tests {
    use kmotiondef::Cycles;

    use super::*;
    use crate::testing::TestBench;

    #[test]
    fn pins_are_the_numbered_bits() {
        let mut bench = TestBench::new();
        bench.call("WriteSnapAmp", &[0x60 + 19, 0b11]);
        bench.call("WriteSnapAmp", &[0x60 + 17, 0b11]);
        bench.call("WriteSnapAmp", &[0x60 + 18, 0b10]);
        assert_eq!(bench.call_i32("ReadSnapAmp", &[0x60 + 17]), 0b01);
        assert_eq!(bench.call_i32("ReadBit", &[112]), 1);
        assert_eq!(bench.call_i32("ReadBit", &[113]), 0);
    }

    #[test]
    fn encoders_and_inputs_have_their_registers() {
        let mut bench = TestBench::new();
        bench.kernel.parts.io.encoders.count(13, -2, &mut bench.kernel.parts.io.pins, Cycles::default());
        bench.kernel.parts.io.encoders.fail(13);
        bench.kernel.parts.io.pins.drive(Bit::new(96 + 3).expect("a bit"), true, Cycles::default());
        assert_eq!(bench.call_i32("ReadSnapAmp", &[0x60 + 9]), 0x80fe);
        assert_eq!(bench.call_i32("ReadSnapAmp", &[0x60 + 16]), 0x080c);
        bench.call("WriteSnapAmp", &[0x60 + 8, 0]);
        assert_eq!(bench.call_i32("ReadSnapAmp", &[0x60 + 9]), 0x00fe);
    }

    #[test]
    fn a_missing_board_reads_48_volts_and_no_current() {
        let mut bench = TestBench::new();
        for (register, expect) in [(12, 8192), (22, 30_916), (24, 616), (30, 0)] {
            assert_eq!(bench.call_i32("ReadSnapAmp", &[0x40 + register]), expect, "{register}");
        }
    }
}
