//! Functions that call themselves: their need of the small stack is unknown.

use std::collections::BTreeMap;

use super::call_graph::CallGraph;
use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::source::Span;
use crate::typed::SymbolId;

/// Reports every function that is called while it runs, if `main` reaches it.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    let Some(main) = program.symbol("main") else { return };
    for (callee, (caller, span)) in calls_back(&CallGraph::new(program), main) {
        let name = program.name(callee);
        let message = match callee == caller {
            true => format!("`{name}` calls itself"),
            false => format!("`{}` calls `{name}`, which leads back to it", program.name(caller)),
        };
        sink.report(
            Diagnostic::warning(Lint::Recursion, span, message)
                .at("the depth is not known at compile time")
                .note("a thread has 2048 bytes of stack"),
        );
    }
}

/// The functions that are called again on a path from `root`, each with the first such call.
fn calls_back(graph: &CallGraph<'_>, root: SymbolId) -> BTreeMap<SymbolId, (SymbolId, Span)> {
    /// A function whose calls are being followed, and the number of calls already followed.
    struct Open {
        symbol: SymbolId,
        followed: usize,
    }
    let mut found = BTreeMap::new();
    // For each visited function, true if it is still open.
    let mut is_open = BTreeMap::from([(root, true)]);
    let mut path = vec![Open { symbol: root, followed: 0 }];
    while let Some(Open { symbol, followed }) = path.last_mut() {
        let symbol = *symbol;
        let Some((callee, span)) = graph.callees(symbol).get(*followed).copied() else {
            is_open.insert(symbol, false);
            path.pop();
            continue;
        };
        *followed += 1;
        match is_open.get(&callee) {
            Some(true) => {
                found.entry(callee).or_insert((symbol, span));
            }
            Some(false) => {}
            None => {
                is_open.insert(callee, true);
                path.push(Open { symbol: callee, followed: 0 });
            }
        }
    }
    found
}
