//! `x =- 1`, where `x -= 1` is probably meant.

use crate::ast::{Expression, ExpressionKind, UnaryOperator};
use crate::diag::{Diagnostic, Lint};
use crate::source::{ExpansionId, SourceMap};

/// The message for an assignment of `from` with a sign next to the `=` and apart from its operand.
pub(crate) fn finding(sources: &SourceMap, from: &Expression) -> Option<Diagnostic> {
    let ExpressionKind::Unary(operator, operand) = &from.kind else { return None };
    let sign = match operator {
        UnaryOperator::Minus => '-',
        UnaryOperator::Plus => '+',
        UnaryOperator::AddressOf
        | UnaryOperator::Dereference
        | UnaryOperator::Complement
        | UnaryOperator::Not => return None,
    };
    let is_written = [from.span, operand.span].iter().all(|span| span.expansion == ExpansionId::NONE);
    let is_apart = operand.span.lo > from.span.lo + 1;
    if !is_written || !is_apart || sources.byte_before(from.span) != Some(b'=') {
        return None;
    }
    Some(
        Diagnostic::warning(
            Lint::ReversedOperator,
            from.span,
            format!("`={sign}` assigns a value with a sign"),
        )
        .at("assigned as it is")
        .help(format!("write `{sign}=` to change the variable by it, or `= {sign}` if this is meant")),
    )
}
