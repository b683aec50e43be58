//! `if (a == 1) … else if (a == 1) …`: the second body is never executed.

use crate::ast::{Expression, ExpressionKind, Statement, StatementKind};
use crate::diag::{Diagnostic, Lint};

/// Levels of an expression that are compared.
const DEEPEST: u32 = 20;

/// The message for a later condition of an `else if` chain that equals the first one.
pub(crate) fn finding(first: &Expression, mut otherwise: Option<&Statement>) -> Option<Diagnostic> {
    while let Some(StatementKind::If { condition, otherwise: next, .. }) =
        otherwise.map(|statement| &statement.kind)
    {
        if is_same(first, condition, DEEPEST) {
            return Some(
                Diagnostic::warning(
                    Lint::DuplicatedCondition,
                    condition.span,
                    "this condition was tested before",
                )
                .at("true only where the earlier one is, too")
                .label(first.span, "here"),
            );
        }
        otherwise = next.as_deref();
    }
    None
}

/// Reports whether two expressions are the same; it knows the kinds that usually occur in conditions.
fn is_same(a: &Expression, b: &Expression, depth: u32) -> bool {
    let Some(depth) = depth.checked_sub(1) else { return false };
    let is_pair =
        |x: &[&Expression; 2], y: &[&Expression; 2]| is_same(x[0], y[0], depth) && is_same(x[1], y[1], depth);
    match (&a.kind, &b.kind) {
        (ExpressionKind::Identifier(x), ExpressionKind::Identifier(y)) => x == y,
        (ExpressionKind::Integer(x), ExpressionKind::Integer(y)) => x == y,
        (ExpressionKind::Floating(x), ExpressionKind::Floating(y)) => x == y,
        (ExpressionKind::Character(x, _), ExpressionKind::Character(y, _)) => x == y,
        (ExpressionKind::Index(x, i), ExpressionKind::Index(y, k)) => is_pair(&[x, i], &[y, k]),
        (
            ExpressionKind::Member { base: x, member: m, .. },
            ExpressionKind::Member { base: y, member: n, .. },
        ) => m == n && is_same(x, y, depth),
        (ExpressionKind::Unary(p, x), ExpressionKind::Unary(q, y)) => p == q && is_same(x, y, depth),
        (ExpressionKind::Binary(p, x, i), ExpressionKind::Binary(q, y, k)) => {
            p == q && is_pair(&[x, i], &[y, k])
        }
        (ExpressionKind::Call(f, x), ExpressionKind::Call(g, y)) => {
            is_same(f, g, depth) && x.len() == y.len() && x.iter().zip(y).all(|(x, y)| is_same(x, y, depth))
        }
        _ => false,
    }
}
