//! The operators between two operands, and how tight they bind.

use crate::ast::BinaryOperator;
use crate::pp::TokenKind;

/// An operator after an operand, with another operand after it.
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

/// The binding of `,`, the loosest.
pub(super) const COMMA: u8 = 0;
/// The binding of `=` and its kin.
pub(super) const ASSIGNMENT: u8 = 1;
/// The binding of `?:`.
pub(super) const CONDITIONAL: u8 = 2;

/// The infix operator that a token is, and how tight it binds; larger is tighter.
pub(super) fn infix(kind: TokenKind) -> Option<(Infix, u8)> {
    use BinaryOperator::{
        Add, And, Divide, Equal, Greater, GreaterEqual, Less, LessEqual, LogicalAnd, LogicalOr, Multiply,
        NotEqual, Or, Remainder, ShiftLeft, ShiftRight, Subtract, Xor,
    };
    let (operator, binding) = match kind {
        TokenKind::OrOr => (LogicalOr, 3),
        TokenKind::AndAnd => (LogicalAnd, 4),
        TokenKind::Or => (Or, 5),
        TokenKind::Xor => (Xor, 6),
        TokenKind::And => (And, 7),
        TokenKind::Equal => (Equal, 8),
        TokenKind::NotEqual => (NotEqual, 8),
        TokenKind::Less => (Less, 9),
        TokenKind::Greater => (Greater, 9),
        TokenKind::LessEqual => (LessEqual, 9),
        TokenKind::GreaterEqual => (GreaterEqual, 9),
        TokenKind::ShiftLeft => (ShiftLeft, 10),
        TokenKind::ShiftRight => (ShiftRight, 10),
        TokenKind::Plus => (Add, 11),
        TokenKind::Minus => (Subtract, 11),
        TokenKind::Star => (Multiply, 12),
        TokenKind::Slash => (Divide, 12),
        TokenKind::Percent => (Remainder, 12),
        TokenKind::Comma => return Some((Infix::Comma, COMMA)),
        TokenKind::Assign => return Some((Infix::Assign, ASSIGNMENT)),
        TokenKind::Question => return Some((Infix::Conditional, CONDITIONAL)),
        _ => return compound_assignment(kind).map(|operator| (Infix::AssignWith(operator), ASSIGNMENT)),
    };
    Some((Infix::Binary(operator), binding))
}

/// The operator of a compound assignment.
pub(super) fn compound_assignment(kind: TokenKind) -> Option<BinaryOperator> {
    Some(match kind {
        TokenKind::StarAssign => BinaryOperator::Multiply,
        TokenKind::SlashAssign => BinaryOperator::Divide,
        TokenKind::PercentAssign => BinaryOperator::Remainder,
        TokenKind::PlusAssign => BinaryOperator::Add,
        TokenKind::MinusAssign => BinaryOperator::Subtract,
        TokenKind::ShiftLeftAssign => BinaryOperator::ShiftLeft,
        TokenKind::ShiftRightAssign => BinaryOperator::ShiftRight,
        TokenKind::AndAssign => BinaryOperator::And,
        TokenKind::XorAssign => BinaryOperator::Xor,
        TokenKind::OrAssign => BinaryOperator::Or,
        _ => return None,
    })
}
