//! The converter of `sscanf` and `fscanf`.
//!
//! The results are the board's, which differ from C: a conversion that finds nothing does not end the call and takes no
//! argument, white space after an ordinary character is an ordinary character, sets have no ranges, floats ignore their
//! width, `%ld` stores eight bytes (gather-persist-console.md section 4.2). Recorded in `scanf.jsonl` and
//! `printf-scanf.jsonl`, which the tests below replay.

use super::scanned::{Base, float_value, integer_value};
use super::{Dialect, cost, strict};

/// One converted value, in the form in which it is stored.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum ScannedValue<'t> {
    /// An 8-bit integer (`%hhd`).
    Byte(i8),
    /// A 16-bit integer (`%hd`).
    Short(i16),
    /// A 32-bit integer.
    Int(i32),
    /// The board's long: eight bytes, of which it uses 40 bits.
    Long(u64),
    /// A single.
    Float(f32),
    /// A double (`%lf`).
    Double(f64),
    /// Characters without a terminator (`%c`).
    Chars(&'t [u8]),
    /// A string, to be stored with a terminator.
    Text(&'t [u8]),
}

/// The destination of converted values, one after another.
pub(crate) trait Sink {
    /// The error of a value that cannot be stored.
    type Error;
    /// Stores a value at the next address.
    fn store(&mut self, value: ScannedValue<'_>) -> Result<(), Self::Error>;
}

/// The length modifier of a conversion, which gives the size of its variable.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Length {
    /// None; for integers also `L` and `ll`, which have no effect.
    #[default]
    Plain,
    /// `hh`, in firmware 5.
    Byte,
    /// `h`.
    Short,
    /// `l`; for floats also `L`.
    Long,
    /// `L` and `ll`.
    LongLong,
}

/// One conversion between `%` and its letter.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Spec {
    pub(super) discard: bool,
    pub(super) width: Option<usize>,
    length: Length,
}

/// The continuation after a directive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Continuation {
    Go,
    /// The call ends with the count so far.
    End,
    /// It ends with −1.
    Fail,
}

/// The result of a call, and the cycles that the board would have spent on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Conversions {
    /// The number of values stored, or −1.
    pub(crate) result: i32,
    /// Cycles in addition to those of a call without conversions.
    pub(crate) cycles: u32,
}

/// Converts `text` under `format`.
pub(crate) fn scan<S: Sink>(
    dialect: Dialect,
    text: &[u8],
    format: &[u8],
    sink: &mut S,
) -> Result<Conversions, S::Error> {
    if dialect == Dialect::Firmware5 {
        return strict::scan(text, format, sink);
    }
    let mut scanner = Scanner { text, at: 0, stored: 0, cycles: 0, behind_character: false };
    let result = obey(&mut scanner, format, sink)?;
    Ok(Conversions { result, cycles: scanner.cycles })
}

/// Obeys the directives of a format; the result of the call.
fn obey<S: Sink>(scanner: &mut Scanner<'_>, format: &[u8], sink: &mut S) -> Result<i32, S::Error> {
    let mut rest = format;
    if has_nothing_for(scanner.text, format) {
        return Ok(-1);
    }
    while let Some((&byte, tail)) = rest.split_first() {
        rest = tail;
        let next = if byte == b'%' {
            scanner.behind_character = false;
            let (spec, tail) = parse(rest, Dialect::Firmware4);
            let Some((&letter, tail)) = tail.split_first() else { break };
            let (set, tail) = if letter == b'[' { split_scan_set(tail) } else { (&[][..], tail) };
            rest = tail;
            scanner.convert(&spec, letter, set, sink)?
        } else {
            scanner.character(byte)
        };
        match next {
            Continuation::Go => {}
            Continuation::End => break,
            Continuation::Fail => return Ok(-1),
        }
    }
    Ok(scanner.stored)
}

/// Reads `*`, width and length.
pub(super) fn parse(format: &[u8], dialect: Dialect) -> (Spec, &[u8]) {
    let mut spec = Spec::default();
    let mut rest = format;
    if let Some(tail) = rest.strip_prefix(b"*") {
        spec.discard = true;
        rest = tail;
    }
    let count = rest.iter().take_while(|byte| byte.is_ascii_digit()).count();
    let (digits, tail) = rest.split_at(count);
    spec.width = std::str::from_utf8(digits).ok().and_then(|text| text.parse().ok());
    let (length, taken) = match tail {
        [b'h', b'h', ..] if dialect == Dialect::Firmware5 => (Length::Byte, 2),
        [b'h', ..] => (Length::Short, 1),
        [b'l', b'l', ..] => (Length::LongLong, 2),
        [b'L', ..] => (Length::LongLong, 1),
        [b'l', ..] => (Length::Long, 1),
        _ => (Length::Plain, 0),
    };
    spec.length = length;
    (spec, &tail[taken..])
}

