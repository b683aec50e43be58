//! The formatter behind `printf` and its kin.
//!
//! The board's results, odd ones included, are what programs see: halves round up, `%#x` of 0 keeps its prefix,
//! `%ld` prints a negative number as an unsigned one (`%lld` takes a `long long`, which the board has not), an unknown conversion prints nothing but its width. They are
//! recorded in the vectors `printf.jsonl` and `printf-scanf.jsonl`, which the tests below replay.

use super::decimal::{Keep, digits};

/// Where the values of the conversions come from.
pub(crate) trait Arguments {
    /// Why a value could not be had.
    type Error;
    /// The next 32-bit value.
    fn word(&mut self) -> Result<u32, Self::Error>;
    /// The next 64-bit value.
    fn long_long(&mut self) -> Result<u64, Self::Error>;
    /// The next double.
    fn double(&mut self) -> Result<f64, Self::Error>;
    /// The next string, at most `limit` bytes of it; `None` for a null pointer.
    fn text(&mut self, limit: usize) -> Result<Option<Vec<u8>>, Self::Error>;
}

/// Width and precision beyond this are cut: the board itself would overrun its memory.
const MAX_FIELD: usize = 4096;

/// One conversion between `%` and its letter.
#[derive(Clone, Copy, Debug, Default)]
struct Spec {
    left: bool,
    plus: bool,
    space: bool,
    alternate: bool,
    zero: bool,
    width: usize,
    precision: Option<usize>,
    short: bool,
    long: bool,
    long_long: bool,
}

/// Formats `arguments` under `format`.
pub(crate) fn format<A: Arguments>(format: &[u8], arguments: &mut A) -> Result<Vec<u8>, A::Error> {
    let mut out = Vec::with_capacity(format.len() + 16);
    let mut rest = format;
    while let Some((&byte, tail)) = rest.split_first() {
        rest = tail;
        if byte == b'%' {
            let (spec, letter, tail) = parse(rest, arguments)?;
            rest = tail;
            convert(&spec, letter, arguments, &mut out)?;
        } else {
            out.push(byte);
        }
    }
    Ok(out)
}

/// A parsed conversion: the specification, its letter (0 at the end of the format) and what follows.
type Parsed<'f> = (Spec, u8, &'f [u8]);

/// Reads flags, width, precision and length up to the conversion letter.
fn parse<'f, A: Arguments>(format: &'f [u8], arguments: &mut A) -> Result<Parsed<'f>, A::Error> {
    let mut spec = Spec::default();
    let mut rest = format;
    while let Some((&flag, tail)) = rest.split_first() {
        match flag {
            b'-' => spec.left = true,
            b'+' => spec.plus = true,
            b' ' => spec.space = true,
            b'#' => spec.alternate = true,
            b'0' => spec.zero = true,
            _ => break,
        }
        rest = tail;
    }
    let (width, tail) = number(rest, arguments)?;
    rest = tail;
    spec.left |= width.is_some_and(|width| width < 0);
    spec.width = field(width.unwrap_or(0).unsigned_abs());
    if let Some(tail) = rest.strip_prefix(b".") {
        let (precision, tail) = number(tail, arguments)?;
        rest = tail;
        let precision = precision.unwrap_or(0);
        spec.precision = u32::try_from(precision).ok().map(field);
    }
    rest = length(rest, &mut spec);
    match rest.split_first() {
        Some((&letter, tail)) => Ok((spec, letter, tail)),
        None => Ok((spec, 0, rest)),
    }
}

/// Limits a width or precision to what can sensibly be printed.
fn field(size: u32) -> usize {
    (size as usize).min(MAX_FIELD)
}

/// Reads a decimal number or `*`, which takes the next argument.
fn number<'f, A: Arguments>(
    format: &'f [u8],
    arguments: &mut A,
) -> Result<(Option<i32>, &'f [u8]), A::Error> {
    if let Some(tail) = format.strip_prefix(b"*") {
        return Ok((Some(arguments.word()? as i32), tail));
    }
    let count = format.iter().take_while(|byte| byte.is_ascii_digit()).count();
    let (text, tail) = format.split_at(count);
    let value =
        text.iter().fold(0_i32, |sum, digit| sum.saturating_mul(10).saturating_add(i32::from(digit - b'0')));
    Ok(((count > 0).then_some(value), tail))
}

/// Reads one `h`, or any number of `l`, `L`.
fn length<'f>(mut format: &'f [u8], spec: &mut Spec) -> &'f [u8] {
    if let Some(tail) = format.strip_prefix(b"h") {
        spec.short = true;
        return tail;
    }
    while let Some(tail) = format.strip_prefix(b"l").or_else(|| format.strip_prefix(b"L")) {
        spec.long_long = spec.long;
        spec.long = true;
        format = tail;
    }
    format
}

