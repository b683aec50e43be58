//! The formatter of `printf` and related functions.
//!
//! Programs get the board's results, including the odd ones: halves round up, `%#06x` fills before its prefix, `%ld`
//! takes 40 bits from two words, an unknown conversion prints only its width (gather-persist-console.md section 4.1).
//! They are recorded in the vectors `printf.jsonl`, `printf-scanf.jsonl` and `printf-edge.jsonl`, which the tests below
//! replay. There is one extension: `%lld` takes a `long long`, which the board's compiler does not have.

use super::decimal::{Digits, Precision, digits};
use super::{Dialect, cost};

/// The source of the values of the conversions.
pub(crate) trait Arguments {
    /// The error of a value that cannot be read.
    type Error;
    /// The next 32-bit value.
    fn word(&mut self) -> Result<u32, Self::Error>;
    /// The next 64-bit value; also the two words that the board takes for its 40-bit long.
    fn long_long(&mut self) -> Result<u64, Self::Error>;
    /// The next double.
    fn double(&mut self) -> Result<f64, Self::Error>;
    /// The next string, truncated to `limit` bytes; `None` for a null pointer.
    fn text(&mut self, limit: usize) -> Result<Option<Vec<u8>>, Self::Error>;
}

/// The largest width and precision: the board itself would overrun its memory beyond it.
const MAX_FIELD: usize = 4096;

/// One conversion between `%` and its letter.
#[derive(Clone, Copy, Debug, Default)]
struct Spec {
    dialect: Dialect,
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

impl Spec {
    /// True for the rules of firmware 5.
    fn is_nearer_to_c(&self) -> bool {
        self.dialect == Dialect::Firmware5
    }
}

/// A formatted text, and its cost on the board.
#[derive(Clone, Debug, Default)]
pub(crate) struct FormattedText {
    /// The text.
    pub(crate) text: Vec<u8>,
    /// Cycles in addition to those of a call with an empty format.
    pub(crate) cycles: u32,
}

impl FormattedText {
    /// Adds the cost of a part of the format.
    fn spend(&mut self, cycles: u32) {
        self.cycles = self.cycles.saturating_add(cycles);
    }
}

/// Formats `arguments` under `format` as firmware 4.34 does.
pub(crate) fn format<A: Arguments>(format: &[u8], arguments: &mut A) -> Result<Vec<u8>, A::Error> {
    format_counted(Dialect::Firmware4, format, arguments).map(|formatted| formatted.text)
}

/// Formats `arguments` with `format`, and counts the cost on the board.
pub(crate) fn format_counted<A: Arguments>(
    dialect: Dialect,
    format: &[u8],
    arguments: &mut A,
) -> Result<FormattedText, A::Error> {
    let mut out = FormattedText { text: Vec::with_capacity(format.len() + 16), cycles: 0 };
    let mut rest = format;
    let mut plain = 0_u32;
    while let Some((&byte, tail)) = rest.split_first() {
        rest = tail;
        if byte == b'%' {
            let (spec, letter, tail) = parse(dialect, rest, arguments)?;
            rest = tail;
            convert(&spec, letter, arguments, &mut out)?;
        } else {
            out.text.push(byte);
            plain += 1;
        }
    }
    if plain > 0 {
        out.spend(cost::PLAIN_TEXT + plain * cost::PLAIN_CHARACTER);
    }
    Ok(out)
}

/// A parsed conversion: the specification, its letter (0 at the end of the format) and what follows.
type ParsedConversion<'f> = (Spec, u8, &'f [u8]);

/// Reads flags, width, precision and length up to the conversion letter.
fn parse<'f, A: Arguments>(
    dialect: Dialect,
    format: &'f [u8],
    arguments: &mut A,
) -> Result<ParsedConversion<'f>, A::Error> {
    let mut spec = Spec { dialect, ..Spec::default() };
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

/// Limits a width or precision to a sensible size.
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

/// Reads one `h`, `l`, `ll` or `L`.
fn length<'f>(format: &'f [u8], spec: &mut Spec) -> &'f [u8] {
    let (length, taken) = match format {
        [b'h', b'h', ..] if spec.is_nearer_to_c() => return &format[2..],
        [b'h', ..] => (&mut spec.short, 1),
        [b'l', b'l', ..] => (&mut spec.long_long, 2),
        [b'l', ..] => (&mut spec.long, 1),
        // A double is a double without it.
        [b'L', ..] => return &format[1..],
        _ => return format,
    };
    *length = true;
    &format[taken..]
}

