//! The values of preprocessing numbers.
//!
//! Integers are decimal, octal, hexadecimal or binary, floating constants decimal or hexadecimal. A floating constant
//! is rounded once, to the type given by its suffix.

use std::ops::Range;

use crate::ast::{FloatingLiteral, IntegerLiteral};

/// A number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Number {
    /// An integer constant.
    Integer {
        /// The value with its suffixes.
        literal: IntegerLiteral,
        /// It has a suffix `f`, which the vendor's compiler silently drops.
        has_float_suffix: bool,
    },
    /// A floating constant.
    Floating(FloatingLiteral),
}

/// The reason why a text is not a number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NumberError {
    /// The finding.
    pub message: String,
    /// The bytes of the text that it refers to.
    pub range: Range<usize>,
    /// The replacement.
    pub help: Option<String>,
}

impl NumberError {
    fn new(range: Range<usize>, message: impl Into<String>) -> Self {
        Self { message: message.into(), range, help: None }
    }

    fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

/// Reads a preprocessing number.
///
/// # Errors
/// If the text does not follow the grammar of C, or is an integer of more than 64 bits.
pub fn parse(text: &[u8]) -> Result<Number, NumberError> {
    match text {
        [b'0', b'x' | b'X', ..] => hexadecimal(text),
        [b'0', b'b' | b'B', ..] => integer(text, 2, 2),
        _ => {
            let digits = count(text, 0, u8::is_ascii_digit);
            if matches!(text.get(digits), Some(b'.' | b'e' | b'E')) {
                return decimal_floating(text);
            }
            match text {
                [b'0', _, ..] if digits > 1 => octal(text, digits),
                _ => integer(text, 0, 10),
            }
        }
    }
}

/// An octal number; `08` is likely meant to be decimal.
fn octal(text: &[u8], digits: usize) -> Result<Number, NumberError> {
    let wrong = text.iter().take(digits).position(|digit| matches!(digit, b'8' | b'9'));
    let Some(at) = wrong else { return integer(text, 1, 8) };
    let decimal = String::from_utf8_lossy(text.get(..digits).unwrap_or(text)).into_owned();
    let digit = char::from(*text.get(at).unwrap_or(&b'8'));
    let help = format!("a leading 0 makes a number octal; write `{}`", decimal.trim_start_matches('0'));
    Err(NumberError::new(at..at + 1, format!("invalid digit `{digit}` in octal constant")).help(help))
}

/// An integer whose digits begin at `start`.
fn integer(text: &[u8], start: usize, base: u32) -> Result<Number, NumberError> {
    let mut value: u64 = 0;
    let mut at = start;
    let mut overflows = false;
    while let Some(digit) = text.get(at).and_then(|byte| char::from(*byte).to_digit(base)) {
        let next = value.checked_mul(u64::from(base)).and_then(|value| value.checked_add(u64::from(digit)));
        overflows |= next.is_none();
        value = next.unwrap_or(value);
        at += 1;
    }
    if at == start && base != 8 {
        return Err(NumberError::new(0..text.len(), "digits missing in integer constant"));
    }
    if overflows {
        return Err(NumberError::new(0..at, "integer constant does not fit 64 bits"));
    }
    let suffix = text.get(at..).unwrap_or(&[]);
    let (is_unsigned, is_long_long, has_float_suffix) = match suffix.to_ascii_lowercase().as_slice() {
        b"" | b"l" => (false, false, false),
        b"u" | b"ul" | b"lu" => (true, false, false),
        b"ll" => (false, true, false),
        b"ull" | b"llu" => (true, true, false),
        b"f" if base == 10 || base == 8 => (false, false, true),
        _ => return Err(bad_suffix(text, at, "integer")),
    };
    let literal = IntegerLiteral { value, is_decimal: base == 10, is_unsigned, is_long_long };
    Ok(Number::Integer { literal, has_float_suffix })
}

/// A decimal number with a point or an exponent.
fn decimal_floating(text: &[u8]) -> Result<Number, NumberError> {
    let mut at = count(text, 0, u8::is_ascii_digit);
    if text.get(at) == Some(&b'.') {
        at = count(text, at + 1, u8::is_ascii_digit);
    }
    if matches!(text.get(at), Some(b'e' | b'E')) {
        at = exponent(text, at)?.1;
    }
    let is_single = floating_suffix(text, at)?;
    let digits = text.get(..at).and_then(|digits| std::str::from_utf8(digits).ok()).unwrap_or_default();
    // The standard library rounds correctly, and directly to `f32` instead of through `f64`.
    let value = if is_single { digits.parse::<f32>().map(f64::from) } else { digits.parse::<f64>() };
    match value {
        Ok(value) => Ok(Number::Floating(FloatingLiteral { value, is_single })),
        Err(_) => Err(NumberError::new(0..text.len(), "digits missing in floating constant")),
    }
}

/// `0x1F`, `0x1.8p3`
fn hexadecimal(text: &[u8]) -> Result<Number, NumberError> {
    let digits = count(text, 2, u8::is_ascii_hexdigit);
    if !matches!(text.get(digits), Some(b'.' | b'p' | b'P')) {
        return integer(text, 2, 16);
    }
    let mut at = digits;
    if text.get(at) == Some(&b'.') {
        at = count(text, at + 1, u8::is_ascii_hexdigit);
    }
    if !matches!(text.get(at), Some(b'p' | b'P')) {
        let problem = NumberError::new(0..at, "hexadecimal floating constant without an exponent");
        return Err(problem.help("add one: `p0` multiplies by 1"));
    }
    let mut mantissa = Mantissa::default();
    let mut is_fraction = false;
    for byte in text.get(2..at).unwrap_or(&[]) {
        match char::from(*byte).to_digit(16) {
            Some(digit) => mantissa.push(digit, is_fraction),
            None => is_fraction = true,
        }
    }
    if at - 2 == usize::from(is_fraction) {
        return Err(NumberError::new(0..at, "digits missing in floating constant"));
    }
    let (exponent, at) = exponent(text, at)?;
    let is_single = floating_suffix(text, at)?;
    let (bits, lowest) = if is_single { (24, -149) } else { (53, -1074) };
    let mut value = mantissa.round(exponent, bits, lowest);
    if is_single && value > f64::from(f32::MAX) {
        value = f64::INFINITY;
    }
    Ok(Number::Floating(FloatingLiteral { value, is_single }))
}

/// The leading bits of a hexadecimal number: `(bits + something if is_sticky) * 2^exponent`.
#[derive(Default)]
struct Mantissa {
    bits: u64,
    is_sticky: bool,
    exponent: i64,
}

impl Mantissa {
    fn push(&mut self, digit: u32, is_fraction: bool) {
        if self.bits >> 60 == 0 {
            self.bits = self.bits << 4 | u64::from(digit);
            self.exponent -= if is_fraction { 4 } else { 0 };
        } else {
            self.is_sticky |= digit != 0;
            self.exponent += if is_fraction { 0 } else { 4 };
        }
    }

