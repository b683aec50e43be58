//! Operands: prefix operators, casts, calls, members, and primary expressions.

use crate::ast::{Expression, ExpressionKind, UnaryOperator};
use crate::diag::Diagnostic;
use crate::names::word;
use crate::pp::{Flags, Token, TokenKind};

use super::{NESTING, ParseResult, Parser};

impl Parser<'_> {
    /// An operand with its prefix and postfix operators.
    pub(super) fn unary(&mut self) -> ParseResult<Expression> {
        let operand = match self.kind() {
            TokenKind::LeftParen if self.is_type_at(1) => return self.cast(),
            TokenKind::LeftParen if self.kind_at(1) != TokenKind::LeftBrace => self.parenthesized()?,
            TokenKind::And
            | TokenKind::Star
            | TokenKind::Plus
            | TokenKind::Minus
            | TokenKind::Tilde
            | TokenKind::Not => return self.prefix(),
            TokenKind::PlusPlus | TokenKind::MinusMinus => return self.prefix_increment(),
            TokenKind::AndAnd => return self.label_address(),
            _ => match self.name() {
                Some(word::SIZEOF) => return self.sizeof(),
                Some(word::ALIGNOF | word::ALIGNOF_ | word::ALIGNOF__) => return self.alignof(),
                Some(word::EXTENSION) => {
                    self.at += 1;
                    return self.nested(Self::unary);
                }
                _ => self.primary()?,
            },
        };
        if is_postfix(self.kind()) { self.postfix(operand) } else { Ok(operand) }
    }

    /// `(expression)`
    fn parenthesized(&mut self) -> ParseResult<Expression> {
        let open = self.open().span;
        let mut inner = self.nested(Self::expression)?;
        self.close(TokenKind::RightParen)?;
        inner.span = self.span_since(open);
        Ok(inner)
    }

    /// A prefix operator with its operand.
    #[inline(never)]
    fn prefix(&mut self) -> ParseResult<Expression> {
        let token = self.next();
        let operator = match token.kind {
            TokenKind::And => UnaryOperator::AddressOf,
            TokenKind::Star => UnaryOperator::Dereference,
            TokenKind::Plus => UnaryOperator::Plus,
            TokenKind::Minus => UnaryOperator::Minus,
            TokenKind::Tilde => UnaryOperator::Complement,
            _ => UnaryOperator::Not,
        };
        let operand = self.nested(Self::unary)?;
        let span = token.span.to(operand.span);
        Ok(Expression { kind: ExpressionKind::Unary(operator, Box::new(operand)), span })
    }

    /// Reports whether a type begins at the token `ahead`.
    pub(super) fn is_type_at(&self, ahead: usize) -> bool {
        self.name_at(ahead).is_some_and(|name| self.is_type_word(name))
    }

    #[inline(never)]
    fn prefix_increment(&mut self) -> ParseResult<Expression> {
        let token = self.next();
        let operand = Box::new(self.nested(Self::unary)?);
        let span = token.span.to(operand.span);
        let is_increment = token.kind == TokenKind::PlusPlus;
        Ok(Expression { kind: ExpressionKind::Increment { operand, is_increment, is_prefix: true }, span })
    }

    /// `&&label`
    #[inline(never)]
    fn label_address(&mut self) -> ParseResult<Expression> {
        let token = self.next();
        if self.is_identifier_at(0) {
            let label = self.next();
            let kind = ExpressionKind::LabelAddress(label.name, label.span);
            return Ok(Expression { kind, span: token.span.to(label.span) });
        }
        self.fail(
            Diagnostic::error(token.span, "`&&` before an operand needs a label")
                .note("`&&` takes the address of a label, `&` that of an object"),
        )
    }

    /// `(type) operand` or `(type) { … }`
    #[inline(never)]
    fn cast(&mut self) -> ParseResult<Expression> {
        let open = self.open();
        let ty = Box::new(self.type_name()?);
        self.close(TokenKind::RightParen)?;
        if self.kind() == TokenKind::LeftBrace {
            let items = self.nested(Self::initializer_list)?;
            let span = self.span_since(open.span);
            let literal = Expression { kind: ExpressionKind::CompoundLiteral(ty, items), span };
            return self.postfix(literal);
        }
        let operand = Box::new(self.nested(Self::unary)?);
        let span = open.span.to(operand.span);
        Ok(Expression { kind: ExpressionKind::Cast(ty, operand), span })
    }

    #[inline(never)]
    fn sizeof(&mut self) -> ParseResult<Expression> {
        let token = self.next();
        if self.kind() == TokenKind::LeftParen && self.is_type_at(1) {
            let open = self.open();
            let ty = Box::new(self.type_name()?);
            self.close(TokenKind::RightParen)?;
            if self.kind() == TokenKind::LeftBrace {
                let items = self.nested(Self::initializer_list)?;
                let span = self.span_since(open.span);
                let literal = Expression { kind: ExpressionKind::CompoundLiteral(ty, items), span };
                let operand = Box::new(self.postfix(literal)?);
                let span = self.span_since(token.span);
                return Ok(Expression { kind: ExpressionKind::SizeofExpression(operand), span });
            }
            let span = self.span_since(token.span);
            return Ok(Expression { kind: ExpressionKind::SizeofType(ty), span });
        }
        let operand = Box::new(self.nested(Self::unary)?);
        let span = self.span_since(token.span);
        Ok(Expression { kind: ExpressionKind::SizeofExpression(operand), span })
    }

    /// `_Alignof (type)`; the GNU form also takes an expression.
    #[inline(never)]
    fn alignof(&mut self) -> ParseResult<Expression> {
        let token = self.next();
        if self.kind() != TokenKind::LeftParen || !self.is_type_at(1) {
            let operand = Box::new(self.nested(Self::unary)?);
            let span = self.span_since(token.span);
            return Ok(Expression { kind: ExpressionKind::AlignofExpression(operand), span });
        }
        self.open();
        let ty = Box::new(self.type_name()?);
        self.close(TokenKind::RightParen)?;
        Ok(Expression { kind: ExpressionKind::AlignofType(ty), span: self.span_since(token.span) })
    }

    /// Parses the postfix operators after an operand.
    #[inline(never)]
    fn postfix(&mut self, mut operand: Expression) -> ParseResult<Expression> {
        let mut count = 0;
        loop {
            count += 1;
            if count > NESTING {
                return Err(self.too_deep());
            }
            let start = operand.span;
            let kind = match self.kind() {
                TokenKind::LeftBracket => {
                    self.open();
                    let index = self.nested(Self::expression)?;
                    self.close(TokenKind::RightBracket)?;
                    ExpressionKind::Index(Box::new(operand), Box::new(index))
                }
                TokenKind::LeftParen => {
                    let arguments = self.nested(Self::arguments)?;
                    ExpressionKind::Call(Box::new(operand), arguments)
                }
                TokenKind::Dot | TokenKind::Arrow => {
                    let arrow = self.next().kind == TokenKind::Arrow;
                    if !self.is_identifier_at(0) {
                        return self.fail_expected("the name of a member");
                    }
                    let member = self.next();
                    let (member, member_span) = (member.name, member.span);
                    ExpressionKind::Member { base: Box::new(operand), arrow, member, member_span }
                }
                TokenKind::PlusPlus | TokenKind::MinusMinus => {
                    let is_increment = self.next().kind == TokenKind::PlusPlus;
                    ExpressionKind::Increment { operand: Box::new(operand), is_increment, is_prefix: false }
                }
                _ => return Ok(operand),
            };
            operand = Expression { kind, span: self.span_since(start) };
        }
    }

    /// `(a, b)`
    fn arguments(&mut self) -> ParseResult<Vec<Expression>> {
        self.open();
        let mut arguments = Vec::new();
        if self.kind() != TokenKind::RightParen {
            loop {
                arguments.push(self.assignment()?);
                if self.eat(TokenKind::Comma).is_none() && !self.lacks_comma() {
                    break;
                }
            }
        }
        self.close(TokenKind::RightParen)?;
        Ok(arguments)
    }

    /// Reports an argument on the same line without a `,` before it; returns true if there is one.
    fn lacks_comma(&mut self) -> bool {
        let token = self.peek();
        let begins_operand =
            matches!(token.kind, TokenKind::Number | TokenKind::String | TokenKind::Character)
                || self.is_identifier_at(0) && self.operator_word().is_none();
        if !begins_operand || token.flags.has(Flags::LINE_START) || token.flags.has(Flags::BROKEN) {
            return false;
        }
        let found = self.describe(token);
        let place = self.end_of_last();
        let diagnostic = Diagnostic::error(place, "expected `,` between two arguments");
        self.report(diagnostic.at(format!("before {found}")));
        true
    }

    /// A constant, a name, or a statement expression.
    #[inline(never)]
    fn primary(&mut self) -> ParseResult<Expression> {
        match self.kind() {
            TokenKind::Identifier => self.identifier(),
            TokenKind::Number => {
                let token = self.next();
                Ok(self.number(token))
            }
            TokenKind::Character => {
                let token = self.next();
                Ok(self.character(token))
            }
            TokenKind::String => Ok(self.string()),
            TokenKind::LeftParen => self.statement_expression(),
            _ => self.fail_expected("an expression"),
        }
    }

    fn identifier(&mut self) -> ParseResult<Expression> {
        let token = self.peek();
        if let Some(builtin) = self.builtin(token) {
            return builtin;
        }
        if let Some(operand) = self.foreign_operand() {
            return Ok(operand);
        }
        let kind = match token.name {
            word::FUNC | word::FUNCTION => ExpressionKind::FunctionName,
            word::ASM | word::ASM_ | word::ASM__ => {
                self.assembler()?;
                ExpressionKind::Error
            }
            name if name.is_keyword() => return self.keyword_as_operand(token),
            name => ExpressionKind::Identifier(name),
        };
        self.at += 1;
        Ok(Expression { kind, span: token.span })
    }

    fn keyword_as_operand(&mut self, token: Token) -> ParseResult<Expression> {
        let spelling = self.spelling(token.name).to_owned();
        let diagnostic = Diagnostic::error(token.span, format!("expected an expression, found `{spelling}`"));
        self.fail(if self.is_declaration_word(token.name) {
            diagnostic.note(format!("`{spelling}` belongs to a declaration; a cast has it in parentheses"))
        } else {
            diagnostic.note(format!("`{spelling}` is a keyword"))
        })
    }

    /// `({ … })`
    fn statement_expression(&mut self) -> ParseResult<Expression> {
        let open = self.open();
        let statements = self.nested(Self::block)?;
        self.close(TokenKind::RightParen)?;
        Ok(Expression {
            kind: ExpressionKind::StatementExpression(statements),
            span: self.span_since(open.span),
        })
    }
}

/// Reports whether a token continues an operand.
fn is_postfix(kind: TokenKind) -> bool {
    matches!(
        kind,
        TokenKind::LeftBracket
            | TokenKind::LeftParen
            | TokenKind::Dot
            | TokenKind::Arrow
            | TokenKind::PlusPlus
            | TokenKind::MinusMinus
    )
}
