//! Initialisers.

use crate::ast::{Designator, Initializer, InitializerItem};
use crate::pp::TokenKind;

use super::{ParseResult, Parser};

impl Parser<'_> {
    /// Parses an initialiser after `=`.
    pub(super) fn initializer(&mut self) -> ParseResult<Initializer> {
        if self.kind() != TokenKind::LeftBrace {
            return Ok(Initializer::Expression(self.assignment()?));
        }
        let start = self.peek().span;
        let items = self.nested(Self::initializer_list)?;
        Ok(Initializer::List { items, span: self.span_since(start) })
    }

    /// `{ … }`
    pub(super) fn initializer_list(&mut self) -> ParseResult<Vec<InitializerItem>> {
        self.open();
        let mut items = Vec::new();
        while self.kind() != TokenKind::RightBrace {
            let designators = self.designators()?;
            items.push(InitializerItem { designators, initializer: self.initializer()? });
            if self.eat(TokenKind::Comma).is_none() {
                break;
            }
        }
        self.close(TokenKind::RightBrace)?;
        Ok(items)
    }

    /// `.a[1] =`, `[1] =`, and the GNU forms `a:` and `[1]` without `=`.
    fn designators(&mut self) -> ParseResult<Vec<Designator>> {
        let mut designators = Vec::new();
        if self.is_identifier_at(0) && self.kind_at(1) == TokenKind::Colon {
            let token = self.next();
            self.at += 1;
            designators.push(Designator::Member(token.name, token.span));
            return Ok(designators);
        }
        self.designator_steps(&mut designators)?;
        let ends_in_index = matches!(designators.last(), Some(Designator::Index(_) | Designator::Range(..)));
        if !designators.is_empty() && self.eat(TokenKind::Assign).is_none() && !ends_in_index {
            return self.fail_expected("`=` after the designator");
        }
        Ok(designators)
    }

    /// Any number of `.a` and `[1]`.
    pub(super) fn designator_steps(&mut self, designators: &mut Vec<Designator>) -> ParseResult<()> {
        loop {
            match self.kind() {
                TokenKind::Dot => {
                    self.at += 1;
                    if !self.is_identifier_at(0) {
                        return self.fail_expected("the name of a member");
                    }
                    let token = self.next();
                    designators.push(Designator::Member(token.name, token.span));
                }
                TokenKind::LeftBracket => {
                    self.open();
                    let first = self.conditional()?;
                    let last = match self.eat(TokenKind::Ellipsis) {
                        Some(_) => Some(self.conditional()?),
                        None => None,
                    };
                    self.close(TokenKind::RightBracket)?;
                    designators.push(match last {
                        Some(last) => Designator::Range(first, last),
                        None => Designator::Index(first),
                    });
                }
                _ => return Ok(()),
            }
        }
    }
}
