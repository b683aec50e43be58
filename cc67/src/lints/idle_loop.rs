//! Loops that never end and do nothing: the thread spends its slices on them for ever.

use super::Lint;
use super::program::Program;
use crate::diag::{Diagnostic, Sink};
use crate::typed::{ExprId, ExprKind, Function, PlaceKind, Stmt, StmtKind};

/// Reports `for (;;) ;` and whatever comes to the same.
pub(super) fn check(program: &Program<'_>, sink: &mut Sink) {
    for function in program.functions() {
        function.each_stmt(&mut |stmt| {
            if is_idle_loop(function, stmt) {
                sink.report(
                    Diagnostic::warning(Lint::IdleLoop, stmt.span, "this loop does nothing and never ends").help(
                        "end the program by returning from `main`, or call `WaitNextTimeSlice()` in the loop",
                    ),
                );
            }
        });
    }
}

fn is_idle_loop(function: &Function, stmt: &Stmt) -> bool {
    let StmtKind::Loop { condition: None, body, step, .. } = &stmt.kind else { return false };
    body.iter().all(|stmt| is_idle(function, stmt)) && step.is_none_or(|step| is_pure(function, step))
}

/// Whether a statement has no effect and does not leave its loop.
fn is_idle(function: &Function, stmt: &Stmt) -> bool {
    match &stmt.kind {
        StmtKind::Expr(expr) => is_pure(function, *expr),
        StmtKind::Block(inner) => inner.iter().all(|stmt| is_idle(function, stmt)),
        StmtKind::If { condition, then, otherwise } => {
            is_pure(function, *condition) && then.iter().chain(otherwise).all(|stmt| is_idle(function, stmt))
        }
        StmtKind::Continue => true,
        _ => false,
    }
}

/// Whether an expression changes nothing but locals that live in no memory.
fn is_pure(function: &Function, expr: ExprId) -> bool {
    match &function.exprs[expr].kind {
        ExprKind::Int(_) | ExprKind::Float(_) => true,
        ExprKind::Load(place) => matches!(function.places[*place].kind, PlaceKind::Local(..)),
        ExprKind::Update(update) => {
            let is_register = match function.places[update.place].kind {
                PlaceKind::Local(local, _) => !function.locals[local].in_memory,
                _ => false,
            };
            is_register && is_pure(function, update.operand)
        }
        ExprKind::Unary(_, value) | ExprKind::Convert(value) => is_pure(function, *value),
        _ => false,
    }
}