/// Performs one conversion.
fn convert<A: Arguments>(
    spec: &Spec,
    letter: u8,
    arguments: &mut A,
    out: &mut FormattedText,
) -> Result<(), A::Error> {
    match letter {
        b'd' | b'i' if spec.long_long => signed(spec, arguments.long_long()?.cast_signed(), out),
        b'u' | b'x' | b'X' | b'o' if spec.long_long => unsigned(spec, arguments.long_long()?, letter, out),
        b'd' | b'i' if spec.long => signed(spec, read_long(arguments)?, out),
        b'u' | b'x' | b'X' | b'o' if spec.long => {
            unsigned(spec, read_long(arguments)?.cast_unsigned() & LONG_MASK, letter, out);
        }
        b'd' | b'i' => signed(spec, (arguments.word()? as i32).into(), out),
        b'u' | b'x' | b'X' | b'o' => unsigned(spec, arguments.word()?.into(), letter, out),
        b'p' => {
            let digits = with_precision(spec, &format!("{:x}", arguments.word()?));
            let prefix = if spec.alternate && spec.is_nearer_to_c() { "0x" } else { "" };
            let head = if spec.is_nearer_to_c() { b"" } else { sign(spec, false) };
            pad(&with_blank_fill(spec), head, format!("{prefix}{digits}").as_bytes(), out);
        }
        b'c' => {
            out.spend(cost::CHARACTER);
            pad(spec, blank_prefix(spec), &[arguments.word()? as u8], out);
        }
        b's' => {
            let limit = spec.precision.unwrap_or(usize::MAX);
            let text = arguments.text(limit)?.unwrap_or_else(|| b"(null)".to_vec());
            let shown = text.len().min(limit);
            out.spend(cost::text(shown as u32));
            pad(&without_zero_fill(spec), b"", &text[..shown], out);
        }
        b'F' if spec.is_nearer_to_c() => float(spec, arguments.double()?, b'f', out),
        b'f' | b'e' | b'E' | b'g' | b'G' => float(spec, arguments.double()?, letter, out),
        b'%' => {
            out.spend(cost::PERCENT);
            out.text.push(b'%');
        }
        // The end of the format.
        0 => pad(&without_zero_fill(spec), sign(spec, false), b"", out),
        _ => pad(&without_zero_fill(spec), b"", b"", out),
    }
    Ok(())
}

/// The bits of the board's `long` in an eight-byte place.
const LONG_MASK: u64 = (1 << 40) - 1;

/// The board's `long`: 40 bits of two words. The words after the last argument are whatever the caller has there.
fn read_long<A: Arguments>(arguments: &mut A) -> Result<i64, A::Error> {
    const UNUSED: u32 = u64::BITS - LONG_MASK.count_ones();
    Ok((arguments.long_long()? << UNUSED).cast_signed() >> UNUSED)
}

/// Returns the conversion without zero filling.
fn without_zero_fill(spec: &Spec) -> Spec {
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
fn signed(spec: &Spec, value: i64, out: &mut FormattedText) {
    integer(spec, sign(spec, value < 0), &value.unsigned_abs().to_string(), out);
}

/// Returns the prefix of an unsigned number or a character: a blank if that flag is given, whatever the other flags.
fn blank_prefix(spec: &Spec) -> &'static [u8] {
    if spec.space { b" " } else { b"" }
}

/// `%u`, `%x`, `%X` and `%o`; `h` keeps 16 bits.
///
/// Board quirk: zeros that fill a width come before the prefix, and `%#o` always has one more zero.
fn unsigned(spec: &Spec, value: u64, letter: u8, out: &mut FormattedText) {
    let value = if spec.short { value & 0xffff } else { value };
    let (prefix, text) = match letter {
        b'x' => ("0x", format!("{value:x}")),
        b'X' => ("0X", format!("{value:X}")),
        b'o' => ("0", format!("{value:o}")),
        _ => ("", value.to_string()),
    };
    let digits = with_precision(spec, &text);
    let count = digits.len() as u32;
    out.spend(if letter == b'u' { cost::decimal(count, false) } else { cost::hexadecimal(count) });
    let prefix = if spec.alternate && !digits.is_empty() { prefix } else { "" };
    if !spec.is_nearer_to_c() {
        return pad(&with_blank_fill(spec), blank_prefix(spec), format!("{prefix}{digits}").as_bytes(), out);
    }
    let is_needless = letter == b'o' && digits.starts_with('0');
    pad(&with_blank_fill(spec), if is_needless { b"" } else { prefix.as_bytes() }, digits.as_bytes(), out);
}

