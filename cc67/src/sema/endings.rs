//! How statements end: functions without a value, loops without an end.

use super::Sema;
use crate::diag::Diagnostic;
use crate::lints::Lint;
use crate::source::Span;
use crate::typed::{ExprId, ExprKind, Function, PlaceKind, Stmt, StmtKind};

impl Sema<'_> {
    /// Warns about a function that may end without its value.
    pub(super) fn lint_missing_return(&mut self, function: &Function) {
        let name = &self.symbols.get(function.symbol).name;
        if function.ty.result.is_void() || name == "main" || !may_complete(&function.body) {
            return;
        }
        let message = format!("`{name}` may end without returning a value");
        self.report(
            Diagnostic::warning(Lint::MissingReturn, function.end, message)
                .at("the value is 0 here")
                .label(function.span, "this function")
                .note("on the board it is whatever the last call left behind"),
        );
    }

    /// Warns about `for (;;) ;`: the thread spends its slices on nothing, for ever.
    pub(super) fn lint_idle_loop(
        &mut self,
        condition: Option<ExprId>,
        body: &[Stmt],
        step: Option<ExprId>,
        span: Span,
    ) {
        let is_idle = condition.is_none()
            && body.iter().all(|stmt| self.is_idle(stmt))
            && step.is_none_or(|step| self.is_pure(step));
        if is_idle {
            self.report(
                Diagnostic::warning(Lint::IdleLoop, span, "this loop does nothing and never ends").help(
                    "end the program by returning from `main`, or call `WaitNextTimeSlice()` in the loop",
                ),
            );
        }
    }

    /// Whether a statement has no effect and does not leave its loop.
    fn is_idle(&self, stmt: &Stmt) -> bool {
        match &stmt.kind {
            StmtKind::Expr(expr) => self.is_pure(*expr),
            StmtKind::Block(inner) => inner.iter().all(|stmt| self.is_idle(stmt)),
            StmtKind::If { condition, then, otherwise } => {
                self.is_pure(*condition) && then.iter().chain(otherwise).all(|stmt| self.is_idle(stmt))
            }
            StmtKind::Continue => true,
            _ => false,
        }
    }

    /// Whether an expression changes nothing but locals that live in no memory.
    fn is_pure(&self, expr: ExprId) -> bool {
        match &self.body.exprs[expr].kind {
            ExprKind::Int(_) | ExprKind::Float(_) => true,
            ExprKind::Load(place) => matches!(self.body.places[*place].kind, PlaceKind::Local(..)),
            ExprKind::Update(update) => {
                let is_register = match self.body.places[update.place].kind {
                    PlaceKind::Local(local, _) => !self.body.locals[local].in_memory,
                    _ => false,
                };
                is_register && self.is_pure(update.operand)
            }
            ExprKind::Unary(_, value) | ExprKind::Convert(value) => self.is_pure(*value),
            _ => false,
        }
    }
}

/// Whether what follows the statements can be reached.
fn may_complete(stmts: &[Stmt]) -> bool {
    stmts.iter().all(completes)
}

fn completes(stmt: &Stmt) -> bool {
    match &stmt.kind {
        StmtKind::Return(_) | StmtKind::Goto(_) | StmtKind::Break | StmtKind::Continue => false,
        StmtKind::Block(inner) => may_complete(inner),
        StmtKind::If { then, otherwise, .. } => may_complete(then) || may_complete(otherwise),
        StmtKind::Loop { condition: None, body, .. } => body.iter().any(breaks),
        StmtKind::Switch { has_default, body, .. } => {
            !has_default || body.iter().any(breaks) || body.last().is_none_or(completes)
        }
        _ => true,
    }
}

/// Whether a statement leaves the loop or switch around it with `break`.
fn breaks(stmt: &Stmt) -> bool {
    match &stmt.kind {
        StmtKind::Break => true,
        StmtKind::Block(inner) => inner.iter().any(breaks),
        StmtKind::If { then, otherwise, .. } => then.iter().chain(otherwise).any(breaks),
        _ => false,
    }
}
