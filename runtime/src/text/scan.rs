//! The converter behind `sscanf` and `fscanf`.
//!
//! The board's results: a set in brackets has no ranges, `%ld` stores eight bytes, the end of the text before the
//! first conversion gives −1. Recorded in `printf-scanf.jsonl`.

use super::number::{float_prefix, integer_prefix};

/// One converted value, as it is stored.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Scanned<'t> {
    /// A 16-bit integer (`%hd`).
    Short(i16),
    /// A 32-bit integer.
    Int(i32),
    /// The board's long: eight bytes.
    Long(i64),
    /// A single.
    Float(f32),
    /// A double (`%lf`).
    Double(f64),
    /// Characters without a terminator (`%c`).
    Chars(&'t [u8]),
    /// A string, to be stored with a terminator.
    Text(&'t [u8]),
}

/// Where converted values go, one after the other.
pub(crate) trait Sink {
    /// Why a value could not be stored.
    type Error;
    /// Stores a value at the next address.
    fn store(&mut self, value: Scanned<'_>) -> Result<(), Self::Error>;
}

/// One conversion between `%` and its letter.
#[derive(Clone, Copy, Debug, Default)]
struct Spec {
    discard: bool,
    width: Option<usize>,
    short: bool,
    long: bool,
}

/// Converts `text` under `format`: the number of values stored, or −1 at the end of the text before the first.
pub(crate) fn scan<S: Sink>(text: &[u8], format: &[u8], sink: &mut S) -> Result<i32, S::Error> {
    let mut scanner = Scanner { text, at: 0, stored: 0 };
    let mut rest = format;
    while let Some((&byte, tail)) = rest.split_first() {
        rest = tail;
        let matched = if byte.is_ascii_whitespace() {
            scanner.skip_space();
            true
        } else if byte == b'%' {
            let (spec, tail) = parse(rest);
            let Some((&letter, tail)) = tail.split_first() else { break };
            let (set, tail) = if letter == b'[' { bracketed(tail) } else { (&[][..], tail) };
            rest = tail;
            if scanner.at_end(letter) {
                return Ok(if scanner.stored == 0 { -1 } else { scanner.stored });
            }
            scanner.convert(&spec, letter, set, sink)?
        } else {
            scanner.literal(byte)
        };
        if !matched {
            break;
        }
    }
    Ok(scanner.stored)
}

/// Reads `*`, width and length.
fn parse(format: &[u8]) -> (Spec, &[u8]) {
    let mut spec = Spec::default();
    let mut rest = format;
    if let Some(tail) = rest.strip_prefix(b"*") {
        spec.discard = true;
        rest = tail;
    }
    let count = rest.iter().take_while(|byte| byte.is_ascii_digit()).count();
    let (digits, tail) = rest.split_at(count);
    spec.width =
        std::str::from_utf8(digits).ok().and_then(|text| text.parse().ok()).filter(|&width| width > 0);
    rest = tail;
    while let Some((&letter, tail)) = rest.split_first() {
        match letter {
            b'h' => spec.short = true,
            b'l' | b'L' => spec.long = true,
            _ => break,
        }
        rest = tail;
    }
    (spec, rest)
}

/// The characters up to `]`, a leading `]` or `^]` included, and what follows.
fn bracketed(format: &[u8]) -> (&[u8], &[u8]) {
    let first = usize::from(format.first() == Some(&b'^')) + 1;
    let end = format.iter().skip(first).position(|&byte| byte == b']').map(|index| index + first);
    let end = end.unwrap_or(format.len());
    (&format[..end], format.get(end + 1..).unwrap_or(&[]))
}

struct Scanner<'t> {
    text: &'t [u8],
    at: usize,
    stored: i32,
}

impl<'t> Scanner<'t> {
    fn rest(&self) -> &'t [u8] {
        &self.text[self.at..]
    }

    fn skip_space(&mut self) {
        self.at += self.rest().iter().take_while(|byte| byte.is_ascii_whitespace()).count();
    }

    /// Whether nothing is left for a conversion, blanks skipped where it skips them.
    fn at_end(&mut self, letter: u8) -> bool {
        if !matches!(letter, b'c' | b'[' | b'n') {
            self.skip_space();
        }
        letter != b'n' && self.rest().is_empty()
    }

    fn literal(&mut self, byte: u8) -> bool {
        let matched = self.rest().first() == Some(&byte);
        self.at += usize::from(matched);
        matched
    }

    /// At most `width` bytes of what is left.
    fn window(&self, width: Option<usize>) -> &'t [u8] {
        let rest = self.rest();
        &rest[..rest.len().min(width.unwrap_or(usize::MAX))]
    }

    /// Performs one conversion; `false` when the text does not match.
    fn convert<S: Sink>(
        &mut self,
        spec: &Spec,
        letter: u8,
        set: &[u8],
        sink: &mut S,
    ) -> Result<bool, S::Error> {
        let window = self.window(spec.width);
        let (value, used) = match letter {
            b'd' | b'u' => integer(spec, window, 10),
            b'i' => integer(spec, window, 0),
            b'x' | b'X' | b'p' => integer(spec, window, 16),
            b'o' => integer(spec, window, 8),
            b'f' | b'e' | b'E' | b'g' | b'G' => float(spec, window),
            b's' => span(window, |byte| !byte.is_ascii_whitespace()),
            b'[' => match set.strip_prefix(b"^") {
                Some(others) => span(window, |byte| !others.contains(&byte)),
                None => span(window, |byte| set.contains(&byte)),
            },
            b'c' => {
                let count = window.len().min(spec.width.unwrap_or(1));
                (Scanned::Chars(&window[..count]), count)
            }
            b'n' => {
                sink.store(Scanned::Int(self.at as i32))?;
                return Ok(true);
            }
            _ => return Ok(self.literal(letter)),
        };
        self.at += used;
        if used > 0 && !spec.discard {
            sink.store(value)?;
            self.stored += 1;
        }
        Ok(used > 0)
    }
}

