//! `i = i++`, which stores into one variable twice without a defined order.

use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::operators::BinaryOp;
use crate::typed::{ExprId, ExprKind, Function, PlaceKind, UpdateResult};

/// Reports assignments whose value changes the assigned variable.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        for expr in function.exprs.values() {
            let ExprKind::Assign(place, value) = expr.kind else { continue };
            let assigned = function.places[place].kind;
            if matches!(assigned, PlaceKind::Local(..) | PlaceKind::Symbol(..))
                && is_changed(function, assigned, value)
            {
                sink.report(
                    Diagnostic::warning(
                        Lint::Unsequenced,
                        expr.span,
                        "one variable is changed twice in an expression",
                    )
                    .at("C does not say which of the two stores is the last")
                    .help("write the increment as a statement of its own"),
                );
            }
        }
    }
}

/// Returns whether the value assigned to a variable increments the same variable, with no defined order of the two
/// stores.
fn is_changed(function: &Function, assigned: PlaceKind, value: ExprId) -> bool {
    match &function.exprs[value].kind {
        ExprKind::Update(update) => {
            let is_step =
                matches!(update.op, BinaryOp::Add | BinaryOp::Subtract) && update.result == UpdateResult::Old;
            is_step && function.places[update.place].kind == assigned
        }
        ExprKind::Convert(inner) => is_changed(function, assigned, *inner),
        ExprKind::Binary(_, a, b) => is_changed(function, assigned, *a) || is_changed(function, assigned, *b),
        _ => false,
    }
}
