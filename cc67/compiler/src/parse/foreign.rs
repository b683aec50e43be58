//! Statements of other languages: reported once, with the equivalent in C, and skipped.

use std::collections::BTreeSet;

use crate::ast::{Expression, ExpressionKind, Statement, StatementKind};
use crate::diag::Diagnostic;
use crate::names::{Name, word};
use crate::pp::{Flags, TokenKind};
use crate::words::foreign as foreign_words;

use super::scopes::NameMeaning;
use super::{ParseResult, Parser};

/// A language in which parts of a program turn out to be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Language {
    Basic,
    Cpp,
    GCode,
}

/// The languages that were reported.
pub(super) type ReportedLanguages = BTreeSet<Language>;

impl Parser<'_> {
    /// Reports a word of a language, once for each language.
    fn report_foreign(&mut self, language: Language, diagnostic: Diagnostic) {
        if self.recovery.foreign.insert(language) {
            self.report(diagnostic);
        }
    }

    /// The spelling of the next token, if it is a name without a meaning here.
    fn unknown_word(&self) -> Option<&str> {
        let name = self.name().filter(|name| !name.is_keyword())?;
        (self.scopes.meaning(name) == NameMeaning::Unknown).then(|| self.spelling(name))
    }

    /// The keyword that the next name would be with small letters, as in `If (x)`; reports it.
    pub(super) fn miswritten_keyword(&mut self) -> Option<Name> {
        let written =
            self.unknown_word().filter(|word| word.starts_with(|first: char| first.is_uppercase()))?;
        let small = written.to_ascii_lowercase();
        let keyword = self.names.find(&small)?;
        let fits = match keyword {
            word::IF | word::WHILE | word::FOR | word::SWITCH => self.kind_at(1) == TokenKind::LeftParen,
            word::DO => self.kind_at(1) == TokenKind::LeftBrace,
            word::RETURN => matches!(self.kind_at(1), TokenKind::Number | TokenKind::Semicolon),
            word::ELSE => true,
            _ => false,
        };
        if !fits {
            return None;
        }
        let message = format!("`{written}` is not a C keyword; case matters");
        let diagnostic = Diagnostic::error(self.peek().span, message).help(format!("write `{small}`"));
        self.report(diagnostic);
        Some(keyword)
    }

    /// Reads an `else if` written as one word, as if it were `if`; returns true if there is one.
    pub(super) fn is_else_if(&mut self) -> bool {
        let Some(written) = self.unknown_word() else { return false };
        let is_known = ["elseif", "elsif", "elif"].contains(&written.to_ascii_lowercase().as_str());
        if !is_known || self.kind_at(1) != TokenKind::LeftParen {
            return false;
        }
        let message = format!("`{written}` is not a C keyword");
        let diagnostic = Diagnostic::error(self.peek().span, message).help("write `else if`");
        self.report(diagnostic);
        true
    }

    /// Skips the `then` after a condition.
    pub(super) fn skip_then(&mut self) {
        if self.unknown_word().is_some_and(|word| word.eq_ignore_ascii_case("then")) {
            let span = self.next().span;
            let diagnostic = Diagnostic::error(span, "C has no `then`");
            self.report_foreign(
                Language::Basic,
                diagnostic.help("put the statements in `{ … }`; C has no `end if` either"),
            );
        }
    }

    /// A statement of another language, which is skipped; `None` if there is none.
    pub(super) fn foreign_statement(&mut self) -> Option<ParseResult<Statement>> {
        let start = self.peek().span;
        let written = self.unknown_word()?;
        let (language, message, help) = if is_block_end(written) && self.kind_at(1) != TokenKind::LeftParen {
            let message = format!("`{written}` is not a C keyword");
            (Language::Basic, message, "`}` ends what `{` began".to_owned())
        } else if written == "delete" && self.kind_at(1) != TokenKind::LeftParen {
            let message = "`delete` belongs to C++".to_owned();
            (Language::Cpp, message, "memory is not allocated, so it is not freed".to_owned())
        } else if foreign_words::is_g_code(written) && self.is_g_code_at(1) {
            let help = "`Move(0, 10);` moves axis 0; G-code is run by the PC, not by C programs";
            let message = "this is G-code, not C".to_owned();
            (Language::GCode, message, help.to_owned())
        } else {
            return None;
        };
        self.at += 1;
        while !self.peek().flags.has(Flags::LINE_START) && self.kind() != TokenKind::End {
            self.at += 1;
        }
        let span = self.span_since(start);
        self.report_foreign(language, Diagnostic::error(span, message).help(help));
        let error = Expression { kind: ExpressionKind::Error, span };
        Some(Ok(Statement { kind: StatementKind::Expression(error), span }))
    }

    /// Reports whether an otherwise undeclared word of G-code is at the token `ahead`.
    fn is_g_code_at(&self, ahead: usize) -> bool {
        self.name_at(ahead).is_some_and(|name| {
            self.scopes.meaning(name) == NameMeaning::Unknown && foreign_words::is_g_code(self.spelling(name))
        })
    }

    /// Skips a declaration of C++; `false` if the next one is not.
    pub(super) fn skip_foreign_declaration(&mut self) -> bool {
        let Some(written) = self.unknown_word() else { return false };
        let help = match written {
            "class" => "C has `struct` for data, and functions outside it",
            "using" | "namespace" => "leave it out: C has no namespaces",
            "template" => "C has no templates",
            _ => return false,
        };
        if !self.is_identifier_at(1) && self.kind_at(1) != TokenKind::Less {
            return false;
        }
        let diagnostic =
            Diagnostic::error(self.peek().span, format!("`{written}` belongs to C++")).help(help);
        self.report_foreign(Language::Cpp, diagnostic);
        if let Some(name) = self.name_at(1).filter(|name| !name.is_keyword()) {
            self.scopes.set_missing_type(name);
        }
        while !matches!(self.kind(), TokenKind::Semicolon | TokenKind::LeftBrace | TokenKind::End) {
            self.at += 1;
        }
        if self.kind() == TokenKind::LeftBrace {
            self.skip_braces();
        }
        self.eat(TokenKind::Semicolon);
        true
    }

    /// `new type[count]`, which is skipped.
    pub(super) fn foreign_operand(&mut self) -> Option<Expression> {
        if self.unknown_word() != Some("new") || self.kind_at(1) != TokenKind::Identifier {
            return None;
        }
        let start = self.next().span;
        let mut depth = 0_usize;
        loop {
            match self.kind() {
                TokenKind::LeftParen | TokenKind::LeftBracket => depth += 1,
                TokenKind::RightParen | TokenKind::RightBracket if depth > 0 => depth -= 1,
                TokenKind::RightParen | TokenKind::RightBracket | TokenKind::Comma if depth == 0 => break,
                TokenKind::Semicolon | TokenKind::LeftBrace | TokenKind::RightBrace | TokenKind::End => break,
                _ => {}
            }
            self.at += 1;
        }
        let span = self.span_since(start);
        let advice = foreign_words::word("new").map_or("", |word| word.advice);
        self.report_foreign(Language::Cpp, Diagnostic::error(span, "`new` belongs to C++").help(advice));
        Some(Expression { kind: ExpressionKind::Error, span })
    }

    /// The advice for a word at the position of an operator or a `)`.
    pub(super) fn operator_word(&self) -> Option<&'static str> {
        match self.unknown_word()? {
            written @ ("and" | "or" | "not") => foreign_words::word(written).map(|word| word.advice),
            "AND" => Some("write `&&`"),
            "OR" => Some("write `||`"),
            "mod" | "MOD" | "Mod" => Some("write `%`"),
            _ => None,
        }
    }
}

/// Reports whether a word ends a block in Basic and its relatives.
fn is_block_end(word: &str) -> bool {
    const ENDS: &[&str] = &["end", "endif", "endwhile", "endfor", "wend", "fi", "done"];
    ENDS.iter().any(|end| word.eq_ignore_ascii_case(end))
}