/// Digits of a signed integer after their sign.
fn integer(spec: &Spec, head: &[u8], text: &str, out: &mut FormattedText) {
    let digits = with_precision(spec, text);
    out.spend(cost::decimal(digits.len() as u32, head == b"-"));
    pad(&with_blank_fill(spec), head, digits.as_bytes(), out);
}

/// Digits, with leading zeros up to the precision; 0 has none if the precision is 0.
fn with_precision(spec: &Spec, text: &str) -> String {
    let precision = spec.precision.unwrap_or(1);
    // Board quirk: in firmware 5 it has one with the flag `#`.
    let is_shown = spec.is_nearer_to_c() && spec.alternate;
    if precision == 0 && text == "0" && !is_shown { String::new() } else { format!("{text:0>precision$}") }
}

/// An integer with a precision is filled with blanks.
fn with_blank_fill(spec: &Spec) -> Spec {
    if spec.precision.is_some() { without_zero_fill(spec) } else { *spec }
}

/// `%f`, `%e` and `%g`. Values that are not finite print like 2 to the power of 1024; these and zeros have no sign.
fn float(spec: &Spec, value: f64, letter: u8, out: &mut FormattedText) {
    let magnitude = value.abs();
    let negative = value.is_finite() && value < 0.0 && magnitude >= f64::MIN_POSITIVE;
    let precision = spec.precision.unwrap_or(6);
    let keep = match letter {
        b'f' => Precision::Decimals(precision),
        b'e' | b'E' => Precision::Scientific(precision + 1),
        _ => Precision::Significant(precision.max(1)),
    };
    let found = digits(magnitude, keep);
    let text = match letter {
        b'f' => fixed(spec, magnitude, precision, &found),
        b'e' | b'E' => found.scientific(precision, spec.alternate, letter),
        _ => general(spec, &found, precision.max(1), letter),
    };
    out.spend(match letter {
        b'f' => cost::fixed(spec.precision, &found),
        b'e' | b'E' => cost::scientific(spec.precision, &found),
        _ => cost::general(spec.precision, &found),
    });
    if negative {
        out.spend(cost::MINUS);
    }
    pad(spec, sign(spec, negative), &text, out);
}

/// `%f`. Board quirk: without decimals, values below 0.1 show their first decimal, or nothing after the point.
fn fixed(spec: &Spec, magnitude: f64, precision: usize, found: &Digits) -> Vec<u8> {
    let is_small = (f64::MIN_POSITIVE..0.1).contains(&magnitude);
    if precision > 0 || !is_small || spec.is_nearer_to_c() {
        return found.fixed(precision, spec.alternate);
    }
    let first = digits(magnitude, Precision::Decimals(1));
    first.fixed(usize::from(!first.digits.is_empty()), true)
}

/// `%g`: `%e` for exponents below −4 or from the precision on, otherwise `%f`, without trailing zeros.
fn general(spec: &Spec, found: &Digits, precision: usize, letter: u8) -> Vec<u8> {
    let exponent = found.exponent();
    if found.is_scientific(precision) {
        let shown = if spec.alternate { precision } else { significant(&found.digits) };
        return found.scientific(shown - 1, spec.alternate, letter - (b'g' - b'e'));
    }
    if exponent < -1 && !spec.is_nearer_to_c() {
        // Board quirk: trailing zeros are kept below 0.1, and as many zeros as requested digits end the text.
        let zeros = exponent.unsigned_abs() as usize - 1;
        let decimals = if zeros >= precision { precision } else { zeros + precision };
        return found.fixed(decimals, spec.alternate);
    }
    let decimals = (precision as i32 - 1 - exponent) as usize;
    if spec.alternate {
        return found.fixed(decimals, true);
    }
    let shown = (significant(&found.digits) as i32 - 1 - exponent).max(0) as usize;
    found.fixed(shown, false)
}

/// Returns the number of digits without trailing zeros; at least one.
fn significant(digits: &[u8]) -> usize {
    digits.iter().rposition(|&digit| digit != 0).map_or(1, |last| last + 1)
}

