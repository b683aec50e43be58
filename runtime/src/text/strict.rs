//! The converter of `sscanf` and `fscanf` of firmware 5, which follows C: a conversion that finds nothing ends the
//! call.
//!
//! Recorded in `fw5-text.jsonl`, which the test below replays. Numbers have the same values as in firmware 4.34.

use super::scan::{
    Conversions, ScannedValue, Sink, Spec, float, has_nothing_for, parse, span, split_scan_set,
    stored_integer,
};
use super::scanned::{Base, magnitude, saturate_long};
use super::{Dialect, cost};

/// The reason why a call ends before its format does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Refusal {
    /// The text does not match, or the format ends.
    Mismatch,
    /// The text has ended: the result is −1 if nothing was stored.
    Input,
}

/// Converts `text` under `format`.
pub(super) fn scan<S: Sink>(text: &[u8], format: &[u8], sink: &mut S) -> Result<Conversions, S::Error> {
    let mut scanner = Scanner { text, at: 0, stored: 0, cycles: 0 };
    if has_nothing_for(text, format) {
        return Ok(Conversions { result: -1, cycles: 0 });
    }
    let mut rest = format;
    let mut end = Refusal::Mismatch;
    let mut is_behind_character = false;
    while let Some((&byte, tail)) = rest.split_first() {
        rest = tail;
        let directive = if byte == b'%' {
            is_behind_character = false;
            let (spec, tail) = parse(rest, Dialect::Firmware5);
            let Some((&letter, tail)) = tail.split_first() else { break };
            let (set, tail) = if letter == b'[' { split_scan_set(tail) } else { (&[][..], tail) };
            rest = tail;
            scanner.convert(&spec, letter, set, sink)?
        } else if byte.is_ascii_whitespace() && !is_behind_character {
            scanner.skip_space();
            None
        } else {
            // Board quirk: white space after an ordinary character is one, too.
            is_behind_character = true;
            scanner.character(byte)
        };
        if let Some(found) = directive {
            end = found;
            break;
        }
    }
    let has_nothing = end == Refusal::Input && scanner.stored == 0;
    Ok(Conversions { result: if has_nothing { -1 } else { scanner.stored }, cycles: scanner.cycles })
}

struct Scanner<'t> {
    text: &'t [u8],
    at: usize,
    stored: i32,
    cycles: u32,
}

impl<'t> Scanner<'t> {
    fn rest(&self) -> &'t [u8] {
        &self.text[self.at..]
    }

    fn skip_space(&mut self) {
        self.at += self.rest().iter().take_while(|byte| byte.is_ascii_whitespace()).count();
    }

    fn character(&mut self, byte: u8) -> Option<Refusal> {
        match self.rest().first() {
            None => Some(Refusal::Input),
            Some(&found) if found == byte => {
                self.at += 1;
                None
            }
            Some(_) => Some(Refusal::Mismatch),
        }
    }

    /// Performs one conversion; returns the reason to end the call after it, if there is one.
    fn convert<S: Sink>(
        &mut self,
        spec: &Spec,
        letter: u8,
        set: &[u8],
        sink: &mut S,
    ) -> Result<Option<Refusal>, S::Error> {
        if letter == b'n' {
            if !spec.discard {
                sink.store(ScannedValue::Int(self.at as i32))?;
            }
            return Ok(None);
        }
        if !matches!(letter, b'c' | b'[') {
            self.skip_space();
        }
        if letter == b'%' {
            return Ok(self.character(b'%'));
        }
        let rest = self.rest();
        if rest.is_empty() {
            return Ok(Some(Refusal::Input));
        }
        let window = &rest[..rest.len().min(spec.width.unwrap_or(usize::MAX))];
        let (value, used) = match letter {
            b'd' | b'u' | b'o' | b'i' | b'x' | b'X' | b'p' => {
                let (value, used) = integer(window, letter);
                (stored_integer(spec, value), used)
            }
            b'f' | b'e' | b'E' | b'g' | b'G' => {
                // An exponent letter without digits is consumed and ignored.
                let (_, used) = float(spec, window);
                let last = window[..used].iter().rposition(|byte| !b"eE+-".contains(byte));
                let number = &window[..last.map_or(0, |last| last + 1)];
                (float(spec, number).0, used)
            }
            b's' => span(window, |byte| !byte.is_ascii_whitespace()),
            b'[' => match set.strip_prefix(b"^") {
                Some(others) => span(window, |byte| !others.contains(&byte)),
                None => span(window, |byte| set.contains(&byte)),
            },
            b'c' => {
                let count = window.len().min(spec.width.unwrap_or(1));
                (ScannedValue::Chars(&window[..count]), count)
            }
            _ => return Ok(Some(Refusal::Mismatch)),
        };
        self.cycles = self.cycles.saturating_add(cost::scanned(letter, used as u32));
        if used == 0 {
            return Ok(Some(Refusal::Mismatch));
        }
        self.at += used;
        if !spec.discard {
            sink.store(value)?;
            self.stored += 1;
        }
        Ok(None)
    }
}

/// Reads an integer: the 40 bits of its value, and its length in bytes; none without a digit.
fn integer(text: &[u8], letter: u8) -> (u64, usize) {
    let signed = usize::from(matches!(text.first(), Some(b'+' | b'-')));
    let digits = &text[signed..];
    let takes_prefix = matches!(letter, b'i' | b'x' | b'X' | b'p');
    let has_prefix = matches!(digits, [b'0', b'x' | b'X', digit, ..] if digit.is_ascii_hexdigit());
    let (base, prefix) = match letter {
        b'd' => (Base::Decimal, 0),
        b'u' => (Base::Unsigned, 0),
        b'o' => (Base::Octal, 0),
        _ if takes_prefix && has_prefix => (Base::Hexadecimal, 2),
        b'i' if digits.first() == Some(&b'0') => (Base::Octal, 0),
        b'i' => (Base::Decimal, 0),
        _ => (Base::Hexadecimal, 0),
    };
    let radix = match base {
        Base::Octal => 8,
        Base::Hexadecimal => 16,
        Base::Decimal | Base::Unsigned | Base::Any => 10,
    };
    let digits = &digits[prefix..];
    let count = digits.iter().take_while(|byte| char::from(**byte).is_digit(radix)).count();
    if count == 0 {
        return (0, 0);
    }
    let is_signed = matches!(letter, b'd' | b'i');
    let value = saturate_long(magnitude(&digits[..count], radix), text.first() == Some(&b'-'), is_signed);
    (value, signed + prefix + count)
}
