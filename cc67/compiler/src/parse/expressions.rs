//! Expressions: operands with operators between them, by precedence climbing.
//!
//! Parentheses only nest through [`Parser::infix`] and [`Parser::unary`]. Rare cases are in separate functions, so that
//! the stack frames of these two stay small.

use crate::ast::{Expression, ExpressionKind};
use crate::pp::TokenKind;

use super::operators::{ASSIGNMENT, COMMA, CONDITIONAL, Infix, infix};
use super::{CHAIN, OPERATORS, ParseResult, Parser};

impl Parser<'_> {
    /// `a, b` and everything that binds tighter.
    pub(super) fn expression(&mut self) -> ParseResult<Expression> {
        self.infix(COMMA)
    }

    /// `a = b` and everything that binds tighter.
    pub(super) fn assignment(&mut self) -> ParseResult<Expression> {
        self.infix(ASSIGNMENT)
    }

    /// `a ? b : c` and everything that binds tighter, called a constant expression in the grammar.
    pub(super) fn conditional(&mut self) -> ParseResult<Expression> {
        self.infix(CONDITIONAL)
    }

    /// Operands with operators of at least the precedence `least`.
    fn infix(&mut self, least: u8) -> ParseResult<Expression> {
        let mut left = self.unary()?;
        let mut count = 0;
        while let Some((operator, binding)) = infix(self.kind())
            && binding >= least
        {
            self.at += 1;
            count += 1;
            if count > CHAIN {
                return Err(self.too_long());
            }
            left = match operator {
                Infix::Conditional => self.branches(left)?,
                Infix::Assign | Infix::AssignWith(_) => self.assignment_rest(operator, left)?,
                Infix::Comma | Infix::Binary(_) => {
                    let right = self.right_operand(binding)?;
                    combine(operator, left, right)
                }
            };
        }
        Ok(left)
    }

    /// The operand after a left-associative operator.
    fn right_operand(&mut self, binding: u8) -> ParseResult<Expression> {
        if self.nesting.operators >= OPERATORS {
            return Err(self.too_deep());
        }
        self.nesting.operators += 1;
        let right = self.infix(binding + 1);
        self.nesting.operators -= 1;
        right
    }

    /// The right side of an assignment, which is right-associative.
    #[inline(never)]
    fn assignment_rest(&mut self, operator: Infix, left: Expression) -> ParseResult<Expression> {
        let right = self.nested(Self::assignment)?;
        Ok(combine(operator, left, right))
    }

    /// Parses the branches after `condition ?`; the middle operand may be missing.
    #[inline(never)]
    fn branches(&mut self, condition: Expression) -> ParseResult<Expression> {
        let then = match self.kind() {
            TokenKind::Colon => None,
            _ => Some(Box::new(self.nested(Self::expression)?)),
        };
        self.expect(TokenKind::Colon, "of the conditional expression")?;
        let otherwise = Box::new(self.nested(Self::conditional)?);
        let span = condition.span.to(otherwise.span);
        Ok(Expression {
            kind: ExpressionKind::Conditional { condition: Box::new(condition), then, otherwise },
            span,
        })
    }
}

#[inline(never)]
fn combine(operator: Infix, left: Expression, right: Expression) -> Expression {
    let span = left.span.to(right.span);
    let (left, right) = (Box::new(left), Box::new(right));
    let kind = match operator {
        Infix::Comma => ExpressionKind::Comma(left, right),
        Infix::Assign => ExpressionKind::Assign(left, right),
        Infix::AssignWith(operator) => ExpressionKind::AssignWith(operator, left, right),
        Infix::Binary(operator) => ExpressionKind::Binary(operator, left, right),
        // `branches` has three operands.
        Infix::Conditional => ExpressionKind::Error,
    };
    Expression { kind, span }
}
