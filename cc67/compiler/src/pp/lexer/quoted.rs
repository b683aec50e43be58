//! The ends of strings and character constants; their meaning is read later.

use crate::diag::Diagnostic;

use super::super::LAX;
use super::super::token::{Flags, Token, TokenKind};
use super::{Lexer, LexerContext};

impl Lexer {
    /// Reads a string or character constant that starts at `lo`; its quote is the next byte.
    pub(super) fn quoted_token(&mut self, lo: usize, flags: Flags, cx: &mut LexerContext<'_>) -> Token {
        let quote = self.at;
        let delimiter = self.byte(quote);
        let kind = if delimiter == b'"' { TokenKind::String } else { TokenKind::Character };
        let mut runs_over_lines = false;
        self.at += 1;
        loop {
            match self.byte(self.at) {
                byte if byte == delimiter => break self.at += 1,
                _ if self.at >= self.end => return self.unterminated(kind, lo, quote, flags, cx),
                b'\n' if self.in_directive || kind == TokenKind::Character => {
                    return self.unterminated(kind, lo, quote, flags, cx);
                }
                // A line that ends as a statement does is one; the quote was forgotten.
                b'\n' if !runs_over_lines && self.bytes(quote, self.at).trim_ascii_end().ends_with(b";") => {
                    return self.unterminated(kind, lo, quote, flags, cx);
                }
                b'\\' if self.splice(cx) => {}
                b'\\' => self.at += 2,
                byte => {
                    runs_over_lines |= byte == b'\n';
                    self.at += 1;
                }
            }
        }
        if runs_over_lines {
            let first_line = self.end_of_line(quote);
            cx.sink.report(
                Diagnostic::warning(LAX, self.span_to(lo, first_line), "string runs over several lines")
                    .at("the line ends are part of the string")
                    .help("is a closing `\"` missing? else write `\\n\"` and start the next line with `\"`"),
            );
        }
        Token::new(kind, flags, self.span_from(lo))
    }

    /// Reports a missing closing quote and continues after the part of the line that was probably meant.
    fn unterminated(
        &mut self,
        kind: TokenKind,
        lo: usize,
        quote: usize,
        flags: Flags,
        cx: &mut LexerContext<'_>,
    ) -> Token {
        let line_end = self.end_of_line(quote);
        let line = self.bytes(quote, line_end);
        // `printf("a);` probably lacks the quote before `);`, and `'a;` the quote after `a`.
        self.at = match kind {
            TokenKind::String => {
                let tail = line.iter().rev().take_while(|byte| b");\r \t".contains(byte)).count();
                if self.in_directive { line_end } else { (line_end - tail).max(quote + 1) }
            }
            _ => (quote + 2).min(line_end),
        };
        let (message, at) = match kind {
            TokenKind::String => ("string is never closed", "no closing `\"`"),
            _ => ("character constant is never closed", "no closing `'` on this line"),
        };
        cx.sink.report(Diagnostic::error(self.span_to(lo, quote + 1), message).at(at));
        Token::new(kind, flags.with(Flags::BROKEN), self.span_from(lo))
    }
}