/// The characters up to `]`, including a leading `]` or `^]`, and the rest of the format.
pub(super) fn split_scan_set(format: &[u8]) -> (&[u8], &[u8]) {
    let first = usize::from(format.first() == Some(&b'^')) + 1;
    let end = format.iter().skip(first).position(|&byte| byte == b']').map(|index| index + first);
    let end = end.unwrap_or(format.len());
    (&format[..end], format.get(end + 1..).unwrap_or(&[]))
}

/// Reports whether the first directive is a conversion and the text is used up, except for white space.
pub(super) fn has_nothing_for(text: &[u8], format: &[u8]) -> bool {
    let directives = format.trim_ascii_start();
    let text = if directives.len() < format.len() { text.trim_ascii_start() } else { text };
    directives.first() == Some(&b'%') && text.is_empty()
}

struct Scanner<'t> {
    text: &'t [u8],
    at: usize,
    stored: i32,
    cycles: u32,
    /// True if the previous directive was an ordinary character: white space is then one, too.
    behind_character: bool,
}

impl<'t> Scanner<'t> {
    fn rest(&self) -> &'t [u8] {
        &self.text[self.at..]
    }

    fn skip_space(&mut self) {
        self.at += self.rest().iter().take_while(|byte| byte.is_ascii_whitespace()).count();
    }

    /// An ordinary character, or white space.
    fn character(&mut self, byte: u8) -> Continuation {
        if byte.is_ascii_whitespace() && !self.behind_character {
            self.skip_space();
            return Continuation::Go;
        }
        self.behind_character = true;
        if self.rest().first() != Some(&byte) {
            return Continuation::End;
        }
        self.at += 1;
        Continuation::Go
    }

    /// At most `width` bytes of the remaining text.
    fn window(&self, width: Option<usize>) -> &'t [u8] {
        let rest = self.rest();
        &rest[..rest.len().min(width.unwrap_or(usize::MAX))]
    }

    /// Performs one conversion. Most conversions that find nothing store nothing, take no argument and do not end the
    /// call.
    fn convert<S: Sink>(
        &mut self,
        spec: &Spec,
        letter: u8,
        set: &[u8],
        sink: &mut S,
    ) -> Result<Continuation, S::Error> {
        if !matches!(letter, b'c' | b'[' | b'n') {
            self.skip_space();
        }
        let window = self.window(spec.width);
        let (value, used) = match letter {
            b'd' | b'u' | b'o' | b'i' | b'x' | b'X' | b'p' => integer(spec, letter, window),
            b'f' | b'e' | b'E' | b'g' | b'G' => float(spec, self.rest()),
            b's' => span(window, |byte| !byte.is_ascii_whitespace()),
            b'[' => match set.strip_prefix(b"^") {
                Some(others) => span(window, |byte| !others.contains(&byte)),
                None => span(window, |byte| set.contains(&byte)),
            },
            b'c' => {
                let count = window.len().min(spec.width.unwrap_or(1));
                (ScannedValue::Chars(&window[..count]), count)
            }
            b'n' => {
                if !spec.discard {
                    sink.store(ScannedValue::Int(self.at as i32))?;
                }
                return Ok(Continuation::Go);
            }
            b'%' => return Ok(self.percent()),
            _ => return Ok(Continuation::Go),
        };
        // Board quirk: a set that matches nothing stores an empty string, which counts, and consumes one character too
        // many at the end; a string stores an empty one there, too, which does not count.
        self.cycles = self.cycles.saturating_add(cost::scanned(letter, used as u32));
        let at_end = self.rest().is_empty();
        let is_counted = used > 0 || letter == b'[' && (at_end || spec.width == Some(0));
        self.at = (self.at + used).min(self.text.len());
        if !spec.discard && (is_counted || letter == b's' && at_end) {
            sink.store(value)?;
            self.stored += i32::from(is_counted);
        }
        Ok(Continuation::Go)
    }

    /// `%%`. Board quirk: without a percent sign in the text the call fails, whatever was converted.
    fn percent(&mut self) -> Continuation {
        if self.rest().first() != Some(&b'%') {
            return Continuation::Fail;
        }
        self.at += 1;
        Continuation::Go
    }
}

