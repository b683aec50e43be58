//! `if (a = b)`; the form `if ((a = b))` shows that it is intended.

use crate::ast::{Expression, ExpressionKind, UnaryOperator};
use crate::diag::{Diagnostic, Lint};
use crate::operators::OperatorMeaning;

/// The message for a condition that is an assignment.
pub(crate) fn finding(condition: &Expression) -> Option<Diagnostic> {
    let ExpressionKind::Assign(to, from) = &condition.kind else { return None };
    // The span of a parenthesised expression holds its parentheses.
    if condition.span.lo != to.span.lo {
        return None;
    }
    let diagnostic = Diagnostic::warning(
        Lint::AssignmentCondition,
        condition.span,
        "an assignment is used as a condition",
    )
    .help(match &from.kind {
        // `a =! b`
        ExpressionKind::Unary(UnaryOperator::Not, _) => {
            "write `!=` or `==` to compare, or a second pair of parentheses if this is meant"
        }
        _ => "write `==` to compare, or a second pair of parentheses if this is meant",
    });
    Some(match &from.kind {
        ExpressionKind::Binary(operator, ..) if matches!(operator.meaning(), OperatorMeaning::Compare(_)) => {
            diagnostic.note(format!("`{}` is computed first: its result is assigned", operator.spelling()))
        }
        _ => diagnostic,
    })
}
