//! The address of a local array, returned from its function.

use super::program::AnalysedProgram;
use super::walk::{Extent, Walk};
use crate::diag::{Diagnostic, Lint, Sink};
use crate::operators::BinaryOp;
use crate::typed::{ExprId, ExprKind, Function, LocalId, PlaceKind, StmtKind};

/// Reports `return` of an address in the function's own frame.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        function.each_stmt(&mut |stmt| {
            let StmtKind::Return(Some(value)) = stmt.kind else { return };
            let Some(local) = addressed(function, value).or_else(|| kept(function, value)) else { return };
            let local = &function.locals[local];
            if local.name.is_empty() {
                return;
            }
            let message =
                format!("the address of `{}` is returned, which ends with the function", local.name);
            sink.report(
                Diagnostic::warning(Lint::ReturnedLocal, function.exprs[value].span, message)
                    .label(local.span, "a variable of this function")
                    .help("declare it `static`, or let the caller pass an array"),
            );
        });
    }
}

/// The local into which an address points.
fn addressed(function: &Function, expr: ExprId) -> Option<LocalId> {
    match function.exprs[expr].kind {
        ExprKind::Convert(inner) => addressed(function, inner),
        ExprKind::Binary(op, base, _) if [BinaryOp::Add, BinaryOp::Subtract].contains(&op) => {
            addressed(function, base)
        }
        ExprKind::Address(place) => match function.places[place].kind {
            PlaceKind::Local(local, _) => Some(local),
            _ => None,
        },
        _ => None,
    }
}

/// The local into which the value of a pointer variable points.
fn kept(function: &Function, expr: ExprId) -> Option<LocalId> {
    match function.exprs[expr].kind {
        ExprKind::Convert(inner) => kept(function, inner),
        ExprKind::Load(place) => match function.places[place].kind {
            PlaceKind::Local(local, 0) if !function.locals[local].in_memory => only_value(function, local),
            _ => None,
        },
        _ => None,
    }
}

/// The local to which a pointer points in the whole function, if every assignment agrees.
fn only_value(function: &Function, pointer: LocalId) -> Option<LocalId> {
    let mut found = None;
    let mut is_same = !function.parameters.contains(&pointer);
    Walk { function, extent: Extent::All }.stmts(&function.body, &mut |expr| {
        let (place, value) = match &function.exprs[expr].kind {
            ExprKind::Assign(place, value) => (*place, Some(*value)),
            ExprKind::Update(update) => (update.place, None),
            _ => return,
        };
        if !matches!(function.places[place].kind, PlaceKind::Local(local, _) if local == pointer) {
            return;
        }
        // A pointer that is incremented stays in its object.
        let Some(value) = value else { return };
        let to = addressed(function, value);
        is_same &= to.is_some() && (found.is_none() || found == to);
        found = to;
    });
    found.filter(|_| is_same)
}