/// The bytes that belong to a string conversion.
pub(super) fn span(window: &[u8], belongs: impl Fn(u8) -> bool) -> (ScannedValue<'_>, usize) {
    let count = window.iter().take_while(|&&byte| belongs(byte)).count();
    (ScannedValue::Text(&window[..count]), count)
}

fn integer<'t>(spec: &Spec, letter: u8, window: &'t [u8]) -> (ScannedValue<'t>, usize) {
    let base = match letter {
        b'd' => Base::Decimal,
        b'u' => Base::Unsigned,
        b'o' => Base::Octal,
        b'i' => Base::Any,
        _ => Base::Hexadecimal,
    };
    let (value, used) = integer_value(window, base);
    (stored_integer(spec, value), used)
}

/// An integer as a conversion stores it.
pub(super) fn stored_integer(spec: &Spec, value: u64) -> ScannedValue<'static> {
    match spec.length {
        Length::Byte => ScannedValue::Byte(value as i8),
        Length::Short => ScannedValue::Short(value as i16),
        Length::Long => ScannedValue::Long(value),
        Length::Plain | Length::LongLong => ScannedValue::Int(value as i32),
    }
}

pub(super) fn float<'t>(spec: &Spec, text: &'t [u8]) -> (ScannedValue<'t>, usize) {
    let (value, used) = float_value(text);
    let is_double = matches!(spec.length, Length::Long | Length::LongLong);
    (if is_double { ScannedValue::Double(value) } else { ScannedValue::Float(single(value)) }, used)
}

