//! The operators between two operands, and how tight they bind.

use crate::ast::{BinaryOperator, for_each_binary_operator};
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
    let other = match kind {
        TokenKind::Comma => Some((Infix::Comma, COMMA)),
        TokenKind::Assign => Some((Infix::Assign, ASSIGNMENT)),
        TokenKind::Question => Some((Infix::Conditional, CONDITIONAL)),
        _ => compound_assignment(kind).map(|operator| (Infix::AssignWith(operator), ASSIGNMENT)),
    };
    other.or_else(|| binary(kind).map(|(operator, binding)| (Infix::Binary(operator), binding)))
}

macro_rules! define_tokens {
    ($(
        $operator:ident $text:literal = $token:ident $binding:literal $(, $assignment:ident)? => $class:ident($of:expr);
    )*) => {
        /// The binary operator of a token, and how tight it binds.
        fn binary(kind: TokenKind) -> Option<(BinaryOperator, u8)> {
            match kind {
                $(TokenKind::$token => Some((BinaryOperator::$operator, $binding)),)*
                _ => None,
            }
        }

        /// The operator of a compound assignment.
        pub(super) fn compound_assignment(kind: TokenKind) -> Option<BinaryOperator> {
            match kind {
                $($(TokenKind::$assignment => Some(BinaryOperator::$operator),)?)*
                _ => None,
            }
        }
    };
}

for_each_binary_operator!(define_tokens);
