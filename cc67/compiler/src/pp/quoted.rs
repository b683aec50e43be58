//! The values of strings and character constants.

use std::ops::Range;

use super::lexer::is_blank;
use crate::ast::Encoding;

/// A problem within the quotes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct QuotedProblem {
    /// The severity.
    pub kind: ProblemKind,
    /// The finding.
    pub message: String,
    /// The bytes of the text that it refers to.
    pub range: Range<usize>,
    /// The replacement.
    pub help: Option<String>,
}

/// The severity of a problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProblemKind {
    /// The program is wrong.
    Error,
    /// The value is the same as with the vendor's compiler.
    Warning,
}

/// The elements of a quoted string in an encoding, and its errors.
#[must_use]
pub fn string(text: &[u8], encoding: Encoding) -> (Vec<i32>, Vec<QuotedProblem>) {
    let mut problems = Vec::new();
    let elements = decode(text, encoding, &mut problems);
    (elements, problems)
}

/// The value of a quoted character constant, and its errors.
#[must_use]
pub fn character(text: &[u8]) -> (i32, Vec<QuotedProblem>) {
    let mut problems = Vec::new();
    let encoding = encoding(text);
    let elements = decode(text, encoding, &mut problems);
    let first = elements.first().copied().unwrap_or(0);
    let value = match u8::try_from(first) {
        Ok(byte) if encoding.size() == 1 => i32::from(byte.cast_signed()),
        _ => first,
    };
    let message = match elements.len() {
        0 => "character constant is empty",
        1 => return (value, problems),
        _ => "character constant has more than one character",
    };
    let help = (elements.len() > 1).then(|| "a string has double quotes: `\"`".to_owned());
    problems.push(QuotedProblem {
        kind: ProblemKind::Error,
        message: message.to_owned(),
        range: 0..text.len(),
        help,
    });
    (value, problems)
}

/// The encoding that the prefix of a string or character constant selects.
#[must_use]
pub fn encoding(text: &[u8]) -> Encoding {
    let all = [Encoding::Utf8, Encoding::Utf16, Encoding::Utf32, Encoding::Wide];
    all.into_iter().find(|encoding| text.starts_with(encoding.prefix().as_bytes())).unwrap_or_default()
}

fn decode(text: &[u8], encoding: Encoding, problems: &mut Vec<QuotedProblem>) -> Vec<i32> {
    let end = text.len().saturating_sub(1);
    let mut at = 1 + self::encoding(text).prefix().len();
    let mut elements = Vec::with_capacity(end.saturating_sub(at));
    while at < end {
        let Some(byte) = text.get(at) else { break };
        if *byte != b'\\' {
            // A string over several lines of a Windows file only contains the line feeds.
            if *byte == b'\r' && text.get(at + 1) == Some(&b'\n') {
                at += 1;
            } else {
                at += read_plain_character(text.get(at..end).unwrap_or_default(), encoding, &mut elements);
            }
            continue;
        }
        let blanks = text.iter().skip(at + 1).take_while(|byte| is_blank(**byte)).count();
        if text.get(at + 1 + blanks) == Some(&b'\n') {
            at += blanks + 2;
            continue;
        }
        if let Some((point, length)) = universal(text, at) {
            encode(point, encoding, &mut elements);
            at += length;
            continue;
        }
        let (value, length) = escape(text, at, encoding, problems);
        elements.push(value);
        at += length;
    }
    elements
}

/// Reads one ordinary character; returns its length. Bytes that are not UTF-8 represent themselves, as in Latin-1.
fn read_plain_character(text: &[u8], encoding: Encoding, elements: &mut Vec<i32>) -> usize {
    let byte = text.first().copied().unwrap_or(0);
    let length = match byte {
        0xC2..=0xDF => 2,
        0xE0..=0xEF => 3,
        0xF0..=0xF4 => 4,
        _ => 1,
    };
    let sequence = text.get(..length).and_then(|bytes| std::str::from_utf8(bytes).ok());
    match sequence.and_then(|text| text.chars().next()) {
        Some(character) if encoding.size() > 1 => {
            encode(character, encoding, elements);
            length
        }
        _ => {
            elements.push(i32::from(byte));
            1
        }
    }
}

/// `\u00e9`, `\U0001F600`: the character and the length of the escape, if it is one.
fn universal(text: &[u8], at: usize) -> Option<(char, usize)> {
    let digits = match text.get(at + 1)? {
        b'u' => 4,
        b'U' => 8,
        _ => return None,
    };
    let written = text.get(at + 2..at + 2 + digits)?;
    let value = written
        .iter()
        .try_fold(0_u32, |value, byte| value.checked_mul(16)?.checked_add(char::from(*byte).to_digit(16)?))?;
    Some((char::from_u32(value)?, 2 + digits))
}

/// Adds a character in the units of an encoding.
fn encode(character: char, encoding: Encoding, elements: &mut Vec<i32>) {
    match encoding.size() {
        1 => elements.extend(character.encode_utf8(&mut [0; 4]).bytes().map(i32::from)),
        2 => elements.extend(character.encode_utf16(&mut [0; 2]).iter().map(|unit| i32::from(*unit))),
        _ => elements.push(u32::from(character).cast_signed()),
    }
}