/// Performs one conversion.
fn convert<A: Arguments>(
    spec: &Spec,
    letter: u8,
    arguments: &mut A,
    out: &mut Vec<u8>,
) -> Result<(), A::Error> {
    match letter {
        b'd' | b'i' if spec.long_long => signed(spec, arguments.long_long()?.cast_signed(), out),
        b'u' | b'x' | b'X' | b'o' if spec.long_long => unsigned(spec, arguments.long_long()?, letter, out),
        // With one `l` the board reads a wider register whose upper part is zero: never negative.
        b'd' | b'i' if spec.long => signed(spec, arguments.word()?.into(), out),
        b'd' | b'i' => signed(spec, (arguments.word()? as i32).into(), out),
        b'u' | b'x' | b'X' | b'o' => unsigned(spec, arguments.word()?.into(), letter, out),
        b'p' => pad(spec, b"", format!("{:x}", arguments.word()?).as_bytes(), out),
        b'c' => pad(&unzeroed(spec), b"", &[arguments.word()? as u8], out),
        b's' => {
            let limit = spec.precision.unwrap_or(usize::MAX);
            let text = arguments.text(limit)?.unwrap_or_else(|| b"(null)".to_vec());
            let shown = text.len().min(limit);
            pad(&unzeroed(spec), b"", &text[..shown], out);
        }
        b'f' | b'e' | b'E' | b'g' | b'G' => float(spec, arguments.double()?, letter, out),
        b'%' => out.push(b'%'),
        _ => pad(&unzeroed(spec), b"", b"", out),
    }
    Ok(())
}

/// The same conversion without zero filling.
fn unzeroed(spec: &Spec) -> Spec {
    Spec { zero: false, ..*spec }
}

/// The sign to write before a number.
fn sign(spec: &Spec, negative: bool) -> &'static [u8] {
    match (negative, spec.plus, spec.space) {
        (true, _, _) => b"-",
        (false, true, _) => b"+",
        (false, false, true) => b" ",
        (false, false, false) => b"",
    }
}

/// `%d` and `%i`.
fn signed(spec: &Spec, value: i64, out: &mut Vec<u8>) {
    integer(spec, sign(spec, value < 0), &value.unsigned_abs().to_string(), out);
}

/// `%u`, `%x`, `%X` and `%o`; `h` keeps 16 bits.
fn unsigned(spec: &Spec, value: u64, letter: u8, out: &mut Vec<u8>) {
    let value = if spec.short { value & 0xffff } else { value };
    let (prefix, text) = match letter {
        b'x' => ("0x", format!("{value:x}")),
        b'X' => ("0X", format!("{value:X}")),
        b'o' => ("0", format!("{value:o}")),
        _ => ("", value.to_string()),
    };
    let mut head = if spec.space && !spec.plus { b" ".to_vec() } else { Vec::new() };
    if spec.alternate {
        head.extend(prefix.bytes());
    }
    integer(spec, &head, &text, out);
}

/// Digits of an integer behind their head, with the precision's zeros.
fn integer(spec: &Spec, head: &[u8], text: &str, out: &mut Vec<u8>) {
    let Some(precision) = spec.precision else {
        return pad(spec, head, text.as_bytes(), out);
    };
    let text = if precision == 0 && text == "0" { "" } else { text };
    let filled = format!("{text:0>precision$}");
    pad(&unzeroed(spec), head, filled.as_bytes(), out);
}

/// `%f`, `%e` and `%g`. What is not finite prints like the largest number, without a sign.
fn float(spec: &Spec, value: f64, letter: u8, out: &mut Vec<u8>) {
    let negative = value.is_finite() && value < 0.0;
    let magnitude = value.abs();
    let precision = spec.precision.unwrap_or(6);
    let text = match letter {
        b'f' => digits(magnitude, Keep::Decimals(precision)).fixed(precision, spec.alternate),
        b'e' | b'E' => {
            digits(magnitude, Keep::Significant(precision + 1)).scientific(precision, spec.alternate, letter)
        }
        _ => general(spec, magnitude, precision.max(1), letter),
    };
    pad(spec, sign(spec, negative), &text, out);
}

/// `%g`: `%e` for exponents below −4 or from the precision on, else `%f`, without the zeros at the end.
fn general(spec: &Spec, magnitude: f64, precision: usize, letter: u8) -> Vec<u8> {
    let found = digits(magnitude, Keep::Significant(precision));
    let exponent = if found.digits.is_empty() { 0 } else { found.point - 1 };
    if exponent < -4 || exponent >= precision as i32 {
        let shown = if spec.alternate { precision } else { significant(&found.digits) };
        return found.scientific(shown - 1, spec.alternate, letter - (b'g' - b'e'));
    }
    let decimals = (precision as i32 - 1 - exponent) as usize;
    if exponent < -1 {
        // Odd and kept: zeros at the end stay below 0.1, and a single significant digit gets lost.
        let shown = if precision == 1 { decimals - 1 } else { decimals };
        let mut text = found.fixed(decimals, spec.alternate);
        text.truncate(text.len() - (decimals - shown));
        return text;
    }
    if spec.alternate {
        return found.fixed(decimals, true);
    }
    let shown = (significant(&found.digits) as i32 - 1 - exponent).max(0) as usize;
    found.fixed(shown, false)
}

