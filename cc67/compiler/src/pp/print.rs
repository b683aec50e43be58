//! Converts tokens back to text, for users and tests.

use crate::names::is_name_byte;
use crate::source::SourceMap;

use super::lexer::without_splices;
use super::token::{Flags, Token, TokenKind};

/// The text of a preprocessed translation unit; line breaks are kept, other white space becomes one blank.
#[must_use]
pub fn print(tokens: &[Token], sources: &SourceMap) -> Vec<u8> {
    let mut output: Vec<u8> = Vec::new();
    for token in tokens.iter().filter(|token| token.kind != TokenKind::End) {
        let text = token.kind.punctuator().map_or_else(|| sources.text(token.span), str::as_bytes);
        let last = output.last().copied();
        if last.is_some() && token.flags.has(Flags::LINE_START) {
            output.push(b'\n');
        } else if last.is_some() && (token.flags.has(Flags::SPACE) || would_join(last, text.first().copied()))
        {
            output.push(b' ');
        }
        if token.flags.has(Flags::SPLICED) {
            output.extend(without_splices(text));
        } else {
            output.extend(text);
        }
    }
    if !output.is_empty() {
        output.push(b'\n');
    }
    output
}

/// Reports whether two tokens without a separator could be read as one, judged by the adjacent bytes.
fn would_join(left: Option<u8>, right: Option<u8>) -> bool {
    let (Some(left), Some(right)) = (left, right) else { return false };
    match right {
        b'+' | b'-' | b'&' | b'|' | b'<' | b'.' | b'#' => left == right,
        b'>' => matches!(left, b'>' | b'-'),
        b'=' => b"=+-*/%&|^<>!".contains(&left),
        b'*' | b'/' => left == b'/',
        b'"' | b'\'' => left == b'L',
        _ => is_name_byte(left) && is_name_byte(right),
    }
}
