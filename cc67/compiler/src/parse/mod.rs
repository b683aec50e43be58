//! The parser: tokens in, syntax tree out.
//!
//! Recursive descent with precedence climbing, after the grammar of C11 with the GNU extensions that the vendor's
//! compiler has. It accepts implicit `int` wherever that compiler does. It only needs to know which names are types
//! ([`scopes`]).
//!
//! An error is reported where it is found and propagates as [`ErrorReported`] to the enclosing statement or declaration,
//! which continues after it ([`recover`]): one run shows all independent errors, and few others.

#![cfg_attr(
    not(test),
    deny(
        clippy::unwrap_used,
        clippy::expect_used,
        clippy::panic,
        clippy::indexing_slicing,
        clippy::as_conversions
    )
)]

mod builtins;
mod declarations;
mod declarators;
mod expressions;
mod foreign;
mod indentation;
mod initializers;
mod literals;
mod operators;
pub mod print;
mod records;
mod recover;
mod scopes;
mod specifiers;
mod statements;
#[cfg(test)]
mod tests;
mod unary;
mod unknown;

use std::collections::BTreeSet;

use crate::ast::TranslationUnit;
use crate::diag::{Diagnostic, Sink};
use crate::names::{Name, Names};
use crate::pp::{Flags, Token, TokenKind};
use crate::source::{SourceMap, Span};

use scopes::Scopes;

/// Parentheses, blocks, declarators and prefix operators within each other.
pub const NESTING: usize = 640;

/// Binary operators in a row; each nests the tree one level deeper to the left.
pub const CHAIN: usize = 30_000;

/// Binary operators that wait for their right operand; up to ten for each parenthesis.
const OPERATORS: usize = 3 * NESTING;

/// Parses preprocessed tokens; errors are reported to `sink`, and their code is left out of the tree.
#[must_use]
pub fn parse(tokens: &[Token], sources: &SourceMap, names: &Names, sink: &mut Sink) -> TranslationUnit {
    let end = match tokens.last() {
        Some(last) if last.kind == TokenKind::End => *last,
        _ => Token::new(TokenKind::End, Flags::LINE_START, Span::new(0, 0)),
    };
    let mut parser = Parser {
        tokens,
        at: 0,
        end,
        sources,
        names,
        sink,
        scopes: Scopes::default(),
        nesting: Nesting::default(),
        recovery: Recovery::default(),
        is_branch: false,
        has_function: false,
        tags: BTreeSet::new(),
    };
    // The preprocessor may already have found too many errors.
    if parser.sink.is_full() { TranslationUnit::default() } else { parser.translation_unit() }
}

/// Says that an error was reported and the construct could not be parsed.
#[derive(Debug)]
struct ErrorReported;

/// The result of a parsing function.
type ParseResult<T> = Result<T, ErrorReported>;

/// A parser at work.
struct Parser<'a> {
    tokens: &'a [Token],
    /// Index of the next token.
    at: usize,
    /// The token after the last one.
    end: Token,
    sources: &'a SourceMap,
    names: &'a Names,
    sink: &'a mut Sink,
    scopes: Scopes,
    nesting: Nesting,
    recovery: Recovery,
    /// True if the next or current block comes after `if (…)`.
    is_branch: bool,
    /// A function was defined.
    has_function: bool,
    /// The tags of structures, unions and enumerations.
    tags: BTreeSet<(Name, &'static str)>,
}

/// The nesting depth of the parser.
#[derive(Debug, Default)]
struct Nesting {
    /// Constructs within each other.
    constructs: usize,
    /// The number of binary operators whose right operands are being parsed.
    operators: usize,
}

/// The state for continuing after errors, and for reporting each mistake once.
#[derive(Debug, Default)]
struct Recovery {
    /// Brackets and braces that are open.
    open: Vec<Token>,
    /// True if the rest of the tokens is ignored, without errors about it.
    is_stopped: bool,
    /// True if a function begins before the `}` of the previous one: its blocks end here.
    is_unwinding: bool,
    /// A statement outside all functions was reported.
    has_loose_statement: bool,
    /// Other languages whose words were reported.
    foreign: foreign::ReportedLanguages,
}

impl Parser<'_> {
    /// The next token; `End` forever after the last one.
    fn peek(&self) -> Token {
        self.tokens.get(self.at).copied().unwrap_or(self.end)
    }

    /// The kind of the next token.
    fn kind(&self) -> TokenKind {
        self.kind_at(0)
    }

    /// The kind of the token `ahead` tokens after the next one.
    fn kind_at(&self, ahead: usize) -> TokenKind {
        self.tokens.get(self.at + ahead).map_or(TokenKind::End, |token| token.kind)
    }

    /// The name of the token `ahead` tokens after the next one, keyword or not.
    fn name_at(&self, ahead: usize) -> Option<Name> {
        self.tokens
            .get(self.at + ahead)
            .filter(|token| token.kind == TokenKind::Identifier)
            .map(|token| token.name)
    }

    /// The name of the next token, keyword or not.
    fn name(&self) -> Option<Name> {
        self.name_at(0)
    }

    /// Reports whether the token `ahead` is an identifier that is not a keyword.
    fn is_identifier_at(&self, ahead: usize) -> bool {
        self.name_at(ahead).is_some_and(|name| !name.is_keyword())
    }

    /// Reads the next token.
    fn next(&mut self) -> Token {
        let token = self.peek();
        self.at += usize::from(token.kind != TokenKind::End);
        token
    }

    /// Takes the next token if it is of this kind.
    fn eat(&mut self, kind: TokenKind) -> Option<Token> {
        (self.kind() == kind).then(|| self.next())
    }

    /// Takes the next token if it is this word.
    fn take_word(&mut self, word: Name) -> Option<Token> {
        (self.name() == Some(word)).then(|| self.next())
    }

    /// The span of the token read last.
    fn last_span(&self) -> Span {
        self.at.checked_sub(1).and_then(|at| self.tokens.get(at)).map_or(self.end.span, |token| token.span)
    }

    /// From `start` to the token read last.
    fn span_since(&self, start: Span) -> Span {
        start.to(self.last_span())
    }

    /// Reads an opening bracket that its partner must close.
    fn open(&mut self) -> Token {
        let token = self.next();
        self.recovery.open.push(token);
        token
    }

    /// Parses a construct one nesting level deeper.
    fn nested<T>(&mut self, parse: impl FnOnce(&mut Self) -> ParseResult<T>) -> ParseResult<T> {
        if self.nesting.constructs >= NESTING {
            return Err(self.too_deep());
        }
        self.nesting.constructs += 1;
        let result = parse(self);
        self.nesting.constructs -= 1;
        result
    }

    #[inline(never)]
    fn too_deep(&mut self) -> ErrorReported {
        self.limit_exceeded(format!("nested deeper than {NESTING} levels"))
    }

    #[inline(never)]
    fn too_long(&mut self) -> ErrorReported {
        self.limit_exceeded(format!("more than {CHAIN} operators in a row"))
    }

    fn limit_exceeded(&mut self, message: String) -> ErrorReported {
        let span = self.peek().span;
        self.report(Diagnostic::error(span, message).note("the rest of the program was not read"));
        self.stop()
    }

    fn spelling(&self, name: Name) -> &str {
        self.names.get(name)
    }
}