/// A double as the float that is stored: too large a value becomes infinite.
fn single(value: f64) -> f32 {
    value as f32
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use serde_json::Value as Json;

    use super::*;
    use crate::text::vectors::{rows, split, unquote};

    /// The recording program's variables, each with spare bytes after it, and the targets of the call.
    struct Variables {
        targets: std::vec::IntoIter<String>,
        variables: Vec<(String, Vec<u8>)>,
    }

    impl Variables {
        /// As the recording program begins: every number −99, every text empty.
        fn new(targets: Vec<String>) -> Self {
            let filled = |name: &str| match name.as_bytes().first() {
                Some(b'i') => (-99_i32).to_le_bytes().repeat(4),
                Some(b'h') => (-99_i16).to_le_bytes().repeat(8),
                Some(b'f') => (-99_f32).to_le_bytes().repeat(32),
                Some(b'd') => (-99_f64).to_le_bytes().repeat(16),
                _ => vec![0; 120],
            };
            let names = ["i0", "i1", "i2", "h0", "f0", "f1", "d0", "d1", "s0", "s1"];
            let variables = names.iter().map(|name| ((*name).to_owned(), filled(name))).collect();
            Self { targets: targets.into_iter(), variables }
        }

        fn bytes(&self, name: &str) -> &[u8] {
            let found = self.variables.iter().find(|(known, _)| known == name);
            found.map(|(_, bytes)| bytes.as_slice()).expect("a variable of the recording program")
        }

        /// The value as the vectors have it.
        fn value(&self, name: &str) -> f64 {
            let bytes = self.bytes(name);
            match name.as_bytes().first() {
                Some(b'i') => i32::from_le_bytes(bytes[..4].try_into().expect("four")).into(),
                Some(b'h') => i16::from_le_bytes(bytes[..2].try_into().expect("two")).into(),
                Some(b'f') => f32::from_le_bytes(bytes[..4].try_into().expect("four")).into(),
                _ => f64::from_le_bytes(bytes[..8].try_into().expect("eight")),
            }
        }

        fn text(&self, name: &str) -> String {
            let text = self.bytes(name).split(|byte| *byte == 0).next().unwrap_or_default();
            String::from_utf8_lossy(text).into_owned()
        }

        fn hex(&self, name: &str, count: usize) -> String {
            self.bytes(name).iter().take(count).map(|byte| format!("{byte:02x}")).collect()
        }
    }

    impl Sink for Variables {
        type Error = Infallible;

        fn store(&mut self, value: ScannedValue<'_>) -> Result<(), Infallible> {
            let bytes = match value {
                ScannedValue::Byte(value) => value.to_le_bytes().to_vec(),
                ScannedValue::Short(value) => value.to_le_bytes().to_vec(),
                ScannedValue::Int(value) => value.to_le_bytes().to_vec(),
                ScannedValue::Long(value) => value.to_le_bytes().to_vec(),
                ScannedValue::Float(value) => value.to_le_bytes().to_vec(),
                ScannedValue::Double(value) => value.to_le_bytes().to_vec(),
                ScannedValue::Chars(text) => text.to_vec(),
                ScannedValue::Text(text) => [text, &[0]].concat(),
            };
            // A row without its argument stores to the address in some register of the board.
            let Some(target) = self.targets.next() else { return Ok(()) };
            let variable = self.variables.iter_mut().find(|(name, _)| *name == target).expect("a known one");
            variable.1[..bytes.len()].copy_from_slice(&bytes);
            Ok(())
        }
    }

    /// Makes the call of a row.
    fn call(row: &Json, dialect: Dialect) -> (i32, Variables) {
        let field = |name: &str| row[name].as_str().unwrap_or_default();
        let mut parts = split(field("sscanf")).into_iter();
        let pattern = parts.next().unwrap_or_default();
        let mut variables =
            Variables::new(parts.map(|part| part.trim_start_matches('&').to_owned()).collect());
        let Ok(found) = scan(dialect, &unquote(field("text")), &unquote(&pattern), &mut variables);
        (found.result, variables)
    }

    /// The last bits of some quotients depend on the processor: they are compared within 4 units of the last place.
    fn is_close(row: &Json, found: f64, expect: &str) -> bool {
        let expect = u64::from_str_radix(expect, 16).expect("bits of a double");
        row["note"].is_string() && found.to_bits().abs_diff(expect) <= 4
    }

    fn check(row: &Json) {
        let (result, variables) = call(row, Dialect::Firmware4);
        assert_eq!(Some(i64::from(result)), row["result"].as_i64(), "{row}");
        for (key, expect) in row.as_object().expect("an object") {
            match (key.split_once('_'), expect) {
                (Some((name, "bytes")), Json::String(expect)) => {
                    assert_eq!(variables.hex(name, expect.len() / 2), *expect, "{row}");
                }
                (Some((name, "hex")), Json::String(expect)) => {
                    let value = variables.value(name);
                    let bits = if name.starts_with('f') {
                        format!("{:08x}", (value as f32).to_bits())
                    } else {
                        format!("{:016x}", value.to_bits())
                    };
                    assert!(bits == *expect || is_close(row, value, expect), "{bits} {row}");
                }
                (None, Json::Number(expect))
                    if key != "result" && row.get(format!("{key}_hex")).is_none() =>
                {
                    assert_eq!(Some(variables.value(key)), expect.as_f64(), "{row}");
                }
                (None, Json::String(expect)) if matches!(key.as_str(), "s0" | "s1") => {
                    assert_eq!(variables.text(key), *expect, "{row}");
                }
                _ => {}
            }
        }
    }

    /// Checks a row of the older vectors: all variables, as text; the ints are consecutive in memory.
    fn check_text(row: &Json) {
        let (result, variables) = call(row, Dialect::Firmware4);
        let expect = |name: &str| row[name].as_str().unwrap_or_default();
        assert_eq!(result.to_string(), expect("result"), "{row}");
        assert_eq!(variables.value("i0").to_string(), expect("i0"), "{row}");
        for name in ["f0", "d0", "d1"] {
            assert_eq!(format!("{:.6}", variables.value(name)), expect(name), "{row}");
        }
        assert_eq!(variables.text("s0"), expect("s0"), "{row}");
    }

    #[test]
    fn conversions_of_firmware_5_match_the_recording() {
        let rows = rows("fw5-text.jsonl");
        let rows: Vec<&Json> = rows.iter().filter(|row| row["sscanf"].is_string()).collect();
        assert_eq!(rows.len(), 331);
        for row in rows {
            let (result, variables) = call(row, Dialect::Firmware5);
            let found = [f64::from(result), variables.value("i0"), variables.value("i1")];
            let expect = ["result", "i0", "i1"].map(|name| row[name].as_f64().expect("a number"));
            assert_eq!(found, expect, "{row}");
        }
    }

    #[test]
    fn conversions_match_the_recording() {
        rows("scanf.jsonl").iter().for_each(check);
        let older = rows("printf-scanf.jsonl");
        let older: Vec<&Json> = older.iter().filter(|row| row["sscanf"].is_string()).collect();
        assert!(older.len() > 30);
        older.into_iter().for_each(check_text);
    }
}
