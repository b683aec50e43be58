//! Lines that begin with `#`.

use crate::diag::Diagnostic;
use crate::names::{Name, word};
use crate::source::Span;
use crate::words::suggest;

use super::engine::Preprocessor;
use super::token::{Token, TokenKind};

/// The directives, for suggestions.
const DIRECTIVES: &[&str] = &[
    "define", "undef", "include", "if", "ifdef", "ifndef", "elif", "else", "endif", "error", "warning",
    "pragma", "line",
];

/// Pragmas of other compilers for which programs are also written.
const KNOWN_PRAGMAS: &[&str] = &["TI_COMPILER", "once", "push_macro", "pop_macro"];

impl Preprocessor<'_> {
    /// Executes the directive after `hash`, and skips to the end of its line.
    pub(super) fn directive(&mut self, hash: Token) {
        let depth = self.open.len();
        let Some((lexer, mut cx)) = self.lexer() else { return };
        lexer.in_directive = true;
        let token = lexer.next(&mut cx);
        match token.kind {
            TokenKind::End => {}
            TokenKind::Number => self.line_marker(token),
            TokenKind::Identifier => self.named_directive(hash, token),
            _ => self.unknown_directive(token),
        }
        // An `#include` has finished its line before it opened the file.
        if self.open.len() == depth {
            self.finish_line();
        }
    }

    /// Skips the rest of a directive's line.
    pub(super) fn finish_line(&mut self) {
        if let Some((lexer, mut cx)) = self.lexer() {
            lexer.skip_line(&mut cx);
            lexer.in_directive = false;
        }
    }

    /// The next token of the directive's line, not expanded; `End` at its end.
    pub(super) fn directive_token(&mut self) -> Token {
        match self.lexer() {
            Some((lexer, mut cx)) => lexer.next(&mut cx),
            None => Token::new(TokenKind::End, super::Flags::NONE, Span::new(0, 0)),
        }
    }

    /// The rest of the directive's line, expanded.
    pub(super) fn directive_tokens(&mut self) -> Vec<Token> {
        let mut tokens = Vec::new();
        loop {
            let token = self.directive_token();
            if token.kind == TokenKind::End {
                return self.expand_list(tokens);
            }
            tokens.push(token);
        }
    }

    fn named_directive(&mut self, hash: Token, token: Token) {
        let span = hash.span.to(token.span);
        if let Some(file) = self.open.last_mut()
            && file.conditionals.is_empty()
            && token.name != word::IFNDEF
        {
            file.guard.meet_text();
        }
        match token.name {
            word::DEFINE => {
                if let Some(name) = self.define() {
                    self.note_macro(name);
                }
            }
            word::UNDEF => {
                if let Some(name) = self.macro_name("undef") {
                    self.note_macro(name.name);
                    self.macros.undefine(name.name);
                }
            }
            word::INCLUDE => self.include(span),
            word::IF => self.open_if(span),
            word::IFDEF => self.open_ifdef(span, true),
            word::IFNDEF => self.open_ifdef(span, false),
            word::ELIF => self.elif(span),
            word::ELSE => self.else_(span),
            word::ENDIF => self.endif(span),
            word::ERROR => {
                let text = self.line_text();
                self.sink.report(Diagnostic::error(span, format!("#error {text}")));
            }
            word::WARNING => {
                let text = self.line_text();
                self.sink.report(Diagnostic::requested_warning(span, format!("#warning {text}")));
            }
            word::PRAGMA => self.pragma(span),
            word::LINE => self.line(),
            _ => self.unknown_directive(token),
        }
    }

    /// The name in `#define`, `#undef` or `#ifdef`.
    pub(super) fn macro_name(&mut self, directive: &str) -> Option<Token> {
        let token = self.directive_token();
        if token.kind == TokenKind::Identifier && token.name != word::DEFINED {
            return Some(token);
        }
        let message = if token.kind == TokenKind::End {
            format!("name missing in `#{directive}`")
        } else {
            let spelling = self.spelling(token);
            format!("`{}` cannot be the name of a macro", String::from_utf8_lossy(&spelling))
        };
        self.sink.report(Diagnostic::error(token.span, message).at("expected a name"));
        None
    }

    fn line_text(&mut self) -> String {
        let text = self.lexer().map(|(lexer, _)| lexer.take_line()).unwrap_or_default();
        String::from_utf8_lossy(&text).into_owned()
    }

    fn pragma(&mut self, span: Span) {
        let text = self.line_text();
        let first = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').next().unwrap_or_default();
        if first == "once"
            && let Some(path) = self.open.last().and_then(|file| file.path.clone())
        {
            self.reader.set_once(path);
        }
        if let ("push_macro" | "pop_macro", Some(name)) = (first, text.split('"').nth(1)) {
            let name = self.names.intern(name);
            self.find_macro(name);
            match first {
                "push_macro" => self.macros.save(name),
                _ => {
                    self.note_macro(name);
                    self.macros.restore(name);
                }
            }
        }
        if !KNOWN_PRAGMAS.contains(&first) {
            self.sink.report(Diagnostic::remark(span, format!("`#pragma {text}` is ignored")));
        }
    }

    /// `#line 100 "file"`
    fn line(&mut self) {
        let tokens = self.directive_tokens();
        match tokens.split_first() {
            Some((number, rest)) if number.kind == TokenKind::Number => self.set_line(*number, rest),
            other => {
                let span = other.map_or_else(|| self.directive_token().span, |(token, _)| token.span);
                self.sink.report(Diagnostic::error(span, "expected a line number after `#line`"));
            }
        }
    }

    /// `# 33 "file"`, as other preprocessors write it.
    fn line_marker(&mut self, number: Token) {
        let file = self.directive_token();
        self.set_line(number, &[file]);
    }

    /// Makes the next line the one of this number.
    fn set_line(&mut self, number: Token, rest: &[Token]) {
        let text = self.spelling(number);
        let line = std::str::from_utf8(&text).ok().and_then(|text| text.parse::<i64>().ok());
        let (Some(line), Some(place)) = (line, self.sources.place(number.span)) else {
            self.sink.report(Diagnostic::error(number.span, "line number is not a decimal number"));
            return;
        };
        let name = rest.first().filter(|token| token.kind == TokenKind::String).map(|token| {
            let text = self.spelling(*token);
            let inner = text.strip_prefix(b"\"").and_then(|text| text.strip_suffix(b"\"")).unwrap_or(&text);
            String::from_utf8_lossy(inner).replace("\\\\", "\\")
        });
        if let Some(file) = self.open.last_mut() {
            file.line_shift = line.saturating_sub(i64::from(place.line) + 1);
            file.presumed_name = name.or(file.presumed_name.take());
        }
    }

    fn unknown_directive(&mut self, token: Token) {
        let spelling = String::from_utf8_lossy(&self.spelling(token)).into_owned();
        let diagnostic =
            Diagnostic::error(token.span, format!("unknown preprocessing directive `#{spelling}`"));
        self.sink.report_lost_names(match suggest(&spelling, DIRECTIVES.iter().copied()) {
            _ if spelling == "import" => diagnostic.help("use `#include`"),
            Some(near) => diagnostic.help(format!("did you mean `#{near}`?")),
            None => diagnostic,
        });
    }

    /// Reports whether a macro of this name is defined.
    pub(super) fn is_defined(&mut self, name: Name) -> bool {
        self.find_macro(name).is_some()
    }
}
