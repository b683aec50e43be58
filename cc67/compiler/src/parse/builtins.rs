//! Constructs that look like calls but take types, or access the arguments of the function.
//!
//! Those without underscores have the meaning of the C library, unless the program declares the name itself.

use crate::ast::{Designator, Expression, ExpressionKind};
use crate::diag::Diagnostic;
use crate::names::{Name, word};
use crate::pp::{Token, TokenKind};

use super::scopes::NameMeaning;
use super::{ParseResult, Parser};

impl Parser<'_> {
    /// Reads a built-in construct if `token`, the next one, begins one.
    pub(super) fn builtin(&mut self, token: Token) -> Option<ParseResult<Expression>> {
        let parse = match token.name {
            word::BUILTIN_VA_START | word::VA_START => Self::va_start,
            word::BUILTIN_VA_ARG | word::VA_ARG => Self::va_arg,
            word::BUILTIN_VA_END | word::VA_END => Self::va_end,
            word::BUILTIN_VA_COPY | word::VA_COPY => Self::va_copy,
            word::BUILTIN_OFFSETOF | word::OFFSETOF => Self::offsetof,
            word::GENERIC => Self::generic_selection,
            _ => return None,
        };
        if !self.is_builtin(token.name) {
            return None;
        }
        Some(self.nested(|parser| {
            parser.at += 1;
            parser.open();
            let kind = parse(parser)?;
            parser.close(TokenKind::RightParen)?;
            Ok(Expression { kind, span: parser.span_since(token.span) })
        }))
    }

    /// `asm`, in any of its places.
    pub(super) fn assembler(&mut self) -> ParseResult<()> {
        let span = self.peek().span;
        self.fail(
            Diagnostic::error(span, "inline assembly is not supported")
                .note("programs are compiled to bytecode, not to instructions of the DSP"),
        )
    }

    fn is_builtin(&self, name: Name) -> bool {
        self.kind_at(1) == TokenKind::LeftParen
            && (name.is_keyword() || self.scopes.meaning(name) == NameMeaning::Unknown)
    }

    fn va_start(&mut self) -> ParseResult<ExpressionKind> {
        let list = self.assignment()?;
        self.expect(TokenKind::Comma, "and the last named parameter")?;
        let last = self.assignment()?;
        Ok(ExpressionKind::VaStart(Box::new(list), Box::new(last)))
    }

    fn va_arg(&mut self) -> ParseResult<ExpressionKind> {
        let list = self.assignment()?;
        self.expect(TokenKind::Comma, "and a type")?;
        let ty = self.type_name()?;
        Ok(ExpressionKind::VaArg(Box::new(list), Box::new(ty)))
    }

    fn va_end(&mut self) -> ParseResult<ExpressionKind> {
        Ok(ExpressionKind::VaEnd(Box::new(self.assignment()?)))
    }

    fn va_copy(&mut self) -> ParseResult<ExpressionKind> {
        let to = self.assignment()?;
        self.expect(TokenKind::Comma, "and the list to copy")?;
        let from = self.assignment()?;
        Ok(ExpressionKind::VaCopy(Box::new(to), Box::new(from)))
    }

    fn offsetof(&mut self) -> ParseResult<ExpressionKind> {
        let ty = self.type_name()?;
        self.expect(TokenKind::Comma, "and a member")?;
        if !self.is_identifier_at(0) {
            return self.fail_expected("the name of a member");
        }
        let member = self.next();
        let mut path = vec![Designator::Member(member.name, member.span)];
        self.designator_steps(&mut path)?;
        Ok(ExpressionKind::Offsetof(Box::new(ty), path))
    }

    fn generic_selection(&mut self) -> ParseResult<ExpressionKind> {
        let value = Box::new(self.assignment()?);
        let mut choices = Vec::new();
        while self.eat(TokenKind::Comma).is_some() {
            let ty = match self.take_word(word::DEFAULT) {
                Some(_) => None,
                None => Some(self.type_name()?),
            };
            self.expect(TokenKind::Colon, "after the type")?;
            choices.push((ty, self.assignment()?));
        }
        Ok(ExpressionKind::Generic { value, choices })
    }
}
