//! The call-back of the servo interrupt, which must not wait.

use std::collections::BTreeSet;

use super::Sema;
use crate::diag::Diagnostic;
use crate::lints::Lint;
use crate::typed::{Callee, Expr, ExprId, ExprKind, Function, PlaceId, PlaceKind, SymbolId};

/// Firmware functions that may wait: for time, for the PC, for another thread.
const WAITING: &[&str] = &[
    "Delay_sec",
    "MutexLock",
    "RS232_GetChar",
    "RS232_PutChar",
    "WaitNextTimeSlice",
    "WaitUntil",
    "fgets",
    "fopen",
    "fprintf",
    "fscanf",
    "printf",
];

impl Sema<'_> {
    /// Warns about calls that may wait in the functions that the unit installs as call-back.
    pub(super) fn lint_call_backs(&mut self, functions: &[Function]) {
        let Some(variable) = self.symbols.linked(self.known.call_back) else { return };
        let installed: BTreeSet<_> =
            functions.iter().flat_map(|function| installed_functions(function, variable)).collect();
        for function in functions.iter().filter(|function| installed.contains(&function.symbol)) {
            for (callee, expr) in function.exprs.values().filter_map(called) {
                if !WAITING.contains(&self.symbols.get(callee).name.as_str()) {
                    continue;
                }
                let name = &self.symbols.get(callee).name;
                self.report(
                    Diagnostic::warning(
                        Lint::CallBackWait,
                        expr.span,
                        format!("`{name}` in the call-back may wait"),
                    )
                    .at("the board hangs if it does")
                    .label(function.span, "runs in every servo interrupt")
                    .help("set a variable here, and call it in a thread that sees the variable"),
                );
            }
        }
    }
}

/// The functions that are stored in `variable`.
fn installed_functions(function: &Function, variable: SymbolId) -> impl Iterator<Item = SymbolId> {
    let symbol_at = |place: PlaceId| match function.places[place].kind {
        PlaceKind::Symbol(symbol, 0) => Some(symbol),
        _ => None,
    };
    let address = move |expr: ExprId| match function.exprs[expr].kind {
        ExprKind::Address(place) => symbol_at(place),
        _ => None,
    };
    function.exprs.values().filter_map(move |expr| match expr.kind {
        ExprKind::Assign(place, value) if symbol_at(place) == Some(variable) => address(value),
        _ => None,
    })
}

/// The function that an expression calls by name.
fn called(expr: &Expr) -> Option<(SymbolId, &Expr)> {
    match &expr.kind {
        ExprKind::Call(call) => match call.callee {
            Callee::Symbol(symbol) => Some((symbol, expr)),
            Callee::Pointer(_) => None,
        },
        _ => None,
    }
}
