//! The file name after `#include`, which is not a token.

use crate::source::Span;

use super::{Lexer, LexerContext};

/// A file name as written.
#[derive(Debug)]
pub(in super::super) struct HeaderName {
    /// The text between the delimiters.
    pub(in super::super) name: String,
    /// It is in `<>`, not in quotes.
    pub(in super::super) is_angled: bool,
    /// True if the closing delimiter exists.
    pub(in super::super) is_closed: bool,
    /// From delimiter to delimiter.
    pub(in super::super) span: Span,
}

impl Lexer {
    /// Reads a file name if one is next: `"name"`, `<name>`, or either without its end.
    pub(in super::super) fn header_name(&mut self, cx: &mut LexerContext<'_>) -> Option<HeaderName> {
        self.skip_space(cx);
        let lo = self.at;
        let closing = match self.byte(lo) {
            b'"' => b'"',
            b'<' => b'>',
            _ => return None,
        };
        let line = self.bytes(lo + 1, self.end_of_line(lo));
        let end = line.iter().position(|byte| *byte == closing);
        let text = match end {
            Some(end) => line.get(..end).unwrap_or(line),
            None => line.trim_ascii_end(),
        };
        let name = String::from_utf8_lossy(text).into_owned();
        self.at = lo + 1 + text.len() + usize::from(end.is_some());
        Some(HeaderName {
            name,
            is_angled: closing == b'>',
            is_closed: end.is_some(),
            span: self.span_from(lo),
        })
    }
}