/// The bytes that belong to a string conversion.
fn span(window: &[u8], belongs: impl Fn(u8) -> bool) -> (Scanned<'_>, usize) {
    let count = window.iter().take_while(|&&byte| belongs(byte)).count();
    (Scanned::Text(&window[..count]), count)
}

fn integer<'t>(spec: &Spec, window: &'t [u8], base: u32) -> (Scanned<'t>, usize) {
    let (value, used) = integer_prefix(window, base);
    let value = match (spec.short, spec.long) {
        (true, _) => Scanned::Short(value as i16),
        (false, true) => Scanned::Long(value),
        (false, false) => Scanned::Int(value as i32),
    };
    (value, used)
}

fn float<'t>(spec: &Spec, window: &'t [u8]) -> (Scanned<'t>, usize) {
    let (value, used) = float_prefix(window);
    (if spec.long { Scanned::Double(value) } else { Scanned::Float(value as f32) }, used)
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use serde_json::Value as Json;

    use super::*;
    use crate::text::vectors::{rows, split, unquote};

    /// The recording program's variables in the order they lie in memory, and the targets of the call.
    struct Variables {
        targets: std::vec::IntoIter<String>,
        ints: [u32; 2],
        float: f32,
        doubles: [f64; 2],
        text: Vec<u8>,
    }

    impl Sink for Variables {
        type Error = Infallible;

        fn store(&mut self, value: Scanned<'_>) -> Result<(), Infallible> {
            let target = self.targets.next().expect("a target for each value");
            let index = usize::from(target.ends_with('1'));
            match value {
                Scanned::Short(value) => {
                    self.ints[index] = self.ints[index] & 0xffff_0000 | u32::from(value as u16);
                }
                Scanned::Int(value) => self.ints[index] = value as u32,
                Scanned::Long(value) => self.ints = [value as u32, (value >> 32) as u32],
                Scanned::Float(value) => self.float = value,
                Scanned::Double(value) => self.doubles[index] = value,
                Scanned::Chars(text) | Scanned::Text(text) => self.text = text.to_vec(),
            }
            Ok(())
        }
    }

    fn check(row: &Json) {
        let field = |name: &str| row[name].as_str().unwrap_or_default();
        let mut parts = split(field("sscanf")).into_iter();
        // The pattern may hold commas: it ends with its closing quote.
        let mut pattern = parts.next().unwrap_or_default();
        while pattern.matches('"').count() < 2 {
            pattern = format!("{pattern},{}", parts.next().expect("the pattern ends"));
        }
        let targets: Vec<String> = parts.collect();
        let unset = [-99_i32 as u32; 2];
        let mut variables = Variables {
            targets: targets.into_iter(),
            ints: unset,
            float: -99.0,
            doubles: [-99.0; 2],
            text: Vec::new(),
        };
        let Ok(result) = scan(&unquote(field("text")), &unquote(&pattern), &mut variables);
        let found = [
            result.to_string(),
            (variables.ints[0] as i32).to_string(),
            (variables.ints[1] as i32).to_string(),
            format!("{:.6}", variables.float),
            format!("{:.6}", variables.doubles[0]),
            format!("{:.6}", variables.doubles[1]),
            String::from_utf8_lossy(&variables.text).into_owned(),
        ];
        let expect = ["result", "i0", "i1", "f0", "d0", "d1", "s0"].map(field);
        assert_eq!(found, expect, "{} of {}", field("sscanf"), field("text"));
    }

    #[test]
    fn the_board_converts_the_same() {
        let rows = rows("printf-scanf.jsonl");
        let scans: Vec<&Json> = rows.iter().filter(|row| row["sscanf"].is_string()).collect();
        assert!(scans.len() > 30);
        scans.into_iter().for_each(check);
    }
}
