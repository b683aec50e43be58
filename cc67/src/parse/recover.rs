//! Reporting syntax errors, and going on behind them.

use crate::diag::{Diagnostic, TOO_MANY_ERRORS};
use crate::names::word;
use crate::pp::{Flags, Token, TokenKind};
use crate::source::Span;

use super::{Parsed, Parser, Reported};

impl Parser<'_> {
    /// Reports something; nothing after the parser stopped.
    pub(super) fn report(&mut self, diagnostic: Diagnostic) {
        if self.is_stopped {
            return;
        }
        self.sink.report(diagnostic);
        if self.sink.is_full() {
            self.sink.report(Diagnostic::global_error(TOO_MANY_ERRORS));
            self.stop();
        }
    }

    /// Reports an error and gives up the construct.
    pub(super) fn fail<T>(&mut self, diagnostic: Diagnostic) -> Parsed<T> {
        self.report(diagnostic);
        Err(Reported)
    }

    /// Gives up the rest of the program.
    pub(super) fn stop(&mut self) -> Reported {
        self.is_stopped = true;
        self.at = self.tokens.len();
        Reported
    }

    /// Reports that something else was expected than the next token.
    pub(super) fn fail_expected<T>(&mut self, what: &str) -> Parsed<T> {
        let token = self.peek();
        if token.kind == TokenKind::End {
            return Err(self.report_end(what));
        }
        if token.flags.has(Flags::BROKEN) {
            return Err(Reported);
        }
        let found = self.describe(token);
        self.fail(Diagnostic::error(token.span, format!("expected {what}, found {found}")))
    }

    /// Reads a token of this kind; `what` says where it is expected.
    pub(super) fn expect(&mut self, kind: TokenKind, what: &str) -> Parsed<Token> {
        match self.take(kind) {
            Some(token) => Ok(token),
            None => {
                let text = kind.punctuator().unwrap_or("name");
                self.fail_expected(&format!("`{text}` {what}"))
            }
        }
    }

    /// Reads the bracket that closes the one opened last.
    pub(super) fn close(&mut self, kind: TokenKind) -> Parsed<Token> {
        if let Some(token) = self.take(kind) {
            self.open.pop();
            return Ok(token);
        }
        let text = kind.punctuator().unwrap_or_default();
        let found = self.peek();
        if found.kind == TokenKind::End {
            return Err(self.report_end(&format!("`{text}`")));
        }
        let opener = self.open.pop().unwrap_or(found);
        let message = format!("expected `{text}`, found {}", self.describe(found));
        self.report(Diagnostic::error(found.span, message).label(opener.span, "to close this"));
        // Before these the bracket was just forgotten.
        if matches!(found.kind, TokenKind::Semicolon | TokenKind::LeftBrace | TokenKind::RightBrace) {
            Ok(found)
        } else {
            self.open.push(opener);
            Err(Reported)
        }
    }

    /// Reads the `;` behind `what`, whose missing is reported where it should stand.
    pub(super) fn semicolon(&mut self, what: Span) -> Parsed<()> {
        if self.take(TokenKind::Semicolon).is_some() {
            return Ok(());
        }
        let found = self.peek();
        if found.kind == TokenKind::End && !self.open.is_empty() {
            return Err(self.report_end("`;`"));
        }
        let place = self.end_of_last();
        let message = match self.short_text(what, place) {
            Some(text) => format!("expected `;` after `{text}`"),
            None => "expected `;`".to_owned(),
        };
        let mut diagnostic = Diagnostic::error(place, message);
        let is_forgotten = found.flags.has(Flags::LINE_START) || found.kind == TokenKind::RightBrace;
        if !is_forgotten {
            let found = self.describe(found);
            diagnostic = diagnostic.at(format!("found {found}"));
        }
        self.report(diagnostic);
        if is_forgotten || found.kind == TokenKind::End { Ok(()) } else { Err(Reported) }
    }

    /// The place behind the token read last.
    pub(super) fn end_of_last(&self) -> Span {
        let site = self.sources.call_site(self.last_span());
        Span::new(site.hi, site.hi)
    }

    /// A token as a message names it.
    pub(super) fn describe(&self, token: Token) -> String {
        match token.kind {
            TokenKind::End => "the end of the file".to_owned(),
            TokenKind::String => "a string".to_owned(),
            TokenKind::Stray => format!("the character `{}`", self.text(token.span)),
            _ => {
                format!("`{}`", token.kind.punctuator().map_or_else(|| self.text(token.span), str::to_owned))
            }
        }
    }

    pub(super) fn text(&self, span: Span) -> String {
        String::from_utf8_lossy(self.sources.text(span)).into_owned()
    }

    /// The text from the start of a construct to a place behind it, if it is short and in one line.
    fn short_text(&self, start: Span, end: Span) -> Option<String> {
        let text = self.text(Span::new(self.sources.call_site(start).lo, end.lo));
        let is_short = !text.is_empty() && text.len() <= 40 && !text.contains(['\n', '`']);
        is_short.then_some(text)
    }

    /// Reports that the file ends within something, and stops.
    fn report_end(&mut self, what: &str) -> Reported {
        // The preprocessor gave up and said why.
        if self.end.flags.has(Flags::BROKEN) {
            return self.stop();
        }
        let diagnostic = match self.open.pop() {
            Some(opener) => {
                let text = opener.kind.punctuator().unwrap_or_default();
                Diagnostic::error(opener.span, format!("`{text}` is never closed"))
                    .at("opened here")
                    .label(self.end_of_last(), "the file ends here")
            }
            None => {
                Diagnostic::error(self.end_of_last(), format!("expected {what}, found the end of the file"))
            }
        };
        self.report(diagnostic);
        self.stop()
    }

    /// Goes to the end of a statement or declaration that could not be parsed. Brackets opened since there
    /// were `open` of them are taken to be those of the failed construct.
    pub(super) fn skip_statement(&mut self, open: usize) {
        if self.is_stopped || self.is_unwinding {
            self.open.truncate(open);
            return;
        }
        let mut pending = self.open.len().saturating_sub(open);
        self.open.truncate(open);
        loop {
            let token = self.peek();
            match token.kind {
                TokenKind::End | TokenKind::RightBrace => return,
                TokenKind::LeftParen | TokenKind::LeftBracket => pending += 1,
                TokenKind::RightParen | TokenKind::RightBracket => pending = pending.saturating_sub(1),
                TokenKind::Semicolon if pending == 0 || self.is_line_start_at(1) => {
                    self.at += 1;
                    return;
                }
                TokenKind::LeftBrace => {
                    self.skip_braces();
                    if self.kind() != TokenKind::Semicolon && self.kind() != TokenKind::Comma {
                        return;
                    }
                    continue;
                }
                TokenKind::Identifier
                    if token.flags.has(Flags::LINE_START) && self.is_statement_word(token) =>
                {
                    return;
                }
                _ => {}
            }
            self.at += 1;
        }
    }

    /// Goes behind the `)` of a condition that could not be parsed.
    pub(super) fn skip_to_close(&mut self, open: usize) {
        let mut pending = self.open.len().saturating_sub(open);
        self.open.truncate(open);
        while pending > 0 && !self.is_stopped && !self.is_unwinding {
            match self.kind() {
                TokenKind::End | TokenKind::LeftBrace | TokenKind::RightBrace => return,
                TokenKind::Semicolon if self.is_line_start_at(1) => return,
                TokenKind::LeftParen | TokenKind::LeftBracket => pending += 1,
                TokenKind::RightParen | TokenKind::RightBracket => pending -= 1,
                _ => {}
            }
            self.at += 1;
        }
    }

    /// Goes behind the brace that closes the next one.
    pub(super) fn skip_braces(&mut self) {
        let mut depth = 0_usize;
        loop {
            match self.next().kind {
                TokenKind::LeftBrace => depth += 1,
                TokenKind::RightBrace => depth -= 1,
                TokenKind::End => return,
                _ => {}
            }
            if depth == 0 {
                return;
            }
        }
    }

    fn is_line_start_at(&self, ahead: usize) -> bool {
        self.tokens.get(self.at + ahead).is_none_or(|token| token.flags.has(Flags::LINE_START))
    }

    /// Whether a token is a word that begins a statement or declaration.
    fn is_statement_word(&self, token: Token) -> bool {
        matches!(
            token.name,
            word::IF
                | word::FOR
                | word::WHILE
                | word::DO
                | word::SWITCH
                | word::CASE
                | word::DEFAULT
                | word::RETURN
                | word::BREAK
                | word::CONTINUE
                | word::GOTO
                | word::ELSE
                | word::TYPEDEF
        ) || self.is_type_word(token.name)
    }
}
