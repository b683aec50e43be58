//! Functions that call themselves: nobody can tell how much of the small stack they need.

use std::collections::BTreeSet;

use super::Lint;
use super::call_graph::CallGraph;
use super::program::Program;
use crate::diag::{Diagnostic, Sink};
use crate::typed::SymbolId;

/// Reports every function that its own calls lead back to, if `main` reaches it.
pub(super) fn check(program: &Program<'_>, sink: &mut Sink) {
    let graph = CallGraph::new(program);
    let Some(main) = program.symbol("main") else { return };
    let mut reported: BTreeSet<SymbolId> = BTreeSet::new();
    for (symbol, _) in graph.reached_from(main) {
        for (callee, span) in graph.callees(symbol) {
            let reached = graph.reached_from(callee);
            if !reached.contains_key(&symbol) || reached.keys().any(|other| reported.contains(other)) {
                continue;
            }
            reported.insert(symbol);
            let name = program.name(symbol);
            let message = match callee == symbol {
                true => format!("`{name}` calls itself"),
                false => format!("`{name}` calls `{}`, which leads back to it", program.name(callee)),
            };
            sink.report(
                Diagnostic::warning(Lint::Recursion, span, message)
                    .at("how deep, the compiler cannot tell")
                    .note("a thread has 2048 bytes of stack"),
            );
        }
    }
}
