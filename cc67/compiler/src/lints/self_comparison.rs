//! A floating-point value compared with itself.

use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::operators::CompareOp;
use crate::typed::{ExprId, ExprKind, Function, PlaceKind};

/// Reports `x == x` on variables.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        for expr in function.exprs.values() {
            let ExprKind::Compare(op, a, b) = expr.kind else { continue };
            if function.exprs[a].ty.is_floating() && is_same_variable(function, a, b) {
                let message = "a floating-point value is compared with itself";
                sink.report(Diagnostic::warning(Lint::SelfComparison, expr.span, message).at(result_of(op)));
            }
        }
    }
}

fn is_same_variable(function: &Function, a: ExprId, b: ExprId) -> bool {
    let (ExprKind::Load(x), ExprKind::Load(y)) = (&function.exprs[a].kind, &function.exprs[b].kind) else {
        return false;
    };
    let (x, y) = (function.places[*x].kind, function.places[*y].kind);
    x == y && matches!(x, PlaceKind::Local(..) | PlaceKind::Symbol(..))
}

const fn result_of(op: CompareOp) -> &'static str {
    match op {
        CompareOp::Equal | CompareOp::LessEqual | CompareOp::GreaterEqual => "true unless it is not a number",
        CompareOp::NotEqual => "true only if it is not a number",
        CompareOp::Less | CompareOp::Greater => "never true",
    }
}
