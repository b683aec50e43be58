//! Comparison of two printed lines that differ only in numbers, such as times, with the size of the difference.
//!
//! A number before a unit of time is a time. Digits that belong to a word (`axis1`, `0x1F`) are not numbers, and spaces
//! before a number are ignored, because of fields with a fixed width.

use std::fmt;

/// Units of time as programs print them, and their values in seconds.
const UNITS: [(&str, f64); 18] = [
    ("s", 1.0),
    ("sec", 1.0),
    ("secs", 1.0),
    ("second", 1.0),
    ("seconds", 1.0),
    ("ms", 1e-3),
    ("msec", 1e-3),
    ("milliseconds", 1e-3),
    ("us", 1e-6),
    ("usec", 1e-6),
    ("µs", 1e-6),
    ("microseconds", 1e-6),
    ("ns", 1e-9),
    ("tick", TICK),
    ("ticks", TICK),
    ("samples", TICK),
    ("cycle", 5e-9),
    ("cycles", 5e-9),
];
/// The length of a servo tick in seconds.
const TICK: f64 = 90e-6;
/// If the last digit is worth more than this many tolerances, rounding does not explain a difference.
const ROUNDING: f64 = 10.0;
/// A margin for the binary representation of decimal fractions.
const NOT_QUITE: f64 = 0.999_999;

/// The allowed difference of printed numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tolerance {
    /// Times, in seconds.
    pub(crate) seconds: f64,
    /// Other numbers.
    pub(crate) number: f64,
}

/// The largest differences between the numbers of two lines.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Deviation {
    /// Times, in seconds.
    seconds: f64,
    /// Other numbers.
    number: f64,
}

impl Deviation {
    /// The larger one of each kind.
    pub(crate) const fn max(self, other: Self) -> Self {
        Self { seconds: self.seconds.max(other.seconds), number: self.number.max(other.number) }
    }

    /// Returns whether there is no difference.
    pub(crate) fn is_none(self) -> bool {
        self == Self::default()
    }
}

impl fmt::Display for Deviation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.seconds > 0.0 {
            let (value, unit) = match self.seconds {
                seconds if seconds < 1e-3 => (seconds * 1e6, "µs"),
                seconds if seconds < 1.0 => (seconds * 1e3, "ms"),
                seconds => (seconds, "s"),
            };
            // Three digits, without the representation error of the subtracted decimal fractions.
            write!(f, "{} {unit}", libm::round(value * 1e3) / 1e3)?;
        }
        if self.number > 0.0 {
            let between = if self.seconds > 0.0 { " and " } else { "" };
            write!(f, "{between}{}", libm::round(self.number * 1e9) / 1e9)?;
        }
        Ok(())
    }
}

/// The differences between the numbers of two lines; `None` if the lines differ otherwise, or by more than the
/// tolerance.
pub(crate) fn deviation(one: &str, other: &str, allowed: Tolerance) -> Option<Deviation> {
    let (ones, others) = (LinePieces::of(one), LinePieces::of(other));
    if ones.words != others.words {
        return None;
    }
    let mut deviation = Deviation::default();
    for ((one, other), after) in ones.numbers.iter().zip(&others.numbers).zip(ones.words.iter().skip(1)) {
        let unit = unit(after);
        let scale = unit.unwrap_or(1.0);
        let limit = if unit.is_some() { allowed.seconds } else { allowed.number };
        let difference = (one.value - other.value).abs() * scale;
        let digit = one.digit.max(other.digit) * scale;
        // Times and fractions are rounded, counts are not.
        let is_rounded = (unit.is_some() || digit < 1.0) && digit <= ROUNDING * limit;
        let is_near = difference <= limit || is_rounded && difference < (limit + digit) * NOT_QUITE;
        if !is_near {
            return None;
        }
        deviation = deviation.max(match unit {
            Some(_) => Deviation { seconds: difference, number: 0.0 },
            None => Deviation { seconds: 0.0, number: difference },
        });
    }
    Some(deviation)
}

/// The value in seconds of the unit with which a text begins.
fn unit(text: &str) -> Option<f64> {
    let text = text.trim_start_matches([' ', '\t', '(', '[']);
    let end = text.find(|c: char| !c.is_alphabetic()).unwrap_or(text.len());
    let word = text.get(..end)?;
    UNITS.iter().find(|(name, _)| *name == word).map(|(_, seconds)| *seconds)
}

/// A printed number.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PrintedNumber {
    value: f64,
    /// The value of one unit in its last digit.
    digit: f64,
}

/// A line, split into numbers and the texts around them.
#[derive(Debug, Default, PartialEq)]
struct LinePieces<'a> {
    numbers: Vec<PrintedNumber>,
    /// The texts before, between and after the numbers.
    words: Vec<&'a str>,
}

