//! The calls whose value is used, for lints about results.

use std::collections::BTreeSet;

use crate::ty::Types;
use crate::typed::{Callee, ExprId, ExprKind, Function, Stmt, StmtKind, SymbolId};

/// The functions whose values are used by `function`.
pub(super) fn used_in(function: &Function) -> BTreeSet<SymbolId> {
    let dropped = dropped(function);
    let calls = function.exprs.iter().filter(|(id, _)| !dropped.contains(id));
    calls
        .filter_map(|(_, expr)| match &expr.kind {
            ExprKind::Call(call) => match call.callee {
                Callee::Symbol(callee) => Some(callee),
                Callee::Pointer(_) => None,
            },
            _ => None,
        })
        .collect()
}

/// The expressions whose value is not used.
fn dropped(function: &Function) -> BTreeSet<ExprId> {
    let mut open = Vec::new();
    function.each_stmt(&mut |stmt| collect(stmt, &mut open));
    for expr in function.exprs.values() {
        match &expr.kind {
            ExprKind::Comma(first, _) => open.push(*first),
            ExprKind::Convert(inner) if expr.ty == Types::VOID => open.push(*inner),
            ExprKind::Statements(stmts, _) => stmts.iter().for_each(|stmt| collect(stmt, &mut open)),
            _ => {}
        }
    }
    let mut dropped = BTreeSet::new();
    while let Some(expr) = open.pop() {
        if !dropped.insert(expr) {
            continue;
        }
        match function.exprs[expr].kind {
            ExprKind::Comma(_, last) | ExprKind::Convert(last) => open.push(last),
            ExprKind::Conditional(_, a, b) => open.extend([a, b]),
            _ => {}
        }
    }
    dropped
}

/// Collects the values that one statement evaluates and drops.
fn collect(stmt: &Stmt, out: &mut Vec<ExprId>) {
    match &stmt.kind {
        StmtKind::Expr(expr) => out.push(*expr),
        StmtKind::Loop { step, .. } => out.extend(*step),
        _ => {}
    }
}
