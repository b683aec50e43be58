//! Numbers at the beginning of a text, as `strtol` and `strtod` read them.

use super::scanned::float_value;

/// Reads an integer: optional sign, prefix where `base` allows it, digits.
///
/// Returns the value modulo 2^64 and its length in bytes; 0 bytes if there is no number. For `base` 0 the prefix
/// determines the base.
pub(crate) fn integer_prefix(text: &[u8], base: u32) -> (i64, usize) {
    let IntegerText { negative, base, digits, used } = digits_of(text, base);
    let value = digits.iter().fold(0_i64, |sum, &byte| {
        let digit = char::from(byte).to_digit(base).unwrap_or(0);
        sum.wrapping_mul(i64::from(base)).wrapping_add(i64::from(digit))
    });
    (if negative { value.wrapping_neg() } else { value }, used)
}

/// Returns whether an integer is negative, and its magnitude; larger ones are saturated.
pub(crate) fn magnitude(text: &[u8], base: u32) -> (bool, u64) {
    let IntegerText { negative, base, digits, .. } = digits_of(text, base);
    let value = digits.iter().fold(0_u64, |sum, &byte| {
        let digit = char::from(byte).to_digit(base).unwrap_or(0);
        sum.saturating_mul(u64::from(base)).saturating_add(u64::from(digit))
    });
    (negative, value)
}

/// The parts of an integer in text.
struct IntegerText<'t> {
    negative: bool,
    base: u32,
    digits: &'t [u8],
    /// Bytes of sign, prefix and digits; 0 without digits.
    used: usize,
}

fn digits_of(text: &[u8], base: u32) -> IntegerText<'_> {
    let (negative, signed) = sign(text);
    let mut digits = &text[signed..];
    let mut base = base;
    let hexadecimal = matches!(digits, [b'0', b'x' | b'X', digit, ..] if digit.is_ascii_hexdigit());
    if hexadecimal && (base == 0 || base == 16) {
        digits = &digits[2..];
        base = 16;
    } else if base == 0 {
        base = if digits.first() == Some(&b'0') { 8 } else { 10 };
    }
    let count = digits.iter().take_while(|&&byte| char::from(byte).is_digit(base)).count();
    let used = if count == 0 { 0 } else { text.len() - digits.len() + count };
    IntegerText { negative, base, digits: &digits[..count], used }
}

/// Reads a decimal floating-point number as the board does; 0 bytes if there is none.
///
/// A sign alone counts as the beginning of a number. An exponent without digits makes the value 0, and is not part of
/// it.
pub(crate) fn float_prefix(text: &[u8]) -> (f64, usize) {
    let begins = match text {
        [b'+' | b'-', ..] => true,
        [b'.', digit, ..] | [digit, ..] => digit.is_ascii_digit(),
        [] => false,
    };
    if !begins {
        return (0.0, 0);
    }
    let (value, used) = float_value(text);
    let taken = &text[..used];
    let letter = taken.iter().position(|byte| matches!(byte, b'e' | b'E'));
    let is_cut = |at: &usize| !taken[*at..].iter().any(u8::is_ascii_digit);
    (value, letter.filter(is_cut).unwrap_or(used))
}

/// Returns whether there is a minus sign, and the length of the sign in bytes.
fn sign(text: &[u8]) -> (bool, usize) {
    match text.first() {
        Some(b'-') => (true, 1),
        Some(b'+') => (false, 1),
        _ => (false, 0),
    }
}

/// A value for a message. The bits of a small integer, read as a floating-point number, would have dozens of zeros.
pub(crate) fn legible(value: f64) -> String {
    const SMALL: f64 = 1e-9;
    if value != 0.0 && value.abs() < SMALL { format!("{value:e}") } else { value.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integer_parsing_accepts_prefixes() {
        assert_eq!(integer_prefix(b"0x1F;", 0), (31, 4));
        assert_eq!(integer_prefix(b"010", 0), (8, 3));
        assert_eq!(integer_prefix(b"-12a", 10), (-12, 3));
        assert_eq!(integer_prefix(b"0x", 16), (0, 1));
        assert_eq!(integer_prefix(b"-x", 10), (0, 0));
    }

    #[test]
    fn float_parsing_stops_at_the_end_of_the_number() {
        assert_eq!(float_prefix(b"-2.5e3,"), (-2500.0, 6));
        assert_eq!(float_prefix(b".5"), (0.5, 2));
        assert_eq!(float_prefix(b"5."), (5.0, 2));
        assert_eq!(float_prefix(b"."), (0.0, 0));
        assert_eq!(float_prefix(b"1e"), (0.0, 1));
        assert_eq!(float_prefix(b"- 5"), (-0.0, 1));
        assert_eq!(float_prefix(b"1e400"), (f64::MAX, 5));
    }
}
