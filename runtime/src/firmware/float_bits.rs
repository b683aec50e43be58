//! The bits of a `float` in `persist.UserData` that a program reads as an integer.
//!
//! A PC, or another program, has stored the `float`; the integer is a number of ten digits that no motion, delay or
//! print means.

use kmotiondef::firmware::Function;
use kmotiondef::limits::N_USER_DATA_VARS;
use kmotiondef::structs::Persist;
use kmotiondef::variables::PERSIST;
use vm::firmware::Caller;

use super::parts::Parts;
use crate::out::Message;
use crate::views::Typed;

/// Numbers from a thousandth to ten million have such bits, with either sign.
const NUMBERS: std::ops::RangeInclusive<f32> = 0.001..=1e7;
/// Digits of the bits as an integer.
const DIGITS: usize = 9;

/// A program passes a number to a call.
pub(crate) fn notice(parts: &mut Parts, caller: &Caller<'_>, function: Function, value: f64) {
    let bits = value as i32;
    if f64::from(bits) != value || !NUMBERS.contains(&f32::from_bits(bits.cast_unsigned()).abs()) {
        return;
    }
    let is_it = |index: &usize| {
        let element = PERSIST.field(Persist::USER_DATA).element(*index);
        caller.memory.get(element) == bits
    };
    if let Some(index) = (0..N_USER_DATA_VARS).find(is_it) {
        let float = f32::from_bits(bits.cast_unsigned());
        parts.out.diagnose(caller, Message::FloatBits { function, value: bits, index, float });
    }
}

/// A program prints a text, with such a number perhaps.
pub(crate) fn notice_text(parts: &mut Parts, caller: &Caller<'_>, function: Function, text: &[u8]) {
    let numbers = text.split(|byte| !(byte.is_ascii_digit() || *byte == b'-'));
    for number in numbers.filter(|number| number.len() >= DIGITS) {
        if let Some(value) = std::str::from_utf8(number).ok().and_then(|number| number.parse::<i32>().ok()) {
            notice(parts, caller, function, f64::from(value));
        }
    }
}
