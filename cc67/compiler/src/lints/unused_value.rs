//! Statements that compute a value and drop it.

use kmotiondef::firmware::row_named;
use kmotiondef::function::PolledState;

use super::format::called_firmware;
use super::program::AnalysedProgram;
use crate::ast::{Expression, ExpressionKind, UnaryOperator};
use crate::diag::{Diagnostic, Lint, Sink};
use crate::operators::BinaryOperator;
use crate::source::Span;
use crate::typed::{ExprKind, StmtKind};

/// Reports calls of functions that only answer a question, as statements.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        function.each_stmt(&mut |stmt| {
            let StmtKind::Expr(expr) = stmt.kind else { return };
            let ExprKind::Call(call) = &function.exprs[expr].kind else { return };
            let Some(name) = called_firmware(program.unit, call) else { return };
            if only_answers(name) {
                let message = format!("the result of `{name}` is not used");
                sink.report(
                    Diagnostic::warning(Lint::UnusedValue, stmt.span, message)
                        .at("the call has no other effect")
                        .help(format!("a loop waits: `while (!{name}(…)) WaitNextTimeSlice();`")),
                );
            }
        });
    }
}

/// Reports whether a firmware function has no effect but its result.
fn only_answers(name: &str) -> bool {
    let polls = row_named(name).and_then(|row| row.attributes.polls);
    matches!(polls, Some(PolledState::Bit | PolledState::Motion | PolledState::Path | PolledState::Recording))
}

/// The message for an expression statement whose value is not used; `is_function` if it is just the name of a function.
pub(crate) fn finding(expression: &Expression, is_function: bool) -> Option<Diagnostic> {
    if let ExpressionKind::Unary(UnaryOperator::Dereference, pointer) = &expression.kind
        && let ExpressionKind::Increment { is_increment, is_prefix: false, .. } = pointer.kind
    {
        return Some(moved_pointer(expression.span, is_increment));
    }
    if has_effect(expression) {
        return None;
    }
    if let ExpressionKind::Comma(first, last) = &expression.kind
        && has_effect(first)
    {
        return Some(after_comma(first, last));
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

/// The message for `*p++;`, which increments the pointer and not its target.
fn moved_pointer(span: Span, is_increment: bool) -> Diagnostic {
    let operator = if is_increment { "++" } else { "--" };
    let message = "this moves the pointer; the value that it points to stays the same";
    Diagnostic::warning(Lint::UnusedValue, span, message)
        .at("the value is read and dropped")
        .help(format!("`(*p){operator}` changes the value; `p{operator}` alone moves the pointer"))
}

/// The message for `first, last` where only `first` has an effect: `x = 0,25` stores 0.
fn after_comma(first: &Expression, last: &Expression) -> Diagnostic {
    let stored = match &first.kind {
        ExpressionKind::Assign(_, value) | ExpressionKind::AssignWith(_, _, value) => whole(value),
        _ => None,
    };
    match stored.zip(whole(last)) {
        Some((stored, fraction)) => {
            let message = format!("`,` ends the number: {stored} is stored, and {fraction} is dropped");
            Diagnostic::warning(Lint::UnusedValue, last.span, message)
                .at("no part of the number")
                .help("the decimal point is `.`, as in `0.25`")
        }
        None => Diagnostic::warning(Lint::UnusedValue, last.span, "the value after `,` is not used")
            .at("the value is dropped"),
    }
}

/// The value of a decimal constant without a point.
fn whole(expression: &Expression) -> Option<u64> {
    match &expression.kind {
        ExpressionKind::Integer(literal) if literal.is_decimal => Some(literal.value),
        ExpressionKind::Unary(UnaryOperator::Minus, operand) => whole(operand),
        _ => None,
    }
}

/// Reports whether evaluating an expression has an effect, judging by its form.
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
        ExpressionKind::Cast(_, inner) | ExpressionKind::Unary(UnaryOperator::Dereference, inner) => {
            has_effect(inner)
        }
        _ => false,
    }
}
