//! Statements that compute a value and drop it.

use crate::ast::{Expression, ExpressionKind, UnaryOperator};
use crate::diag::{Diagnostic, Lint};
use crate::operators::BinaryOperator;

/// The message for an expression statement whose value is not used; `is_function` if it only names one.
pub(crate) fn finding(expression: &Expression, is_function: bool) -> Option<Diagnostic> {
    if has_effect(expression) {
        return None;
    }
    let diagnostic = Diagnostic::warning(Lint::UnusedValue, expression.span, "this statement has no effect");
    Some(match &expression.kind {
        ExpressionKind::Binary(BinaryOperator::Equal, ..) => diagnostic.help("`=` assigns, `==` compares"),
        ExpressionKind::Identifier(_) if is_function => {
            diagnostic.help("write `()` after the name to call the function")
        }
        _ => diagnostic.at("the value is dropped"),
    })
}

/// Reports whether evaluating an expression has an effect, judged by its form.
fn has_effect(expression: &Expression) -> bool {
    match &expression.kind {
        ExpressionKind::Call(..)
        | ExpressionKind::Assign(..)
        | ExpressionKind::AssignWith(..)
        | ExpressionKind::Increment { .. }
        | ExpressionKind::VaStart(..)
        | ExpressionKind::VaArg(..)
        | ExpressionKind::VaEnd(_)
        | ExpressionKind::VaCopy(..)
        | ExpressionKind::StatementExpression(_)
        | ExpressionKind::Error => true,
        ExpressionKind::Comma(_, last) | ExpressionKind::Member { base: last, .. } => has_effect(last),
        ExpressionKind::Binary(BinaryOperator::LogicalAnd | BinaryOperator::LogicalOr, _, last) => {
            has_effect(last)
        }
        ExpressionKind::Conditional { then, otherwise, .. } => {
            then.as_deref().is_some_and(has_effect) || has_effect(otherwise)
        }
        // `*p++;` is how some people write `p++;`.
        ExpressionKind::Cast(_, inner) | ExpressionKind::Unary(UnaryOperator::Dereference, inner) => {
            has_effect(inner)
        }
        _ => false,
    }
}