/// The value of the escape at `at`, and its length in bytes.
fn escape(text: &[u8], at: usize, encoding: Encoding, problems: &mut Vec<QuotedProblem>) -> (i32, usize) {
    let letter = text.get(at + 1).copied().unwrap_or(0);
    let value = match letter {
        b'a' => 7,
        b'b' => 8,
        b'f' => 12,
        b'n' => 10,
        b'r' => 13,
        b't' => 9,
        b'v' => 11,
        b'e' => 27,
        b'\'' | b'"' | b'\\' | b'?' => i32::from(letter),
        b'0'..=b'7' => return numeric(text, at, at + 1, 8, 3, encoding, problems),
        b'x' => return numeric(text, at, at + 2, 16, usize::MAX, encoding, problems),
        _ => {
            let shown = if letter.is_ascii_graphic() { char::from(letter) } else { '?' };
            problems.push(QuotedProblem {
                kind: ProblemKind::Warning,
                message: format!("unknown escape `\\{shown}`"),
                range: at..at + 2,
                help: Some("write `\\\\` for a backslash".to_owned()),
            });
            i32::from(letter)
        }
    };
    (value, 2)
}

/// An octal or hexadecimal escape whose digits begin at `start`.
fn numeric(
    text: &[u8],
    at: usize,
    start: usize,
    base: u32,
    most: usize,
    encoding: Encoding,
    problems: &mut Vec<QuotedProblem>,
) -> (i32, usize) {
    let mut problem = |kind, range, message: &str| {
        problems.push(QuotedProblem { kind, message: message.to_owned(), range, help: None });
    };
    let digits = text.iter().skip(start).take(most).map_while(|byte| char::from(*byte).to_digit(base));
    let (mut value, mut length, mut overflows) = (0_u32, 0, false);
    for digit in digits {
        overflows |= value.leading_zeros() < base.ilog2();
        value = value.wrapping_mul(base) | digit;
        length += 1;
    }
    let end = start + length;
    let most_of = match encoding.size() {
        1 => 0xFF,
        2 => 0xFFFF,
        _ => u32::MAX,
    };
    if length == 0 {
        problem(ProblemKind::Error, at..end, "digits missing after `\\x`");
    } else if overflows || value > most_of {
        let what = if most_of == 0xFF { "its low byte is taken" } else { "its low digits are taken" };
        problem(ProblemKind::Warning, at..end, &format!("escape does not fit a character; {what}"));
    }
    ((value & most_of).cast_signed(), end - at)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strings() {
        let check = |text: &str, expect: &[i32]| assert_eq!(read(text.as_bytes()), (expect.to_vec(), vec![]));
        check(r#""ab""#, &[97, 98]);
        check(r#""""#, &[]);
        check(r#""\a\b\f\n\r\t\v\e\'\"\\\?""#, &[7, 8, 12, 10, 13, 9, 11, 27, 39, 34, 92, 63]);
        check(r#""\0\12\1234""#, &[0, 10, 83, 52]);
        check(r#""\x41\xff""#, &[65, 255]);
        check(r#"L"a\x1234""#, &[97, 0x1234]);
        check("\"a\\\nb\\\r\nc\r\nd\"", &[97, 98, 99, 10, 100]);
        assert_eq!(read(b"\"\xE9\"").0, [0xE9]);
    }

    #[test]
    fn encodings_split_characters_into_their_units() {
        let check = |text: &str, expect: &[i32]| assert_eq!(read(text.as_bytes()), (expect.to_vec(), vec![]));
        check("\"é\"", &[0xC3, 0xA9]);
        check(r#""\u00e9""#, &[0xC3, 0xA9]);
        check("u8\"é\"", &[0xC3, 0xA9]);
        check("u\"é😀\"", &[0xE9, 0xD83D, 0xDE00]);
        check("U\"é😀\"", &[0xE9, 0x1F600]);
        check(r#"L"\U0001F600\xffffffff""#, &[0x1F600, -1]);
        assert_eq!(read(b"L\"\xE9\"").0, [0xE9]);
        assert_eq!(character("u'é'".as_bytes()), (0xE9, vec![]));
    }

    fn read(text: &[u8]) -> (Vec<i32>, Vec<QuotedProblem>) {
        string(text, encoding(text))
    }

    #[test]
    fn characters_are_signed() {
        let check = |text: &str, expect: i32| assert_eq!(character(text.as_bytes()), (expect, vec![]));
        check("'a'", 97);
        check(r"'\377'", -1);
        check(r"'\0'", 0);
        check(r"L'\377'", 255);
    }

    #[test]
    fn problems_say_where() {
        let check = |text: &str, message: &str, range: Range<usize>| {
            let problems =
                if text.starts_with('"') { read(text.as_bytes()).1 } else { character(text.as_bytes()).1 };
            let found: Vec<_> =
                problems.into_iter().map(|problem| (problem.message, problem.range)).collect();
            assert_eq!(found, [(message.to_owned(), range)], "{text}");
        };
        check(r#""C:\Program""#, r"unknown escape `\P`", 3..5);
        check(r#""\xg""#, r"digits missing after `\x`", 1..3);
        check(r#""\x123""#, "escape does not fit a character; its low byte is taken", 1..6);
        check("''", "character constant is empty", 0..2);
        check("'ab'", "character constant has more than one character", 0..4);
    }
}
