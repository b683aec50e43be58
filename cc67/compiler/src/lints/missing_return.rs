//! Functions that may end without returning a value.
//!
//! Few programs for this board use the value of `main`, or of a helper that is called as a statement; only values that
//! a caller uses matter (`dialect.md` section 8).

use std::collections::BTreeSet;

use super::program::AnalysedProgram;
use super::used_values;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::typed::{Stmt, StmtKind};

/// Reports every function except `main` whose end can be reached.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    let used: BTreeSet<_> = program.functions().flat_map(used_values::used_in).collect();
    for function in program.whole_functions() {
        let name = program.name(function.symbol);
        if function.ty.result.is_void() || name == "main" || !may_complete(&function.body) {
            continue;
        }
        let (lint, message) = match used.contains(&function.symbol) {
            true => (Lint::MissingReturn, format!("`{name}` may end without the value that its callers use")),
            false => (Lint::FallsOffEnd, format!("`{name}` may end without returning a value")),
        };
        sink.report(
            Diagnostic::warning(lint, function.end, message)
                .at("the value is 0 here")
                .label(function.span, "this function")
                .note("on the board it is whatever the last call left behind"),
        );
    }
}

/// Reports whether execution can continue after the statements.
fn may_complete(stmts: &[Stmt]) -> bool {
    stmts.iter().all(completes)
}

/// Reports whether execution can continue after a statement.
pub(super) fn completes(stmt: &Stmt) -> bool {
    match &stmt.kind {
        StmtKind::Return(_)
        | StmtKind::Goto(_)
        | StmtKind::GotoAddress(_)
        | StmtKind::Break
        | StmtKind::Continue => false,
        StmtKind::Block(inner) => may_complete(inner),
        StmtKind::If { then, otherwise, .. } => may_complete(then) || may_complete(otherwise),
        StmtKind::Loop { condition: None, body, .. } => body.iter().any(breaks),
        StmtKind::Switch { has_default, body, .. } => {
            !has_default || body.iter().any(breaks) || body.last().is_none_or(completes)
        }
        _ => true,
    }
}

/// Reports whether a statement leaves the loop or switch around it with `break`.
fn breaks(stmt: &Stmt) -> bool {
    match &stmt.kind {
        StmtKind::Break => true,
        StmtKind::Block(inner) => inner.iter().any(breaks),
        StmtKind::If { then, otherwise, .. } => then.iter().chain(otherwise).any(breaks),
        _ => false,
    }
}
