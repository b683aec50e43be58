//! Decimal digits of a double, as the board's library finds them.
//!
//! The board does not round correctly: it brings large values below 10^10 by multiplying with 0.1, takes the
//! integer part as it is, and finds every further digit by multiplying the fraction by ten in double arithmetic;
//! the digit behind the last one wanted decides the rounding, halves going up. So 0.35 rounds to 0.4 and
//! 2.675 to 2.67, and `%f` of 123456789012345678 ends in 719.337463, as measured. The same steps here give the
//! same text.
//!
//! What is asked for in significant digits (`%e`, `%g`) is found otherwise where these steps are far off, in very
//! large and very small values, and beyond 15 digits if the text would read back as another value: nobody has
//! measured them there, and programs that print `%.17g` mean to read the same value back (`dialect.md` section 5).
//! There the digits are the fewest that name the value, rounded where fewer are wanted, with zeros where more are.

use std::ops::Range;

/// Decimal digits and where the point stands among them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Digits {
    /// Digits as values 0 to 9; the first is not 0 unless the value is.
    pub(crate) digits: Vec<u8>,
    /// How many digits stand before the decimal point; negative for zeros behind it.
    pub(crate) point: i32,
}

/// Which digit is the last one wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Keep {
    /// So many digits from the first that is not 0.
    Significant(usize),
    /// So many digits behind the decimal point.
    Decimals(usize),
}

/// At and above this the value is scaled down first.
const SCALED_FROM: f64 = 1e10;

/// The values whose significant digits are found as on the board.
const ORDINARY: Range<f64> = 1e-5..1e10;

/// The most significant digits that are found as on the board.
const ORDINARY_DIGITS: usize = 15;

/// Finds the digits of a magnitude, rounded at the last digit that `keep` names.
///
/// Zero has no digits. Values that are not finite count as the largest finite one.
pub(crate) fn digits(magnitude: f64, keep: Keep) -> Digits {
    let finite = if magnitude.is_finite() { magnitude } else { f64::MAX };
    if finite == 0.0 {
        return Digits { digits: Vec::new(), point: 0 };
    }
    let found = as_the_board(finite, keep);
    let Keep::Significant(count) = keep else { return found };
    if ORDINARY.contains(&finite) && (count <= ORDINARY_DIGITS || found.names(finite)) {
        return found;
    }
    let Digits { mut digits, point } = fewest(finite);
    digits.resize(digits.len().max(count), 0);
    round_at(digits, point, count)
}

/// The digits by the board's own steps.
fn as_the_board(magnitude: f64, keep: Keep) -> Digits {
    let (mut digits, fraction, point) = split(magnitude);
    let wanted = match keep {
        Keep::Significant(count) => count as i64,
        Keep::Decimals(count) => count as i64 + i64::from(point),
    };
    let Ok(wanted) = usize::try_from(wanted) else {
        return Digits { digits: Vec::new(), point: 0 };
    };
    extend(&mut digits, fraction, wanted + 1);
    round_at(digits, point, wanted)
}

