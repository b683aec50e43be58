//! Reporting syntax errors, and continuing after them.

use crate::diag::{Diagnostic, TOO_MANY_ERRORS};
use crate::names::word;
use crate::pp::{Flags, Token, TokenKind};
use crate::source::Span;

use super::{ErrorReported, ParseResult, Parser};

impl Parser<'_> {
    /// Reports a diagnostic, unless the parser has stopped.
    pub(super) fn report(&mut self, diagnostic: Diagnostic) {
        if self.recovery.is_stopped {
            return;
        }
        self.sink.report(diagnostic);
        if self.sink.is_full() {
            self.sink.report(Diagnostic::global_error(TOO_MANY_ERRORS));
            self.stop();
        }
    }

    /// Reports an error and gives up the construct.
    pub(super) fn fail<T>(&mut self, diagnostic: Diagnostic) -> ParseResult<T> {
        self.report(diagnostic);
        Err(ErrorReported)
    }

    /// Gives up the rest of the program.
    pub(super) fn stop(&mut self) -> ErrorReported {
        self.recovery.is_stopped = true;
        self.at = self.tokens.len();
        ErrorReported
    }

    /// Reports that the next token is not the expected one.
    pub(super) fn fail_expected<T>(&mut self, what: &str) -> ParseResult<T> {
        let token = self.peek();
        if token.kind == TokenKind::End {
            return Err(self.report_end(what));
        }
        if token.flags.has(Flags::BROKEN) {
            return Err(ErrorReported);
        }
        let found = self.describe(token);
        let diagnostic = Diagnostic::error(token.span, format!("expected {what}, found {found}"));
        self.fail(match self.hint(token) {
            Some(help) => diagnostic.help(help),
            None => diagnostic,
        })
    }

    /// The probable meaning of an unexpected `token`.
    fn hint(&self, token: Token) -> Option<String> {
        if let Some(advice) = self.macro_advice(token) {
            return Some(advice);
        }
        let before = self.at.checked_sub(1).and_then(|at| self.tokens.get(at))?;
        let is_adjacent = !token.flags.has(Flags::SPACE) && !token.flags.has(Flags::LINE_START);
        let advice = match (before.kind, token.kind) {
            (TokenKind::Assign, TokenKind::Greater) if is_adjacent => "did you mean `>=`?",
            (TokenKind::Assign, TokenKind::Less) if is_adjacent => "did you mean `<=`?",
            (TokenKind::Less, TokenKind::Greater) if is_adjacent => "did you mean `!=`?",
            (TokenKind::Not | TokenKind::Equal | TokenKind::NotEqual, TokenKind::Assign) if is_adjacent => {
                "`==` and `!=` have two characters"
            }
            (_, TokenKind::Number) if !self.text(token.span).bytes().all(|byte| byte.is_ascii_digit()) => {
                "a name begins with a letter or `_`"
            }
            _ => return None,
        };
        Some(advice.to_owned())
    }

    /// Advice on the `#define` that has put `=` or `;` where it is not allowed.
    fn macro_advice(&self, token: Token) -> Option<String> {
        let expansion = self.sources.expansion(token.span.expansion)?;
        let text = match token.kind {
            TokenKind::Assign => "=",
            TokenKind::Semicolon => ";",
            _ => return None,
        };
        Some(format!("remove the `{text}` from `#define {}`", self.sources.macro_name(expansion)))
    }

    /// Takes a token of this kind; `what` describes the position where it is expected.
    pub(super) fn expect(&mut self, kind: TokenKind, what: &str) -> ParseResult<Token> {
        match self.eat(kind) {
            Some(token) => Ok(token),
            None => {
                let text = kind.punctuator().unwrap_or("name");
                self.fail_expected(&format!("`{text}` {what}"))
            }
        }
    }

    /// Takes the bracket that closes the last open one.
    pub(super) fn close(&mut self, kind: TokenKind) -> ParseResult<Token> {
        if let Some(token) = self.eat(kind) {
            self.recovery.open.pop();
            return Ok(token);
        }
        let text = kind.punctuator().unwrap_or_default();
        let found = self.peek();
        if found.kind == TokenKind::End {
            return Err(self.report_end(&format!("`{text}`")));
        }
        let opener = self.recovery.open.pop().unwrap_or(found);
        let advice = self.macro_advice(found);
        if found.kind == TokenKind::Semicolon
            && self.kind_at(1) == kind
            && let Some(help) = advice
        {
            let message = "a `;` from a macro ends the statement here";
            self.report(Diagnostic::error(found.span, message).help(help));
            self.at += 1;
            return Ok(self.next());
        }
        self.report(self.unclosed_bracket(opener, found, text));
        // Before these the bracket was just forgotten.
        if matches!(found.kind, TokenKind::Semicolon | TokenKind::LeftBrace | TokenKind::RightBrace)
            || found.flags.has(Flags::LINE_START) && self.is_condition(opener)
        {
            Ok(found)
        } else {
            self.recovery.open.push(opener);
            Err(ErrorReported)
        }
    }

    /// Reports whether a parenthesis belongs to `if`, `while` or `switch`.
    fn is_condition(&self, opener: Token) -> bool {
        let tokens = self.tokens.get(..self.at).unwrap_or_default();
        let at = tokens.iter().rposition(|token| token.span == opener.span);
        let before = at.and_then(|at| at.checked_sub(1)).and_then(|at| tokens.get(at));
        before.is_some_and(|word| matches!(word.name, word::IF | word::WHILE | word::SWITCH))
    }

    /// The error for a bracket whose partner was expected at `found`.
    fn unclosed_bracket(&self, opener: Token, found: Token, text: &str) -> Diagnostic {
        let is_forgotten = found.flags.has(Flags::LINE_START) || found.kind == TokenKind::Semicolon;
        let mut diagnostic = if is_forgotten {
            Diagnostic::error(self.end_of_last(), format!("expected `{text}`"))
                .at(format!("before {}", self.describe(found)))
        } else {
            let message = format!("expected `{text}`, found {}", self.describe(found));
            Diagnostic::error(found.span, message)
        };
        diagnostic = diagnostic.label(opener.span, "to close this");
        if let Some((name, span)) = self.open_macro() {
            diagnostic = diagnostic.label(span, format!("macro `{name}` leaves this open"));
        }
        match self.operator_word() {
            Some(advice) => diagnostic.help(advice),
            None => diagnostic,
        }
    }

    /// The macro with an unclosed parenthesis in its arguments: its name, and its position.
    fn open_macro(&self) -> Option<(String, Span)> {
        let tokens = self.tokens.get(..self.at)?.iter().rev();
        let statement = tokens.take_while(|token| {
            !matches!(token.kind, TokenKind::Semicolon | TokenKind::LeftBrace | TokenKind::RightBrace)
        });
        let mut closed: Vec<Token> = Vec::new();
        for token in statement {
            match token.kind {
                TokenKind::RightParen => closed.push(*token),
                TokenKind::LeftParen => {
                    let partner = closed.pop();
                    let expansion = self.sources.expansion(token.span.expansion);
                    if let Some(expansion) = expansion
                        && partner.is_none_or(|partner| partner.span.expansion != token.span.expansion)
                    {
                        let span = Span::new(token.span.lo, token.span.hi);
                        return Some((self.sources.macro_name(expansion).into_owned(), span));
                    }
                }
                _ => {}
            }
        }
        None
    }

    /// Takes the `;` after `what`; if it is missing, that is reported at its position.
    pub(super) fn semicolon(&mut self, what: Span) -> ParseResult<()> {
        if self.eat(TokenKind::Semicolon).is_some() {
            return Ok(());
        }
        let found = self.peek();
        if found.kind == TokenKind::End && !self.recovery.open.is_empty() {
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
            diagnostic = diagnostic.at(format!("found {}", self.describe(found)));
            let is_operand = found.kind == TokenKind::Number || self.is_identifier_at(0);
            if let Some(advice) = self.operator_word() {
                diagnostic = diagnostic.help(advice);
            } else if is_operand {
                diagnostic = diagnostic.help("or is an operator missing, such as `*`?");
            }
        }
        self.report(diagnostic);
        if is_forgotten || found.kind == TokenKind::End { Ok(()) } else { Err(ErrorReported) }
    }

    /// The place after the token read last.
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

    /// The text from the start of a construct to a later position, if it is short and on one line.
    fn short_text(&self, start: Span, end: Span) -> Option<String> {
        let text = self.text(Span::new(self.sources.call_site(start).lo, end.lo));
        let is_short = !text.is_empty() && text.len() <= 40 && !text.contains(['\n', '`']);
        is_short.then_some(text)
    }

    /// Reports that the file ends within a construct, and stops.
    fn report_end(&mut self, what: &str) -> ErrorReported {
        // The preprocessor gave up and reported the reason.
        if self.end.flags.has(Flags::BROKEN) {
            return self.stop();
        }
        let brace = self.recovery.open.iter().find(|token| token.kind == TokenKind::LeftBrace).copied();
        let innermost = self.recovery.open.pop().filter(|token| token.kind != TokenKind::LeftBrace);
        let diagnostic = match innermost.or(brace) {
            Some(opener) => {
                let opener = self.unclosed_brace(opener);
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

    /// Skips to the end of a statement or declaration that could not be parsed. Brackets opened since there were `open`
    /// of them are taken as part of the failed construct.
    pub(super) fn skip_statement(&mut self, open: usize) {
        if self.recovery.is_stopped || self.recovery.is_unwinding {
            self.recovery.open.truncate(open);
            return;
        }
        let mut pending = self.recovery.open.len().saturating_sub(open);
        self.recovery.open.truncate(open);
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

    /// Skips past the `)` of a condition that could not be parsed.
    pub(super) fn skip_to_close(&mut self, open: usize) {
        let mut pending = self.recovery.open.len().saturating_sub(open);
        self.recovery.open.truncate(open);
        while pending > 0 && !self.recovery.is_stopped && !self.recovery.is_unwinding {
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

    /// Skips past the brace that closes the next one to be opened.
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

    /// Reports whether a token is a word that begins a statement or declaration.
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
