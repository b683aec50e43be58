//! `50000 * 50000`: a computation with `int` constants that leaves the range of `int`, also where a variable holds one.

use std::collections::BTreeMap;

use super::program::AnalysedProgram;
use super::value_range::single_values;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::operators::BinaryOp;
use crate::source::Span;
use crate::ty::Types;
use crate::typed::{ExprId, ExprKind, Function, LocalId, PlaceKind};

/// Reports products with variables that have a single value, a constant.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        let known = single_values(function);
        for expr in function.exprs.values() {
            let ExprKind::Binary(BinaryOp::Multiply, a, b) = expr.kind else { continue };
            if expr.ty == Types::INT
                && let (Some(a), Some(b)) = (value(function, &known, a), value(function, &known, b))
            {
                sink.report_if(finding(BinaryOp::Multiply, a, b, expr.span));
            }
        }
    }
}

/// A constant, or that of a variable.
fn value(function: &Function, known: &BTreeMap<LocalId, i64>, expr: ExprId) -> Option<i64> {
    match function.exprs[expr].kind {
        ExprKind::Int(number) => Some(number),
        ExprKind::Load(place) => match function.places[place].kind {
            PlaceKind::Local(local, 0) => known.get(&local).copied(),
            _ => None,
        },
        _ => None,
    }
}

/// The message for a computation of two signed constants of 32 bits.
pub(crate) fn finding(op: BinaryOp, a: i64, b: i64, span: Span) -> Option<Diagnostic> {
    let exact = op.exactly(a, b)?;
    let stored = exact as i32;
    (i64::from(stored) != exact).then(|| {
        Diagnostic::warning(Lint::Overflow, span, format!("{exact} does not fit in an `int`"))
            .at(format!("the result is {stored}"))
            .help("write one of the numbers with a decimal point, as in `50000.0`, and store the result in a `double`")
    })
}
