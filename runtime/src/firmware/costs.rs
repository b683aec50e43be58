//! Costs of calls that depend on their arguments, relative to the cost of their rows (costs.md section 2).
//!
//! The numbers are cycles of firmware 4.34 with the wait states of the bus as it sets them.

use kmotiondef::Cycles;
use kmotiondef::firmware::Function;
use vm::firmware::Caller;

/// Ranges of bits: the last bit of each, and the cycles by which a call differs from its row.
pub(super) type Ranges = &'static [(i32, i64)];

/// `SetBit`.
pub(super) const SET_BIT: Ranges =
    &[(47, 0), (63, -32), (95, 176), (127, 184), (167, 42), (1023, -13), (i32::MAX, 4)];

/// `ClearBit`.
pub(super) const CLEAR_BIT: Ranges =
    &[(47, 0), (63, -33), (95, 175), (127, 183), (167, 42), (1023, -14), (i32::MAX, 4)];

/// `SetStateBit` to 0.
pub(super) const RESET_STATE_BIT: Ranges =
    &[(47, -5), (63, -38), (95, 170), (127, 178), (167, 37), (1023, -19), (i32::MAX, -1)];

/// `SetStateBit` to 1.
pub(super) const SET_STATE_BIT: Ranges =
    &[(47, 0), (63, -32), (95, 176), (127, 184), (167, 42), (1023, -13), (i32::MAX, 4)];

/// `ReadBit`.
pub(super) const READ_BIT: Ranges =
    &[(47, 0), (63, -42), (95, -22), (127, -14), (143, 26), (167, -4), (183, 2), (1023, 6), (i32::MAX, 16)];

/// `SetBitDirection` to output.
pub(super) const TO_OUTPUT: Ranges = &[(47, 0), (63, -102), (95, 159), (i32::MAX, 153)];

/// `SetBitDirection` to input.
pub(super) const TO_INPUT: Ranges = &[(47, -6), (63, -102), (95, 153), (i32::MAX, 147)];

/// The plan of a move that reaches its full speed, in firmware 5.
pub(super) const FULL_SPEED: i64 = 595;

/// The planning of a motion after the wait for its slice, in firmware 5: of a move, a jog, several moves.
pub(super) const AFTER_MOVE: i64 = 4720;
pub(super) const AFTER_JOG: i64 = 1500;
pub(super) const AFTER_MOVES: i64 = 3475;

/// `MoveExp` after the wait for its slice.
pub(super) const AFTER_EXP: i64 = 220;

/// Cycles of a motion call before it waits for its slice.
pub(super) const BEFORE_A_WAIT: i64 = 100;

/// A motion call without effect: the axis is disabled, or beyond a limit.
pub(super) const REFUSED: i64 = 76;

/// `StopCoordinatedMotion` in its slice, and in the separate slice of each axis in addition to the jog to rest.
pub(super) const STOP: i64 = 327;
pub(super) const STOP_AXIS: i64 = 176;

/// `ResumeCoordinatedMotion` in a feedhold, without the moves of its axes.
pub(super) const RESUME: i64 = 230;

/// A jog of 0 of an axis at rest.
pub(super) const NOTHING_TO_STOP: i64 = 136;

/// An arc sine or cosine, by the size of its argument.
pub(super) struct Arc {
    /// Up to a half.
    inner: i64,
    /// From there to 1: it takes a square root.
    outer: i64,
    /// From 1 on.
    edge: i64,
}

pub(super) const ASIN: Arc = Arc { inner: 0, outer: 432, edge: 90 };
pub(super) const ACOS: Arc = Arc { inner: 0, outer: 407, edge: 65 };
pub(super) const ASINF: Arc = Arc { inner: -50, outer: 30, edge: 0 };
pub(super) const ACOSF: Arc = Arc { inner: -35, outer: 30, edge: 0 };

impl Arc {
    pub(super) fn cost(&self, x: f64) -> i64 {
        match x.abs() {
            size if size <= 0.5 => self.inner,
            size if size < 1.0 => self.outer,
            _ => self.edge,
        }
    }
}

/// The tangents of 15° and 75°, between which the arc tangent reduces its argument.
const TANGENTS: [f64; 2] = [0.267_949_192_431_122_7, 3.732_050_807_568_877];

/// `atan`: its polynomial, its reduction and its reciprocal.
pub(super) fn of_arc_tangent(x: f64) -> i64 {
    match x.abs() {
        size if size <= TANGENTS[0] => -122,
        size if size <= 1.0 => 0,
        size if size <= TANGENTS[1] => 93,
        _ => -29,
    }
}

/// `atan2`: the cost of the arc tangent of a quotient, if there is one.
pub(super) fn of_direction(y: f64, x: f64) -> i64 {
    match (y == 0.0, x == 0.0) {
        (true, true) => -528,
        (false, true) => -520,
        _ => of_arc_tangent(y / x),
    }
}

/// The axes of the coordinate system for which the rows of its functions were measured.
const MEASURED_AXES: i64 = 5;

/// The nominal time of a change of the override, for each axis.
pub(super) const CHANGE_TIME: i64 = 124;

/// `CheckDoneXYZABC`, for each axis, and less if one is disabled.
pub(super) const CHECK_DONE: i64 = 27;
pub(super) const CHECK_DONE_DISABLED: i64 = -15;

/// `CheckDoneBuf` that finds a disabled axis: at the first letter, and for each letter before it.
pub(super) const CHECK_BUF_DISABLED: i64 = 30;
pub(super) const CHECK_BUF_LETTER: i64 = 24;

