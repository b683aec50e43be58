//! `#` and `##`: tokens that are made by the preprocessor.

use std::sync::Arc;

use crate::diag::Diagnostic;
use crate::source::{ExpansionId, Span};

use super::engine::Preprocessor;
use super::lexer::{Lexer, LexerContext};
use super::token::{Flags, Token, TokenKind, token_text};
use super::{LAX, limits};

impl Preprocessor<'_> {
    /// The text of a token, as the program means it.
    pub(super) fn spelling(&self, token: Token) -> Vec<u8> {
        token_text(token, self.sources).into_owned()
    }

    /// The string that shows `tokens`, one blank where they are separated.
    pub(super) fn stringize(&mut self, tokens: &[Token], expansion: ExpansionId) -> Token {
        let mut text = vec![b'"'];
        for (index, token) in tokens.iter().enumerate() {
            if index > 0 && token.flags.is_separated() {
                text.push(b' ');
            }
            let is_quoted = matches!(token.kind, TokenKind::String | TokenKind::Character);
            for byte in self.spelling(*token) {
                match byte {
                    b'"' | b'\\' if is_quoted => text.extend([b'\\', byte]),
                    b'\n' => text.extend(b"\\n"),
                    _ => text.push(byte),
                }
            }
            if self.is_too_long(text.len(), token.span) {
                break;
            }
        }
        text.push(b'"');
        let span = Span { expansion, ..self.sources.add_scratch(&text) };
        Token::new(TokenKind::String, Flags::NONE, span)
    }

    /// Appends the token formed by `first` and `second`, or both if they do not form one.
    pub(super) fn paste(
        &mut self,
        output: &mut Vec<Token>,
        first: Token,
        second: Token,
        expansion: ExpansionId,
    ) {
        let mut text = self.spelling(first);
        text.extend(self.spelling(second));
        if self.is_too_long(text.len(), first.span) {
            return;
        }
        let span = Span { expansion, ..self.sources.add_scratch(&text) };
        let mut lexer = Lexer::new(Arc::new(text), span.lo);
        lexer.in_directive = true;
        // Faults of the joined text are reported here or when the token is used.
        let mut quiet = crate::diag::Sink::new();
        let joined = lexer.next(&mut LexerContext { names: self.names, sink: &mut quiet });
        if joined.span.lo == span.lo && joined.span.hi == span.hi && !quiet.has_errors() {
            output.push(Token {
                flags: first.flags.without(Flags::NO_EXPAND).without(Flags::SPLICED),
                span,
                ..joined
            });
            return;
        }
        let left = String::from_utf8_lossy(&self.spelling(first)).into_owned();
        let right = String::from_utf8_lossy(&self.spelling(second)).into_owned();
        let message = format!("pasting `{left}` and `{right}` does not give a valid token");
        self.sink.report(Diagnostic::warning(LAX, span, message).note("both are kept as they are"));
        output.extend([first, second]);
    }

    fn is_too_long(&mut self, length: usize, span: Span) -> bool {
        if length <= limits::MADE_BYTES {
            return false;
        }
        self.stop(span, format!("macro expansion creates a token longer than {} bytes", limits::MADE_BYTES));
        true
    }
}
