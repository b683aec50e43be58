//! The bits of a `float` in `persist.UserData` that a program reads as an integer.
//!
//! A PC, or another program, has stored the `float`; the integer is a number of ten digits that no motion, delay or
//! print means, nor a multiple of it.

use kmotiondef::firmware::Function;
use kmotiondef::limits::N_USER_DATA_VARS;
use kmotiondef::structs::Persist;
use kmotiondef::variables::PERSIST;
use vm::firmware::Caller;

use super::parts::Parts;
use crate::out::Message;
use crate::views::TypedAccess;

/// Numbers from a thousandth to ten million have such bits, with either sign.
const NUMBERS: std::ops::RangeInclusive<f32> = 0.001..=1e7;
/// Digits of the bits as an integer.
const DIGITS: usize = 9;

/// The least number of which a factor is sought that a program has multiplied such bits with.
const ABSURD: f64 = 1e8;

/// A program passes a number to a call; true if it comes from the bits of a `float`.
pub(crate) fn check(parts: &mut Parts, caller: &Caller<'_>, function: Function, value: f64) -> bool {
    let is_whole = f64::from(value as i32) == value && is_number(value as i32);
    let is_absurd = value.is_finite() && value.abs() >= ABSURD;
    if !is_whole && !is_absurd {
        return false;
    }
    let elements = (0..N_USER_DATA_VARS).map(|index| {
        let element = PERSIST.field(Persist::USER_DATA).element(index);
        (index, caller.memory.get(element))
    });
    let numbers = elements.filter(|(_, bits)| is_number(*bits));
    let found = numbers.filter_map(|(index, bits)| Some((index, bits, factor(value, bits)?)));
    let Some((index, bits, factor)) = found.min_by_key(|(.., factor)| *factor != 1.0) else {
        return false;
    };
    let float = f32::from_bits(bits.cast_unsigned());
    let what =
        if factor == 1.0 { format!("{bits} is") } else { format!("{value} is {factor} times {bits},") };
    parts.out.diagnose(caller, Message::FloatBits { function, what, index, float });
    true
}

/// Returns whether an integer is the bits of a number that people use.
fn is_number(bits: i32) -> bool {
    NUMBERS.contains(&f32::from_bits(bits.cast_unsigned()).abs())
}

/// The factor of a few digits, such as a number of counts per unit, by which a value is a multiple of an integer.
fn factor(value: f64, bits: i32) -> Option<f64> {
    const DIGITS: i32 = 4;
    const SAME: f64 = 1e-12;
    let ratio = value / f64::from(bits);
    if ratio == 1.0 {
        return Some(ratio);
    }
    let unit = libm::pow(10.0, f64::from(DIGITS - 1) - libm::floor(libm::log10(ratio.abs())));
    let rounded = libm::round(ratio * unit) / unit;
    let is_same = (rounded * f64::from(bits) - value).abs() <= SAME * value.abs();
    (is_same && value.abs() >= ABSURD).then_some(rounded)
}

/// A program prints a text, with such a number perhaps.
pub(crate) fn notice_text(parts: &mut Parts, caller: &Caller<'_>, function: Function, text: &[u8]) {
    let numbers = text.split(|byte| !(byte.is_ascii_digit() || *byte == b'-'));
    for number in numbers.filter(|number| number.len() >= DIGITS) {
        if let Some(value) = std::str::from_utf8(number).ok().and_then(|number| number.parse::<i32>().ok()) {
            _ = check(parts, caller, function, f64::from(value));
        }
    }
}
