//! Binary operators and their precedence.

use crate::operators::BinaryOperator;
use crate::pp::TokenKind;

/// An operator that comes between two operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Infix {
    /// `,`
    Comma,
    /// `=`
    Assign,
    /// `+=`
    AssignWith(BinaryOperator),
    /// `? … :`
    Conditional,
    /// `+`
    Binary(BinaryOperator),
}

/// The precedence of `,`, the lowest.
pub(super) const COMMA: u8 = 0;
/// The precedence of `=` and the other assignments.
pub(super) const ASSIGNMENT: u8 = 1;
/// The precedence of `?:`.
pub(super) const CONDITIONAL: u8 = 2;

/// The infix operator of a token, and its precedence; higher numbers bind tighter.
pub(super) fn infix(kind: TokenKind) -> Option<(Infix, u8)> {
    let other = match kind {
        TokenKind::Comma => Some((Infix::Comma, COMMA)),
        TokenKind::Assign => Some((Infix::Assign, ASSIGNMENT)),
        TokenKind::Question => Some((Infix::Conditional, CONDITIONAL)),
        _ => kind.compound_assignment().map(|operator| (Infix::AssignWith(operator), ASSIGNMENT)),
    };
    other.or_else(|| kind.binary_operator().map(|operator| (Infix::Binary(operator), operator.binding())))
}
