//! The call-back of the servo interrupt, which must not wait.

use std::collections::BTreeSet;

use super::Lint;
use super::program::Program;
use crate::diag::{Diagnostic, Sink};
use crate::typed::{Callee, ExprId, ExprKind, Function, PlaceId, PlaceKind, SymbolId};

/// The firmware's pointer to the function that every servo interrupt calls.
const VARIABLE: &str = "UserCallBack";

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

/// Reports calls that may wait in the functions that the unit installs as call-back.
pub(super) fn check(program: &Program<'_>, sink: &mut Sink) {
    let Some(variable) = program.symbol(VARIABLE) else { return };
    let installed: BTreeSet<_> =
        program.functions().flat_map(|function| installed_functions(function, variable)).collect();
    for function in program.functions().filter(|function| installed.contains(&function.symbol)) {
        for (expr, call) in function.calls() {
            let Callee::Symbol(callee) = call.callee else { continue };
            let name = &program.unit.symbols[callee].name;
            if WAITING.contains(&name.as_str()) {
                sink.report(
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
