//! Words, texts and signs of a line, each with its column.

use super::reader::TIME_UNITS;

/// The kind and content of a token.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum TokenKind {
    /// A word or number.
    Word(String),
    /// Characters between quotation marks, escapes resolved.
    Text(Vec<u8>),
    /// `=`, another sign between two numbers, or `±`.
    Sign(&'static str),
    /// `;`, which separates statements.
    Semicolon,
}

/// One token.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Token {
    pub(super) kind: TokenKind,
    /// Its first character, from 1.
    pub(super) column: usize,
}

/// A mistake and its column.
pub(super) type Mistake = (usize, String);

/// Splits a line; `#` begins a comment.
pub(super) fn tokens(line: &str) -> Result<Vec<Token>, Mistake> {
    let characters: Vec<char> = line.chars().collect();
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(&character) = characters.get(at) {
        let column = at + 1;
        let kind = match character {
            '#' => break,
            ';' => {
                at += 1;
                TokenKind::Semicolon
            }
            '"' => TokenKind::Text(text(&characters, &mut at)?),
            character if character.is_whitespace() => {
                at += 1;
                continue;
            }
            _ => match sign(&characters, &mut at) {
                Some(sign) => TokenKind::Sign(sign),
                None => TokenKind::Word(word(&characters, &mut at)),
            },
        };
        if let TokenKind::Word(word) = &kind
            && let Some(element) = element(word)
        {
            tokens.push(Token { kind: TokenKind::Word(PERSIST.to_owned()), column });
            let number = TokenKind::Word(element.to_owned());
            tokens.push(Token { kind: number, column: column + PERSIST.len() + 1 });
            continue;
        }
        tokens.push(Token { kind, column });
    }
    Ok(with_units(tokens))
}

/// The unit of analog inputs.
const VOLTS: &str = "V";

/// Joins numbers and the units that a blank separates from them, as in `0.5 s` and `2.5 V`.
fn with_units(tokens: Vec<Token>) -> Vec<Token> {
    let mut joined: Vec<Token> = Vec::with_capacity(tokens.len());
    for token in tokens {
        if let TokenKind::Word(unit) = &token.kind
            && (unit == VOLTS || TIME_UNITS.iter().any(|(name, _)| name == unit))
            && let Some(Token { kind: TokenKind::Word(number), .. }) = joined.last_mut()
            && number.parse::<f64>().is_ok()
        {
            number.push_str(unit);
            continue;
        }
        joined.push(token);
    }
    joined
}

/// The first word of statements and conditions about an element of `persist.UserData`.
const PERSIST: &str = "persist";

/// The number of an element that is written as `--set` takes it, `persist.5`.
fn element(word: &str) -> Option<&str> {
    let number = word.strip_prefix(PERSIST)?.strip_prefix('.')?;
    (!number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit())).then_some(number)
}

/// The spellings of signs, the longer ones first, each with its canonical form.
const SIGNS: &[(&str, &str)] = &[
    ("<=", "<="),
    (">=", ">="),
    ("!=", "!="),
    ("==", "="),
    ("+-", "±"),
    ("=", "="),
    ("<", "<"),
    (">", ">"),
    ("±", "±"),
];

/// The sign at this position.
fn sign(characters: &[char], at: &mut usize) -> Option<&'static str> {
    let rest = characters.get(*at..).unwrap_or_default();
    let begins = |written: &str| written.chars().eq(rest.iter().copied().take(written.chars().count()));
    let (written, sign) = SIGNS.iter().find(|(written, _)| begins(written))?;
    *at += written.chars().count();
    Some(sign)
}

/// Reads a word up to a space or a sign; `->` is a part of a word.
fn word(characters: &[char], at: &mut usize) -> String {
    let start = *at;
    while let Some(&character) = characters.get(*at) {
        let is_arrow = character == '>' && *at > start && characters.get(*at - 1) == Some(&'-');
        let is_end = character.is_whitespace() || matches!(character, ';' | '#' | '"');
        if is_end || (!is_arrow && *at > start && sign(characters, &mut at.clone()).is_some()) {
            break;
        }
        *at += 1;
    }
    characters.get(start..*at).unwrap_or_default().iter().collect()
}

/// Reads the bytes of a text and moves `at` past it.
fn text(characters: &[char], at: &mut usize) -> Result<Vec<u8>, Mistake> {
    let start = *at + 1;
    let mut bytes = Vec::new();
    *at += 1;
    loop {
        let column = *at + 1;
        match characters.get(*at) {
            None => return Err((start, "the text has no closing \"".to_owned())),
            Some('"') => {
                *at += 1;
                return Ok(bytes);
            }
            Some('\\') => bytes.push(escape(characters, at, column)?),
            Some(&character) => {
                *at += 1;
                bytes.extend(character.to_string().bytes());
            }
        }
    }
}

/// The byte of an escape sequence.
fn escape(characters: &[char], at: &mut usize, column: usize) -> Result<u8, Mistake> {
    let named = characters.get(*at + 1).copied();
    *at += 2;
    Ok(match named {
        Some('r') => b'\r',
        Some('n') => b'\n',
        Some('t') => b'\t',
        Some('0') => 0,
        Some('\\') => b'\\',
        Some('"') => b'"',
        Some('x') => {
            let digits: String = characters.iter().skip(*at).take(2).collect();
            *at += 2;
            u8::from_str_radix(&digits, 16)
                .map_err(|_| (column, "\\x takes two hexadecimal digits".to_owned()))?
        }
        _ => return Err((column, "a text knows \\r \\n \\t \\0 \\\\ \\\" and \\xNN".to_owned())),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_split_into_tokens() {
        let tokens = tokens("at 1s bit 5=1; uart \"a\\x41\\r#\" # said").expect("it is right");
        let kinds: Vec<_> = tokens.iter().map(|token| (token.column, format!("{:?}", token.kind))).collect();
        let columns: Vec<_> = tokens.iter().map(|token| token.column).collect();
        assert_eq!(columns, [1, 4, 7, 11, 12, 13, 14, 16, 21], "{kinds:?}");
        assert_eq!(tokens[8].kind, TokenKind::Text(b"aA\r#".to_vec()));
    }

    #[test]
    fn an_element_is_written_with_a_blank_or_a_dot() {
        let kinds =
            |line| tokens(line).expect("it is right").into_iter().map(|token| token.kind).collect::<Vec<_>>();
        assert_eq!(kinds("expect persist.20 = 5"), kinds("expect persist 20 = 5"));
        assert_eq!(kinds("persist.UserData[5] = 1").len(), 3);
    }

    #[test]
    fn unclosed_texts_and_unknown_escapes_are_errors() {
        for (line, expect) in [("uart \"a", 6), ("uart \"\\q\"", 7), ("uart \"\\x4\"", 7), ("\"\\", 2)] {
            assert_eq!(tokens(line).expect_err("it is wrong").0, expect, "{line}");
        }
    }
}