/// The fewest digits that name the value.
fn fewest(magnitude: f64) -> Digits {
    let text = format!("{magnitude:e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let digits = mantissa.bytes().filter(u8::is_ascii_digit).map(|digit| digit - b'0').collect();
    Digits { digits, point: exponent.parse::<i32>().unwrap_or(0) + 1 }
}

/// The integer part's digits, the fraction left, and the place of the point.
fn split(magnitude: f64) -> (Vec<u8>, f64, i32) {
    let (mut value, mut point) = (magnitude, 0);
    while value >= SCALED_FROM {
        value *= 0.1;
        point += 1;
    }
    let whole = libm::trunc(value);
    let mut fraction = value - whole;
    let mut digits = Vec::new();
    if whole > 0.0 {
        digits.extend(format!("{whole:.0}").bytes().map(|digit| digit - b'0'));
        point += digits.len() as i32;
    } else {
        while fraction * 10.0 < 1.0 {
            fraction *= 10.0;
            point -= 1;
        }
    }
    (digits, fraction, point)
}

/// Appends digits of the fraction until there are `count`.
fn extend(digits: &mut Vec<u8>, mut fraction: f64, count: usize) {
    while digits.len() < count {
        fraction *= 10.0;
        let digit = libm::trunc(fraction);
        fraction -= digit;
        digits.push(digit as u8);
    }
}

/// Cuts to `wanted` digits; the digit behind them rounds up from 5.
fn round_at(mut digits: Vec<u8>, mut point: i32, wanted: usize) -> Digits {
    let up = digits.get(wanted).is_some_and(|&digit| digit >= 5);
    digits.truncate(wanted);
    if up {
        let nines = digits.iter().rev().take_while(|&&digit| digit == 9).count();
        let changed = digits.len() - nines;
        digits[changed..].fill(0);
        if let Some(last) = changed.checked_sub(1) {
            digits[last] += 1;
        } else {
            digits.insert(0, 1);
            point += 1;
        }
    }
    Digits { digits, point }
}

impl Digits {
    /// Whether the digits read back as `magnitude`.
    fn names(&self, magnitude: f64) -> bool {
        let text = self.scientific(self.digits.len().saturating_sub(1), false, b'e');
        String::from_utf8(text).is_ok_and(|text| text.parse() == Ok(magnitude))
    }

    /// The digit at `place` counted from the decimal point: 0 is the first behind it, −1 the one before it.
    fn at(&self, place: i64) -> u8 {
        let index = place + i64::from(self.point);
        usize::try_from(index)
            .ok()
            .and_then(|index| self.digits.get(index))
            .map_or(b'0', |digit| b'0' + digit)
    }

    /// Text with `decimals` digits behind the point, as `%f` has it.
    pub(crate) fn fixed(&self, decimals: usize, always_point: bool) -> Vec<u8> {
        let whole = i64::from(self.point.max(1));
        let mut text: Vec<u8> = (-whole..0).map(|place| self.at(place)).collect();
        if decimals > 0 || always_point {
            text.push(b'.');
        }
        text.extend((0..decimals as i64).map(|place| self.at(place)));
        text
    }

    /// Text with `decimals` digits behind the point and an exponent, as `%e` has it; `letter` is `e` or `E`.
    pub(crate) fn scientific(&self, decimals: usize, always_point: bool, letter: u8) -> Vec<u8> {
        let mantissa = Self { digits: self.digits.clone(), point: 1 };
        let mut text = mantissa.fixed(decimals, always_point);
        let exponent = if self.digits.is_empty() { 0 } else { self.point - 1 };
        push_exponent(&mut text, exponent, letter);
        text
    }
}

/// Appends an exponent with its sign and at least two digits.
fn push_exponent(text: &mut Vec<u8>, exponent: i32, letter: u8) {
    text.push(letter);
    text.push(if exponent < 0 { b'-' } else { b'+' });
    text.extend(format!("{:02}", exponent.unsigned_abs()).bytes());
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(value: f64, keep: Keep, expect: &str, point: i32) {
        let found = digits(value, keep);
        let text: String = found.digits.iter().map(|digit| char::from(b'0' + digit)).collect();
        assert_eq!((text.as_str(), found.point), (expect, point), "{value} {keep:?}");
    }

    #[test]
    fn halves_go_up_and_digits_come_from_the_fraction() {
        check(0.5, Keep::Decimals(0), "1", 1);
        check(2.5, Keep::Significant(1), "3", 1);
        check(0.35, Keep::Decimals(1), "4", 0);
        check(2.675, Keep::Decimals(2), "267", 1);
        check(99.96, Keep::Decimals(1), "1000", 3);
    }

    #[test]
    fn seventeen_digits_read_back_as_the_same_value() {
        let mut bits = 0x0123_4567_89AB_CDEF_u64;
        for _ in 0..10_000 {
            bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let value = f64::from_bits(bits & i64::MAX as u64);
            if value.is_finite() {
                let text = digits(value, Keep::Significant(17)).scientific(16, false, b'e');
                let text = String::from_utf8(text).expect("digits are ASCII");
                assert_eq!(text.parse(), Ok(value), "{text}");
            }
        }
    }

    #[test]
    fn significant_digits_of_extreme_values_are_rounded_correctly() {
        check(123_456_789_012_345_680.0, Keep::Significant(5), "12346", 18);
        check(0.1, Keep::Significant(20), "10000000000000000000", 0);
        check(3.529457878180234e41, Keep::Significant(10), "3529457878", 42);
        check(2.922407875466816e-288, Keep::Significant(12), "292240787547", -287);
    }

    #[test]
    fn small_values_have_zeros_behind_the_point() {
        check(0.00012, Keep::Significant(2), "12", -3);
        check(4.9e-7, Keep::Decimals(6), "", -6);
        check(5.1e-7, Keep::Decimals(6), "1", -5);
        check(0.0004, Keep::Decimals(2), "", 0);
    }
}