/// Writes head and body in the field's width.
fn pad(spec: &Spec, head: &[u8], body: &[u8], out: &mut FormattedText) {
    let fill = spec.width.saturating_sub(head.len() + body.len());
    if spec.width > 0 {
        out.spend(cost::width(fill as u32));
    }
    let flags = [spec.left, spec.plus, spec.space, spec.alternate, spec.zero];
    out.spend(cost::FLAG * flags.into_iter().map(u32::from).sum::<u32>());
    let text = &mut out.text;
    if spec.left {
        text.extend_from_slice(head);
        text.extend_from_slice(body);
        text.extend(std::iter::repeat_n(b' ', fill));
    } else if spec.zero {
        text.extend_from_slice(head);
        text.extend(std::iter::repeat_n(b'0', fill));
        text.extend_from_slice(body);
    } else {
        text.extend(std::iter::repeat_n(b' ', fill));
        text.extend_from_slice(head);
        text.extend_from_slice(body);
    }
}

#[cfg(test)]
pub(super) mod tests {
    use std::convert::Infallible;

    use serde_json::Value as Json;

    use super::*;
    use crate::text::vectors::{Argument, call, rows};

    struct List {
        list: std::vec::IntoIter<Argument>,
        /// The number of words that were taken.
        taken: usize,
    }

    impl Arguments for List {
        type Error = Infallible;

        fn word(&mut self) -> Result<u32, Infallible> {
            self.taken += 1;
            Ok(match self.list.next() {
                Some(Argument::Word(word)) => word,
                _ => 0,
            })
        }

        fn long_long(&mut self) -> Result<u64, Infallible> {
            // From a place aligned to 8: the words before an odd place are skipped with it.
            if self.taken % 2 == 1 {
                self.word()?;
            }
            Ok(match self.list.next() {
                Some(Argument::Word(low)) => {
                    self.taken += 2;
                    match self.list.next() {
                        Some(Argument::Word(high)) => u64::from(high) << 32 | u64::from(low),
                        _ => low.into(),
                    }
                }
                Some(Argument::LongLong(value)) => value,
                _ => 0,
            })
        }

        fn double(&mut self) -> Result<f64, Infallible> {
            Ok(match self.list.next() {
                Some(Argument::Double(double)) => double,
                _ => 0.0,
            })
        }

        fn text(&mut self, limit: usize) -> Result<Option<Vec<u8>>, Infallible> {
            Ok(match self.list.next() {
                Some(Argument::Text(text)) => Some(text.into_iter().take(limit).collect()),
                _ => None,
            })
        }
    }

    fn printf(pattern: &[u8], list: Vec<Argument>) -> Vec<u8> {
        let Ok(text) = format(pattern, &mut List { list: list.into_iter(), taken: 0 });
        text
    }

    /// The text of a call and its cost.
    pub(in crate::text) fn counted(pattern: &[u8], list: Vec<Argument>) -> FormattedText {
        let Ok(formatted) =
            format_counted(Dialect::Firmware4, pattern, &mut List { list: list.into_iter(), taken: 0 });
        formatted
    }

    /// This many characters of one call reach the console.
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
    fn printed_text_of_firmware_5_matches_the_recording() {
        let (mut wrong, mut compared) = (Vec::new(), 0);
        for row in rows("fw5-text.jsonl") {
            let (Some(text), Some(expect)) = (row["printf"].as_str(), row["out"].as_str()) else { continue };
            let (pattern, list) = call(text);
            let mut list = List { list: list.into_iter(), taken: 0 };
            let Ok(found) = format_counted(Dialect::Firmware5, &pattern, &mut list);
            let seen = &found.text[..found.text.len().min(SEEN)];
            if String::from_utf8_lossy(seen) != expect {
                wrong.push(format!("{text}: {:?}, recorded {expect:?}", String::from_utf8_lossy(seen)));
            }
            compared += 1;
        }
        assert!(wrong.is_empty() && compared == 1534, "{compared}\n{}", wrong.join("\n"));
    }

    #[test]
    fn printed_text_matches_the_recording() {
        for file in ["printf.jsonl", "printf-scanf.jsonl", "printf-edge.jsonl"] {
            rows(file).iter().for_each(check);
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
        fn decimals_are_correct_to_a_unit_in_the_last_place(value in -1e6..1e6_f64, precision in 0_usize..9) {
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