    /// The nearest number of this many bits that is a multiple of `2^lowest`; ties go to the even one.
    fn round(&self, exponent: i64, bits: u32, lowest: i64) -> f64 {
        if self.bits == 0 {
            return 0.0;
        }
        let exponent = self.exponent.saturating_add(exponent);
        let length = i64::from(64 - self.bits.leading_zeros());
        // The number of low bits that do not fit, because the number is long or tiny.
        let drop = (length - i64::from(bits)).max(lowest.saturating_sub(exponent)).max(0);
        let Some(drop) = u32::try_from(drop).ok().filter(|drop| *drop <= 64) else { return 0.0 };
        let kept = self.bits.checked_shr(drop).unwrap_or(0);
        let rest = self.bits.wrapping_sub(kept.checked_shl(drop).unwrap_or(0));
        let half = 1_u64.checked_shl(drop.wrapping_sub(1)).unwrap_or(0);
        let is_above = drop > 0 && (rest > half || rest == half && (self.is_sticky || kept & 1 == 1));
        scale_by_power_of_two(kept + u64::from(is_above), exponent.saturating_add(i64::from(drop)))
    }
}

/// `integer * 2^exponent`, which is exact: `integer` has at most 53 bits and the result is a multiple of 2^-1074.
fn scale_by_power_of_two(integer: u64, exponent: i64) -> f64 {
    let high = u32::try_from(integer >> 32).unwrap_or(0);
    let low = u32::try_from(integer & u64::from(u32::MAX)).unwrap_or(0);
    let integer = f64::from(high) * 4_294_967_296.0 + f64::from(low);
    let power = match exponent {
        -1022..=1023 => f64::from_bits((exponent + 1023).cast_unsigned() << 52),
        -1074..=-1023 => f64::from_bits(1 << (exponent + 1074)),
        1024.. => f64::INFINITY,
        _ => 0.0,
    };
    integer * power
}

/// Reads `e+10`: the value and the offset after it.
fn exponent(text: &[u8], letter: usize) -> Result<(i64, usize), NumberError> {
    let sign = text.get(letter + 1);
    let start = letter + 1 + usize::from(matches!(sign, Some(b'+' | b'-')));
    let end = count(text, start, u8::is_ascii_digit);
    if end == start {
        return Err(NumberError::new(letter..start, "digits missing in the exponent"));
    }
    let digits = text.get(start..end).and_then(|digits| std::str::from_utf8(digits).ok()).unwrap_or_default();
    let value = digits.parse::<i32>().map_or(i64::from(i32::MAX), i64::from);
    Ok((if sign == Some(&b'-') { -value } else { value }, end))
}

/// Reports whether the suffix makes a floating constant a `float`.
fn floating_suffix(text: &[u8], at: usize) -> Result<bool, NumberError> {
    match text.get(at..) {
        Some([b'f' | b'F']) => Ok(true),
        Some([] | [b'l' | b'L']) => Ok(false),
        _ => Err(bad_suffix(text, at, "floating")),
    }
}

fn bad_suffix(text: &[u8], at: usize, kind: &str) -> NumberError {
    let suffix = String::from_utf8_lossy(text.get(at..).unwrap_or(&[])).into_owned();
    let problem = NumberError::new(at..text.len(), format!("invalid suffix `{suffix}` on {kind} constant"));
    if suffix.starts_with(['+', '-']) {
        problem.help("put a space before the sign; the letter before it makes it an exponent")
    } else if suffix.contains('.') {
        problem.help("a number has one decimal point")
    } else {
        problem
    }
}

/// The offset after the bytes from `at` on that belong to a class.
fn count(text: &[u8], at: usize, class: fn(&u8) -> bool) -> usize {
    at + text.iter().skip(at).take_while(|byte| class(byte)).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integers() {
        let check = |text: &str, value: u64, flags: &str| {
            let Ok(Number::Integer { literal, has_float_suffix }) = parse(text.as_bytes()) else {
                panic!("{text} is not an integer: {:?}", parse(text.as_bytes()));
            };
            let found: String = [
                (literal.is_decimal, 'd'),
                (literal.is_unsigned, 'u'),
                (literal.is_long_long, 'l'),
                (has_float_suffix, 'f'),
            ]
            .into_iter()
            .filter_map(|(is_set, letter)| is_set.then_some(letter))
            .collect();
            assert_eq!((literal.value, found.as_str()), (value, flags), "{text}");
        };
        check("0", 0, "d");
        check("00000", 0, "");
        check("017", 15, "");
        check("2000f", 2000, "df");
        check("0x1F", 31, "");
        check("0xffffffffu", 0xffff_ffff, "u");
        check("0b101", 5, "");
        check("4294967296LL", 1 << 32, "dl");
        check("1uLL", 1, "dul");
        check("18446744073709551615", u64::MAX, "d");
    }

    #[test]
    fn floating_constants() {
        let check = |text: &str, value: f64, is_single: bool| {
            assert_eq!(
                parse(text.as_bytes()),
                Ok(Number::Floating(FloatingLiteral { value, is_single })),
                "{text}"
            );
        };
        check("1.5", 1.5, false);
        check(".5", 0.5, false);
        check("1.", 1.0, false);
        check("08.5", 8.5, false);
        check("1e-6f", f64::from(1e-6_f32), true);
        check("2.0F", 2.0, true);
        check("0.1f", f64::from(0.1_f32), true);
        check("1e400", f64::INFINITY, false);
        check("1.0L", 1.0, false);
        // Double rounding through `double` would give 1.0.
        check("1.00000005960464485f", f64::from(1.000_000_1_f32), true);
    }

    #[test]
    fn hexadecimal_floating_constants() {
        let check = |text: &str, value: f64| {
            let Ok(Number::Floating(literal)) = parse(text.as_bytes()) else { panic!("{text}") };
            assert_eq!(literal.value.to_bits(), value.to_bits(), "{text}");
        };
        check("0x1p0", 1.0);
        check("0x1.8p3", 12.0);
        check("0x.8p1", 1.0);
        check("0x1.fffffffffffffp1023", f64::MAX);
        check("0x1.fffffffffffff8p1023", f64::INFINITY);
        check("0x1p-1074", f64::from_bits(1));
        check("0x1p-1075", 0.0);
        check("0x1.8p-1075", f64::from_bits(1));
        check("0x1.00000000000008p0", 1.0);
        check("0x1.000000000000080000000000001p0", 1.0 + f64::EPSILON);
        check("0x1.000001p0f", 1.0);
        check("0x1.0000011p0f", f64::from(1.0_f32 + f32::EPSILON));
        check("0x1p-149f", f64::from(f32::from_bits(1)));
        check("0x1p-150f", 0.0);
        check("0x1p128f", f64::INFINITY);
        check("0x0p99999999999999", 0.0);
    }

    #[test]
    fn invalid_numbers_are_explained() {
        let check = |text: &str, message: &str| {
            assert_eq!(parse(text.as_bytes()).map_err(|problem| problem.message), Err(message.to_owned()));
        };
        check("08", "invalid digit `8` in octal constant");
        check("019", "invalid digit `9` in octal constant");
        check("123abc", "invalid suffix `abc` on integer constant");
        check("1.2.3", "invalid suffix `.3` on floating constant");
        check("1.5abc", "invalid suffix `abc` on floating constant");
        check("20s", "invalid suffix `s` on integer constant");
        check("0x12G", "invalid suffix `G` on integer constant");
        check("0x", "digits missing in integer constant");
        check("0b2", "digits missing in integer constant");
        check("1e+", "digits missing in the exponent");
        check("0x1.8", "hexadecimal floating constant without an exponent");
        check("0x.p1", "digits missing in floating constant");
        check("18446744073709551616", "integer constant does not fit 64 bits");
        check("0x1e+5", "invalid suffix `+5` on integer constant");
    }
}
