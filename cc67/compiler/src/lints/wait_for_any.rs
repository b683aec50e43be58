//! `while (!CheckDone(0) && !CheckDone(1))`, which ends with the first axis that arrives.

use kmotiondef::firmware::Function;

use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::operators::CompareOp;
use crate::typed::{self, Callee, ExprId, ExprKind, StmtKind, UnaryOp};

/// The function that returns whether the motion of an axis has ended.
const CHECK_DONE: &str = Function::CheckDone.name();

/// Reports loops that wait while no axis has arrived.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        function.each_stmt(&mut |stmt| {
            let StmtKind::Loop { condition: Some(condition), .. } = stmt.kind else { return };
            let mut waits = 0;
            if moving(program, function, condition, &mut waits) && waits > 1 {
                let span = function.exprs[condition].span;
                sink.report(
                    Diagnostic::warning(
                        Lint::WaitForAny,
                        span,
                        "this loop ends when the first axis has arrived",
                    )
                    .at("false once one of them has arrived")
                    .help("write `||` in place of `&&` to wait for all of them"),
                );
            }
        });
    }
}

/// Reports whether a condition only tests if axes move, combined with `&&`; counts them.
fn moving(
    program: &AnalysedProgram<'_>,
    function: &typed::Function,
    condition: ExprId,
    waits: &mut u32,
) -> bool {
    match function.exprs[condition].kind {
        ExprKind::And(a, b) => moving(program, function, a, waits) && moving(program, function, b, waits),
        ExprKind::Unary(UnaryOp::Not, call) => asks(program, function, call, waits),
        ExprKind::Compare(CompareOp::Equal, call, zero) => {
            matches!(function.exprs[zero].kind, ExprKind::Int(0)) && asks(program, function, call, waits)
        }
        ExprKind::Convert(inner) => moving(program, function, inner, waits),
        _ => false,
    }
}

fn asks(program: &AnalysedProgram<'_>, function: &typed::Function, call: ExprId, waits: &mut u32) -> bool {
    let is_it = is_check_done(program, function, call);
    *waits += u32::from(is_it);
    is_it
}

/// Returns whether an expression is a call of `CheckDone`.
pub(super) fn is_check_done(program: &AnalysedProgram<'_>, function: &typed::Function, expr: ExprId) -> bool {
    called(program, function, expr) == Some(CHECK_DONE)
}

/// The name of the function that an expression calls.
pub(super) fn called<'a>(
    program: &'a AnalysedProgram<'_>,
    function: &typed::Function,
    expr: ExprId,
) -> Option<&'a str> {
    match &function.exprs[expr].kind {
        ExprKind::Call(call) => match call.callee {
            Callee::Symbol(callee) => Some(program.name(callee)),
            _ => None,
        },
        ExprKind::Convert(inner) => called(program, function, *inner),
        _ => None,
    }
}
