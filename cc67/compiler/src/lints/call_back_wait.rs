//! The call-back of the servo interrupt, which must not wait.

use std::collections::{BTreeMap, BTreeSet};

use kmotiondef::firmware::row_named;

use super::call_graph::CallGraph;
use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::typed::{Callee, ExprId, ExprKind, Function, PlaceId, PlaceKind, SymbolId};

/// The firmware's pointer to the function that every servo interrupt calls.
const VARIABLE: &str = "UserCallBack";

/// Reports calls that may wait in the functions that the unit installs as call-back.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    let graph = CallGraph::new(program);
    let mut seen = BTreeSet::new();
    for root in call_backs(program) {
        let reached = graph.reached_from(root);
        let Some(call_back) = graph.function(root) else { continue };
        for function in reached.keys().filter_map(|symbol| graph.function(*symbol)) {
            for (expr, call) in function.calls() {
                let Callee::Symbol(callee) = call.callee else { continue };
                let name = program.name(callee);
                if row_named(name).is_none_or(|row| row.attributes.waits.is_none())
                    || !seen.insert((function.symbol, callee))
                {
                    continue;
                }
                let diagnostic = Diagnostic::warning(
                    Lint::CallBackWait,
                    expr.span,
                    format!("`{name}` in the call-back may wait"),
                )
                .at("the board hangs if it does")
                .label(call_back.span, "runs in every servo interrupt")
                .help("set a variable here, and call the function in a thread that checks the variable");
                sink.report(match function.symbol == root {
                    true => diagnostic,
                    false => diagnostic.note(path(program, &reached, function.symbol)),
                });
            }
        }
    }
}

/// The functions that the unit installs as call-back.
pub(super) fn call_backs(program: &AnalysedProgram<'_>) -> BTreeSet<SymbolId> {
    let Some(variable) = program.symbol(VARIABLE) else { return BTreeSet::new() };
    program.functions().flat_map(|function| installed_functions(function, variable)).collect()
}

/// The calls that lead from the call-back to a function, for people.
fn path(
    program: &AnalysedProgram<'_>,
    reached: &BTreeMap<SymbolId, Option<SymbolId>>,
    to: SymbolId,
) -> String {
    let mut names = vec![program.name(to)];
    let mut symbol = to;
    while let Some(Some(caller)) = reached.get(&symbol) {
        names.push(program.name(*caller));
        symbol = *caller;
    }
    names.reverse();
    format!("called through {}", names.join(" → "))
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