/// `printf` of no character.
pub(super) const NOTHING_PRINTED: i64 = -129;

/// Spends the cost of a function of the coordinate system for each of its axes.
pub(super) fn spend_axes(caller: &mut Caller<'_>, axes: usize, cycles: i64) {
    spend(caller, cycles * (axes as i64 - MEASURED_AXES));
}

/// Spends the cost of a call for this bit.
pub(super) fn spend_bit(caller: &mut Caller<'_>, ranges: Ranges, bit: i32) {
    let range = ranges.iter().find(|(last, _)| bit <= *last);
    spend(caller, range.map_or(0, |(_, cycles)| *cycles));
}

/// Spends the cost of a motion call without effect.
pub(super) fn spend_refusal(caller: &mut Caller<'_>, function: Function) {
    spend(caller, REFUSED - function.row().cost.get());
}

/// Spends cycles.
pub(super) fn spend(caller: &mut Caller<'_>, cycles: i64) {
    caller.spend(Cycles::new(cycles));
}

/// The function that reads a number from text, which determines the cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum IntegerReading {
    /// `atoi`, `atol`.
    Plain,
    /// `strtol`.
    Signed,
    /// `strtoul`.
    Unsigned,
}

/// Cycles for the text of an integer, on top of a text of no digit (`atoi`) or one.
pub(super) fn of_integer(reading: IntegerReading, blanks: usize, number: &[u8]) -> i64 {
    let unsigned = number.strip_prefix(b"-").or_else(|| number.strip_prefix(b"+")).unwrap_or(number);
    let plain = unsigned.strip_prefix(b"0x").or_else(|| unsigned.strip_prefix(b"0X"));
    let (digits, prefix) = (plain.unwrap_or(unsigned).len() as i64, if plain.is_some() { 128 } else { 0 });
    let blanks = blanks as i64;
    match reading {
        IntegerReading::Plain => 22 * digits + 13 * blanks,
        IntegerReading::Signed => {
            19 * blanks + prefix + by_digits(digits, &[(1, 0), (2, 277), (5, 1312), (10, 4227)])
        }
        IntegerReading::Unsigned => {
            20 * blanks + prefix + by_digits(digits, &[(1, 0), (2, 232), (5, 1132), (10, 3822)])
        }
    }
}

/// Between the digits that were measured, in a straight line.
fn by_digits(digits: i64, measured: &[(i64, i64)]) -> i64 {
    let digits = digits.max(1);
    let mut pairs = measured.iter().zip(measured.iter().skip(1));
    let line = pairs.clone().find(|(_, (to, _))| digits <= *to).or_else(|| pairs.next_back());
    line.map_or(0, |((from, low), (to, high))| low + (high - low) * (digits - from) / (to - from))
}

/// Cycles for the text of a double, on top of an empty one.
pub(super) fn of_double(number: &[u8]) -> i64 {
    let text = number.to_ascii_lowercase();
    let (mantissa, exponent) = match text.iter().position(|byte| *byte == b'e') {
        Some(at) => (&text[..at], Some(&text[at + 1..])),
        None => (&text[..], None),
    };
    let (whole, fraction) = match mantissa.iter().position(|byte| *byte == b'.') {
        Some(at) => (&mantissa[..at], &mantissa[at + 1..]),
        None => (mantissa, &[][..]),
    };
    let whole: &[u8] = if whole == b"0" { b"" } else { whole };
    let digits = |part: &[u8]| part.iter().filter(|byte| byte.is_ascii_digit()).count() as i64;
    let behind = digits(fraction);
    let point = if behind > 0 || exponent.is_some() { 107 } else { 0 };
    let scaled = exponent.map_or(0, |exponent| {
        let size = exponent.iter().filter(|byte| byte.is_ascii_digit());
        let size = size.fold(0_i64, |value, digit| (10 * value + i64::from(digit - b'0')).min(400));
        150 + size * 3 / 5
    });
    30 * digits(whole) + point + 65 * behind.min(3) + 45 * (behind - 3).max(0) + scaled
}

#[cfg(test)]
mod tests {
    use super::{IntegerReading, of_double, of_integer};

    fn is_near(found: i64, recorded: i64) {
        assert!((found - recorded).abs() * 10 <= recorded, "{found}, recorded {recorded}");
    }

    #[test]
    fn reading_numbers_costs_what_was_measured() {
        for (text, recorded) in [("0", 75), ("42", 97), ("-12345", 163), ("1234567890", 273)] {
            is_near(53 + of_integer(IntegerReading::Plain, 0, text.as_bytes()), recorded);
        }
        for (text, recorded) in
            [("7", 300), ("42", 577), ("-12345", 1612), ("1234567890", 4527), ("0x7fff", 1395)]
        {
            is_near(300 + of_integer(IntegerReading::Signed, 0, text.as_bytes()), recorded);
        }
        is_near(273 + of_integer(IntegerReading::Unsigned, 3, b"99"), 564);
        let doubles = [
            ("0", 164),
            ("7", 194),
            ("1.5", 361),
            ("-12345.678", 653),
            ("3.14159265358979", 989),
            ("1e10", 473),
            ("1.5e-7", 524),
            ("6.02e23", 569),
            ("1e300", 626),
        ];
        for (text, recorded) in doubles {
            is_near(164 + of_double(text.as_bytes()), recorded);
        }
    }
}
