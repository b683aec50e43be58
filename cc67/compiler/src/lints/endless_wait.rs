//! `while (!flag) WaitNextTimeSlice();`, where no statement of the program changes `flag`.

use std::collections::BTreeSet;

use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::typed::{Definition, ExprId, ExprKind, Function, PlaceKind, Stmt, StmtKind, SymbolId};

/// Reports loops whose condition reads only one variable of the program, which is never changed.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    // Code with errors may change anything.
    if program.functions().any(|function| function.has_errors) {
        return;
    }
    let changed = changed(program);
    for function in program.functions() {
        function.each_stmt(&mut |stmt| {
            if let Some((symbol, condition)) = waited(program, function, stmt)
                && !changed.contains(&symbol)
            {
                let name = program.name(symbol);
                let message = format!("this loop waits for `{name}`, which nothing in the program changes");
                sink.report(
                    Diagnostic::warning(Lint::EndlessWait, function.exprs[condition].span, message)
                        .at("the same in every iteration")
                        .help("no other thread can change it: use `persist.UserData` or a virtual bit, which threads share"),
                );
            }
        });
    }
}

/// The variable for which a loop waits, and the condition.
fn waited(program: &AnalysedProgram<'_>, function: &Function, stmt: &Stmt) -> Option<(SymbolId, ExprId)> {
    let StmtKind::Loop { condition: Some(condition), body, step: None, .. } = &stmt.kind else { return None };
    if leaves(body) {
        return None;
    }
    let symbol = only_variable(function, *condition)?;
    let symbols = &program.unit.symbols;
    let is_own = matches!(symbols[symbol].definition, Definition::Tentative | Definition::Data(_));
    (is_own && !symbols[symbol].is_anonymous()).then_some((symbol, *condition))
}

/// Reports whether statements may leave the loop around them, or hold inline assembler.
fn leaves(stmts: &[Stmt]) -> bool {
    stmts.iter().any(|stmt| match &stmt.kind {
        StmtKind::Break | StmtKind::Return(_) | StmtKind::Goto(_) | StmtKind::GotoAddress(_) => true,
        StmtKind::Block(body) | StmtKind::Loop { body, .. } | StmtKind::Switch { body, .. } => leaves(body),
        StmtKind::If { then, otherwise, .. } => leaves(then) || leaves(otherwise),
        _ => false,
    })
}

/// The variable with linkage that a condition reads, if it depends on nothing else.
fn only_variable(function: &Function, condition: ExprId) -> Option<SymbolId> {
    match function.exprs[condition].kind {
        ExprKind::Load(place) => match function.places[place].kind {
            PlaceKind::Symbol(symbol, ..) => Some(symbol),
            _ => None,
        },
        ExprKind::Unary(_, value) | ExprKind::Convert(value) => only_variable(function, value),
        ExprKind::Compare(_, a, b) | ExprKind::Binary(_, a, b) => {
            let is_number =
                |expr: ExprId| matches!(function.exprs[expr].kind, ExprKind::Int(_) | ExprKind::Float(_));
            match (is_number(a), is_number(b)) {
                (true, false) => only_variable(function, b),
                (false, true) => only_variable(function, a),
                _ => None,
            }
        }
        _ => None,
    }
}

/// The variables that a statement changes, or whose addresses it passes on.
fn changed(program: &AnalysedProgram<'_>) -> BTreeSet<SymbolId> {
    let mut changed = BTreeSet::new();
    for symbol in program.unit.symbols.values() {
        if let Definition::Data(data) = &symbol.definition {
            changed.extend(data.addresses.iter().map(|word| word.symbol));
        }
    }
    for function in program.functions() {
        for expr in function.exprs.values() {
            let place = match &expr.kind {
                ExprKind::Assign(place, _)
                | ExprKind::Address(place)
                | ExprKind::Clear(place)
                | ExprKind::VaArg(place) => *place,
                ExprKind::Update(update) => update.place,
                ExprKind::Copy { to, .. } => *to,
                _ => continue,
            };
            let mut place = place;
            while let PlaceKind::Bits(unit, _) = function.places[place].kind {
                place = unit;
            }
            if let PlaceKind::Symbol(symbol, ..) = function.places[place].kind {
                changed.insert(symbol);
            }
        }
    }
    changed
}
