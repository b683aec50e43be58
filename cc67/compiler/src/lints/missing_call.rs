//! `while (!CheckDone) ;`: the name of a function where its result is meant.

use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::ty::Type;
use crate::typed::{ExprId, ExprKind, Function, PlaceKind, StmtKind, SymbolId, UnaryOp};

/// Reports functions that are tested or compared with a number, which is always or never true for their address.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        let mut tested = tested(function);
        tested.sort_unstable();
        for expr in tested {
            if let Some(symbol) = named(program, function, expr) {
                let name = program.name(symbol);
                let message = format!("`{name}` is not called here");
                let finding = Diagnostic::warning(Lint::MissingCall, function.exprs[expr].span, message)
                    .at("the function's address, which is never 0")
                    .help(format!("write `{name}(…)` to call the function"));
                sink.report(finding);
            }
        }
    }
}

/// The expressions that are tested for truth, in no particular order.
fn tested(function: &Function) -> Vec<ExprId> {
    let mut tested = Vec::new();
    function.each_stmt(&mut |stmt| match &stmt.kind {
        StmtKind::If { condition, .. } => tested.push(*condition),
        StmtKind::Loop { condition, .. } => tested.extend(*condition),
        _ => {}
    });
    let is_number = |expr: ExprId| matches!(function.exprs[expr].kind, ExprKind::Int(_));
    for expr in function.exprs.values() {
        match expr.kind {
            ExprKind::Unary(UnaryOp::Not, value) | ExprKind::Conditional(value, ..) => tested.push(value),
            ExprKind::And(a, b) | ExprKind::Or(a, b) => tested.extend([a, b]),
            ExprKind::Compare(_, a, b) if is_number(b) => tested.push(a),
            ExprKind::Compare(_, a, b) if is_number(a) => tested.push(b),
            _ => {}
        }
    }
    tested
}

/// The function, if an expression is just its name.
fn named(program: &AnalysedProgram<'_>, function: &Function, expr: ExprId) -> Option<SymbolId> {
    let place = match function.exprs[expr].kind {
        ExprKind::Address(place) => place,
        // A comparison with a number converts.
        ExprKind::Convert(inner) => return named(program, function, inner),
        _ => return None,
    };
    let PlaceKind::Symbol(symbol, ..) = function.places[place].kind else { return None };
    let is_function = matches!(program.unit.types.get(program.unit.symbols[symbol].ty), Type::Function(_));
    is_function.then_some(symbol)
}
