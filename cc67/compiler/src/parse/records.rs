//! `struct`, `union` and `enum`.

use crate::ast::{
    EnumSpecifier, Enumerator, MemberDeclaration, MemberDeclarator, RecordKind, RecordSpecifier,
    TypeSpecifier,
};
use crate::names::{Name, word};
use crate::pp::TokenKind;
use crate::source::Span;

use super::declarators::NameRule;
use super::scopes::NameMeaning;
use super::{ParseResult, Parser};

impl Parser<'_> {
    /// `struct tag { … }`, at the keyword.
    pub(super) fn record(&mut self) -> ParseResult<RecordSpecifier> {
        let keyword = self.next();
        let kind = if keyword.name == word::STRUCT { RecordKind::Struct } else { RecordKind::Union };
        let mut alignments = self.attributes()?;
        let keyword_text = if kind == RecordKind::Struct { "struct" } else { "union" };
        let tag = self.tag(keyword_text);
        let members = if self.kind() == TokenKind::LeftBrace {
            Some(self.nested(Self::members)?)
        } else if tag.is_some() {
            None
        } else {
            return self.fail_expected("a tag or `{`");
        };
        alignments.extend(self.attributes()?);
        Ok(RecordSpecifier { kind, tag, members, alignments, span: self.span_since(keyword.span) })
    }

    /// `enum tag { … }`, at the keyword.
    pub(super) fn enumeration(&mut self) -> ParseResult<EnumSpecifier> {
        let keyword = self.next();
        self.attributes()?;
        let tag = self.tag("enum");
        let enumerators = if self.kind() == TokenKind::LeftBrace {
            Some(self.enumerators()?)
        } else if tag.is_some() {
            None
        } else {
            return self.fail_expected("a tag or `{`");
        };
        self.attributes()?;
        Ok(EnumSpecifier { tag, enumerators, span: self.span_since(keyword.span) })
    }

    fn tag(&mut self, keyword: &'static str) -> Option<(Name, Span)> {
        let token = self.is_identifier_at(0).then(|| self.next())?;
        self.tags.insert((token.name, keyword));
        Some((token.name, token.span))
    }

    fn members(&mut self) -> ParseResult<Vec<MemberDeclaration>> {
        self.open();
        let mut members = Vec::new();
        while !matches!(self.kind(), TokenKind::RightBrace | TokenKind::End) {
            if self.eat(TokenKind::Semicolon).is_some() {
                continue;
            }
            let (start, open) = (self.at, self.recovery.open.len());
            match self.member_line() {
                Ok(Some(line)) => members.push(line),
                Ok(None) => {}
                Err(_) => {
                    self.skip_statement(open);
                    if self.at == start {
                        self.at += 1;
                    }
                }
            }
        }
        self.close(TokenKind::RightBrace)?;
        Ok(members)
    }

    /// `int a, b : 3;`; nothing for an assertion.
    fn member_line(&mut self) -> ParseResult<Option<MemberDeclaration>> {
        if self.name() == Some(word::STATIC_ASSERT) {
            self.static_assert()?;
            return Ok(None);
        }
        let start = self.peek().span;
        let mut specifiers = self.specifiers()?;
        if specifiers.ty.is_none() && self.is_unknown_type() {
            self.unknown_type(&mut specifiers);
        }
        let mut members = Vec::with_capacity(1);
        let is_alone = matches!(specifiers.ty, Some(TypeSpecifier::Record(_) | TypeSpecifier::Enum(_)));
        if !(is_alone && self.kind() == TokenKind::Semicolon) {
            loop {
                members.push(self.member()?);
                if self.eat(TokenKind::Comma).is_none() {
                    break;
                }
            }
        }
        let span = self.span_since(start);
        self.semicolon(span)?;
        Ok(Some(MemberDeclaration { specifiers, members, span }))
    }

    fn member(&mut self) -> ParseResult<MemberDeclarator> {
        let declarator =
            if self.kind() == TokenKind::Colon { None } else { Some(self.declarator(NameRule::Required)?) };
        let width = match self.eat(TokenKind::Colon) {
            Some(_) => Some(self.conditional()?),
            None => None,
        };
        self.attributes()?;
        Ok(MemberDeclarator { declarator, width })
    }

    fn enumerators(&mut self) -> ParseResult<Vec<Enumerator>> {
        self.open();
        let mut enumerators = Vec::new();
        while self.kind() != TokenKind::RightBrace {
            if !self.is_identifier_at(0) {
                return self.fail_expected("the name of an enumerator");
            }
            let token = self.next();
            self.attributes()?;
            let value = match self.eat(TokenKind::Assign) {
                Some(_) => Some(self.conditional()?),
                None => None,
            };
            self.scopes.declare(token.name, NameMeaning::Ordinary);
            enumerators.push(Enumerator { name: token.name, span: token.span, value });
            if self.eat(TokenKind::Comma).is_none() {
                break;
            }
        }
        self.close(TokenKind::RightBrace)?;
        Ok(enumerators)
    }
}
