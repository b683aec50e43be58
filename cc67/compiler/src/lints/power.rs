//! `2 ^ 10`: C has no operator for powers.

use super::program::AnalysedProgram;
use crate::ast::{Expression, ExpressionKind};
use crate::diag::{Diagnostic, Lint, Sink};
use crate::operators::{BinaryOp, BinaryOperator};
use crate::source::Span;
use crate::typed::ExprKind;

/// Reports exclusive ors that become floating-point numbers, which bits never do: `radius = x ^ 2`.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        for expr in function.exprs.values().filter(|expr| expr.ty.is_floating()) {
            let ExprKind::Convert(inner) = expr.kind else { continue };
            let inner = &function.exprs[inner];
            if let ExprKind::Binary(BinaryOp::Xor, ..) = inner.kind {
                sink.report(
                    Diagnostic::warning(Lint::Power, inner.span, "`^` is exclusive or, not a power")
                        .at(format!("bits that become a `{}`", program.spell(expr.ty)))
                        .help("write `x * x`, or `pow(x, y)`"),
                );
            }
        }
    }
}

/// The message for `left ^ right` where both are decimal numbers and the left one is the base of usual powers.
pub(crate) fn finding(left: &Expression, right: &Expression, span: Span) -> Option<Diagnostic> {
    let exponent = number(right)?;
    let base = number(last_factor(left)).filter(|base| matches!(base, 2 | 10))?;
    let finding = Diagnostic::warning(Lint::Power, span, "`^` is exclusive or, not a power");
    let power = match base {
        2 => format!("(1 << {exponent})"),
        _ => format!("1e{exponent}"),
    };
    Some(match factor(left) {
        None => {
            let power = power.trim_matches(['(', ')']);
            finding.at(format!("this is {}", base ^ exponent)).help(format!("write `{power}`"))
        }
        Some(factor) => {
            // A product with a fraction is an error with its own message.
            if matches!(factor.kind, ExpressionKind::Floating(_)) {
                return None;
            }
            let help = match number(factor) {
                Some(factor) if base == 10 => format!("write `{factor}e{exponent}`"),
                _ => format!("write `* {power}`"),
            };
            finding.at("the product is computed first").help(help)
        }
    })
}

fn number(expression: &Expression) -> Option<u64> {
    match &expression.kind {
        ExpressionKind::Integer(literal) if literal.is_decimal => Some(literal.value),
        _ => None,
    }
}

/// The first factor of a product without parentheses around it, which its span would include.
fn factor(expression: &Expression) -> Option<&Expression> {
    match &expression.kind {
        ExpressionKind::Binary(BinaryOperator::Multiply, left, _) if expression.span.lo == left.span.lo => {
            Some(left)
        }
        _ => None,
    }
}

/// The number to which `^` seems to apply in `2 * 10 ^ 5`.
fn last_factor(expression: &Expression) -> &Expression {
    match &expression.kind {
        ExpressionKind::Binary(_, _, right) if factor(expression).is_some() => right,
        _ => expression,
    }
}
