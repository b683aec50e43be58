//! Digital and analog inputs and outputs, and registers.

use kmotiondef::AccessSize;
use kmotiondef::firmware::Function;
use kmotiondef::limits::N_DACS;
use kmotiondef::variables::{DAC_BUFFER, VIRTUAL_BITS_EX};

use super::arguments::Values;
use super::session::{Answer, Session};
use crate::firmware::{io, kogna, kogna_bus};
use crate::views::TypedAccess;

/// The first LED.
const LED0: i32 = 46;
/// The converters' word for zero.
const ZERO: i32 = 2048;
/// The size of the board's buffer for the words of a reply, in characters; a longer reply overwrites the return
/// address.
const ANSWER_ROOM: usize = 84;

pub(super) fn set_bit(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    session.call(|parts, caller| io::command_bit(parts, caller, Function::SetBit, values.integer(0), true));
    Answer::Nothing
}

pub(super) fn clear_bit(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    session
        .call(|parts, caller| io::command_bit(parts, caller, Function::ClearBit, values.integer(0), false));
    Answer::Nothing
}

pub(super) fn set_state_bit(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let (bit, state) = (values.integer(0), values.integer(1));
    session.call(|parts, caller| io::command_bit(parts, caller, Function::SetStateBit, bit, state != 0));
    Answer::Nothing
}

pub(super) fn led(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let (bit, state) = (LED0 + values.integer(0), values.integer(1));
    session.call(|parts, caller| io::command_bit(parts, caller, Function::SetStateBit, bit, state != 0));
    Answer::Nothing
}

/// The level, without a remark about undriven inputs: a user reads them on purpose.
pub(super) fn read_bit(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    i32::from(session.parts.level(session.context.memory, values.bit())).into()
}

pub(super) fn set_bit_direction(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let (bit, direction) = (values.integer(0), values.integer(1));
    session.call(|parts, caller| io::set_bit_direction(parts, caller, bit, direction));
    Answer::Nothing
}

pub(super) fn get_bit_direction(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    session.call(|parts, caller| io::get_bit_direction(parts, caller, values.integer(0))).into()
}

/// Words of the extended virtual bits on one line. The released firmware reads on after the last word, and hangs; a
/// count of 0 yields nothing.
pub(super) fn get_virtual_bits(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let (first, count) = (values.count(0), values.count(1));
    if count == 0 {
        return Answer::Nothing;
    }
    let memory = &*session.memory();
    let start = memory.locate(VIRTUAL_BITS_EX);
    let word = |index: usize| format!("{:X}", memory.peek::<u32>(start.offset(4 * index as u32)));
    let answer = (first..first + count).map(word).collect::<Vec<_>>().join(" ");
    let fits = answer.len() < ANSWER_ROOM;
    if fits { answer.into() } else { Answer::Stopped(Box::new(answer.into())) }
}

pub(super) fn adc(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    session.call(|parts, caller| io::analog_input(parts, caller, values.integer(0))).into()
}

pub(super) fn dac(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let word = values.integer(1) + ZERO;
    if let Some(index) = values.count(0).checked_sub(N_DACS)
        && let Some(kogna) = &session.parts.io.kogna
    {
        kogna.set_analog_output(session.context.memory, index, word as i16);
        return Answer::Nothing;
    }
    session.memory().set(DAC_BUFFER.element(values.count(0)), word as i16);
    Answer::Nothing
}

pub(super) fn hrpwm_set_mode(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let (pin, mode) = (values.integer(0), values.integer(1));
    session.call(|parts, caller| kogna::hrpwm::set_mode(parts, caller, pin, mode));
    Answer::Nothing
}

pub(super) fn spi_set_mode(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let (pin, mode) = (values.integer(0), values.integer(1));
    session.call(|parts, caller| kogna::spi::set_mode(parts, caller, pin, mode));
    Answer::Nothing
}

pub(super) fn pwm(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let (channel, value) = (values.integer(0), values.integer(1));
    session.call(|parts, caller| io::write_pwm(parts, caller, channel, value));
    Answer::Nothing
}

pub(super) fn pwmr(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let (channel, value) = (values.integer(0), values.integer(1));
    session.call(|parts, caller| io::write_pwmr(parts, caller, channel, value));
    Answer::Nothing
}

pub(super) fn pwmc(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let (channel, value) = (values.integer(0), values.integer(1));
    session.call(|parts, caller| io::write_pwmc(parts, caller, channel, value));
    Answer::Nothing
}

fn write(session: &mut Session<'_, '_>, values: &Values, size: AccessSize) -> Answer {
    let (number, value) = (values.integer(0).cast_unsigned(), values.integer(1).cast_unsigned());
    let (fpga, now) = (session.memory().map().fpga, session.context.now);
    let is_kogna = session.parts.io.kogna.is_some();
    let offset = if is_kogna { 2 * number } else { 4 * number + 2 };
    // On a KFLOP the largest number that the command accepts is outside.
    if offset < fpga.size {
        let (address, parts) = (fpga.base.offset(offset), &mut *session.parts);
        if is_kogna {
            kogna_bus::write(parts, address, size, value, now);
        } else {
            parts.write_register(address, size, value, now);
        }
    }
    Answer::Nothing
}

pub(super) fn fpga(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    write(session, values, AccessSize::Byte)
}

pub(super) fn fpgaw(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    write(session, values, AccessSize::Half)
}
