//! `int step = 0; main() { while (step < 3) { …; step++; } }`: on the second start of the program `step` is still 3.
//!
//! A global variable gets its initial value when the program is loaded, not when it is started.

use super::changes::{Changes, symbol};
use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::operators::CompareOp;
use crate::typed::{Definition, ExprId, ExprKind, Function, StmtKind, SymbolId};

/// Reports loops of `main` that end by counting a global variable that is not set elsewhere.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    let Some(main) = program.whole_functions().find(|function| program.name(function.symbol) == "main")
    else {
        return;
    };
    let mut counted = Vec::new();
    main.each_stmt(&mut |stmt| {
        if let StmtKind::Loop { condition: Some(condition), .. } = stmt.kind
            && let Some(symbol) = counter(program, main, condition)
        {
            counted.push((symbol, condition));
        }
    });
    if counted.is_empty() {
        return;
    }
    let changes = Changes::of(program);
    counted.retain(|(symbol, _)| changes.counted.contains(symbol) && !changes.set.contains(symbol));
    for (symbol, condition) in counted {
        let name = program.name(symbol);
        let message = format!("nothing sets `{name}` back when the program starts again");
        sink.report(
            Diagnostic::warning(Lint::KeptCounter, main.exprs[condition].span, message)
                .at("false at once on the second start")
                .note(
                    "variables of a program get their first values when it is loaded, not when it is started",
                )
                .help(format!("store the first value of `{name}` at the beginning of `main`")),
        );
    }
}

/// The variable of the program that a condition compares with a constant.
fn counter(program: &AnalysedProgram<'_>, function: &Function, condition: ExprId) -> Option<SymbolId> {
    let ExprKind::Compare(
        CompareOp::Less | CompareOp::LessEqual | CompareOp::Greater | CompareOp::GreaterEqual,
        value,
        end,
    ) = function.exprs[condition].kind
    else {
        return None;
    };
    let ExprKind::Load(place) = function.exprs[value].kind else { return None };
    let symbol = symbol(function, place)?;
    // An explicit initial value is probably relied on.
    let is_own = matches!(program.unit.symbols[symbol].definition, Definition::Data(_));
    (is_own && matches!(function.exprs[end].kind, ExprKind::Int(_))).then_some(symbol)
}