/// How many digits are left without the zeros at the end; at least one.
fn significant(digits: &[u8]) -> usize {
    digits.iter().rposition(|&digit| digit != 0).map_or(1, |last| last + 1)
}

/// Writes head and body in the field's width.
fn pad(spec: &Spec, head: &[u8], body: &[u8], out: &mut Vec<u8>) {
    let fill = spec.width.saturating_sub(head.len() + body.len());
    if spec.left {
        out.extend_from_slice(head);
        out.extend_from_slice(body);
        out.extend(std::iter::repeat_n(b' ', fill));
    } else if spec.zero {
        out.extend_from_slice(head);
        out.extend(std::iter::repeat_n(b'0', fill));
        out.extend_from_slice(body);
    } else {
        out.extend(std::iter::repeat_n(b' ', fill));
        out.extend_from_slice(head);
        out.extend_from_slice(body);
    }
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use serde_json::Value as Json;

    use super::*;
    use crate::text::vectors::{Argument, call, rows};

    struct List(std::vec::IntoIter<Argument>);

    impl Arguments for List {
        type Error = Infallible;

        fn word(&mut self) -> Result<u32, Infallible> {
            Ok(match self.0.next() {
                Some(Argument::Word(word)) => word,
                _ => 0,
            })
        }

        fn long_long(&mut self) -> Result<u64, Infallible> {
            Ok(match self.0.next() {
                Some(Argument::Word(word)) => word.into(),
                Some(Argument::LongLong(value)) => value,
                _ => 0,
            })
        }

        fn double(&mut self) -> Result<f64, Infallible> {
            Ok(match self.0.next() {
                Some(Argument::Double(double)) => double,
                _ => 0.0,
            })
        }

        fn text(&mut self, limit: usize) -> Result<Option<Vec<u8>>, Infallible> {
            Ok(match self.0.next() {
                Some(Argument::Text(text)) => Some(text.into_iter().take(limit).collect()),
                _ => None,
            })
        }
    }

    fn printf(pattern: &[u8], list: Vec<Argument>) -> Vec<u8> {
        let Ok(text) = format(pattern, &mut List(list.into_iter()));
        text
    }

    /// So many characters of one call reach the console.
    const SEEN: usize = 128;

    fn check(row: &Json) {
        let (Some(text), Some(expect)) = (row["printf"].as_str(), row["out"].as_str()) else {
            return;
        };
        let (pattern, list) = call(text);
        let mut found = printf(&pattern, list);
        found.truncate(SEEN);
        assert_eq!(String::from_utf8_lossy(&found), expect, "{text}");
    }

    #[test]
    fn the_board_prints_the_same() {
        for row in rows("printf.jsonl").iter().chain(&rows("printf-scanf.jsonl")) {
            check(row);
        }
    }

    proptest::proptest! {
        #[test]
        fn integers_print_as_other_formatters_print_them(value: u64, width in 0_usize..30, zero: bool) {
            let zero_flag = if zero { "0" } else { "" };
            let list = || vec![Argument::LongLong(value)];
            let check = |letter: &str, plain: String| {
                let pattern = format!("%{zero_flag}{width}ll{letter}");
                let sign = if plain.starts_with('-') && zero { "-" } else { "" };
                let digits = plain.trim_start_matches(if zero { "-" } else { "" });
                let fill = if zero { "0" } else { " " };
                let expect = format!("{sign}{}{digits}", fill.repeat(width.saturating_sub(plain.len())));
                assert_eq!(String::from_utf8_lossy(&printf(pattern.as_bytes(), list())), expect, "{pattern}");
            };
            check("d", value.cast_signed().to_string());
            check("u", value.to_string());
            check("x", format!("{value:x}"));
            check("X", format!("{value:X}"));
            check("o", format!("{value:o}"));
        }

        #[test]
        fn decimals_are_right_to_a_unit_of_the_last_one(value in -1e6..1e6_f64, precision in 0_usize..9) {
            let text = printf(format!("%.{precision}f").as_bytes(), vec![Argument::Double(value)]);
            let text = String::from_utf8_lossy(&text).into_owned();
            let read: f64 = text.parse().expect("a number");
            let unit = format!("1e-{precision}").parse::<f64>().expect("a number");
            assert!((read - value).abs() <= unit * 0.500_001 + 1e-9, "{text} {value}");
            assert_eq!(text.split('.').nth(1).map_or(0, str::len), precision);
        }
    }

    #[test]
    fn gathered_doubles_read_back() {
        for value in [1.0 / 3.0, 12_345.678_901_234_5, -0.001_234_567_890_123_4, 7e-9, 31_415_926.535_897_93]
        {
            let text = printf(b"%.17g", vec![Argument::Double(value)]);
            let read: f64 = String::from_utf8_lossy(&text).parse().expect("a number");
            assert!((read - value).abs() <= value.abs() * 2.0 * f64::EPSILON, "{value} {read}");
        }
    }
}
