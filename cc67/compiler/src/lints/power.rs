//! `2 ^ 10`: C has no operator for powers.

use crate::ast::{Expression, ExpressionKind};
use crate::diag::{Diagnostic, Lint};
use crate::source::Span;

/// The message for `left ^ right` where both are decimal numbers and the left one is the base of usual powers.
pub(crate) fn finding(left: &Expression, right: &Expression, span: Span) -> Option<Diagnostic> {
    let number = |expression: &Expression| match &expression.kind {
        ExpressionKind::Integer(literal) if literal.is_decimal => Some(literal.value),
        _ => None,
    };
    let (base, exponent) = (number(left).filter(|base| matches!(base, 2 | 10))?, number(right)?);
    let help = match base {
        2 => format!("write `1 << {exponent}`"),
        _ => format!("write `1e{exponent}`"),
    };
    Some(
        Diagnostic::warning(Lint::Power, span, "`^` is exclusive or, not a power")
            .at(format!("this is {}", base ^ exponent))
            .help(help),
    )
}