impl<'a> LinePieces<'a> {
    fn of(line: &'a str) -> Self {
        let mut pieces = Self::default();
        let (mut rest, mut from) = (line, 0);
        while let Some(found) = next_number(rest, from) {
            let (before, number) = rest.split_at(found.start);
            let (number, after) = number.split_at(found.end - found.start);
            match printed(number) {
                Some(printed) => {
                    pieces.words.push(before.trim_end());
                    pieces.numbers.push(printed);
                    (rest, from) = (after, 0);
                }
                None => from = found.end,
            }
        }
        pieces.words.push(rest.trim_end());
        pieces
    }
}

/// Returns the range of the next number, with its sign; digits after a letter belong to a word.
fn next_number(text: &str, from: usize) -> Option<std::ops::Range<usize>> {
    let bytes = text.as_bytes();
    let mut at = from;
    while at < bytes.len() {
        if is_word(bytes[at]) && !bytes[at].is_ascii_digit() {
            at = skip(bytes, at, is_word);
        } else if bytes[at].is_ascii_digit() {
            let end = end_of_number(bytes, at);
            // `0x1F` is a word.
            if bytes[at] == b'0' && end == at + 1 && matches!(bytes.get(end), Some(b'x' | b'X')) {
                at = skip(bytes, end, is_word);
                continue;
            }
            let is_signed = at > 0 && bytes[at - 1] == b'-' && (at < 2 || !is_word(bytes[at - 2]));
            return Some(at - usize::from(is_signed)..end);
        } else {
            at += 1;
        }
    }
    None
}

const fn is_word(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_' || byte >= 0x80
}

fn skip(bytes: &[u8], from: usize, belongs: impl Fn(u8) -> bool) -> usize {
    from + bytes.iter().skip(from).take_while(|byte| belongs(**byte)).count()
}

/// The end of digits, decimal point, digits and exponent.
fn end_of_number(bytes: &[u8], from: usize) -> usize {
    let digits = |at: usize| skip(bytes, at, |byte| byte.is_ascii_digit());
    let mut end = digits(from);
    if bytes.get(end) == Some(&b'.') && bytes.get(end + 1).is_some_and(u8::is_ascii_digit) {
        end = digits(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let exponent = digits(end + 1 + sign);
        if exponent > end + 1 + sign {
            end = exponent;
        }
    }
    end
}

fn printed(text: &str) -> Option<PrintedNumber> {
    let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
    let decimals = mantissa.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    let power = exponent.parse::<i32>().ok()?.checked_sub(i32::try_from(decimals).ok()?)?;
    Some(PrintedNumber { value: text.parse().ok()?, digit: libm::pow(10.0, power.into()) })
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALLOWED: Tolerance = Tolerance { seconds: 0.001, number: 0.001 };

    fn check(one: &str, other: &str, expect: Option<&str>) {
        let found = deviation(one, other, ALLOWED).map(|deviation| deviation.to_string());
        assert_eq!(found.as_deref(), expect, "{one} | {other}");
    }

    #[test]
    fn times_may_differ_by_the_tolerance_in_their_unit() {
        check("took 3.200123 s", "took 3.200126 s", Some("3 µs"));
        check("3200 us.", "3203 us.", Some("3 µs"));
        check("3200 us", "4300 us", None);
        check("after 12 ms", "after 14 ms", None);
        check("640025 cycles", "640625 cycles", Some("3 µs"));
        check("1000 ticks (seconds)", "1011 ticks (seconds)", Some("990 µs"));
        check("1000 ticks", "1020 ticks", None);
    }

    #[test]
    fn rounded_numbers_may_differ_in_their_last_digit() {
        check("t=3.20 s", "t=3.21 s", Some("10 ms"));
        check("t=3.2 s", "t=3.3 s", None);
        check("12 ms", "13 ms", Some("1 ms"));
        check("at 7.249", "at 7.250", Some("0.001"));
        check("at 7.24", "at 7.26", None);
    }

    #[test]
    fn counts_and_words_must_be_equal() {
        check("3 parts", "4 parts", None);
        check("axis1 ready", "axis2 ready", None);
        check("0x1F", "0x1E", None);
        check("done", "ended", None);
        check("1 2", "1", None);
        check("equal 5", "equal 5", Some(""));
        check("-0.0001", "0.0001", Some("0.0002"));
        check("2-1.0001", "2-1.0002", Some("0.0001"));
    }

    #[test]
    fn padding_to_a_field_width_is_ignored() {
        check("t:   9.9999 s", "t:  10.0001 s", Some("200 µs"));
        check("1.5e-3x", "1.6e-3x", Some("0.0001"));
    }

    #[test]
    fn times_and_other_numbers_are_reported_separately() {
        check("3.0001 s at 5.0004", "3.0002 s at 5.0001", Some("100 µs and 0.0003"));
    }
}
